// Runs small hand-written programs on the cores of the simulated chip: what rule tests share.
// Memory: owns main memory. Threads: one caller. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/core_runner.h>
#include <gridiron/sim/sim_core.h>
#include <gridiron/sim/sim_memory.h>

#include "support/test_headers.h"

namespace gridiron::sim {

/// Main memory in two parts, one to read and one to write, and a chip with 8 KB of data per core.
class ProgramBench {
 public:
  static constexpr std::uint32_t kPartBytes = 64 * 1024;
  static constexpr std::uint32_t kDataBytes = 32 * 1024;

  ProgramBench() : memory_(std::uint64_t{1} << 20) {
    input_ = *memory_.allocate(kPartBytes, 4096);
    output_ = *memory_.allocate(kPartBytes, 4096);
    for (std::uint32_t i = 0; i < kPartBytes; ++i) input_.bytes[i] = input_byte(i);
    shape.tile_count = 1;
    shape.arena_bytes = 64 * 1024;
    shape.data_bytes = kDataBytes;
    shape.writable = {{output_.address.value, output_.address.value + kPartBytes}};
  }

  [[nodiscard]] static std::byte input_byte(std::uint32_t i) {
    return static_cast<std::byte>((i * 13 + i / 256) & 0xFF);
  }
  [[nodiscard]] MainAddress input(std::uint64_t offset = 0) const { return input_.address.offset_by(offset); }
  [[nodiscard]] MainAddress output(std::uint64_t offset = 0) const { return output_.address.offset_by(offset); }
  [[nodiscard]] std::span<std::byte> output_bytes() const { return output_.bytes; }
  [[nodiscard]] SimMemory& memory() { return memory_; }

  [[nodiscard]] ChipResult run(const CoreProgram& program) { return run_cores(memory_, shape, options, program); }

  FrameShape shape{kGridEngine};
  ChipOptions options;

 private:
  SimMemory memory_;
  MemoryRegion input_, output_;
};

/// Claims tiles and calls act(tile_id) -> Status for each, until there is none or one is no kOk.
template <class Act>
Status for_each_tile(SimCore& core, Act&& act) {
  for (;;) {
    const ItemClaim claim = core.claim_item();
    if (claim.kind == ItemClaim::Kind::kAborted) return Status::kAborted;
    if (claim.kind != ItemClaim::Kind::kItem) return Status::kOk;
    GRIDIRON_TRY(act(claim.item));
  }
}

/// @returns the violations of a result in words, for messages.
inline std::string words(const ChipResult& result) {
  std::string text = "status " + std::to_string(static_cast<int>(result.status));
  for (const Violation& v : result.violations) {
    text += "\n  rule " + std::to_string(static_cast<int>(v.rule)) + " core " + std::to_string(v.core) + " tile " +
            std::to_string(v.tile_id) + ": " + v.detail;
  }
  return text;
}

}  // namespace gridiron::sim
