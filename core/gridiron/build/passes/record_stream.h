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
  RecordStream(Transfers<P>& transfers, RecordRing& ring, MainAddress records)
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

  Transfers<P>& transfers_;
  RecordRing& ring_;
  MainAddress records_;
  std::uint32_t pushed_ = 0, popped_ = 0, arrived_ = 0;  // counts
};

/// Calls take(record) for records whose ids are pushed, in order, as late as possible.
template <class P, class Take>
class RecordTaker {
 public:
  RecordTaker(Transfers<P>& transfers, RecordRing& ring, MainAddress records, Take& take)
      : stream_(transfers, ring, records), take_(take) {}

  [[nodiscard]] GRIDIRON_INLINE Status push(std::uint32_t id) {
    if (stream_.is_full()) GRIDIRON_TRY(take_one());
    ids_[back_++ % RecordRing::kSlots] = id;
    return stream_.push(id);
  }
  [[nodiscard]] GRIDIRON_INLINE Status end() {
    while (!stream_.is_empty()) GRIDIRON_TRY(take_one());
    return Status::kOk;
  }

 private:
  [[nodiscard]] GRIDIRON_INLINE Status take_one() {
    const VertexTriangle* record = nullptr;
    GRIDIRON_TRY(stream_.pop(ids_[front_++ % RecordRing::kSlots], record));
    take_(*record);
    return Status::kOk;
  }

  RecordStream<P> stream_;
  Take& take_;
  std::uint32_t ids_[RecordRing::kSlots];
  std::uint32_t front_ = 0, back_ = 0;
};

}  // namespace gridiron
