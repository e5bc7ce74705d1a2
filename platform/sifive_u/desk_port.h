// A port whose transfers the master makes, some time later and in any order. Until then the destination of a get holds
// poison, so that a use before the wait, a buffer changed before it, or a reliance on order changes the picture.
// Memory: 150 bytes by value, and a desk in shared memory. Threads: one worker. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>
#include <gridiron/platform/tile_order.h>
#include <gridiron/platform/transfer_rules.h>

#include <cstdint>

#include "run_control.h"
#include "shared_memory.h"
#include "transfer_desk.h"

namespace gridiron::port {

class DeskPort {
 public:
  /// How often a wait may be woken for other transfers before it gives up.
  static constexpr std::uint32_t kWakeBound = 1u << 20;

  DeskPort(RunControl& control, TransferDesk& desk, std::uint32_t core_index, const void* store,
           std::uint64_t store_bytes)
      : tiles_(control),
        desk_(desk),
        hart_(core_index + 1),
        local_base_(reinterpret_cast<std::uintptr_t>(store)),
        local_bytes_(store_bytes) {}

  [[nodiscard]] PlatformLimits limits() const {
    PlatformLimits limits;
    limits.queue_depth = kDeskSlots;
    return limits;
  }

  Status get(void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    std::uint32_t slot = 0;
    GRIDIRON_TRY(find_slot(local, address, bytes, tag, slot));
    constexpr std::uint64_t kPoison = 0xDEADBEEFDEADBEEF;
    auto* words = static_cast<volatile std::uint64_t*>(local);
    for (std::uint32_t i = 0; i < bytes / sizeof kPoison; ++i) words[i] = kPoison;
    ask(slot, reinterpret_cast<std::uintptr_t>(local), address.value, bytes, tag);
    return Status::kOk;
  }

  Status put(const void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    std::uint32_t slot = 0;
    GRIDIRON_TRY(find_slot(local, address, bytes, tag, slot));
    ask(slot, address.value, reinterpret_cast<std::uintptr_t>(local), bytes, tag);
    return Status::kOk;
  }

  // Sleeps while a transfer is pending. The master wakes it, and limits the sleep with its own bound.
  Status wait(TagMask tags) {
    Status status = Status::kOk;
    for (std::uint32_t i = 0; i < kDeskSlots; ++i) {
      if ((TagMask::of(tag_of_slot_[i]).bits & tags.bits) == 0) continue;
      std::uint32_t wakes = 0;
      for (; is_pending(i) && wakes < kWakeBound; ++wakes) {
        sleep_hart(false);
        hush_hart(hart_);
      }
      if (wakes == kWakeBound) status = Status::kTransferTimedOut;
    }
    return status;
  }

  ItemClaim claim_item() {
    if (tiles_.must_stop()) return {ItemClaim::Kind::kAborted, 0};
    const std::uint32_t claim = tiles_.next_tile(), count = tiles_.tile_count();
    if (claim >= count) return {ItemClaim::Kind::kNone, 0};
    return {ItemClaim::Kind::kItem, middle_out(claim, count)};
  }

 private:
  [[nodiscard]] bool is_pending(std::uint32_t slot) const {
    return __atomic_load_n(&desk_.slots[slot].is_pending, __ATOMIC_ACQUIRE) != 0;
  }

  Status find_slot(const void* local, MainAddress address, std::uint32_t bytes, Tag tag, std::uint32_t& slot) const {
    const std::uint64_t local_address = reinterpret_cast<std::uintptr_t>(local);
    GRIDIRON_TRY(check_transfer(limits(), local_address, address, bytes, tag));
    const std::uint64_t offset = local_address - local_base_;
    if (offset > local_bytes_ || bytes > local_bytes_ - offset) return Status::kTransferLocalRange;
    for (slot = 0; slot < kDeskSlots; ++slot) {
      if (!is_pending(slot)) return Status::kOk;
    }
    return Status::kTransferQueueFull;
  }

  void ask(std::uint32_t slot, std::uint64_t target, std::uint64_t source, std::uint32_t bytes, Tag tag) {
    tag_of_slot_[slot] = tag;
    TransferSlot& request = desk_.slots[slot];
    request.target = target;
    request.source = source;
    request.bytes = bytes;
    __atomic_store_n(&request.is_pending, std::uint32_t{1}, __ATOMIC_RELEASE);
    wake_hart(0);
  }

  SharedTiles tiles_;
  TransferDesk& desk_;
  std::uint32_t hart_;
  std::uint64_t local_base_;
  std::uint64_t local_bytes_;
  Tag tag_of_slot_[kDeskSlots] = {};
};

static_assert(Platform<DeskPort>);

}  // namespace gridiron::port
