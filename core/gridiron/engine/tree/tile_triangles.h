// Triangles on their way to the pixels of a tile: corners in the tile's coordinates, the pixels that they may cover,
// edges and 1 / t as functions of the pixel; all in lanes, one triangle a lane, each with a bound of its error.
// Source: Olano, Greer 1997 (edges without clipping); bounds own, core/TREE.md. Memory: values. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/engine/tree/tile_memory.h>
#include <gridiron/engine/tree/tile_projection.h>
#include <gridiron/ray/pixel_box.h>

#include <bit>
#include <cstdint>

namespace gridiron {

/// A leaf's first corner in the coordinates of a tile.
struct LeafBase {
  float place[3];  ///< world space
  float base[3];   ///< column w, row w, w
  float error;     ///< of a coordinate of any of the leaf's corners, w's counted 2 width times

  /// @param width  of the tile, in pixels. @param size  no corner is farther from another, along any axis.
  GRIDIRON_INLINE LeafBase(const EyeProjection& eye, const TileProjection& tile, std::uint32_t width,
                           const VertexTriangle& first, float size) {
    double way[3];
    for (int axis = 0; axis < 3; ++axis) {
      place[axis] = first.v[0][axis];
      way[axis] = double{place[axis]} - eye.eye[axis];
    }
    for (int row = 0; row < 3; ++row) {
      const double* const r = tile.exact_rows[row];
      base[row] = static_cast<float>(r[0] * way[0] + r[1] * way[1] + r[2] * way[2]);
    }
    const float column = magnitude(base[0]), line = magnitude(base[1]);
    const float bases = (column > line ? column : line) + 2.0f * static_cast<float>(width) * magnitude(base[2]);
    error = size * tile.error_per_size + bases * tile.error_per_base + tile.base_error;
  }
};

/// A box of pixels may be too large by so much on each side: what estimates of 1 / w and corners' errors move.
inline constexpr float kBoxMargin = 0x1p-5f + 0x1p-7f;
/// w of every corner must be above its error times this, so that the box holds.
inline constexpr float kLeastSureW = 0x1p8f;
/// Beyond it 1 / w of a triangle is surely below that of a pixel.
inline constexpr float kSurelyFarther = 1.0f - 0x1p-10f;

/// Corners of L::kCount triangles of a leaf.
template <class L>
struct LeafCorners {
  using Float = typename L::Float;
  Float vertices[3][3];  ///< corner, axis; world space
  Float id;              ///< pattern of triangle_id
  Float x[3], y[3], w[3];
  float error;

  /// @param triangles  `count` of them; a shorter group of lanes repeats the last.
  GRIDIRON_INLINE void project(const TileProjection& tile, const LeafBase& leaf, const VertexTriangle* triangles,
                               std::uint32_t count) {
    load(triangles, count);
    error = leaf.error;
    for (int corner = 0; corner < 3; ++corner) {
      Float q[3];
      for (int axis = 0; axis < 3; ++axis) q[axis] = vertices[corner][axis] - Float(leaf.place[axis]);
      const auto along = [&](int row) GRIDIRON_INLINE_LAMBDA {
        const float* const r = tile.rows[row];
        return L::bounded_sum(
            q[0], Float(r[0]),
            L::bounded_sum(q[1], Float(r[1]), L::bounded_sum(q[2], Float(r[2]), Float(leaf.base[row]))));
      };
      x[corner] = along(0);
      y[corner] = along(1);
      w[corner] = along(2);
    }
  }

  /// @returns the triangles that may cover a pixel's centre and are not surely behind all hits, as bits.
  /// @param far  w beyond which everything is hidden. @param last_x, last_y  pixels that the picture has.
  /// @tparam IsWider  boxes have room for directions that are off by more than kUsuallyMoved.
  template <std::uint32_t Width, bool IsWider>
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t cull([[maybe_unused]] const TileProjection& tile, float far, float last_x,
                                                   float last_y, typename L::Int& box) const {
    static constexpr float kWidth = Width;
    const Float least_w = L::min(L::min(w[0], w[1]), w[2]), most_w = L::max(L::max(w[0], w[1]), w[2]);
    Float column[3], row[3];
    for (int corner = 0; corner < 3; ++corner) {
      const Float inverse = L::reciprocal_estimate(w[corner]);
      column[corner] = x[corner] * inverse;
      row[corner] = y[corner] * inverse;
    }
    const auto is_near = least_w > Float(error * kLeastSureW);  // else pixels cannot be told
    const auto range = [&](const Float* place, float last, Float& first, Float& end) GRIDIRON_INLINE_LAMBDA {
      const Float low = L::min(L::min(place[0], place[1]), place[2]) + Float(1.0f - 0x1p-10f - kBoxMargin);
      const Float high = L::max(L::max(place[0], place[1]), place[2]) + Float(kBoxMargin);
      const auto wider = [&](Float place_of_end, [[maybe_unused]] bool is_low) GRIDIRON_INLINE_LAMBDA {
        if constexpr (IsWider) return place_of_end + Float(is_low ? -tile.direction_error : tile.direction_error);
        return place_of_end;
      };
      // Not a number: min and max choose their second operand.
      first = L::select(is_near, L::max(wider(low, true), Float(0.0f)), Float(0.0f));
      end = L::select(is_near, L::min(wider(high, false), Float(last)), Float(last));
    };
    Float x0, x1, y0, y1;
    range(column, last_x, x0, x1);
    range(row, last_y, y0, y1);
    const auto far_end = L::min(x1, y1) >= Float(0.0f);
    const auto ix0 = L::truncate(L::min(x0, Float(kWidth))), iy0 = L::truncate(L::min(y0, Float(kWidth)));
    const auto ix1 = L::truncate(L::max(x1, Float(-1.0f))), iy1 = L::truncate(L::max(y1, Float(-1.0f)));
    const auto one = L::Int::splat(1);
    box = ix0 | (iy0 << 8) | (ix1 << 16) | (iy1 << 24);
    const auto kept = far_end & (ix0 < ix1 + one) & (iy0 < iy1 + one) & (most_w > Float(-error));
    const std::uint32_t hidden = (least_w * Float(kSurelyFarther) > Float(far)).bits() & is_near.bits();
    return kept.bits() & ~hidden;
  }

 private:
  GRIDIRON_INLINE void load(const VertexTriangle* triangles, std::uint32_t count) {
    if constexpr (L::kCount == 1) {
      for (int i = 0; i < 9; ++i) vertices[i / 3][i % 3] = Float(triangles->v[i / 3][i % 3]);
      id = Float(std::bit_cast<float>(triangles->triangle_id));
    } else {
      load_lanes(triangles, count);
    }
  }
  GRIDIRON_INLINE void load_lanes(const VertexTriangle* triangles, std::uint32_t count) {
    const VertexTriangle* group[L::kCount];
    for (std::uint32_t i = 0; i < L::kCount; ++i) group[i] = triangles + (i < count ? i : count - 1);
    const TransposedWords<L> low(group, 0), middle(group, 4), high(group, 8);
    for (int axis = 0; axis < 3; ++axis) vertices[0][axis] = low.word[axis];
    vertices[1][0] = low.word[3];
    vertices[1][1] = middle.word[0];
    vertices[1][2] = middle.word[1];
    vertices[2][0] = middle.word[2];
    vertices[2][1] = middle.word[3];
    vertices[2][2] = high.word[0];
    id = high.word[3];
  }
};

/// The float test of set_up_normal(), with the same operations, for L::kCount triangles.
/// @param vertices  corner, axis. @returns the lanes for which it is valid.
template <class L>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t float_normals(const typename L::Float (&vertices)[3][3],
                                                          typename L::Float (&normal)[3]) {
  using Float = typename L::Float;
  Float e1[3], e2[3], size[3];
  for (int i = 0; i < 3; ++i) {
    e1[i] = vertices[1][i] - vertices[0][i];
    e2[i] = vertices[2][i] - vertices[0][i];
  }
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1, k = j == 2 ? 0 : j + 1;
    const Float first = e1[j] * e2[k], second = e1[k] * e2[j];
    normal[i] = first - second;
    size[i] = L::abs(first) + L::abs(second);
  }
  const Float squared = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
  const Float sum = size[0] + size[1] + size[2];
  const auto is_valid = (sum > Float(0x1p-40f)) & (sum < Float(0x1p40f)) & (squared > Float(0x1p-8f) * (sum * sum));
  const Float scale = Float(1.0f) / L::square_root(squared);
  for (int i = 0; i < 3; ++i) normal[i] = normal[i] * scale;
  return is_valid.bits();
}

// With e = kFloatUnit, corners relative to an offset within the tile, g the error of their coordinates there and G = P
// + R W, where P and W are the largest |column w|, |row w| and |w| and R the farthest pixel: an edge's function is a
// product of two places less the pixel, each at most G and off by g: 4 g G. Its coefficients are differences of two
// products, their sum at a pixel takes at most eleven more roundings of sums of at most 2 G^2, step by step: 2 (2 + 11)
// e G^2. Lanes of blocks take fewer, but of terms of up to 2.2 R: 28.3 e G^2.
inline constexpr float kTileEdgeError = 30.0f * 0x1p-23f;
inline constexpr float kCornerFactor = 4.1f;
/// Covers what becomes subnormal, or is flushed.
inline constexpr float kLeastEdgeError = 0x1p-100f;
/// 1 / t is n . pixel / n . v with n = a x b, sides of the triangle at corner v. With C_i = |a_j b_k| + |a_k b_j| and
/// m_i the largest |component| of corners: n is off by 3 e C_i, and by e C_i for each rounded side, which counts along
/// the way from v to the hit, at most 2 m_i: 8 e C . m; n . v rounds by 3 e C . m, and takes (|n_x| + |n_y|) g + |n_w|
/// g_w of corners' errors. Coefficients take 3 e, their sum at a pixel 12 e of the sum of magnitudes; the least
/// distance by which rounded t surely differ 2 e.
inline constexpr float kNormalError = 11.5f * 0x1p-23f;
inline constexpr float kNearError = 17.5f * 0x1p-23f;
/// An error r of n . v moves 1 / t by r / (1 - r).
inline constexpr float kSecondOrder = 1.04f;
/// Above it nothing is known of a triangle's side.
inline constexpr float kMostNormalError = 0x1p-5f;
inline constexpr float kMostNear = 0x1p90f;

/// What a group of the queue gives: triangles as bits.
struct TileGroup {
  std::uint32_t drawn;    ///< have functions
  std::uint32_t tiny;     ///< of these, with boxes of at most 3 x 3 pixels
  std::uint32_t careful;  ///< have no bound: exact arithmetic decides their pixels
};

/// @returns for each box of pixels a 1 / t that all its pixels' hits have at least: the least of the blocks that it
/// lies in, up to two across and two down, or `least_near`, the tile's. A box that is no box gives any number. One lane
/// has no gather, and tiles of 64 KB have no room for the code.
template <class L, std::uint32_t Width, std::uint32_t MostLanes>
[[nodiscard]] GRIDIRON_INLINE typename L::Float least_near_of_boxes(const TileMemory<Width, MostLanes>& memory,
                                                                    typename L::Int ix0, typename L::Int iy0,
                                                                    typename L::Int ix1, typename L::Int iy1,
                                                                    float least_near) {
  using Float = typename L::Float;
  using Int = typename L::Int;
  // A block's number times 4 is the bytes to its entry, and its first column; rows of blocks are Width bytes long.
  static_assert(kBlockWidth == 4 && (Width == 32 || Width == 64));
  static constexpr int kShift = Width == 64 ? 4 : 3;
  const Int first = Int::splat(Width - kBlockWidth);
  const Int column0 = ix0 & first, column1 = ix1 & first;
  const Int row0 = (iy0 & first) << kShift, row1 = (iy1 & first) << kShift;
  const auto at = [&](Int row, Int column)
                      GRIDIRON_INLINE_LAMBDA { return L::floats_of(L::gather(memory.least_near, row | column)); };
  const auto is_small = (column1 < column0 + Int::splat(2 * kBlockWidth)) & (row1 < row0 + Int::splat(2 * Width));
  const Float upper = L::min(at(row0, column0), at(row0, column1));
  const Float lower = L::min(at(row1, column0), at(row1, column1));
  return L::select(is_small, L::min(upper, lower), Float(least_near));
}

/// Makes functions of L::kCount triangles of the queue, those from `first` on, relative to the middle of each box.
/// @param there  lanes with triangles. @param least_near  1 / t below which everything is hidden.
template <class L, std::uint32_t Width, std::uint32_t MostLanes>
[[nodiscard]] GRIDIRON_INLINE TileGroup set_up_group(TileMemory<Width, MostLanes>& memory, const TileProjection& tile,
                                                     std::uint32_t first, std::uint32_t there, float least_near) {
  using Float = typename L::Float;
  using Int = typename L::Int;
  const auto word = [&](std::uint32_t kind)
                        GRIDIRON_INLINE_LAMBDA { return L::floats_of(Int::load(memory.queue[kind] + first)); };
  const Int box = Int::load(memory.queue[kPixelBox] + first);
  const Int byte = Int::splat(0xFF);
  const Int ix0 = box & byte, iy0 = (box >> 8) & byte, ix1 = (box >> 16) & byte, iy1 = (box >> 24) & byte;
  const Float ox = L::to_float(ix0 + ix1) * Float(0.5f), oy = L::to_float(iy0 + iy1) * Float(0.5f);
  const Float x1 = L::to_float(ix1) - ox, y1 = L::to_float(iy1) - oy;  // the first pixel is at -x1, -y1
  const Float minus_ox = -ox, minus_oy = -oy;

  // 1. Corners relative to the offset, and how large they are.
  Float x[3], y[3], w[3];
  for (std::uint32_t corner = 0; corner < 3; ++corner) {
    w[corner] = word(kCornerW + corner);
    x[corner] = L::bounded_sum(minus_ox, w[corner], word(kCornerX + corner));
    y[corner] = L::bounded_sum(minus_oy, w[corner], word(kCornerY + corner));
  }
  const auto most = [](const Float(&of)[3])
                        GRIDIRON_INLINE_LAMBDA { return L::max(L::larger_size(of[0], of[1]), L::abs(of[2])); };
  const Float most_x = most(x), most_y = most(y), most_w = most(w);
  // Blocks reach beyond the box.
  const Float half = L::max(x1, y1), reach = half + Float(kBlockWidth - 1.0f);
  const Float size = L::bounded_sum(reach, most_w, L::max(most_x, most_y));
  const Float moved = word(kCornerError) + size * Float(0x1.4p-23f) +
                      most_w * Float(static_cast<float>(Width * 0x1p-22) + tile.direction_error);
  const Float edge_error =
      (size + moved) * (moved * Float(kCornerFactor) + size * Float(kTileEdgeError)) + Float(kLeastEdgeError);

  // 2. The plane. Of the three corners the one opposite to the longest side gives the least error.
  Float side_x[3], side_y[3], side_w[3], length[3];
  for (int i = 0; i < 3; ++i) {
    const int next = i == 2 ? 0 : i + 1;
    side_x[i] = x[next] - x[i];
    side_y[i] = y[next] - y[i];
    side_w[i] = w[next] - w[i];
    length[i] = L::abs(side_x[i]) + L::abs(side_y[i]);
  }
  // The longest side is number 0, 1, or else 2: the others are 1 and 2, 2 and 0, 0 and 1.
  const auto is_later = (length[1] > length[0]) | (length[2] > length[0]);
  const auto is_last = length[2] > length[1];
  const auto choose = [&](Float one, Float two, Float three)
                          GRIDIRON_INLINE_LAMBDA { return L::select(is_later, L::select(is_last, three, two), one); };
  const Float ax = choose(side_x[1], side_x[2], side_x[0]), bx = choose(side_x[2], side_x[0], side_x[1]);
  const Float ay = choose(side_y[1], side_y[2], side_y[0]), by = choose(side_y[2], side_y[0], side_y[1]);
  const Float aw = choose(side_w[1], side_w[2], side_w[0]), bw = choose(side_w[2], side_w[0], side_w[1]);
  const Float vx = choose(x[2], x[0], x[1]), vy = choose(y[2], y[0], y[1]), vw = choose(w[2], w[0], w[1]);
  const Float p0 = ay * bw, p1 = aw * by, p2 = aw * bx, p3 = ax * bw, p4 = ax * by, p5 = ay * bx;
  const Float nx = p0 - p1, ny = p2 - p3, nw = p4 - p5;
  const Float volume = L::bounded_sum(nx, vx, L::bounded_sum(ny, vy, nw * vw));
  const Float rounded =
      L::bounded_sum(L::abs(p0) + L::abs(p1), most_x,
                     L::bounded_sum(L::abs(p2) + L::abs(p3), most_y, (L::abs(p4) + L::abs(p5)) * most_w));
  const Float slope = L::abs(nx) + L::abs(ny);
  const Float plane_error =
      rounded * Float(kNormalError) + slope * moved + L::abs(nw) * moved * Float(1.0f / (2.0f * float(Width)));
  const Float inverse = Float(1.0f) / volume;
  const Float relative = plane_error * L::abs(inverse);
  const Float near_x = nx * inverse, near_y = ny * inverse, near_w = nw * inverse;
  const Float most_near = L::bounded_sum(L::abs(near_x) + L::abs(near_y), reach, L::abs(near_w));
  const Float near_error = most_near * (relative * Float(kSecondOrder) + Float(kNearError + 2.0f * tile.w_error));
  // Not a number: not sure.
  const auto is_sure =
      (relative < Float(kMostNormalError)) & (most_near < Float(kMostNear)) & (edge_error < Float(kMostNear));

  // 3. Edges, turned so that the triangle lies on their positive side, with their error added. Where the greatest value
  // in the box is negative, the triangle covers no pixel of it, or is hidden.
  const auto most_in_box = [&](Float value, Float along_x, Float along_y) GRIDIRON_INLINE_LAMBDA {
    return L::bounded_sum(L::abs(along_x), x1, L::bounded_sum(L::abs(along_y), y1, value));
  };
  const Float near_value = near_w - near_error, near_span = near_error + near_error;
  Float least(least_near);
  if constexpr (L::kCount != 1 && Width > 16) least = least_near_of_boxes<L>(memory, ix0, iy0, ix1, iy1, least_near);
  Int none = L::words_of(most_in_box(near_value, near_x, near_y) + near_span - least);
  const Int sign = L::words_of(volume) & Int::splat(0x80000000u);
  const auto turned = [&](Float a) GRIDIRON_INLINE_LAMBDA { return L::floats_of(L::words_of(a) ^ sign); };
  for (std::uint32_t i = 0; i < 3; ++i) {
    const std::uint32_t next = i == 2 ? std::uint32_t{0} : i + 1;
    const Float edge_x = turned(L::bounded_difference(y[i], w[next], w[i], y[next]));
    const Float edge_y = turned(L::bounded_difference(w[i], x[next], x[i], w[next]));
    const Float value = turned(L::bounded_difference(x[i], y[next], y[i], x[next])) + edge_error;
    none = none | L::words_of(most_in_box(value, edge_x, edge_y));
    value.store(memory.functions[kEdgeValue + i]);
    edge_x.store(memory.functions[kEdgeX + i]);
    edge_y.store(memory.functions[kEdgeY + i]);
  }
  const std::uint32_t sure = is_sure.bits();
  TileGroup group{~L::sign_bits(none) & sure & there, 0, there & ~sure};
  if ((group.drawn | group.careful) == 0) return group;
  near_value.store(memory.functions[kNearValue]);
  near_x.store(memory.functions[kNearX]);
  near_y.store(memory.functions[kNearY]);
  ox.store(memory.functions[kOffsetX]);
  oy.store(memory.functions[kOffsetY]);
  (edge_error + edge_error).store(memory.functions[kEdgeSpan]);
  near_span.store(memory.functions[kNearSpan]);
  box.store(memory.boxes);
  Int::load(memory.queue[kRecord] + first).store(memory.records);
  Int::load(memory.queue[kTriangleId] + first).store(memory.ids);
  group.tiny = (half < Float(1.25f)).bits() & group.drawn;
  return group;
}

}  // namespace gridiron
