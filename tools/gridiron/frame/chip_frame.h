// Chip frame: a prepared frame rendered on the simulated chip as the command line asks.
// Memory: the frame's. Threads: starts the chip's. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/sim_chip.h>

#include <cstdint>
#include <filesystem>
#include <functional>

#include "frame_memory.h"
#include "gridiron/command_line/arguments.h"

namespace gridiron::tool {

/// Renders. @param arguments  those that the frame was prepared with, threads above 0.
/// @param progress  of tiles; may be empty.
/// Errors: Failure where the frame failed, of stop_if_interrupted(), kUsage for a tile that is not there.
[[nodiscard]] sim::ChipResult render_on_chip(FrameMemory& frame, const RenderArguments& arguments,
                                             std::function<void(std::uint32_t done, std::uint32_t total)> progress);

/// Renders the frame whose FrameRecord lies at `frame`; signals end it between two tiles.
/// @param input  where the frame comes from, for messages.
/// Errors: Failure where the frame failed, of stop_if_interrupted().
[[nodiscard]] sim::ChipResult run_on_chip(sim::SimMemory& memory, MainAddress frame, sim::ChipOptions options,
                                          const std::filesystem::path& input);

/// @returns what the host has, at least 1.
[[nodiscard]] std::uint32_t host_threads();

/// Takes away threads that would find no tile. Precondition: the layout is settled.
void limit_threads(RenderArguments& arguments);

}  // namespace gridiron::tool
