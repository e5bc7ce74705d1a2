// Eye rays of a tile through the wide tree: boxes, then triangles, are brought to the tile's pixels. Every pixel's hit
// is that of exact arithmetic: floats decide with bounds of their errors, doubles and integers what these leave open.
// Source: own; Olano, Greer 1997 for edges without clipping; core/TREE.md. Memory: TileMemory. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/engine/tree/tile_hits.h>
#include <gridiron/engine/tree/tile_memory.h>
#include <gridiron/engine/tree/tile_projection.h>
#include <gridiron/engine/tree/tile_triangles.h>
#include <gridiron/engine/tree/tile_work.h>
#include <gridiron/platform/contract.h>
#include <gridiron/ray/distance.h>
#include <gridiron/ray/hits.h>

#include <bit>
#include <cstdint>
#include <type_traits>

namespace gridiron {
inline constexpr auto kLaneNumbers = [] {
  struct {
    alignas(64) std::uint32_t lane[16];
  } numbers{};
  for (std::uint32_t i = 0; i < 16; ++i) numbers.lane[i] = i;
  return numbers;
}();

/// Traces one tile after the other. Between begin() and finish() it goes on step by step, so that several tracers can
/// take turns while what they wait for is on its way.
/// @tparam Source  where nodes and records are, as of RayLists; record(number, triangle) fetches any record, and what
///                 node() and leaf() gave stays until their next call.
/// @tparam MostLanes  of the memory.
template <class L, std::uint32_t Width, class Source, std::uint32_t MostLanes = 16>
class TileTracer {
 public:
  using Memory = TileMemory<Width, MostLanes>;
  TileTracer(Memory& memory, Source& source, WorkCounters& work)
      : memory_(memory), source_(source), work_(work), hits_(memory, source, work) {}

  /// Begins a tile whose first pixel lies in the picture. Borrows frame and eye until finish().
  [[nodiscard]] GRIDIRON_OUTLINE Status begin(const FrameHead& frame, const EyeProjection& eye, const TileView& view,
                                              TilePlanes planes) {
    work_.add(TileWork::kView);
    work_.charge_to(TileWork::kView);
    eye_ = &eye;
    hits_.begin(frame, eye, view, planes);
    project_tile(frame, eye, view, Width, tile_);
    last_x_ = static_cast<float>(hits_.columns() - 1);
    last_y_ = static_cast<float>(hits_.rows() - 1);
    queued_ = 0;
    top_ = 1;
    memory_.stack[0] = {0.0f, TreeChild::node(0).bits, 0.0f, 0};
    return source_.ahead(TreeChild::node(0));
  }

  [[nodiscard]] bool has_more() const { return top_ != 0; }

  /// Visits the next child that is not behind all hits, and has those fetched that come next. Precondition: has_more().
  [[nodiscard]] GRIDIRON_OUTLINE Status step() {
    work_.charge_to(TileWork::kChild);
    for (--top_; memory_.stack[top_].w > hits_.far(); --top_) {
      GRIDIRON_TRY(ask_for_last());
      if (top_ == 0) return Status::kOk;
    }
    const WaitingChild& next = memory_.stack[top_];
    const TreeChild child{next.child};
    if (child.is_leaf()) {
      GRIDIRON_TRY(ask_for_last());
      return visit_leaf(child, next.size);
    }
    const TreeNode* node = nullptr;
    GRIDIRON_TRY(source_.node(child.node_index(), node));
    hits_.update();
    const std::uint32_t bottom = top_;
    push_children(*node);
    if (top_ == bottom) return ask_for_last();
    const std::uint32_t added = top_ - bottom, asked = added < source_.window() ? added : source_.window();
    for (std::uint32_t i = 1; i <= asked; ++i) GRIDIRON_TRY(ask_for(top_ - i));
    return Status::kOk;
  }

  /// Draws what still waits. Then the memory has the tile's hits, if are_there_hits().
  [[nodiscard]] GRIDIRON_OUTLINE Status finish() {
    while (queued_ != 0) GRIDIRON_TRY(draw_group());
    return Status::kOk;
  }

  /// Whether anything may have been hit; if not, the memory's planes are undefined.
  [[nodiscard]] bool are_there_hits() const { return hits_.is_cleared(); }

  /// Writes the hits into the planes of a larger tile.
  /// @param x, y  this tile's first pixel there. @param tile_width  pixels of a row of the planes.
  void store_hits(std::uint32_t x, std::uint32_t y, std::uint32_t tile_width, const Hits& hits) {
    hits_.store(x, y, tile_width, hits);
  }

 private:
  using Float = typename L::Float;
  using Int = typename L::Int;
  static constexpr std::uint32_t kLanes = L::kCount;
  static constexpr std::uint32_t kGroups = kBlockPixels / kLanes;
  static_assert(kLanes <= MostLanes);
  static_assert(kLanes == 1 || kLanes >= kBlockWidth, "a group is a pixel, or one or several rows of a block");
  static constexpr std::uint32_t kRow = Memory::kBlocksPerRow;
  static constexpr float kBlockStep = kBlockWidth;

  // One more child comes into the window: those that are visited next have been asked for.
  [[nodiscard]] GRIDIRON_INLINE Status ask_for_last() {
    return top_ >= source_.window() ? ask_for(top_ - source_.window()) : Status::kOk;
  }
  [[nodiscard]] GRIDIRON_OUTLINE Status ask_for(std::uint32_t place) {
    const WaitingChild& waiting = memory_.stack[place];
    return waiting.w > hits_.far() ? Status::kOk : source_.ahead(TreeChild{waiting.child});
  }

  GRIDIRON_INLINE void push_children(const TreeNode& node) {
    work_.add(TileWork::kBoxGroup, (node.child_count + (kLanes - 1)) / kLanes);
    work_.charge_to(TileWork::kBoxGroup);
    alignas(64) float least_w[kTreeWidth], sizes[kTreeWidth];
    std::uint32_t met = 0;
    for (std::uint32_t base = 0; base < node.child_count; base += kLanes) {
      const auto plane = [&](int p, bool is_least) GRIDIRON_INLINE_LAMBDA {
        const float* const k = tile_.planes[p];
        const auto side = [&](int axis) GRIDIRON_INLINE_LAMBDA {
          return Float::load(((k[axis] > 0.0f) == is_least ? node.low : node.high)[axis] + base);
        };
        return L::bounded_sum(side(0), Float(k[0]),
                              L::bounded_sum(side(1), Float(k[1]), L::bounded_sum(side(2), Float(k[2]), Float(k[3]))));
      };
      const Float w = plane(4, true);
      const Float inside = L::min(L::min(plane(0, false), plane(1, false)), L::min(plane(2, false), plane(3, false)));
      w.store(least_w + base);
      const auto extent = [&](int axis) GRIDIRON_INLINE_LAMBDA {
        return Float::load(node.high[axis] + base) - Float::load(node.low[axis] + base);
      };
      L::max(L::max(extent(0), extent(1)), extent(2)).store(sizes + base);
      met |= ((inside >= Float(0.0f)) & (w <= Float(hits_.far()))).bits() << base;
    }
    if (!eye_->is_trusted) {
      met = ~0u;
      if constexpr (kHasWiderMargins<Width>) met = met_without_trust(node);
    }
    const std::uint32_t there = (2u << (node.child_count - 1)) - 1;
    const std::uint32_t bottom = top_;
    std::uint32_t top = top_;
    work_.charge_to(TileWork::kChild);
    for (std::uint32_t rest = met & there; rest != 0; rest &= rest - 1) {
      const std::uint32_t i = lowest_bit(rest);
      const float w = least_w[i];
      std::uint32_t place = top;
      for (; place > bottom && memory_.stack[place - 1].w < w; --place) {
        L::copy_quad(memory_.stack[place - 1], memory_.stack[place]);
      }
      const WaitingChild waiting{w, node.children[i].bits, sizes[i], 0};
      L::copy_quad(waiting, memory_.stack[place]);
      ++top;
    }
    work_.add(TileWork::kChild, top - bottom);
    top_ = top;
  }

  [[nodiscard]] GRIDIRON_INLINE Status visit_leaf(TreeChild child, float size) {
    if (!hits_.is_cleared()) hits_.clear();
    const VertexTriangle* records = nullptr;
    GRIDIRON_TRY(source_.leaf(child, records));
    if (!eye_->is_trusted) [[unlikely]] {
      if constexpr (kHasWiderMargins<Width>) {
        if (eye_->has_bounds) return visit_with_wider_margins(child, size, records);
      }
      return decide_all(child);
    }
    return project_leaf<false>(child, size, records);
  }
  template <bool kIsWider>
  [[nodiscard]] GRIDIRON_INLINE Status project_leaf(TreeChild child, float size, const VertexTriangle* records) {
    const std::uint32_t count = child.count();
    work_.add(TileWork::kLeaf);
    work_.charge_to(TileWork::kLeaf);
    const LeafBase base(*eye_, tile_, Width, records[0], size);
    for (std::uint32_t first = 0; first < count; first += kLanes) {
      const std::uint32_t here = count - first < kLanes ? count - first : kLanes;
      work_.add(TileWork::kCornerGroup);
      work_.charge_to(TileWork::kCornerGroup);
      LeafCorners<L> corners;
      corners.project(tile_, base, records + first, here);
      Int box;
      const std::uint32_t kept =
          corners.template cull<Width, kIsWider>(tile_, hits_.far(), last_x_, last_y_, box) & ((1u << here) - 1);
      if (kept == 0) continue;
      queue(corners, box, kept, child.first() + first, records + first);
      if (queued_ >= kLanes) GRIDIRON_TRY(draw_group());
    }
    return Status::kOk;
  }

  GRIDIRON_INLINE void queue(const LeafCorners<L>& corners, Int box, std::uint32_t kept, std::uint32_t first_record,
                             const VertexTriangle* records) {
    work_.add(TileWork::kKeptGroup);
    work_.charge_to(TileWork::kKeptGroup);
    const typename L::Packing packing{kept, queued_};
    const auto put = [&](std::uint32_t word, Int value)
                         GRIDIRON_INLINE_LAMBDA { L::append(packing, value, memory_.queue[word]); };
    for (std::uint32_t i = 0; i < 3; ++i) {
      put(kCornerX + i, L::words_of(corners.x[i]));
      put(kCornerY + i, L::words_of(corners.y[i]));
      put(kCornerW + i, L::words_of(corners.w[i]));
    }
    put(kCornerError, L::words_of(Float(corners.error)));
    put(kPixelBox, box);
    put(kRecord, Int::splat(first_record) + Int::load(kLaneNumbers.lane));
    put(kTriangleId, L::words_of(corners.id));
    if (hits_.planes().facing) {
      Float normal[3];
      set_up_normals(corners, kept, records, normal);
      for (std::uint32_t i = 0; i < 3; ++i) put(kNormal + i, L::words_of(normal[i]));
    }
    if (hits_.planes().distance) {
      for (std::uint32_t i = 0; i < 9; ++i) put(kVertex + i, L::words_of(corners.vertices[i / 3][i % 3]));
    }
    queued_ += count_bits(kept);
  }
  // set_up_normal() of a group: its float test, lane by lane; the same bits.
  GRIDIRON_INLINE void set_up_normals(const LeafCorners<L>& corners, std::uint32_t kept, const VertexTriangle* records,
                                      Float (&normal)[3]) {
    work_.add(TileWork::kNormalGroup);
    work_.charge_to(TileWork::kNormalGroup);
    const std::uint32_t sure = float_normals<L>(corners.vertices, normal);
    if ((kept & ~sure) == 0) [[likely]]
      return;
    alignas(64) float words[3][kLanes];
    for (int axis = 0; axis < 3; ++axis) normal[axis].store(words[axis]);
    for (std::uint32_t rest = kept & ~sure; rest != 0; rest &= rest - 1) {
      const std::uint32_t i = lowest_bit(rest);
      work_.add(Work::kNormalSetup);
      float found[3];
      set_up_normal(records[i], found);
      for (int axis = 0; axis < 3; ++axis) words[axis][i] = found[axis];
    }
    for (int axis = 0; axis < 3; ++axis) normal[axis] = Float::load(words[axis]);
  }

  // Draws the first group of lanes of the queue; the rest takes its place.
  [[nodiscard]] GRIDIRON_OUTLINE Status draw_group() {
    const std::uint32_t count = queued_ < kLanes ? queued_ : kLanes;
    work_.add(TileWork::kFunctionGroup);
    work_.charge_to(TileWork::kFunctionGroup);
    TileGroup group = set_up_group<L, Width>(memory_, tile_, 0, (1u << count) - 1, hits_.least_near());
    if (hits_.trusts_floats()) trust_floats();
    std::uint32_t rest = group.drawn;
    if (count_bits(group.tiny) >= kLeastTiny) {
      work_.charge_to(TileWork::kTinyPlace);
      GRIDIRON_TRY(draw_tiny(group.tiny));
      rest &= ~group.tiny;
    }
    for (; rest != 0; rest &= rest - 1) GRIDIRON_TRY(draw_triangle(lowest_bit(rest)));
    for (rest = group.careful; rest != 0; rest &= rest - 1) GRIDIRON_TRY(draw_carefully(lowest_bit(rest)));
    work_.charge_to(TileWork::kFunctionGroup);
    queued_ -= count;
    const std::uint32_t words = hits_.planes().distance ? kTileWords : hits_.planes().facing ? kVertex : kNormal;
    for (std::uint32_t word = 0; word < words; ++word) {
      Int::load(memory_.queue[word] + kLanes).store(memory_.queue[word]);
    }
    return Status::kOk;
  }
  static constexpr std::uint32_t kLeastTiny = kLanes < 16 ? 1 : 4;
  // Accuracy::kFast: what may be inside is, and what is in front by floats is.
  GRIDIRON_INLINE void trust_floats() {
    Float(0.0f).store(memory_.functions[kEdgeSpan]);
    Float(0.0f).store(memory_.functions[kNearSpan]);
  }

  [[nodiscard]] GRIDIRON_INLINE Status draw_tiny(std::uint32_t tiny) {
    const auto function = [&](std::uint32_t kind)
                              GRIDIRON_INLINE_LAMBDA { return Float::load(memory_.functions[kind]); };
    const Int box = Int::load(memory_.boxes);
    const Int byte = Int::splat(0xFF);
    const Int ix0 = box & byte, iy0 = (box >> 8) & byte, ix1 = (box >> 16) & byte, iy1 = (box >> 24) & byte;
    const Float x = L::to_float(ix0) - function(kOffsetX), y = L::to_float(iy0) - function(kOffsetY);
    // Which triangles have a second and a third row or column.
    const Int one = Int::splat(1);
    const std::uint32_t columns[3] = {tiny, (ix0 < ix1).bits() & tiny, (ix0 + one < ix1).bits() & tiny};
    const std::uint32_t lines[3] = {tiny, (iy0 < iy1).bits(), (iy0 + one < iy1).bits()};
    Float left[4];
    for (std::uint32_t k = 0; k < 3; ++k) {
      left[k] =
          L::bounded_sum(function(kEdgeX + k), x, L::bounded_sum(function(kEdgeY + k), y, function(kEdgeValue + k)));
    }
    left[3] = L::bounded_sum(function(kNearX), x, L::bounded_sum(function(kNearY), y, function(kNearValue)));
    for (std::uint32_t row = 0; row < kMostTiny; ++row) {
      if ((lines[row] & tiny) == 0) break;
      Float value[4] = {left[0], left[1], left[2], left[3]};
      alignas(64) float near[kMostTiny][kLanes], inside[kMostTiny][kLanes];
      LaneSets hits = 0;
      const auto test = [&](std::uint32_t column) GRIDIRON_INLINE_LAMBDA {
        work_.add(TileWork::kTinyPlace);
        const Float least = L::min(L::min(value[0], value[1]), value[2]);
        least.store(inside[column]);
        value[3].store(near[column]);
        const std::uint32_t met = ~L::sign_bits(L::words_of(least)) & columns[column] & lines[row];
        hits = hits | LaneSets(met) << (column * kLanes);
      };
      test(0);
      for (std::uint32_t column = 1; column < kMostTiny; ++column) {
        for (std::uint32_t k = 0; k < 3; ++k) value[k] = value[k] + function(kEdgeX + k);
        value[3] = value[3] + function(kNearX);
        test(column);
      }
      for (; hits != 0; hits &= hits - 1) {
        const std::uint32_t hit = lowest_bit(hits), i = hit % kLanes, column = hit / kLanes;
        GRIDIRON_TRY(draw_pixel(i, column, row, near[column][i], inside[column][i]));
      }
      work_.charge_to(TileWork::kTinyPlace);
      for (std::uint32_t k = 0; k < 3; ++k) left[k] = left[k] + function(kEdgeY + k);
      left[3] = left[3] + function(kNearY);
    }
    return Status::kOk;
  }
  static constexpr std::uint32_t kMostTiny = 3;  // columns and rows of a tiny triangle's box
  // A bit a lane, for each column.
  using LaneSets = std::conditional_t<(kLanes * kMostTiny > 32), std::uint64_t, std::uint32_t>;
  // @param inside  the least of the edges' functions, not negative.
  [[nodiscard]] GRIDIRON_INLINE Status draw_pixel(std::uint32_t i, std::uint32_t column, std::uint32_t row, float near,
                                                  float inside) {
    work_.add(TileWork::kTinyPixel);
    work_.charge_to(TileWork::kTinyPixel);
    const std::uint32_t box = memory_.boxes[i];
    const std::uint32_t x = (box & 0xFFu) + column, y = (box >> 8 & 0xFFu) + row;
    const std::uint32_t block = y / kBlockWidth * kRow + x / kBlockWidth;
    const std::uint32_t pixel = y % kBlockWidth * kBlockWidth + x % kBlockWidth;
    const float old = memory_.near[block][pixel], span = memory_.functions[kNearSpan][i];
    if (near + span < old) return Status::kOk;
    if (!(inside >= memory_.functions[kEdgeSpan][i]) || !(near > old + memory_.span[block])) [[unlikely]]
      return hits_.trusts_floats() ? Status::kOk : hits_.decide(block, 1u << pixel, i);
    memory_.near[block][pixel] = near;
    memory_.id[block][pixel] = memory_.ids[i];
    memory_.record[block][pixel] = memory_.records[i];
    memory_.span[block] = span > memory_.span[block] ? span : memory_.span[block];
    hits_.mark(block);
    hits_.take_pixel(block, pixel, i);
    return Status::kOk;
  }
  // A triangle that is drawn block by block: its functions in all lanes.
  struct Drawn {
    Float value[4], x[4], y[4], edge_span, near_span;
    Float start[4], step[4];  ///< at the pixels of a block's first group; from one group to the next
    float span;
    Int id, record;
    std::uint32_t lane;
    Float offset_x, offset_y;  ///< pixel that functions are relative to
    static constexpr unsigned kMost = Memory::kMostLanes;

    GRIDIRON_INLINE Drawn(const Memory& memory, std::uint32_t i)
        : Drawn(&memory.functions[0][i], memory.ids[i], memory.records[i], i) {}
    // @param of_lane  its first function; the next one is Memory::kMostLanes further.
    GRIDIRON_INLINE Drawn(const float* of_lane, std::uint32_t triangle, std::uint32_t place, std::uint32_t i)
        : edge_span(of_lane[kEdgeSpan * kMost]),
          near_span(of_lane[kNearSpan * kMost]),
          span(of_lane[kNearSpan * kMost]),
          id(Int::splat(triangle)),
          record(Int::splat(place)),
          lane(i),
          offset_x(of_lane[kOffsetX * kMost]),
          offset_y(of_lane[kOffsetY * kMost]) {
      for (unsigned k = 0; k < 3; ++k) {
        value[k] = Float(of_lane[(kEdgeValue + k) * kMost]);
        x[k] = Float(of_lane[(kEdgeX + k) * kMost]);
        y[k] = Float(of_lane[(kEdgeY + k) * kMost]);
      }
      value[3] = Float(of_lane[kNearValue * kMost]);
      x[3] = Float(of_lane[kNearX * kMost]);
      y[3] = Float(of_lane[kNearY * kMost]);
      const auto& places = kTilePlaces<Width>;
      const Float column = Float::load(places.column), row = Float::load(places.row);
      for (int k = 0; k < 4; ++k) {
        start[k] = L::bounded_sum(x[k], column, kLanes > kBlockWidth ? L::bounded_sum(y[k], row, value[k]) : value[k]);
        if constexpr (kGroups > 1) step[k] = kLanes > kBlockWidth ? y[k] * Float(float(kLanes) / kBlockWidth) : y[k];
      }
    }
    /// Function k at the first group's pixels of a block.
    [[nodiscard]] GRIDIRON_INLINE Float at(int k, Float column, Float row) const {
      return L::bounded_sum(x[k], column, L::bounded_sum(y[k], row, start[k]));
    }
  };

  [[nodiscard]] GRIDIRON_INLINE Status draw_triangle(std::uint32_t i) {
    work_.add(TileWork::kDrawn);
    work_.charge_to(TileWork::kDrawn);
    const Drawn drawn(memory_, i);
    const std::uint32_t box = memory_.boxes[i];
    const std::uint32_t bx0 = (box & 0xFFu) / kBlockWidth, by0 = (box >> 8 & 0xFFu) / kBlockWidth,
                        bx1 = (box >> 16 & 0xFFu) / kBlockWidth, by1 = (box >> 24) / kBlockWidth;
    if ((bx1 - bx0 + 1) * (by1 - by0 + 1) > kFewBlocks) {
      return draw_many_blocks(drawn, bx0, by0, bx1, by1);
    }
    const std::uint32_t first = by0 * kRow + bx0;
    const Float x = Float(kTilePlaces<Width>.block_column[first]) - drawn.offset_x;
    const Float y = Float(kTilePlaces<Width>.block_row[first]) - drawn.offset_y;
    Float row[4];
    for (int k = 0; k < 4; ++k) row[k] = drawn.at(k, x, y);
    for (std::uint32_t by = by0; by <= by1; ++by) {
      Float value[4] = {row[0], row[1], row[2], row[3]};
      for (std::uint32_t bx = bx0; bx <= bx1; ++bx) {
        GRIDIRON_TRY(draw_block<false>(drawn, by * kRow + bx, value));
        for (int k = 0; k < 4; ++k) value[k] = L::bounded_sum(drawn.x[k], Float(kBlockStep), value[k]);
      }
      for (int k = 0; k < 4; ++k) row[k] = L::bounded_sum(drawn.y[k], Float(kBlockStep), row[k]);
    }
    return Status::kOk;
  }
  static constexpr std::uint32_t kFewBlocks = kLanes == 16 ? 6 : kLanes == 1 ? 2 : 4;

  // Blocks are looked at in lanes: which the triangle may touch in front of what is there, which it covers.
  [[nodiscard]] GRIDIRON_OUTLINE Status draw_many_blocks(const Drawn& f, std::uint32_t bx0, std::uint32_t by0,
                                                         std::uint32_t bx1, std::uint32_t by1) {
    static constexpr float kLast = kBlockWidth - 1.0f;
    work_.add(TileWork::kLargeTriangle);
    work_.charge_to(TileWork::kLargeTriangle);
    const auto& places = kTilePlaces<Width>;
    Float most[4], least[4];
    for (int k = 0; k < 4; ++k) {
      const Float zero(0.0f), last(kLast);
      most[k] = (L::max(f.x[k], zero) + L::max(f.y[k], zero)) * last + f.value[k];
      least[k] = (L::min(f.x[k], zero) + L::min(f.y[k], zero)) * last + f.value[k];
    }
    most[3] = most[3] + f.near_span;
    // A block's value is the sum of a term of its column and one of its row.
    Float across[4][kColumnGroups], covers[3];
    for (std::uint32_t group = 0; group < kColumnGroups; ++group) {
      const Float x = Float::load(places.block_column + group * kLanes) - f.offset_x;
      const Float y = Float::load(places.block_row);
      for (int k = 0; k < 4; ++k) {
        across[k][group] = kGroupRows > 1 ? L::bounded_sum(f.x[k], x, f.y[k] * y) : f.x[k] * x;
      }
    }
    for (int k = 0; k < 3; ++k) covers[k] = (most[k] - least[k]) + f.edge_span;
    const std::uint32_t columns = (2u << bx1) - (1u << bx0);
    for (std::uint32_t by = by0 - by0 % kGroupRows; by <= by1; by += kGroupRows) {
      const Float line = Float(places.block_row[by * kRow]) - f.offset_y;
      Float down[4];
      for (int k = 0; k < 4; ++k) down[k] = L::bounded_sum(f.y[k], line, most[k]);
      const std::uint32_t wanted = kGroupRows > 1 ? blocks_of_rows(columns, by, by0, by1) : columns;
      for (std::uint32_t group = 0; group < kColumnGroups; ++group) {
        const std::uint32_t here = wanted >> (group * kLanes) & L::kAllBits;
        if (here == 0) continue;
        work_.add(TileWork::kBlockGroup);
        work_.charge_to(TileWork::kBlockGroup);
        const std::uint32_t base = by * kRow + group * kLanes;
        // Negative: no pixel, not every pixel.
        Int none = L::words_of((across[3][group] + down[3]) - Float::load(memory_.least_near + base));
        Int partial = none;
        for (int k = 0; k < 3; ++k) {
          const Float value = across[k][group] + down[k];
          none = none | L::words_of(value);
          partial = partial | L::words_of(value - covers[k]);
        }
        const std::uint32_t all = ~L::sign_bits(none) & here;
        if (all == 0) continue;
        const std::uint32_t some = L::sign_bits(partial) & all;
        for (std::uint32_t rest = some; rest != 0; rest &= rest - 1) {
          const std::uint32_t block = base + lowest_bit(rest);
          GRIDIRON_TRY(draw_block_at<false>(f, block, Float(places.block_column[block]) - f.offset_x,
                                            Float(places.block_row[block]) - f.offset_y));
        }
        for (std::uint32_t rest = all & ~some; rest != 0; rest &= rest - 1) {
          const std::uint32_t block = base + lowest_bit(rest);
          GRIDIRON_TRY(draw_block_at<true>(f, block, Float(places.block_column[block]) - f.offset_x,
                                           Float(places.block_row[block]) - f.offset_y));
        }
      }
    }
    return Status::kOk;
  }
  // A group of lanes is a part of a row of blocks, or several rows.
  static constexpr std::uint32_t kColumnGroups = kRow > kLanes ? kRow / kLanes : std::uint32_t{1};
  static constexpr std::uint32_t kGroupRows = kLanes > kRow ? kLanes / kRow : std::uint32_t{1};
  [[nodiscard]] static GRIDIRON_INLINE std::uint32_t blocks_of_rows(std::uint32_t columns, std::uint32_t first,
                                                                    std::uint32_t by0, std::uint32_t by1) {
    std::uint32_t blocks = 0;
    for (std::uint32_t i = 0; i < kGroupRows; ++i) {
      if (first + i >= by0 && first + i <= by1) blocks |= columns << (i * kRow);
    }
    return blocks;
  }

  // @param x, y  of the block's first pixel from the triangle's offset.
  template <bool kCovered>
  [[nodiscard]] GRIDIRON_INLINE Status draw_block_at(const Drawn& f, std::uint32_t block, Float x, Float y) {
    Float value[4];
    for (int k = kCovered ? 3 : 0; k < 4; ++k) value[k] = f.at(k, x, y);
    return draw_block<kCovered>(f, block, value);
  }
  // @param at  values of the functions at the first group's pixels. @tparam kCovered  the triangle surely covers the
  // block.
  template <bool kCovered>
  [[nodiscard]] GRIDIRON_INLINE Status draw_block(const Drawn& f, std::uint32_t block, const Float (&at)[4]) {
    static constexpr TileWork kKind = kCovered ? TileWork::kCoveredBlock : TileWork::kBlock;
    work_.add(kKind);
    work_.charge_to(kKind);
    if constexpr (kLanes == 1) return draw_pixels<kCovered>(f, block, at);
    Float value[4];
    for (int k = kCovered ? 3 : 0; k < 4; ++k) value[k] = at[k];
    // What decides a pixel: the least edge function, and how far the triangle is in front; both with the error that may
    // be. Where one of them is negative, the pixel keeps its hit; signs are joined as words.
    Float inside[kGroups], ahead[kGroups], near[kGroups];
    Int possible[kGroups], surely[kGroups];
    float* const stored = memory_.near[block];
    const auto test = [&](std::uint32_t group) GRIDIRON_INLINE_LAMBDA {
      near[group] = value[3];
      ahead[group] = value[3] - Float::load(stored + group * kLanes);
      possible[group] = L::words_of(ahead[group] + f.near_span);
      if constexpr (!kCovered) {
        inside[group] = L::min(L::min(value[0], value[1]), value[2]);
        possible[group] = possible[group] | L::words_of(inside[group]);
      }
    };
    test(0);
    Int all = possible[0];
    for (std::uint32_t group = 1; group < kGroups; ++group) {
      for (int k = kCovered ? 3 : 0; k < 4; ++k) value[k] = value[k] + f.step[k];
      test(group);
      all = all & possible[group];
    }
    if (L::sign_bits(all) == L::kAllBits) return Status::kOk;
    if constexpr (!kCovered) {
      work_.add(TileWork::kTakenBlock);
      work_.charge_to(TileWork::kTakenBlock);
    }
    const Float old_span(memory_.span[block]);
    std::uint32_t* const id = memory_.id[block];
    std::uint32_t* const record = memory_.record[block];
    for (std::uint32_t group = 0; group < kGroups; ++group) {
      const std::uint32_t pixel = group * kLanes;
      surely[group] = L::words_of(ahead[group] - old_span);
      if constexpr (!kCovered) surely[group] = surely[group] | L::words_of(inside[group] - f.edge_span);
      const auto stays = surely[group] < Int::splat(0);
      L::select(stays, Float::load(stored + pixel), near[group]).store(stored + pixel);
      L::select(stays, Int::load(id + pixel), f.id).store(id + pixel);
      L::select(stays, Int::load(record + pixel), f.record).store(record + pixel);
    }
    all = surely[0];
    Int open = surely[0] ^ possible[0];
    for (std::uint32_t group = 1; group < kGroups; ++group) {
      all = all & surely[group];
      open = open | (surely[group] ^ possible[group]);
    }
    if (L::sign_bits(all) != L::kAllBits) {
      memory_.span[block] = f.span > memory_.span[block] ? f.span : memory_.span[block];
      hits_.mark(block);
      if (hits_.planes().facing || hits_.planes().distance) {
        std::uint32_t kept = 0;
        for (std::uint32_t group = 0; group < kGroups; ++group) kept |= L::sign_bits(surely[group]) << group * kLanes;
        hits_.take_planes(block, ~kept & kAllPixels, f.lane);
      }
    }
    if (L::sign_bits(open) != 0 && !hits_.trusts_floats()) [[unlikely]] {
      std::uint32_t pixels = 0;
      for (std::uint32_t group = 0; group < kGroups; ++group) {
        pixels |= L::sign_bits(surely[group] ^ possible[group]) << group * kLanes;
      }
      return hits_.decide(block, pixels, f.lane);
    }
    work_.charge_to(kKind);
    return Status::kOk;
  }
  static constexpr std::uint32_t kAllPixels = (1u << kBlockPixels) - 1;

  // What follows where pixels of a block were taken, or left open.
  [[nodiscard]] GRIDIRON_INLINE Status settle_block(const Drawn& f, std::uint32_t block, std::uint32_t taken,
                                                    std::uint32_t open) {
    if (taken != 0) {
      memory_.span[block] = f.span > memory_.span[block] ? f.span : memory_.span[block];
      hits_.mark(block);
      if (hits_.planes().facing || hits_.planes().distance) hits_.take_planes(block, taken, f.lane);
    }
    if (open != 0 && !hits_.trusts_floats()) [[unlikely]]
      return hits_.decide(block, open, f.lane);
    return Status::kOk;
  }
  // draw_block() of one lane: pixel by pixel, and no more of each than decides it.
  template <bool kCovered>
  [[nodiscard]] GRIDIRON_OUTLINE Status draw_pixels(const Drawn& f, std::uint32_t block, const Float (&at)[4]) {
    Float line[4];
    for (int k = kCovered ? 3 : 0; k < 4; ++k) line[k] = at[k];
    const Float zero(0.0f), old_span(memory_.span[block]);
    std::uint32_t open = 0, taken = 0;
    for (std::uint32_t first = 0; first < kBlockPixels; first += kBlockWidth) {
      Float value[4];
      for (int k = kCovered ? 3 : 0; k < 4; ++k) value[k] = line[k];
      for (std::uint32_t column = 0; column < kBlockWidth; ++column) {
        const std::uint32_t pixel = first + column;
        Float inside = f.edge_span + f.edge_span;
        if constexpr (!kCovered) inside = L::min(L::min(value[0], value[1]), value[2]);
        if (kCovered || (inside > zero).is_set) {
          const Float ahead = value[3] - Float::load(memory_.near[block] + pixel);
          if ((ahead + f.near_span > zero).is_set) {
            const bool is_inside = kCovered || (inside - f.edge_span > zero).is_set;
            if (is_inside && (ahead - old_span > zero).is_set) {
              taken |= 1u << pixel;
              value[3].store(memory_.near[block] + pixel);
              f.id.store(memory_.id[block] + pixel);
              f.record.store(memory_.record[block] + pixel);
            } else {
              open |= 1u << pixel;
            }
          }
        }
        for (int k = kCovered ? 3 : 0; k < 4; ++k) value[k] = value[k] + f.x[k];
      }
      for (int k = kCovered ? 3 : 0; k < 4; ++k) line[k] = line[k] + f.y[k];
    }
    if ((open | taken) == 0) return Status::kOk;
    if constexpr (!kCovered) work_.add(TileWork::kTakenBlock);
    return settle_block(f, block, taken, open);
  }

  // Pixels of a box, one by one.
  [[nodiscard]] GRIDIRON_RARE Status draw_carefully(std::uint32_t i) {
    const std::uint32_t box = memory_.boxes[i];
    for (std::uint32_t y = box >> 8 & 0xFFu; y <= box >> 24; ++y) {
      for (std::uint32_t x = box & 0xFFu; x <= (box >> 16 & 0xFFu); ++x) GRIDIRON_TRY(hits_.decide_pixel(x, y, i));
    }
    return Status::kOk;
  }
  // What boxes and leaves take where the usual margins do not hold.
  [[nodiscard]] GRIDIRON_RARE std::uint32_t met_without_trust(const TreeNode& node) {
    if (!eye_->has_bounds) return ~0u;
    return boxes_in_wide_margins(*eye_, tile_, node, hits_.far());
  }
  [[nodiscard]] GRIDIRON_RARE Status visit_with_wider_margins(TreeChild child, float size,
                                                              const VertexTriangle* records) {
    return project_leaf<true>(child, size, records);
  }
  // Without any bound, all pixels of all triangles.
  [[nodiscard]] GRIDIRON_RARE Status decide_all(TreeChild child) {
    const std::uint32_t first = child.first();
    for (std::uint32_t i = 0; i < child.count(); ++i) {
      VertexTriangle triangle;
      GRIDIRON_TRY(source_.record(first + i, triangle));
      memory_.records[0] = first + i;
      memory_.ids[0] = triangle.triangle_id;
      if (hits_.planes().distance) {
        for (std::uint32_t k = 0; k < 9; ++k) {
          memory_.queue[kVertex + k][0] = std::bit_cast<std::uint32_t>(triangle.v[k / 3][k % 3]);
        }
      }
      if (hits_.planes().facing) {
        float normal[3];
        work_.add(Work::kNormalSetup);
        set_up_normal(triangle, normal);
        for (std::uint32_t k = 0; k < 3; ++k) memory_.queue[kNormal + k][0] = std::bit_cast<std::uint32_t>(normal[k]);
      }
      for (std::uint32_t y = 0; y < hits_.rows(); ++y) {
        for (std::uint32_t x = 0; x < hits_.columns(); ++x) GRIDIRON_TRY(hits_.decide_pixel(x, y, 0));
      }
    }
    return Status::kOk;
  }

  Memory& memory_;
  Source& source_;
  WorkCounters& work_;
  TileHits<L, Width, Source, MostLanes> hits_;
  const EyeProjection* eye_ = nullptr;
  TileProjection tile_{};
  float last_x_ = 0.0f, last_y_ = 0.0f;
  std::uint32_t top_ = 0, queued_ = 0;
};

}  // namespace gridiron
