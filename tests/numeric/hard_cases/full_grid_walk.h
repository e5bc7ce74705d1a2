// The walks of a frustum over a grid whose every cell holds something. Compiled for the Cell's numbers as well, so it
// includes none of the tests' types. Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/engine/grid/frustum.h>
#include <gridiron/engine/grid/slice_walk.h>

#include <cstdint>
#include <vector>

namespace gridiron {

/// A macrocell table in which none is empty: block = macrocell + 1.
struct FullTable {
  [[nodiscard]] static std::uint32_t chunk_of(std::uint32_t) { return 0; }
  [[nodiscard]] static bool holds(std::uint32_t) { return true; }
  [[nodiscard]] static bool is_occupied(std::uint32_t) { return true; }
  [[nodiscard]] static std::uint32_t block_of(std::uint32_t macro_cell) { return macro_cell + 1; }
};

/// Calls visit(cell) with the three indices of each cell that the macrocell walk and the cell walk visit.
template <class Visit>
void walk_full_grid(const GridRecord& grid, const Frustum& frustum, WorkCounters& work, const Visit& visit) {
  const std::uint32_t m = grid.macro_width;
  std::vector<CellRecord> block(std::size_t{m} * m * m);
  for (std::uint32_t i = 0; i < block.size(); ++i) block[i] = {i, 1};  // a cell's first triangle: its place
  MacroWalk macro_walk{};
  macro_walk.begin(grid, frustum);
  MacroVisit macro_cell{};
  while (macro_walk.next(frustum, FullTable{}, kFloatMax, true, macro_cell, work) == WalkStep::kFound) {
    std::uint32_t corner[3];
    corner[frustum.axis_k] = static_cast<std::uint32_t>(macro_cell.k_first);
    corner[frustum.axis_u] = static_cast<std::uint32_t>(macro_cell.u_first);
    corner[frustum.axis_v] = static_cast<std::uint32_t>(macro_cell.v_first);
    CellWalk cell_walk{};
    cell_walk.begin(grid, frustum, macro_cell);
    CellVisit found{};
    while (cell_walk.next(frustum, block.data(), kFloatMax, found, work)) {
      const std::uint32_t i = found.first_triangle;
      const std::uint32_t cell[3] = {corner[0] + i % m, corner[1] + i / m % m, corner[2] + i / m / m};
      visit(cell);
    }
  }
}

/// x fastest, then y, then z.
inline std::uint64_t full_grid_id(const GridRecord& grid, const std::uint32_t cell[3]) {
  return (std::uint64_t{cell[2]} * grid.cell_count[1] + cell[1]) * grid.cell_count[0] + cell[0];
}

}  // namespace gridiron
