// Wrong on purpose, for an image that shows what is noticed: a core at work touches what is not its own.
// Memory: none. Threads: core 1. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>

#include <cstddef>
#include <cstdint>

#include "memory_map.h"
#include "passing_port.h"
#include "trespassing.h"

extern "C" const char master_begin[];  // zcu102.ld

namespace gridiron::port {

inline constexpr std::uint64_t kTrespassCount = 15;

/// What core 1 must not do. @param kind  1 to 11; others: nothing.
inline void trespass(std::uint64_t kind) {
  constexpr std::uint64_t kArena = kOnChipAddress + kArenaBytes;
  switch (kind) {
    case 1: load_from(kOnChipAddress); break;           // a neighbour's first word
    case 2: store_to(kArena - 4); break;                // what a stack that is too deep meets
    case 3: load_from(kArena + kArenaBytes); break;     // the first word behind its own
    case 4: store_to(kFirmwareAddress + 64); break;     // code
    case 5: load_from(reinterpret_cast<std::uintptr_t>(master_begin)); break;
    case 6: load_from(kJobAddress); break;
    case 7: load_from(kGdmaAddress); break;             // a channel that is not its own
    case 8: load_from(kApuAddress); break;
    case 9: load_from(kResetAddress); break;
    case 10: load_from(0); break;
    case 11: execute(kArena + kArenaBytes / 2); break;  // code in its own arena
    default: break;
  }
}

/// Asks for transfers with an end that is not the job's memory or the core's own: of kind 12 puts to the firmware, of
/// 13 a get from it, of 14 a get from behind main memory, of 15 puts from a neighbour's arena. Others are handed on as
/// they are.
template <Platform P>
class TrespassingPort : public PassingPort<P> {
 public:
  TrespassingPort(P& port, std::uint64_t kind) : PassingPort<P>(port), kind_(kind) {}

  Status get(void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    const bool is_tenth = ++gets_ == 10;
    if (kind_ == 13 && is_tenth) address.value = kFirmwareAddress + address.value % 4096;
    if (kind_ == 14 && is_tenth) address.value = kMainMemoryEnd + address.value % 4096;
    return PassingPort<P>::get(local, address, bytes, tag);
  }
  Status put(const void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    if (kind_ == 12) address.value = kFirmwareAddress + address.value % 4096;
    if (kind_ == 15) local = static_cast<const std::byte*>(local) - kArenaBytes;
    return PassingPort<P>::put(local, address, bytes, tag);
  }

 private:
  std::uint64_t kind_;
  std::uint32_t gets_ = 0;
};

}  // namespace gridiron::port
