// Memory that the master and the workers of a board share during a frame. The master clears and fills it before it
// starts a core. Afterwards each worker writes its own slot, its tiles' results and the tile counter.
// Memory: main memory that is coherent or not cached. Threads: as above. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/firmware/frame_job.h>

#include <cstdint>

namespace gridiron::port {

enum class CoreState : std::uint32_t {
  kAsleep = 0,  ///< has not begun the frame
  kWorking = 1,
  kFinished = 2,  ///< its result is complete
  kTrapped = 3,   ///< its trap is complete; it does not return
  kStarted = 4,   ///< the master wants it to work: a core that is woken otherwise goes back to sleep
};

/// The cause of a trap, in the registers of the core.
struct Trap {
  std::uint64_t cause;    ///< RISC-V mcause, AArch64 ESR
  std::uint64_t address;  ///< that the access was to: mtval, FAR
  std::uint64_t pc;       ///< of the instruction
};

struct alignas(64) CoreSlot {
  std::uint32_t state;  ///< CoreState, stored after all else
  std::uint32_t tiles_done;
  Trap trap;
  CoreResult result;
};

struct alignas(64) RunControl {
  std::uint32_t next_tile;
  std::uint32_t tile_count;
  std::uint32_t stop;  ///< 1 ends the frame between tiles
  std::uint32_t core_count;
  std::uint64_t frame_address;
  std::uint64_t spill_address;  ///< memory for rays that wait, 0: none
  std::uint64_t spill_bytes;    ///< of each core
  CoreSlot cores[kMostBoardCores];
};

[[nodiscard]] inline CoreState state_of(const CoreSlot& slot) {
  return static_cast<CoreState>(__atomic_load_n(&slot.state, __ATOMIC_ACQUIRE));
}
inline void set_state(CoreSlot& slot, CoreState state) {
  __atomic_store_n(&slot.state, static_cast<std::uint32_t>(state), __ATOMIC_RELEASE);
}

/// The part of a Board (template_port.h) that all boards share: tiles by an atomic counter in shared memory.
class SharedTiles {
 public:
  explicit SharedTiles(RunControl& control) : control_(control) {}

  [[nodiscard]] std::uint32_t next_tile() {
    return __atomic_fetch_add(&control_.next_tile, std::uint32_t{1}, __ATOMIC_RELAXED);
  }
  [[nodiscard]] bool must_stop() { return __atomic_load_n(&control_.stop, __ATOMIC_RELAXED) != 0; }
  [[nodiscard]] std::uint32_t tile_count() const { return control_.tile_count; }

 private:
  RunControl& control_;
};

}  // namespace gridiron::port
