// Codes triangles of one code again, on a lattice of their own: in the store, or where they lie if they are too many.
// The same codes as build_tree()'s. Memory: caller's. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/passes/build_plan.h>
#include <gridiron/build/passes/pass_sort.h>
#include <gridiron/build/passes/pass_tools.h>
#include <gridiron/build/passes/record_stream.h>
#include <gridiron/build/tree/tree_box.h>
#include <gridiron/build/tree/tree_curve.h>

namespace gridiron {

// Crowds are few: one copy of each of these, as every four inlined are kilobytes on a core without vectors.
[[nodiscard]] inline GRIDIRON_OUTLINE FourBoxes boxes_of_four(const CornerQuads* corners) {
  return FourTriangles::of(corners).boxes();
}
inline GRIDIRON_OUTLINE void codes_of_four(const TreeCurve& curve, const FourBoxes& boxes, std::uint32_t* codes) {
  const Lanes<4>::Int found = curve.codes_of(boxes);
  for (int k = 0; k < 4; ++k) codes[k] = static_cast<std::uint32_t>(found[k]);
}

/// Collects records in fours and passes their boxes on.
template <class Use>
class BoxQuads {
 public:
  /// @param use  use(boxes, ids, count) for 1 to 4 triangles; if fewer than four, the last one is repeated.
  explicit BoxQuads(Use& use) : use_(use) {}

  GRIDIRON_INLINE void operator()(const VertexTriangle& record, std::uint32_t id) {
    corners_[count_] = corner_quads(record);
    ids_[count_] = id;
    if (++count_ == 4) flush();
  }
  GRIDIRON_INLINE void end() {
    if (count_ == 0) return;
    for (std::uint32_t i = count_; i < 4; ++i) corners_[i] = corners_[count_ - 1];
    flush();
  }

 private:
  GRIDIRON_INLINE void flush() {
    use_(boxes_of_four(corners_), ids_, count_);
    count_ = 0;
  }
  Use& use_;
  CornerQuads corners_[4];
  std::uint32_t ids_[4];
  std::uint32_t count_ = 0;
};

/// Calls use(boxes, ids, count) for triangles in fours. @param kind  of work. @param each_id  each_id(push) calls
/// push(id) for all of them.
template <class P, class EachId, class Use>
[[nodiscard]] Status for_each_boxes(BuildTransfers<P>& transfers, RecordRing& ring, MainAddress records, BuildWork kind,
                                    EachId&& each_id, Use&& use) {
  BoxQuads<Use> quads(use);
  RecordTaker<P, BoxQuads<Use>> taker(transfers, ring, records, kind, quads);
  const auto push = [&taker](std::uint32_t id) GRIDIRON_INLINE_LAMBDA { return taker.push(id); };
  GRIDIRON_TRY(each_id(push));
  GRIDIRON_TRY(taker.end());
  quads.end();
  return Status::kOk;
}

/// The range of triangles' middles.
template <class P, class EachId>
[[nodiscard]] Status find_middles(BuildTransfers<P>& transfers, RecordRing& ring, MainAddress records, EachId&& each_id,
                                  QuadBox& range) {
  FourBoxes middles = FourBoxes::none();
  const auto add = [&middles, &transfers](const FourBoxes& boxes, const std::uint32_t*,
                                          std::uint32_t) GRIDIRON_INLINE_LAMBDA {
    transfers.add_work(BuildWork::kMiddleGroup);
    const QuadRows middle = {boxes.low.x + boxes.high.x, boxes.low.y + boxes.high.y, boxes.low.z + boxes.high.z};
    middles.add({middle, middle});
  };
  GRIDIRON_TRY(for_each_boxes(transfers, ring, records, BuildWork::kMiddleGroup, each_id, add));
  range = QuadBox::around(middles);
  return Status::kOk;
}

/// Calls use(code, id) for triangles with their codes on a lattice, without kTreeCodedAgain. use() -> Status.
template <class P, class EachId, class Use>
[[nodiscard]] Status for_each_code(BuildTransfers<P>& transfers, RecordRing& ring, MainAddress records,
                                   const TreeCurve& curve, EachId&& each_id, Use&& use) {
  Status status = Status::kOk;
  const auto code = [&](const FourBoxes& boxes, const std::uint32_t* ids, std::uint32_t count) GRIDIRON_INLINE_LAMBDA {
    transfers.add_work(BuildWork::kAgainGroup);
    std::uint32_t codes[4];
    codes_of_four(curve, boxes, codes);
    for (std::uint32_t k = 0; k < count && status == Status::kOk; ++k) {
      status = use(codes[k], ids[k]);
    }
  };
  GRIDIRON_TRY(for_each_boxes(transfers, ring, records, BuildWork::kAgainGroup, each_id, code));
  return status;
}

/// Up to how many keys are sorted by small digits.
inline constexpr std::uint32_t kFewRunKeys = 512;

/// Codes triangles again in the store. @param keys  `key` of each has the id of its triangle, in order; gets the new
/// one. `again` is lost.
template <class Layout, class P>
[[nodiscard]] Status code_again(BuildTransfers<P>& transfers, RecordRing& ring, MainAddress records, SortedKey* keys,
                                std::uint32_t count, std::uint32_t* counts) {
  const auto number = [&] {
    for (std::uint32_t i = 0; i < count; ++i) keys[i].key = numbered(i, keys[i].key.id());
  };
  if (count <= kFewTreeTriangles) {
    number();
    return Status::kOk;
  }
  const auto each_id = [&](auto&& push) -> Status {
    for (std::uint32_t i = 0; i < count; ++i) GRIDIRON_TRY(push(keys[i].key.id()));
    return Status::kOk;
  };
  QuadBox middles;
  GRIDIRON_TRY(find_middles(transfers, ring, records, each_id, middles));
  const TreeCurve curve(middles);
  if (curve.is_flat()) {
    number();
    return Status::kOk;
  }
  std::uint32_t next = 0;
  GRIDIRON_TRY(for_each_code(transfers, ring, records, curve, each_id,
                             [&](std::uint32_t code, std::uint32_t id) GRIDIRON_INLINE_LAMBDA {
                               keys[next++].again = TreeKey::of(code | kTreeCodedAgain, id);
                               return Status::kOk;
                             }));
  constexpr std::uint32_t kFew = Layout::kFewDigitBits, kMany = Layout::kDigitBits;
  const bool is_in_key = count <= kFewRunKeys
                             ? sort_run<kFew, 2>(&keys->again, &keys->key, count, kTreeCodeBits, counts, transfers)
                             : sort_run<kMany, 2>(&keys->again, &keys->key, count, kTreeCodeBits, counts, transfers);
  if (is_in_key) return Status::kOk;
  for (std::uint32_t i = 0; i < count; ++i) keys[i].key = keys[i].again;
  return Status::kOk;
}

/// Sorts more keys than the store holds: goes through all of them for each share that it holds.
///
/// @param each   each(visit) calls visit(code, id) -> Status for all keys, in the order that equal codes keep.
/// @param flag   of all codes.
/// @param emit   emit(keys, count) -> Status takes sorted keys, `key` of each.
/// @param keys   Layout::kBucketKeys.
template <class Layout, class P, class Each, class Emit>
[[nodiscard]] Status sort_far(BuildTransfers<P>& transfers, std::uint32_t count, std::uint32_t flag, SortedKey* keys,
                              std::uint32_t* counts, Each&& each, Emit&& emit) {
  constexpr std::uint32_t kDigit = Layout::kDigitBits, kValues = 1u << kDigit, kRoom = Layout::kBucketKeys;
  std::uint32_t low = 0;  // codes below are done
  // Each share has a key at least.
  for (std::uint32_t done = 0; done < count;) {
    // The codes of the share are [low, end), or `low` alone.
    std::uint32_t start = 0, end = 0, bits = kTreeCodeBits;
    bool is_one_code = false;
    while (end == 0) {
      const std::uint32_t shift = bits > kDigit ? bits - kDigit : std::uint32_t{0};
      for (std::uint32_t i = 0; i < kValues; ++i) counts[i] = 0;
      GRIDIRON_TRY(each([&](std::uint32_t code, std::uint32_t) GRIDIRON_INLINE_LAMBDA {
        if (code >= low && code - start < (1u << bits)) ++counts[(code - start) >> shift];
        return Status::kOk;
      }));
      std::uint32_t sum = 0, value = 0;
      for (; value < (1u << (bits - shift)) && sum + counts[value] <= kRoom; ++value) sum += counts[value];
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
    std::uint32_t taken = 0;
    GRIDIRON_TRY(each([&](std::uint32_t code, std::uint32_t id) -> Status {
      if (code < low || code >= end) return Status::kOk;
      keys[taken++].key = TreeKey::of(code | flag, id);
      if (!is_one_code || taken < kRoom) return Status::kOk;
      done += taken;
      taken = 0;
      return emit(keys, kRoom);
    }));
    if (!is_one_code && sort_run<kDigit, 2>(&keys->key, &keys->again, taken, kTreeCodeBits, counts, transfers)) {
      for (std::uint32_t i = 0; i < taken; ++i) keys[i].key = keys[i].again;
    }
    done += taken;
    if (taken > 0) GRIDIRON_TRY(emit(keys, taken));
    low = end;
  }
  return Status::kOk;
}

/// Marks the first and the last `again` of a crowd, so that a part of one is not taken for the whole: where many
/// triangles are split by their number, a cut may go through a crowd.
inline constexpr std::uint64_t kCrowdEnd = 1u << kTreeCodeBits;
[[nodiscard]] inline bool is_crowd(const SortedKey& first, const SortedKey& last) {
  return (first.key.bits & kTreeCodedAgain) == 0 && (first.again.bits & last.again.bits & kCrowdEnd) != 0;
}
/// The key that follows `key` once its crowd is coded again.
[[nodiscard]] inline TreeKey again_of(const SortedKey& key) {
  return {key.again.bits & ~kCrowdEnd};
}

/// Buffers for keys that are too many for the store.
struct FarBuffers {
  static constexpr std::uint32_t kKeys = 64;
  alignas(128) std::byte read[2 * window_bytes<SortedKey>(kKeys)];
  alignas(128) std::byte written[window_bytes<SortedKey>(kKeys)];
};

/// Changes sorted keys [first, first + count) in main memory. @param change  change(key, number from first on).
/// @param buffer  of window_bytes<SortedKey>(room).
template <class P, class Change>
[[nodiscard]] Status change_far(BuildTransfers<P>& transfers, std::byte* buffer, std::uint32_t room, MainAddress sorted,
                                std::uint64_t first, std::uint32_t count, Change&& change) {
  for (std::uint32_t at = 0; at < count; at += room) {
    const std::uint32_t n = count - at < room ? count - at : room;
    const Window<SortedKey> window(buffer, sorted, first + at);
    GRIDIRON_TRY(window.get(transfers, n, kSetupTag));
    GRIDIRON_TRY(transfers.wait(kSetupTag));
    transfers.add_work(BuildWork::kGatheredKey, n);
    for (std::uint32_t i = 0; i < n; ++i) change(window.elements()[i], at + i);
    GRIDIRON_TRY(window.put(transfers, n, kSetupTag));
    GRIDIRON_TRY(transfers.wait(kSetupTag));
  }
  return Status::kOk;
}
template <class P, class Change>
[[nodiscard]] Status change_far(BuildTransfers<P>& transfers, FarBuffers& buffers, MainAddress sorted,
                                std::uint64_t first, std::uint32_t count, Change&& change) {
  return change_far(transfers, buffers.written, FarBuffers::kKeys, sorted, first, count, change);
}

/// Writes `again` of sorted keys [begin, end) that have one code, in main memory.
/// @param keys  Layout::kBucketKeys, whose contents are lost.
template <class Layout, class P>
[[nodiscard]] Status code_again_far(BuildTransfers<P>& transfers, RecordRing& ring, FarBuffers& buffers,
                                    const BuildPlan& plan, std::uint32_t begin, std::uint32_t end, SortedKey* keys,
                                    std::uint32_t* counts) {
  const std::uint32_t count = end - begin;
  const auto each_id = [&](auto&& push) -> Status {
    return for_each_window<SortedKey, FarBuffers::kKeys>(
        transfers, buffers.read, plan.sorted, begin, end, kFirstMacroTag,
        [&push](const SortedKey* window, std::uint64_t, std::uint32_t n) -> Status {
          for (std::uint32_t i = 0; i < n; ++i) GRIDIRON_TRY(push(window[i].key.id()));
          return Status::kOk;
        });
  };
  QuadBox middles;
  GRIDIRON_TRY(find_middles(transfers, ring, plan.raw_records, each_id, middles));
  const TreeCurve curve(middles);
  if (count <= kFewTreeTriangles || curve.is_flat()) {
    return change_far(transfers, buffers, plan.sorted, begin, count,
                      [](SortedKey& key, std::uint32_t i) { key.again = numbered(i, key.key.id()); });
  }
  std::uint64_t place = begin;
  return sort_far<Layout>(
      transfers, count, kTreeCodedAgain, keys, counts,
      [&](auto&& visit) { return for_each_code(transfers, ring, plan.raw_records, curve, each_id, visit); },
      [&](const SortedKey* share, std::uint32_t n) -> Status {
        const std::uint64_t first = place;
        place += n;
        return change_far(transfers, buffers, plan.sorted, first, n,
                          [share](SortedKey& key, std::uint32_t i) { key.again = share[i].key; });
      });
}

}  // namespace gridiron
