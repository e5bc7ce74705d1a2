// Where the parts of a scene image lie, and which macrocell a cell belongs to. Shared by counting and building.
// Internal header. Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/image_rules.h>
#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/base/records.h>
#include <gridiron/build/effects/effect_sections.h>
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/build/grid/grid_resolution.h>
#include <gridiron/build/tree/tree_sections.h>

#include <cstdint>

namespace gridiron {

inline constexpr std::uint64_t kMaxCount = 0xFFFFFFFFu;

inline Status check_parameters(const GridParameters& parameters) {
  const bool lambda_ok = parameters.lambda >= kLeastLambda && parameters.lambda <= kGreatestLambda;
  const bool width_ok = parameters.macro_width >= 1 && parameters.macro_width <= kMaxMacroWidth;
  const bool format_ok = parameters.format == TriangleFormat::kVertices ||
                         parameters.format == TriangleFormat::kProjection ||
                         parameters.format == TriangleFormat::kLattice;
  const bool leaf_ok = parameters.leaf_triangles >= 1 && parameters.leaf_triangles <= kMaxTreeLeaf;
  return lambda_ok && width_ok && format_ok && leaf_ok ? Status::kOk : Status::kBadParameter;
}

/// Whether these can be parts of one image. Surfaces and the tree store vertices, which a projection does not have.
inline Status check_parts(const GridParameters& parameters, bool has_tree) {
  const bool parts_ok = has_tree ? parameters.format != TriangleFormat::kProjection : parameters.has_grid;
  return parts_ok ? Status::kOk : Status::kBadParameter;
}

// --- Layout -----------------------------------------------------------------------------------------------------

// Offsets of all parts; they follow from the counts, but for the end of the tree's nodes. Without a grid its parts take
// no bytes.
struct ImageLayout {
  std::uint64_t section_table_offset, grid_offset, macro_table_offset, cell_blocks_offset, triangles_offset;
  std::uint64_t macro_table_entries;
  std::uint32_t section_count;
  EffectSections effects;  // from the end of the triangles on
  TreeSections tree;       // from the end of the effects to the end of the image, with room for the most nodes
  std::uint64_t image_bytes;
};

// What an image holds.
struct ImageParts {
  const EffectsRecord* effects;  // as counted; null: none
  std::uint64_t triangle_count;  // of the input
  std::uint64_t kept_count;      // of these, those that have an area as they are stored
  const GridParameters& parameters;

  [[nodiscard]] bool has_grid() const { return parameters.has_grid; }
  [[nodiscard]] bool has_tree() const { return effects != nullptr || parameters.has_tree; }
};

inline ImageLayout layout_of(const GridRecord& grid, const ImageParts& parts) {
  constexpr std::uint64_t kLine = kLineBytes;
  ImageLayout layout{};
  layout.macro_table_entries = parts.has_grid() ? (macro_cell_total(grid) + 31) / 32 : 0;
  layout.section_table_offset = round_up<std::uint64_t>(sizeof(ImageHeader), kLine);
  layout.section_count = (parts.has_grid() ? Sections::kGridCount : 0) +
                         (parts.effects != nullptr ? effect_section_count(*parts.effects) : 0) +
                         (parts.has_tree() ? kTreeSectionCount : 0);
  layout.grid_offset = round_up(layout.section_table_offset + layout.section_count * sizeof(SectionEntry), kLine);
  layout.macro_table_offset = round_up(layout.grid_offset + (parts.has_grid() ? sizeof(GridRecord) : 0), kLine);
  layout.cell_blocks_offset =
      round_up(layout.macro_table_offset + layout.macro_table_entries * sizeof(MacroTableEntry), kLine);
  layout.triangles_offset =
      round_up(layout.cell_blocks_offset + std::uint64_t{grid.cell_block_count} * grid.cell_block_bytes, kLine);
  const std::uint64_t triangles_end =
      round_up(layout.triangles_offset + std::uint64_t{grid.reference_count} * grid.triangle_bytes, kLine);
  layout.effects.begin_bytes = triangles_end;
  layout.effects.end_bytes = triangles_end;
  if (parts.effects != nullptr) {
    layout.effects =
        place_effect_sections(*parts.effects, static_cast<std::uint32_t>(parts.triangle_count), triangles_end);
  }
  layout.tree.begin_bytes = layout.effects.end_bytes;
  layout.tree.end_bytes = layout.effects.end_bytes;
  if (parts.has_tree()) {
    layout.tree = place_tree_sections(
        static_cast<TriangleFormat>(grid.triangle_format), parts.kept_count, parts.parameters.leaf_triangles,
        parts.effects != nullptr ? TreeOrder::kForAnyHit : TreeOrder::kByNumber, layout.effects.end_bytes);
  }
  layout.image_bytes = layout.tree.end_bytes;
  return layout;
}

// --- Macrocells -------------------------------------------------------------------------------------------------

// Division of a cell coordinate by the macro width, as a multiplication: with r = ceil(2^16 / m), x r / 2^16 exceeds
// x / m by less than x / 2^16 <= 2047 / 65536 < 1 / m, too little to reach the next integer.
struct MacroMap {
  std::uint32_t reciprocal;
  std::uint32_t width;
  std::uint64_t count_x;
  std::uint64_t count_y;

  explicit MacroMap(const GridRecord& grid)
      : reciprocal((65536u + grid.macro_width - 1) / grid.macro_width),
        width(grid.macro_width),
        count_x(grid.macro_cell_count[0]),
        count_y(grid.macro_cell_count[1]) {}

  [[nodiscard]] std::uint32_t macro_of(std::int32_t cell) const {
    return (static_cast<std::uint32_t>(cell) * reciprocal) >> 16;
  }
  [[nodiscard]] std::uint64_t row_index(std::int32_t y, std::int32_t z) const {
    return (macro_of(z) * count_y + macro_of(y)) * count_x;
  }
};

// Linear macrocell index in the high bits, cell within the macrocell (less than 8^3) in the low nine.
inline constexpr std::uint32_t kCellBits = 9;
static_assert(kMaxMacroWidth * kMaxMacroWidth * kMaxMacroWidth <= (1u << kCellBits));

}  // namespace gridiron
