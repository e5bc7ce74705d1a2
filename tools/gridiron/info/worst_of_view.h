// Worst of a view: the bounds of a frame's tiles for its camera, and the tile that takes the most.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/replay.h>
#include <gridiron/sim/view_bound.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/stopwatch.h"

namespace gridiron::tool {

/// Bounds of all tiles of one frame, row by row.
struct WorstOfView {
  std::uint32_t tiles_x = 0, tile_width = 0;
  std::vector<double> tile_cycles;                  ///< the most of each tile, on the machine
  std::uint32_t tile = 0;                           ///< the one of most cycles
  TileBound bound{};                                ///< its
  sim::TileCycles cycles;                           ///< its
  std::uint64_t most_gets = 0, most_get_bytes = 0;  ///< of any tile
  HostSeconds seconds{};                            ///< that bounding took
};

/// Bounds the tiles of a frame. Precondition: sim::has_view_bound(). @param machine  with prices in cycles.
[[nodiscard]] WorstOfView find_worst_of_view(const sim::ViewFrame& frame, const sim::MachineProfile& machine);

/// The greatest that any tile of a frame did.
struct WorstMeasured {
  std::uint32_t tile = 0;  ///< of most cycles
  double cycles = 0;
  std::uint64_t gets = 0, get_bytes = 0;
};

/// @param timing  of `trace`, with its timeline.
[[nodiscard]] WorstMeasured find_worst_measured(const sim::FrameTrace& trace, const sim::FrameTiming& timing);

}  // namespace gridiron::tool
