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

#include <cstdint>

namespace gridiron {

inline constexpr std::uint64_t kMaxCount = 0xFFFFFFFFu;
inline constexpr std::uint32_t kSectionCount = 4;  ///< of geometry

inline Status check_parameters(const GridParameters& parameters) {
  const bool lambda_ok = parameters.lambda >= kLeastLambda && parameters.lambda <= kGreatestLambda;
  const bool width_ok = parameters.macro_width >= 1 && parameters.macro_width <= kMaxMacroWidth;
  const bool format_ok = parameters.format == TriangleFormat::kVertices ||
                         parameters.format == TriangleFormat::kProjection ||
                         parameters.format == TriangleFormat::kLattice;
  return lambda_ok && width_ok && format_ok ? Status::kOk : Status::kBadParameter;
}

/// Surfaces store vertices, which a projection does not have.
inline bool may_have_effects(const GridParameters& parameters) {
  return parameters.format != TriangleFormat::kProjection;
}

// --- Layout -----------------------------------------------------------------------------------------------------

// Offsets of all parts; they follow from the counts.
struct ImageLayout {
  std::uint64_t section_table_offset, grid_offset, macro_table_offset, cell_blocks_offset, triangles_offset;
  std::uint64_t macro_table_entries;
  std::uint32_t section_count;
  EffectSections effects;  // from the end of the triangles to the end of the image
  std::uint64_t image_bytes;
};

// @param effects  as counted; null: none.
inline ImageLayout layout_of(const GridRecord& grid, const EffectsRecord* effects, std::uint64_t triangle_count) {
  constexpr std::uint64_t kLine = kLineBytes;
  ImageLayout layout{};
  layout.macro_table_entries = (macro_cell_total(grid) + 31) / 32;
  layout.section_table_offset = round_up<std::uint64_t>(sizeof(ImageHeader), kLine);
  layout.section_count = kSectionCount + (effects != nullptr ? effect_section_count(*effects) : 0);
  layout.grid_offset = round_up(layout.section_table_offset + layout.section_count * sizeof(SectionEntry), kLine);
  layout.macro_table_offset = round_up(layout.grid_offset + sizeof(GridRecord), kLine);
  layout.cell_blocks_offset =
      round_up(layout.macro_table_offset + layout.macro_table_entries * sizeof(MacroTableEntry), kLine);
  layout.triangles_offset =
      round_up(layout.cell_blocks_offset + std::uint64_t{grid.cell_block_count} * grid.cell_block_bytes, kLine);
  const std::uint64_t triangles_end =
      round_up(layout.triangles_offset + std::uint64_t{grid.reference_count} * grid.triangle_bytes, kLine);
  layout.effects.begin_bytes = triangles_end;
  layout.effects.end_bytes = triangles_end;
  if (effects != nullptr) {
    layout.effects = place_effect_sections(*effects, static_cast<std::uint32_t>(triangle_count), triangles_end);
  }
  layout.image_bytes = layout.effects.end_bytes;
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
