// Cell walks: see the header. SPDX-License-Identifier: Apache-2.0
#include "numeric/hard_cases/cell_walk.h"

#include "core/ray/packet_cases.h"
#include "numeric/hard_cases/full_grid_walk.h"

namespace gridiron::test::hard {
namespace {

// Cells that a frustum's walk visits, sorted.
std::vector<std::uint64_t> visited_cells(const GridRecord& grid, const Frustum& frustum) {
  std::vector<std::uint64_t> cells;
  WorkCounters work;
  walk_full_grid(grid, frustum, work, [&](const std::uint32_t* cell) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_LT(cell[axis], grid.cell_count[axis]) << "a cell beyond the grid";
    cells.push_back(full_grid_id(grid, cell));
  });
  std::sort(cells.begin(), cells.end());
  EXPECT_TRUE(std::adjacent_find(cells.begin(), cells.end()) == cells.end()) << "a cell was visited twice";
  return cells;
}

// Cells that a packet's rays touch, by the oracle.
using TouchedCells = std::vector<std::vector<std::uint64_t>>;

template <class PacketType>
void walk_packet(const GridRecord& grid, const Rays& rays, std::size_t first, const TouchedCells& touched,
                 WalkTally& tally) {
  auto packet = std::make_unique<PacketType>();
  RaySet<PacketType::kRayCount> waiting;
  waiting.clear();
  for (std::uint32_t ray = 0; ray < PacketType::kRayCount && first + ray < rays.directions.size(); ++ray) {
    for (int axis = 0; axis < 3; ++axis) packet->dir[axis][ray] = rays.directions[first + ray][axis];
    waiting.insert(ray);
  }
  for (int axis = 0; axis < 3; ++axis) packet->origin[axis] = rays.origin[axis];
  packet->is_linear = false;
  set_direction_bounds(*packet);
  Frustum frustum;
  WorkCounters work;
  while (take_pass<Lanes<4>>(grid, waiting, *packet, frustum, work)) {
    const std::vector<std::uint64_t> visited = visited_cells(grid, frustum);
    tally.visited += visited.size();
    for (std::uint32_t ray = 0; ray < PacketType::kRayCount; ++ray) {
      if (!packet->active.contains(ray)) continue;
      const std::vector<std::uint64_t>& cells = touched[first + ray];
      if (std::includes(visited.begin(), visited.end(), cells.begin(), cells.end())) continue;
      const Vec3& o = rays.origin;
      const Vec3& d = rays.directions[first + ray];
      ADD_FAILURE() << "a cell touched is not visited, packet of " << PacketType::kRayCount << ", ray from "
                    << std::hexfloat << o.x << ", " << o.y << ", " << o.z << " along " << d.x << ", " << d.y << ", "
                    << d.z;
      return;
    }
  }
}

}  // namespace

GridRecord grid_of(Vec3 minimum, Vec3 cells_per_unit, const UVec3& cell_count, std::uint32_t macro_width) {
  GridRecord grid{};
  for (int axis = 0; axis < 3; ++axis) {
    grid.minimum[axis] = minimum[axis];
    grid.cells_per_unit[axis] = cells_per_unit[axis];
    grid.cell_count[axis] = cell_count[axis];
    grid.macro_cell_count[axis] = (cell_count[axis] + macro_width - 1) / macro_width;
  }
  grid.macro_width = macro_width;
  return grid;
}

WalkTally walk(const GridRecord& grid, const std::vector<Rays>& all_rays) {
  WalkTally tally;
  for (const Rays& rays : all_rays) {
    TouchedCells touched;
    for (std::size_t ray = 0; ray < rays.directions.size(); ++ray) {
      std::vector<std::uint64_t>& cells = touched.emplace_back();
      OracleRay asked = oracle_ray(rays, ray);
      asked.t_max = kFloatMax;
      for (const CellIndex& cell : touched_cells(grid, asked)) {
        const std::uint32_t place[3] = {static_cast<std::uint32_t>(cell[0]), static_cast<std::uint32_t>(cell[1]),
                                        static_cast<std::uint32_t>(cell[2])};
        cells.push_back(full_grid_id(grid, place));
      }
      std::sort(cells.begin(), cells.end());
      tally.touched += cells.size();
      // Alone: the narrowest frustum that there is.
      Rays one{rays.origin};
      one.directions = {rays.directions[ray]};
      walk_packet<Packet<4>>(grid, one, 0, {cells}, tally);
    }
    tally.rays += rays.directions.size();
    // Side by side, but for rays of all directions: the frustum of those is the whole grid.
    for (std::size_t first = 0; rays.columns != 0 && first < touched.size(); first += 64) {
      walk_packet<Packet<8>>(grid, rays, first, touched, tally);
      for (std::size_t i = first; i < first + 64 && i < touched.size(); i += 16) {
        walk_packet<Packet<4>>(grid, rays, i, touched, tally);
      }
    }
    if (testing::Test::HasFailure()) return tally;
  }
  return tally;
}

}  // namespace gridiron::test::hard
