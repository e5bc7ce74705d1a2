// Mailbox: remembers which triangles a packet has already been tested against.
// Source: Kirk, Arvo 1991; Cho, Kim, Han 2012, section 4.2. Memory: inside the local store. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>

#include <cstdint>

namespace gridiron {

/// Direct-mapped, one triangle id per slot. Forgetting is harmless: a test done twice changes nothing.
struct alignas(128) Mailbox {
  static constexpr std::uint32_t kSlotCount = 64;
  std::uint32_t slots[kSlotCount];

  GRIDIRON_INLINE void clear() {
    for (std::uint32_t& slot : slots) slot = kNoTriangle;
  }
  /// @returns true where the triangle was tested before; remembers it otherwise.
  [[nodiscard]] GRIDIRON_INLINE bool seen(std::uint32_t triangle_id) {
    std::uint32_t& slot = slots[triangle_id % kSlotCount];
    if (slot == triangle_id) return true;
    slot = triangle_id;
    return false;
  }
};

}  // namespace gridiron
