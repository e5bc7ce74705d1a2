// The engine behind DeskPort: the master moves the workers' bytes, each transfer after a random delay.
// Memory: a delay for each slot. Threads: the master, integers only. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>

#include "transfer_desk.h"

namespace gridiron::port {

/// @tparam kDesks  workers.
template <std::uint32_t kDesks>
class DeskEngine {
 public:
  /// The most rounds that a transfer waits; half of them wait less than an eighth of that.
  static constexpr std::uint32_t kLongestDelay = 256;

  DeskEngine(TransferDesk (&desks)[kDesks], std::uint64_t seed)
      : desks_(desks), random_(seed * 0x9E3779B97F4A7C15u + 0x2545F4914F6CDD1Du) {
    std::memset(&desks, 0, sizeof desks);
  }

  /// Looks at every slot once: completes those that have waited long enough.
  /// @param wake  called with the desk of each completed transfer.
  /// @returns whether any transfer was pending.
  template <class Wake>
  bool run_round(Wake&& wake) {
    bool is_active = false;
    for (std::uint32_t desk = 0; desk < kDesks; ++desk) {
      for (std::uint32_t i = 0; i < kDeskSlots; ++i) {
        TransferSlot& slot = desks_[desk].slots[i];
        if (__atomic_load_n(&slot.is_pending, __ATOMIC_ACQUIRE) == 0) continue;
        is_active = true;
        std::uint32_t& rounds = rounds_[desk][i];
        if (rounds == 0) rounds = 1 + next_delay();
        if (--rounds != 0) continue;
        std::memcpy(reinterpret_cast<void*>(slot.target), reinterpret_cast<const void*>(slot.source), slot.bytes);
        __atomic_store_n(&slot.is_pending, std::uint32_t{0}, __ATOMIC_RELEASE);
        ++done_;
        wake(desk);
      }
    }
    return is_active;
  }

  [[nodiscard]] std::uint64_t done() const { return done_; }

 private:
  // Source of the generator: Marsaglia 2003, Xorshift RNGs.
  std::uint32_t next_delay() {
    random_ ^= random_ << 13;
    random_ ^= random_ >> 7;
    random_ ^= random_ << 17;
    const auto chance = static_cast<std::uint32_t>(random_ >> 32);
    const std::uint32_t most = (chance & 1) != 0 ? kLongestDelay : kLongestDelay / 8;
    return (chance >> 1) % most;
  }

  TransferDesk (&desks_)[kDesks];
  std::uint32_t rounds_[kDesks][kDeskSlots] = {};
  std::uint64_t random_;
  std::uint64_t done_ = 0;
};

}  // namespace gridiron::port
