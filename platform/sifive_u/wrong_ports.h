// Wrong on purpose, for images that show what is noticed: a port that forgets waits, a worker that touches what is not
// its own. No image of a frame that counts has them.
// Memory: none. Threads: one worker. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "forgetful_port.h"
#include "memory_map.h"
#include "shared_memory.h"

namespace gridiron::port {

/// Does the trespass that shared_memory names; core 1 alone.
inline void trespass(std::uint32_t core_index, std::uint64_t arena) {
  if (core_index != 1) return;
  const auto load = [](std::uint64_t address) { (void)*reinterpret_cast<const volatile std::uint32_t*>(address); };
  const auto store = [](std::uint64_t address) { *reinterpret_cast<volatile std::uint32_t*>(address) = 0; };
  switch (shared_memory.trespass) {
    case 1: load(arena - GRIDIRON_ARENA_BYTES); break;  // a neighbour's first word
    case 2: store(arena - 4); break;                    // a neighbour's last one
    case 3: load(arena + GRIDIRON_ARENA_BYTES); break;  // the first word behind its own
    case 4: store(GRIDIRON_CODE + 64); break;
    case 5: load(GRIDIRON_MASTER_DATA); break;
    case 6: load(GRIDIRON_JOB); break;
    case 7: load(GRIDIRON_PDMA); break;                 // a channel that is not its own
    case 8: store(GRIDIRON_UART); break;
    case 9: store(GRIDIRON_MTIMECMP0); break;
    case 10: reinterpret_cast<void (*)()>(arena)(); break;  // code in its own arena
    default: break;
  }
}

}  // namespace gridiron::port
