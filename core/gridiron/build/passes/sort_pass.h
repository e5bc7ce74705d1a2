// Fifth pass of a build: brings the keys of each bucket together, sorts them, and codes crowded ones again.
// Memory: the pass's store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/passes/build_plan.h>
#include <gridiron/build/passes/code_again.h>
#include <gridiron/build/passes/pass_sort.h>
#include <gridiron/build/passes/pass_tools.h>
#include <gridiron/build/passes/record_stream.h>

namespace gridiron {

template <class Layout>
struct SortStore {
  static constexpr std::uint32_t kRuns = Layout::kBucketKeys < 4096 ? 64 : 128;  // whose cuts are there at once
  static constexpr std::uint32_t kPieces = 4;                                    // of runs under way
  static constexpr std::uint32_t kPieceKeys = Layout::kBucketKeys < 4096 ? 64 : 256;

  alignas(128) SortedKey keys[Layout::kBucketKeys + 1];  // from an odd place on where the bucket lies at one
  alignas(128) std::byte pieces[kPieces][window_bytes<TreeKey>(kPieceKeys)];
  alignas(128) std::byte cuts[2][window_bytes<std::uint32_t>(kRuns)];
  alignas(128) BuildState state;
  alignas(128) FarBuffers far;
  alignas(128) std::byte scanned[window_bytes<SortedKey>(FarBuffers::kKeys)];
  RecordRing ring;
  std::uint32_t ids[Layout::kBucketKeys];  // of crowded triangles, in their first order
  alignas(16) std::uint32_t counts[kSortCounts<Layout::kDigitBits>];
};

/// Sorts buckets, one after another.
template <class Layout, class P>
class BucketSorter {
 public:
  BucketSorter(BuildTransfers<P>& transfers, SortStore<Layout>& store, const BuildPlan& plan)
      : transfers_(transfers), store_(store), plan_(plan) {}

  [[nodiscard]] Status sort(std::uint32_t bucket) {
    // Where the bucket lies among all keys, and how many it has.
    std::uint64_t before = 0, through = 0;
    GRIDIRON_TRY(each_cuts(
        bucket, [&](const std::uint32_t* begins, const std::uint32_t* ends, std::uint32_t, std::uint32_t count) {
          for (std::uint32_t i = 0; i < count; ++i) {
            before += begins[i];
            through += ends[i];
          }
          return Status::kOk;
        }));
    const auto count = static_cast<std::uint32_t>(through - before);
    const auto first = static_cast<std::uint32_t>(before);
    if (count == 0) return Status::kOk;
    if (count > kRoom) return sort_many(bucket, first, count);

    SortedKey* const keys = store_.keys + (first & 1u);  // both ends of a transfer are congruent
    std::uint32_t taken = 0, all = 0, same = ~0u;
    GRIDIRON_TRY(each_key(bucket, [&](TreeKey key) GRIDIRON_INLINE_LAMBDA {
      keys[taken++].key = key;
      all |= key.code();
      same &= key.code();
      return Status::kOk;
    }));
    const auto differing = static_cast<std::uint32_t>(width_of(all & ~same));
    if (sort_run<Layout::kDigitBits, 2>(&keys->key, &keys->again, count, differing, store_.counts, transfers_)) {
      for (std::uint32_t i = 0; i < count; ++i) keys[i].key = keys[i].again;
    }
    GRIDIRON_TRY(code_crowded(keys, count));
    GRIDIRON_TRY(transfers_.put(keys, plan_.sorted.offset_by(std::uint64_t{first} * sizeof(SortedKey)),
                                count * static_cast<std::uint32_t>(sizeof(SortedKey)), kFirstOutputTag));
    return transfers_.wait(kFirstOutputTag);
  }

 private:
  static constexpr std::uint32_t kRoom = Layout::kBucketKeys;
  static constexpr std::uint32_t kPieceWork = 16;  // keys that take as long as beginning a piece of a run
  static constexpr std::uint32_t kPieces = SortStore<Layout>::kPieces, kPieceKeys = SortStore<Layout>::kPieceKeys;

  // Calls use(begins, ends, first run, count) for all runs of a bucket.
  template <class Use>
  [[nodiscard]] Status each_cuts(std::uint32_t bucket, Use&& use) {
    constexpr std::uint32_t kRuns = SortStore<Layout>::kRuns;
    for (std::uint32_t run = 0; run < plan_.run_count; run += kRuns) {
      const std::uint32_t rest = plan_.run_count - run, count = rest < kRuns ? rest : kRuns;
      const std::uint64_t row = std::uint64_t{bucket} * plan_.run_stride + run;
      const Window<std::uint32_t> begins(store_.cuts[0], plan_.cuts, row);
      const Window<std::uint32_t> ends(store_.cuts[1], plan_.cuts, row + plan_.run_stride);
      if (held_bucket_ != bucket || held_run_ != run) {
        held_bucket_ = bucket;
        held_run_ = run;
        GRIDIRON_TRY(begins.get(transfers_, count, kSetupTag));
        GRIDIRON_TRY(ends.get(transfers_, count, kSetupTag));
        GRIDIRON_TRY(transfers_.wait(kSetupTag));
      }
      GRIDIRON_TRY(use(begins.elements(), ends.elements(), run, count));
    }
    return Status::kOk;
  }

  // Calls visit(key) for the keys of a bucket, run by run, their transfers ahead.
  template <class Visit>
  [[nodiscard]] Status each_key(std::uint32_t bucket, Visit&& visit) {
    return each_cuts(bucket,
                     [&](const std::uint32_t* begins, const std::uint32_t* ends, std::uint32_t first_run,
                         std::uint32_t count) -> Status {
                       std::uint64_t firsts[kPieces];
                       std::uint32_t sizes[kPieces];
                       std::uint32_t asked = 0, taken = 0;  // pieces
                       std::uint32_t run = 0, at = count > 0 ? begins[0] : std::uint32_t{0};
                       const auto window_of = [&](std::uint32_t piece) {
                         return Window<TreeKey>(store_.pieces[piece % kPieces], plan_.run_keys,
                                                firsts[piece % kPieces]);
                       };
                       const auto tag_of = [](std::uint32_t piece) {
                         return static_cast<std::uint8_t>(kFirstMacroTag + piece % kPieces);
                       };
                       while (run < count || taken < asked) {
                         if (run < count && asked - taken < kPieces) {
                           const std::uint32_t rest = ends[run] - at, size = rest < kPieceKeys ? rest : kPieceKeys;
                           if (size > 0) {
                             firsts[asked % kPieces] = std::uint64_t{first_run + run} * Layout::kRunTriangles + at;
                             sizes[asked % kPieces] = size;
                             GRIDIRON_TRY(window_of(asked).get(transfers_, size, tag_of(asked)));
                             ++asked;
                             at += size;
                           }
                           if (at == ends[run]) {
                             ++run;
                             at = run < count ? begins[run] : std::uint32_t{0};
                           }
                           continue;
                         }
                         GRIDIRON_TRY(transfers_.wait(tag_of(taken)));
                         const TreeKey* const keys = window_of(taken).elements();
                         const std::uint32_t size = sizes[taken % kPieces];
                         transfers_.add_work(BuildWork::kGatheredKey, size + kPieceWork);
                         const auto place = static_cast<std::uint32_t>(firsts[taken % kPieces]);
                         for (std::uint32_t i = 0; i < size; ++i) {
                           // Of sorted records the place is that of the key in its run.
                           if constexpr (Layout::kSortsRecords) {
                             GRIDIRON_TRY(visit(TreeKey::of(keys[i].code(), place + i)));
                           } else {
                             GRIDIRON_TRY(visit(keys[i]));
                           }
                         }
                         ++taken;
                       }
                       return Status::kOk;
                     });
  }

  // Codes keys again where more than kFewTreeTriangles have one code.
  [[nodiscard]] Status code_crowded(SortedKey* keys, std::uint32_t count) {
    for (std::uint32_t begin = 0; begin < count;) {
      if (count - begin <= kFewTreeTriangles) break;
      // Most codes are rare: look at the key that would make a crowd.
      const std::uint32_t code = keys[begin].key.code();
      std::uint32_t later = begin + kFewTreeTriangles;
      if (keys[later].key.code() != code) {
        // The first key of its code; at most kFewTreeTriangles steps.
        while (keys[later - 1].key.code() == keys[later].key.code()) --later;
        begin = later;
        continue;
      }
      std::uint32_t end = begin + kFewTreeTriangles + 1;
      while (end < count && keys[end].key.code() == code) ++end;
      const std::uint32_t size = end - begin;
      transfers_.add_work(BuildWork::kGatheredKey, 2 * size);
      for (std::uint32_t i = 0; i < size; ++i) store_.ids[i] = keys[begin + i].key.id();
      GRIDIRON_TRY((code_again<Layout>(transfers_, store_.ring, plan_.raw_records, keys + begin, size, store_.counts)));
      for (std::uint32_t i = 0; i < size; ++i) {
        keys[begin + i] = {TreeKey::of(code, store_.ids[i]), keys[begin + i].key};
      }
      keys[begin].again.bits |= kCrowdEnd;
      keys[end - 1].again.bits |= kCrowdEnd;
      begin = end;
    }
    return Status::kOk;
  }

  // A bucket that is larger than the store.
  [[nodiscard]] GRIDIRON_OUTLINE Status sort_many(std::uint32_t bucket, std::uint32_t first, std::uint32_t count) {
    std::uint64_t place = first;
    GRIDIRON_TRY((sort_far<Layout>(
        transfers_, count, 0, store_.keys, store_.counts,
        [&](auto&& visit) { return each_key(bucket, [&](TreeKey key) { return visit(key.code(), key.id()); }); },
        [&](const SortedKey* share, std::uint32_t n) -> Status {
          const std::uint64_t at = place;
          place += n;
          return change_far(transfers_, store_.far, plan_.sorted, at, n,
                            [share](SortedKey& key, std::uint32_t i) { key = share[i]; });
        })));
    std::uint32_t begin = first, at = first, code = 0;
    const auto end_crowd = [&]() -> Status {
      if (at - begin <= kFewTreeTriangles) return Status::kOk;
      GRIDIRON_TRY(
          (code_again_far<Layout>(transfers_, store_.ring, store_.far, plan_, begin, at, store_.keys, store_.counts)));
      const auto mark = [](SortedKey& key, std::uint32_t) { key.again.bits |= kCrowdEnd; };
      GRIDIRON_TRY(change_far(transfers_, store_.far, plan_.sorted, begin, 1, mark));
      return change_far(transfers_, store_.far, plan_.sorted, at - 1, 1, mark);
    };
    // One after another: what codes again uses the buffers of windows.
    for (; at < first + count; ++at) {
      const std::uint32_t offset = (at - first) % FarBuffers::kKeys;
      const Window<SortedKey> window(store_.scanned, plan_.sorted, at - offset);
      if (offset == 0) {
        const std::uint32_t rest = first + count - at;
        GRIDIRON_TRY(window.get(transfers_, rest < FarBuffers::kKeys ? rest : FarBuffers::kKeys, kSetupTag));
        GRIDIRON_TRY(transfers_.wait(kSetupTag));
      }
      const std::uint32_t here = window.elements()[offset].key.code();
      if (here == code && at > first) continue;
      GRIDIRON_TRY(end_crowd());
      code = here;
      begin = at;
    }
    return end_crowd();
  }

  BuildTransfers<P>& transfers_;
  SortStore<Layout>& store_;
  const BuildPlan& plan_;
  std::uint32_t held_bucket_ = ~0u, held_run_ = 0;
};

/// Writes sorted. Items: buckets.
template <class Layout, class P>
[[nodiscard]] Status run_sort_pass(BuildTransfers<P>& transfers, SortStore<Layout>& store, const BuildPlan& plan) {
  GRIDIRON_TRY(fetch(transfers, store.state, plan.state));
  BucketSorter<Layout, P> sorter(transfers, store, plan);
  return for_each_item(transfers, plan.bucket_room, [&](std::uint32_t bucket) {
    return bucket < store.state.bucket_count ? sorter.sort(bucket) : Status::kOk;
  });
}

}  // namespace gridiron
