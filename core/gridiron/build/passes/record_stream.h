// Fetches the records of triangles by their places, ahead of their use.
// Memory: a RecordRing of the store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/build/passes/pass_tools.h>
#include <gridiron/dma/tags.h>

#include <cstddef>
#include <cstdint>

namespace gridiron {

/// Memory of records under way.
struct RecordRing {
  static constexpr std::uint32_t kSpans = 16;  // transfers
  static constexpr std::uint32_t kSpan = 4;    // records that one covers
  static constexpr std::uint32_t kGroup = 2;   // transfers with one tag
  static constexpr std::uint32_t kSpanBytes = 256;
  static_assert(kSpans / kGroup <= kTriangleTagCount);
  static_assert(kSpan * sizeof(VertexTriangle) + kPortableGranuleBytes <= kSpanBytes);

  alignas(128) std::byte spans[kSpans][kSpanBytes];

  [[nodiscard]] static GRIDIRON_INLINE std::uint8_t tag_of(std::uint32_t number) {
    return static_cast<std::uint8_t>(kFirstTriangleTag + number % kSpans / kGroup);
  }
  // Congruent with the place in main memory.
  [[nodiscard]] GRIDIRON_INLINE std::byte* place_of(std::uint32_t number, std::uint32_t first) {
    static_assert(sizeof(VertexTriangle) % kPortableCongruenceBytes == kPortableGranuleBytes);
    return spans[number % kSpans] + (first & 1u) * kPortableGranuleBytes;
  }
};

/// A queue of records. Places that follow one another closely, as those of neighbours in a sorted run do, share a
/// transfer. Uses tags from kFirstTriangleTag on.
template <class P>
class RecordStream {
 public:
  RecordStream(BuildTransfers<P>& transfers, RecordRing& ring, MainAddress records)
      : transfers_(transfers), ring_(ring), records_(records) {}

  [[nodiscard]] GRIDIRON_INLINE bool is_empty() const { return popped_ == pushed_; }
  /// Whether push() has to wait for a pop().
  [[nodiscard]] GRIDIRON_INLINE bool is_full() const { return back_ - front_ >= RecordRing::kSpans - 1; }
  /// Begins anew. Precondition: is_empty().
  void reset() { pushed_ = popped_ = back_ = front_ = open_count_ = left_ = 0; }

  /// Asks for the record at a place. Precondition: !is_full(). The record popped last is lost.
  [[nodiscard]] GRIDIRON_INLINE Status push(std::uint32_t place) {
    transfers_.add_work(BuildWork::kAskedRecord);
    ++pushed_;
    if (place - open_first_ >= open_room_) {
      GRIDIRON_TRY(close());
      open_first_ = open_last_ = place;
      open_room_ = RecordRing::kSpan;
      open_count_ = 1;
      return Status::kOk;
    }
    open_last_ = place > open_last_ ? place : open_last_;
    ++open_count_;
    return Status::kOk;
  }
  /// Takes the record that was asked for first. Precondition: !is_empty(). @param place  that was pushed.
  [[nodiscard]] GRIDIRON_INLINE Status pop(std::uint32_t place, const VertexTriangle*& record) {
    if (left_ == 0) GRIDIRON_TRY(begin_span());
    ++popped_;
    --left_;
    record = front_records_ + (place - front_first_);
    return Status::kOk;
  }

 private:
  // Sends for the last span, if there is one that is not under way.
  [[nodiscard]] Status close() {
    if (open_count_ == 0) return Status::kOk;
    transfers_.add_work(BuildWork::kRecordSpan);
    firsts_[back_ % RecordRing::kSpans] = open_first_;
    counts_[back_ % RecordRing::kSpans] = open_count_;
    const std::uint32_t bytes = (open_last_ - open_first_ + 1) * static_cast<std::uint32_t>(sizeof(VertexTriangle));
    GRIDIRON_TRY(transfers_.get(ring_.place_of(back_, open_first_),
                                records_.offset_by(std::uint64_t{open_first_} * sizeof(VertexTriangle)), bytes,
                                RecordRing::tag_of(back_)));
    ++back_;
    open_count_ = open_room_ = 0;
    transfers_.charge_to(BuildWork::kAskedRecord);
    return Status::kOk;
  }
  [[nodiscard]] Status begin_span() {
    if (front_ == back_) GRIDIRON_TRY(close());
    GRIDIRON_TRY(transfers_.wait(RecordRing::tag_of(front_)));
    front_first_ = firsts_[front_ % RecordRing::kSpans];
    left_ = counts_[front_ % RecordRing::kSpans];
    front_records_ = reinterpret_cast<const VertexTriangle*>(ring_.place_of(front_, front_first_));
    ++front_;
    transfers_.charge_to(BuildWork::kTakenRecord);
    return Status::kOk;
  }

  BuildTransfers<P>& transfers_;
  RecordRing& ring_;
  MainAddress records_;
  std::uint32_t pushed_ = 0, popped_ = 0;  // records
  std::uint32_t back_ = 0, front_ = 0;     // spans sent for, and begun to be taken
  // The span that is not sent for yet: records, the room from the first place on that it may grow to.
  std::uint32_t open_first_ = 0, open_last_ = 0, open_room_ = 0, open_count_ = 0;
  std::uint32_t front_first_ = 0, left_ = 0;  // of the span that is being taken: records
  const VertexTriangle* front_records_ = nullptr;
  std::uint32_t firsts_[RecordRing::kSpans] = {}, counts_[RecordRing::kSpans] = {};
};

/// Calls take(record, place) for records whose places are pushed, in order, as late as possible. Places that follow one
/// another closely share a transfer.
template <class P, class Take>
class RecordTaker {
 public:
  /// @param kind  of work, that all is charged to.
  RecordTaker(BuildTransfers<P>& transfers, RecordRing& ring, MainAddress records, BuildWork kind, Take& take)
      : transfers_(transfers), ring_(ring), records_(records), kind_(kind), take_(take) {}

  [[nodiscard]] GRIDIRON_INLINE Status push(std::uint32_t id) {
    transfers_.charge_to(kind_);
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
  static constexpr std::uint32_t kSpans = RecordRing::kSpans, kSpan = RecordRing::kSpan;
  struct Span {
    std::uint32_t first, last, count = 0;
    std::uint8_t wanted[kSpan];  // from `first` on
  };

  [[nodiscard]] Window<VertexTriangle> window_of(std::uint32_t number) const {
    return {ring_.spans[number % kSpans], records_, spans_[number % kSpans].first};
  }
  [[nodiscard]] static std::uint8_t tag_of(std::uint32_t number) { return RecordRing::tag_of(number); }
  // Asks for the last span, and makes room for the next one.
  [[nodiscard]] Status close() {
    const Span& span = spans_[back_ % kSpans];
    GRIDIRON_TRY(window_of(back_).get(transfers_, span.last - span.first + 1, tag_of(back_)));
    ++back_;
    // One less than there are, so that the tag of the first is not that of the last.
    if (back_ - front_ == kSpans - 1) GRIDIRON_TRY(take_front());
    spans_[back_ % kSpans].count = 0;
    return Status::kOk;
  }
  [[nodiscard]] Status take_front() {
    const Span& span = spans_[front_ % kSpans];
    GRIDIRON_TRY(transfers_.wait(tag_of(front_)));
    const VertexTriangle* const records = window_of(front_).elements();
    for (std::uint32_t i = 0; i < span.count; ++i) take_(records[span.wanted[i]], span.first + span.wanted[i]);
    ++front_;
    return Status::kOk;
  }

  BuildTransfers<P>& transfers_;
  RecordRing& ring_;
  MainAddress records_;
  BuildWork kind_;
  Take& take_;
  Span spans_[kSpans];
  std::uint32_t front_ = 0, back_ = 0;  // numbers of spans; the last one grows
};

}  // namespace gridiron
