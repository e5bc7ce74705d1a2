// Compiled with -Dgridiron=gridiron_cell, its header before the Cell's numbers. SPDX-License-Identifier: Apache-2.0
#include "numeric/hard_cases/cell_numbers.h"

#include <gridiron/engine/grid/frustum.h>
#include <gridiron/engine/grid/slice_walk.h>

#include <cstring>

namespace gridiron {
namespace {

// No macrocell is empty.
struct FullTable {
  [[nodiscard]] static std::uint32_t chunk_of(std::uint32_t) { return 0; }
  [[nodiscard]] static bool holds(std::uint32_t) { return true; }
  [[nodiscard]] static std::uint32_t block_of(std::uint32_t macro_cell) { return macro_cell + 1; }
};

}  // namespace
}  // namespace gridiron

namespace hard_cell {

std::vector<std::uint64_t> visited_cells(const unsigned char* grid_bytes, const HostVector& origin,
                                         const HostVector& dir, std::uint64_t& steps) {
  using namespace gridiron;
  GridRecord grid;
  std::memcpy(static_cast<void*>(&grid), grid_bytes, sizeof grid);
  const std::uint32_t m = grid.macro_width;
  std::vector<CellRecord> block(std::size_t{m} * m * m);
  for (std::uint32_t i = 0; i < block.size(); ++i) block[i] = {i, 1};
  auto packet = Packet<4>{};
  for (int axis = 0; axis < 3; ++axis) {
    packet.dir[axis][0] = dir[axis];
    packet.origin[axis] = origin[axis];
  }
  packet.is_linear = false;
  RaySet<Packet<4>::kRayCount> waiting;
  waiting.clear();
  waiting.insert(0);
  std::vector<std::uint64_t> cells;
  Frustum frustum;
  WorkCounters work;
  while (take_pass<Lanes<4>>(grid, waiting, packet, frustum, work)) {
    if (!packet.active.contains(0)) continue;
    MacroWalk macro_walk{};
    macro_walk.begin(grid, frustum);
    MacroVisit visit{};
    while (macro_walk.next(frustum, FullTable{}, kFloatMax, true, visit, work) == WalkStep::kFound) {
      std::uint32_t corner[3];
      corner[frustum.axis_k] = static_cast<std::uint32_t>(visit.k_first);
      corner[frustum.axis_u] = static_cast<std::uint32_t>(visit.u_first);
      corner[frustum.axis_v] = static_cast<std::uint32_t>(visit.v_first);
      CellWalk cell_walk{};
      cell_walk.begin(grid, frustum, visit);
      CellVisit found{};
      while (cell_walk.next(frustum, block.data(), kFloatMax, found, work)) {
        const std::uint32_t i = found.first_triangle;
        const std::uint64_t x = corner[0] + i % m, y = corner[1] + i / m % m, z = corner[2] + i / m / m;
        cells.push_back((z * grid.cell_count[1] + y) * grid.cell_count[0] + x);
      }
    }
  }
  steps = work[GridWork::kMacroCellStep] + work[GridWork::kCellStep];
  return cells;
}

}  // namespace hard_cell
