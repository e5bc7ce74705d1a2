// Frames of the kernel's tests on the simulated chip: see the header. SPDX-License-Identifier: Apache-2.0
#include "effects/kernel_chip.h"

#include "support/instrumented.h"

namespace gridiron::test {

std::unique_ptr<sim::SimMemory> chip_memory(const KernelFrame& frame) {
  // Addresses stay as they are: both memories begin at the same one.
  static_assert(sim::SimMemory::kFirstAddress == 4096);
  const std::uint64_t bytes = frame.memory.size() - 3 * sim::SimMemory::kFirstAddress;
  auto memory = std::make_unique<sim::SimMemory>(bytes);
  const auto region = memory->allocate(bytes, sim::SimMemory::kFirstAddress);
  if (!region || region->address.value != sim::SimMemory::kFirstAddress) return nullptr;
  std::copy_n(kernel_memory(frame) + sim::SimMemory::kFirstAddress, bytes, region->bytes.data());
  return memory;
}

KernelPicture render_on_chip(KernelScene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height,
                             const KernelOptions& options, sim::ChipOptions chip) {
  constexpr std::uint32_t kTileWidth = 32;
  KernelPicture picture;
  const KernelFrame frame = make_kernel_frame(scene, camera, width, height, kTileWidth, options);
  picture.status = frame.status;
  if (frame.status != Status::kOk) return picture;
  const std::unique_ptr<sim::SimMemory> memory = chip_memory(frame);
  if (memory == nullptr) {
    picture.status = Status::kMemoryTooSmall;
    return picture;
  }
  chip.spill = {frame.spill.address, frame.spill.bytes};
  const sim::ChipResult result = render_in_test(*memory, MainAddress{frame.frame_address}, chip);
  picture.status = result.status;
  if (!result.violations.empty()) picture.violation = result.violations.front().detail;
  read_kernel_planes(frame, memory->base(), width, height, kTileWidth, picture);
  return picture;
}

}  // namespace gridiron::test
