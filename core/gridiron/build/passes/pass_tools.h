// What all passes of a build do: claim items, and move runs of elements that begin anywhere.
// Memory: borrowed. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/build/passes/build_transfers.h>
#include <gridiron/build/tree/tree_curve.h>
#include <gridiron/build/tree/tree_splits.h>
#include <gridiron/dma/transfers.h>
#include <gridiron/platform/contract.h>

#include <cstddef>
#include <cstdint>

namespace gridiron {

/// Bytes of a buffer for so many elements at any place of an array; a multiple of kPortableCongruenceBytes.
template <class Element>
[[nodiscard]] constexpr std::size_t window_bytes(std::uint32_t count) {
  return static_cast<std::size_t>(
      round_up(count * static_cast<std::uint32_t>(sizeof(Element)) + 48, kPortableCongruenceBytes));
}

/// Elements [first, first + count) of an array in main memory, and a buffer for them that is aligned to
/// kPortableCongruenceBytes.
template <class Element>
class Window {
 public:
  Window(std::byte* buffer, MainAddress array, std::uint64_t first)
      : address_(array.value + first * sizeof(Element)), buffer_(buffer) {}

  /// Element `first`, once the get has been waited for.
  [[nodiscard]] Element* elements() const {
    return reinterpret_cast<Element*>(buffer_ + address_ % kPortableCongruenceBytes);
  }
  /// Starts to get so many elements, at least one, and what lies beside them in their granules.
  template <class P>
  [[nodiscard]] Status get(BuildTransfers<P>& transfers, std::uint32_t count, std::uint8_t tag) const {
    const std::uint64_t begin = address_ / kPortableGranuleBytes * kPortableGranuleBytes;
    const std::uint64_t end = (address_ + count * sizeof(Element) + kPortableGranuleBytes - 1) / kPortableGranuleBytes *
                              kPortableGranuleBytes;
    return transfers.get(buffer_ + begin % kPortableCongruenceBytes, MainAddress{begin},
                         static_cast<std::uint32_t>(end - begin), tag);
  }
  /// Starts to put so many elements, at least one. Precondition: they begin and end with a granule.
  template <class P>
  [[nodiscard]] Status put(BuildTransfers<P>& transfers, std::uint32_t count, std::uint8_t tag) const {
    return transfers.put(elements(), MainAddress{address_}, count * static_cast<std::uint32_t>(sizeof(Element)), tag);
  }

 private:
  std::uint64_t address_;
  std::byte* buffer_;
};

/// Calls visit(element, index) for elements [first, end) of an array, in order; their transfers are ahead.
///
/// @param buffers  two, of window_bytes<Element>(kCount) each, aligned to kPortableCongruenceBytes.
/// @param tag      and the next one are used. @param visit  -> Status.
template <class Element, std::uint32_t kCount, class P, class Visit>
[[nodiscard]] GRIDIRON_INLINE Status for_each_window(BuildTransfers<P>& transfers, std::byte* buffers,
                                                     MainAddress array, std::uint64_t first, std::uint64_t end,
                                                     std::uint8_t tag, Visit&& visit) {
  static constexpr std::size_t kBytes = window_bytes<Element>(kCount);
  const auto count_at = [end](std::uint64_t at) {
    return end - at < kCount ? static_cast<std::uint32_t>(end - at) : kCount;
  };
  const auto window_at = [&](std::uint64_t at, std::uint32_t side) {
    return Window<Element>(buffers + side * kBytes, array, at);
  };
  const auto tag_of = [tag](std::uint32_t side) { return static_cast<std::uint8_t>(tag + side); };
  std::uint32_t side = 0;
  if (first < end) GRIDIRON_TRY(window_at(first, 0).get(transfers, count_at(first), tag));
  for (std::uint64_t at = first; at < end; at += kCount) {
    if (at + kCount < end) {
      GRIDIRON_TRY(window_at(at + kCount, 1 - side).get(transfers, count_at(at + kCount), tag_of(1 - side)));
    }
    GRIDIRON_TRY(transfers.wait(tag_of(side)));
    GRIDIRON_TRY(visit(window_at(at, side).elements(), at, count_at(at)));
    side = 1 - side;
  }
  return Status::kOk;
}

/// Gets one element that lies in main memory and waits for it. @param local  congruent with it.
template <class Element, class P>
[[nodiscard]] Status fetch(BuildTransfers<P>& transfers, Element& local, MainAddress address) {
  static_assert(sizeof(Element) % kPortableGranuleBytes == 0);
  GRIDIRON_TRY(transfers.get(&local, address, sizeof(Element), kSetupTag));
  return transfers.wait(kSetupTag);
}

/// Waits for tags [first, first + count).
template <class P>
[[nodiscard]] Status wait_for(BuildTransfers<P>& transfers, std::uint8_t first, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) GRIDIRON_TRY(transfers.wait(static_cast<std::uint8_t>(first + i)));
  return Status::kOk;
}

/// The kind of a step of TreeSplits.
[[nodiscard]] GRIDIRON_INLINE constexpr BuildWork kind_of(SplitWork work) {
  switch (work) {
    case SplitWork::kPart:
      return BuildWork::kPart;
    case SplitWork::kWeighedPart:
      return BuildWork::kWeighedPart;
    case SplitWork::kSearchStep:
      return BuildWork::kSearchStep;
    case SplitWork::kLeaf:
      break;
  }
  return BuildWork::kLeaf;
}

/// Calls work(item) for each item that this core claims. @param item_count  of the pass.
template <class P, class Work>
[[nodiscard]] Status for_each_item(BuildTransfers<P>& transfers, std::uint32_t item_count, Work&& work) {
  for (std::uint64_t claims = 0; claims <= item_count; ++claims) {
    const ItemClaim claim = transfers.claim_item();
    switch (claim.kind) {
      case ItemClaim::Kind::kNone:
        return Status::kOk;
      case ItemClaim::Kind::kAborted:
        return Status::kAborted;
      case ItemClaim::Kind::kDeadline:
        return Status::kDeadline;
      case ItemClaim::Kind::kItem:
        GRIDIRON_TRY(work(claim.item));
    }
  }
  return Status::kOk;
}

}  // namespace gridiron
