// Pixel box: the pixels of a packet that a triangle can cover, from its vertices' places on the picture.
// Source: own; projections by the rows of the inverse camera matrix. Memory: values. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/ray/packet.h>

#include <cstdint>

namespace gridiron {

/// Vertices of L::kCount / 4 triangles as seen from a packet's origin, a quad of lanes each: 0, 1, 2, 2.
template <class L>
struct VertexLanes {
  using Float = typename L::Float;
  Float x, y, z;        ///< world space
  Float a_x, a_y, a_z;  ///< less the origin

  /// @param triangles  L::kCount / 4 of them.
  GRIDIRON_INLINE VertexLanes(const VertexTriangle* const* triangles, const float origin[3]) {
    // A record's first 36 bytes are x0 y0 z0 x1 | y1 z1 x2 y2 | z2: turn them into one vector per axis.
    constexpr std::uint32_t kTriangles = L::kCount / 4;
    const float* rows[3][kTriangles];
    for (std::uint32_t i = 0; i < kTriangles; ++i) {
      for (int row = 0; row < 3; ++row) rows[row][i] = &triangles[i]->v[0][0] + 4 * row;
    }
    const Float row0 = L::load_quads(rows[0]);
    const Float row1 = L::load_quads(rows[1]);
    const Float row2 = L::load_quads(rows[2]);
    x = L::template shuffle_quads<0, 3, 6, 6>(row0, row1);
    y = L::template shuffle_quads<1, 4, 7, 7>(row0, row1);
    z = L::template shuffle_quads<0, 1, 4, 4>(L::template shuffle_quads<2, 5, 5, 5>(row0, row1), row2);
    a_x = x - Float(origin[0]);
    a_y = y - Float(origin[1]);
    a_z = z - Float(origin[2]);
  }
};

/// Prepares packet.projection from first_dir, step_x and step_y.
///
/// With F, X, Y these three and det = F . (X x Y), the rows are W = (X x Y) / det, P = (Y x F) / det and
/// Q = (F x X) / det: the direction F + c X + r Y has W . d = 1, P . d = c, Q . d = r, so that a point a in front of the
/// origin appears at column P . a / W . a and row Q . a / W . a.
///
/// Errors, e = 2^-23, D = dir_bound, the largest sum of magnitudes that goes into a direction's component. The rows are
/// rounded from doubles, e of themselves. A direction differs from the linear form by less than 6 e D: P . d is within
/// 8 e D |P|1 of the column, W . d within 8 e D |W|1 of 1; at columns up to 32 that is 8 e D (|P|1 + 32 |W|1). The place
/// of a point in the triangle lies between its vertices', as all have W . a > 0. A vertex less the origin, the products
/// and sums carry 4 e |P|1 |a|max in the numerator, 4 e |W|1 |a|max in the denominator; where |a|max <= 2 D W . a, that
/// is 8 e D |P|1 in all, and of the quotient itself 8 e D |W|1 + 3 e. The latter on quotients up to 64; those beyond
/// stay beyond 32 as long as it is below a quarter. Sum: 16 e D |P|1 + 768 e D |W|1 + 192 e. Twice that is charged.
template <class PacketType>
void set_up_projection(PacketType& packet, float dir_bound) {
  double first[3], step_x[3], step_y[3];
  for (int axis = 0; axis < 3; ++axis) {
    first[axis] = double{packet.first_dir[axis]};
    step_x[axis] = double{packet.step_x[axis]};
    step_y[axis] = double{packet.step_y[axis]};
  }
  double rows[3][3];  // of the inverse, times det
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    const int k = j == 2 ? 0 : j + 1;
    rows[0][i] = step_x[j] * step_y[k] - step_x[k] * step_y[j];
    rows[1][i] = step_y[j] * first[k] - step_y[k] * first[j];
    rows[2][i] = first[j] * step_x[k] - first[k] * step_x[j];
  }
  const double det = first[0] * rows[0][0] + first[1] * rows[0][1] + first[2] * rows[0][2];
  PixelProjection& projection = packet.projection;
  float size[3] = {0.0f, 0.0f, 0.0f};
  for (int row = 0; row < 3; ++row) {
    for (int axis = 0; axis < 3; ++axis) {
      projection.rows[row][axis] = static_cast<float>(rows[row][axis] / det);
      size[row] += magnitude(projection.rows[row][axis]);
    }
  }
  const float along = size[1] > size[2] ? size[1] : size[2];
  constexpr float kUnit = 0x1p-23f;
  projection.margin = 32.0f * kUnit * (dir_bound * along) + 1536.0f * kUnit * (dir_bound * size[0]) + 400.0f * kUnit;
  projection.most_per_depth = 2.0f * dir_bound;
  // What doubles lose in a matrix that is nearly singular must not count.
  double scale = 1.0;
  for (const double* const vector : {first, step_x, step_y}) {
    scale *= magnitude(vector[0]) + magnitude(vector[1]) + magnitude(vector[2]);
  }
  const bool is_good = projection.margin < 1.0f && magnitude(det) > 0x1p-24 * scale && dir_bound < 0x1p60f;
  if (!is_good) projection.margin = kInfinity;
}

/// Boxes of pixels of L::kCount / 4 triangles, in the packet: from `first` to before `end`. Lane 4 i is the column, lane
/// 4 i + 2 the row of triangle i.
template <class L>
struct PixelBoxes {
  typename L::Int first, end;
};

/// @returns for each triangle a box outside of which no ray of the packet can hit it; where that cannot be told, the
/// whole packet.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_INLINE PixelBoxes<L> pixel_boxes(const PacketType& packet, const VertexLanes<L>& vertices) {
  using Float = typename L::Float;
  const PixelProjection& projection = packet.projection;
  const auto along = [&](int row) GRIDIRON_INLINE_LAMBDA {
    return vertices.a_x * Float(projection.rows[row][0]) + vertices.a_y * Float(projection.rows[row][1]) +
           vertices.a_z * Float(projection.rows[row][2]);
  };
  const Float depth = along(0);
  const Float size = L::max(L::max(L::abs(vertices.a_x), L::abs(vertices.a_y)), L::abs(vertices.a_z));
  // Below 2^-60 products may lose too much.
  const auto is_sure = (size <= depth * Float(projection.most_per_depth)) & (depth >= Float(0x1p-60f));
  const Float inverse = Float(1.0f) / depth;
  const Float column = along(1) * inverse;
  const Float row = along(2) * inverse;
  // Per quad: columns of vertices 0 and 1, rows of 0 and 1; then of vertex 2.
  const Float some = L::template shuffle_quads<0, 1, 4, 5>(column, row);
  const Float last = L::template shuffle_quads<2, 2, 6, 6>(column, row);
  Float low = L::min(some, last);
  Float high = L::max(some, last);
  low = L::min(low, L::template shuffle_quads<1, 0, 3, 2>(low)) - Float(projection.margin);
  high = L::max(high, L::template shuffle_quads<1, 0, 3, 2>(high)) + Float(projection.margin);
  const std::uint32_t unsure = ~is_sure.bits() & L::kAllBits;
  if (unsure != 0) [[unlikely]] {
    const std::uint32_t quads = (unsure | unsure >> 1 | unsure >> 2 | unsure >> 3) & 0x1111u;
    const auto in_quad = L::mask_from_bits(quads * 0xFu);
    low = L::select(in_quad, Float(-kInfinity), low);
    high = L::select(in_quad, Float(kInfinity), high);
  }
  constexpr float kWidth = static_cast<float>(PacketType::kWidth);
  const auto pixel = [](Float value) GRIDIRON_INLINE_LAMBDA {
    return L::truncate(L::min(L::max(value, Float(0.0f)), Float(kWidth)));
  };
  // The first pixel not before `low` is the whole part of low + 1, one less where low is whole itself; 1 - 2^-18 ends on
  // a float at every column, so that rounding cannot carry a sum past it.
  return {pixel(low + Float(1.0f - 0x1p-18f)), pixel(high + Float(1.0f))};
}

/// Subpackets in the columns, or rows, of subpackets before one.
struct SubpacketsBefore {
  SubpacketSet column[9];
  SubpacketSet row[9];
};
inline constexpr SubpacketsBefore kSubpacketsBefore = [] {
  SubpacketsBefore before{};
  for (std::uint32_t edge = 0; edge < 9; ++edge) {
    for (std::uint32_t i = 0; i < 64; ++i) {
      // The difference wraps, its highest bit is set, where it is before the edge.
      before.column[edge] |= SubpacketSet{(subpacket_column(i) - edge) >> 31} << i;
      before.row[edge] |= SubpacketSet{(subpacket_row(i) - edge) >> 31} << i;
    }
  }
  return before;
}();

/// One triangle's box, in pixels of the packet.
struct PixelBox {
  std::uint32_t first_column, end_column, first_row, end_row;

  template <class L>
  GRIDIRON_INLINE PixelBox(const PixelBoxes<L>& boxes, std::uint32_t index) {
    const int lane = static_cast<int>(4 * index);
    first_column = static_cast<std::uint32_t>(boxes.first[lane]);
    end_column = static_cast<std::uint32_t>(boxes.end[lane]);
    first_row = static_cast<std::uint32_t>(boxes.first[lane + 2]);
    end_row = static_cast<std::uint32_t>(boxes.end[lane + 2]);
  }
  /// @returns the subpackets that it touches.
  [[nodiscard]] GRIDIRON_INLINE SubpacketSet subpackets() const {
    if (first_column >= end_column || first_row >= end_row) return 0;
    constexpr std::uint32_t kLast = kSubpacketWidth - 1;
    const SubpacketSet before_end = kSubpacketsBefore.column[(end_column + kLast) / kSubpacketWidth] &
                                    kSubpacketsBefore.row[(end_row + kLast) / kSubpacketWidth];
    const SubpacketSet before_first = kSubpacketsBefore.column[first_column / kSubpacketWidth] |
                                      kSubpacketsBefore.row[first_row / kSubpacketWidth];
    return before_end & ~before_first;
  }
  /// @returns whether these are at most two by two.
  [[nodiscard]] GRIDIRON_INLINE bool is_small() const {
    return end_column - first_column / kSubpacketWidth * kSubpacketWidth <= 2 * kSubpacketWidth &&
           end_row - first_row / kSubpacketWidth * kSubpacketWidth <= 2 * kSubpacketWidth;
  }
  /// @returns its rows, bit i = row i of the packet. Precondition: it is not empty.
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t rows() const {
    return (~0u >> (32 - (end_row - first_row))) << first_row;
  }
};

}  // namespace gridiron
