// Fetches the records of triangles by their ids, ahead of their use. Ids that follow one another closely share a transfer.
// Memory: a RecordRing of the store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/build/passes/pass_tools.h>
#include <gridiron/dma/tags.h>

namespace gridiron {

/// Memory of a RecordStream.
struct RecordRing {
  static constexpr std::uint32_t kSlots = 10, kSpan = 6;  // transfers under way; records of one
  static_assert(kSlots <= kTriangleTagCount);
  struct Slot {
    std::uint32_t first, last;  // ids
    std::uint32_t count;        // of records that are wanted
    std::uint8_t wanted[kSpan];  // from `first` on
  };
  alignas(128) std::byte buffers[kSlots][window_bytes<VertexTriangle>(kSpan)];
  Slot slots[kSlots];
};

/// A queue of records. Uses tags from kFirstTriangleTag on.
template <class P>
class RecordStream {
 public:
  RecordStream(Transfers<P>& transfers, RecordRing& ring, MainAddress records)
      : transfers_(transfers), ring_(ring), records_(records) {}

  [[nodiscard]] GRIDIRON_INLINE bool is_empty() {
    settle();
    return used_ == 0;
  }
  [[nodiscard]] GRIDIRON_INLINE bool can_push(std::uint32_t id) {
    settle();
    return used_ < RecordRing::kSlots || (is_open_ && fits(id));
  }
  /// Begins anew. Precondition: is_empty().
  void reset() { front_ = back_ = used_ = taken_ = 0; }
  /// Asks for a record. Precondition: can_push().
  [[nodiscard]] GRIDIRON_INLINE Status push(std::uint32_t id) {
    if (!is_open_ || !fits(id)) {
      if (is_open_) GRIDIRON_TRY(close());
      back_ = front_ + used_;
      if (back_ >= RecordRing::kSlots) back_ -= RecordRing::kSlots;
      ++used_;
      is_open_ = true;
      ring_.slots[back_].first = ring_.slots[back_].last = id;
      ring_.slots[back_].count = 0;
    }
    RecordRing::Slot& slot = ring_.slots[back_];
    slot.wanted[slot.count++] = static_cast<std::uint8_t>(id - slot.first);
    slot.last = id > slot.last ? id : slot.last;
    return Status::kOk;
  }
  /// Takes the record that was asked for first. Precondition: !is_empty(). @param record  valid until the next call.
  [[nodiscard]] GRIDIRON_INLINE Status pop(const VertexTriangle*& record) {
    settle();
    if (taken_ == 0) {
      if (used_ == 1 && is_open_) GRIDIRON_TRY(close());
      GRIDIRON_TRY(transfers_.wait(tag_of(front_)));
    }
    record = window_of(front_).elements() + ring_.slots[front_].wanted[taken_++];
    return Status::kOk;
  }

 private:
  // Frees the front slot if its records have been taken.
  GRIDIRON_INLINE void settle() {
    if (taken_ == 0 || taken_ != ring_.slots[front_].count) return;
    ++front_;
    if (front_ == RecordRing::kSlots) front_ = 0;
    --used_;
    taken_ = 0;
  }
  [[nodiscard]] GRIDIRON_INLINE bool fits(std::uint32_t id) const {
    const RecordRing::Slot& slot = ring_.slots[back_];
    return id - slot.first < RecordRing::kSpan && slot.count < RecordRing::kSpan;
  }
  [[nodiscard]] Window<VertexTriangle> window_of(std::uint32_t slot) const {
    return {ring_.buffers[slot], records_, ring_.slots[slot].first};
  }
  [[nodiscard]] static std::uint8_t tag_of(std::uint32_t slot) {
    return static_cast<std::uint8_t>(kFirstTriangleTag + slot);
  }
  [[nodiscard]] Status close() {
    is_open_ = false;
    return window_of(back_).get(transfers_, ring_.slots[back_].last - ring_.slots[back_].first + 1, tag_of(back_));
  }

  Transfers<P>& transfers_;
  RecordRing& ring_;
  MainAddress records_;
  std::uint32_t front_ = 0, back_ = 0, used_ = 0;
  std::uint32_t taken_ = 0;  // of the front slot
  bool is_open_ = false;     // more may go into the back slot
};

/// Calls take(record) for records that are pushed, in order, as late as possible.
template <class P, class Take>
class RecordTaker {
 public:
  RecordTaker(Transfers<P>& transfers, RecordRing& ring, MainAddress records, Take& take)
      : stream_(transfers, ring, records), take_(take) {}

  [[nodiscard]] GRIDIRON_INLINE Status push(std::uint32_t id) {
    // At most the records of one slot.
    while (!stream_.can_push(id)) GRIDIRON_TRY(take_one());
    return stream_.push(id);
  }
  [[nodiscard]] GRIDIRON_INLINE Status end() {
    while (!stream_.is_empty()) GRIDIRON_TRY(take_one());
    return Status::kOk;
  }

 private:
  [[nodiscard]] GRIDIRON_INLINE Status take_one() {
    const VertexTriangle* record = nullptr;
    GRIDIRON_TRY(stream_.pop(record));
    take_(*record);
    return Status::kOk;
  }

  RecordStream<P> stream_;
  Take& take_;
};

}  // namespace gridiron
