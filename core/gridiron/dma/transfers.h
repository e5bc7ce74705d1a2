// Transfers: what core asks of a platform, split into portable pieces and kept within its queue.
// Memory: 300 bytes by value. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/stages.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/dma/tags.h>
#include <gridiron/platform/contract.h>

#include <cstddef>
#include <cstdint>

namespace gridiron {

/// Bytes of the next piece of a transfer that starts at `address` with `rest` bytes to go: at most
/// kPortableMaxTransferBytes and not across a multiple of kPortableBoundaryBytes.
[[nodiscard]] constexpr std::uint32_t next_piece_bytes(MainAddress address, std::uint32_t rest) {
  const std::uint32_t to_boundary =
      kPortableBoundaryBytes - static_cast<std::uint32_t>(address.value % kPortableBoundaryBytes);
  const std::uint32_t piece = rest < to_boundary ? rest : to_boundary;
  return piece < kPortableMaxTransferBytes ? piece : kPortableMaxTransferBytes;
}

/// Keeps track of a platform's pending commands. When its queue is full, it waits for the oldest tag first, so that
/// queue_depth is never exceeded, down to a depth of 1.
template <Platform P>
class Transfers {
 public:
  Transfers(P& platform, WorkCounters& work) : platform_(platform), work_(work) {}

  [[nodiscard]] std::uint32_t queue_depth() const { return platform_.limits().queue_depth; }

  /// Reserves `commands` places of the queue for output tags; the caller never has more of them pending. All other
  /// transfers share the rest, so that their waits do not depend on which tiles are still being written.
  void reserve_for_output(std::uint32_t commands) { output_share_ = commands; }

  /// Starts a get of `bytes` > 0, a multiple of 16, both ends congruent modulo 32.
  [[nodiscard]] Status get(void* local, MainAddress address, std::uint32_t bytes, std::uint8_t tag) {
    std::byte* target = static_cast<std::byte*>(local);
    while (bytes != 0) {
      const std::uint32_t piece = next_piece_bytes(address, bytes);
      GRIDIRON_TRY(make_room(tag));
      work_.add(Work::kGetIssue);
      note_work();
      GRIDIRON_TRY(platform_.get(target, address, piece, Tag{tag}));
      target += piece;
      address = address.offset_by(piece);
      bytes -= piece;
    }
    return Status::kOk;
  }

  /// Starts a put; the same rules.
  [[nodiscard]] Status put(const void* local, MainAddress address, std::uint32_t bytes, std::uint8_t tag) {
    const std::byte* source = static_cast<const std::byte*>(local);
    while (bytes != 0) {
      const std::uint32_t piece = next_piece_bytes(address, bytes);
      GRIDIRON_TRY(make_room(tag));
      work_.add(Work::kPutIssue);
      note_work();
      GRIDIRON_TRY(platform_.put(source, address, piece, Tag{tag}));
      source += piece;
      address = address.offset_by(piece);
      bytes -= piece;
    }
    return Status::kOk;
  }

  /// Waits for every transfer of a tag.
  [[nodiscard]] Status wait(std::uint8_t tag) {
    work_.add(Work::kWait);
    note_work();
    if (is_counted(tag)) pending_count_ -= pending_[tag];
    pending_[tag] = 0;
    return platform_.wait(TagMask::of(Tag{tag}));
  }

  /// Bytes of main memory where they lie.
  [[nodiscard]] const std::byte* in_place(MainAddress address) const requires InPlaceReader<P> {
    return platform_.in_place(address);
  }

  /// Reports the core's stage from now on, to platforms that have note_stage().
  GRIDIRON_INLINE void note_stage(Stage stage) {
    if constexpr (StageObserver<P>) {
      note_work();
      platform_.note_stage(static_cast<std::uint8_t>(stage));
    }
  }

  [[nodiscard]] ItemClaim claim_item() {
    note_work();
    return platform_.claim_item();
  }

 private:
  // Counts one command of `tag`, waiting for the tag that began longest ago while the queue is full.
  [[nodiscard]] Status make_room(std::uint8_t tag) {
    const std::uint32_t depth = platform_.limits().queue_depth - output_share_;
    if (is_counted(tag) && pending_count_ >= depth) [[unlikely]] {
      std::uint8_t oldest = 0;
      std::uint32_t oldest_age = 0;
      for (std::uint8_t i = 0; i < kTagCount; ++i) {
        const std::uint32_t age = sequence_ - started_[i];
        if (pending_[i] != 0 && is_counted(i) && age >= oldest_age) {
          oldest = i;
          oldest_age = age;
        }
      }
      GRIDIRON_TRY(wait(oldest));
    }
    if (pending_[tag] == 0) started_[tag] = sequence_;
    ++sequence_;
    ++pending_[tag];
    if (is_counted(tag)) ++pending_count_;
    return Status::kOk;
  }

  // Whether a command of `tag` takes a place of the shared part of the queue.
  [[nodiscard]] bool is_counted(std::uint8_t tag) const { return output_share_ == 0 || tag < kFirstOutputTag; }

  GRIDIRON_INLINE void note_work() {
    if constexpr (WorkObserver<P>) platform_.note_work(work_.counts, kWorkKindCount);
  }

  static constexpr std::uint8_t kTagCount = 32;
  P& platform_;
  WorkCounters& work_;
  std::uint32_t sequence_ = 0;
  std::uint32_t pending_count_ = 0;  // in the shared part of the queue
  std::uint32_t output_share_ = 0;
  std::uint32_t started_[kTagCount] = {};
  std::uint8_t pending_[kTagCount] = {};
};

}  // namespace gridiron
