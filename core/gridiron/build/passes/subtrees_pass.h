// Seventh pass of a build: makes each piece's leaves and nodes, and writes records and nodes. Nodes are not numbered
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
  static constexpr std::uint32_t kEvents = 32;  // leaves and ends of nodes that wait for their triangles
  static constexpr std::uint32_t kRecords = Layout::kBucketKeys < 4096 ? 16 : 32;  // sent at once
  static constexpr std::uint32_t kNodes = 4;                                       // on their way
  static constexpr std::uint32_t kResults = 4;                                     // of pieces, on their way

  // A range that is split, and which of its children is next.
  struct Level {
    TreeRange ranges[kTreeWidth];
    std::uint32_t count, next;
    std::uint32_t slot;    // of its node
    std::uint32_t opened;  // nodes of this level
  };
  // A node whose children are being made.
  struct OpenNode {
    CornerBox boxes[kTreeWidth];
    float areas[kTreeWidth];
    TreeChild children[kTreeWidth];
    std::uint32_t count, index;
    std::uint32_t parent, child;  // the node that it is a child of, or kNoParent and the piece
    bool is_open;
  };
  static constexpr std::uint32_t kNoParent = ~0u;
  struct Event {
    std::uint32_t node;   // of a leaf its parent; else the node that ends
    std::uint32_t child;  // of a leaf; kEnds: an end. Without a parent the piece
    std::uint32_t left;   // triangles of a leaf that have not been taken yet
  };
  static constexpr std::uint32_t kEnds = ~0u;

  alignas(128) SortedKey keys[Layout::kPieceKeys + 1];
  alignas(128) OpenNode nodes[kMaxTreeDepth * Layout::kNodeLag];
  alignas(128) TreeNode sent_nodes[kNodes];
  alignas(128) std::byte records[2][window_bytes<VertexTriangle>(kRecords)];
  alignas(128) std::byte pieces[2 * window_bytes<Piece>(16)];
  alignas(128) PieceResult results[kResults];
  alignas(128) SubtreeBucket bucket[2];  // one, congruent with its place in main memory
  alignas(128) LevelCounts level_counts;
  alignas(128) BuildState state;
  alignas(128) TopState top_state;
  RecordRing ring;
  Level levels[kMaxTreeDepth];
  Event events[kEvents];
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
        stream_(transfers, store.ring, plan.raw_records),
        margin_(tree_margin_of(store.state.low, store.state.high)) {
    for (auto& node : store.nodes) node.is_open = false;
  }

  [[nodiscard]] Status build(std::uint32_t bucket) {
    GRIDIRON_TRY(transfers_.get(bucket_place(bucket), plan_.buckets.offset_by(bucket * sizeof(SubtreeBucket)),
                                sizeof(SubtreeBucket), kSetupTag));
    GRIDIRON_TRY(transfers_.wait(kSetupTag));
    const SubtreeBucket head = *bucket_place(bucket);
    begin_ = head.begin;
    keys_ = store_.keys + (begin_ & 1u);  // both ends of a transfer are congruent
    GRIDIRON_TRY(transfers_.get(keys_, plan_.sorted.offset_by(std::uint64_t{begin_} * sizeof(SortedKey)),
                                (head.end - begin_) * static_cast<std::uint32_t>(sizeof(SortedKey)), kSetupTag));
    GRIDIRON_TRY(transfers_.wait(kSetupTag));
    store_.level_counts = {};
    raw_node_ = raw_node_place(begin_, plan_.input.leaf_triangles);
    next_record_ = record_sent_ = begin_;
    // Tags of an item depend on nothing but the item.
    record_side_ = first_event_ = next_node_ = next_result_ = 0;
    next_place_ = sent_window().elements();
    stream_.reset();
    const auto add_all = [&](const Piece* pieces, std::uint64_t first, std::uint32_t count) -> Status {
      for (std::uint32_t i = 0; i < count; ++i) GRIDIRON_TRY(add(pieces[i], static_cast<std::uint32_t>(first) + i));
      return Status::kOk;
    };
    GRIDIRON_TRY((for_each_window<Piece, 16>(transfers_, store_.pieces, plan_.pieces, head.first_piece,
                                             head.first_piece + head.piece_count, kFirstMacroTag, add_all)));
    GRIDIRON_TRY(take_events());
    GRIDIRON_TRY(send_records());
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
  using Event = typename Store::Event;
  static constexpr std::uint8_t kRecordTag = kFirstOutputTag, kCountsTag = kFirstOutputTag + 2;
  static constexpr std::uint8_t kResultTag = kFirstOutputTag + 3, kNodeTag = kFirstOutputTag + 4;
  static_assert(Store::kNodes <= 4);

  // --- Splits -----------------------------------------------------------------------------------------------------

  [[nodiscard]] SubtreeBucket* bucket_place(std::uint32_t bucket) { return &store_.bucket[bucket & 1u]; }
  GRIDIRON_INLINE void count_work(SplitWork work, std::uint32_t amount) const {
    transfers_.add_work(kind_of(work), amount);
  }
  [[nodiscard]] std::uint32_t whole_count() const { return store_.state.triangle_count; }
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t code_of(std::uint32_t i) const { return keys_[i - begin_].key.code(); }
  [[nodiscard]] std::uint32_t middle_of(const TreeRange& part) const {
    return this->first_like_last(part.begin, part.end, code_of(part.begin), code_of(part.end - 1));
  }
  [[nodiscard]] Status code_again(std::uint32_t begin, std::uint32_t end) {
    SortedKey* const keys = keys_ + (begin - begin_);
    const std::uint32_t count = end - begin;
    if (count > kFewTreeTriangles && is_crowd(keys[0], keys[count - 1])) {
      transfers_.add_work(BuildWork::kGatheredKey, count);
      for (std::uint32_t i = 0; i < count; ++i) keys[i].key = again_of(keys[i]);
      return Status::kOk;
    }
    // Records go the way of those of leaves.
    if (count > kFewTreeTriangles) GRIDIRON_TRY(take_events());
    return gridiron::code_again<Layout>(transfers_, store_.ring, plan_.raw_records, keys, count, store_.counts);
  }

  [[nodiscard]] Status add(const Piece& piece, std::uint32_t number) {
    if (piece.depth == 0) return add_leaf(Store::kNoParent, number, piece.begin, piece.end - piece.begin);
    top_depth_ = depth_ = piece.depth - 1;
    GRIDIRON_TRY(open(piece.begin, piece.end, Store::kNoParent, number));
    // Each turn opens a node, makes a leaf or ends a node.
    while (depth_ > top_depth_) {
      Level& level = store_.levels[depth_ - 1];
      if (level.next == level.count) {
        --depth_;
        GRIDIRON_TRY(add_event({level.slot, Store::kEnds, 0}));
        continue;
      }
      const TreeRange& range = level.ranges[level.next];
      const std::uint32_t child = level.next++;
      OpenNode& node = store_.nodes[level.slot];
      if (range.level < 0) {
        node.children[child] = TreeChild::leaf(range.begin, range.end - range.begin);
        GRIDIRON_TRY(add_leaf(level.slot, child, range.begin, range.end - range.begin));
      } else {
        node.children[child] = TreeChild::node(store_.level_counts.of[depth_]);
        GRIDIRON_TRY(open(range.begin, range.end, level.slot, child));
      }
    }
    return Status::kOk;
  }

  [[nodiscard]] Status open(std::uint32_t begin, std::uint32_t end, std::uint32_t parent, std::uint32_t child) {
    Level& level = store_.levels[depth_];
    const std::uint32_t index = store_.level_counts.of[depth_]++;
    const std::uint32_t slot = depth_ * Layout::kNodeLag + index % Layout::kNodeLag;
    ++depth_;
    OpenNode& node = store_.nodes[slot];
    while (node.is_open) GRIDIRON_TRY(take_event());
    GRIDIRON_TRY(this->split_range(begin, end, depth_, level.ranges, level.count));
    level.next = 0;
    level.slot = slot;
    node.count = level.count;
    node.index = index;
    node.parent = parent;
    node.child = child;
    node.is_open = true;
    return Status::kOk;
  }

  // --- Leaves and ends of nodes -----------------------------------------------------------------------------------

  [[nodiscard]] Status add_leaf(std::uint32_t node, std::uint32_t child, std::uint32_t first, std::uint32_t count) {
    GRIDIRON_TRY(add_event({node, child, count}));
    for (std::uint32_t i = first; i < first + count; ++i) {
      const std::uint32_t id = keys_[i - begin_].key.id();
      while (stream_.is_full()) GRIDIRON_TRY(take_event());
      GRIDIRON_TRY(stream_.push(id));
    }
    return Status::kOk;
  }

  [[nodiscard]] Status add_event(const Event& event) {
    if (event_count_ == Store::kEvents) GRIDIRON_TRY(take_event());
    store_.events[(first_event_ + event_count_) % Store::kEvents] = event;
    ++event_count_;
    return Status::kOk;
  }
  // Takes the next event, or of the last leaf what has been asked for.
  [[nodiscard]] Status take_event() {
    Event& event = store_.events[first_event_];
    if (event.child != Store::kEnds) {
      for (; event.left > 0 && !stream_.is_empty(); --event.left) GRIDIRON_TRY(take_record());
      if (event.left > 0) return Status::kOk;
    }
    const Event done = event;
    first_event_ = (first_event_ + 1) % Store::kEvents;
    --event_count_;
    if (done.child == Store::kEnds) return end_node(done.node);
    transfers_.add_work(BuildWork::kLeaf);
    const QuadBox box = leaf_box_.grown(margin_);
    const float area = leaf_area_;
    leaf_box_ = QuadBox{};
    leaf_area_ = 0.0f;
    return deliver(done.node, done.child, box, area, 0);
  }
  // All of them; afterwards the stream's memory is free.
  [[nodiscard]] Status take_events() {
    while (event_count_ > 0) GRIDIRON_TRY(take_event());
    return Status::kOk;
  }
  [[nodiscard]] GRIDIRON_INLINE Status take_record() {
    transfers_.add_work(BuildWork::kTakenRecord);
    const VertexTriangle* record = nullptr;
    GRIDIRON_TRY(stream_.pop(keys_[next_record_ - begin_].key.id(), record));
    const CornerQuads corners = corner_quads(*record);
    leaf_box_.add(corners);
    if (plan_.input.order == TreeOrder::kForAnyHit) leaf_area_ += std::bit_cast<float>(record->reserved[0]);
    return write_record(*record);
  }
  // A child's box and area go to its node, or those of a piece to main memory.
  [[nodiscard]] Status deliver(std::uint32_t node, std::uint32_t child, const QuadBox& box, float area,
                               std::uint32_t number) {
    if (node != Store::kNoParent) {
      store_.nodes[node].boxes[child].low = box.low;
      store_.nodes[node].boxes[child].high = box.high;
      store_.nodes[node].areas[child] = area;
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
    return transfers_.put(&result, plan_.piece_results.offset_by(std::uint64_t{child} * sizeof(PieceResult)),
                          sizeof(PieceResult), kResultTag);
  }

  [[nodiscard]] Status end_node(std::uint32_t slot) {
    transfers_.add_work(BuildWork::kNode);
    OpenNode& open_node = store_.nodes[slot];
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
    node.reserved[0] = slot / Layout::kNodeLag;
    node.reserved[1] = open_node.index;
    GRIDIRON_TRY(
        transfers_.put(&node, plan_.raw_nodes.offset_by(raw_node_++ * sizeof(TreeNode)), sizeof(TreeNode), tag));
    open_node.is_open = false;
    return deliver(open_node.parent, open_node.child, QuadBox::of_node(node), total, open_node.index);
  }

  // --- Records ----------------------------------------------------------------------------------------------------

  [[nodiscard]] Window<VertexTriangle> sent_window() {
    return {store_.records[record_side_], plan_.input.records, record_sent_};
  }
  [[nodiscard]] GRIDIRON_INLINE Status write_record(const VertexTriangle& record) {
    const auto* const from = reinterpret_cast<const std::uint32_t*>(&record);
    auto* const to = reinterpret_cast<std::uint32_t*>(next_place_);
    for (std::uint32_t i = 0; i < 8; i += 4) Lanes<4>::Int::load(from + i).store(to + i);
    // Without the area.
    const Lanes<4>::Int kept = words_quad(~0u, 0, 0, ~0u);
    (Lanes<4>::Int::load(from + 8) & kept).store(to + 8);
    ++next_record_;
    ++next_place_;
    return next_record_ - record_sent_ == Store::kRecords ? send_records() : Status::kOk;
  }
  [[nodiscard]] Status send_records() {
    const std::uint32_t count = next_record_ - record_sent_;
    if (count == 0) return Status::kOk;
    GRIDIRON_TRY(sent_window().put(transfers_, count, static_cast<std::uint8_t>(kRecordTag + record_side_)));
    record_sent_ = next_record_;
    record_side_ = 1 - record_side_;
    next_place_ = sent_window().elements();
    return transfers_.wait(static_cast<std::uint8_t>(kRecordTag + record_side_));
  }

  BuildTransfers<P>& transfers_;
  Store& store_;
  const BuildPlan& plan_;
  RecordStream<P> stream_;
  float margin_;
  SortedKey* keys_ = nullptr;  // of the bucket
  std::uint32_t begin_ = 0;
  std::uint32_t depth_ = 0, top_depth_ = 0;
  std::uint32_t first_event_ = 0, event_count_ = 0;
  QuadBox leaf_box_;  // of the leaf that is being taken
  float leaf_area_ = 0.0f;
  std::uint32_t next_node_ = 0, next_result_ = 0;
  std::uint64_t raw_node_ = 0;
  std::uint32_t next_record_ = 0, record_sent_ = 0, record_side_ = 0;
  VertexTriangle* next_place_ = nullptr;  // of the next record, among those that are sent at once
};

/// Writes records, raw_nodes, piece_results and level_counts. Items: buckets of pieces.
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
