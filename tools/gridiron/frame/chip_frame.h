// Chip frame: a prepared frame rendered on the simulated chip as the command line asks.
// Memory: the frame's. Threads: starts the chip's. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/sim_chip.h>

#include <cstdint>
#include <filesystem>
#include <functional>

#include "frame_memory.h"

namespace gridiron::tool {

/// Renders. @param plan  the one that the frame was prepared with.
/// @param progress  of tiles; may be empty.
/// Errors: Failure where the frame failed, of stop_if_interrupted(), kUsage for a tile that is not there.
[[nodiscard]] sim::ChipResult render_on_chip(FrameMemory& frame, const RenderPlan& plan,
                                             std::function<void(std::uint32_t done, std::uint32_t total)> progress);

/// Renders the frame whose FrameRecord lies at `frame`; signals end it between two tiles.
/// @param input  where the frame comes from, for messages.
/// Errors: Failure where the frame failed, of stop_if_interrupted().
[[nodiscard]] sim::ChipResult run_on_chip(sim::SimMemory& memory, MainAddress frame, sim::ChipOptions options,
                                          const std::filesystem::path& input);

}  // namespace gridiron::tool
