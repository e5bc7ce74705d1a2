// Record gather: fetches records that lie anywhere in main memory, one for each item of a list, ahead of their use.
// Memory: buffers that the engine of rays lends while it traces none. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/dma/buffer_ring.h>
#include <gridiron/dma/tags.h>
#include <gridiron/dma/transfers.h>
#include <gridiron/platform/contract.h>

#include <cstddef>
#include <cstdint>

namespace gridiron {

/// Hands each item its record, in order. Neighbours in the list with the same record share its transfer.
///
/// @param address_of  address_of(i), called twice for an item; 0: it needs no record and is skipped.
/// @param bytes       of a record, a multiple of 16, at most kIdleBufferBytes less 16.
/// @param use         use(i, const std::byte* record) -> Status.
/// frame.fetch_depth records are under way at once, at most kTriangleTagCount.
template <class Store, Platform P, class AddressOf, class Use>
[[nodiscard]] Status gather_records(Store& store, Transfers<P>& transfers, std::uint32_t count, std::uint32_t bytes,
                                    AddressOf&& address_of, Use&& use) {
  BufferRing ring(store.frame.fetch_depth);
  store.wave.rays.lend(store.frame.fetch_depth);
  std::uint64_t wanted[kTriangleTagCount];  // by slot
  std::uint64_t last_wanted = 0;
  std::uint64_t at_hand = 0;  // in the front slot, waited for
  std::uint32_t ahead = 0;
  const auto place_of = [&](std::uint32_t slot, std::uint64_t address) {
    return store.wave.rays.idle_buffer(slot) + address % kPortableCongruenceBytes;
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint64_t address = address_of(i);
    if (address == 0) continue;
    if (address != at_hand && at_hand != 0) ring.pop();
    for (; ahead < count && !ring.full(); ++ahead) {
      const std::uint64_t next = address_of(ahead);
      if (next == 0 || next == last_wanted) continue;
      const std::uint32_t slot = ring.push();
      wanted[slot] = last_wanted = next;
      GRIDIRON_TRY(transfers.get(place_of(slot, next), MainAddress{next}, bytes,
                                 static_cast<std::uint8_t>(kFirstTriangleTag + slot)));
    }
    const std::uint32_t slot = ring.front();
    if (address != at_hand) {
      GRIDIRON_TRY(transfers.wait(static_cast<std::uint8_t>(kFirstTriangleTag + slot)));
      at_hand = address;
    }
    GRIDIRON_TRY(use(i, place_of(slot, wanted[slot])));
  }
  return Status::kOk;
}

}  // namespace gridiron
