// View bound: see the header. Names of loops and counters are those of engine/tree.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/lanes.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/dma/transfers.h>
#include <gridiron/engine/tree/tile_memory.h>
#include <gridiron/engine/tree/tile_projection.h>
#include <gridiron/engine/tree/tile_tracer.h>
#include <gridiron/engine/tree/tile_triangles.h>
#include <gridiron/engine/tree/tile_work.h>
#include <gridiron/ray/intersect_rays.h>
#include <gridiron/sim/engine_work.h>
#include <gridiron/sim/view_bound.h>
#include <gridiron/store/local_store.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <functional>
#include <vector>

namespace gridiron::sim {
namespace {

using L = Lanes<4>;
using Float = L::Float;
using Int = L::Int;
constexpr std::uint32_t kLanes = L::kCount;

// Two ways to sum up a linear function at a pixel differ by less than this share of its span: each rounds at most 11
// times sums of at most 2 size^2, by half a kFloatUnit each time, and the span is twice 30 kFloatUnit size^2 or more.
constexpr float kEdgeSlack = 0.4f;
// The crossing of a row is rounded three times, near places of at most 64.
constexpr float kPlaceSlack = 0x1p-14f;
// In spans of a triangle's 1 / t, whose function's sum at a pixel may round by 12 of the 35 kFloatUnit that a span has at
// least: how far the kernel's sum may be off; from there on, how far what is stored for a hit may be below (an exact
// decision stores 2^-19 less) and above.
constexpr double kSumSlack = 0.35, kLessStored = 0.9, kMoreStored = 1.35;
// An exact decision stores a span of its own.
constexpr double kStoredSpan = 0x1.01p-17;
// Rows with more triangles than this, and tiles with more open pixels, are not looked into: each pixel is open, and
// costs the most.
constexpr std::size_t kMostOfRow = 512;
constexpr std::uint64_t kMostLookedInto = 1u << 15;

// What is drawn: functions of the pixel as in memory, relative to an offset.
struct Shape {
  float value[4], x[4], y[4];  // edges, then 1 / t
  float offset_x, offset_y;
  float edge_span, near_span;
  std::uint32_t box;
  std::uint32_t record;
  std::uint32_t node;  // nodes that the tile had entered when it was queued
  enum class Kind : std::uint8_t { kTiny, kDrawn, kCareful } kind;
};

// A shape's pixels of one row, by bits.
struct RowPart {
  std::uint32_t possible;  // where it may be hit
  std::uint32_t edges;     // of these, where edges are open
  std::uint32_t open;      // and where it may have to be decided
  std::uint32_t shape;
  double near, near_x;  // 1 / t at column 0 and per column
  double low, high;     // what may be stored, where it is possible
  double span;          // of 1 / t
  bool is_in_order;     // drawn after all that comes before it

  [[nodiscard]] double at(std::uint32_t x) const { return near + near_x * x; }
  [[nodiscard]] bool may_be(std::uint32_t x) const { return (possible >> x & 1u) != 0; }
  [[nodiscard]] bool is_sure(std::uint32_t x) const { return ((possible & ~edges) >> x & 1u) != 0; }
};

std::uint32_t bits_between(int first, int end) {  // [first, end)
  if (end <= first) return 0;
  const std::uint64_t below_end = (std::uint64_t{1} << end) - 1;
  return static_cast<std::uint32_t>(below_end & ~((std::uint64_t{1} << first) - 1));
}

// What tiles of a frame have in common.
struct Scene {
  FrameHead head;
  TreeRecord tree{};
  const TreeNode* nodes = nullptr;
  const VertexTriangle* triangles = nullptr;
  std::uint64_t nodes_address = 0, triangles_address = 0;  // in main memory
  EyeProjection eye{};
  bool has_facing = false, trusts_floats = false, breaks_ties = false;

  explicit Scene(const ViewFrame& frame) : head(frame.head) {
    std::memcpy(&tree, frame.image.data() + (head.tree_address - head.image_address), sizeof tree);
    nodes = reinterpret_cast<const TreeNode*>(frame.image.data() + tree.nodes_offset_bytes);
    triangles = reinterpret_cast<const VertexTriangle*>(frame.image.data() + tree.triangles_offset_bytes);
    nodes_address = head.image_address + tree.nodes_offset_bytes;
    triangles_address = head.image_address + tree.triangles_offset_bytes;
    float largest = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      largest = std::max({largest, magnitude(tree.bounds_minimum[axis]), magnitude(tree.bounds_maximum[axis])});
    }
    eye = project_eye(head, largest);
    has_facing = head.shading == static_cast<std::uint32_t>(Shading::kSimple);
    trusts_floats = head.accuracy == static_cast<std::uint32_t>(Accuracy::kFast);
    breaks_ties = head.accuracy == static_cast<std::uint32_t>(Accuracy::kExact);
  }
};

// Commands and bytes of a transfer.
struct Transfer {
  std::uint64_t commands = 0, bytes = 0;
};
Transfer transfer_of(std::uint64_t address, std::uint32_t bytes) {
  Transfer transfer{0, bytes};
  for (std::uint32_t rest = bytes; rest != 0; ++transfer.commands) {
    const std::uint32_t piece = next_piece_bytes(MainAddress{address}, rest);
    address += piece;
    rest -= piece;
  }
  return transfer;
}
Transfer transfer_of(const Scene& scene, TreeChild child) {
  if (!child.is_leaf()) {
    return transfer_of(scene.nodes_address + std::uint64_t{child.node_index()} * sizeof(TreeNode), sizeof(TreeNode));
  }
  return transfer_of(scene.triangles_address + std::uint64_t{child.first()} * sizeof(VertexTriangle),
                     child.count() * static_cast<std::uint32_t>(sizeof(VertexTriangle)));
}

// One tile of eye rays.
template <std::uint32_t Width>
class TileBounder {
 public:
  explicit TileBounder(const Scene& scene) : scene_(scene), memory_(std::make_unique<Memory>()) {}

  void add(const TileView& view, TileBound& bound) {
    bound_ = &bound;
    view_ = view;
    const FrameHead& head = scene_.head;
    columns_ = std::min(Width, head.width - view.left);
    rows_count_ = std::min(Width, head.height - view.top);
    project_tile(head, scene_.eye, view, Width, tile_);
    shapes_.clear();
    for (auto& row : rows_) row.clear();
    block_span_.fill(floor_of(head) * 0x1p-16f);
    queued_ = 0;
    drawn_tiny_[0] = drawn_tiny_[1] = drawn_tiny_[2] = 0;
    marked_.clear();
    changed_ = 0;
    changed_blocks_ = 0;
    changed_node_ = 0;
    kept_ = 0;
    count(TileWork::kView);
    count(Work::kIdGroup, Memory::kBlocks * kGroups);
    walk();
    if (scene_.eye.is_trusted) finish();
  }

 private:
  using Memory = TileMemory<Width, kLanes>;
  static constexpr std::uint32_t kRow = Memory::kBlocksPerRow;
  static constexpr std::uint32_t kGroups = kBlockPixels / kLanes;

  // 1 / t of what is too far away.
  static float floor_of(const FrameHead& head) { return head.t_far < 0x1p60f ? 1.0f / head.t_far : 0.0f; }
  void count(WorkId kind, std::uint64_t amount = 1) { bound_->work[kind.number()] += amount; }
  void fetch(const Transfer& transfer, std::uint64_t times = 1) {
    count(Work::kGetIssue, times * transfer.commands);
    count(Work::kWait, times);
    bound_->get_bytes += times * transfer.bytes;
  }

  // All nodes and leaves that the tile meets, in the kernel's order.
  //
  // Transfers: a child is asked for where it comes into the window of those that are visited next, and again where it
  // comes back into it behind the children of one before it: at most once for each child that leaves the stack, and as
  // many as the window holds for each node with children. It is fetched where it has left the cache meanwhile, and once
  // more where it is visited.
  void walk() {
    const Transfer root = transfer_of(scene_, TreeChild::node(0));
    fetch(root, 2);
    stack_.assign(1, {0.0f, TreeChild::node(0).bits, 0.0f, 0});
    std::uint64_t again = 0;
    bool has_leaves = false;
    nodes_ = 0;
    Transfer longest = root;
    while (!stack_.empty()) {
      const WaitingChild next = stack_.back();
      stack_.pop_back();
      const TreeChild child{next.child};
      if (child.is_leaf()) {
        has_leaves = true;
        visit_leaf(child, next.size);
        continue;
      }
      ++nodes_;
      const std::size_t bottom = stack_.size();
      push_children(scene_.nodes[child.node_index()]);
      const std::size_t added = stack_.size() - bottom;
      for (std::size_t i = bottom; i < stack_.size(); ++i) {
        const Transfer transfer = transfer_of(scene_, TreeChild{stack_[i].child});
        fetch(transfer, 2);
        longest = {std::max(longest.commands, transfer.commands), std::max(longest.bytes, transfer.bytes)};
      }
      again += std::min<std::uint64_t>(added, scene_.head.fetch_depth);
    }
    fetch(longest, again);
    if (!has_leaves) return;
    count(TileWork::kClearedBlock, Memory::kBlocks);
    if (columns_ != Width || rows_count_ != Width) count(TileWork::kChangedBlock, Memory::kBlocks);
  }

  // TileTracer::push_children(), but for hits.
  void push_children(const TreeNode& node) {
    count(TileWork::kBoxGroup, (node.child_count + (kLanes - 1)) / kLanes);
    alignas(64) float least_w[kTreeWidth], sizes[kTreeWidth];
    std::uint32_t met = 0;
    for (std::uint32_t base = 0; base < node.child_count; base += kLanes) {
      const auto plane = [&](int p, bool is_least) {
        const float* const k = tile_.planes[p];
        const auto side = [&](int axis) {
          return Float::load(((k[axis] > 0.0f) == is_least ? node.low : node.high)[axis] + base);
        };
        return L::bounded_sum(side(0), Float(k[0]),
                              L::bounded_sum(side(1), Float(k[1]), L::bounded_sum(side(2), Float(k[2]), Float(k[3]))));
      };
      const Float inside = L::min(L::min(plane(0, false), plane(1, false)), L::min(plane(2, false), plane(3, false)));
      const Float w = plane(4, true);
      w.store(least_w + base);
      const auto extent = [&](int axis) {
        return Float::load(node.high[axis] + base) - Float::load(node.low[axis] + base);
      };
      L::max(L::max(extent(0), extent(1)), extent(2)).store(sizes + base);
      met |= ((inside >= Float(0.0f)) & (w <= Float(kFloatMax))).bits() << base;
    }
    if (!scene_.eye.is_trusted) met = ~0u;
    const std::size_t bottom = stack_.size();
    for (std::uint32_t rest = met & ((2u << (node.child_count - 1)) - 1); rest != 0; rest &= rest - 1) {
      const std::uint32_t i = lowest_bit(rest);
      std::size_t place = stack_.size();
      while (place > bottom && stack_[place - 1].w < least_w[i]) --place;
      stack_.insert(stack_.begin() + static_cast<std::ptrdiff_t>(place),
                    WaitingChild{least_w[i], node.children[i].bits, sizes[i], 0});
    }
    count(TileWork::kChild, stack_.size() - bottom);
  }

  void visit_leaf(TreeChild child, float size) {
    const VertexTriangle* const records = scene_.triangles + child.first();
    if (!scene_.eye.is_trusted) {
      // Every pixel of every triangle.
      if (scene_.has_facing) count(Work::kNormalSetup, child.count());
      for (std::uint32_t i = 0; i < child.count(); ++i) fetch(record_transfer(child.first() + i));
      add_open_pixels(std::uint64_t{child.count()} * columns_ * rows_count_);
      return;
    }
    count(TileWork::kLeaf);
    const LeafBase base(scene_.eye, tile_, Width, records[0], size);
    for (std::uint32_t first = 0; first < child.count(); first += kLanes) {
      const std::uint32_t here = std::min(child.count() - first, kLanes);
      count(TileWork::kCornerGroup);
      LeafCorners<L> corners;
      corners.project(tile_, base, records + first, here);
      Int box;
      const std::uint32_t kept = corners.template cull<Width>(kFloatMax, static_cast<float>(columns_ - 1),
                                                              static_cast<float>(rows_count_ - 1), box) &
                                 ((1u << here) - 1);
      if (kept == 0) continue;
      count(TileWork::kKeptGroup);
      queue(corners, box, kept, child.first() + first, records + first);
      if (queued_ >= kLanes) set_up(kLanes);
    }
  }

  // TileTracer::queue(), without what only hits need.
  void queue(const LeafCorners<L>& corners, Int box, std::uint32_t kept, std::uint32_t first_record,
             const VertexTriangle* records) {
    const L::Packing packing{kept, queued_};
    const auto put = [&](std::uint32_t word, Int value) { L::append(packing, value, memory_->queue[word]); };
    for (std::uint32_t i = 0; i < 3; ++i) {
      put(kCornerX + i, L::words_of(corners.x[i]));
      put(kCornerY + i, L::words_of(corners.y[i]));
      put(kCornerW + i, L::words_of(corners.w[i]));
    }
    put(kCornerError, L::words_of(Float(corners.error)));
    put(kPixelBox, box);
    put(kRecord, Int::splat(first_record) + Int::load(kLaneNumbers.lane));
    put(kTriangleId, L::words_of(corners.id));
    if (scene_.has_facing) {
      count(TileWork::kNormalGroup);
      Float normal[3];
      count(Work::kNormalSetup, count_bits(kept & ~float_normals<L>(corners.vertices, normal)));
    }
    (void)records;
    queued_ += count_bits(kept);
    kept_ += count_bits(kept);
  }

  // Functions of the first `lanes` of the queue: the same, lane by lane, whichever triangles share a group.
  void set_up(std::uint32_t lanes) {
    const TileGroup group = set_up_group<L, Width>(*memory_, tile_, 0, (1u << lanes) - 1, 0.0f);
    for (std::uint32_t i = 0; i < lanes; ++i) {
      const bool is_drawn = (group.drawn >> i & 1u) != 0, is_careful = (group.careful >> i & 1u) != 0;
      if (!is_drawn && !is_careful) continue;
      Shape shape{};
      for (std::uint32_t k = 0; k < 3; ++k) {
        shape.value[k] = memory_->functions[kEdgeValue + k][i];
        shape.x[k] = memory_->functions[kEdgeX + k][i];
        shape.y[k] = memory_->functions[kEdgeY + k][i];
      }
      shape.value[3] = memory_->functions[kNearValue][i];
      shape.x[3] = memory_->functions[kNearX][i];
      shape.y[3] = memory_->functions[kNearY][i];
      shape.offset_x = memory_->functions[kOffsetX][i];
      shape.offset_y = memory_->functions[kOffsetY][i];
      shape.edge_span = memory_->functions[kEdgeSpan][i];
      shape.near_span = memory_->functions[kNearSpan][i];
      shape.box = memory_->boxes[i];
      shape.record = memory_->records[i];
      shape.node = static_cast<std::uint32_t>(nodes_);
      shape.kind = is_careful                        ? Shape::Kind::kCareful
                   : (group.tiny >> i & 1u) != 0 ? Shape::Kind::kTiny
                                                     : Shape::Kind::kDrawn;
      shapes_.push_back(shape);
    }
    queued_ -= lanes;
    for (std::uint32_t word = 0; word < kNormal; ++word) {
      Int::load(memory_->queue[word] + kLanes).store(memory_->queue[word]);
    }
  }

  // Everything is queued.
  void finish() {
    if (queued_ != 0) set_up(queued_);
    has_careful_ = std::ranges::any_of(shapes_, [](const Shape& f) { return f.kind == Shape::Kind::kCareful; });
    const std::uint64_t groups = (kept_ + kLanes - 1) / kLanes;
    count(TileWork::kFunctionGroup, groups);
    for (std::uint32_t i = 0; i < shapes_.size(); ++i) {
      const Shape& shape = shapes_[i];
      std::uint64_t blocks = blocks_of(shape.box);
      if (shape.kind == Shape::Kind::kCareful) {
        add_careful(i);
        mark(shape, blocks);
        continue;
      }
      if (shape.kind == Shape::Kind::kTiny) {
        const std::uint32_t lines = (shape.box >> 24) - (shape.box >> 8 & 0xFFu);
        for (std::uint32_t line = 0; line <= lines && line < 3; ++line) ++drawn_tiny_[line];
      } else {
        count(TileWork::kDrawn);
        add_blocks(shape, blocks);
      }
      mark(shape, blocks);
      add_rows(i);
    }
    // Places of tiny triangles: three of each line that one of the group has. Hits change which triangles share a
    // group, but not how many groups there may be with a triangle that has so many lines.
    for (const std::uint64_t with_line : drawn_tiny_) count(TileWork::kTinyPlace, 3 * std::min(with_line, groups));
    settle_rows();
    count(TileWork::kChangedBlock, most_changed_blocks());
  }

  // Blocks that a node finds changed when it is entered.
  //
  // Those of triangles that were queued since the node before; where that one is left out, blocks of both count
  // once. But up to three triangles wait in the queue while a node is entered, and change their blocks after it.
  [[nodiscard]] std::uint64_t most_changed_blocks() {
    changed_ += static_cast<std::uint64_t>(std::popcount(changed_blocks_));
    const std::size_t late = std::min<std::size_t>(marked_.size(), (kLanes - 1) * nodes_);
    std::ranges::nth_element(marked_, marked_.begin() + static_cast<std::ptrdiff_t>(late), std::greater{});
    for (std::size_t i = 0; i < late; ++i) changed_ += marked_[i];
    return std::min(changed_, nodes_ * Memory::kBlocks);
  }
  // A shape may change these blocks.
  void mark(const Shape& shape, std::uint64_t blocks) {
    if (shape.node != changed_node_) {
      changed_ += static_cast<std::uint64_t>(std::popcount(changed_blocks_));
      changed_blocks_ = 0;
      changed_node_ = shape.node;
    }
    changed_blocks_ |= blocks;
    marked_.push_back(static_cast<std::uint8_t>(std::popcount(blocks)));
  }
  [[nodiscard]] static std::uint64_t blocks_of(std::uint32_t box) {
    const std::uint32_t bx0 = (box & 0xFFu) / kBlockWidth, by0 = (box >> 8 & 0xFFu) / kBlockWidth,
                        bx1 = (box >> 16 & 0xFFu) / kBlockWidth, by1 = (box >> 24) / kBlockWidth;
    std::uint64_t blocks = 0;
    for (std::uint32_t by = by0; by <= by1; ++by) blocks |= std::uint64_t{(2u << bx1) - (1u << bx0)} << (by * kRow);
    return blocks;
  }

  // Blocks that the kernel tests, hits aside.
  // @param blocks  of its box; gets those of them.
  void add_blocks(const Shape& f, std::uint64_t& blocks) {
    const std::uint32_t bx0 = (f.box & 0xFFu) / kBlockWidth, by0 = (f.box >> 8 & 0xFFu) / kBlockWidth,
                        bx1 = (f.box >> 16 & 0xFFu) / kBlockWidth, by1 = (f.box >> 24) / kBlockWidth;
    const std::uint32_t of_box = (bx1 - bx0 + 1) * (by1 - by0 + 1);
    if (of_box <= kFewBlocks) {
      add_tested(of_box, 0);
      return;
    }
    blocks = 0;
    const auto& places = kTilePlaces<Width>;
    const Float zero(0.0f), last(kBlockWidth - 1.0f);
    Float most[3], covers[3];
    const float span = scene_.trusts_floats ? 0.0f : f.edge_span;
    for (int k = 0; k < 3; ++k) {
      const Float x(f.x[k]), y(f.y[k]), value(f.value[k]);
      most[k] = (L::max(x, zero) + L::max(y, zero)) * last + value;
      covers[k] = (most[k] - ((L::min(x, zero) + L::min(y, zero)) * last + value)) + Float(span);
    }
    const std::uint32_t columns = (2u << bx1) - (1u << bx0);
    std::uint64_t tested = 0, covered = 0;
    for (std::uint32_t by = by0; by <= by1; ++by) {
      const Float line = Float(places.block_row[by * kRow]) - Float(f.offset_y);
      for (std::uint32_t group = 0; group < kRow / kLanes; ++group) {
        const std::uint32_t here = columns >> (group * kLanes) & L::kAllBits;
        if (here == 0) continue;
        count(TileWork::kBlockGroup);
        const Float x = Float::load(places.block_column + group * kLanes) - Float(f.offset_x);
        // Sums in another order may decide otherwise: within this of a limit a block counts as both.
        const Float slack(f.edge_span * kEdgeSlack);
        Int none = Int::splat(0), partial = Int::splat(0), whole = Int::splat(0);
        for (int k = 0; k < 3; ++k) {
          const Float value = Float(f.x[k]) * x + L::bounded_sum(Float(f.y[k]), line, most[k]);
          none = none | L::words_of(value + slack);
          partial = partial | L::words_of(value - covers[k] - slack);
          whole = whole | L::words_of(value - covers[k] + slack);
        }
        const std::uint32_t all = ~L::sign_bits(none) & here;
        blocks |= std::uint64_t{all} << (by * kRow + group * kLanes);
        tested += count_bits(L::sign_bits(partial) & all);
        covered += count_bits(~L::sign_bits(whole) & all);
      }
    }
    add_tested(tested, covered);
  }
  static constexpr std::uint32_t kFewBlocks = 4;  // of TileTracer with four lanes
  void add_tested(std::uint64_t tested, std::uint64_t covered) {
    count(TileWork::kBlock, tested);
    count(TileWork::kCoveredBlock, covered);
    if (scene_.has_facing) count(TileWork::kFacingBlock, tested + covered);
  }

  // Where a shape's edges cross the rows of pixels, four rows at a time.
  void add_rows(std::uint32_t number) {
    const Shape& f = shapes_[number];
    const bool is_tiny = f.kind == Shape::Kind::kTiny;
    // Blocks are tested whole.
    const std::uint32_t round = is_tiny ? 0 : kBlockWidth - 1;
    const std::uint32_t x0 = (f.box & 0xFFu) & ~round, y0 = (f.box >> 8 & 0xFFu) & ~round;
    const std::uint32_t x1 = std::min((f.box >> 16 & 0xFFu) | round, columns_ - 1),
                        y1 = std::min((f.box >> 24) | round, rows_count_ - 1);
    const Float first(static_cast<float>(x0)), last(static_cast<float>(x1));
    Float inverse[3], before[3], after[3];
    bool is_left[3];
    for (int k = 0; k < 3; ++k) {
      static constexpr float kLeastSlope = 0x1p-120f;
      is_left[k] = f.x[k] >= 0.0f;
      const float slope = std::max(magnitude(f.x[k]), kLeastSlope);
      const float per = 1.0f / slope;
      inverse[k] = Float(is_left[k] ? per : -per);
      const float slack = f.edge_span * kEdgeSlack * per + kPlaceSlack;
      before[k] = Float(slack);
      after[k] = Float(f.edge_span * per + slack);
    }
    for (std::uint32_t y = y0; y <= y1; y += kLanes) {
      const Float row = Float(static_cast<float>(y) - f.offset_y) + Float::load(kFourRows);
      Float low = first, high = last, sure_low = first, sure_high = last;
      for (int k = 0; k < 3; ++k) {
        const Float place = Float(f.offset_x) - (Float(f.value[k]) + row * Float(f.y[k])) * inverse[k];
        if (is_left[k]) {
          low = L::max(place - before[k], low);
          sure_low = L::max(place + after[k], sure_low);
        } else {
          high = L::min(place + before[k], high);
          sure_high = L::min(place - after[k], sure_high);
        }
      }
      alignas(16) float lows[4], highs[4], sure_lows[4], sure_highs[4];
      low.store(lows);
      high.store(highs);
      sure_low.store(sure_lows);
      sure_high.store(sure_highs);
      for (std::uint32_t i = 0; i < kLanes && y + i <= y1; ++i) {
        const std::uint32_t possible = bits_within(lows[i], highs[i]);
        if (possible != 0) add_part(number, y + i, possible, possible & ~bits_within(sure_lows[i], sure_highs[i]));
      }
    }
  }
  static constexpr float kFourRows[4] = {0.0f, 1.0f, 2.0f, 3.0f};
  // Whole numbers from `low` to `high`, as bits. Precondition: 0 <= low, high < Width.
  static std::uint32_t bits_within(float low, float high) {
    if (!(low <= high)) return 0;
    const int whole = static_cast<int>(low);
    return bits_between(whole + (static_cast<float>(whole) < low ? 1 : 0), static_cast<int>(high) + 1);
  }

  void add_part(std::uint32_t number, std::uint32_t row, std::uint32_t possible, std::uint32_t edges) {
    const Shape& f = shapes_[number];
    if (f.kind == Shape::Kind::kTiny) count(TileWork::kTinyPixel, count_bits(possible));
    if (!is_looked_into()) return;
    const double near = double{f.value[3]} + double{f.y[3]} * (row - double{f.offset_y}) - double{f.x[3]} * double{f.offset_x};
    const int first = std::countr_zero(possible), last = 31 - std::countl_zero(possible);
    const double at_first = near + double{f.x[3]} * first, at_last = near + double{f.x[3]} * last;
    const double span = f.near_span, most = std::max(at_first, at_last) + kMoreStored * span;
    rows_[row].push_back({possible, edges, edges, number, near, f.x[3],
                          std::min(at_first, at_last) - kMoreStored * span, most, span,
                          f.kind == Shape::Kind::kDrawn});
    const double stored = std::max(span, most * kStoredSpan);
    for (int block = first / 4; block <= last / 4; ++block) {
      double& most_span = block_span_[row / kBlockWidth * kRow + static_cast<std::uint32_t>(block)];
      most_span = std::max(most_span, stored);
    }
  }

  // Whether any pixel may be decided: Accuracy::kFast decides those of triangles without a bound.
  [[nodiscard]] bool is_looked_into() const { return !scene_.trusts_floats || has_careful_; }

  // Every pixel of the box is decided, and what it stores may be as near as anything.
  void add_careful(std::uint32_t number) {
    const Shape& f = shapes_[number];
    const std::uint32_t bits = bits_between(static_cast<int>(f.box & 0xFFu), static_cast<int>((f.box >> 16 & 0xFFu) + 1));
    const double all = kInfinity;
    for (std::uint32_t y = f.box >> 8 & 0xFFu; y <= f.box >> 24; ++y) {
      rows_[y].push_back({bits, bits, bits, number, 0.0, 0.0, -all, all, all, false});
      for (std::uint32_t block = 0; block < kRow; ++block) {
        if ((bits >> (block * kBlockWidth) & 15u) != 0) block_span_[y / kBlockWidth * kRow + block] = all;
      }
    }
  }

  // Pixels that floats may leave open: those near an edge, and those where two triangles are equally near.
  void settle_rows() {
    if (!is_looked_into()) return;
    const double floor = floor_of(scene_.head) * (1.0 + 0x1p-14);
    std::uint64_t looked_into = 0;
    for (std::uint32_t y = 0; y < rows_count_; ++y) {
      std::vector<RowPart>& row = rows_[y];
      const double* const spans = &block_span_[y / kBlockWidth * kRow];
      if (row.size() > kMostOfRow) {
        for (const RowPart& part : row) {
          if (!scene_.trusts_floats || shapes_[part.shape].kind == Shape::Kind::kCareful) {
            add_open_pixels(count_bits(part.possible));
          }
        }
        continue;
      }
      const double most_span = *std::max_element(spans, spans + kRow);
      std::uint32_t seen = 0;
      for (std::size_t i = 0; i < row.size(); ++i) {
        RowPart& part = row[i];
        if (scene_.trusts_floats) {
          if (shapes_[part.shape].kind != Shape::Kind::kCareful) part.open = 0;
          continue;
        }
        // Nothing was hit: what t_far or an error of 1 / t leaves open.
        if (!(part.low > floor + most_span)) part.open = part.possible;
        if ((seen & part.possible) != 0) {
          for (std::size_t j = 0; j < i; ++j) {
            RowPart& other = row[j];
            if ((part.possible & other.possible) == 0 || part.low > other.high + most_span ||
                other.low > part.high + most_span) {
              continue;
            }
            compare(part, other, spans);
            // Which of them is drawn first depends on what else is kept.
            if (!part.is_in_order || !other.is_in_order) compare(other, part, spans);
          }
        }
        seen |= part.possible;
      }
      for (const RowPart& part : row) {
        if (looked_into > kMostLookedInto) {
          add_open_pixels(count_bits(part.open));
          continue;
        }
        for (std::uint32_t rest = part.open; rest != 0; rest &= rest - 1) {
          ++looked_into;
          decide(row, part, lowest_bit(rest), y);
        }
      }
    }
  }

  // Marks the pixels where a part may have to be decided after another was hit.
  void compare(RowPart& part, const RowPart& old, const double* spans) {
    const std::uint32_t both = part.possible & old.possible;
    const int first = std::countr_zero(both), last = 31 - std::countl_zero(both);
    const double span = *std::max_element(spans + first / 4, spans + last / 4 + 1);
    // In front at least: surely, or not at all.
    const double most = kSumSlack * part.span + kMoreStored * old.span + span;
    const double least = -(kMoreStored * part.span + kLessStored * old.span);
    const double apart = part.near - old.near, per_column = part.near_x - old.near_x;
    const double at_first = apart + per_column * first, at_last = apart + per_column * last;
    if ((at_first > most && at_last > most) || (at_first < least && at_last < least)) return;
    for (std::uint32_t rest = both & ~part.open; rest != 0; rest &= rest - 1) {
      const double here = apart + per_column * lowest_bit(rest);
      if (!(here > most || here < least)) part.open |= rest & -rest;
    }
  }

  // Whether a pixel surely has a hit so much in front when a part is drawn that floats leave it out. What is drawn
  // block by block comes after all before it; these were drawn, or something in front of them was.
  [[nodiscard]] static bool is_hidden(const std::vector<RowPart>& row, const RowPart& part, std::uint32_t x) {
    if (!part.is_in_order) return false;
    const double most = part.at(x) + kMoreStored * part.span;
    for (const RowPart* other = row.data(); other != &part; ++other) {
      if (other->is_sure(x) && other->at(x) - kLessStored * other->span > most) return true;
    }
    return false;
  }

  // One decision at the most: whichever triangle was hit before.
  void decide(const std::vector<RowPart>& row, const RowPart& part, std::uint32_t x, std::uint32_t y) {
    if (is_hidden(row, part, x)) return;
    count(TileWork::kOpenPixel);
    if (scene_.has_facing) count(TileWork::kFacingBlock);
    BatchRay ray{};
    const FrameHead& head = scene_.head;
    for (int axis = 0; axis < 3; ++axis) {
      ray.origin[axis] = head.eye[axis];
      ray.dir[axis] = pixel_direction(head, axis, (static_cast<float>(view_.left) + view_.dx) + static_cast<float>(x),
                                      (static_cast<float>(view_.top) + view_.dy) + static_cast<float>(y));
      ray.dir_max = std::max(ray.dir_max, magnitude(ray.dir[axis]));
    }
    const std::uint32_t record = shapes_[part.shape].record;
    const VertexTriangle& triangle = scene_.triangles[record];
    fetch(record_transfer(record));
    WorkCounters work;
    const bool is_hit = passes_through(ray, triangle, work);
    bool may_tie = false;
    if (is_hit) {
      const float t = ray_distance(ray, triangle, work);
      std::uint32_t exact = 0;
      Transfer longest{};
      for (const RowPart& other : row) {
        if (!other.may_be(x) || &other == &part) continue;
        WorkCounters of_other;
        const std::uint32_t other_record = shapes_[other.shape].record;
        const float other_t = ray_distance(ray, scene_.triangles[other_record], of_other);
        exact = std::max(exact, of_other[Work::kExactDistance]);
        may_tie = may_tie || other_t == t;
        const Transfer transfer = record_transfer(other_record);
        longest = {std::max(longest.commands, transfer.commands), std::max(longest.bytes, transfer.bytes)};
      }
      if (longest.commands != 0) {
        work.add(Work::kRayDistance);
        work.add(Work::kExactDistance, exact);
        fetch(longest);
      }
    }
    if (may_tie && scene_.breaks_ties) {
      work.add(Work::kExactOrder);
      work.add(Work::kExactSign, 3);
    }
    for (const Work kind :
         {Work::kDoubleSign, Work::kExactSign, Work::kRayDistance, Work::kExactDistance, Work::kExactOrder}) {
      count(kind, work[kind]);
    }
  }

  // The most of so many decisions.
  void add_open_pixels(std::uint64_t pixels) {
    count(TileWork::kOpenPixel, pixels);
    if (scene_.has_facing) count(TileWork::kFacingBlock, pixels);
    count(Work::kDoubleSign, 3 * pixels);
    count(Work::kExactSign, (scene_.breaks_ties ? 6 : 3) * pixels);
    count(Work::kRayDistance, 2 * pixels);
    count(Work::kExactDistance, 2 * pixels);
    if (scene_.breaks_ties) count(Work::kExactOrder, pixels);
    // Records of both triangles, each across a boundary.
    fetch({2, sizeof(VertexTriangle)}, 2 * pixels);
  }

  [[nodiscard]] Transfer record_transfer(std::uint32_t record) const {
    return transfer_of(scene_, TreeChild::leaf(record, 1));
  }

  const Scene& scene_;
  std::unique_ptr<Memory> memory_;
  TileBound* bound_ = nullptr;
  TileView view_{};
  TileProjection tile_{};
  std::uint32_t columns_ = 0, rows_count_ = 0, queued_ = 0;
  std::uint64_t kept_ = 0, nodes_ = 0;
  std::uint64_t changed_ = 0, changed_blocks_ = 0;  // up to a node; since then
  std::uint32_t changed_node_ = 0;
  std::vector<std::uint8_t> marked_;  // blocks that each shape may change
  std::uint64_t drawn_tiny_[3] = {};  // tiny triangles with a first, second, third line
  bool has_careful_ = false;
  std::vector<WaitingChild> stack_;
  std::vector<Shape> shapes_;
  std::array<std::vector<RowPart>, Width> rows_;
  std::array<double, Memory::kBlocks> block_span_{};
};

}  // namespace

struct ViewBound::State {
  explicit State(const ViewFrame& frame) : scene(frame), large(scene), small(scene), store(frame.store) {}

  Scene scene;
  TileBounder<TreeLayout256K<64>::kEyeTileWidth> large;
  TileBounder<TreeLayout64K::kEyeTileWidth> small;
  StoreSize store;

  template <class Bounder>
  void add_eyes(Bounder& bounder, std::uint32_t eye_width, std::uint32_t left, std::uint32_t top, TileBound& bound) {
    const FrameHead& head = scene.head;
    const std::uint32_t right = std::min(left + head.tile_width, head.width);
    const std::uint32_t bottom = std::min(top + head.tile_width, head.height);
    for (std::uint32_t y = top; y < bottom; y += eye_width) {
      for (std::uint32_t x = left; x < right; x += eye_width) bounder.add({x, y, 0.0f, 0.0f}, bound);
    }
  }
};

bool has_view_bound(const FrameHead& head, StoreSize store) {
  const bool is_layout = (store == StoreSize::k256KB && head.tile_width == TreeLayout256K<64>::kTileWidth) ||
                         (store == StoreSize::k64KB && head.tile_width == TreeLayout64K::kTileWidth);
  return is_layout && head.engine_id == static_cast<std::uint32_t>(EngineId::kTree) && head.depth_address == 0 &&
         head.shading != static_cast<std::uint32_t>(Shading::kScene) &&
         head.accuracy != static_cast<std::uint32_t>(Accuracy::kCompact);
}

ViewBound::ViewBound(const ViewFrame& frame) : state_(std::make_unique<State>(frame)) {}
ViewBound::~ViewBound() = default;
ViewBound::ViewBound(ViewBound&&) noexcept = default;

TileBound ViewBound::of(std::uint32_t tile_id) {
  const FrameHead& head = state_->scene.head;
  const std::uint32_t width = head.tile_width;
  const std::uint32_t left = tile_id % head.tiles_x * width, top = tile_id / head.tiles_x * width;
  TileBound bound;
  const auto count = [&](WorkId kind, std::uint64_t amount) { bound.work[kind.number()] += amount; };
  if (state_->store == StoreSize::k64KB) {
    state_->add_eyes(state_->small, TreeLayout64K::kEyeTileWidth, left, top, bound);
  } else {
    state_->add_eyes(state_->large, TreeLayout256K<64>::kEyeTileWidth, left, top, bound);
  }
  // A command waits for room in the queue, if that.
  count(Work::kWait, bound[Work::kGetIssue]);
  // TileRenderer's own.
  const std::uint64_t pixels = std::uint64_t{width} * width;
  const bool is_simple = head.shading == static_cast<std::uint32_t>(Shading::kSimple);
  count(Work::kTileStart, 1);
  if (left + width > head.width || top + width > head.height) count(Work::kIdGroup, (is_simple ? 2 : 1) * pixels / 4);
  count(is_simple ? Work::kShadedSimpleGroup : Work::kShadedGroup, pixels / kLanes);
  count(Work::kWait, 2);
  for (const std::uint64_t plane : {head.color_address, head.id_address}) {
    if (plane == 0) continue;
    const Transfer transfer = transfer_of(plane + tile_id * pixels * 4, static_cast<std::uint32_t>(pixels * 4));
    count(Work::kPutIssue, transfer.commands);
    count(Work::kWait, transfer.commands);
    bound.put_bytes += transfer.bytes;
  }
  return bound;
}

TileCycles view_tile_cycles(const TileBound& bound, const MachineProfile& machine, std::uint32_t output_depth) {
  const auto prices = work_prices(machine.work_cycles, kTreeEngine);
  TileCycles cycles;
  for (std::uint32_t kind = 0; kind < kTreeEngine.kind_count(); ++kind) {
    cycles.work += static_cast<double>(bound.work[kind]) * prices[kind];
  }
  const double gets = static_cast<double>(bound[Work::kGetIssue]), puts = static_cast<double>(bound[Work::kPutIssue]);
  cycles.commands =
      (gets + puts) * machine.issue_cycles + static_cast<double>(bound[Work::kWait]) * machine.wait_cycles;
  const double line_bytes = machine.line_bytes, in_flight = machine.lines_in_flight;
  const double turn = machine.channel_bytes_per_cycle > 0 ? line_bytes / machine.channel_bytes_per_cycle : 0.0;
  const double way = machine.latency_cycles.longest() + machine.core_count * in_flight * turn;
  // Lines of a command behind its first one.
  const auto under_way = [&](double commands, double bytes, double most_bytes) {
    const double further = bytes / line_bytes + commands;
    const double most_lines = most_bytes / line_bytes + 2;
    const double ways = commands + (most_lines > in_flight ? further / in_flight : 0.0);
    return ways * way + further * machine.core_line_interval_cycles;
  };
  cycles.transfers = under_way(gets, static_cast<double>(bound.get_bytes), kMaxTreeLeaf * sizeof(VertexTriangle)) +
                     (1 + output_depth) *
                         under_way(puts, static_cast<double>(bound.put_bytes), kPortableBoundaryBytes);
  return cycles;
}

}  // namespace gridiron::sim
