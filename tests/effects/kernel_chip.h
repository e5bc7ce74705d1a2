// Frames of the kernel's tests on the simulated chip: with its kernels, modes and lanes.
// Memory: owns the simulated main memory. Threads: one caller. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/sim_chip.h>
#include <gridiron/sim/sim_memory.h>

#include <memory>

#include "effects/kernel_scene.h"

namespace gridiron::test {

/// @returns a chip's main memory that holds the frame at the same addresses; null where the host has none.
[[nodiscard]] std::unique_ptr<sim::SimMemory> chip_memory(const KernelFrame& frame);

/// Renders a scene in tiles of 32x32. options.moves_late and options.queue_depth are not looked at: `chip` says when
/// bytes move and how long the queue is. The regions of waiting rays are set here.
[[nodiscard]] KernelPicture render_on_chip(KernelScene& scene, const Camera& camera, std::uint32_t width,
                                           std::uint32_t height, const KernelOptions& options, sim::ChipOptions chip);

}  // namespace gridiron::test
