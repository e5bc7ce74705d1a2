// Wrong on purpose, for images that must fail: a port that forgets waits, a worker that makes forbidden accesses.
// Images for real frames do not contain them.
// Memory: none. Threads: one worker. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "forgetful_port.h"
#include "memory_map.h"
#include "shared_memory.h"
#include "trespassing.h"

namespace gridiron::port {

inline constexpr std::uint64_t kTrespassCount = 10;

/// Makes the forbidden access that shared_memory selects; core 1 alone.
inline void trespass(std::uint32_t core_index, std::uint64_t arena) {
  if (core_index != 1) return;
  switch (shared_memory.trespass) {
    case 1: load_from(arena - GRIDIRON_ARENA_BYTES); break;  // a neighbour's first word
    case 2: store_to(arena - 4); break;                      // a neighbour's last one
    case 3: load_from(arena + GRIDIRON_ARENA_BYTES); break;  // the first word behind its own
    case 4: store_to(GRIDIRON_CODE + 64); break;
    case 5: load_from(GRIDIRON_MASTER_DATA); break;
    case 6: load_from(GRIDIRON_JOB); break;
    case 7: load_from(GRIDIRON_PDMA); break;                 // a channel that is not its own
    case 8: store_to(GRIDIRON_UART); break;
    case 9: store_to(GRIDIRON_MTIMECMP0); break;
    case 10: execute(arena); break;                          // code in its own arena
    default: break;
  }
}

}  // namespace gridiron::port
