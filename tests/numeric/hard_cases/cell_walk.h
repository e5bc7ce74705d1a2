// The traversal by itself: macrocell walk and cell walk over a grid whose every cell holds something, compared with the
// cells that the oracle says the rays touch.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>

#include "numeric/exact_cells.h"
#include "numeric/hard_cases/trial.h"

namespace gridiron::test::hard {

/// What walks came by.
struct WalkTally {
  std::uint64_t rays = 0;
  std::uint64_t touched = 0;  ///< cells, by the oracle
  std::uint64_t visited = 0;  ///< cells, by the walks
};

/// A grid of cells of any size, its origin at `minimum`.
GridRecord grid_of(Vec3 minimum, Vec3 cells_per_unit, const UVec3& cell_count, std::uint32_t macro_width);

/// Takes every ray through the grid alone and, in a picture, beside its neighbours in packets of 16 and 64. Each
/// cell touched has to be visited; each cell visited is one of the grid, visited once. What is not so fails the running
/// test.
WalkTally walk(const GridRecord& grid, const std::vector<Rays>& all_rays);

}  // namespace gridiron::test::hard
