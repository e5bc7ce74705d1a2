// A tile of a view and the most that it may take: see view_bound.h. Names of loops and counters are those of the
// kernel's engine/tree. Source: own; core/README.md, "The worst tile of a view". Memory: std::vector. Threads: one.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/engine/tree/tile_hits.h>
#include <gridiron/engine/tree/tile_memory.h>
#include <gridiron/engine/tree/tile_projection.h>
#include <gridiron/engine/tree/tile_tracer.h>
#include <gridiron/engine/tree/tile_triangles.h>
#include <gridiron/engine/tree/tile_work.h>
#include <gridiron/frame/tile_bound.h>
#include <gridiron/ray/intersect_rays.h>
#include <gridiron/sim/view_shapes.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace gridiron::sim::view {

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
    for (auto& block : parts_) block.clear();
    block_span_.fill(floor() * 0x1p-16f);
    pixels_.fill(kAllPixels);
    covered_.fill(0);
    covered_low_.fill(kInfinity);
    if (columns_ != Width || rows_count_ != Width) {
      for (std::uint32_t block = 0; block < Memory::kBlocks; ++block) pixels_[block] = pixels_of(block);
    }
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
    if (is_bounded()) finish();
  }

 private:
  using Memory = TileMemory<Width, kLanes>;
  static constexpr std::uint32_t kRow = Memory::kBlocksPerRow;
  static constexpr std::uint32_t kGroups = kBlockPixels / kLanes;

  // 1 / w of what is too far away.
  [[nodiscard]] float floor() const {
    const float farthest = scene_.head.t_far * scene_.eye.unit;
    return farthest < 0x1p60f ? 1.0f / farthest : 0.0f;
  }
  [[nodiscard]] bool is_bounded() const { return scene_.eye.template is_bounded<Width>(); }
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
    if (!scene_.eye.is_trusted) {
      met = is_bounded() ? boxes_in_wide_margins(scene_.eye, tile_, node, kFloatMax) : ~0u;
    }
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
    if (!is_bounded()) {
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
      const float last_x = static_cast<float>(columns_ - 1), last_y = static_cast<float>(rows_count_ - 1);
      const std::uint32_t met = scene_.eye.is_trusted
                                    ? corners.template cull<Width, false>(tile_, kFloatMax, last_x, last_y, box)
                                    : corners.template cull<Width, true>(tile_, kFloatMax, last_x, last_y, box);
      const std::uint32_t kept = met & ((1u << here) - 1);
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
      shape.box = memory_->boxes[i];
      shape.record = memory_->records[i];
      shape.node = static_cast<std::uint32_t>(nodes_);
      shape.kind = is_careful                    ? Shape::Kind::kCareful
                   : (group.tiny >> i & 1u) != 0 ? Shape::Kind::kTiny
                                                 : Shape::Kind::kDrawn;
      shape.span = is_careful ? kInfinity : memory_->functions[kNearSpan][i];
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
    if (shapes_.empty()) {
      count(TileWork::kFunctionGroup, (kept_ + kLanes - 1) / kLanes);
      return;
    }
    has_careful_ = std::ranges::any_of(shapes_, [](const Shape& f) { return f.kind == Shape::Kind::kCareful; });
    const std::uint64_t groups = (kept_ + kLanes - 1) / kLanes;
    count(TileWork::kFunctionGroup, groups);
    for (std::uint32_t i = 0; i < shapes_.size(); ++i) {
      const Shape& shape = shapes_[i];
      touched_ = 0;
      if (shape.kind == Shape::Kind::kCareful) {
        for_each_block(shape.box, [&](std::uint32_t block, std::uint32_t pixels) {
          pixels &= pixels_[block];
          if (pixels != 0) add_part(i, {-kInfinity, kInfinity}, block, pixels, pixels);
        });
      } else if (shape.kind == Shape::Kind::kTiny) {
        const std::uint32_t lines = (shape.box >> 24) - (shape.box >> 8 & 0xFFu);
        for (std::uint32_t line = 0; line <= lines && line < 3; ++line) ++drawn_tiny_[line];
        const Edges edges(shape);
        for_each_block(shape.box,
                       [&](std::uint32_t block, std::uint32_t pixels) { add_tested(i, edges, block, pixels); });
      } else {
        count(TileWork::kDrawn);
        add_drawn(i);
      }
      mark(shape, touched_);
    }
    // Places of tiny triangles: three of each line that one of the group has. Hits change which triangles share a
    // group, but not how many groups there may be with a triangle that has so many lines.
    for (const std::uint64_t with_line : drawn_tiny_) count(TileWork::kTinyPlace, 3 * std::min(with_line, groups));
    settle_blocks();
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
  // A shape may change these blocks: those with pixels that it may hit.
  void mark(const Shape& shape, std::uint64_t blocks) {
    if (shape.node != changed_node_) {
      changed_ += static_cast<std::uint64_t>(std::popcount(changed_blocks_));
      changed_blocks_ = 0;
      changed_node_ = shape.node;
    }
    changed_blocks_ |= blocks;
    marked_.push_back(static_cast<std::uint8_t>(std::popcount(blocks)));
  }

  // Calls visit(block, pixels) for the blocks of a box, with its pixels there.
  template <class Visit>
  static void for_each_block(std::uint32_t box, Visit&& visit) {
    const std::uint32_t x0 = box & 0xFFu, y0 = box >> 8 & 0xFFu, x1 = box >> 16 & 0xFFu, y1 = box >> 24;
    for (std::uint32_t by = y0 / kBlockWidth; by <= y1 / kBlockWidth; ++by) {
      const std::uint32_t rows = 0x1111u & bits_of_block(by, y0, y1, kBlockWidth);
      for (std::uint32_t bx = x0 / kBlockWidth; bx <= x1 / kBlockWidth; ++bx) {
        visit(by * kRow + bx, rows * bits_of_block(bx, x0, x1, 1));
      }
    }
  }
  // Columns or rows first..last of a block, `step` bits each.
  static std::uint32_t bits_of_block(std::uint32_t block, std::uint32_t first, std::uint32_t last, std::uint32_t step) {
    const std::uint32_t start = block * kBlockWidth;
    const std::uint32_t low = first > start ? first - start : 0;
    const std::uint32_t end = last - start < kBlockWidth ? last - start + 1 : kBlockWidth;
    return ((1u << (end * step)) - 1) & ~((1u << (low * step)) - 1);
  }
  // Of a block, those in the picture.
  [[nodiscard]] std::uint16_t pixels_of(std::uint32_t block) const {
    const std::uint32_t bx = block % kRow, by = block / kRow;
    if (bx * kBlockWidth >= columns_ || by * kBlockWidth >= rows_count_) return 0;
    return static_cast<std::uint16_t>((0x1111u & bits_of_block(by, 0, rows_count_ - 1, kBlockWidth)) *
                                      bits_of_block(bx, 0, columns_ - 1, 1));
  }

  // A shape's edges in lanes.
  struct Edges {
    Float start[3], x[3], y[3], offset_x, offset_y, slack, span;

    explicit Edges(const Shape& f)
        : offset_x(f.offset_x),
          offset_y(f.offset_y),
          slack(f.edge_span * kEdgeSlack),
          span(f.edge_span * (1.0f + kEdgeSlack)) {
      for (int k = 0; k < 3; ++k) {
        x[k] = Float(f.x[k]);
        y[k] = Float(f.y[k]);
        start[k] = x[k] * Float::load(kTilePlaces<Width>.column) + Float(f.value[k]);
      }
    }
    // Pixels of a block where the triangle may be, and surely is.
    void test(std::uint32_t block, std::uint32_t& possible, std::uint32_t& sure) const {
      const Float column = Float(kTilePlaces<Width>.block_column[block]) - offset_x;
      const Float row = Float(kTilePlaces<Width>.block_row[block]) - offset_y;
      Float value[3];
      for (int k = 0; k < 3; ++k) value[k] = x[k] * column + (y[k] * row + start[k]);
      std::uint32_t none = 0, not_sure = 0;
      for (std::uint32_t line = 0; line < kBlockWidth; ++line) {
        const Float inside = L::min(L::min(value[0], value[1]), value[2]);
        none |= L::sign_bits(L::words_of(inside + slack)) << (line * kBlockWidth);
        not_sure |= L::sign_bits(L::words_of(inside - span)) << (line * kBlockWidth);
        for (int k = 0; k < 3; ++k) value[k] = value[k] + y[k];
      }
      possible = ~none & kAllPixels;
      sure = ~not_sure & kAllPixels;
    }
  };
  static constexpr std::uint32_t kAllPixels = (1u << kBlockPixels) - 1;

  // What a shape may store in a block; sums that round take less than the rest of a span.
  struct Interval {
    float low, high;
  };
  [[nodiscard]] static Interval interval_of(const Shape& f, std::uint32_t block) {
    static constexpr float kMiddle = 0.5f * (kBlockWidth - 1.0f);
    static constexpr float kRoom = static_cast<float>(kMoreStored) + 0.25f;
    const float column = kTilePlaces<Width>.block_column[block] + kMiddle - f.offset_x;
    const float row = kTilePlaces<Width>.block_row[block] + kMiddle - f.offset_y;
    const float middle = f.value[3] + f.x[3] * column + f.y[3] * row;
    const float half = (magnitude(f.x[3]) + magnitude(f.y[3])) * kMiddle + kRoom * f.span;
    return {middle - half, middle + half};
  }
  // Whether all pixels of a block surely have hits in front of all of a shape when it is drawn: as is_hidden().
  [[nodiscard]] bool is_covered(const Shape& f, const Interval& interval, std::uint32_t block) const {
    return f.is_in_order() && covered_[block] == pixels_[block] && interval.high < covered_low_[block];
  }

  // A block tested pixel by pixel. @param pixels  that are tested.
  void add_tested(std::uint32_t number, const Edges& edges, std::uint32_t block, std::uint32_t pixels) {
    const Interval interval = interval_of(shapes_[number], block);
    if (is_covered(shapes_[number], interval, block)) return;
    std::uint32_t possible = 0, sure = 0;
    edges.test(block, possible, sure);
    possible &= pixels & pixels_[block];
    if (possible != 0) add_part(number, interval, block, possible, possible & ~sure);
  }

  // A triangle that is drawn block by block.
  void add_drawn(std::uint32_t number) {
    const Shape& f = shapes_[number];
    const Edges edges(f);
    const std::uint32_t bx0 = (f.box & 0xFFu) / kBlockWidth, by0 = (f.box >> 8 & 0xFFu) / kBlockWidth,
                        bx1 = (f.box >> 16 & 0xFFu) / kBlockWidth, by1 = (f.box >> 24) / kBlockWidth;
    const std::uint32_t of_box = (bx1 - bx0 + 1) * (by1 - by0 + 1);
    if (of_box <= kFewBlocks) {
      count_blocks(of_box, 0);
      for (std::uint32_t by = by0; by <= by1; ++by) {
        for (std::uint32_t bx = bx0; bx <= bx1; ++bx) add_tested(number, edges, by * kRow + bx, kAllPixels);
      }
      return;
    }
    count(TileWork::kLargeTriangle);
    const auto& places = kTilePlaces<Width>;
    const Float zero(0.0f), last(kBlockWidth - 1.0f);
    Float most[3], covers[3];
    const float span = scene_.trusts_floats ? 0.0f : f.edge_span;
    for (int k = 0; k < 3; ++k) {
      most[k] = (L::max(edges.x[k], zero) + L::max(edges.y[k], zero)) * last + Float(f.value[k]);
      covers[k] =
          (most[k] - ((L::min(edges.x[k], zero) + L::min(edges.y[k], zero)) * last + Float(f.value[k]))) + Float(span);
    }
    const std::uint32_t columns = (2u << bx1) - (1u << bx0);
    std::uint64_t tested = 0, covered = 0;
    for (std::uint32_t by = by0; by <= by1; ++by) {
      const Float line = Float(places.block_row[by * kRow]) - edges.offset_y;
      for (std::uint32_t group = 0; group < kRow / kLanes; ++group) {
        const std::uint32_t here = columns >> (group * kLanes) & L::kAllBits;
        if (here == 0) continue;
        count(TileWork::kBlockGroup);
        const Float x = Float::load(places.block_column + group * kLanes) - edges.offset_x;
        // Sums in another order may decide otherwise: within `slack` of a limit a block counts as both.
        Int none = Int::splat(0), partial = Int::splat(0), whole = Int::splat(0);
        for (int k = 0; k < 3; ++k) {
          const Float value = edges.x[k] * x + (edges.y[k] * line + most[k]);
          none = none | L::words_of(value + edges.slack);
          partial = partial | L::words_of(value - covers[k] - edges.slack);
          whole = whole | L::words_of(value - covers[k] + edges.slack);
        }
        const std::uint32_t all = ~L::sign_bits(none) & here, part = L::sign_bits(partial) & all;
        const std::uint32_t base = by * kRow + group * kLanes;
        tested += count_bits(part);
        covered += count_bits(~L::sign_bits(whole) & all);
        for (std::uint32_t rest = part; rest != 0; rest &= rest - 1) {
          add_tested(number, edges, base + lowest_bit(rest), kAllPixels);
        }
        for (std::uint32_t rest = all & ~part; rest != 0; rest &= rest - 1) {
          const std::uint32_t block = base + lowest_bit(rest);
          const Interval interval = interval_of(f, block);
          if (pixels_[block] != 0 && !is_covered(f, interval, block)) {
            add_part(number, interval, block, pixels_[block], 0);
          }
        }
      }
    }
    count_blocks(tested, covered);
  }
  static constexpr std::uint32_t kFewBlocks = 4;  // of TileTracer with four lanes
  void count_blocks(std::uint64_t tested, std::uint64_t covered) {
    count(TileWork::kBlock, tested);
    count(TileWork::kTakenBlock, tested);
    count(TileWork::kCoveredBlock, covered);
    if (scene_.has_facing) count(TileWork::kFacingBlock, tested + covered);
  }

  void add_part(std::uint32_t number, const Interval& interval, std::uint32_t block, std::uint32_t possible,
                std::uint32_t edges) {
    const Shape& f = shapes_[number];
    if (f.kind == Shape::Kind::kTiny) count(TileWork::kTinyPixel, count_bits(possible));
    touched_ |= std::uint64_t{1} << block;
    if (const std::uint32_t sure = possible & ~edges & ~std::uint32_t{covered_[block]}; sure != 0) {
      covered_[block] = static_cast<std::uint16_t>(covered_[block] | sure);
      covered_low_[block] = std::min(covered_low_[block], interval.low);
    }
    if (!is_looked_into()) return;
    const auto bits = static_cast<std::uint16_t>(edges);
    parts_[block].push_back(
        {static_cast<std::uint16_t>(possible), bits, bits, f.is_in_order(), number, interval.low, interval.high});
    block_span_[block] = std::max({block_span_[block], f.span, interval.high * kStoredSpan});
  }

  // Whether any pixel may be decided: Accuracy::kFast decides those of triangles without a bound.
  [[nodiscard]] bool is_looked_into() const { return !scene_.trusts_floats || has_careful_; }

  // Pixels that floats may leave open: those near an edge, and those where two triangles are equally near.
  void settle_blocks() {
    if (!is_looked_into()) return;
    const float floor = this->floor() * (1.0f + 0x1p-14f);
    std::uint64_t looked_into = 0;
    for (std::uint32_t block = 0; block < Memory::kBlocks; ++block) {
      std::vector<BlockPart>& parts = parts_[block];
      if (parts.empty()) continue;
      // Twice: comparisons of floats may round.
      const float apart = 2.0f * block_span_[block];
      const bool is_short = parts.size() <= kMostOfBlock;
      std::uint32_t seen = 0;
      for (std::size_t i = 0; i < parts.size(); ++i) {
        BlockPart& part = parts[i];
        if (scene_.trusts_floats) {
          if (shapes_[part.shape].kind != Shape::Kind::kCareful) part.open = 0;
          continue;
        }
        // Nothing was hit: what t_far or an error of 1 / t leaves open.
        if (!is_short || !(part.low > floor + apart)) part.open = part.possible;
        if (is_short && ((seen & part.possible & ~std::uint32_t{part.open}) != 0 || !part.is_in_order)) {
          const float low = part.low - apart, high = part.high + apart;
          for (std::size_t j = 0; j < i; ++j) {
            BlockPart& other = parts[j];
            if ((part.possible & other.possible) == 0 || low > other.high || other.low > high) continue;
            compare(part, other, block);
            if (!part.is_in_order || !other.is_in_order) compare(other, part, block);
          }
        }
        seen |= part.possible;
      }
      for (const BlockPart& part : parts) {
        if (looked_into > kMostLookedInto || !is_short) {
          add_open_pixels(count_bits(part.open));
          continue;
        }
        for (std::uint32_t rest = part.open; rest != 0; rest &= rest - 1) {
          ++looked_into;
          decide(parts, part, lowest_bit(rest), block);
        }
      }
    }
  }

  // Marks the pixels where a part may have to be decided after another was hit.
  void compare(BlockPart& part, const BlockPart& old_part, std::uint32_t block) const {
    const Shape &f = shapes_[part.shape], &old = shapes_[old_part.shape];
    // In front at least: surely, or not at all.
    const double span = f.span, old_span = old.span;
    const double most = kSumSlack * span + kMoreStored * old_span + double{block_span_[block]};
    const double least = -(kMoreStored * span + kLessStored * old_span);
    const std::uint32_t column = block % kRow * kBlockWidth, row = block / kRow * kBlockWidth;
    const double apart = f.near(column, row) - old.near(column, row);
    const double right = double{f.x[3]} - double{old.x[3]}, down = double{f.y[3]} - double{old.y[3]};
    for (std::uint32_t rest = part.possible & old_part.possible & ~part.open; rest != 0; rest &= rest - 1) {
      const std::uint32_t pixel = lowest_bit(rest);
      const double here = apart + right * (pixel % kBlockWidth) + down * (pixel / kBlockWidth);
      if (!(here > most || here < least)) part.open = static_cast<std::uint16_t>(part.open | 1u << pixel);
    }
  }

  // Whether a pixel surely has a hit so much in front when a part is drawn that floats leave it out: what comes before
  // it was drawn, or something in front of that was.
  [[nodiscard]] bool is_hidden(const std::vector<BlockPart>& parts, const BlockPart& part, std::uint32_t pixel,
                               std::uint32_t x, std::uint32_t y) const {
    const Shape& f = shapes_[part.shape];
    if (!f.is_in_order()) return false;
    const double most = f.near(x, y) + kMoreStored * double{f.span};
    for (const BlockPart* other = parts.data(); other != &part; ++other) {
      if (!other->is_sure(pixel)) continue;
      const Shape& before = shapes_[other->shape];
      if (before.near(x, y) - kLessStored * double{before.span} > most) return true;
    }
    return false;
  }

  // One decision at the most: whichever triangle was hit before.
  void decide(const std::vector<BlockPart>& parts, const BlockPart& part, std::uint32_t pixel, std::uint32_t block) {
    const std::uint32_t x = block % kRow * kBlockWidth + pixel % kBlockWidth,
                        y = block / kRow * kBlockWidth + pixel / kBlockWidth;
    if (is_hidden(parts, part, pixel, x, y)) return;
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
    bool may_tie = false;
    if (passes_through(ray, triangle, work)) {
      const float t = ray_distance(ray, triangle, work);
      std::uint32_t exact = 0;
      Transfer longest{};
      for (const BlockPart& other : parts) {
        if (!other.may_be(pixel) || &other == &part) continue;
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
  std::array<std::vector<BlockPart>, Memory::kBlocks> parts_;
  std::array<float, Memory::kBlocks> block_span_{};      // the most that a block's hits may have
  std::array<std::uint16_t, Memory::kBlocks> pixels_{};  // in the picture
  // Pixels of each block that what comes before surely hits, until all are; and 1 / t of the farthest of these.
  std::array<std::uint16_t, Memory::kBlocks> covered_{};
  std::array<float, Memory::kBlocks> covered_low_{};
  std::uint64_t touched_ = 0;  // blocks that the current shape may change
};

}  // namespace gridiron::sim::view
