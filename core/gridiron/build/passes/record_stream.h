// Records of triangles, read by their places ahead of their use, and written one after another.
// Memory: borrowed. Threads: one core. SPDX-License-Identifier: Apache-2.0
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
};

/// Calls take(record, place) -> Status for records whose places are pushed, in order, as late as possible. Places that
/// follow one another closely, as those of neighbours in a sorted run do, share a transfer. Uses tags from
/// kFirstTriangleTag on.
template <class P, class Take>
class RecordTaker {
 public:
  RecordTaker(BuildTransfers<P>& transfers, RecordRing& ring, MainAddress records, Take& take)
      : transfers_(transfers), ring_(ring), records_(records), take_(take) {}

  [[nodiscard]] GRIDIRON_INLINE Status push(std::uint32_t place) {
    transfers_.add_work(BuildWork::kAskedRecord);
    Span& span = spans_[back_ % kSpans];
    if (span.count > 0 && place - span.first < kSpan && span.count < kSpan) {
      span.wanted[span.count++] = static_cast<std::uint8_t>(place - span.first);
      span.last = place > span.last ? place : span.last;
      return Status::kOk;
    }
    if (span.count > 0) GRIDIRON_TRY(close());
    Span& next = spans_[back_ % kSpans];
    next.first = next.last = place;
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
    transfers_.add_work(BuildWork::kRecordSpan);
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
    transfers_.charge_to(BuildWork::kAskedRecord);
    const VertexTriangle* const records = window_of(front_).elements();
    for (std::uint32_t i = 0; i < span.count; ++i) {
      GRIDIRON_TRY(take_(records[span.wanted[i]], span.first + span.wanted[i]));
    }
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

/// The third quadword of a record, and that of a record in its final place: without what passes keep in its reserved
/// words.
[[nodiscard]] GRIDIRON_INLINE Lanes<4>::Int third_quad(const VertexTriangle& record) {
  return Lanes<4>::Int::load(reinterpret_cast<const std::uint32_t*>(&record) + 8);
}
[[nodiscard]] GRIDIRON_INLINE Lanes<4>::Int final_quad(Lanes<4>::Int third) {
  return third & words_quad(~0u, 0, 0, ~0u);
}
/// The same with a code in the second reserved word.
[[nodiscard]] GRIDIRON_INLINE Lanes<4>::Int with_code(Lanes<4>::Int third, std::uint32_t code) {
  using L = Lanes<4>;
  return L::words_of(L::shuffle_quads<0, 1, 4, 3>(L::floats_of(third), L::floats_of(L::Int::splat(code))));
}
/// Copies a record with another third quadword.
GRIDIRON_INLINE void copy_record(const VertexTriangle& record, Lanes<4>::Int third, VertexTriangle& copy) {
  using Int = Lanes<4>::Int;
  const auto* const from = reinterpret_cast<const std::uint32_t*>(&record);
  auto* const to = reinterpret_cast<std::uint32_t*>(&copy);
  const Int first = Int::load(from), second = Int::load(from + 4);
  first.store(to);
  second.store(to + 4);
  third.store(to + 8);
}

/// Two buffers of records that go to main memory.
template <std::uint32_t kCount>
struct RecordBuffers {
  alignas(128) std::byte bytes[2][window_bytes<VertexTriangle>(kCount)];
};

/// Writes records one after another. Uses a tag and the next one.
template <class P, std::uint32_t kCount>
class RecordWriter {
 public:
  /// @param first  place of the first one among `records`.
  RecordWriter(BuildTransfers<P>& transfers, RecordBuffers<kCount>& buffers, MainAddress records, std::uint64_t first,
               std::uint8_t tag)
      : transfers_(transfers), buffers_(buffers), records_(records), sent_(first), tag_(tag) {
    next_ = window().elements();
  }

  /// Writes a record with another third quadword.
  [[nodiscard]] GRIDIRON_INLINE Status write(const VertexTriangle& record, Lanes<4>::Int third) {
    copy_record(record, third, *next_++);
    return ++count_ == kCount ? send() : Status::kOk;
  }
  /// Room for the next records, at least one; the caller fills it. @param room  of records.
  [[nodiscard]] VertexTriangle* places(std::uint32_t& room) const {
    room = kCount - count_;
    return next_;
  }
  /// So many records have been written to places().
  [[nodiscard]] Status add(std::uint32_t count) {
    next_ += count;
    count_ += count;
    return count_ == kCount ? send() : Status::kOk;
  }
  /// Sends what is left.
  [[nodiscard]] Status send_rest() { return count_ > 0 ? put() : Status::kOk; }
  /// Sends what is left, and waits for all.
  [[nodiscard]] Status end() {
    GRIDIRON_TRY(send_rest());
    return wait_for(transfers_, tag_, 2);
  }

 private:
  [[nodiscard]] Window<VertexTriangle> window() const { return {buffers_.bytes[side_], records_, sent_}; }
  [[nodiscard]] Status put() { return window().put(transfers_, count_, static_cast<std::uint8_t>(tag_ + side_)); }
  [[nodiscard]] GRIDIRON_OUTLINE Status send() {
    GRIDIRON_TRY(put());
    sent_ += count_;
    count_ = 0;
    side_ = 1 - side_;
    next_ = window().elements();
    return transfers_.wait(static_cast<std::uint8_t>(tag_ + side_));
  }

  BuildTransfers<P>& transfers_;
  RecordBuffers<kCount>& buffers_;
  MainAddress records_;
  std::uint64_t sent_;
  std::uint8_t tag_;
  std::uint32_t side_ = 0, count_ = 0;
  VertexTriangle* next_;
};

/// Buffers of records that are read one after another.
template <std::uint32_t kCount>
struct RecordWindows {
  static constexpr std::uint32_t kWindows = 4;
  alignas(128) std::byte bytes[kWindows][window_bytes<VertexTriangle>(kCount)];
};

/// Reads records one after another, their transfers ahead. Uses tags kFirstMacroTag to kFirstMacroTag + 3.
template <class P, std::uint32_t kCount>
class RecordReader {
 public:
  RecordReader(BuildTransfers<P>& transfers, RecordWindows<kCount>& windows, MainAddress records)
      : transfers_(transfers), windows_(windows), records_(records) {}

  /// The next ones are records [first, end).
  [[nodiscard]] Status begin(std::uint32_t first, std::uint32_t end) {
    next_ = first;
    end_ = end;
    return go_on();
  }
  /// Precondition: there is one. It is lost with the next but one.
  [[nodiscard]] GRIDIRON_INLINE Status next(const VertexTriangle*& record) {
    if (left_ == 0) GRIDIRON_TRY(turn());
    record = place_++;
    ++next_;
    --left_;
    return Status::kOk;
  }
  /// Waits for all transfers; the records change or the memory is used for something else until go_on().
  [[nodiscard]] Status stop() { return wait_for(transfers_, kFirstMacroTag, kWindows); }
  [[nodiscard]] Status go_on() {
    left_ = window_ = 0;
    asked_ = next_;
    for (std::uint32_t i = 0; i + 1 < kWindows; ++i) GRIDIRON_TRY(ask(i));
    return Status::kOk;
  }

 private:
  static constexpr std::uint32_t kWindows = RecordWindows<kCount>::kWindows;

  [[nodiscard]] Status ask(std::uint32_t number) {
    if (asked_ >= end_) return Status::kOk;
    const Window<VertexTriangle> window(windows_.bytes[number % kWindows], records_, asked_);
    const std::uint32_t size = size_at(asked_);
    asked_ += size;
    return window.get(transfers_, size, tag_of(number));
  }
  [[nodiscard]] GRIDIRON_OUTLINE Status turn() {
    GRIDIRON_TRY(ask(window_ + kWindows - 1));
    GRIDIRON_TRY(transfers_.wait(tag_of(window_)));
    place_ = Window<VertexTriangle>(windows_.bytes[window_ % kWindows], records_, next_).elements();
    left_ = size_at(next_);
    ++window_;
    return Status::kOk;
  }
  [[nodiscard]] std::uint32_t size_at(std::uint32_t at) const { return end_ - at < kCount ? end_ - at : kCount; }
  [[nodiscard]] static std::uint8_t tag_of(std::uint32_t number) {
    return static_cast<std::uint8_t>(kFirstMacroTag + number % kWindows);
  }

  BuildTransfers<P>& transfers_;
  RecordWindows<kCount>& windows_;
  MainAddress records_;
  std::uint32_t next_ = 0, end_ = 0, asked_ = 0;  // records
  std::uint32_t window_ = 0, left_ = 0;           // of the current window
  const VertexTriangle* place_ = nullptr;
};

}  // namespace gridiron
