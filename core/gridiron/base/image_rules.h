// The rules of a scene image that need integers only: header, sections, sizes of grid and tree, counts of the effects.
// open_scene_image, firmware and simulator use them from here. core/SPEC.md is the text form. Memory:
// borrowed. Threads: any; integers only. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/records.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/base/triangle_formats.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace gridiron {

// A checker reads the image and is called for every rule. It has
//   read<Record>(offset)                   the record at an offset of the image
//   require(holds, offset, field, value)   whether the rule holds, its field's offset, name in SPEC.md and value;
//                                          @returns holds
//   is_intact(header)                      whether the check value is that of the image, if it is to be checked

/// For callers that need only whether all rules hold.
struct AnyFault {
  [[nodiscard]] static constexpr bool require(bool holds, std::uint64_t, const char*, std::uint64_t = 0) {
    return holds;
  }
};

/// Returns false from a function that has a `checker` if a field of a record at `base` is wrong. The variable `record`
/// has the record's name in SPEC.md. GRIDIRON_RULE_OF names the value that is reported.
#define GRIDIRON_RULE_OF(value, holds, base, record, member)                                                           \
  if (!checker.require((holds), (base) + offsetof(std::remove_cvref_t<decltype(record)>, member), #record "." #member, \
                       (value)))                                                                                       \
  return false
#define GRIDIRON_RULE(holds, base, record, member) GRIDIRON_RULE_OF((record).member, holds, base, record, member)

[[nodiscard]] constexpr bool all_zero(const std::uint32_t* words, int count) {
  std::uint32_t any = 0;
  for (int i = 0; i < count; ++i) any |= words[i];
  return any == 0;
}

// --- Header and sections ------------------------------------------------------------------------------------------

/// The known sections by kind, and where their entries stand.
struct Sections {
  static constexpr std::uint32_t kGridCount = 4;  ///< of the grid, the first kinds: all of them or none
  static constexpr std::uint32_t kKnownCount = static_cast<std::uint32_t>(SectionKind::kEnd) - 1;
  SectionEntry entries[kKnownCount] = {};
  std::uint64_t entry_offsets[kKnownCount] = {};
  bool found[kKnownCount] = {};

  [[nodiscard]] static std::uint32_t index_of(SectionKind kind) { return static_cast<std::uint32_t>(kind) - 1; }
  [[nodiscard]] const SectionEntry& entry(SectionKind kind) const { return entries[index_of(kind)]; }
  [[nodiscard]] std::uint64_t entry_offset(SectionKind kind) const { return entry_offsets[index_of(kind)]; }
  [[nodiscard]] bool has(SectionKind kind) const { return found[index_of(kind)]; }
  [[nodiscard]] bool has_grid() const { return has(SectionKind::kGrid); }
};

/// The parts of an image that determine the sizes of all others.
struct ImageHead {
  ImageHeader header{};
  Sections sections;
  GridRecord grid{};        ///< all zero if the image has no grid
  EffectsRecord effects{};  ///< all zero if the image has none
  TreeRecord tree{};        ///< all zero if the image has no tree
};

/// @param available  bytes of memory from the image's first on.
template <class Checker>
[[nodiscard]] bool check_header(Checker& checker, std::uint64_t available, ImageHeader& header) {
  if (!checker.require(available >= sizeof(ImageHeader), 0, "image", available)) return false;
  header = checker.template read<ImageHeader>(0);
  GRIDIRON_RULE(header.magic == kImageMagic, 0, header, magic);
  GRIDIRON_RULE(header.version == kImageVersion, 0, header, version);
  GRIDIRON_RULE(
      header.image_bytes >= kLineBytes && header.image_bytes % kLineBytes == 0 && header.image_bytes <= available, 0,
      header, image_bytes);
  GRIDIRON_RULE(checker.is_intact(header), 0, header, check_value);
  GRIDIRON_RULE(header.section_count <= kMaxSectionCount, 0, header, section_count);
  const std::uint64_t table_end =
      std::uint64_t{header.section_table_offset_bytes} + std::uint64_t{header.section_count} * sizeof(SectionEntry);
  GRIDIRON_RULE(header.section_table_offset_bytes >= sizeof(ImageHeader) &&
                    header.section_table_offset_bytes % 8 == 0 && table_end <= header.image_bytes,
                0, header, section_table_offset_bytes);
  GRIDIRON_RULE(header.triangle_count >= 1, 0, header, triangle_count);
  GRIDIRON_RULE(header.vertex_count >= 3, 0, header, vertex_count);
  GRIDIRON_RULE(header.dropped_triangle_count < header.triangle_count, 0, header, dropped_triangle_count);
  GRIDIRON_RULE_OF(header.reserved[0], all_zero(header.reserved, 5), 0, header, reserved);
  return true;
}

template <class Checker>
[[nodiscard]] bool check_sections(Checker& checker, const ImageHeader& header, Sections& sections) {
  const std::uint64_t table_begin = header.section_table_offset_bytes;
  const std::uint64_t table_end = table_begin + std::uint64_t{header.section_count} * sizeof(SectionEntry);
  for (std::uint32_t i = 0; i < header.section_count; ++i) {
    const std::uint64_t place = table_begin + i * sizeof(SectionEntry);
    const auto section = checker.template read<SectionEntry>(place);

    // Inside the image, behind the header, apart from the table and from every earlier section.
    GRIDIRON_RULE(section.offset_bytes >= sizeof(ImageHeader) && section.offset_bytes % kLineBytes == 0 &&
                      section.offset_bytes <= header.image_bytes,
                  place, section, offset_bytes);
    GRIDIRON_RULE(
        section.section_bytes % kLineBytes == 0 && section.section_bytes <= header.image_bytes - section.offset_bytes,
        place, section, section_bytes);
    GRIDIRON_RULE(section.element_bytes == 0 || section.element_count <= section.section_bytes / section.element_bytes,
                  place, section, element_count);
    const std::uint64_t begin = section.offset_bytes;
    const std::uint64_t end = begin + section.section_bytes;
    GRIDIRON_RULE(begin == end || end <= table_begin || begin >= table_end, place, section, offset_bytes);
    for (std::uint32_t j = 0; j < i; ++j) {
      const auto other = checker.template read<SectionEntry>(table_begin + j * sizeof(SectionEntry));
      const bool apart = begin == end || other.section_bytes == 0 || end <= other.offset_bytes ||
                         begin >= other.offset_bytes + other.section_bytes;
      GRIDIRON_RULE(apart, place, section, offset_bytes);
    }

    // Each known kind occurs once; others are skipped.
    const std::uint32_t index = section.kind - 1;
    if (index >= Sections::kKnownCount) continue;
    GRIDIRON_RULE(!sections.found[index], place, section, kind);
    sections.found[index] = true;
    sections.entries[index] = section;
    sections.entry_offsets[index] = place;
  }
  // A grid, a tree or both.
  bool has_grid = !sections.has(SectionKind::kTree);
  for (std::uint32_t i = 0; i < Sections::kGridCount; ++i) has_grid |= sections.found[i];
  for (std::uint32_t i = 0; i < Sections::kGridCount; ++i) {
    GRIDIRON_RULE(sections.found[i] == has_grid, 0, header, section_count);
  }
  return true;
}

/// Checks that a section was found and holds that many elements of that size, so that all of them lie inside the image.
template <class Checker>
[[nodiscard]] bool check_elements(Checker& checker, const Sections& sections, SectionKind kind,
                                  std::uint64_t element_bytes, std::uint64_t element_count) {
  const SectionEntry& section = sections.entry(kind);
  const std::uint64_t place = sections.entry_offset(kind);
  GRIDIRON_RULE(section.element_bytes == element_bytes, place, section, element_bytes);
  GRIDIRON_RULE(section.element_count == element_count, place, section, element_count);
  return true;
}

// --- Grid ---------------------------------------------------------------------------------------------------------

[[nodiscard]] constexpr std::uint64_t macro_cell_total(const GridRecord& grid) {
  return std::uint64_t{grid.macro_cell_count[0]} * grid.macro_cell_count[1] * grid.macro_cell_count[2];
}

/// Checks the grid's integers, and the sections whose sizes follow from them. An image with a tree may have no grid.
template <class Checker>
[[nodiscard]] bool check_grid_sizes(Checker& checker, const Sections& sections, GridRecord& grid) {
  if (!sections.has_grid()) return true;
  if (!check_elements(checker, sections, SectionKind::kGrid, sizeof(GridRecord), 1)) return false;
  const std::uint64_t base = sections.entry(SectionKind::kGrid).offset_bytes;
  grid = checker.template read<GridRecord>(base);
  GRIDIRON_RULE(grid.macro_width >= 1 && grid.macro_width <= kMaxMacroWidth, base, grid, macro_width);
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint32_t cells = grid.cell_count[axis], macro_cells = grid.macro_cell_count[axis];
    GRIDIRON_RULE_OF(cells, cells >= 1 && cells <= kMaxCellsPerAxis, base, grid, cell_count);
    GRIDIRON_RULE_OF(macro_cells, macro_cells == (cells + grid.macro_width - 1) / grid.macro_width, base, grid,
                     macro_cell_count);
  }
  GRIDIRON_RULE(grid.cell_block_count >= 1, base, grid, cell_block_count);
  const auto format = static_cast<TriangleFormat>(grid.triangle_format);
  GRIDIRON_RULE(format == TriangleFormat::kVertices || format == TriangleFormat::kProjection ||
                    format == TriangleFormat::kLattice,
                base, grid, triangle_format);
  GRIDIRON_RULE(grid.triangle_bytes == triangle_bytes_of(format), base, grid, triangle_bytes);
  GRIDIRON_RULE(grid.cell_block_bytes == cell_block_bytes_of(format, grid.macro_width), base, grid, cell_block_bytes);
  GRIDIRON_RULE_OF(grid.reserved[0], all_zero(grid.reserved, 3), base, grid, reserved);
  // The sizes that the other sections must have, in numbers that cannot overflow: at most 2^33 macrocells.
  return check_elements(checker, sections, SectionKind::kMacroTable, sizeof(MacroTableEntry),
                        (macro_cell_total(grid) + 31) / 32) &&
         check_elements(checker, sections, SectionKind::kCellBlocks, grid.cell_block_bytes, grid.cell_block_count) &&
         check_elements(checker, sections, SectionKind::kTriangles, grid.triangle_bytes, grid.reference_count);
}

// --- Effects ------------------------------------------------------------------------------------------------------

/// Checks the counts that bound loops, queues and addresses. @param base  the record's place in the image.
template <class Checker>
[[nodiscard]] constexpr bool check_effect_counts(Checker&& checker, std::uint64_t base, const EffectsRecord& effects) {
  const std::uint32_t samples = effects.samples_per_pixel;
  GRIDIRON_RULE(effects.material_count >= 1 && effects.material_count <= kMaxMaterials, base, effects, material_count);
  GRIDIRON_RULE(effects.light_count <= kMaxLights, base, effects, light_count);
  GRIDIRON_RULE(effects.point_light_count <= effects.light_count, base, effects, point_light_count);
  GRIDIRON_RULE(effects.recursion_depth >= 1 && effects.recursion_depth <= kMaxRecursionDepth, base, effects,
                recursion_depth);
  GRIDIRON_RULE(samples == 1 || samples == 4 || samples == 16, base, effects, samples_per_pixel);
  GRIDIRON_RULE(effects.occlusion_samples <= kMaxEffectSamples, base, effects, occlusion_samples);
  GRIDIRON_RULE(effects.has_shadows <= 1, base, effects, has_shadows);
  GRIDIRON_RULE(effects.environment_width <= kMaxEnvironmentWidth, base, effects, environment_width);
  return true;
}

/// @returns the EffectBits that follow from counts of the record, a subset of kCountedEffects.
[[nodiscard]] constexpr std::uint32_t counted_effects(const EffectsRecord& effects) {
  return (effects.occlusion_samples != 0 ? kAmbientOcclusion : 0u) |
         (effects.environment_width != 0 ? kEnvironment : 0u) | (effects.samples_per_pixel > 1 ? kMultisampling : 0u);
}
inline constexpr std::uint32_t kCountedEffects = kAmbientOcclusion | kEnvironment | kMultisampling;

/// A section whose elements an EffectsRecord or TreeRecord counts and whose offset it holds: 0 if it has no elements.
struct CountedPart {
  SectionKind kind;
  std::uint64_t element_bytes, element_count, offset_bytes;
  std::uint32_t place;  ///< of offset_bytes in the record
  const char* field;    ///< its name
};

/// Calls body(CountedPart) for each of the five, empty ones too, in the order of the image, until it returns false.
template <class Body>
constexpr bool for_each_effect_part(const EffectsRecord& effects, std::uint64_t triangle_count, Body&& body) {
  const std::uint64_t blocks = effects.environment_width == 0 ? 0 : environment_blocks(effects.environment_width);
#define GRIDIRON_PART(kind, record, count, member)                                                              \
  body(CountedPart{SectionKind::kind, sizeof(record), (count), effects.member, offsetof(EffectsRecord, member), \
                   "effects." #member})
  return GRIDIRON_PART(kMaterials, MaterialRecord, effects.material_count, materials_offset_bytes) &&
         GRIDIRON_PART(kLights, LightRecord, effects.light_count, lights_offset_bytes) &&
         GRIDIRON_PART(kSurfaces, SurfaceRecord, triangle_count, surfaces_offset_bytes) &&
         GRIDIRON_PART(kNormals, NormalRecord, effects.smooth_triangle_count, normals_offset_bytes) &&
         GRIDIRON_PART(kEnvironmentMap, EnvironmentBlock, 6 * blocks * blocks, environment_offset_bytes);
#undef GRIDIRON_PART
}

/// Checks that a section is there if it has elements, at its place and of its size. @param base  the record's place.
template <class Checker>
[[nodiscard]] bool check_part(Checker& checker, const Sections& sections, std::uint64_t base, const CountedPart& part) {
  const bool wanted = part.element_count != 0;
  const bool found = sections.has(part.kind) == wanted;
  const std::uint64_t expected = wanted ? sections.entry(part.kind).offset_bytes : 0;
  return checker.require(found && part.offset_bytes == expected, base + part.place, part.field, part.offset_bytes) &&
         (!wanted || check_elements(checker, sections, part.kind, part.element_bytes, part.element_count));
}

/// Reads the record of effects, and requires exactly the sections that it counts, at the places that it names.
template <class Checker>
[[nodiscard]] bool check_effect_sizes(Checker& checker, ImageHead& head) {
  const Sections& sections = head.sections;
  if (!sections.has(SectionKind::kEffects)) {
    return for_each_effect_part(head.effects, 0, [&](const CountedPart& part) {
      const SectionEntry& section = sections.entry(part.kind);
      GRIDIRON_RULE(!sections.has(part.kind), sections.entry_offset(part.kind), section, kind);
      return true;
    });
  }
  const SectionEntry& section = sections.entry(SectionKind::kEffects);
  // Surfaces store vertices, which a projection does not have.
  GRIDIRON_RULE(head.grid.triangle_format != static_cast<std::uint32_t>(TriangleFormat::kProjection),
                sections.entry_offset(SectionKind::kEffects), section, kind);
  if (!check_elements(checker, sections, SectionKind::kEffects, sizeof(EffectsRecord), 1)) return false;
  const std::uint64_t base = section.offset_bytes;
  const EffectsRecord& effects = head.effects = checker.template read<EffectsRecord>(base);
  if (!check_effect_counts(checker, base, effects)) return false;
  GRIDIRON_RULE_OF(effects.reserved[0], all_zero(effects.reserved, 8), base, effects, reserved);
  return for_each_effect_part(effects, head.header.triangle_count,
                              [&](const CountedPart& part) { return check_part(checker, sections, base, part); });
}

// --- Tree ---------------------------------------------------------------------------------------------------------

/// Checks the counts that bound loops, stacks and addresses. @param base  the record's place in the image.
template <class Checker>
[[nodiscard]] constexpr bool check_tree_counts(Checker&& checker, std::uint64_t base, const TreeRecord& tree) {
  GRIDIRON_RULE(tree.node_count >= 1, base, tree, node_count);
  GRIDIRON_RULE(tree.triangle_count >= 1 && tree.triangle_count <= kMaxTreeTriangles, base, tree, triangle_count);
  GRIDIRON_RULE(tree.depth >= 1 && tree.depth <= kMaxTreeDepth, base, tree, depth);
  GRIDIRON_RULE(tree.leaf_triangles >= 1 && tree.leaf_triangles <= kMaxTreeLeaf, base, tree, leaf_triangles);
  const auto format = static_cast<TriangleFormat>(tree.triangle_format);
  GRIDIRON_RULE(format == TriangleFormat::kVertices || format == TriangleFormat::kLattice, base, tree, triangle_format);
  GRIDIRON_RULE(tree.triangle_bytes == triangle_bytes_of(format), base, tree, triangle_bytes);
  return true;
}

/// Calls body(CountedPart) for the triangles and the nodes, in the order of the image, until it returns false.
template <class Body>
constexpr bool for_each_tree_part(const TreeRecord& tree, Body&& body) {
  return body(CountedPart{SectionKind::kTreeTriangles, tree.triangle_bytes, tree.triangle_count,
                          tree.triangles_offset_bytes, offsetof(TreeRecord, triangles_offset_bytes),
                          "tree.triangles_offset_bytes"}) &&
         body(CountedPart{SectionKind::kTreeNodes, sizeof(TreeNode), tree.node_count, tree.nodes_offset_bytes,
                          offsetof(TreeRecord, nodes_offset_bytes), "tree.nodes_offset_bytes"});
}

/// Reads the tree's record, and requires exactly the sections that it counts, at the places that it names. An image
/// with effects has one, and one without a grid; another may.
template <class Checker>
[[nodiscard]] bool check_tree_sizes(Checker& checker, ImageHead& head) {
  const Sections& sections = head.sections;
  const ImageHeader& header = head.header;
  if (!sections.has(SectionKind::kTree)) {
    GRIDIRON_RULE(!sections.has(SectionKind::kEffects), 0, header, section_count);
    constexpr SectionKind kKinds[] = {SectionKind::kTreeNodes, SectionKind::kTreeTriangles};
    for (const SectionKind kind : kKinds) {
      const SectionEntry& section = sections.entry(kind);
      GRIDIRON_RULE(!sections.has(kind), sections.entry_offset(kind), section, kind);
    }
    return true;
  }
  if (!check_elements(checker, sections, SectionKind::kTree, sizeof(TreeRecord), 1)) return false;
  const std::uint64_t base = sections.entry(SectionKind::kTree).offset_bytes;
  const TreeRecord& tree = head.tree = checker.template read<TreeRecord>(base);
  if (!check_tree_counts(checker, base, tree)) return false;
  GRIDIRON_RULE(tree.triangle_count == header.triangle_count - header.dropped_triangle_count, base, tree,
                triangle_count);
  GRIDIRON_RULE(!sections.has_grid() || tree.triangle_format == head.grid.triangle_format, base, tree, triangle_format);
  GRIDIRON_RULE_OF(tree.reserved[0], all_zero(tree.reserved, 12), base, tree, reserved);
  return for_each_tree_part(tree, [&](const CountedPart& part) { return check_part(checker, sections, base, part); });
}

/// All of the above.
template <class Checker>
[[nodiscard]] bool check_image_head(Checker& checker, std::uint64_t available, ImageHead& head) {
  return check_header(checker, available, head.header) && check_sections(checker, head.header, head.sections) &&
         check_grid_sizes(checker, head.sections, head.grid) && check_effect_sizes(checker, head) &&
         check_tree_sizes(checker, head);
}

}  // namespace gridiron
