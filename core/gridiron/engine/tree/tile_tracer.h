// Eye rays of a tile through the wide tree: boxes, then triangles, are brought to the tile's pixels. Every pixel's hit
// is that of exact arithmetic: floats decide with bounds of their errors, doubles and integers what these leave open.
// Source: own; Olano, Greer 1997 for edges without clipping; core/TREE.md. Memory: TileMemory. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/engine/tree/tile_memory.h>
#include <gridiron/engine/tree/tile_projection.h>
#include <gridiron/engine/tree/tile_triangles.h>
#include <gridiron/engine/tree/tile_work.h>
#include <gridiron/platform/contract.h>
#include <gridiron/ray/distance.h>
#include <gridiron/ray/hits.h>
#include <gridiron/ray/intersect_rays.h>

#include <bit>
#include <cstdint>

namespace gridiron {

/// Places of pixels in a block, and of blocks in a tile.
template <std::uint32_t Width>
struct TilePlaces {
  static constexpr std::uint32_t kBlocksPerRow = Width / kBlockWidth;
  static constexpr std::uint32_t kBlocks = kBlocksPerRow * kBlocksPerRow;
  static constexpr std::uint32_t kEntries = (kBlocks + 15) / 16 * 16;  ///< for whole groups of lanes
  alignas(64) float column[kBlockPixels];
  alignas(64) float row[kBlockPixels];
  alignas(64) float block_column[kEntries];
  alignas(64) float block_row[kEntries];
};
template <std::uint32_t Width>
inline constexpr TilePlaces<Width> kTilePlaces = [] {
  TilePlaces<Width> places{};
  for (std::uint32_t i = 0; i < kBlockPixels; ++i) {
    places.column[i] = static_cast<float>(i % kBlockWidth);
    places.row[i] = static_cast<float>(i / kBlockWidth);
  }
  for (std::uint32_t i = 0; i < TilePlaces<Width>::kEntries; ++i) {
    places.block_column[i] = static_cast<float>(i % TilePlaces<Width>::kBlocksPerRow * kBlockWidth);
    places.block_row[i] = static_cast<float>(i / TilePlaces<Width>::kBlocksPerRow * kBlockWidth);
  }
  return places;
}();

inline constexpr float kMostStoredNear = 0x1p120f;
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
template <class L, std::uint32_t Width, class Source>
class TileTracer {
 public:
  using Memory = TileMemory<Width>;
  TileTracer(Memory& memory, Source& source, WorkCounters& work) : memory_(memory), source_(source), work_(work) {}

  /// Begins a tile whose first pixel lies in the picture. Borrows frame and eye until finish().
  /// @param wants_facing, wants_distance  the planes of the memory that are to be filled.
  /// @param largest  |coordinate| of the tree's triangles.
  [[nodiscard]] GRIDIRON_OUTLINE Status begin(const FrameHead& frame, const EyeProjection& eye, const TileView& view,
                                              bool wants_facing, bool wants_distance, float largest) {
    work_.add(TileWork::kView);
    work_.charge_to(TileWork::kView);
    frame_ = &frame;
    eye_ = &eye;
    view_ = view;
    wants_facing_ = wants_facing;
    wants_distance_ = wants_distance;
    trusts_floats_ = frame.accuracy == static_cast<std::uint32_t>(Accuracy::kFast);
    project_tile(frame, eye, view, Width, largest, tile_);
    const std::uint32_t columns = frame.width - view.left, rows = frame.height - view.top;
    columns_ = columns < Width ? columns : Width;
    rows_ = rows < Width ? rows : Width;
    last_x_ = static_cast<float>(columns_ - 1);
    last_y_ = static_cast<float>(rows_ - 1);
    if (wants_facing || wants_distance) set_up_directions();
    queued_ = 0;
    dirty_ = 0;
    is_cleared_ = false;
    least_near_ = 0.0f;
    far_ = kFloatMax;
    top_ = 1;
    memory_.stack[0] = TreeChild::node(0).bits;
    memory_.stack_w[0] = 0.0f;
    memory_.stack_size[0] = 0.0f;
    return source_.ahead(TreeChild::node(0));
  }

  [[nodiscard]] bool has_more() const { return top_ != 0; }

  /// Visits the next child, and has those fetched that come next. Precondition: has_more().
  [[nodiscard]] GRIDIRON_OUTLINE Status step() {
    work_.charge_to(TileWork::kChild);
    --top_;
    if (memory_.stack_w[top_] > far_) return Status::kOk;
    const TreeChild child{memory_.stack[top_]};
    if (child.is_leaf()) {
      // One more child comes into the window.
      if (top_ >= source_.window()) GRIDIRON_TRY(ask_for(top_ - source_.window()));
      return visit_leaf(child, memory_.stack_size[top_]);
    }
    const TreeNode* node = nullptr;
    GRIDIRON_TRY(source_.node(child.node_index(), node));
    if (dirty_ != 0) update_least();
    push_children(*node);
    for (std::uint32_t i = 1; i <= source_.window() && i <= top_; ++i) GRIDIRON_TRY(ask_for(top_ - i));
    return Status::kOk;
  }

  /// Draws what still waits. Then the memory has the tile's hits, if has_hits().
  [[nodiscard]] GRIDIRON_OUTLINE Status finish() {
    while (queued_ != 0) GRIDIRON_TRY(draw_group());
    return Status::kOk;
  }

  /// Whether anything may have been hit; if not, the memory's planes are undefined.
  [[nodiscard]] bool has_hits() const { return is_cleared_; }

  /// Writes the hits into the planes of a larger tile.
  /// @param x, y  this tile's first pixel there. @param tile_width  pixels of a row of the planes.
  GRIDIRON_OUTLINE void store_hits(std::uint32_t x, std::uint32_t y, std::uint32_t tile_width, const Hits& hits) {
    work_.add(Work::kIdGroup, Memory::kBlocks * kGroups);
    work_.charge_to(Work::kIdGroup);
    for_each_group(
        [&](std::uint32_t block, std::uint32_t i, std::uint32_t pixel) GRIDIRON_INLINE_LAMBDA {
          const Int id = is_cleared_ ? Int::load(memory_.id[block] + i) : Int::splat(kNoTriangle);
          L::store_quads(id, hits.id + pixel, tile_width);
        },
        x, y, tile_width);
    if (hits.distance != nullptr) {
      work_.add(Work::kDepthGroup, Memory::kBlocks * kGroups);
      work_.charge_to(Work::kDepthGroup);
      for_each_group(
          [&](std::uint32_t block, std::uint32_t i, std::uint32_t pixel) GRIDIRON_INLINE_LAMBDA {
            Float distance(kFloatMax);
            if (is_cleared_) {
              Float dir[3];
              directions(block, i, dir);
              const auto missed = L::equal(kNoTriangle, memory_.id[block] + i);
              distance = L::select(missed, distance, Float::load(memory_.distance[block] + i) * length_of(dir));
            }
            L::store_quads(distance, hits.distance + pixel, tile_width);
          },
          x, y, tile_width);
    }
    if (hits.facing != nullptr) {
      work_.charge_to(Work::kShadedSimpleGroup);
      for_each_group(
          [&](std::uint32_t block, std::uint32_t i, std::uint32_t pixel) GRIDIRON_INLINE_LAMBDA {
            Float facing(0.0f);
            if (is_cleared_) {
              Float dir[3];
              directions(block, i, dir);
              facing = Float::load(memory_.facing[block] + i) / length_of(dir);
            }
            L::store_quads(facing, hits.facing + pixel, tile_width);
          },
          x, y, tile_width);
    }
  }

 private:
  using Float = typename L::Float;
  using Int = typename L::Int;
  static constexpr std::uint32_t kLanes = L::kCount;
  static constexpr std::uint32_t kGroups = kBlockPixels / kLanes;
  static constexpr std::uint32_t kRow = Memory::kBlocksPerRow;
  static constexpr float kBlockStep = kBlockWidth;

  template <class Write>
  GRIDIRON_INLINE void for_each_group(Write&& write, std::uint32_t x, std::uint32_t y, std::uint32_t tile_width) const {
    for (std::uint32_t block = 0; block < Memory::kBlocks; ++block) {
      const std::uint32_t pixel = (y + block / kRow * kBlockWidth) * tile_width + x + block % kRow * kBlockWidth;
      for (std::uint32_t i = 0; i < kBlockPixels; i += kLanes) write(block, i, pixel + i / kBlockWidth * tile_width);
    }
  }
  // Directions of a group of pixels, as FrameHead defines them.
  GRIDIRON_INLINE void directions(std::uint32_t block, std::uint32_t i, Float (&dir)[3]) const {
    const std::uint32_t column = block % kRow * kBlockWidth, row = block / kRow * kBlockWidth + i / kBlockWidth;
    for (int axis = 0; axis < 3; ++axis) {
      dir[axis] =
          L::repeat_quad(memory_.column_direction[axis] + column) + L::splat_quads(memory_.row_direction[axis] + row);
    }
  }
  // The two terms of directions: pixel_direction().
  GRIDIRON_OUTLINE void set_up_directions() {
    const float left = static_cast<float>(view_.left) + view_.dx, top = static_cast<float>(view_.top) + view_.dy;
    for (int axis = 0; axis < 3; ++axis) {
      const float corner = frame_->corner[axis], step_x = frame_->step_x[axis], step_y = frame_->step_y[axis];
      for (std::uint32_t i = 0; i < Width; ++i) {
        const float place = static_cast<float>(i);
        memory_.column_direction[axis][i] = corner + (left + place) * step_x;
        memory_.row_direction[axis][i] = (top + place) * step_y;
      }
    }
  }
  [[nodiscard]] static GRIDIRON_INLINE Float length_of(const Float (&dir)[3]) {
    return L::square_root((dir[0] * dir[0] + dir[1] * dir[1]) + dir[2] * dir[2]);
  }

  [[nodiscard]] GRIDIRON_INLINE Status ask_for(std::uint32_t place) {
    return memory_.stack_w[place] > far_ ? Status::kOk : source_.ahead(TreeChild{memory_.stack[place]});
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
      met |= ((inside >= Float(0.0f)) & (w <= Float(far_))).bits() << base;
    }
    if (!eye_->is_trusted) met = ~0u;
    const std::uint32_t there = (2u << (node.child_count - 1)) - 1;
    const std::uint32_t bottom = top_;
    std::uint32_t top = top_;
    work_.charge_to(TileWork::kChild);
    for (std::uint32_t rest = met & there; rest != 0; rest &= rest - 1) {
      const std::uint32_t i = lowest_bit(rest);
      const float w = least_w[i];
      std::uint32_t place = top;
      for (; place > bottom && memory_.stack_w[place - 1] < w; --place) {
        memory_.stack[place] = memory_.stack[place - 1];
        memory_.stack_w[place] = memory_.stack_w[place - 1];
        memory_.stack_size[place] = memory_.stack_size[place - 1];
      }
      memory_.stack[place] = node.children[i].bits;
      memory_.stack_w[place] = w;
      memory_.stack_size[place] = sizes[i];
      ++top;
    }
    work_.add(TileWork::kChild, top - bottom);
    top_ = top;
  }

  [[nodiscard]] GRIDIRON_INLINE Status visit_leaf(TreeChild child, float size) {
    if (!is_cleared_) clear();
    const VertexTriangle* records = nullptr;
    GRIDIRON_TRY(source_.leaf(child, records));
    const std::uint32_t count = child.count();
    if (!eye_->is_trusted) [[unlikely]]
      return decide_all(child);
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
      const std::uint32_t kept = corners.template cull<Width>(far_, last_x_, last_y_, box) & ((1u << here) - 1);
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
    const auto put = [&](std::uint32_t word, Int value)
                         GRIDIRON_INLINE_LAMBDA { L::compress(value, kept, memory_.queue[word] + queued_); };
    for (std::uint32_t i = 0; i < 3; ++i) {
      put(kCornerX + i, L::words_of(corners.x[i]));
      put(kCornerY + i, L::words_of(corners.y[i]));
      put(kCornerW + i, L::words_of(corners.w[i]));
    }
    put(kCornerError, L::words_of(Float(corners.error)));
    put(kPixelBox, box);
    put(kRecord, Int::splat(first_record) + Int::load(kLaneNumbers.lane));
    put(kTriangleId, L::words_of(corners.id));
    if (wants_facing_) {
      Float normal[3];
      set_up_normals(corners, kept, records, normal);
      for (std::uint32_t i = 0; i < 3; ++i) put(kNormal + i, L::words_of(normal[i]));
    }
    if (wants_distance_) {
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
    TileGroup group = set_up_group<L, Width>(memory_, tile_, 0, (1u << count) - 1, least_near_);
    if (trusts_floats_) trust_floats();
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
    if (queued_ != 0) {
      const std::uint32_t words = wants_distance_ ? kTileWords : wants_facing_ ? kVertex : kNormal;
      for (std::uint32_t word = 0; word < words; ++word) {
        Int::load(memory_.queue[word] + kLanes).store(memory_.queue[word]);
      }
    }
    return Status::kOk;
  }
  static constexpr std::uint32_t kLeastTiny = kLanes < 16 ? 1 : 4;
  // Accuracy::kFast: what may be inside is, and what is in front by floats is.
  GRIDIRON_INLINE void trust_floats() {
    Float(-1.0f).store(memory_.functions[kEdgeSpan]);
    Float(0.0f).store(memory_.functions[kNearSpan]);
  }

  GRIDIRON_INLINE void mark(std::uint32_t block) { dirty_ |= std::uint64_t{1} << (block % 64); }

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
    const Float edge_span = function(kEdgeSpan);
    for (std::uint32_t row = 0; row < 3; ++row) {
      if ((lines[row] & tiny) == 0) break;
      Float value[4] = {left[0], left[1], left[2], left[3]};
      for (std::uint32_t column = 0; column < 3; ++column) {
        const std::uint32_t here = columns[column] & lines[row];
        if (here == 0) break;
        work_.add(TileWork::kTinyPlace);
        work_.charge_to(TileWork::kTinyPlace);
        const Float least = L::min(L::min(value[0], value[1]), value[2]);
        const std::uint32_t met = (least > Float(0.0f)).bits() & here;
        if (met != 0) {
          const std::uint32_t sure = (least > edge_span).bits();
          alignas(64) float near[kLanes];
          value[3].store(near);
          for (std::uint32_t rest = met; rest != 0; rest &= rest - 1) {
            const std::uint32_t i = lowest_bit(rest);
            GRIDIRON_TRY(draw_pixel(i, column, row, near[i], (sure >> i & 1u) != 0));
          }
          work_.charge_to(TileWork::kTinyPlace);
        }
        for (std::uint32_t k = 0; k < 3; ++k) value[k] = value[k] + function(kEdgeX + k);
        value[3] = value[3] + function(kNearX);
      }
      for (std::uint32_t k = 0; k < 3; ++k) left[k] = left[k] + function(kEdgeY + k);
      left[3] = left[3] + function(kNearY);
    }
    return Status::kOk;
  }
  [[nodiscard]] GRIDIRON_INLINE Status draw_pixel(std::uint32_t i, std::uint32_t column, std::uint32_t row, float near,
                                                  bool is_inside) {
    work_.add(TileWork::kTinyPixel);
    work_.charge_to(TileWork::kTinyPixel);
    const std::uint32_t box = memory_.boxes[i];
    const std::uint32_t x = (box & 0xFFu) + column, y = (box >> 8 & 0xFFu) + row;
    const std::uint32_t block = y / kBlockWidth * kRow + x / kBlockWidth;
    const std::uint32_t pixel = y % kBlockWidth * kBlockWidth + x % kBlockWidth;
    const float old = memory_.near[block][pixel], span = memory_.functions[kNearSpan][i];
    if (near + span < old) return Status::kOk;
    if (!is_inside || !(near > old + memory_.span[block])) [[unlikely]]
      return trusts_floats_ ? Status::kOk : decide(block, 1u << pixel, i);
    memory_.near[block][pixel] = near;
    memory_.id[block][pixel] = memory_.ids[i];
    memory_.record[block][pixel] = memory_.records[i];
    memory_.span[block] = span > memory_.span[block] ? span : memory_.span[block];
    mark(block);
    if (wants_facing_) take_facing(block, pixel, i);
    if (wants_distance_) take_distances(block, 1u << pixel, i);
    return Status::kOk;
  }
  // The facing of one pixel: take_planes() for a group, lane by lane.
  GRIDIRON_INLINE void take_facing(std::uint32_t block, std::uint32_t pixel, std::uint32_t lane) {
    const std::uint32_t column = block % kRow * kBlockWidth + pixel % kBlockWidth;
    const std::uint32_t row = block / kRow * kBlockWidth + pixel / kBlockWidth;
    const auto share = [&](std::uint32_t axis) GRIDIRON_INLINE_LAMBDA {
      const float dir = memory_.column_direction[axis][column] + memory_.row_direction[axis][row];
      return std::bit_cast<float>(memory_.queue[kNormal + axis][lane]) * dir;
    };
    const float x = share(0), y = share(1), z = share(2);
    memory_.facing[block][pixel] = magnitude(x + y + z);
  }

  // A triangle that is drawn block by block: its functions in all lanes.
  struct Drawn {
    Float value[4], x[4], y[4], edge_span, near_span;
    Float start[4], step[4];  ///< at the pixels of a block's first group; from one group to the next
    float span;
    Int id, record;
    std::uint32_t lane;

    GRIDIRON_INLINE Drawn(const Memory& memory, std::uint32_t i)
        : edge_span(memory.functions[kEdgeSpan][i]),
          near_span(memory.functions[kNearSpan][i]),
          span(memory.functions[kNearSpan][i]),
          id(Int::splat(memory.ids[i])),
          record(Int::splat(memory.records[i])),
          lane(i) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        value[k] = Float(memory.functions[kEdgeValue + k][i]);
        x[k] = Float(memory.functions[kEdgeX + k][i]);
        y[k] = Float(memory.functions[kEdgeY + k][i]);
      }
      value[3] = Float(memory.functions[kNearValue][i]);
      x[3] = Float(memory.functions[kNearX][i]);
      y[3] = Float(memory.functions[kNearY][i]);
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
    const Float offset_x(memory_.functions[kOffsetX][i]), offset_y(memory_.functions[kOffsetY][i]);
    if ((bx1 - bx0 + 1) * (by1 - by0 + 1) > kFewBlocks) {
      return draw_many_blocks(drawn, bx0, by0, bx1, by1, offset_x, offset_y);
    }
    const std::uint32_t first = by0 * kRow + bx0;
    const Float x = Float(kTilePlaces<Width>.block_column[first]) - offset_x;
    const Float y = Float(kTilePlaces<Width>.block_row[first]) - offset_y;
    // From block to block.
    Float row[4], right[4], down[4];
    for (int k = 0; k < 4; ++k) {
      row[k] = drawn.at(k, x, y);
      right[k] = drawn.x[k] * Float(kBlockStep);
      down[k] = drawn.y[k] * Float(kBlockStep);
    }
    for (std::uint32_t by = by0; by <= by1; ++by) {
      Float value[4] = {row[0], row[1], row[2], row[3]};
      for (std::uint32_t bx = bx0; bx <= bx1; ++bx) {
        GRIDIRON_TRY(draw_block<false>(drawn, by * kRow + bx, value));
        for (int k = 0; k < 4; ++k) value[k] = value[k] + right[k];
      }
      for (int k = 0; k < 4; ++k) row[k] = row[k] + down[k];
    }
    return Status::kOk;
  }
  static constexpr std::uint32_t kFewBlocks = kLanes == 16 ? 6 : 4;

  // Blocks are looked at in lanes: which the triangle may touch in front of what is there, which it covers.
  [[nodiscard]] GRIDIRON_OUTLINE Status draw_many_blocks(const Drawn& f, std::uint32_t bx0, std::uint32_t by0,
                                                         std::uint32_t bx1, std::uint32_t by1, Float offset_x,
                                                         Float offset_y) {
    static constexpr float kLast = kBlockWidth - 1.0f;
    const auto& places = kTilePlaces<Width>;
    Float most[4], least[3];
    for (int k = 0; k < 4; ++k) {
      const Float zero(0.0f), last(kLast);
      most[k] = (L::max(f.x[k], zero) + L::max(f.y[k], zero)) * last + f.value[k];
      if (k < 3) least[k] = (L::min(f.x[k], zero) + L::min(f.y[k], zero)) * last + f.value[k];
    }
    most[3] = most[3] + f.near_span;
    const float left = places.block_column[bx0] - 1.0f, right = places.block_column[bx1] + 1.0f;
    const float top = places.block_row[by0 * kRow] - 1.0f, bottom = places.block_row[by1 * kRow] + 1.0f;
    const std::uint32_t begin = (by0 * kRow + (kLanes <= kRow ? bx0 : std::uint32_t{0})) & ~(kLanes - 1);
    for (std::uint32_t base = begin; base <= by1 * kRow + bx1; base += kLanes) {
      if constexpr (kLanes < kRow) {
        const std::uint32_t column = base % kRow;
        if (column > bx1 || column + (kLanes - 1) < bx0) continue;
      }
      work_.add(TileWork::kBlockGroup);
      work_.charge_to(TileWork::kBlockGroup);
      const Float column = Float::load(places.block_column + base), line = Float::load(places.block_row + base);
      const Float x = column - offset_x, y = line - offset_y;
      auto met = (column > Float(left)) & (column < Float(right)) & (line > Float(top)) & (line < Float(bottom));
      auto covered = met;
      for (int k = 0; k < 3; ++k) {
        const Float along = L::bounded_sum(f.x[k], x, f.y[k] * y);
        met = met & (along + most[k] > Float(0.0f));
        covered = covered & (along + least[k] > f.edge_span);
      }
      met = met &
            (L::bounded_sum(f.x[3], x, L::bounded_sum(f.y[3], y, most[3])) > Float::load(memory_.least_near + base));
      const std::uint32_t all = met.bits();
      if (all == 0) continue;
      const std::uint32_t full = covered.bits() & all;
      for (std::uint32_t rest = all & ~full; rest != 0; rest &= rest - 1) {
        const std::uint32_t block = base + lowest_bit(rest);
        GRIDIRON_TRY(draw_block_at<false>(f, block, Float(places.block_column[block]) - offset_x,
                                          Float(places.block_row[block]) - offset_y));
      }
      for (std::uint32_t rest = full; rest != 0; rest &= rest - 1) {
        const std::uint32_t block = base + lowest_bit(rest);
        GRIDIRON_TRY(draw_block_at<true>(f, block, Float(places.block_column[block]) - offset_x,
                                         Float(places.block_row[block]) - offset_y));
      }
    }
    return Status::kOk;
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
    Float value[4];
    for (int k = kCovered ? 3 : 0; k < 4; ++k) value[k] = at[k];
    // What decides a pixel: the least edge function, and how far the triangle is in front; both with the error that may
    // be.
    Float inside[kGroups], ahead[kGroups], near[kGroups];
    typename L::Mask met[kGroups];
    Float any(-1.0f);
    for (std::uint32_t group = 0; group < kGroups; ++group) {
      near[group] = value[3];
      ahead[group] = value[3] - Float::load(memory_.near[block] + group * kLanes);
      Float possible = ahead[group] + f.near_span;
      if constexpr (!kCovered) {
        inside[group] = L::min(L::min(value[0], value[1]), value[2]);
        possible = L::min(possible, inside[group]);
      }
      any = group == 0 ? possible : L::max(any, possible);
      met[group] = possible > Float(0.0f);
      if (group + 1 < kGroups) {
        for (int k = kCovered ? 3 : 0; k < 4; ++k) value[k] = value[k] + f.step[k];
      }
    }
    if ((any > Float(0.0f)).bits() == 0) return Status::kOk;
    const Float old_span(memory_.span[block]);
    std::uint32_t open = 0, taken = 0;
    for (std::uint32_t group = 0; group < kGroups; ++group) {
      const std::uint32_t pixel = group * kLanes;
      Float surely = ahead[group] - old_span;
      if constexpr (!kCovered) surely = L::min(surely, inside[group] - f.edge_span);
      const auto sure = (surely > Float(0.0f)) & met[group];
      const std::uint32_t sure_bits = sure.bits();
      open |= (met[group].bits() ^ sure_bits) << pixel;
      taken |= sure_bits << pixel;
      float* const target = memory_.near[block] + pixel;
      L::select(sure, near[group], Float::load(target)).store(target);
      std::uint32_t* const id = memory_.id[block] + pixel;
      std::uint32_t* const record = memory_.record[block] + pixel;
      L::select(sure, f.id, Int::load(id)).store(id);
      L::select(sure, f.record, Int::load(record)).store(record);
    }
    if (taken != 0) {
      memory_.span[block] = f.span > memory_.span[block] ? f.span : memory_.span[block];
      mark(block);
      if (wants_facing_ || wants_distance_) take_planes(block, taken, f.lane);
    }
    if (open != 0 && !trusts_floats_) [[unlikely]]
      return decide(block, open, f.lane);
    return Status::kOk;
  }

  // Fills the planes that shading and depth ask for, where the triangle of a lane was taken.
  GRIDIRON_OUTLINE void take_planes(std::uint32_t block, std::uint32_t taken, std::uint32_t lane) {
    work_.add(TileWork::kFacingBlock);
    work_.charge_to(TileWork::kFacingBlock);
    if (wants_facing_) {
      const auto normal = [&](std::uint32_t axis) GRIDIRON_INLINE_LAMBDA {
        return Float(std::bit_cast<float>(memory_.queue[kNormal + axis][lane]));
      };
      const Float normal_x = normal(0), normal_y = normal(1), normal_z = normal(2);
      for (std::uint32_t i = 0; i < kBlockPixels; i += kLanes) {
        Float dir[3];
        directions(block, i, dir);
        const Float facing = L::abs(normal_x * dir[0] + normal_y * dir[1] + normal_z * dir[2]);
        float* const target = memory_.facing[block] + i;
        L::select(L::mask_from_bits(taken >> i & L::kAllBits), facing, Float::load(target)).store(target);
      }
    }
    if (wants_distance_) take_distances(block, taken, lane);
  }
  GRIDIRON_OUTLINE void take_distances(std::uint32_t block, std::uint32_t taken, std::uint32_t lane) {
    VertexTriangle triangle;
    queued_triangle(lane, triangle);
    struct BlockRays : PacketDirections<kBlockPixels> {
      float origin[3];
    } rays;
    for (int axis = 0; axis < 3; ++axis) rays.origin[axis] = frame_->eye[axis];
    work_.add(Work::kHitSetup);
    DistanceSetup setup;
    set_up_distance(rays.origin, eye_->dir_max, triangle, setup);
    for (std::uint32_t i = 0; i < kBlockPixels; i += kLanes) {
      const std::uint32_t here = taken >> i & L::kAllBits;
      if (here == 0) continue;
      Float dir[3];
      directions(block, i, dir);
      for (int axis = 0; axis < 3; ++axis) dir[axis].store(rays.dir[axis] + i);
      alignas(64) float found[kLanes];
      distances_of<L>(rays, i, here, triangle, setup, found, work_);
      float* const target = memory_.distance[block] + i;
      L::select(L::mask_from_bits(here), Float::load(found), Float::load(target)).store(target);
    }
  }
  GRIDIRON_INLINE void queued_triangle(std::uint32_t lane, VertexTriangle& triangle) const {
    for (std::uint32_t i = 0; i < 9; ++i) {
      triangle.v[i / 3][i % 3] = std::bit_cast<float>(memory_.queue[kVertex + i][lane]);
    }
    triangle.triangle_id = memory_.ids[lane];
  }

  // The least of blocks that changed, and of the tile once every block has a hit everywhere.
  GRIDIRON_INLINE void update_least() {
    work_.charge_to(TileWork::kChangedBlock);
    for (std::uint64_t rest = dirty_; rest != 0; rest &= rest - 1) {
      for (std::uint32_t block = lowest_bit(rest); block < Memory::kBlocks; block += 64) {
        work_.add(TileWork::kChangedBlock);
        Float least = Float::load(memory_.near[block]);
        for (std::uint32_t i = kLanes; i < kBlockPixels; i += kLanes) {
          least = L::min(least, Float::load(memory_.near[block] + i));
        }
        const float found = L::horizontal_min(least);
        if (memory_.least_near[block] <= floor_ && found > floor_) --empty_blocks_;
        memory_.least_near[block] = found;
      }
    }
    dirty_ = 0;
    if (empty_blocks_ != 0) return;
    Float least = Float::load(memory_.least_near);
    for (std::uint32_t i = kLanes; i < Memory::kBlocks; i += kLanes) {
      least = L::min(least, Float::load(memory_.least_near + i));
    }
    least_near_ = L::horizontal_min(least);
    far_ = least_near_ > 0x1p-100f ? (1.0f / least_near_) * (1.0f + 0x1p-9f) : kFloatMax;
  }

  GRIDIRON_OUTLINE void clear() {
    work_.add(TileWork::kClearedBlock, Memory::kBlocks);
    work_.charge_to(TileWork::kClearedBlock);
    is_cleared_ = true;
    // What lies farther than t_far is no hit. Near it, exact distances decide.
    floor_ = frame_->t_far < 0x1p60f ? (1.0f / frame_->t_far) * (1.0f - 0x1p-18f) : 0.0f;
    const Float none(floor_), span(floor_ * 0x1p-16f), zero(0.0f);
    const Int no_id = Int::splat(kNoTriangle);
    for (std::uint32_t block = 0; block < Memory::kBlocks; ++block) {
      for (std::uint32_t i = 0; i < kBlockPixels; i += kLanes) {
        none.store(memory_.near[block] + i);
        no_id.store(memory_.id[block] + i);
        if (wants_facing_) zero.store(memory_.facing[block] + i);
      }
    }
    for (std::uint32_t i = 0; i < Memory::kBlocks; i += kLanes) {
      none.store(memory_.least_near + i);
      span.store(memory_.span + i);
    }
    empty_blocks_ = Memory::kBlocks;
    if (columns_ != Width || rows_ != Width) clear_outside();
  }
  // Nothing lies in front of what is outside the picture, so that it hides the blocks and the tile like a hit.
  GRIDIRON_RARE void clear_outside() {
    for (std::uint32_t i = 0; i < Width * Width; ++i) {
      const std::uint32_t x = i % Width, y = i / Width;
      if (x < columns_ && y < rows_) continue;
      const std::uint32_t block = y / kBlockWidth * kRow + x / kBlockWidth;
      memory_.near[block][y % kBlockWidth * kBlockWidth + x % kBlockWidth] = kMostStoredNear;
    }
    dirty_ = ~std::uint64_t{0};
    update_least();
  }

  // Pixels of a box, one by one.
  [[nodiscard]] GRIDIRON_RARE Status draw_carefully(std::uint32_t i) {
    const std::uint32_t box = memory_.boxes[i];
    for (std::uint32_t y = box >> 8 & 0xFFu; y <= box >> 24; ++y) {
      for (std::uint32_t x = box & 0xFFu; x <= (box >> 16 & 0xFFu); ++x) GRIDIRON_TRY(decide_pixel(x, y, i));
    }
    return Status::kOk;
  }
  // Without any bound, all pixels of all triangles.
  [[nodiscard]] GRIDIRON_RARE Status decide_all(TreeChild child) {
    const std::uint32_t first = child.first();
    for (std::uint32_t i = 0; i < child.count(); ++i) {
      VertexTriangle triangle;
      GRIDIRON_TRY(source_.record(first + i, triangle));
      memory_.records[0] = first + i;
      memory_.ids[0] = triangle.triangle_id;
      if (wants_distance_) {
        for (std::uint32_t k = 0; k < 9; ++k) {
          memory_.queue[kVertex + k][0] = std::bit_cast<std::uint32_t>(triangle.v[k / 3][k % 3]);
        }
      }
      if (wants_facing_) {
        float normal[3];
        work_.add(Work::kNormalSetup);
        set_up_normal(triangle, normal);
        for (std::uint32_t k = 0; k < 3; ++k) memory_.queue[kNormal + k][0] = std::bit_cast<std::uint32_t>(normal[k]);
      }
      for (std::uint32_t y = 0; y < rows_; ++y) {
        for (std::uint32_t x = 0; x < columns_; ++x) GRIDIRON_TRY(decide_pixel(x, y, 0));
      }
    }
    return Status::kOk;
  }
  [[nodiscard]] GRIDIRON_RARE Status decide_pixel(std::uint32_t x, std::uint32_t y, std::uint32_t lane) {
    const std::uint32_t block = y / kBlockWidth * kRow + x / kBlockWidth;
    return decide(block, 1u << (y % kBlockWidth * kBlockWidth + x % kBlockWidth), lane);
  }

  // Decides pixels of a block exactly: whether the triangle of a lane is hit, and whether before what was hit so far.
  [[nodiscard]] GRIDIRON_RARE Status decide(std::uint32_t block, std::uint32_t pixels, std::uint32_t lane) {
    work_.charge_to(TileWork::kOpenPixel);
    const std::uint32_t record = memory_.records[lane];
    VertexTriangle triangle;
    GRIDIRON_TRY(source_.record(record, triangle));
    BatchRay ray{};
    for (int axis = 0; axis < 3; ++axis) ray.origin[axis] = frame_->eye[axis];
    for (; pixels != 0; pixels &= pixels - 1) {
      const std::uint32_t pixel = lowest_bit(pixels);
      const std::uint32_t column = block % kRow * kBlockWidth + pixel % kBlockWidth;
      const std::uint32_t row = block / kRow * kBlockWidth + pixel / kBlockWidth;
      if (column >= columns_ || row >= rows_) continue;
      work_.add(TileWork::kOpenPixel);
      const float x = (static_cast<float>(view_.left) + view_.dx) + static_cast<float>(column);
      const float y = (static_cast<float>(view_.top) + view_.dy) + static_cast<float>(row);
      ray.dir_max = 0.0f;
      for (int axis = 0; axis < 3; ++axis) {
        ray.dir[axis] = pixel_direction(*frame_, axis, x, y);
        ray.dir_max = magnitude(ray.dir[axis]) > ray.dir_max ? magnitude(ray.dir[axis]) : ray.dir_max;
      }
      if (!passes_through(ray, triangle, work_)) continue;
      const float t = ray_distance(ray, triangle, work_);
      if (!(t > 0.0f) || !(t <= frame_->t_far)) continue;
      const std::uint32_t old_id = memory_.id[block][pixel];
      if (old_id != kNoTriangle) {
        VertexTriangle old;
        GRIDIRON_TRY(source_.record(memory_.record[block][pixel], old));
        const float old_t = ray_distance(ray, old, work_);
        const bool has_lower_id = triangle.triangle_id < old_id;
        if (old_t < t) continue;
        if (old_t == t) {
          const bool breaks_ties = frame_->accuracy == static_cast<std::uint32_t>(Accuracy::kExact);
          const bool is_first =
              breaks_ties ? comes_first_exactly(ray.origin, ray.dir, triangle, old, has_lower_id, work_) : has_lower_id;
          if (!is_first) continue;
        }
      }
      const float near = (1.0f / t) * (1.0f - 0x1p-19f);
      const float stored = near < kMostStoredNear ? near : kMostStoredNear, span = stored * 0x1p-17f;
      memory_.near[block][pixel] = stored;
      memory_.id[block][pixel] = triangle.triangle_id;
      memory_.record[block][pixel] = record;
      memory_.span[block] = span > memory_.span[block] ? span : memory_.span[block];
      if (eye_->is_trusted) mark(block);
      if (wants_facing_ || wants_distance_) take_planes(block, 1u << pixel, lane);
    }
    return Status::kOk;
  }

  Memory& memory_;
  Source& source_;
  WorkCounters& work_;
  const FrameHead* frame_ = nullptr;
  const EyeProjection* eye_ = nullptr;
  TileView view_{};
  TileProjection tile_{};
  std::uint32_t columns_ = 0, rows_ = 0;
  float last_x_ = 0.0f, last_y_ = 0.0f;
  std::uint32_t top_ = 0, queued_ = 0, empty_blocks_ = 0;
  std::uint64_t dirty_ = 0;
  float least_near_ = 0.0f, far_ = 0.0f, floor_ = 0.0f;
  bool is_cleared_ = false, wants_facing_ = false, wants_distance_ = false, trusts_floats_ = false;
};

}  // namespace gridiron
