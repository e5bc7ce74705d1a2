// Third pass of a build, of one item: sums up what the runs have, and chooses the codes at which buckets begin.
// Memory: the pass's store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/passes/build_plan.h>
#include <gridiron/build/passes/pass_sort.h>
#include <gridiron/build/passes/pass_tools.h>
#include <gridiron/build/tree/tree_box.h>

namespace gridiron {

template <class Layout>
struct BucketsStore {
  static constexpr std::uint32_t kWindow = 128;

  alignas(128) std::byte windows[2 * window_bytes<RunPart>(8)];
  alignas(128) std::uint32_t splitters[2][kWindow];
  alignas(128) BuildState state;
  alignas(16) TreeKey samples[Layout::kSamples];
  TreeKey spare[Layout::kSamples];
  alignas(16) std::uint32_t counts[kSortCounts<Layout::kDigitBits>];
};

/// Writes words one after another.
template <class P>
class WordWriter {
 public:
  static constexpr std::uint32_t kWindow = 128;  // words
  /// @param buffers  two. @param tag  and the next one are used. @param address  a multiple of kLineBytes.
  WordWriter(BuildTransfers<P>& transfers, std::uint32_t (*buffers)[kWindow], MainAddress address, std::uint8_t tag)
      : transfers_(transfers), buffers_(buffers), address_(address), tag_(tag) {}

  [[nodiscard]] Status write(std::uint32_t word) {
    buffers_[side_][count_++] = word;
    return count_ == kWindow ? send() : Status::kOk;
  }
  /// Puts what is left, with words without meaning behind it up to a granule, and waits.
  [[nodiscard]] Status end() {
    if (count_ > 0) GRIDIRON_TRY(send());
    return wait_for(transfers_, tag_, 2);
  }

 private:
  [[nodiscard]] Status send() {
    const std::uint32_t bytes = round_up(count_ * 4, kPortableGranuleBytes);
    GRIDIRON_TRY(transfers_.put(buffers_[side_], address_, bytes, static_cast<std::uint8_t>(tag_ + side_)));
    address_ = address_.offset_by(bytes);
    side_ = 1 - side_;
    count_ = 0;
    return transfers_.wait(static_cast<std::uint8_t>(tag_ + side_));
  }

  BuildTransfers<P>& transfers_;
  std::uint32_t (*buffers_)[kWindow];
  MainAddress address_;
  std::uint8_t tag_;
  std::uint32_t side_ = 0, count_ = 0;
};

/// Writes state and splitters: of bucket i the least code, of the one behind the last kNoSample. Items: one.
/// Errors: kNoTriangles, kMemoryTooSmall.
template <class Layout, class P>
[[nodiscard]] Status run_buckets_pass(BuildTransfers<P>& transfers, BucketsStore<Layout>& store,
                                      const BuildPlan& plan) {
  const auto sum_up = [&]() -> Status {
    FourBoxes bounds = FourBoxes::none();
    std::uint32_t count = 0;
    GRIDIRON_TRY(
        (for_each_window<RunPart, 8>(transfers, store.windows, plan.run_parts, 0, plan.run_count, kFirstMacroTag,
                                     [&](const RunPart* parts, std::uint64_t, std::uint32_t part_count) {
                                       for (std::uint32_t i = 0; i < part_count; ++i) {
                                         bounds.add(parts[i].bounds());
                                         count += parts[i].count;
                                       }
                                       return Status::kOk;
                                     })));
    if (count == 0) return Status::kNoTriangles;
    if (count > plan.input.record_room) return Status::kMemoryTooSmall;
    const QuadBox all = QuadBox::around(bounds);
    store.state = {};
    store.state.triangle_count = count;
    for (int axis = 0; axis < 3; ++axis) {
      store.state.low[axis] = lane_of(all.low, axis);
      store.state.high[axis] = lane_of(all.high, axis);
    }
    return Status::kOk;
  };
  const auto choose = [&]() -> Status {
    std::uint32_t count = 0;
    const std::uint32_t sampled = (plan.run_count + plan.sampled_runs - 1) / plan.sampled_runs;
    GRIDIRON_TRY((for_each_window<std::uint32_t, 256>(
        transfers, store.windows, plan.samples, 0, std::uint64_t{sampled} * plan.run_samples, kFirstMacroTag,
        [&](const std::uint32_t* codes, std::uint64_t, std::uint32_t code_count) {
          for (std::uint32_t i = 0; i < code_count; ++i) {
            if (codes[i] != kNoSample) store.samples[count++] = TreeKey::of(codes[i], 0);
          }
          return Status::kOk;
        })));
    const bool is_in_spare =
        sort_run<1>(store.samples, store.spare, count, Layout::kDigitBits, kTreeCodeBits, store.counts, transfers);
    const TreeKey* const sorted = is_in_spare ? store.spare : store.samples;
    // A sample stands for as many keys as there are for each of them. A code that many samples have does not share a
    // bucket that would become too large with it.
    const std::uint64_t limit = std::uint64_t{plan.bucket_limit} * count / store.state.triangle_count;
    WordWriter<P> splitters(transfers, store.splitters, plan.splitters, kFirstOutputTag);
    GRIDIRON_TRY(splitters.write(0));
    std::uint32_t buckets = 1, begin = 0;
    for (std::uint32_t i = 0; i < count;) {
      std::uint32_t end = i + 1;
      while (end < count && sorted[end].code() == sorted[i].code()) ++end;
      // Two neighbours together exceed the limit, so there is room for all.
      if (i > begin && end - begin > limit && buckets < plan.bucket_room) {
        GRIDIRON_TRY(splitters.write(sorted[i].code()));
        ++buckets;
        begin = i;
      }
      i = end;
    }
    store.state.bucket_count = buckets;
    GRIDIRON_TRY(splitters.write(kNoSample));
    GRIDIRON_TRY(splitters.end());
    GRIDIRON_TRY(transfers.put(&store.state, plan.state, sizeof(BuildState), kFirstOutputTag));
    return transfers.wait(kFirstOutputTag);
  };
  return for_each_item(transfers, 1, [&](std::uint32_t) -> Status {
    GRIDIRON_TRY(sum_up());
    return choose();
  });
}

}  // namespace gridiron
