// Slots in which a worker leaves its transfers for the master, in the image whose master is the engine.
// Memory: shared. Threads: a slot belongs to the worker while it is free or done, else to the master.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron::port {

struct TransferSlot {
  std::uint32_t is_pending;  ///< the worker sets it to 1; the master sets it to 0 when the bytes have moved
  std::uint32_t bytes;
  std::uint64_t target;
  std::uint64_t source;
};

inline constexpr std::uint32_t kDeskSlots = 16;

struct TransferDesk {
  TransferSlot slots[kDeskSlots];
};

}  // namespace gridiron::port
