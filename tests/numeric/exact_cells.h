// Which cells of a grid a ray touches, exactly: the oracle of every traversal.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>

#include "numeric/oracle.h"

namespace gridiron::test {

/// x, y, z.
using CellIndex = std::array<std::int32_t, 3>;

/// What it took.
struct CellCounts {
  std::uint64_t cells = 0;
  std::uint64_t exact_orders = 0;  ///< crossings put in order by integers
  std::uint64_t exact_starts = 0;  ///< first cells found by integers
};

/// The closed cells that hold a point of the ray with t_min <= t <= t_max, those of the grid alone, each once.
///
/// Cell (x, y, z) is the closed box of GridRecord, in real numbers: a point on a face belongs to both cells, one on a
/// corner to eight. @returns them by ascending t of the first such point; those of the same t in no order that matters.
/// @param use_filter  doubles with a bound of their error first, integers where these leave it open.
/// Precondition: ray and grid finite, scales positive.
[[nodiscard]] std::vector<CellIndex> touched_cells(const GridRecord& grid, const OracleRay& ray, bool use_filter = true,
                                                   CellCounts* counts = nullptr);

}  // namespace gridiron::test
