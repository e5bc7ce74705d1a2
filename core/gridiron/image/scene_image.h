// Validation of a scene image and access to its parts. The byte layout is in base/records.h and core/SPEC.md.
// Memory: borrowed. Threads: read-only; those that share the work. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/image_rules.h>
#include <gridiron/build/work_sharing.h>
#include <gridiron/platform/status.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace gridiron {

/// A validated scene image: header, grid, effects, tree and where each section lies. Offsets count from the
/// image's first byte.
struct SceneImageView {
  ImageHeader header;                      ///< as it stands in the image
  bool has_grid;                           ///< there is a grid, a tree, or both
  GridRecord grid;                         ///< of the image; without a grid resolve_empty_grid's, of the tree
  std::uint64_t macro_table_offset_bytes;  ///< MacroTableEntry[]; like the next two 0 without a grid
  std::uint64_t cell_blocks_offset_bytes;  ///< blocks of cells
  std::uint64_t triangles_offset_bytes;    ///< triangle records
  bool has_effects;                        ///< the scene has lights and materials
  EffectsRecord effects;                   ///< all zero where the image has none
  std::uint64_t effects_offset_bytes;      ///< of that record; 0 where the image has none
  bool has_tree;                           ///< true with effects, and without a grid
  TreeRecord tree;                         ///< all zero where the image has none
  std::uint64_t tree_offset_bytes;         ///< of that record; 0 where the image has none
};

/// The view of an image whose head is right; without a grid its `grid` is all zero.
[[nodiscard]] inline SceneImageView view_of(const ImageHead& head) {
  const auto offset_of = [&head](SectionKind kind) { return head.sections.entry(kind).offset_bytes; };
  return {head.header,
          head.sections.has_grid(),
          head.grid,
          offset_of(SectionKind::kMacroTable),
          offset_of(SectionKind::kCellBlocks),
          offset_of(SectionKind::kTriangles),
          head.sections.has(SectionKind::kEffects),
          head.effects,
          offset_of(SectionKind::kEffects),
          head.sections.has(SectionKind::kTree),
          head.tree,
          offset_of(SectionKind::kTree)};
}

/// What was wrong with an image: for the words of tools.
struct SceneImageError {
  Status status = Status::kOk;    ///< what open_scene_image returned
  std::uint64_t byte_offset = 0;  ///< place of the offending field
  const char* field = "";         ///< its name in SPEC.md
};

/// Checks every byte of an image that the kernel will rely on, once; afterwards the hot path checks nothing.
/// Sections of unknown kinds are checked for place and size only.
///
/// @param image  kLineBytes-aligned; may be longer than the image, never shorter.
/// @param view   written on success only.
/// @param sharing  threads; a grid and the sections of effects are checked by one.
/// Errors: kBadImage, with the place in `error`. Cost: linear in the image's size.
[[nodiscard]] Status open_scene_image(std::span<const std::byte> image, SceneImageView& view, SceneImageError& error,
                                      const WorkSharing& sharing = {});

/// @returns the check value (base/check_value.h) of a whole image, its own field taken as 0.
/// @param image  a multiple of 64 bytes long.
[[nodiscard]] std::uint64_t scene_image_check_value(std::span<const std::byte> image, const WorkSharing& sharing = {});

}  // namespace gridiron
