// Divided frame: the tiles of one frame rendered by all ranks. Rank 0 has the whole picture and its time afterwards.
// Memory: the frame's, and traces. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/replay.h>
#include <gridiron/sim/sim_chip.h>

#include <cstdint>
#include <functional>
#include <optional>

#include "frame_memory.h"
#include "render_plan.h"

namespace gridiron::tool {

/// A frame as rank 0 has it; on others it is empty.
struct DividedFrame {
  sim::ChipResult chip;                    ///< `transfers` only where there is one rank
  std::uint64_t trace_bytes = 0;           ///< FrameTrace::packed_bytes() of all traces
  std::optional<sim::FrameTiming> timing;  ///< where the traces were replayed as they came, and are gone
};

/// As render_on_chip(), by all ranks, each of which has prepared the frame. Pieces (piece_of_rank()) are claims of
/// tiles. A single tile (RenderPlan::tile) is rendered by rank 0 alone.
///
/// A rank renders and sends as many tiles at a time as take it kSecondsAtOnce, but no more than kTilesAtOnce. That
/// tiles of several such parts overlap in main memory is not checked.
/// @param replay  where there are several ranks: the plan's machine replays traces as they come, with these options.
///                null: they are kept. Errors: Failure, and those of Ranks.
[[nodiscard]] DividedFrame render_divided(FrameMemory& frame, const RenderPlan& plan, const sim::ReplayOptions* replay,
                                          const std::function<void(std::uint32_t done, std::uint32_t total)>& progress);
inline constexpr std::uint32_t kTilesAtOnce = 256;
inline constexpr double kSecondsAtOnce = 2;

}  // namespace gridiron::tool
