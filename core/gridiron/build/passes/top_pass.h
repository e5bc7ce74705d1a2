// Sixth pass of a build, of one item: splits ranges of triangles until each fits a core's store.
// Memory: the pass's store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/passes/build_plan.h>
#include <gridiron/build/passes/code_again.h>
#include <gridiron/build/passes/pass_tools.h>
#include <gridiron/build/tree/tree_splits.h>

namespace gridiron {

template <class Layout>
struct TopStore {
  static constexpr std::uint32_t kLineKeys = 8;                                  // of a line of main memory
  static constexpr std::uint32_t kLines = Layout::kBucketKeys < 4096 ? 16 : 64;  // a power of two
  static constexpr std::uint32_t kPieces = 16, kBuckets = 16;                    // sent at once

  struct Level {
    TreeRange ranges[kTreeWidth];
    std::uint32_t count, next, number;
    alignas(32) TopNode node;
  };

  alignas(128) SortedKey keys[Layout::kBucketKeys];  // of code_again_far()
  alignas(128) SortedKey lines[kLines][kLineKeys];
  alignas(128) std::byte copied[window_bytes<SortedKey>(FarBuffers::kKeys)];
  alignas(128) Piece pieces[2][kPieces];
  alignas(128) SubtreeBucket buckets[2][kBuckets];
  alignas(128) BuildState state;
  alignas(128) TopState top_state;
  alignas(128) FarBuffers far;
  RecordRing ring;
  Level levels[kMaxTreeDepth];
  std::uint32_t line_held[kLines];             // line + 1; 0: none
  std::uint32_t samples[Layout::kTopSamples];  // codes of keys at equal distances
  alignas(16) std::uint32_t counts[kSortCounts<Layout::kDigitBits>];
};

/// Splits ranges of keys that lie in main memory.
template <class Layout, class P>
class TopSplitter : private TreeSplits<TopSplitter<Layout, P>> {
 public:
  TopSplitter(BuildTransfers<P>& transfers, TopStore<Layout>& store, const BuildPlan& plan)
      : Splits(plan.input.leaf_triangles), transfers_(transfers), store_(store), plan_(plan) {
    for (std::uint32_t i = 0; i < TopStore<Layout>::kLines; ++i) store.line_held[i] = 0;
  }

  /// Writes tops, pieces and buckets.
  [[nodiscard]] Status run() {
    GRIDIRON_TRY(take_samples());
    const std::uint32_t whole = whole_count();
    if (whole <= plan_.piece_limit) {
      GRIDIRON_TRY(add_piece(0, whole, 1));
    } else {
      GRIDIRON_TRY(open(0, whole));
      // Each turn opens a node, makes a piece or closes a node.
      while (depth_ > 0) GRIDIRON_TRY(step());
    }
    GRIDIRON_TRY(end_bucket());
    GRIDIRON_TRY(send_pieces());
    GRIDIRON_TRY(send_buckets());
    store_.top_state = {top_count_, piece_count_, bucket_count_, store_.state.triangle_count, {}};
    GRIDIRON_TRY(transfers_.put(&store_.top_state, plan_.top_state, sizeof(TopState), kFirstOutputTag));
    return wait_for(transfers_, kFirstOutputTag, kOutputTagCount);
  }

 private:
  using Splits = TreeSplits<TopSplitter>;
  friend Splits;
  using Level = typename TopStore<Layout>::Level;
  static constexpr std::uint8_t kPieceTag = kFirstOutputTag, kBucketTag = kFirstOutputTag + 2;
  static constexpr std::uint8_t kNodeTag = kFirstOutputTag + 4;

  // --- Nodes ------------------------------------------------------------------------------------------------------

  // Splits a range that is a node's.
  [[nodiscard]] Status open(std::uint32_t begin, std::uint32_t end) {
    GRIDIRON_TRY(transfers_.wait(kNodeTag));  // that was here before
    Level& level = store_.levels[depth_++];
    GRIDIRON_TRY(this->split_range(begin, end, depth_, level.ranges, level.count));
    GRIDIRON_TRY(status_);
    level.next = 0;
    level.number = top_count_++;
    level.node = {};
    level.node.begin = begin;
    level.node.depth = depth_;
    level.node.child_count = level.count;
    return Status::kOk;
  }

  [[nodiscard]] Status step() {
    Level& level = store_.levels[depth_ - 1];
    if (level.next == level.count) {
      --depth_;
      return transfers_.put(&level.node, plan_.tops.offset_by(std::uint64_t{level.number} * sizeof(TopNode)),
                            sizeof(TopNode), kNodeTag);
    }
    const TreeRange range = level.ranges[level.next];
    std::uint32_t& child = level.node.children[level.next++];
    const std::uint32_t size = range.end - range.begin;
    if (range.level < 0) {
      child = piece_count_;
      return add_piece(range.begin, range.end, 0);
    }
    // What is coded again in the store is not split here.
    if (size <= plan_.piece_limit || (range.level == 0 && size <= Layout::kPieceKeys)) {
      child = piece_count_;
      return add_piece(range.begin, range.end, depth_ + 1);
    }
    child = top_count_ | TopNode::kTop;
    return open(range.begin, range.end);
  }

  [[nodiscard]] Status add_piece(std::uint32_t begin, std::uint32_t end, std::uint32_t depth) {
    if (bucket_.piece_count > 0 && (end - bucket_.begin > plan_.piece_limit || bucket_.piece_count == kBucketPieces)) {
      GRIDIRON_TRY(end_bucket());
    }
    if (bucket_.piece_count == 0) bucket_ = {piece_count_, 0, begin, end};
    ++bucket_.piece_count;
    bucket_.end = end;
    static constexpr std::uint32_t kPieces = TopStore<Layout>::kPieces;
    store_.pieces[piece_count_ / kPieces % 2][piece_count_ % kPieces] = {begin, end, depth, bucket_count_};
    ++piece_count_;
    return piece_count_ % kPieces == 0 ? send_pieces() : Status::kOk;
  }
  [[nodiscard]] Status end_bucket() {
    static constexpr std::uint32_t kBuckets = TopStore<Layout>::kBuckets;
    store_.buckets[bucket_count_ / kBuckets % 2][bucket_count_ % kBuckets] = bucket_;
    bucket_.piece_count = 0;
    ++bucket_count_;
    return bucket_count_ % kBuckets == 0 ? send_buckets() : Status::kOk;
  }
  [[nodiscard]] Status send_pieces() {
    return send(store_.pieces, plan_.pieces, piece_count_, pieces_sent_, kPieceTag);
  }
  [[nodiscard]] Status send_buckets() {
    return send(store_.buckets, plan_.buckets, bucket_count_, buckets_sent_, kBucketTag);
  }
  // Sends what has been made since the last time from one of two buffers, and waits for the other one.
  template <class Element, std::size_t kSize>
  [[nodiscard]] Status send(Element (&buffers)[2][kSize], MainAddress array, std::uint32_t count, std::uint32_t& sent,
                            std::uint8_t tag) {
    static constexpr auto kCount = static_cast<std::uint32_t>(kSize);
    if (count == sent) return Status::kOk;
    const std::uint32_t side = sent / kCount % 2;
    const std::uint32_t bytes = (count - sent) * static_cast<std::uint32_t>(sizeof(Element));
    GRIDIRON_TRY(transfers_.put(buffers[side], array.offset_by(std::uint64_t{sent} * sizeof(Element)), bytes,
                                static_cast<std::uint8_t>(tag + side)));
    sent = count;
    return transfers_.wait(static_cast<std::uint8_t>(tag + 1 - side));
  }

  // --- Keys -------------------------------------------------------------------------------------------------------

  GRIDIRON_INLINE void count_work(SplitWork work, std::uint32_t amount) const {
    transfers_.add_work(kind_of(work), amount);
  }
  [[nodiscard]] std::uint32_t whole_count() const { return store_.state.triangle_count; }

  // A key, which may have to be fetched. Errors: status_.
  [[nodiscard]] std::uint32_t code_of(std::uint32_t i) const { return key_at(i).key.code(); }
  [[nodiscard]] SortedKey key_at(std::uint32_t i) const {
    static constexpr std::uint32_t kLineKeys = TopStore<Layout>::kLineKeys;
    const std::uint32_t line = i / kLineKeys, slot = line % TopStore<Layout>::kLines;
    if (store_.line_held[slot] != line + 1) fetch_line(line);
    return store_.lines[slot][i % kLineKeys];
  }
  GRIDIRON_OUTLINE void fetch_line(std::uint32_t line) const {
    Status status = get_line(line);
    if (status == Status::kOk) status = transfers_.wait(kSetupTag);
    if (status != Status::kOk) status_ = status;
  }
  [[nodiscard]] Status get_line(std::uint32_t line) const {
    static constexpr std::uint32_t kLineKeys = TopStore<Layout>::kLineKeys, kLines = TopStore<Layout>::kLines;
    const std::uint32_t left = whole_count() - line * kLineKeys;
    store_.line_held[line % kLines] = line + 1;
    return transfers_.get(
        store_.lines[line % kLines], plan_.sorted.offset_by(std::uint64_t{line} * kLineKeys * sizeof(SortedKey)),
        (left < kLineKeys ? left : kLineKeys) * static_cast<std::uint32_t>(sizeof(SortedKey)), kSetupTag);
  }

  // Keys, so close to one another that they are fetched at once.
  static constexpr std::uint32_t kGap = TopStore<Layout>::kLines / 2 * TopStore<Layout>::kLineKeys;
  void fetch_lines(std::uint32_t first, std::uint32_t last) const {
    static constexpr std::uint32_t kLineKeys = TopStore<Layout>::kLineKeys, kLines = TopStore<Layout>::kLines;
    Status status = Status::kOk;
    for (std::uint32_t line = first / kLineKeys; line <= last / kLineKeys && status == Status::kOk; ++line) {
      if (store_.line_held[line % kLines] != line + 1) status = get_line(line);
    }
    if (status == Status::kOk) status = transfers_.wait(kSetupTag);
    if (status != Status::kOk) status_ = status;
  }

  // Codes of keys at equal distances, to find the middle of a range without fetching keys from all over it.
  [[nodiscard]] Status take_samples() {
    sample_step_ = TopStore<Layout>::kLineKeys;
    while (whole_count() / sample_step_ >= Layout::kTopSamples) sample_step_ *= 2;
    // A line each, as many under way as there is room for.
    static constexpr std::uint32_t kLines = TopStore<Layout>::kLines;
    const std::uint32_t count = whole_count() / sample_step_ + (whole_count() % sample_step_ != 0 ? 1u : 0u);
    static constexpr std::uint32_t kAhead = kTriangleTagCount < kLines ? std::uint32_t{kTriangleTagCount} : kLines;
    for (std::uint32_t i = 0; i < count + kAhead; ++i) {
      const auto tag = static_cast<std::uint8_t>(kFirstTriangleTag + i % kAhead);
      SortedKey* const line = store_.lines[i % kAhead];
      if (i >= kAhead) {
        GRIDIRON_TRY(transfers_.wait(tag));
        store_.samples[i - kAhead] = line[0].key.code();
      }
      if (i < count) {
        GRIDIRON_TRY(transfers_.get(line, plan_.sorted.offset_by(std::uint64_t{i} * sample_step_ * sizeof(SortedKey)),
                                    sizeof(SortedKey), tag));
      }
    }
    return Status::kOk;
  }

  [[nodiscard]] std::uint32_t middle_of(const TreeRange& part) const {
    const std::uint32_t first = code_of(part.begin), last = code_of(part.end - 1);
    // What could not be fetched is no code, and samples do not fit it.
    if (status_ != Status::kOk) return part.begin + 1;
    // The first sample that is like the last key lies at or behind the middle, the one before it in front.
    std::uint32_t low = part.begin / sample_step_ + 1, size = (part.end - 1) / sample_step_ + 1 - low;
    while (size > 0) {
      const std::uint32_t half = (size + 1) / 2, code = store_.samples[low + half - 1];
      low += (code ^ first) > (code ^ last) ? std::uint32_t{0} : half;
      size -= half;
    }
    const std::uint32_t before = (low - 1) * sample_step_, after = low * sample_step_ + 1;
    const std::uint32_t begin = before > part.begin ? before : part.begin, end = after < part.end ? after : part.end;
    if (end - begin <= kGap) fetch_lines(begin, end - 1);
    if (status_ != Status::kOk) return part.begin + 1;
    return this->first_like_last(begin, end, first, last);
  }

  // Equal keys of many triangles have their next codes beside them, if the range has all that are equal.
  [[nodiscard]] Status code_again(std::uint32_t begin, std::uint32_t end) {
    const std::uint32_t count = end - begin;
    if (count <= kFewTreeTriangles) {
      GRIDIRON_TRY(change_far(transfers_, store_.far, plan_.sorted, begin, count,
                              [](SortedKey& key, std::uint32_t i) { key.key = numbered(i, key.key.id()); }));
    } else {
      if (!is_crowd(key_at(begin), key_at(end - 1))) {
        GRIDIRON_TRY((code_again_far<Layout>(transfers_, store_.ring, store_.far, plan_, begin, end, store_.keys,
                                             store_.counts)));
      }
      GRIDIRON_TRY(take_again(begin, count));
    }
    // What is held here is out of date.
    for (std::uint32_t i = 0; i < TopStore<Layout>::kLines; ++i) store_.line_held[i] = 0;
    for (std::uint32_t i = (begin + sample_step_ - 1) / sample_step_; i * sample_step_ < end; ++i) {
      store_.samples[i] = code_of(i * sample_step_);
    }
    return status_;
  }

  // Puts the next codes of keys in the place of the first ones, their transfers before and behind.
  [[nodiscard]] Status take_again(std::uint32_t begin, std::uint32_t count) {
    static constexpr std::uint32_t kShares = 4, kKeys = Layout::kBucketKeys / kShares / 2 * 2 - 4;
    const auto window_of = [&](std::uint32_t share) {
      auto* const buffer = reinterpret_cast<std::byte*>(store_.keys + share % kShares * (kKeys + 4));
      return Window<SortedKey>(buffer, plan_.sorted, std::uint64_t{begin} + share * kKeys);
    };
    const auto count_of = [count](std::uint32_t share) {
      return count - share * kKeys < kKeys ? count - share * kKeys : kKeys;
    };
    const auto tag_of = [](std::uint32_t share) {
      return static_cast<std::uint8_t>(kFirstTriangleTag + share % kShares);
    };
    const std::uint32_t shares = (count + kKeys - 1) / kKeys;
    for (std::uint32_t i = 0; i < shares + 2; ++i) {
      if (i < shares) {
        GRIDIRON_TRY(transfers_.wait(tag_of(i)));  // what was put from there
        GRIDIRON_TRY(window_of(i).get(transfers_, count_of(i), tag_of(i)));
      }
      if (i < 2) continue;
      const std::uint32_t share = i - 2;
      GRIDIRON_TRY(transfers_.wait(tag_of(share)));
      SortedKey* const keys = window_of(share).elements();
      transfers_.add_work(BuildWork::kGatheredKey, count_of(share));
      for (std::uint32_t k = 0; k < count_of(share); ++k) keys[k].key = again_of(keys[k]);
      GRIDIRON_TRY(window_of(share).put(transfers_, count_of(share), tag_of(share)));
    }
    return wait_for(transfers_, kFirstTriangleTag, kShares);
  }

  BuildTransfers<P>& transfers_;
  TopStore<Layout>& store_;
  const BuildPlan& plan_;
  SubtreeBucket bucket_{};
  std::uint32_t depth_ = 0;  // open nodes
  std::uint32_t top_count_ = 0, piece_count_ = 0, bucket_count_ = 0;
  std::uint32_t pieces_sent_ = 0, buckets_sent_ = 0;
  std::uint32_t sample_step_ = 0;
  mutable Status status_ = Status::kOk;
};

/// Writes top_state, tops, pieces and buckets. Items: one.
template <class Layout, class P>
[[nodiscard]] Status run_top_pass(BuildTransfers<P>& transfers, TopStore<Layout>& store, const BuildPlan& plan) {
  return for_each_item(transfers, 1, [&](std::uint32_t) -> Status {
    GRIDIRON_TRY(fetch(transfers, store.state, plan.state));
    return TopSplitter<Layout, P>(transfers, store, plan).run();
  });
}

}  // namespace gridiron
