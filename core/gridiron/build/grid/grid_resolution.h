// How many cells a grid has and how world space maps to them, for the builder and for the checks of an image.
// Source: Cho, Kim, Han 2012, Eq. (1). Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>

#include <cstdint>

namespace gridiron {

inline constexpr float kLeastLambda = 1e-6f;
inline constexpr float kGreatestLambda = 1e6f;

/// Completes a grid: minimum, cells_per_unit, cell_count and macro_cell_count follow from the rest.
///
/// @param grid            bounds_minimum, bounds_maximum, lambda and macro_width, within their ranges.
/// @param triangle_count  n of Eq. (1), at least 1.
void resolve_grid(std::uint64_t triangle_count, GridRecord& grid);

/// Completes the grid of an image without one: a cell over the bounds that holds nothing. Its other fields are those of
/// the tree. Lights and rays of ambient occlusion have the limits that they have beside a grid of one cell.
///
/// @param grid  bounds, lattice, triangle_format and triangle_bytes.
void resolve_empty_grid(GridRecord& grid);

/// @returns whether the grid is one cell: no smaller lambda makes it coarser.
[[nodiscard]] constexpr bool has_one_cell(const GridRecord& grid) {
  return grid.cell_count[0] == 1 && grid.cell_count[1] == 1 && grid.cell_count[2] == 1;
}

}  // namespace gridiron
