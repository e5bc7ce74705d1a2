// Compiled with -Dgridiron=gridiron_cell, its header before the Cell's numbers. SPDX-License-Identifier: Apache-2.0
#include "numeric/hard_cases/cell_numbers.h"

#include <cstring>

#include "numeric/hard_cases/full_grid_walk.h"

namespace hard_cell {

std::vector<std::uint64_t> visited_cells(const unsigned char* grid_bytes, const HostVector& origin,
                                         const HostVector& dir, std::uint64_t& steps) {
  using namespace gridiron;
  GridRecord grid;
  std::memcpy(static_cast<void*>(&grid), grid_bytes, sizeof grid);
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
    walk_full_grid(grid, frustum, work, [&](const std::uint32_t* cell) { cells.push_back(full_grid_id(grid, cell)); });
  }
  steps = work[GridWork::kMacroCellStep] + work[GridWork::kCellStep];
  return cells;
}

}  // namespace hard_cell
