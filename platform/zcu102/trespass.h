// Wrong on purpose, for an image that shows what is noticed: a core at work touches what is not its own.
// Memory: none. Threads: core 1. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "memory_map.h"

extern "C" const char master_begin[];  // zcu102.ld

namespace gridiron::port {

/// What core 1 must not do. @param kind  1 to 11; others: nothing.
inline void trespass(std::uint64_t kind) {
  const auto load = [](std::uint64_t address) {
    (void)*reinterpret_cast<const volatile std::uint32_t*>(static_cast<std::uintptr_t>(address));
  };
  const auto store = [](std::uint64_t address) {
    *reinterpret_cast<volatile std::uint32_t*>(static_cast<std::uintptr_t>(address)) = 0;
  };
  constexpr std::uint64_t kArena = kOnChipAddress + kArenaBytes;
  switch (kind) {
    case 1: load(kOnChipAddress); break;                        // a neighbour's first word
    case 2: store(kArena - 4); break;                           // what a stack that is too deep meets
    case 3: load(kArena + kArenaBytes); break;                  // the first word behind its own
    case 4: store(kFirmwareAddress + 64); break;                // code
    case 5: load(reinterpret_cast<std::uintptr_t>(master_begin)); break;
    case 6: load(kJobAddress); break;
    case 7: load(kGdmaAddress); break;                          // a channel that is not its own
    case 8: load(kApuAddress); break;
    case 9: load(kResetAddress); break;
    case 10: load(0); break;
    case 11: reinterpret_cast<void (*)()>(kArena + kArenaBytes / 2)(); break;  // code in its own arena
    default: break;
  }
}

}  // namespace gridiron::port
