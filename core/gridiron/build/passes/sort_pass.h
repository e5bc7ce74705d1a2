// Fifth pass of a build: brings the triangles of each bucket together, sorts them, codes crowded ones again, and writes
// records and keys in their final order.
// Memory: the pass's store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/passes/build_plan.h>
#include <gridiron/build/passes/code_again.h>
#include <gridiron/build/passes/pass_sort.h>
#include <gridiron/build/passes/pass_tools.h>
#include <gridiron/build/passes/record_stream.h>

namespace gridiron {

/// A bucket with its records.
template <class Layout>
struct HeldBucket {
  alignas(128) BucketKey keys[Layout::kBucketKeys + 1];  // from an odd place on where the bucket lies at one
  alignas(128) VertexTriangle records[Layout::kBucketRecords + 1];
};

/// A bucket without its records: it may be larger than the store.
template <class Layout>
struct LoneBucket {
  static constexpr std::uint32_t kPieces = 4;  // of runs under way
  static constexpr std::uint32_t kPieceKeys = Layout::kSortsRecords ? 256 : 64;
  static constexpr std::uint32_t kScannedKeys = 64;

  alignas(128) BucketKey keys[Layout::kLoneKeys + 1];  // likewise
  alignas(128) std::byte pieces[kPieces][window_bytes<TreeKey>(kPieceKeys)];
  alignas(128) std::byte scanned[window_bytes<SortedKey>(kScannedKeys)];
  FarStore<Layout> far;
};

template <class Layout>
struct SortStore {
  static constexpr std::uint32_t kRuns = Layout::kSortsRecords ? 128 : 64;  // whose cuts are there at once

  union {
    HeldBucket<Layout> held;
    LoneBucket<Layout> lone;
  };
  RecordBuffers<Layout::kRecordWindow> sent;
  static constexpr std::uint32_t kSamples = 64;  // of sorted keys, sent at once
  alignas(128) std::byte samples[window_bytes<SortedKey>(kSamples)];
  alignas(128) std::byte cuts[2][window_bytes<std::uint32_t>(kRuns)];
  alignas(128) BuildState state;
  alignas(16) std::uint32_t counts[kSortCounts<Layout::kDigitBits>];
};

/// Sorts buckets, one after another.
template <class Layout, class P>
class BucketSorter {
 public:
  BucketSorter(BuildTransfers<P>& transfers, SortStore<Layout>& store, const BuildPlan& plan)
      : transfers_(transfers), store_(store), plan_(plan) {}

  [[nodiscard]] Status sort(std::uint32_t bucket) {
    // Where the bucket lies among all keys, and how many it has, in how many runs.
    std::uint64_t before = 0, through = 0;
    std::uint32_t runs = 0;
    GRIDIRON_TRY(each_cuts(
        bucket, [&](const std::uint32_t* begins, const std::uint32_t* ends, std::uint32_t, std::uint32_t count) {
          for (std::uint32_t i = 0; i < count; ++i) {
            before += begins[i];
            through += ends[i];
            runs += begins[i] < ends[i] ? std::uint32_t{1} : std::uint32_t{0};
          }
          return Status::kOk;
        }));
    const auto count = static_cast<std::uint32_t>(through - before);
    const auto first = static_cast<std::uint32_t>(before);
    if (count == 0) return Status::kOk;
    all_codes_ = 0;
    same_codes_ = ~0u;
    if constexpr (Layout::kSortsRecords) {
      if (count <= Layout::kBucketKeys && count + runs <= Layout::kBucketRecords) {
        BucketKey* const keys = store_.held.keys + (first & 1u);  // both ends of a transfer are congruent
        GRIDIRON_TRY(get_records(bucket, keys));
        return sort_bucket<true>(keys, first, count);
      }
    }
    if (count > Layout::kLoneKeys) return sort_many(bucket, first, count);
    BucketKey* const keys = store_.lone.keys + (first & 1u);
    std::uint32_t taken = 0;
    GRIDIRON_TRY(each_key(bucket, [&](TreeKey key) GRIDIRON_INLINE_LAMBDA {
      keys[taken++].key = note_code(key);
      return Status::kOk;
    }));
    return sort_bucket<false>(keys, first, count);
  }

 private:
  static constexpr std::uint32_t kPieceWork = 16;  // keys that take as long as beginning a piece of a run
  static constexpr std::uint32_t kPieces = LoneBucket<Layout>::kPieces, kPieceKeys = LoneBucket<Layout>::kPieceKeys;
  static constexpr std::uint32_t kScannedKeys = LoneBucket<Layout>::kScannedKeys;
  static constexpr std::uint8_t kRecordTag = kFirstOutputTag, kKeysTag = kFirstOutputTag + 2,
                                kSampleTag = kFirstOutputTag + 3;

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
  [[nodiscard]] GRIDIRON_OUTLINE Status each_key(std::uint32_t bucket, Visit&& visit) {
    return each_cuts(bucket,
                     [&](const std::uint32_t* begins, const std::uint32_t* ends, std::uint32_t first_run,
                         std::uint32_t count) -> Status {
                       std::uint64_t firsts[kPieces];
                       std::uint32_t sizes[kPieces];
                       std::uint32_t asked = 0, taken = 0;  // pieces
                       std::uint32_t run = 0, at = count > 0 ? begins[0] : std::uint32_t{0};
                       const auto window_of = [&](std::uint32_t piece) {
                         return Window<TreeKey>(store_.lone.pieces[piece % kPieces], plan_.run_keys,
                                                firsts[piece % kPieces]);
                       };
                       const auto tag_of = [](std::uint32_t piece) {
                         return static_cast<std::uint8_t>(kFirstMacroTag + piece % kPieces);
                       };
                       while (run < count || taken < asked) {
                         if (run < count && asked - taken < kPieces) {
                           const std::uint32_t rest = ends[run] - at, size = rest < kPieceKeys ? rest : kPieceKeys;
                           if (size > 0) {
                             firsts[asked % kPieces] = std::uint64_t{first_run + run} * plan_.run_triangles + at;
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

  // Gets the records of a bucket, which lie side by side in each run. Their keys come out of them.
  [[nodiscard]] Status get_records(std::uint32_t bucket, BucketKey* keys) {
    static constexpr std::uint32_t kAhead = kTriangleTagCount;  // runs
    std::uint32_t firsts[kAhead], sizes[kAhead];
    std::uint32_t asked = 0, taken = 0, slot = 0;
    const auto tag_of = [](std::uint32_t piece) {
      return static_cast<std::uint8_t>(kFirstTriangleTag + piece % kAhead);
    };
    const auto take = [&]() -> Status {
      GRIDIRON_TRY(transfers_.wait(tag_of(taken)));
      const std::uint32_t begin = firsts[taken % kAhead], size = sizes[taken % kAhead];
      transfers_.add_work(BuildWork::kGatheredKey, size + kPieceWork);
      const auto take_some = [&](std::uint32_t first, auto group) GRIDIRON_INLINE_LAMBDA {
        for (std::uint32_t i = first; i < first + group.value; ++i) {
          const std::uint32_t code = store_.held.records[begin + i].reserved[1];
          keys[i].key = note_code(TreeKey::of(code, begin + i));
        }
      };
      for_each_group(size, take_some);
      keys += size;
      ++taken;
      return Status::kOk;
    };
    const auto ask = [&](const std::uint32_t* begins, const std::uint32_t* ends, std::uint32_t first_run,
                         std::uint32_t count) -> Status {
      for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t size = ends[i] - begins[i];
        if (size == 0) continue;
        if (asked - taken == kAhead) GRIDIRON_TRY(take());
        const std::uint64_t place = std::uint64_t{first_run + i} * plan_.run_triangles + begins[i];
        slot += (slot ^ static_cast<std::uint32_t>(place)) & 1u;  // both ends are congruent
        firsts[asked % kAhead] = slot;
        sizes[asked % kAhead] = size;
        GRIDIRON_TRY(transfers_.get(store_.held.records + slot,
                                    plan_.raw_records.offset_by(place * sizeof(VertexTriangle)),
                                    size * static_cast<std::uint32_t>(sizeof(VertexTriangle)), tag_of(asked)));
        ++asked;
        slot += size;
      }
      return Status::kOk;
    };
    GRIDIRON_TRY(each_cuts(bucket, ask));
    while (taken < asked) GRIDIRON_TRY(take());
    return Status::kOk;
  }

  GRIDIRON_INLINE TreeKey note_code(TreeKey key) {
    all_codes_ |= key.code();
    same_codes_ &= key.code();
    return key;
  }

  // Sorts the keys of a bucket, whose records are in the store or not, and writes keys and records.
  template <bool kHeld>
  [[nodiscard]] Status sort_bucket(BucketKey* keys, std::uint32_t first, std::uint32_t count) {
    const auto differing = static_cast<std::uint32_t>(width_of(all_codes_ & ~same_codes_));
    if (sort_run<2>(&keys->key, &keys->again, count, Layout::kDigitBits, differing, store_.counts, transfers_)) {
      for (std::uint32_t i = 0; i < count; ++i) keys[i].key = keys[i].again;
    }
    GRIDIRON_TRY(code_crowds<kHeld>(keys, count));
    GRIDIRON_TRY(write_records<kHeld>(keys, first, count));
    GRIDIRON_TRY(transfers_.put(keys, plan_.sorted.offset_by(std::uint64_t{first} * sizeof(SortedKey)),
                                count * static_cast<std::uint32_t>(sizeof(SortedKey)), kKeysTag));
    const auto take = [keys, first](std::uint32_t place, SortedKey& sample) {
      sample = *reinterpret_cast<const SortedKey*>(keys + (place - first));
      return Status::kOk;
    };
    GRIDIRON_TRY(put_samples(first, count, take));
    return wait_for(transfers_, kRecordTag, 4);
  }
  // Writes those keys of a bucket that guide the top pass. @param take  take(place, sample) -> Status
  template <class Take>
  [[nodiscard]] Status put_samples(std::uint32_t first, std::uint32_t count, Take&& take) {
    static constexpr std::uint32_t kSamples = SortStore<Layout>::kSamples;
    const std::uint32_t step = plan_.sample_step, end = (first + count + step - 1) / step;
    for (std::uint32_t at = (first + step - 1) / step; at < end; at += kSamples) {
      const std::uint32_t n = end - at < kSamples ? end - at : kSamples;
      const Window<SortedKey> window(store_.samples, plan_.sorted_samples, at);
      GRIDIRON_TRY(transfers_.wait(kSampleTag));
      transfers_.add_work(BuildWork::kGatheredKey, n);
      for (std::uint32_t i = 0; i < n; ++i) GRIDIRON_TRY(take((at + i) * step, window.elements()[i]));
      GRIDIRON_TRY(window.put(transfers_, n, kSampleTag));
    }
    return Status::kOk;
  }

  // Codes keys again where more than kFewTreeTriangles have one code; elsewhere `again` is 0. Then the ids of keys are
  // the places of records in their final order.
  template <bool kHeld>
  [[nodiscard]] Status code_crowds(BucketKey* keys, std::uint32_t count) {
    std::uint32_t done = 0;
    for (std::uint32_t begin = 0; count - begin > kFewTreeTriangles;) {
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
      for (; done < begin; ++done) keys[done].again = {0};
      done = end;
      GRIDIRON_TRY(code_crowd<kHeld>(keys + begin, end - begin));
      begin = end;
    }
    for (; done < count; ++done) keys[done].again = {0};
    return Status::kOk;
  }
  template <bool kHeld>
  [[nodiscard]] GRIDIRON_OUTLINE Status code_crowd(BucketKey* keys, std::uint32_t count) {
    const std::uint32_t code = keys[0].key.code();
    const auto each_boxes = [&](auto& use) -> Status {
      BoxQuads quads(use, count);
      transfers_.charge_to(BuildWork::kAgainGroup);
      if constexpr (kHeld) {
        return quads.take(
            count, [&](std::uint32_t i) -> const VertexTriangle& { return store_.held.records[keys[i].key.id()]; });
      } else if constexpr (Layout::kSortsRecords) {
        return each_box_in_runs(keys, count, quads);
      } else {
        return each_record(keys, count, quads);
      }
    };
    GRIDIRON_TRY((gridiron::code_again<Layout>(transfers_, each_boxes, keys, count, store_.counts)));
    transfers_.add_work(BuildWork::kGatheredKey, 2 * count);
    for (std::uint32_t i = 0; i < count; ++i) keys[i].key = TreeKey::of(code, keys[i].again.id());
    keys[0].again.bits |= kCrowdEnd;
    keys[count - 1].again.bits |= kCrowdEnd;
    return Status::kOk;
  }
  // Calls take(record, place) for the records of keys, which are not in the store.
  template <class Take>
  [[nodiscard]] Status each_record(const BucketKey* keys, std::uint32_t count, Take& take) {
    RecordTaker<P, Take> taker(transfers_, store_.lone.far.ring, plan_.raw_records, take);
    for (std::uint32_t i = 0; i < count; ++i) GRIDIRON_TRY(taker.push(keys[i].key.id()));
    return taker.end();
  }
  // Gives the records of keys, which are in the order of the runs, to BoxQuads.
  template <class Quads>
  [[nodiscard]] Status each_box_in_runs(const BucketKey* keys, std::uint32_t count, Quads& quads) {
    static constexpr std::uint32_t kRecords = FarStore<Layout>::kRecords;
    const auto take_all = [&](const VertexTriangle* records, std::uint64_t, std::uint32_t n) -> Status {
      return quads.take(n, [records](std::uint32_t i) -> const VertexTriangle& { return records[i]; });
    };
    for (std::uint32_t begin = 0; begin < count;) {
      const std::uint32_t first = keys[begin].key.id();
      std::uint32_t end = begin + 1;
      while (end < count && keys[end].key.id() - first == end - begin) ++end;
      GRIDIRON_TRY(
          (for_each_window<VertexTriangle, kRecords>(transfers_, store_.lone.far.records, plan_.raw_records, first,
                                                     std::uint64_t{first} + (end - begin), kFirstMacroTag, take_all)));
      begin = end;
    }
    return Status::kOk;
  }

  // Begins to write the records of keys in their order, and makes of each key what becomes of it.
  template <bool kHeld>
  [[nodiscard]] Status write_records(BucketKey* keys, std::uint32_t first, std::uint32_t count) {
    RecordWriter<P, Layout::kRecordWindow> writer(transfers_, store_.sent, plan_.input.records, first, kRecordTag);
    const auto write = [](const VertexTriangle& record, BucketKey& key, VertexTriangle& copy) GRIDIRON_INLINE_LAMBDA {
      using L = Lanes<4>;
      const L::Int third = third_quad(record);
      // Of the key both codes, of the record the area.
      auto* const words = reinterpret_cast<float*>(&key);
      L::shuffle_quads<0, 2, 5, 3>(L::Float::load(words), L::floats_of(third)).store(words);
      copy_record(record, final_quad(third), copy);
    };
    transfers_.add_work(BuildWork::kSortedRecord, count);
    if constexpr (kHeld) {
      for (std::uint32_t begin = 0; begin < count;) {
        std::uint32_t room = 0;
        VertexTriangle* const copies = writer.places(room);
        const std::uint32_t rest = count - begin, n = rest < room ? rest : room;
        const auto write_some = [&](std::uint32_t i, auto group) GRIDIRON_INLINE_LAMBDA {
          for (std::uint32_t k = i; k < i + group.value; ++k) {
            BucketKey& key = keys[begin + k];
            write(store_.held.records[key.key.id()], key, copies[k]);
          }
        };
        for_each_group(n, write_some);
        GRIDIRON_TRY(writer.add(n));
        begin += n;
      }
    } else {
      BucketKey* next = keys;
      const auto take = [&](const VertexTriangle& record, std::uint32_t) -> Status {
        std::uint32_t room = 0;
        write(record, *next++, *writer.places(room));
        transfers_.charge_to(BuildWork::kSortedRecord);
        return writer.add(1);
      };
      GRIDIRON_TRY(each_record(keys, count, take));
    }
    return writer.send_rest();
  }

  // A bucket that is larger than the store.
  [[nodiscard]] GRIDIRON_RARE Status sort_many(std::uint32_t bucket, std::uint32_t first, std::uint32_t count) {
    std::uint32_t place = first;
    const auto emit = [&](BucketKey* share, std::uint32_t n) -> Status {
      RecordWriter<P, Layout::kRecordWindow> writer(transfers_, store_.sent, plan_.input.records, place, kRecordTag);
      BucketKey* next = share;
      const auto take = [&](const VertexTriangle& record, std::uint32_t) -> Status {
        const std::uint32_t code = next->key.code(), own_place = next->key.id();
        *reinterpret_cast<SortedKey*>(next++) = {code, 0, std::bit_cast<float>(record.reserved[0]), own_place};
        return writer.write(record, final_quad(third_quad(record)));
      };
      transfers_.add_work(BuildWork::kSortedRecord, n);
      RecordTaker<P, decltype(take)> taker(transfers_, store_.lone.far.ring, plan_.raw_records, take);
      for (std::uint32_t i = 0; i < n; ++i) GRIDIRON_TRY(taker.push(share[i].key.id()));
      GRIDIRON_TRY(taker.end());
      GRIDIRON_TRY(writer.end());
      for (std::uint32_t at = 0; at < n; at += kScannedKeys) {
        const std::uint32_t size = n - at < kScannedKeys ? n - at : kScannedKeys;
        const Window<SortedKey> window(store_.lone.scanned, plan_.sorted, std::uint64_t{place} + at);
        for (std::uint32_t i = 0; i < size; ++i) {
          window.elements()[i] = *reinterpret_cast<const SortedKey*>(share + at + i);
        }
        GRIDIRON_TRY(window.put(transfers_, size, kKeysTag));
        GRIDIRON_TRY(transfers_.wait(kKeysTag));
      }
      place += n;
      return Status::kOk;
    };
    const Status status = sort_far<Layout>(
        transfers_, count, store_.lone.keys, Layout::kLoneKeys, store_.counts,
        [&](auto&& visit) {
          return each_key(bucket, [&](TreeKey key) GRIDIRON_INLINE_LAMBDA { return visit(key.code(), key.id()); });
        },
        emit);
    GRIDIRON_TRY(status);
    GRIDIRON_TRY(code_crowds_far(first, count));
    const auto take = [this](std::uint32_t sampled, SortedKey& sample) -> Status {
      const Window<SortedKey> window(store_.lone.scanned, plan_.sorted, sampled);
      GRIDIRON_TRY(window.get(transfers_, 1, kSetupTag));
      GRIDIRON_TRY(transfers_.wait(kSetupTag));
      sample = *window.elements();
      return Status::kOk;
    };
    GRIDIRON_TRY(put_samples(first, count, take));
    return transfers_.wait(kSampleTag);
  }

  // Codes the crowds of a bucket again, where they lie.
  [[nodiscard]] GRIDIRON_RARE Status code_crowds_far(std::uint32_t first, std::uint32_t count) {
    FarOrder<Layout, P> order(transfers_, store_.lone.far, plan_, store_.lone.keys, Layout::kLoneKeys, store_.counts);
    std::uint32_t begin = first, at = first, code = 0;
    const auto end_crowd = [&]() -> Status {
      if (at - begin <= kFewTreeTriangles) return Status::kOk;
      return order.code_crowd(begin, at - begin);
    };
    for (; at < first + count; ++at) {
      const std::uint32_t offset = (at - first) % kScannedKeys;
      const Window<SortedKey> window(store_.lone.scanned, plan_.sorted, at - offset);
      if (offset == 0) {
        const std::uint32_t rest = first + count - at;
        GRIDIRON_TRY(window.get(transfers_, rest < kScannedKeys ? rest : kScannedKeys, kSetupTag));
        GRIDIRON_TRY(transfers_.wait(kSetupTag));
      }
      const SortedKey& key = window.elements()[offset];
      if (key.code == code && at > first) continue;
      GRIDIRON_TRY(end_crowd());
      code = key.code;
      begin = at;
    }
    return end_crowd();
  }

  BuildTransfers<P>& transfers_;
  SortStore<Layout>& store_;
  const BuildPlan& plan_;
  std::uint32_t held_bucket_ = ~0u, held_run_ = 0;
  std::uint32_t all_codes_ = 0, same_codes_ = 0;  // bits that any, and that all keys of the bucket have
};

/// Writes sorted, sorted_samples and records. Items: buckets.
template <class Layout, class P>
[[nodiscard]] Status run_sort_pass(BuildTransfers<P>& transfers, SortStore<Layout>& store, const BuildPlan& plan) {
  GRIDIRON_TRY(fetch(transfers, store.state, plan.state));
  BucketSorter<Layout, P> sorter(transfers, store, plan);
  return for_each_item(transfers, plan.bucket_room, [&](std::uint32_t bucket) {
    return bucket < store.state.bucket_count ? sorter.sort(bucket) : Status::kOk;
  });
}

}  // namespace gridiron
