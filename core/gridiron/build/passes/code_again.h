// Codes triangles of one code again, on a lattice of their own: in the store, or where they lie if they are too many.
// The same codes as build_tree()'s. Memory: caller's. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/passes/build_plan.h>
#include <gridiron/build/passes/pass_sort.h>
#include <gridiron/build/passes/pass_tools.h>
#include <gridiron/build/passes/record_stream.h>
#include <gridiron/build/tree/tree_box.h>
#include <gridiron/build/tree/tree_curve.h>
#include <gridiron/build/tree/tree_order.h>

namespace gridiron {

/// A key that is being sorted, and the one that follows it once its crowd is coded again.
struct alignas(16) BucketKey {
  TreeKey key, again;
};
static_assert(sizeof(BucketKey) == sizeof(SortedKey));

// Crowds are few: one copy of each of these, as every four inlined are kilobytes on a core without vectors.
[[nodiscard]] inline GRIDIRON_OUTLINE FourBoxes boxes_of_four(const CornerQuads* corners) {
  return FourTriangles::of(corners).boxes();
}
inline GRIDIRON_OUTLINE void codes_of_four(const TreeCurve& curve, const FourBoxes& boxes, std::uint32_t* codes) {
  const Lanes<4>::Int found = curve.codes_of(boxes);
  for (int k = 0; k < 4; ++k) codes[k] = static_cast<std::uint32_t>(found[k]);
}

/// Calls use(boxes, count) -> Status for triangles in fours; if fewer than four are left, the last one is repeated.
template <class Use>
class BoxQuads {
 public:
  /// @param count  of triangles in all.
  BoxQuads(Use& use, std::uint32_t count) : use_(use), left_(count) {}

  [[nodiscard]] GRIDIRON_INLINE Status operator()(const VertexTriangle& record, std::uint32_t) {
    corners_[held_++] = corner_quads(record);
    --left_;
    return held_ < 4 && left_ > 0 ? Status::kOk : flush();
  }
  /// The same for several that are in the store. @param record_of  record_of(i) -> const VertexTriangle&
  template <class RecordOf>
  [[nodiscard]] GRIDIRON_INLINE Status take(std::uint32_t count, RecordOf&& record_of) {
    std::uint32_t i = 0;
    for (; i < count && held_ > 0; ++i) GRIDIRON_TRY((*this)(record_of(i), i));
    for (; count - i >= 4; i += 4) {
      for (std::uint32_t k = 0; k < 4; ++k) corners_[k] = corner_quads(record_of(i + k));
      left_ -= 4;
      GRIDIRON_TRY(use_(boxes_of_four(corners_), 4));
    }
    for (; i < count; ++i) GRIDIRON_TRY((*this)(record_of(i), i));
    return Status::kOk;
  }

 private:
  [[nodiscard]] GRIDIRON_OUTLINE Status flush() {
    const std::uint32_t count = held_;
    for (; held_ < 4; ++held_) corners_[held_] = corners_[count - 1];
    held_ = 0;
    return use_(boxes_of_four(corners_), count);
  }
  Use& use_;
  CornerQuads corners_[4];
  std::uint32_t held_ = 0, left_;
};

/// Collects the range of triangles' middles.
class MiddleBounds {
 public:
  GRIDIRON_INLINE void add(const FourBoxes& boxes) {
    const QuadRows middle = {boxes.low.x + boxes.high.x, boxes.low.y + boxes.high.y, boxes.low.z + boxes.high.z};
    middles_.add({middle, middle});
  }
  [[nodiscard]] QuadBox range() const { return QuadBox::around(middles_); }

 private:
  FourBoxes middles_ = FourBoxes::none();
};

/// Up to how many keys are sorted by small digits.
inline constexpr std::uint32_t kFewRunKeys = 512;

/// What goes through triangles that are coded again: first for the range of their middles, then for their codes.
template <class P, class Put>
class AgainCoder {
 public:
  /// @param put  put(code) -> Status takes the codes of triangles in their order.
  AgainCoder(BuildTransfers<P>& transfers, Put& put) : transfers_(transfers), put_(put) {}

  /// Goes through them. @param each_boxes  each_boxes(use) calls use(boxes, count) -> Status for all in fours. ->
  /// Status
  /// @param are_coded  false if all are in one place; then no code was put.
  template <class EachBoxes>
  [[nodiscard]] Status code(EachBoxes&& each_boxes, bool& are_coded) {
    // One call, as it is inlined.
    for (; turn_ < 2; ++turn_) {
      GRIDIRON_TRY(each_boxes(*this));
      if (turn_ == 0) curve_ = TreeCurve(middles_.range());
      if (curve_.is_flat()) break;
    }
    are_coded = !curve_.is_flat();
    return Status::kOk;
  }
  [[nodiscard]] Status operator()(const FourBoxes& boxes, std::uint32_t count) {
    transfers_.add_work(BuildWork::kAgainGroup);
    if (turn_ == 0) {
      middles_.add(boxes);
      return Status::kOk;
    }
    std::uint32_t codes[4];
    codes_of_four(curve_, boxes, codes);
    for (std::uint32_t k = 0; k < count; ++k) GRIDIRON_TRY(put_(codes[k]));
    return Status::kOk;
  }

 private:
  BuildTransfers<P>& transfers_;
  Put& put_;
  MiddleBounds middles_;
  TreeCurve curve_{QuadBox{}};
  std::uint32_t turn_ = 0;
};

/// Takes codes of triangles into the keys that they are sorted by.
struct AgainKeys {
  BucketKey* next;

  [[nodiscard]] GRIDIRON_INLINE Status operator()(std::uint32_t code) {
    next->again = TreeKey::of(code | kTreeCodedAgain, next->key.id());
    ++next;
    return Status::kOk;
  }
};

/// Codes triangles again in the store.
///
/// @param each_boxes  of AgainCoder::code().
/// @param keys        get their new codes and their ids, sorted, in `again`; `key` is lost.
template <class Layout, class P, class EachBoxes>
[[nodiscard]] Status code_again(BuildTransfers<P>& transfers, EachBoxes&& each_boxes, BucketKey* keys,
                                std::uint32_t count, std::uint32_t* counts) {
  AgainKeys put{keys};
  AgainCoder<P, AgainKeys> coder(transfers, put);
  bool are_coded = false;
  GRIDIRON_TRY(coder.code(each_boxes, are_coded));
  if (!are_coded) {
    for (std::uint32_t i = 0; i < count; ++i) keys[i].again = numbered(i, keys[i].key.id());
    return Status::kOk;
  }
  const std::uint32_t digit_bits = count <= kFewRunKeys ? Layout::kFewDigitBits : Layout::kDigitBits;
  if (!sort_run<2>(&keys->again, &keys->key, count, digit_bits, kTreeCodeBits, counts, transfers)) return Status::kOk;
  for (std::uint32_t i = 0; i < count; ++i) keys[i].again = keys[i].key;
  return Status::kOk;
}

/// Sorts more keys than the store holds: goes through all of them for each share that it holds.
///
/// @param each   each(visit) calls visit(code, id) -> Status for all keys, in the order that equal codes keep.
/// @param emit   emit(keys, count) -> Status takes sorted keys, `key` of each.
/// @param keys   `room` of them.
template <class Layout, class P, class Each, class Emit>
[[nodiscard]] Status sort_far(BuildTransfers<P>& transfers, std::uint32_t count, BucketKey* keys, std::uint32_t room,
                              std::uint32_t* counts, Each&& each, Emit&& emit) {
  constexpr std::uint32_t kDigit = Layout::kDigitBits, kValues = 1u << kDigit;
  std::uint32_t low = 0;  // codes below are done
  std::uint32_t start = 0, end = 0, bits = 0, shift = 0, taken = 0, done = 0;
  bool is_counted = false, is_one_code = false;
  // Counts a digit of the codes that are left, or takes the share. One function for both, as it is inlined.
  const auto visit = [&](std::uint32_t code, std::uint32_t id) -> Status {
    if (code < low) return Status::kOk;
    if (is_counted) {
      if (code - start < (1u << bits)) ++counts[(code - start) >> shift];
      return Status::kOk;
    }
    if (code >= end) return Status::kOk;
    keys[taken++].key = TreeKey::of(code, id);
    if (!is_one_code || taken < room) return Status::kOk;
    done += taken;
    taken = 0;
    return emit(keys, room);
  };
  // Each share has a key at least.
  while (done < count) {
    // The codes of the share are [low, end), or `low` alone.
    start = end = 0;
    bits = kTreeCodeBits;
    is_one_code = false;
    is_counted = true;
    while (end == 0) {
      shift = bits > kDigit ? bits - kDigit : std::uint32_t{0};
      for (std::uint32_t i = 0; i < kValues; ++i) counts[i] = 0;
      GRIDIRON_TRY(each(visit));
      std::uint32_t sum = 0, value = 0;
      for (; value < (1u << (bits - shift)) && sum + counts[value] <= room; ++value) sum += counts[value];
      if (sum > 0) {
        end = start + (value << shift);
        break;
      }
      // The first code that is left is one of too many: only a finer look can part them.
      start += value << shift;
      low = low > start ? low : start;
      if (shift == 0) {
        is_one_code = true;
        low = start;
        end = start + 1;
      }
      bits = shift;
    }
    is_counted = false;
    taken = 0;
    GRIDIRON_TRY(each(visit));
    if (!is_one_code && sort_run<2>(&keys->key, &keys->again, taken, kDigit, kTreeCodeBits, counts, transfers)) {
      for (std::uint32_t i = 0; i < taken; ++i) keys[i].key = keys[i].again;
    }
    done += taken;
    if (taken > 0) GRIDIRON_TRY(emit(keys, taken));
    low = end;
  }
  return Status::kOk;
}

/// Marks `again` of the first and the last of a crowd, so that a part of one is not taken for the whole: where many
/// triangles are split by their number, a cut may go through a crowd.
inline constexpr std::uint32_t kCrowdEnd = 1u << kTreeCodeBits;
/// Whether a range of one code is a crowd that stands in the order of `again` but is not split by it yet.
[[nodiscard]] inline bool is_crowd(const SortedKey& first, const SortedKey& last) {
  return (first.code & kTreeCodedAgain) == 0 && (first.again & last.again & kCrowdEnd) != 0;
}
/// The code by which a triangle of a crowd is split.
[[nodiscard]] inline std::uint32_t again_of(const SortedKey& key) {
  return key.again & ~kCrowdEnd;
}

/// Memory of what goes through triangles that lie in main memory.
template <class Layout>
struct FarStore {
  static constexpr std::uint32_t kRecords = Layout::kRecordWindow;  // at once

  RecordRing ring;
  RecordBuffers<kRecords> sent;
  alignas(128) std::byte records[2 * window_bytes<VertexTriangle>(kRecords)];
  alignas(128) std::byte keys[2 * window_bytes<SortedKey>(kRecords)];
  alignas(128) std::byte changed[window_bytes<SortedKey>(kRecords)];
};

/// Gives triangles of one code another order where they lie: sorted keys and records. Slow: for crowds that no store
/// holds, and for trees so deep that crowds are cut in parts.
template <class Layout, class P>
class FarOrder {
 public:
  /// @param share  room for `room` keys. @param counts  of sort_run().
  FarOrder(BuildTransfers<P>& transfers, FarStore<Layout>& store, const BuildPlan& plan, BucketKey* share,
           std::uint32_t room, std::uint32_t* counts)
      : transfers_(transfers), store_(store), plan_(plan), share_(share), room_(room), counts_(counts) {}

  /// Codes a crowd again whose keys have the places of its records among those of the runs. The new codes come to
  /// stand in `again`.
  [[nodiscard]] Status code_crowd(std::uint32_t begin, std::uint32_t count) {
    result_ = Result::kCrowd;
    source_ = plan_.raw_records;
    target_ = plan_.input.records;
    return code(begin, count);
  }
  /// Codes triangles again when all are sorted; the new codes take the place of the old ones.
  [[nodiscard]] Status code_again(std::uint32_t begin, std::uint32_t count) {
    GRIDIRON_TRY(begin_sorted(begin, count, Result::kAgain));
    return code(begin, count);
  }
  /// Restores the order that triangles of one code had before they were coded again as a crowd: that of their ids.
  [[nodiscard]] GRIDIRON_RARE Status restore(std::uint32_t begin, std::uint32_t count) {
    GRIDIRON_TRY(begin_sorted(begin, count, Result::kRestored));
    next_ = 0;
    const auto take = [this](const VertexTriangle& record, std::uint32_t) { return put_code(record.triangle_id); };
    GRIDIRON_TRY(each_record(take));
    return sort();
  }

 private:
  static constexpr std::uint32_t kRecords = FarStore<Layout>::kRecords;
  // What a key becomes.
  enum class Result : std::uint8_t { kCrowd, kAgain, kRestored };

  [[nodiscard]] static std::uint32_t at_most(std::uint32_t count) { return count < kRecords ? count : kRecords; }

  // The records of runs are not needed any more: their place takes the records of another order.
  [[nodiscard]] Status begin_sorted(std::uint32_t begin, std::uint32_t count, Result result) {
    begin_ = begin;
    count_ = count;
    result_ = result;
    source_ = plan_.input.records;
    target_ = plan_.raw_records;
    return change_keys([begin](SortedKey& key, std::uint32_t i) { key.place = begin + i; });
  }

  [[nodiscard]] GRIDIRON_RARE Status code(std::uint32_t begin, std::uint32_t count) {
    begin_ = begin;
    count_ = count;
    bool are_coded = false;
    next_ = 0;
    const auto put = [this](std::uint32_t code) { return put_code(code); };
    AgainCoder<P, decltype(put)> coder(transfers_, put);
    if (count > kFewTreeTriangles) {
      const auto each_boxes = [this](auto& use) {
        BoxQuads quads(use, count_);
        return each_record(quads);
      };
      GRIDIRON_TRY(coder.code(each_boxes, are_coded));
    }
    if (are_coded) return sort();
    return change_keys([this](SortedKey& key, std::uint32_t i) { key = key_of(key.code, i, key.area, i); });
  }

  [[nodiscard]] SortedKey key_of(std::uint32_t code, std::uint32_t again, float area, std::uint32_t number) const {
    if (result_ == Result::kRestored) return {code, 0, area, 0};
    again |= kTreeCodedAgain;
    // Whether a part of a crowd is split by the old codes or by the new ones.
    if (result_ == Result::kAgain) return {again, again, area, 0};
    const bool is_end = number == 0 || number == count_ - 1;
    return {code, is_end ? again | kCrowdEnd : again, area, 0};
  }

  template <class Use>
  [[nodiscard]] GRIDIRON_OUTLINE Status each_key(Use&& use) {
    return for_each_window<SortedKey, kRecords>(transfers_, store_.keys, plan_.sorted, begin_,
                                                std::uint64_t{begin_} + count_, kFirstMacroTag,
                                                [&](const SortedKey* keys, std::uint64_t, std::uint32_t n) -> Status {
                                                  transfers_.add_work(BuildWork::kGatheredKey, n);
                                                  for (std::uint32_t i = 0; i < n; ++i) GRIDIRON_TRY(use(keys[i]));
                                                  return Status::kOk;
                                                });
  }
  // Calls take(record, place) for all triangles in their order.
  template <class Take>
  [[nodiscard]] Status each_record(Take& take) {
    RecordTaker<P, Take> taker(transfers_, store_.ring, source_, take);
    const auto push = [&taker](const SortedKey& key) { return taker.push(key.place); };
    GRIDIRON_TRY(each_key(push));
    return taker.end();
  }
  // Changes all keys. @param change  change(key, number).
  template <class Change>
  [[nodiscard]] Status change_keys(Change&& change) {
    for (std::uint32_t at = 0; at < count_; at += kRecords) {
      const std::uint32_t n = at_most(count_ - at);
      GRIDIRON_TRY(get_changed(at));
      transfers_.add_work(BuildWork::kGatheredKey, n);
      for (std::uint32_t i = 0; i < n; ++i) change(changed(at).elements()[i], at + i);
      GRIDIRON_TRY(put_changed(at));
    }
    return Status::kOk;
  }
  // The key of the next triangle gets the code by which it is sorted.
  [[nodiscard]] Status put_code(std::uint32_t code) {
    const std::uint32_t i = next_ % kRecords, at = next_ - i;
    if (i == 0) GRIDIRON_TRY(get_changed(at));
    SortedKey& key = changed(at).elements()[i];
    code_ = key.code;
    key.again = code;
    ++next_;
    return i + 1 == kRecords || next_ == count_ ? put_changed(at) : Status::kOk;
  }
  [[nodiscard]] Window<SortedKey> changed(std::uint32_t at) const {
    return {store_.changed, plan_.sorted, std::uint64_t{begin_} + at};
  }
  [[nodiscard]] Status get_changed(std::uint32_t at) {
    GRIDIRON_TRY(changed(at).get(transfers_, at_most(count_ - at), kSetupTag));
    return transfers_.wait(kSetupTag);
  }
  [[nodiscard]] Status put_changed(std::uint32_t at) {
    GRIDIRON_TRY(changed(at).put(transfers_, at_most(count_ - at), kSetupTag));
    return transfers_.wait(kSetupTag);
  }

  // Sorts by `again`: records go to the target, and keys and records from there to their final places.
  [[nodiscard]] GRIDIRON_RARE Status sort() {
    const auto each = [this](auto&& visit) -> Status {
      return this->each_key([&visit](const SortedKey& key) { return visit(key.again, key.place); });
    };
    std::uint32_t sorted = begin_;
    const auto emit = [&](const BucketKey* share, std::uint32_t n) -> Status {
      RecordWriter<P, kRecords> writer(transfers_, store_.sent, target_, sorted, kFirstOutputTag);
      const BucketKey* next = share;
      const auto take = [&](const VertexTriangle& record, std::uint32_t) -> Status {
        // Its code comes back in a reserved word.
        const std::uint32_t code = next++->key.code();
        return writer.write(record, with_code(third_quad(record), code));
      };
      transfers_.add_work(BuildWork::kSortedRecord, n);
      RecordTaker<P, decltype(take)> taker(transfers_, store_.ring, source_, take);
      for (std::uint32_t i = 0; i < n; ++i) GRIDIRON_TRY(taker.push(share[i].key.id()));
      GRIDIRON_TRY(taker.end());
      sorted += n;
      return writer.end();
    };
    GRIDIRON_TRY(sort_far<Layout>(transfers_, count_, share_, room_, counts_, each, emit));
    return take_back();
  }
  [[nodiscard]] Status take_back() {
    RecordWriter<P, kRecords> writer(transfers_, store_.sent, plan_.input.records, begin_, kFirstOutputTag);
    const auto take = [&](const VertexTriangle* records, std::uint64_t first, std::uint32_t n) -> Status {
      const auto at = static_cast<std::uint32_t>(first) - begin_;
      transfers_.add_work(BuildWork::kSortedRecord, n);
      for (std::uint32_t i = 0; i < n; ++i) {
        const VertexTriangle& record = records[i];
        changed(at).elements()[i] = key_of(code_, record.reserved[1], area_of(corner_quads(record)), at + i);
        GRIDIRON_TRY(writer.write(record, final_quad(third_quad(record))));
      }
      return put_changed(at);
    };
    GRIDIRON_TRY((for_each_window<VertexTriangle, kRecords>(transfers_, store_.records, target_, begin_,
                                                            std::uint64_t{begin_} + count_, kFirstMacroTag, take)));
    return writer.end();
  }

  BuildTransfers<P>& transfers_;
  FarStore<Layout>& store_;
  const BuildPlan& plan_;
  BucketKey* share_;
  std::uint32_t room_;
  std::uint32_t* counts_;
  MainAddress source_{}, target_{};
  std::uint32_t begin_ = 0, count_ = 0, next_ = 0;
  std::uint32_t code_ = 0;  // that all had
  Result result_ = Result::kAgain;
};

}  // namespace gridiron
