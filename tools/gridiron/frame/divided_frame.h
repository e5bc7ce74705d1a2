// Divided frame: the tiles of one frame rendered by all ranks. Rank 0 has the whole picture and all traces afterwards.
// Memory: the frame's, and the traces. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/sim_chip.h>

#include <cstdint>
#include <functional>

#include "frame_memory.h"
#include "render_plan.h"

namespace gridiron::tool {

/// As render_on_chip(), by all ranks, each of which has prepared the frame. Rank r of N renders the tiles t with
/// t mod N = r. A single tile (RenderPlan::tile) is rendered by rank 0 alone.
///
/// Each call of the simulated chip renders one tile; that tiles overlap in main memory is therefore not checked. A
/// frame with waiting rays takes one thread of each rank, since the chip of a single tile has one place for them.
/// @returns on rank 0 the whole frame's result, without `transfers`; on others an empty one. Errors: Failure, and those
/// of Ranks.
[[nodiscard]] sim::ChipResult render_divided(
    FrameMemory& frame, const RenderPlan& plan,
    const std::function<void(std::uint32_t done, std::uint32_t total)>& progress);

}  // namespace gridiron::tool
