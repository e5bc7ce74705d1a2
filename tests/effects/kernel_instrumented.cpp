// Frames of the kernel's tests by the instrumented kernel. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/sim_chip.h>
#include <gridiron/sim/sim_memory.h>

#include "effects/kernel_scene.h"
#include "support/instrumented.h"

namespace gridiron::test {

std::string instrumented_violation(const KernelFrame& frame, const KernelLayout& kernel, const KernelOptions& options) {
  if (!is_instrumented() || !kernel.has_effects || options.shading != Shading::kScene) return {};
  const sim::StoreSize store = kernel.arena_bytes == sim::arena_bytes(sim::StoreSize::k64KB) ? sim::StoreSize::k64KB
                                                                                             : sim::StoreSize::k256KB;
  const sim::LayoutChoice layout{store, kernel.tile_width, kernel.packet_width, true};
  if (!sim::is_built(layout, sim::Mode::kInstrumented, 4)) return {};
  // Addresses stay as they are: both memories begin at the same one.
  static_assert(sim::SimMemory::kFirstAddress == 4096);
  const std::uint64_t bytes = frame.memory.size() - 3 * sim::SimMemory::kFirstAddress;
  sim::SimMemory memory(bytes);
  const auto region = memory.allocate(bytes, sim::SimMemory::kFirstAddress);
  if (!region || region->address.value != sim::SimMemory::kFirstAddress) return "instrumented: no memory";
  std::copy_n(kernel_memory(frame) + sim::SimMemory::kFirstAddress, bytes, region->bytes.data());
  sim::ChipOptions chip{.mode = sim::Mode::kInstrumented,
                        .store = store,
                        .packet_width = kernel.packet_width,
                        .completion = options.moves_late ? sim::Completion::kLate : sim::Completion::kEarly};
  chip.limits.queue_depth = options.queue_depth;
  chip.spill = {frame.spill.address, frame.spill.bytes};
  const sim::ChipResult result = sim::render_frame(memory, MainAddress{frame.frame_address}, chip);
  note_instrumented_frame();
  if (!result.violations.empty()) return "instrumented: " + result.violations.front().detail;
  return result.status == Status::kOk ? "" : "instrumented: status " + std::to_string(static_cast<int>(result.status));
}

}  // namespace gridiron::test
