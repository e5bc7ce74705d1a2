// Wrong on purpose, for images that show what is noticed: a port that forgets waits, a worker that touches what is not
// its own. No image of a frame that counts has them.
// Memory: none. Threads: one worker. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>
#include <gridiron/store/dma_tags.h>

#include <cstdint>

#include "memory_map.h"
#include "shared_memory.h"

namespace gridiron::port {

/// Leaves out every 16th wait for triangles.
template <Platform P>
class ForgetfulPort {
 public:
  explicit ForgetfulPort(P& port) : port_(port) {}

  [[nodiscard]] PlatformLimits limits() const { return port_.limits(); }
  Status get(void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    return port_.get(local, address, bytes, tag);
  }
  Status put(const void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    return port_.put(local, address, bytes, tag);
  }
  Status wait(TagMask tags) {
    constexpr std::uint32_t kTriangleTags = ((1u << kTriangleTagCount) - 1u) << kFirstTriangleTag;
    if ((tags.bits & kTriangleTags) != 0 && ++waits_ % 16 == 0) return Status::kOk;
    return port_.wait(tags);
  }
  TileClaim claim_tile() { return port_.claim_tile(); }

 private:
  P& port_;
  std::uint32_t waits_ = 0;
};

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
