// Chip frame: renders a prepared frame on the simulated chip with the options of the command line.
// Memory: the frame's. Threads: starts the chip's. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/sim_chip.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

#include "frame_memory.h"

namespace gridiron::tool {

/// @param plan  the one that the frame was prepared with. @param progress  of tiles; may be empty.
/// Errors: Failure if the frame failed, of stop_if_interrupted(), kUsage for a tile outside of the frame.
[[nodiscard]] sim::ChipResult render_on_chip(FrameMemory& frame, const RenderPlan& plan,
                                             std::function<void(std::uint32_t done, std::uint32_t total)> progress);

/// The same of some tiles. @param tiles  rising numbers; RenderPlan::tile is not looked at.
[[nodiscard]] sim::ChipResult render_tiles_on_chip(
    FrameMemory& frame, const RenderPlan& plan, std::span<const std::uint32_t> tiles,
    std::function<void(std::uint32_t done, std::uint32_t total)> progress);

/// Renders the frame whose FrameRecord lies at `frame`; signals end it between two tiles.
/// @param input  source of the frame, for messages.
/// Errors: Failure if the frame failed, of stop_if_interrupted().
[[nodiscard]] sim::ChipResult run_on_chip(sim::SimMemory& memory, MainAddress frame, sim::ChipOptions options,
                                          const std::filesystem::path& input);

}  // namespace gridiron::tool
