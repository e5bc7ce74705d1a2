// The nearest hits of a tile of eye rays so far, block by block, and exact decisions about them.
// Source: own; core/TREE.md. Memory: TileMemory. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/engine/tree/tile_memory.h>
#include <gridiron/engine/tree/tile_projection.h>
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

/// No hit is nearer than 1 / this, as far as the memory tells.
inline constexpr float kMostStoredNear = 0x1p120f;

/// Planes that a tile is asked for beside its triangles.
struct TilePlanes {
  bool facing, distance;
};

/// Whether two triangles lie in one plane across an axis: their corners agree in that coordinate.
[[nodiscard]] GRIDIRON_RARE inline bool share_axis_plane(const VertexTriangle& a, const VertexTriangle& b) {
  for (int axis = 0; axis < 3; ++axis) {
    const float place = a.v[0][axis];
    if (b.v[0][axis] == place && a.v[1][axis] == place && a.v[2][axis] == place && b.v[1][axis] == place &&
        b.v[2][axis] == place) {
      return true;
    }
  }
  return false;
}

/// @tparam Source, MostLanes  as of TileTracer.
template <class L, std::uint32_t Width, class Source, std::uint32_t MostLanes = 16>
class TileHits {
 public:
  using Memory = TileMemory<Width, MostLanes>;
  TileHits(Memory& memory, Source& source, WorkCounters& work) : memory_(memory), source_(source), work_(work) {}

  /// Begins a tile whose first pixel lies in the picture. Borrows frame and eye.
  GRIDIRON_INLINE void begin(const FrameHead& frame, const EyeProjection& eye, const TileView& view,
                             TilePlanes planes) {
    frame_ = &frame;
    eye_ = &eye;
    view_ = view;
    planes_ = planes;
    const std::uint32_t columns = frame.width - view.left, rows = frame.height - view.top;
    columns_ = columns < Width ? columns : Width;
    rows_ = rows < Width ? rows : Width;
    if (planes.facing || planes.distance) set_up_directions();
    dirty_ = 0;
    is_cleared_ = false;
    least_near_ = 0.0f;
    far_ = kFloatMax;
  }

  /// Pixels of the tile that lie in the picture.
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t columns() const { return columns_; }
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t rows() const { return rows_; }
  [[nodiscard]] GRIDIRON_INLINE TilePlanes planes() const { return planes_; }
  /// Whether the memory has hits, or none everywhere; if not, it is undefined, and nothing is hit.
  [[nodiscard]] GRIDIRON_INLINE bool is_cleared() const { return is_cleared_; }
  /// w beyond which everything is hidden, and 1 / t below which it is.
  [[nodiscard]] GRIDIRON_INLINE float far() const { return far_; }
  [[nodiscard]] GRIDIRON_INLINE float least_near() const { return least_near_; }
  /// Accuracy::kFast: what floats leave open stays as it is.
  [[nodiscard]] GRIDIRON_INLINE bool trusts_floats() const {
    return frame_->accuracy == static_cast<std::uint32_t>(Accuracy::kFast);
  }

  /// Clears the memory.
  GRIDIRON_OUTLINE void clear() {
    work_.add(TileWork::kClearedBlock, Memory::kBlocks);
    work_.charge_to(TileWork::kClearedBlock);
    is_cleared_ = true;
    // What lies farther than t_far is no hit. Near it, exact distances decide.
    const float farthest = frame_->t_far * eye_->unit;
    floor_ = farthest < 0x1p60f ? (1.0f / farthest) * (1.0f - 0x1p-18f) : 0.0f;
    const Float none(floor_), span(floor_ * 0x1p-16f), zero(0.0f);
    const Int no_id = Int::splat(kNoTriangle);
    for (std::uint32_t block = 0; block < Memory::kBlocks; ++block) {
      for (std::uint32_t i = 0; i < kBlockPixels; i += kLanes) {
        none.store(memory_.near[block] + i);
        no_id.store(memory_.id[block] + i);
      }
    }
    if (planes_.facing) {
      for (std::uint32_t block = 0; block < Memory::kBlocks; ++block) {
        for (std::uint32_t i = 0; i < kBlockPixels; i += kLanes) zero.store(memory_.facing[block] + i);
      }
    }
    for (std::uint32_t i = 0; i < Memory::kBlocks; i += kLanes) {
      none.store(memory_.least_near + i);
      span.store(memory_.span + i);
    }
    empty_blocks_ = Memory::kBlocks;
    if (columns_ != Width || rows_ != Width) clear_outside();
  }

  /// A block's hits have changed.
  GRIDIRON_INLINE void mark(std::uint32_t block) { dirty_ |= std::uint64_t{1} << (block % 64); }
  /// Seeks the least of blocks that changed, and of the tile once every block has a hit everywhere.
  GRIDIRON_INLINE void update() {
    if (dirty_ != 0) update_least();
  }

  /// Fills the planes that are asked for, where the triangle of a lane was taken. @param taken  pixels of the block.
  GRIDIRON_OUTLINE void take_planes(std::uint32_t block, std::uint32_t taken, std::uint32_t lane) {
    work_.add(TileWork::kFacingBlock);
    work_.charge_to(TileWork::kFacingBlock);
    if (planes_.facing) {
      const auto normal = [&](std::uint32_t axis) GRIDIRON_INLINE_LAMBDA {
        return Float(std::bit_cast<float>(memory_.queue[kNormal + axis][lane]));
      };
      const Float normal_x = normal(0), normal_y = normal(1), normal_z = normal(2);
      for (std::uint32_t i = 0; i < kBlockPixels; i += kLanes) {
        if constexpr (kLanes == 1) {
          if ((taken >> i & 1u) == 0) continue;
        }
        Float dir[3];
        directions(block, i, dir);
        const Float facing = L::abs(normal_x * dir[0] + normal_y * dir[1] + normal_z * dir[2]);
        float* const target = memory_.facing[block] + i;
        L::select(L::mask_from_bits(taken >> i & L::kAllBits), facing, Float::load(target)).store(target);
      }
    }
    if (planes_.distance) take_distances(block, taken, lane);
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

  /// The same for one pixel.
  GRIDIRON_INLINE void take_pixel(std::uint32_t block, std::uint32_t pixel, std::uint32_t lane) {
    if (planes_.facing) take_facing(block, pixel, lane);
    if (planes_.distance) take_distances(block, 1u << pixel, lane);
  }

  /// Decides a pixel of the tile, see decide().
  [[nodiscard]] GRIDIRON_RARE Status decide_pixel(std::uint32_t x, std::uint32_t y, std::uint32_t lane) {
    const std::uint32_t block = y / kBlockWidth * kRow + x / kBlockWidth;
    return decide(block, 1u << (y % kBlockWidth * kBlockWidth + x % kBlockWidth), lane, false);
  }

  /// Decides pixels of a block exactly: whether the triangle of a lane is hit, and whether before what was hit so far.
  /// @param has_function  whether the lane has functions of the pixel; 1 / t then decides the second, if it can.
  [[nodiscard]] GRIDIRON_RARE Status decide(std::uint32_t block, std::uint32_t pixels, std::uint32_t lane,
                                            bool has_function = true) {
    work_.charge_to(TileWork::kOpenPixel);
    const std::uint32_t record = memory_.records[lane];
    VertexTriangle triangle, old;
    GRIDIRON_TRY(source_.record(record, triangle));
    std::uint32_t old_record = record;
    old = triangle;
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
      if (has_function) {
        const float near = near_of(lane, column, row);
        if (near > memory_.near[block][pixel] + memory_.span[block]) {
          take(block, pixel, lane, near, memory_.functions[kNearSpan][lane]);
          continue;
        }
      }
      const std::uint32_t old_id = memory_.id[block][pixel];
      const bool has_lower_id = triangle.triangle_id < old_id;
      bool is_tie = false;
      if (old_id != kNoTriangle) {
        if (memory_.record[block][pixel] != old_record) {
          old_record = memory_.record[block][pixel];
          GRIDIRON_TRY(source_.record(old_record, old));
        }
        // Walls on walls are equally far.
        is_tie = share_axis_plane(triangle, old);
        if (is_tie && !has_lower_id) continue;
      }
      if (!is_tie) {
        const float t = ray_distance(ray, triangle, work_);
        if (!(t > 0.0f) || !(t <= frame_->t_far)) continue;
        if (old_id != kNoTriangle) {
          const float old_t = ray_distance(ray, old, work_);
          if (old_t < t) continue;
          if (old_t == t) {
            const bool breaks_ties = frame_->accuracy == static_cast<std::uint32_t>(Accuracy::kExact);
            const bool is_first = breaks_ties
                                      ? comes_first_exactly(ray.origin, ray.dir, triangle, old, has_lower_id, work_)
                                      : has_lower_id;
            if (!is_first) continue;
          }
        }
        const float exact = (1.0f / (t * eye_->unit)) * (1.0f - 0x1p-19f);
        const float stored = exact < kMostStoredNear ? exact : kMostStoredNear;
        take(block, pixel, lane, stored, stored * 0x1p-17f);
      } else {
        take(block, pixel, lane, memory_.near[block][pixel], memory_.span[block]);
      }
    }
    return Status::kOk;
  }

  /// Writes the hits into the planes of a larger tile.
  /// @param x, y  this tile's first pixel there. @param tile_width  pixels of a row of the planes.
  GRIDIRON_OUTLINE void store(std::uint32_t x, std::uint32_t y, std::uint32_t tile_width, const Hits& hits) {
    work_.add(Work::kIdGroup, Memory::kBlocks * kGroups);
    work_.charge_to(Work::kIdGroup);
    if (!is_cleared_) return store_misses(x, y, tile_width, hits);
    for_each_group(
        [&](std::uint32_t block, std::uint32_t i, std::uint32_t pixel)
            GRIDIRON_INLINE_LAMBDA { L::store_quads(Int::load(memory_.id[block] + i), hits.id + pixel, tile_width); },
        x, y, tile_width);
    if (hits.distance != nullptr) {
      work_.add(Work::kDepthGroup, Memory::kBlocks * kGroups);
      work_.charge_to(Work::kDepthGroup);
      for_each_group(
          [&](std::uint32_t block, std::uint32_t i, std::uint32_t pixel) GRIDIRON_INLINE_LAMBDA {
            Float dir[3];
            directions(block, i, dir);
            const auto missed = L::equal(kNoTriangle, memory_.id[block] + i);
            const Float distance = Float::load(memory_.distance[block] + i) * length_of(dir);
            L::store_quads(L::select(missed, Float(kFloatMax), distance), hits.distance + pixel, tile_width);
          },
          x, y, tile_width);
    }
    if (hits.facing != nullptr) {
      work_.charge_to(Work::kShadedSimpleGroup);
      for_each_group(
          [&](std::uint32_t block, std::uint32_t i, std::uint32_t pixel) GRIDIRON_INLINE_LAMBDA {
            Float dir[3];
            directions(block, i, dir);
            L::store_quads(Float::load(memory_.facing[block] + i) / length_of(dir), hits.facing + pixel, tile_width);
          },
          x, y, tile_width);
    }
  }

 private:
  // 1 / t of a lane's triangle at a pixel, or a little less: as for blocks and tiny triangles, with no more roundings.
  [[nodiscard]] GRIDIRON_INLINE float near_of(std::uint32_t lane, std::uint32_t column, std::uint32_t row) const {
    const auto& functions = memory_.functions;
    const float x = static_cast<float>(column) - functions[kOffsetX][lane];
    const float y = static_cast<float>(row) - functions[kOffsetY][lane];
    return functions[kNearX][lane] * x + (functions[kNearY][lane] * y + functions[kNearValue][lane]);
  }
  GRIDIRON_OUTLINE void take(std::uint32_t block, std::uint32_t pixel, std::uint32_t lane, float near, float span) {
    memory_.near[block][pixel] = near;
    memory_.span[block] = span > memory_.span[block] ? span : memory_.span[block];
    memory_.id[block][pixel] = memory_.ids[lane];
    memory_.record[block][pixel] = memory_.records[lane];
    if (eye_->template is_bounded<Width>()) mark(block);
    if (planes_.facing || planes_.distance) take_planes(block, 1u << pixel, lane);
  }

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
      for (std::uint32_t i = 0; i < kBlockPixels; i += kLanes) {
        write(block, i, pixel + i / kBlockWidth * tile_width + column_of(i));
      }
    }
  }
  GRIDIRON_INLINE void store_misses(std::uint32_t x, std::uint32_t y, std::uint32_t tile_width,
                                    const Hits& hits) const {
    for_each_group(
        [&](std::uint32_t, std::uint32_t, std::uint32_t pixel) GRIDIRON_INLINE_LAMBDA {
          L::store_quads(Int::splat(kNoTriangle), hits.id + pixel, tile_width);
          if (hits.distance != nullptr) L::store_quads(Float(kFloatMax), hits.distance + pixel, tile_width);
          if (hits.facing != nullptr) L::store_quads(Float(0.0f), hits.facing + pixel, tile_width);
        },
        x, y, tile_width);
  }
  // Of a group's first pixel in its block: groups are whole rows, or single pixels.
  [[nodiscard]] static GRIDIRON_INLINE std::uint32_t column_of([[maybe_unused]] std::uint32_t i) {
    return kLanes < kBlockWidth ? i % kBlockWidth : std::uint32_t{0};
  }
  // Directions of a group of pixels, as FrameHead defines them.
  GRIDIRON_INLINE void directions(std::uint32_t block, std::uint32_t i, Float (&dir)[3]) const {
    const std::uint32_t column = block % kRow * kBlockWidth + column_of(i),
                        row = block / kRow * kBlockWidth + i / kBlockWidth;
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

  Memory& memory_;
  Source& source_;
  WorkCounters& work_;
  const FrameHead* frame_ = nullptr;
  const EyeProjection* eye_ = nullptr;
  TileView view_{};
  TilePlanes planes_{};
  std::uint32_t columns_ = 0, rows_ = 0, empty_blocks_ = 0;
  std::uint64_t dirty_ = 0;
  float least_near_ = 0.0f, far_ = 0.0f, floor_ = 0.0f;
  bool is_cleared_ = false;
};

}  // namespace gridiron
