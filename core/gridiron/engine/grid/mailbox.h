// Mailbox: remembers which triangles a packet has already been tested against.
// Source: Kirk, Arvo 1991; Cho, Kim, Han 2012, section 4.2. Memory: inside the local store. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/ray/packet.h>

#include <cstdint>

namespace gridiron {

/// Direct-mapped: each slot holds a triangle and the subpackets that were tested against it. Forgetting is harmless:
/// testing twice changes nothing. @tparam SlotCount  a power of two.
template <std::uint32_t SlotCount>
struct alignas(128) Mailbox {
  static constexpr std::uint32_t kSlotCount = SlotCount;
  std::uint32_t triangle_ids[kSlotCount];
  SubpacketSet tested[kSlotCount];

  GRIDIRON_INLINE void clear() { fill_words(triangle_ids, kNoTriangle); }
  /// @returns those of the `wanted` subpackets that were not tested against the triangle before; remembers them.
  [[nodiscard]] GRIDIRON_INLINE SubpacketSet untested(std::uint32_t triangle_id, SubpacketSet wanted) {
    const std::uint32_t slot = triangle_id % kSlotCount;
    const SubpacketSet before = triangle_ids[slot] == triangle_id ? tested[slot] : SubpacketSet{0};
    triangle_ids[slot] = triangle_id;
    tested[slot] = before | wanted;
    return wanted & ~before;
  }
};

}  // namespace gridiron
