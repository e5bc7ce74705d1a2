// Wrong on purpose, for an image that must fail: a worker core touches memory of others.
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

/// Makes a forbidden access of core 1. @param kind  1 to 11; others: nothing.
inline void trespass(std::uint64_t kind) {
  constexpr std::uint64_t kArena = kOnChipAddress + kArenaBytes;
  switch (kind) {
    case 1: load_from(kOnChipAddress); break;           // a neighbour's first word
    case 2: store_to(kArena - 4); break;                // where a stack that is too deep would write
    case 3: load_from(kArena + kArenaBytes); break;     // the first word after its own
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

/// Starts forbidden transfers: with kind 12 puts to the firmware, with 13 a get from it, with 14 a get from beyond main
/// memory, with 15 puts from a neighbour's arena. Other transfers are passed on unchanged.
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
