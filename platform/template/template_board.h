// A made-up chip, as an example of a Board: memory-mapped engine, no caches in front of local memory.
// Memory: registers at fixed addresses. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>
#include <gridiron/store/local_store.h>

#include <cstdint>

#include "template_port.h"

namespace gridiron::port {

/// Registers of the engine. Each core has its own engine.
struct EngineRegisters {
  std::uint64_t target;
  std::uint64_t source;
  std::uint32_t bytes;
  std::uint32_t control;  ///< write kRun to start
  std::uint32_t status;   ///< kBusy, kError
};

/// Memory that all cores share: uncached, or kept coherent.
struct FrameControl {
  std::uint32_t next_tile;  ///< set to 0 by the host before the frame
  std::uint32_t tile_count;
  std::uint32_t stop;  ///< set by the host to end the frame between tiles
  std::uint32_t core_count;      ///< cores that take part
  std::uint64_t spill_address;   ///< memory for rays that wait, a multiple of kSpillAlignment; 0 without effects
  std::uint64_t spill_bytes;     ///< of each core, one after the other; spill_bytes(recursion_depth) of the scene
};

/// Replace the addresses, bits and bodies by those of your chip.
class TemplateBoard {
 public:
  static constexpr std::uint32_t kRun = 1u << 0;
  static constexpr std::uint32_t kBusy = 1u << 0;
  static constexpr std::uint32_t kError = 1u << 1;

  /// @param local_base  bus address of the core's local memory, `local_bytes` long.
  TemplateBoard(volatile EngineRegisters* engine, FrameControl* control, std::uint64_t local_base,
                std::uint64_t local_bytes)
      : engine_(engine), control_(control), local_base_(local_base), local_bytes_(local_bytes) {}

  void start(const EngineCommand& command) {
    engine_->target = command.target;
    engine_->source = command.source;
    engine_->bytes = command.bytes;
    // All stores of the core, and the three above, come before the one that starts the engine.
    __atomic_thread_fence(__ATOMIC_SEQ_CST);
    engine_->control = kRun;
  }
  [[nodiscard]] bool is_busy() { return (engine_->status & kBusy) != 0; }
  [[nodiscard]] bool has_failed() {
    // Loads of the data come after the load that reported it.
    __atomic_thread_fence(__ATOMIC_SEQ_CST);
    return (engine_->status & kError) != 0;
  }
  [[nodiscard]] std::uint64_t bus_address(const void* local) const { return reinterpret_cast<std::uintptr_t>(local); }
  [[nodiscard]] bool holds(const void* local, std::uint32_t bytes) const {
    const std::uint64_t offset = bus_address(local) - local_base_;
    return offset <= local_bytes_ && bytes <= local_bytes_ - offset;
  }
  // Local memory has no cache on this chip; start() and has_failed() contain the fences.
  void write_back(const void*, std::uint32_t) {}
  void discard(const void*, std::uint32_t) {}

  [[nodiscard]] std::uint32_t next_tile() {
    return __atomic_fetch_add(&control_->next_tile, std::uint32_t{1}, __ATOMIC_RELAXED);
  }
  [[nodiscard]] bool must_stop() { return __atomic_load_n(&control_->stop, __ATOMIC_RELAXED) != 0; }
  [[nodiscard]] std::uint32_t tile_count() const { return control_->tile_count; }

  /// The core's part of the memory for rays that wait; only frames with effects need it. A core outside of core_count
  /// has none.
  [[nodiscard]] SpillRegion spill_region(std::uint32_t core_index) const {
    if (core_index >= control_->core_count) return {};
    return {MainAddress{control_->spill_address + std::uint64_t{core_index} * control_->spill_bytes},
            control_->spill_bytes};
  }

 private:
  volatile EngineRegisters* engine_;
  FrameControl* control_;
  std::uint64_t local_base_;
  std::uint64_t local_bytes_;
};

static_assert(Board<TemplateBoard>);
static_assert(Platform<TemplatePort<TemplateBoard>>);

}  // namespace gridiron::port
