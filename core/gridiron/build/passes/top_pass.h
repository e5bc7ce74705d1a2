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
  static constexpr std::uint32_t kLineKeys = 8;                             // of a line of main memory
  static constexpr std::uint32_t kLines = Layout::kSortsRecords ? 64 : 16;  // a power of two
  static constexpr std::uint32_t kPieces = 16, kBuckets = 16;               // sent at once

  struct Level {
    TreeRange ranges[kTreeWidth];
    std::uint32_t count, next, number;
    std::uint32_t crowd_bits;  // of ranges that are split by `again`
    alignas(32) TopNode node;
  };

  static constexpr std::uint32_t kSampledKeys = Layout::kSortsRecords ? 256 : 64;
  alignas(128) BucketKey share[Layout::kFarKeys];
  alignas(128) std::byte sampled[2 * window_bytes<SortedKey>(kSampledKeys)];
  alignas(128) SortedKey lines[kLines][kLineKeys];
  alignas(128) Piece pieces[2][kPieces];
  alignas(128) SubtreeBucket buckets[2][kBuckets];
  alignas(128) BuildState state;
  alignas(128) TopState top_state;
  FarStore<Layout> far;
  Level levels[kMaxTreeDepth];
  TreeRange crowds[kTreeWidth];     // of the node that is split, those that are split by `again`
  std::uint32_t line_held[kLines];  // line + 1; 0: none
  std::uint32_t samples[Layout::kTopSamples], samples_again[Layout::kTopSamples];  // of keys at equal distances
  alignas(16) std::uint32_t counts[kSortCounts<Layout::kDigitBits>];
};

/// Splits ranges of keys that lie in main memory.
template <class Layout, class P>
class TopSplitter : private TreeSplits<TopSplitter<Layout, P>> {
 public:
  TopSplitter(BuildTransfers<P>& transfers, TopStore<Layout>& store, const BuildPlan& plan)
      : Splits(plan.input.leaf_triangles),
        transfers_(transfers),
        store_(store),
        plan_(plan),
        order_(transfers, store.far, plan, store.share, Layout::kFarKeys, store.counts) {
    for (std::uint32_t i = 0; i < TopStore<Layout>::kLines; ++i) store.line_held[i] = 0;
  }

  /// Writes tops, pieces and buckets.
  [[nodiscard]] Status run() {
    GRIDIRON_TRY(take_samples());
    const std::uint32_t whole = whole_count();
    if (whole <= plan_.piece_limit) {
      GRIDIRON_TRY(add_piece(0, whole, 1, false));
    } else {
      GRIDIRON_TRY(open(0, whole, false));
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

  // Splits a range that is a node's. @param is_of_crowd  by `again`.
  [[nodiscard]] Status open(std::uint32_t begin, std::uint32_t end, bool is_of_crowd) {
    GRIDIRON_TRY(transfers_.wait(kNodeTag));  // that was here before
    Level& level = store_.levels[depth_++];
    is_of_crowd_ = is_of_crowd;
    crowd_count_ = 0;
    GRIDIRON_TRY(this->split_range(begin, end, depth_, level.ranges, level.count));
    GRIDIRON_TRY(status_);
    level.crowd_bits = 0;
    for (std::uint32_t i = 0; i < level.count; ++i) {
      if (is_in_crowd(level.ranges[i].begin)) level.crowd_bits |= 1u << i;
    }
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
    const bool is_of_crowd = (level.crowd_bits >> level.next & 1u) != 0;
    std::uint32_t& child = level.node.children[level.next++];
    const std::uint32_t size = range.end - range.begin;
    if (range.level < 0) {
      child = piece_count_;
      return add_piece(range.begin, range.end, 0, is_of_crowd);
    }
    // What is coded again in the store is not split here.
    if (size <= plan_.piece_limit || (range.level == 0 && size <= Layout::kPieceKeys)) {
      child = piece_count_;
      return add_piece(range.begin, range.end, depth_ + 1, is_of_crowd);
    }
    child = top_count_ | TopNode::kTop;
    return open(range.begin, range.end, is_of_crowd);
  }

  [[nodiscard]] Status add_piece(std::uint32_t begin, std::uint32_t end, std::uint32_t depth, bool is_of_crowd) {
    if (bucket_.piece_count > 0 && (end - bucket_.begin > plan_.piece_limit || bucket_.piece_count == kBucketPieces)) {
      GRIDIRON_TRY(end_bucket());
    }
    if (bucket_.piece_count == 0) bucket_ = {piece_count_, 0, begin, end};
    ++bucket_.piece_count;
    bucket_.end = end;
    static constexpr std::uint32_t kPieces = TopStore<Layout>::kPieces;
    store_.pieces[piece_count_ / kPieces % 2][piece_count_ % kPieces] = {
        begin, end, depth, bucket_count_ | (is_of_crowd ? Piece::kOfCrowd : std::uint32_t{0})};
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

  // Of a key, which may have to be fetched. Errors: status_.
  [[nodiscard]] std::uint32_t code_of(std::uint32_t i) const {
    const SortedKey key = key_at(i);
    return is_in_crowd(i) ? again_of(key) : key.code;
  }
  [[nodiscard]] std::uint32_t sample_of(std::uint32_t sample) const {
    return is_in_crowd(sample * sample_step_) ? store_.samples_again[sample] : store_.samples[sample];
  }
  // Whether a key is in a crowd that is split by `again`: that of the node, or one that its own splits have come to.
  [[nodiscard]] bool is_in_crowd(std::uint32_t i) const {
    bool is_in = is_of_crowd_;
    for (std::uint32_t k = 0; k < crowd_count_; ++k) {
      is_in = is_in || i - store_.crowds[k].begin < store_.crowds[k].end - store_.crowds[k].begin;
    }
    return is_in;
  }
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
    sample_step_ = plan_.sample_step;
    std::uint32_t next = 0;
    const auto take = [&](const SortedKey* keys, std::uint64_t, std::uint32_t n) {
      transfers_.add_work(BuildWork::kGatheredKey, n);
      for (std::uint32_t i = 0; i < n; ++i, ++next) {
        store_.samples[next] = keys[i].code;
        store_.samples_again[next] = again_of(keys[i]);
      }
      return Status::kOk;
    };
    static constexpr std::uint32_t kKeys = TopStore<Layout>::kSampledKeys;
    return for_each_window<SortedKey, kKeys>(transfers_, store_.sampled, plan_.sorted_samples, 0,
                                             (whole_count() + sample_step_ - 1) / sample_step_, kFirstMacroTag, take);
  }

  [[nodiscard]] std::uint32_t middle_of(const TreeRange& part) const {
    const std::uint32_t first = code_of(part.begin), last = code_of(part.end - 1);
    // What could not be fetched is no code, and samples do not fit it.
    if (status_ != Status::kOk) return part.begin + 1;
    // The first sample that is like the last key lies at or behind the middle, the one before it in front.
    std::uint32_t low = part.begin / sample_step_ + 1, size = (part.end - 1) / sample_step_ + 1 - low;
    while (size > 0) {
      const std::uint32_t half = (size + 1) / 2, code = sample_of(low + half - 1);
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
    if (!is_in_crowd(begin) && is_crowd(key_at(begin), key_at(end - 1))) {
      store_.crowds[crowd_count_++] = {begin, end, 0, 0, 0};
      return status_;
    }
    GRIDIRON_TRY(status_);
    GRIDIRON_TRY(order_.code_again(begin, end - begin));
    return take_changed(begin, end);
  }
  // Only a tree of many levels comes here: its triangles may be gone through one after another.
  [[nodiscard]] GRIDIRON_RARE Status restore_order(std::uint32_t begin, std::uint32_t end) {
    if (is_of_crowd_) return Status::kOk;
    std::uint32_t first = begin;  // of a crowd
    bool is_open = false;
    for (std::uint32_t i = begin; i < end; ++i) {
      if ((key_at(i).again & kCrowdEnd) == 0) continue;
      GRIDIRON_TRY(status_);
      if (is_open) {
        GRIDIRON_TRY(order_.restore(first, i + 1 - first));
        GRIDIRON_TRY(take_changed(first, i + 1));
      }
      is_open = !is_open;
      first = i;
    }
    return status_;
  }
  // What is held here of such keys is out of date.
  [[nodiscard]] Status take_changed(std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = 0; i < TopStore<Layout>::kLines; ++i) store_.line_held[i] = 0;
    for (std::uint32_t i = (begin + sample_step_ - 1) / sample_step_; i * sample_step_ < end; ++i) {
      const SortedKey key = key_at(i * sample_step_);
      store_.samples[i] = key.code;
      store_.samples_again[i] = again_of(key);
    }
    return status_;
  }

  BuildTransfers<P>& transfers_;
  TopStore<Layout>& store_;
  const BuildPlan& plan_;
  FarOrder<Layout, P> order_;
  SubtreeBucket bucket_{};
  bool is_of_crowd_ = false;
  std::uint32_t crowd_count_ = 0;
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
