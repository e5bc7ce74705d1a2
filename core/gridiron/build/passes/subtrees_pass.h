// Seventh pass of a build: makes each piece's leaves and nodes, and writes nodes. They are not numbered
// yet: a node names its children by their place among those of their level in the bucket. Memory: the pass's store.
// Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/passes/build_plan.h>
#include <gridiron/build/passes/code_again.h>
#include <gridiron/build/passes/pass_tools.h>
#include <gridiron/build/passes/record_stream.h>
#include <gridiron/build/tree/tree_box.h>
#include <gridiron/build/tree/tree_order.h>
#include <gridiron/build/tree/tree_splits.h>

#include <bit>

namespace gridiron {

template <class Layout>
struct SubtreesStore {
  static constexpr std::uint32_t kNodes = 4;    // on their way
  static constexpr std::uint32_t kResults = 4;  // of pieces, on their way

  // A range that is split, and which of its children is next.
  struct Level {
    TreeRange ranges[kTreeWidth];
    std::uint32_t count, next;
  };
  // A node whose children are being made.
  struct OpenNode {
    CornerBox boxes[kTreeWidth];
    float areas[kTreeWidth];
    TreeChild children[kTreeWidth];
    std::uint32_t count, index;
    std::uint32_t child;  // of the node above, or of the topmost one the piece
  };

  alignas(128) SortedKey keys[Layout::kPieceKeys + 1];
  alignas(128) OpenNode nodes[kMaxTreeDepth];
  alignas(128) TreeNode sent_nodes[kNodes];
  union {
    RecordWindows<Layout::kRecordWindow> records;
    FarStore<Layout> far;
  };
  alignas(128) BucketKey share[Layout::kFarKeys];
  alignas(128) std::byte pieces[2 * window_bytes<Piece>(16)];
  alignas(128) PieceResult results[kResults];
  alignas(128) SubtreeBucket bucket[2];  // one, congruent with its place in main memory
  alignas(128) LevelCounts level_counts;
  alignas(128) BuildState state;
  alignas(128) TopState top_state;
  Level levels[kMaxTreeDepth];
  alignas(16) std::uint32_t counts[kSortCounts<Layout::kDigitBits>];
};

/// Makes subtrees of a bucket's pieces.
template <class Layout, class P>
class SubtreeBuilder : private TreeSplits<SubtreeBuilder<Layout, P>> {
 public:
  SubtreeBuilder(BuildTransfers<P>& transfers, SubtreesStore<Layout>& store, const BuildPlan& plan)
      : Splits(plan.input.leaf_triangles),
        transfers_(transfers),
        store_(store),
        plan_(plan),
        records_(transfers, store.records, plan.input.records),
        margin_(tree_margin_of(store.state.low, store.state.high)) {}

  [[nodiscard]] Status build(std::uint32_t bucket) {
    GRIDIRON_TRY(transfers_.get(bucket_place(bucket), plan_.buckets.offset_by(bucket * sizeof(SubtreeBucket)),
                                sizeof(SubtreeBucket), kSetupTag));
    GRIDIRON_TRY(transfers_.wait(kSetupTag));
    const SubtreeBucket head = *bucket_place(bucket);
    begin_ = head.begin;
    keys_ = store_.keys + (begin_ & 1u);  // both ends of a transfer are congruent
    GRIDIRON_TRY(get_keys(begin_, head.end));
    GRIDIRON_TRY(records_.begin(begin_, head.end));
    GRIDIRON_TRY(transfers_.wait(kSetupTag));
    store_.level_counts = {};
    raw_node_ = raw_node_place(begin_, plan_.input.leaf_triangles);
    // Tags of an item depend on nothing but the item.
    next_node_ = next_result_ = 0;
    const auto add_all = [&](const Piece* pieces, std::uint64_t first, std::uint32_t count) -> Status {
      for (std::uint32_t i = 0; i < count; ++i) GRIDIRON_TRY(add(pieces[i], static_cast<std::uint32_t>(first) + i));
      return Status::kOk;
    };
    GRIDIRON_TRY((for_each_window<Piece, 16>(transfers_, store_.pieces, plan_.pieces, head.first_piece,
                                             head.first_piece + head.piece_count, kPieceTag, add_all)));
    GRIDIRON_TRY(transfers_.put(&store_.level_counts, plan_.level_counts.offset_by(bucket * sizeof(LevelCounts)),
                                sizeof(LevelCounts), kCountsTag));
    return wait_for(transfers_, kFirstOutputTag, kOutputTagCount);
  }

 private:
  using Splits = TreeSplits<SubtreeBuilder>;
  friend Splits;
  using Store = SubtreesStore<Layout>;
  using Level = typename Store::Level;
  using OpenNode = typename Store::OpenNode;
  static constexpr std::uint8_t kPieceTag = kFirstMacroTag + 6, kCountsTag = kFirstOutputTag + 2;
  static constexpr std::uint8_t kResultTag = kFirstOutputTag + 3, kNodeTag = kFirstOutputTag + 4;
  static_assert(Store::kNodes <= 4);

  // --- Splits -----------------------------------------------------------------------------------------------------

  [[nodiscard]] SubtreeBucket* bucket_place(std::uint32_t bucket) { return &store_.bucket[bucket & 1u]; }
  GRIDIRON_INLINE void count_work(SplitWork work, std::uint32_t amount) const {
    transfers_.add_work(kind_of(work), amount);
  }
  [[nodiscard]] std::uint32_t whole_count() const { return store_.state.triangle_count; }
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t code_of(std::uint32_t i) const { return keys_[i - begin_].code; }
  [[nodiscard]] std::uint32_t middle_of(const TreeRange& part) const {
    return this->first_like_last(part.begin, part.end, code_of(part.begin), code_of(part.end - 1));
  }
  [[nodiscard]] Status get_keys(std::uint32_t begin, std::uint32_t end) {
    return transfers_.get(keys_ + (begin - begin_), plan_.sorted.offset_by(std::uint64_t{begin} * sizeof(SortedKey)),
                          (end - begin) * static_cast<std::uint32_t>(sizeof(SortedKey)), kSetupTag);
  }
  // A crowd is split by `again` from now on.
  void take_crowd(std::uint32_t begin, std::uint32_t end) {
    SortedKey* const keys = keys_ + (begin - begin_);
    transfers_.add_work(BuildWork::kGatheredKey, end - begin);
    for (std::uint32_t i = 0; i < end - begin; ++i) keys[i].code = again_of(keys[i]);
  }
  [[nodiscard]] Status code_again(std::uint32_t begin, std::uint32_t end) {
    SortedKey* const keys = keys_ + (begin - begin_);
    const std::uint32_t count = end - begin;
    if (count <= kFewTreeTriangles) {
      for (std::uint32_t i = 0; i < count; ++i) keys[i].code = i | kTreeCodedAgain;
      return Status::kOk;
    }
    if (is_crowd(keys[0], keys[count - 1])) {
      take_crowd(begin, end);
      return Status::kOk;
    }
    return change_order(begin, end, [&](FarOrder<Layout, P>& order) { return order.code_again(begin, end - begin); });
  }
  [[nodiscard]] GRIDIRON_RARE Status restore_order(std::uint32_t begin, std::uint32_t end) {
    std::uint32_t first = begin;  // of a crowd
    bool is_open = false;
    for (std::uint32_t i = begin; i < end; ++i) {
      const SortedKey& key = keys_[i - begin_];
      if ((key.code & kTreeCodedAgain) != 0 || (key.again & kCrowdEnd) == 0) continue;
      if (is_open) {
        const auto restore = [&](FarOrder<Layout, P>& order) { return order.restore(first, i + 1 - first); };
        GRIDIRON_TRY(change_order(first, i + 1, restore));
      }
      is_open = !is_open;
      first = i;
    }
    return Status::kOk;
  }
  // Triangles that no leaf has yet get another order where they lie.
  template <class Change>
  [[nodiscard]] Status change_order(std::uint32_t begin, std::uint32_t end, Change&& change) {
    GRIDIRON_TRY(records_.stop());  // its memory is used
    FarOrder<Layout, P> order(transfers_, store_.far, plan_, store_.share, Layout::kFarKeys, store_.counts);
    GRIDIRON_TRY(change(order));
    GRIDIRON_TRY(records_.go_on());
    GRIDIRON_TRY(get_keys(begin, end));
    return transfers_.wait(kSetupTag);
  }

  [[nodiscard]] Status add(const Piece& piece, std::uint32_t number) {
    if ((piece.bucket & Piece::kOfCrowd) != 0) take_crowd(piece.begin, piece.end);
    top_depth_ = depth_ = piece.depth == 0 ? std::uint32_t{0} : piece.depth - 1;
    piece_ = number;
    if (piece.depth == 0) return add_leaf(0, piece.begin, piece.end - piece.begin);
    GRIDIRON_TRY(open(piece.begin, piece.end, 0));
    // Each turn opens a node, makes a leaf or ends a node.
    while (depth_ > top_depth_) {
      Level& level = store_.levels[depth_ - 1];
      if (level.next == level.count) {
        GRIDIRON_TRY(end_node());
        continue;
      }
      const TreeRange& range = level.ranges[level.next];
      const std::uint32_t child = level.next++;
      OpenNode& node = store_.nodes[depth_ - 1];
      if (range.level < 0) {
        node.children[child] = TreeChild::leaf(range.begin, range.end - range.begin);
        GRIDIRON_TRY(add_leaf(child, range.begin, range.end - range.begin));
      } else {
        node.children[child] = TreeChild::node(store_.level_counts.of[depth_]);
        GRIDIRON_TRY(open(range.begin, range.end, child));
      }
    }
    return Status::kOk;
  }

  [[nodiscard]] Status open(std::uint32_t begin, std::uint32_t end, std::uint32_t child) {
    Level& level = store_.levels[depth_];
    OpenNode& node = store_.nodes[depth_];
    node.index = store_.level_counts.of[depth_]++;
    node.child = child;
    ++depth_;
    GRIDIRON_TRY(this->split_range(begin, end, depth_, level.ranges, level.count));
    level.next = 0;
    node.count = level.count;
    return Status::kOk;
  }

  [[nodiscard]] Status add_leaf(std::uint32_t child, std::uint32_t first, std::uint32_t count) {
    QuadBox box;
    float area = 0.0f;
    transfers_.add_work(BuildWork::kTakenRecord, count);
    for (std::uint32_t i = 0; i < count; ++i) {
      const VertexTriangle* record = nullptr;
      GRIDIRON_TRY(records_.next(record));
      box.add(corner_quads(*record));
      area += keys_[first + i - begin_].area;
    }
    transfers_.add_work(BuildWork::kLeaf);
    if (plan_.input.order != TreeOrder::kForAnyHit) area = 0.0f;
    return deliver(child, box.grown(margin_), area, 0);
  }

  // The box and the area of a child of the open node go to it, or those of a piece to main memory.
  [[nodiscard]] Status deliver(std::uint32_t child, const QuadBox& box, float area, std::uint32_t number) {
    if (depth_ > top_depth_) {
      OpenNode& node = store_.nodes[depth_ - 1];
      node.boxes[child].low = box.low;
      node.boxes[child].high = box.high;
      node.areas[child] = area;
      return Status::kOk;
    }
    if (next_result_ % Store::kResults == 0) GRIDIRON_TRY(transfers_.wait(kResultTag));
    PieceResult& result = store_.results[next_result_++ % Store::kResults];
    for (int axis = 0; axis < 3; ++axis) {
      result.low[axis] = lane_of(box.low, axis);
      result.high[axis] = lane_of(box.high, axis);
    }
    result.area = area;
    result.number = number;
    return transfers_.put(&result, plan_.piece_results.offset_by(std::uint64_t{piece_} * sizeof(PieceResult)),
                          sizeof(PieceResult), kResultTag);
  }

  [[nodiscard]] Status end_node() {
    transfers_.add_work(BuildWork::kNode);
    OpenNode& open_node = store_.nodes[--depth_];
    const std::uint32_t place = next_node_++ % Store::kNodes;
    const auto tag = static_cast<std::uint8_t>(kNodeTag + place);
    GRIDIRON_TRY(transfers_.wait(tag));
    TreeNode& node = store_.sent_nodes[place];
    for (std::uint32_t i = open_node.count; i < kTreeWidth; ++i) {
      open_node.boxes[i].low = CornerQuad(kFloatMax);
      open_node.boxes[i].high = CornerQuad(-kFloatMax);
      open_node.children[i] = {0};
    }
    store_child_boxes(open_node.boxes, node);
    const auto* const children = reinterpret_cast<const std::uint32_t*>(open_node.children);
    for (std::uint32_t i = 0; i < kTreeWidth; i += 4) {
      Lanes<4>::Int::load(children + i).store(reinterpret_cast<std::uint32_t*>(node.children) + i);
    }
    node.order = kTreeOrderByNumber;
    float total = 0.0f;
    if (plan_.input.order == TreeOrder::kForAnyHit) {
      float densities[kTreeWidth];
      for (std::uint32_t i = 0; i < open_node.count; ++i) {
        total += open_node.areas[i];
        densities[i] = density_of(open_node.areas[i], open_node.children[i].is_leaf(),
                                  {open_node.boxes[i].low, open_node.boxes[i].high});
      }
      node.order = order_of(densities, open_node.count);
    }
    node.child_count = open_node.count;
    // Until the node has its number.
    for (std::uint32_t& word : node.reserved) word = 0;
    node.reserved[0] = depth_;
    node.reserved[1] = open_node.index;
    GRIDIRON_TRY(
        transfers_.put(&node, plan_.raw_nodes.offset_by(raw_node_++ * sizeof(TreeNode)), sizeof(TreeNode), tag));
    return deliver(open_node.child, QuadBox::of_node(node), total, open_node.index);
  }

  BuildTransfers<P>& transfers_;
  Store& store_;
  const BuildPlan& plan_;
  RecordReader<P, Layout::kRecordWindow> records_;
  float margin_;
  SortedKey* keys_ = nullptr;  // of the bucket
  std::uint32_t begin_ = 0;
  std::uint32_t piece_ = 0;
  std::uint32_t depth_ = 0, top_depth_ = 0;
  std::uint32_t next_node_ = 0, next_result_ = 0;
  std::uint64_t raw_node_ = 0;
};

/// Writes raw_nodes, piece_results and level_counts. Items: buckets of pieces.
template <class Layout, class P>
[[nodiscard]] Status run_subtrees_pass(BuildTransfers<P>& transfers, SubtreesStore<Layout>& store,
                                       const BuildPlan& plan) {
  GRIDIRON_TRY(fetch(transfers, store.state, plan.state));
  GRIDIRON_TRY(fetch(transfers, store.top_state, plan.top_state));
  SubtreeBuilder<Layout, P> builder(transfers, store, plan);
  return for_each_item(transfers, plan.subtree_room, [&](std::uint32_t bucket) {
    return bucket < store.top_state.bucket_count ? builder.build(bucket) : Status::kOk;
  });
}

}  // namespace gridiron
