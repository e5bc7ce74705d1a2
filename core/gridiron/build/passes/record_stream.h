// Fetches the records of triangles by their ids, ahead of their use.
// Memory: a RecordRing of the store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/build/passes/pass_tools.h>
#include <gridiron/dma/tags.h>

namespace gridiron {

/// Memory of a RecordStream.
struct RecordRing {
  static constexpr std::uint32_t kSlots = 32;  // records under way
  static constexpr std::uint32_t kGroup = 4;   // of them with one tag
  static constexpr std::uint32_t kSlotBytes = 64;
  static_assert(kSlots / kGroup <= kTriangleTagCount && kSlotBytes == sizeof(VertexTriangle) + kPortableGranuleBytes);

  alignas(128) std::byte slots[kSlots * kSlotBytes];
};

/// A queue of records. Uses tags from kFirstTriangleTag on.
template <class P>
class RecordStream {
 public:
  RecordStream(BuildTransfers<P>& transfers, RecordRing& ring, MainAddress records)
      : transfers_(transfers), ring_(ring), records_(records) {}

  [[nodiscard]] GRIDIRON_INLINE bool is_empty() const { return popped_ == pushed_; }
  [[nodiscard]] GRIDIRON_INLINE bool is_full() const { return pushed_ - popped_ == RecordRing::kSlots; }
  /// Begins anew. Precondition: is_empty().
  void reset() { pushed_ = popped_ = arrived_ = 0; }

  /// Asks for a record. Precondition: !is_full(). The record popped last is lost.
  [[nodiscard]] GRIDIRON_INLINE Status push(std::uint32_t id) {
    transfers_.add_work(BuildWork::kAskedRecord);
    const std::uint32_t slot = pushed_++ % RecordRing::kSlots;
    return transfers_.get(place_of(slot, id), records_.offset_by(std::uint64_t{id} * sizeof(VertexTriangle)),
                          sizeof(VertexTriangle), tag_of(slot));
  }
  /// Takes the record that was asked for first. Precondition: !is_empty(). @param id  that was pushed.
  [[nodiscard]] GRIDIRON_INLINE Status pop(std::uint32_t id, const VertexTriangle*& record) {
    const std::uint32_t slot = popped_ % RecordRing::kSlots;
    if (popped_ == arrived_) {
      // Of the group all that have been asked for.
      GRIDIRON_TRY(transfers_.wait(tag_of(slot)));
      const std::uint32_t end = popped_ / RecordRing::kGroup * RecordRing::kGroup + RecordRing::kGroup;
      arrived_ = end - popped_ < pushed_ - popped_ ? end : pushed_;
    }
    ++popped_;
    record = reinterpret_cast<const VertexTriangle*>(place_of(slot, id));
    return Status::kOk;
  }

 private:
  // Congruent with the record's place in main memory.
  [[nodiscard]] GRIDIRON_INLINE std::byte* place_of(std::uint32_t slot, std::uint32_t id) const {
    static_assert(sizeof(VertexTriangle) % kPortableCongruenceBytes == kPortableGranuleBytes);
    return ring_.slots + slot * RecordRing::kSlotBytes + (id & 1u) * kPortableGranuleBytes;
  }
  [[nodiscard]] static GRIDIRON_INLINE std::uint8_t tag_of(std::uint32_t slot) {
    return static_cast<std::uint8_t>(kFirstTriangleTag + slot / RecordRing::kGroup);
  }

  BuildTransfers<P>& transfers_;
  RecordRing& ring_;
  MainAddress records_;
  std::uint32_t pushed_ = 0, popped_ = 0, arrived_ = 0;  // counts
};

/// Calls take(record) for records whose ids are pushed, in order, as late as possible. Ids that follow one another
/// closely share a transfer.
template <class P, class Take>
class RecordTaker {
 public:
  RecordTaker(BuildTransfers<P>& transfers, RecordRing& ring, MainAddress records, Take& take)
      : transfers_(transfers), ring_(ring), records_(records), take_(take) {}

  [[nodiscard]] GRIDIRON_INLINE Status push(std::uint32_t id) {
    transfers_.add_work(BuildWork::kAskedRecord);
    Span& span = spans_[back_ % kSpans];
    if (span.count > 0 && id - span.first < kSpan && span.count < kSpan) {
      span.wanted[span.count++] = static_cast<std::uint8_t>(id - span.first);
      span.last = id > span.last ? id : span.last;
      return Status::kOk;
    }
    if (span.count > 0) GRIDIRON_TRY(close());
    Span& next = spans_[back_ % kSpans];
    next.first = next.last = id;
    next.wanted[0] = 0;
    next.count = 1;
    return Status::kOk;
  }
  [[nodiscard]] Status end() {
    if (spans_[back_ % kSpans].count > 0) GRIDIRON_TRY(close());
    while (front_ != back_) GRIDIRON_TRY(take_front());
    return Status::kOk;
  }

 private:
  static constexpr std::uint32_t kSpans = 8, kSpan = 4;  // records that a transfer covers
  static constexpr std::uint32_t kSpanBytes = RecordRing::kSlots / kSpans * RecordRing::kSlotBytes;
  static_assert(kSpan * sizeof(VertexTriangle) + kPortableGranuleBytes <= kSpanBytes);
  struct Span {
    std::uint32_t first, last, count = 0;
    std::uint8_t wanted[kSpan];  // from `first` on
  };

  [[nodiscard]] Window<VertexTriangle> window_of(std::uint32_t number) const {
    return {ring_.slots + number % kSpans * kSpanBytes, records_, spans_[number % kSpans].first};
  }
  [[nodiscard]] static std::uint8_t tag_of(std::uint32_t number) {
    return static_cast<std::uint8_t>(kFirstTriangleTag + number % kSpans);
  }
  // Asks for the last span, and makes room for the next one.
  [[nodiscard]] Status close() {
    const Span& span = spans_[back_ % kSpans];
    GRIDIRON_TRY(window_of(back_).get(transfers_, span.last - span.first + 1, tag_of(back_)));
    ++back_;
    if (back_ - front_ == kSpans) GRIDIRON_TRY(take_front());
    spans_[back_ % kSpans].count = 0;
    return Status::kOk;
  }
  [[nodiscard]] Status take_front() {
    const Span& span = spans_[front_ % kSpans];
    GRIDIRON_TRY(transfers_.wait(tag_of(front_)));
    const VertexTriangle* const records = window_of(front_).elements();
    for (std::uint32_t i = 0; i < span.count; ++i) take_(records[span.wanted[i]]);
    ++front_;
    return Status::kOk;
  }

  BuildTransfers<P>& transfers_;
  RecordRing& ring_;
  MainAddress records_;
  Take& take_;
  Span spans_[kSpans];
  std::uint32_t front_ = 0, back_ = 0;  // numbers of spans; the last one grows
};

}  // namespace gridiron
