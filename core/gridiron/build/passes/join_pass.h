// The last two passes of a build. One item numbers the nodes of each bucket and makes the nodes above the pieces; then
// nodes of the buckets get their numbers and go to their places.
// Memory: the pass's store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/passes/build_plan.h>
#include <gridiron/build/passes/image_pass.h>
#include <gridiron/build/passes/pass_tools.h>
#include <gridiron/build/tree/tree_box.h>
#include <gridiron/build/tree/tree_order.h>

namespace gridiron {

struct JoinStore {
  static constexpr std::uint32_t kWindow = 8;

  alignas(128) std::byte counts[2 * window_bytes<LevelCounts>(kWindow)];
  alignas(128) std::byte tops[2 * window_bytes<TopNode>(kWindow)];
  alignas(128) TopNode top;
  alignas(128) LevelCounts firsts[kWindow];
  alignas(128) std::byte heads[window_bytes<SubtreeBucket>(kWindow)];
  alignas(128) TreeNode node;
  alignas(128) PieceResult results[kTreeWidth];   // of children
  alignas(32) std::byte pieces[kTreeWidth][32];   // likewise, each congruent with its place
  alignas(32) std::byte numbers[kTreeWidth][32];  // the granule of the number of the first node of a level
  alignas(128) PieceResult result;
  alignas(128) BuildResult build;
  alignas(128) BuildState state;
  alignas(128) TopState top_state;
  TreeImageHead image_head;
  alignas(128) std::byte zeros[kLineBytes];
  std::uint32_t next[16];  // number of the next node of a level
};

/// Numbers nodes and makes those above the pieces.
template <class P>
class TreeJoiner {
 public:
  TreeJoiner(BuildTransfers<P>& transfers, JoinStore& store, const BuildPlan& plan)
      : transfers_(transfers), store_(store), plan_(plan) {}

  /// Errors: kMemoryTooSmall.
  [[nodiscard]] Status run() {
    GRIDIRON_TRY(count_nodes());
    GRIDIRON_TRY(number_nodes());
    nodes_ = nodes_of(plan_, store_.state.triangle_count);
    for (std::uint32_t i = store_.top_state.top_count; i-- > 0;) GRIDIRON_TRY(make_node(i));
    if (plan_.input.is_tree_image) GRIDIRON_TRY(write_image_head());
    GRIDIRON_TRY(transfers_.put(&store_.build, plan_.input.result, sizeof(BuildResult), kFirstOutputTag));
    return transfers_.wait(kFirstOutputTag);
  }

 private:
  // Also the padding between records and nodes.
  [[nodiscard]] Status write_image_head() {
    make_image_head(plan_, store_.build.size, store_.image_head);
    GRIDIRON_TRY(transfers_.put(&store_.image_head, plan_.input.image, sizeof(TreeImageHead), kFirstOutputTag));
    const MainAddress end =
        plan_.input.records.offset_by(std::uint64_t{store_.state.triangle_count} * sizeof(VertexTriangle));
    const auto padding = static_cast<std::uint32_t>(nodes_.value - end.value);
    if (padding == 0) return Status::kOk;
    for (std::byte& byte : store_.zeros) byte = std::byte{0};
    return transfers_.put(store_.zeros + (kLineBytes - padding), end, padding, kFirstOutputTag);
  }

  [[nodiscard]] Status count_nodes() {
    std::uint32_t counts[kMaxTreeDepth] = {};
    GRIDIRON_TRY((for_each_window<LevelCounts, JoinStore::kWindow>(
        transfers_, store_.counts, plan_.level_counts, 0, store_.top_state.bucket_count, kFirstMacroTag,
        [&](const LevelCounts* buckets, std::uint64_t, std::uint32_t count) {
          for (std::uint32_t i = 0; i < count; ++i) {
            for (std::uint32_t level = 0; level < kMaxTreeDepth; ++level) counts[level] += buckets[i].of[level];
          }
          return Status::kOk;
        })));
    GRIDIRON_TRY((for_each_window<TopNode, JoinStore::kWindow>(
        transfers_, store_.tops, plan_.tops, 0, store_.top_state.top_count, kFirstMacroTag,
        [&](const TopNode* tops, std::uint64_t, std::uint32_t count) {
          for (std::uint32_t i = 0; i < count; ++i) ++counts[tops[i].depth - 1];
          return Status::kOk;
        })));
    TreeSize& size = store_.build.size;
    store_.build = {};
    for (std::uint32_t level = 0; level < kMaxTreeDepth; ++level) {
      store_.next[level] = size.node_count;
      size.node_count += counts[level];
      if (counts[level] > 0) size.depth = level + 1;
    }
    size.triangle_count = store_.state.triangle_count;
    size.dropped_triangle_count = plan_.input.triangle_count - size.triangle_count;
    for (int axis = 0; axis < 3; ++axis) {
      size.low[axis] = store_.state.low[axis];
      size.high[axis] = store_.state.high[axis];
    }
    return size.node_count > plan_.input.node_room ? Status::kMemoryTooSmall : Status::kOk;
  }

  // Numbers the nodes of each level in the order of their triangles: buckets, and above them the nodes that begin in
  // one or where one ends. A node that begins in a bucket reaches beyond it, so the bucket's nodes of its level are
  // before it.
  [[nodiscard]] Status number_nodes() {
    std::uint32_t next_top = 0;
    const auto number_tops = [&](std::uint32_t end) -> Status {
      while (next_top < store_.top_state.top_count) {
        const MainAddress place = plan_.tops.offset_by(std::uint64_t{next_top} * sizeof(TopNode));
        GRIDIRON_TRY(fetch(transfers_, store_.top, place));
        if (store_.top.begin >= end) return Status::kOk;
        store_.top.number = store_.next[store_.top.depth - 1]++;
        GRIDIRON_TRY(transfers_.put(&store_.top, place, sizeof(TopNode), kFirstOutputTag));
        GRIDIRON_TRY(transfers_.wait(kFirstOutputTag));
        ++next_top;
      }
      return Status::kOk;
    };
    std::uint32_t top_begin = 0;  // of the next node above the pieces
    const auto number_buckets = [&](const LevelCounts* counts, std::uint64_t first, std::uint32_t count) -> Status {
      const Window<SubtreeBucket> heads(store_.heads, plan_.buckets, first);
      GRIDIRON_TRY(heads.get(transfers_, count, kSetupTag));
      GRIDIRON_TRY(transfers_.wait(kSetupTag));
      GRIDIRON_TRY(transfers_.wait(kFirstOutputTag + 1));
      for (std::uint32_t i = 0; i < count; ++i) {
        for (std::uint32_t level = 0; level < kMaxTreeDepth; ++level) {
          store_.firsts[i].of[level] = store_.next[level];
          store_.next[level] += counts[i].of[level];
        }
        if (top_begin >= heads.elements()[i].end) continue;
        GRIDIRON_TRY(number_tops(heads.elements()[i].end));
        top_begin = next_top < store_.top_state.top_count ? store_.top.begin : std::uint32_t{~0u};
      }
      return transfers_.put(store_.firsts, plan_.level_firsts.offset_by(first * sizeof(LevelCounts)),
                            count * static_cast<std::uint32_t>(sizeof(LevelCounts)), kFirstOutputTag + 1);
    };
    GRIDIRON_TRY((for_each_window<LevelCounts, JoinStore::kWindow>(transfers_, store_.counts, plan_.level_counts, 0,
                                                                   store_.top_state.bucket_count, kFirstMacroTag,
                                                                   number_buckets)));
    return transfers_.wait(kFirstOutputTag + 1);
  }

  // Makes a node above the pieces; those below it have been made.
  [[nodiscard]] Status make_node(std::uint32_t top) {
    GRIDIRON_TRY(fetch(transfers_, store_.top, plan_.tops.offset_by(std::uint64_t{top} * sizeof(TopNode))));
    transfers_.add_work(BuildWork::kNode);
    const TopNode& from = store_.top;
    for (std::uint32_t i = 0; i < from.child_count; ++i) {
      const std::uint32_t child = from.children[i];
      const bool is_top = (child & TopNode::kTop) != 0;
      const std::uint64_t number = child & ~TopNode::kTop;
      const MainAddress results = is_top ? plan_.top_results : plan_.piece_results;
      GRIDIRON_TRY(transfers_.get(&store_.results[i], results.offset_by(number * sizeof(PieceResult)),
                                  sizeof(PieceResult), kSetupTag));
      if (is_top) continue;
      GRIDIRON_TRY(transfers_.get(store_.pieces[i] + number % 2 * 16, plan_.pieces.offset_by(number * sizeof(Piece)),
                                  sizeof(Piece), kSetupTag));
    }
    GRIDIRON_TRY(transfers_.wait(kSetupTag));
    const auto piece_of = [&](std::uint32_t i) -> const Piece& {
      return *reinterpret_cast<const Piece*>(store_.pieces[i] + from.children[i] % 2 * 16);
    };
    const auto first_window = [&](const Piece& piece, std::uint32_t i) {
      return Window<std::uint32_t>(store_.numbers[i], plan_.level_firsts,
                                   std::uint64_t{piece.bucket_number()} * 16 + piece.depth - 1);
    };
    for (std::uint32_t i = 0; i < from.child_count; ++i) {
      if ((from.children[i] & TopNode::kTop) != 0 || piece_of(i).depth == 0) continue;
      GRIDIRON_TRY(first_window(piece_of(i), i).get(transfers_, 1, kSetupTag));
    }
    GRIDIRON_TRY(transfers_.wait(kSetupTag));

    TreeNode& node = store_.node;
    QuadBox boxes[kTreeWidth];
    float densities[kTreeWidth], total = 0.0f;
    for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
      node.children[i] = {0};
      if (i >= from.child_count) continue;
      const PieceResult& result = store_.results[i];
      // The last lanes have other words, which nobody asks for.
      boxes[i] = {CornerQuad::load(result.low), CornerQuad::load(result.high)};
      bool is_leaf = false;
      if ((from.children[i] & TopNode::kTop) != 0) {
        node.children[i] = TreeChild::node(result.number);
      } else {
        const Piece& piece = piece_of(i);
        is_leaf = piece.depth == 0;
        node.children[i] = is_leaf ? TreeChild::leaf(piece.begin, piece.end - piece.begin)
                                   : TreeChild::node(*first_window(piece, i).elements() + result.number);
      }
      total += result.area;
      densities[i] = density_of(result.area, is_leaf, boxes[i]);
    }
    store_child_boxes(boxes, node);
    node.order =
        plan_.input.order == TreeOrder::kForAnyHit ? order_of(densities, from.child_count) : kTreeOrderByNumber;
    node.child_count = from.child_count;
    for (std::uint32_t& word : node.reserved) word = 0;
    GRIDIRON_TRY(transfers_.put(&node, nodes_.offset_by(std::uint64_t{from.number} * sizeof(TreeNode)),
                                sizeof(TreeNode), kFirstOutputTag));
    const QuadBox box = QuadBox::of_node(node);
    PieceResult& own = store_.result;
    for (int axis = 0; axis < 3; ++axis) {
      own.low[axis] = lane_of(box.low, axis);
      own.high[axis] = lane_of(box.high, axis);
    }
    own.area = total;
    own.number = from.number;
    GRIDIRON_TRY(transfers_.put(&own, plan_.top_results.offset_by(std::uint64_t{top} * sizeof(PieceResult)),
                                sizeof(PieceResult), kFirstOutputTag));
    return transfers_.wait(kFirstOutputTag);
  }

  BuildTransfers<P>& transfers_;
  JoinStore& store_;
  const BuildPlan& plan_;
  MainAddress nodes_{};
};

/// Writes level_firsts, the nodes above the pieces and the result. Items: one. Errors: kMemoryTooSmall.
template <class P>
[[nodiscard]] Status run_join_pass(BuildTransfers<P>& transfers, JoinStore& store, const BuildPlan& plan) {
  return for_each_item(transfers, 1, [&](std::uint32_t) -> Status {
    GRIDIRON_TRY(fetch(transfers, store.state, plan.state));
    GRIDIRON_TRY(fetch(transfers, store.top_state, plan.top_state));
    return TreeJoiner<P>(transfers, store, plan).run();
  });
}

struct NumbersStore {
  static constexpr std::uint32_t kNodes = 4;  // at once

  alignas(128) TreeNode nodes[2][kNodes];
  alignas(128) LevelCounts counts;
  alignas(128) LevelCounts firsts;
  alignas(128) SubtreeBucket bucket[2];
  alignas(128) TopState top_state;
};

/// Writes the nodes of buckets. Items: buckets of pieces.
template <class P>
[[nodiscard]] Status run_numbers_pass(BuildTransfers<P>& transfers, NumbersStore& store, const BuildPlan& plan) {
  static constexpr std::uint32_t kNodes = NumbersStore::kNodes;
  GRIDIRON_TRY(fetch(transfers, store.top_state, plan.top_state));
  const MainAddress nodes = nodes_of(plan, store.top_state.triangle_count);
  const auto number = [&](std::uint32_t bucket) -> Status {
    if (bucket >= store.top_state.bucket_count) return Status::kOk;
    SubtreeBucket& head = store.bucket[bucket % 2];
    GRIDIRON_TRY(transfers.get(&store.counts, plan.level_counts.offset_by(bucket * sizeof(LevelCounts)),
                               sizeof(LevelCounts), kSetupTag));
    GRIDIRON_TRY(transfers.get(&store.firsts, plan.level_firsts.offset_by(bucket * sizeof(LevelCounts)),
                               sizeof(LevelCounts), kSetupTag));
    GRIDIRON_TRY(
        transfers.get(&head, plan.buckets.offset_by(bucket * sizeof(SubtreeBucket)), sizeof(SubtreeBucket), kSetupTag));
    GRIDIRON_TRY(transfers.wait(kSetupTag));
    std::uint32_t count = 0;
    for (std::uint32_t level = 0; level < kMaxTreeDepth; ++level) count += store.counts.of[level];
    const std::uint64_t first = raw_node_place(head.begin, plan.input.leaf_triangles);
    const auto get_share = [&](std::uint32_t begin) -> Status {
      if (begin >= count) return Status::kOk;
      const std::uint32_t side = begin / kNodes % 2, n = count - begin < kNodes ? count - begin : kNodes;
      GRIDIRON_TRY(transfers.wait(static_cast<std::uint8_t>(kFirstOutputTag + side)));
      return transfers.get(store.nodes[side], plan.raw_nodes.offset_by((first + begin) * sizeof(TreeNode)),
                           n * static_cast<std::uint32_t>(sizeof(TreeNode)),
                           static_cast<std::uint8_t>(kFirstMacroTag + side));
    };
    GRIDIRON_TRY(get_share(0));
    for (std::uint32_t begin = 0; begin < count; begin += kNodes) {
      const std::uint32_t side = begin / kNodes % 2, n = count - begin < kNodes ? count - begin : kNodes;
      GRIDIRON_TRY(get_share(begin + kNodes));
      GRIDIRON_TRY(transfers.wait(static_cast<std::uint8_t>(kFirstMacroTag + side)));
      transfers.add_work(BuildWork::kNumberedNode, n);
      for (std::uint32_t i = 0; i < n; ++i) {
        TreeNode& node = store.nodes[side][i];
        const std::uint32_t level = node.reserved[0];
        const std::uint64_t place = store.firsts.of[level] + node.reserved[1];
        node.reserved[0] = node.reserved[1] = 0;
        for (std::uint32_t child = 0; child < node.child_count; ++child) {
          if (!node.children[child].is_leaf()) node.children[child].bits += store.firsts.of[level + 1];
        }
        GRIDIRON_TRY(transfers.put(&node, nodes.offset_by(place * sizeof(TreeNode)), sizeof(TreeNode),
                                   static_cast<std::uint8_t>(kFirstOutputTag + side)));
      }
    }
    return wait_for(transfers, kFirstOutputTag, 2);
  };
  return for_each_item(transfers, plan.subtree_room, number);
}

}  // namespace gridiron
