// The Board of this chip: one channel of its DMA engine, PDMA, for each worker.
// Source: SiFive FU540-C000 Manual, chapter 12. Memory: registers of the worker's own channel. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "memory_map.h"
#include "run_control.h"
#include "shared_memory.h"
#include "template_port.h"

namespace gridiron::port {

class PdmaBoard : public SharedTiles {
 public:
  /// @param store        in the worker's arena, the only local memory that transfers may touch.
  PdmaBoard(RunControl& control, std::uint32_t core_index, const void* store, std::uint64_t store_bytes)
      : SharedTiles(control),
        channel_(GRIDIRON_PDMA + std::uint64_t{core_index} * 0x1000),
        local_base_(reinterpret_cast<std::uintptr_t>(store)),
        local_bytes_(store_bytes) {}

  void start(const EngineCommand& command) {
    register_at(channel_ + kControl) = 0;
    register_at(channel_ + kControl) = kClaim;  // alone: it resets what follows
    const std::uint32_t log_bytes = burst_of(command);
    register_at(channel_ + kConfig) = log_bytes << 28 | log_bytes << 24;
    wide_register_at(channel_ + kBytes) = command.bytes;
    wide_register_at(channel_ + kTarget) = command.target;
    wide_register_at(channel_ + kSource) = command.source;
    // All stores of the core, and the ones above, come before the one that starts the engine.
    asm volatile("fence" ::: "memory");
    register_at(channel_ + kControl) = kClaim | kRun;
  }
  [[nodiscard]] bool is_busy() { return (register_at(channel_ + kControl) & (kDone | kError)) == 0; }
  [[nodiscard]] bool has_failed() {
    const bool failed = (register_at(channel_ + kControl) & kError) != 0;
    // Loads of the data come after the load that reported it.
    asm volatile("fence" ::: "memory");
    return failed;
  }
  [[nodiscard]] std::uint64_t bus_address(const void* local) const { return reinterpret_cast<std::uintptr_t>(local); }
  [[nodiscard]] bool holds(const void* local, std::uint32_t bytes) const {
    const std::uint64_t offset = bus_address(local) - local_base_;
    return offset <= local_bytes_ && bytes <= local_bytes_ - offset;
  }
  // The chip keeps caches coherent with its engine; start() and has_failed() hold the fences.
  void write_back(const void*, std::uint32_t) {}
  void discard(const void*, std::uint32_t) {}

 private:
  static constexpr std::uint64_t kControl = 0x00, kConfig = 0x04, kBytes = 0x08, kTarget = 0x10, kSource = 0x18;
  static constexpr std::uint32_t kClaim = 1u << 0, kRun = 1u << 1, kDone = 1u << 30, kError = 1u << 31;

  // Bytes of one bus transaction, as a power of two: at most 64, and a divisor of both addresses and the size, since
  // the manual does not define unaligned transactions.
  [[nodiscard]] static std::uint32_t burst_of(const EngineCommand& command) {
    const std::uint64_t bits = command.target | command.source | command.bytes;
    if (bits % 64 == 0) return 6;
    return bits % 32 == 0 ? 5 : 4;
  }

  std::uint64_t channel_;
  std::uint64_t local_base_;
  std::uint64_t local_bytes_;
};

static_assert(Board<PdmaBoard>);
static_assert(Platform<TemplatePort<PdmaBoard>>);

}  // namespace gridiron::port
