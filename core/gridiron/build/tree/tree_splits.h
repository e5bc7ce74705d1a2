// How a range of triangles, sorted by their codes, is split into the children of a node: the one rule of all builders.
// Source: own; splits at the highest bits of Morton codes as in Lauterbach and others 2009, "Fast BVH Construction on
// GPUs". Internal header. Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/build/tree/tree_curve.h>
#include <gridiron/platform/status.h>

#include <cstdint>

namespace gridiron {

/// A run of sorted triangles: a child of a node, or a part that is to be split into several.
struct TreeRange {
  std::uint32_t begin, end;
  std::int32_t level;    ///< the highest bit in which codes differ, from 1; 0: they are equal; -1: a leaf
  std::uint32_t group;   ///< of a node's first four parts: from which it comes
  std::uint64_t weight;  ///< of parts that can be split, in the order in which they are; 0: a leaf
};

/// What splitting takes, for builders that count their work: parts made by splitting another one, parts whose weights
/// were compared, steps to the place where a part is split, leaves found.
enum class SplitWork : std::uint8_t { kPart, kWeighedPart, kSearchStep, kLeaf };

/// Splits ranges. @tparam Self  a class that derives from this one and knows the keys:
///   std::uint32_t code_of(i)              the code of key i
///   std::uint32_t middle_of(range)        where a part of level > 0 is split; first_like_last() finds it
///   Status code_again(begin, end)         gives keys of one code codes that differ, and sorts them
///   std::uint32_t whole_count()           keys in all
///   Status restore_order(begin, end)      a range will be cut by number: its keys must stand in the order that they
///   had
///                                         when those of one code had not been coded again; may be left out
///   void count_work(SplitWork, amount)    what follows takes so much more of a kind of work; may be left out
template <class Self>
class TreeSplits {
 public:
  explicit TreeSplits(std::uint32_t leaf_triangles) : leaf_triangles_(leaf_triangles) {}

  /// Splits the range of a node. @param depth  nodes on the path to it, itself included.
  /// @param ranges  room for kTreeWidth. @param count  of them.
  [[nodiscard]] GRIDIRON_INLINE Status split_range(std::uint32_t begin, std::uint32_t end, std::uint32_t depth,
                                                   TreeRange* ranges, std::uint32_t& count) {
    if (is_deep(end - begin, depth)) {
      GRIDIRON_TRY(self().restore_order(begin, end));
      count = split_by_number(begin, end, ranges);
      return Status::kOk;
    }
    count = split_to_leaves(begin, end, ranges);
    return count == 0 ? split_by_codes(begin, end, ranges, count) : Status::kOk;
  }

 protected:
  GRIDIRON_INLINE void count_work(SplitWork, std::uint32_t) const {}
  [[nodiscard]] static Status restore_order(std::uint32_t, std::uint32_t) { return Status::kOk; }

  [[nodiscard]] TreeRange range_of(std::uint32_t begin, std::uint32_t end) const {
    const std::uint32_t size = end - begin;
    if (size <= leaf_triangles_) return {begin, end, -1, 0, 0};
    const std::int32_t level = width_of(code_of(begin) ^ code_of(end - 1));
    // Rays meet large cells, and a box is worth more above many triangles.
    const std::int32_t weight = 2 * kMostWeight + kLevelWeight * level + kNumberWeight * width_of(size);
    return {begin, end, level, 0, static_cast<std::uint64_t>(weight) << kWeightShift | size << kNumberBits};
  }

  // Whether so many triangles might not fit below a node: of d levels of nodes below it, each 16 times as many as of
  // d - 1. Splitting them by their number makes a sixteenth of them fit a level less.
  [[nodiscard]] bool is_deep(std::uint32_t count, std::uint32_t depth) const {
    std::uint64_t fitting = leaf_triangles_;
    for (std::uint32_t level = depth; level < kMaxTreeDepth && fitting < count; ++level) fitting *= kTreeWidth;
    return count > fitting;
  }

  // Into as many parts as leaves are needed, at most 16.
  [[nodiscard]] std::uint32_t split_by_number(std::uint32_t begin, std::uint32_t end, TreeRange* ranges) const {
    const std::uint64_t count = end - begin;
    const std::uint64_t leaves = (count + leaf_triangles_ - 1) / leaf_triangles_;
    const std::uint64_t parts = leaves < kTreeWidth ? leaves : std::uint64_t{kTreeWidth};
    for (std::uint64_t i = 0; i < parts; ++i) {
      ranges[i] = range_of(begin + static_cast<std::uint32_t>(count * i / parts),
                           begin + static_cast<std::uint32_t>(count * (i + 1) / parts));
    }
    return static_cast<std::uint32_t>(parts);
  }

  // Where all parts become leaves before there are too many, it does not matter which one is split first. Such nodes
  // are most of all. @returns 0 where they do not, and where codes are equal.
  [[nodiscard]] std::uint32_t split_to_leaves(std::uint32_t begin, std::uint32_t end, TreeRange* ranges) const {
    if (end - begin > kTreeWidth * leaf_triangles_) return 0;
    note(SplitWork::kLeaf, 0);
    std::uint32_t ends[kTreeWidth];  // of the parts from `begin` on, the last first
    std::uint32_t count = 0, open = 1;
    ends[0] = end;
    while (open > 0) {
      const std::uint32_t part_end = ends[open - 1];
      if (part_end - begin <= leaf_triangles_) {
        ranges[count++] = {begin, part_end, -1, 0, 0};
        begin = part_end;
        --open;
        continue;
      }
      const std::uint32_t first = code_of(begin), last = code_of(part_end - 1);
      if (first == last || count + open == kTreeWidth) return 0;
      ends[open] = first_like_last(begin, part_end, first, last);
      ++open;
      note(SplitWork::kLeaf, 0);
    }
    return count;
  }

  // The first key that has the highest bit in which the first and the last one differ as the last one has it.
  [[nodiscard]] std::uint32_t first_like_last(std::uint32_t begin, std::uint32_t end, std::uint32_t first,
                                              std::uint32_t last) const {
    // The first is among [low, low + count]. No branch depends on a code: none could be predicted.
    std::uint32_t low = begin + 1;
    for (std::uint32_t count = end - begin - 2; count > 0;) {
      note(SplitWork::kSearchStep, 1);
      const std::uint32_t half = (count + 1) / 2;
      const std::uint32_t code = code_of(low + half - 1);
      low += (code ^ first) > (code ^ last) ? std::uint32_t{0} : half;
      count -= half;
    }
    return low;
  }

  [[nodiscard]] std::uint32_t leaf_triangles() const { return leaf_triangles_; }

 private:
  // By trial with two scans, a room and balls on a floor. More than any part weighs: kMostWeight.
  static constexpr std::int32_t kLevelWeight = 5, kNumberWeight = 2, kRootWeight = 3, kMostWeight = 1000;
  // Of a part's weight, above its size and its number: the first of the largest of those that weigh the most.
  static constexpr std::uint32_t kNumberBits = 4, kWeightShift = kNumberBits + 28;
  static constexpr std::uint32_t kGroups = 4, kGroupSize = kTreeWidth / kGroups;

  [[nodiscard]] GRIDIRON_INLINE Self& self() { return static_cast<Self&>(*this); }
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t code_of(std::uint32_t i) const {
    return static_cast<const Self&>(*this).code_of(i);
  }

  GRIDIRON_INLINE void note(SplitWork work, std::uint32_t amount) const {
    static_cast<const Self&>(*this).count_work(work, amount);
  }

  // Splits the part that weighs the most until there are 16 or all are leaves. A core tests rays against the union box
  // of each four children first, so the first four parts become groups of four: below the root a group gets more only
  // if no other can be split. At the root, which all rays enter, a group may grow where its parts weigh much more.
  [[nodiscard]] Status split_by_codes(std::uint32_t begin, std::uint32_t end, TreeRange* ranges, std::uint32_t& parts) {
    const bool is_root = end - begin == self().whole_count();
    const std::uint64_t full_weight = static_cast<std::uint64_t>(is_root ? kRootWeight : kMostWeight) << kWeightShift;
    std::uint32_t group_sizes[kGroups] = {1, 1, 1, 1};
    std::uint64_t less[kGroups] = {};  // what the parts of a group that is full weigh less
    note(SplitWork::kPart, 0);
    ranges[0] = range_of(begin, end);
    std::uint32_t count = 1;
    while (count < kTreeWidth) {
      note(SplitWork::kWeighedPart, count);
      std::uint64_t most = 0;
      for (std::uint32_t i = 0; i < count; ++i) {
        const TreeRange& range = ranges[i];
        const std::uint64_t weight =
            range.weight == 0 ? std::uint64_t{0} : (range.weight - less[range.group]) | (kTreeWidth - 1 - i);
        most = weight > most ? weight : most;
      }
      if (most == 0) break;
      const std::uint32_t best = kTreeWidth - 1 - static_cast<std::uint32_t>(most % kTreeWidth);
      note(SplitWork::kPart, 1);
      GRIDIRON_TRY(split_part(ranges, count, best));
      ++count;
      const std::uint32_t group = ranges[best].group;
      if (count > kGroups && ++group_sizes[group] >= kGroupSize) less[group] = full_weight;
      if (count == kGroups) {
        for (std::uint32_t i = 0; i < kGroups; ++i) ranges[i].group = i;
      }
    }
    parts = count;
    return Status::kOk;
  }

  // Splits part i of `count` in two.
  [[nodiscard]] Status split_part(TreeRange* ranges, std::uint32_t count, std::uint32_t i) {
    TreeRange& part = ranges[i];
    const std::uint32_t group = part.group;
    if (part.level == 0) {
      GRIDIRON_TRY(self().code_again(part.begin, part.end));
      part = range_of(part.begin, part.end);
    }
    const std::uint32_t middle = self().middle_of(part);
    note(SplitWork::kPart, 0);
    for (std::uint32_t k = count; k > i + 1; --k) ranges[k] = ranges[k - 1];
    ranges[i + 1] = range_of(middle, part.end);
    part = range_of(part.begin, middle);
    part.group = ranges[i + 1].group = group;
    return Status::kOk;
  }

  std::uint32_t leaf_triangles_;
};

}  // namespace gridiron
