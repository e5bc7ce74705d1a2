// Platform of the plain mode: a get or put is one copy, at once, unchecked; the tree is read where it lies. For fast
// renders on the host.
// Memory: borrows main memory and the tile source. Threads: one core per object. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>
#include <gridiron/sim/item_source.h>
#include <gridiron/store/local_store.h>

#include <cassert>
#include <cstddef>
#include <cstdint>

namespace gridiron::sim {

/// Calls the host's memcpy: inlined, a copy of bounded but unknown size becomes a slow string instruction.
void copy_bytes(void* to, const void* from, std::size_t bytes);

/// One core that checks nothing: a transfer that breaks a rule of the contract is undefined behaviour of the host.
/// Asserts catch the cheapest mistakes in builds without NDEBUG.
class PlainCore {
 public:
  /// @param base   host address of main address 0.
  /// @param spill  the core's own.
  PlainCore(std::byte* base, const PlatformLimits& limits, ItemSource& tiles, SpillRegion spill = {})
      : base_(base), limits_(limits), tiles_(&tiles), spill_(spill) {}

  [[nodiscard]] PlatformLimits limits() const { return limits_; }
  /// The core's own slice of the frame's spill memory, if there is any.
  [[nodiscard]] SpillRegion spill() const { return spill_; }

  Status get(void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    assert(bytes != 0 && bytes <= limits_.max_transfer_bytes && tag.index < limits_.tag_count);
    static_cast<void>(tag);
    ++transfers_;
    copy_bytes(local, base_ + address.value, bytes);
    return Status::kOk;
  }

  Status put(const void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    assert(bytes != 0 && bytes <= limits_.max_transfer_bytes && tag.index < limits_.tag_count);
    static_cast<void>(tag);
    ++transfers_;
    copy_bytes(base_ + address.value, local, bytes);
    return Status::kOk;
  }

  Status wait(TagMask) { return Status::kOk; }

  /// From now on the tree is copied too, as a device would.
  void copy_all() { reads_in_place_ = false; }
  [[nodiscard]] const std::byte* in_place(MainAddress address) const {
    return reads_in_place_ ? base_ + address.value : nullptr;
  }

  ItemClaim claim_item() {
    if (busy_) tiles_->item_done();
    const ItemClaim claim = tiles_->claim();
    busy_ = claim.kind == ItemClaim::Kind::kItem;
    if (busy_) tile_id_ = claim.item;
    return claim;
  }

  /// The tile claimed last.
  [[nodiscard]] std::uint32_t tile_id() const { return tile_id_; }
  [[nodiscard]] std::uint64_t transfers() const { return transfers_; }

 private:
  std::byte* base_;
  PlatformLimits limits_;
  ItemSource* tiles_;
  SpillRegion spill_;
  std::uint64_t transfers_ = 0;
  std::uint32_t tile_id_ = 0;
  bool busy_ = false;
  bool reads_in_place_ = true;
};

static_assert(Platform<PlainCore> && InPlaceReader<PlainCore>);
static_assert(!WorkObserver<PlainCore> && !StageObserver<PlainCore>, "no time is kept, so no observer is needed");

}  // namespace gridiron::sim
