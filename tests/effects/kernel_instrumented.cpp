// Frames of the kernel's tests by the instrumented kernel. SPDX-License-Identifier: Apache-2.0
#include "effects/kernel_chip.h"
#include "support/instrumented.h"

namespace gridiron::test {

std::string instrumented_violation(const KernelFrame& frame, const KernelLayout& kernel, const KernelOptions& options) {
  if (!is_instrumented() || !kernel.has_effects || options.shading != Shading::kScene) return {};
  const sim::StoreSize store = kernel.arena_bytes == sim::arena_bytes(sim::StoreSize::k64KB) ? sim::StoreSize::k64KB
                                                                                             : sim::StoreSize::k256KB;
  const sim::LayoutChoice layout{store, kernel.tile_width, kernel.packet_width, true};
  if (!sim::is_built(layout, sim::Mode::kInstrumented, 4)) return {};
  const std::unique_ptr<sim::SimMemory> memory = chip_memory(frame);
  if (memory == nullptr) return "instrumented: no memory";
  sim::ChipOptions chip{.mode = sim::Mode::kInstrumented,
                        .store = store,
                        .packet_width = kernel.packet_width,
                        .completion = options.moves_late ? sim::Completion::kLate : sim::Completion::kEarly};
  chip.limits.queue_depth = options.queue_depth;
  chip.spill = {frame.spill.address, frame.spill.bytes};
  const sim::ChipResult result = sim::render_frame(*memory, MainAddress{frame.frame_address}, chip);
  note_instrumented_frame();
  if (!result.violations.empty()) return "instrumented: " + result.violations.front().detail;
  return result.status == Status::kOk ? "" : "instrumented: status " + std::to_string(static_cast<int>(result.status));
}

}  // namespace gridiron::test
