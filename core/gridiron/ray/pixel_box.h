// Pixel box: the pixels of a packet that a triangle can cover, from the projections of its vertices.
// Source: own; projections by the rows of the inverse camera matrix. Memory: values. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/ray/packet.h>

#include <cstdint>
#include <initializer_list>

namespace gridiron {

/// Prepares packet.projection from first_dir, step_x and step_y.
///
/// With F, X, Y these three and det = F . (X x Y), the rows are W = (X x Y) / det, P = (Y x F) / det and
/// Q = (F x X) / det: the direction F + c X + r Y has W . d = 1, P . d = c, Q . d = r, so that a point a in front of
/// the origin appears at column P . a / W . a and row Q . a / W . a.
///
/// Errors, e = 2^-23, D = dir_bound, the largest sum of magnitudes that goes into a direction's component. The rows are
/// rounded from doubles, with an error of e of themselves. A direction differs from the linear form by less than 6 e D:
/// P . d is within 8 e D |P|1 of the column, W . d within 8 e D |W|1 of 1; at columns up to 32 that is 8 e D (|P|1 + 32
/// |W|1). The place of a point in the triangle lies between its vertices', as all have W . a > 0. The difference of a
/// vertex and the origin, the products and sums carry 4 e |P|1 |a|max in the numerator, 4 e |W|1 |a|max in the
/// denominator; if |a|max < 2 D W . a, that is 8 e D |P|1 in all, and of the quotient itself 8 e D |W|1 + 3 e. The
/// latter holds for quotients up to 64; those beyond stay beyond 32 as long as it is below a quarter. Sum: 16 e D |P|1
/// + 768 e D |W|1 + 192 e. Twice that is charged.
///
/// A common factor on all rows does not change quotients. It makes the largest sum of magnitudes in a row 1, so that no
/// coordinate up to 2^121 can overflow. If the margin would be a pixel or more, no box is trusted.
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
  double size[3];
  for (int row = 0; row < 3; ++row) {
    size[row] = magnitude(rows[row][0]) + magnitude(rows[row][1]) + magnitude(rows[row][2]);
  }
  const double along = size[1] > size[2] ? size[1] : size[2];
  const double largest = size[0] > along ? size[0] : along;
  const double bound_per_det = double{dir_bound} / magnitude(det);
  constexpr double kUnit = 0x1p-23;
  const double margin = kUnit * (bound_per_det * (32.0 * along + 1536.0 * size[0]) + 400.0);
  // What doubles lose in a nearly singular matrix must not count.
  double scale = 1.0;
  for (const double* const vector : {first, step_x, step_y}) {
    scale *= magnitude(vector[0]) + magnitude(vector[1]) + magnitude(vector[2]);
  }
  PixelProjection& projection = packet.projection;
  projection = PixelProjection{};
  if (!(margin < 1.0 && magnitude(det) > 0x1p-24 * scale)) return;
  const double scaled = (det < 0.0 ? -1.0 : 1.0) / largest;
  for (int row = 0; row < 3; ++row) {
    for (int axis = 0; axis < 3; ++axis) projection.rows[row][axis] = static_cast<float>(rows[row][axis] * scaled);
  }
  projection.margin = static_cast<float>(margin);
  projection.most_per_depth = static_cast<float>(2.0 * bound_per_det * largest);
}

/// Boxes of L::kCount triangles, in pixels of the packet, one lane each: from `first` to before `end`.
template <class L>
struct PixelBoxes {
  alignas(64) std::uint32_t first_column[L::kCount];
  alignas(64) std::uint32_t end_column[L::kCount];
  alignas(64) std::uint32_t first_row[L::kCount];
  alignas(64) std::uint32_t end_row[L::kCount];
  std::uint32_t covering;  ///< lanes whose box is not empty
};

/// Words of L::kCount triangles: element i of the result holds word first_word + i of each, one lane a triangle.
template <class L>
struct TransposedWords {
  typename L::Float word[4];

  GRIDIRON_INLINE TransposedWords(const VertexTriangle* const* triangles, std::uint32_t first_word) {
    using Float = typename L::Float;
    const auto rows_of = [&](std::uint32_t first) GRIDIRON_INLINE_LAMBDA {  // of triangles first, first + 4, ...
      const float* rows[L::kCount / 4];
      for (std::uint32_t quad = 0; quad < L::kCount / 4; ++quad) {
        rows[quad] = &triangles[4 * quad + first]->v[0][0] + first_word;
      }
      return L::load_quads(rows);
    };
    const Float row0 = rows_of(0), row1 = rows_of(1), row2 = rows_of(2), row3 = rows_of(3);
    const Float low01 = L::template shuffle_quads<0, 1, 4, 5>(row0, row1);
    const Float low23 = L::template shuffle_quads<0, 1, 4, 5>(row2, row3);
    const Float high01 = L::template shuffle_quads<2, 3, 6, 7>(row0, row1);
    const Float high23 = L::template shuffle_quads<2, 3, 6, 7>(row2, row3);
    word[0] = L::template shuffle_quads<0, 2, 4, 6>(low01, low23);
    word[1] = L::template shuffle_quads<1, 3, 5, 7>(low01, low23);
    word[2] = L::template shuffle_quads<0, 2, 4, 6>(high01, high23);
    word[3] = L::template shuffle_quads<1, 3, 5, 7>(high01, high23);
  }
};

/// Computes for each triangle a box outside of which no ray of the packet can hit it; the whole packet if that is
/// unknown.
///
/// @param triangles  L::kCount of them; a shorter batch repeats one.
template <class L, class PacketType>
GRIDIRON_INLINE void find_pixel_boxes(const PacketType& packet, const VertexTriangle* const* triangles,
                                      PixelBoxes<L>& boxes) {
  using Float = typename L::Float;
  const PixelProjection& projection = packet.projection;
  // A record's first 36 bytes are x0 y0 z0 x1 | y1 z1 x2 y2 | z2.
  const TransposedWords<L> low_words(triangles, 0);
  const TransposedWords<L> middle_words(triangles, 4);
  const TransposedWords<L> high_words(triangles, 8);
  const Float vertices[3][3] = {{low_words.word[0], low_words.word[1], low_words.word[2]},
                                {low_words.word[3], middle_words.word[0], middle_words.word[1]},
                                {middle_words.word[2], middle_words.word[3], high_words.word[0]}};
  const Float origin_x(packet.origin[0]), origin_y(packet.origin[1]), origin_z(packet.origin[2]);
  Float column[3], row[3];
  auto is_sure = L::mask_from_bits(L::kAllBits);
  for (int i = 0; i < 3; ++i) {
    const Float x = vertices[i][0] - origin_x, y = vertices[i][1] - origin_y, z = vertices[i][2] - origin_z;
    const auto along = [&](int k) GRIDIRON_INLINE_LAMBDA {
      return x * Float(projection.rows[k][0]) + y * Float(projection.rows[k][1]) + z * Float(projection.rows[k][2]);
    };
    const Float depth = along(0);
    const Float inverse = Float(1.0f) / depth;
    column[i] = along(1) * inverse;
    row[i] = along(2) * inverse;
    const Float size = L::max(L::max(L::abs(x), L::abs(y)), L::abs(z));
    // Below 2^-80 products may lose too much. NaNs are not sure.
    is_sure = is_sure & (size < depth * Float(projection.most_per_depth)) & (depth > Float(0x1p-80f));
  }
  const auto range_of = [&](const Float* place, std::uint32_t* first, std::uint32_t* end) GRIDIRON_INLINE_LAMBDA {
    const Float margin(projection.margin);
    const Float low = L::min(L::min(place[0], place[1]), place[2]) - margin;
    const Float high = L::max(L::max(place[0], place[1]), place[2]) + margin;
    constexpr float kWidth = static_cast<float>(PacketType::kWidth);
    const auto pixel = [](Float value)
                           GRIDIRON_INLINE_LAMBDA { return L::min(L::max(value, Float(0.0f)), Float(kWidth)); };
    // The first pixel not before `low` is the whole part of low + 1, one less where low is whole itself; 1 - 2^-18 ends
    // on a float at every column, so that rounding cannot carry a sum past it.
    const Float first_pixel = L::select(is_sure, pixel(low + Float(1.0f - 0x1p-18f)), Float(0.0f));
    const Float end_pixel = L::select(is_sure, pixel(high + Float(1.0f)), Float(kWidth));
    const auto first_whole = L::truncate(first_pixel), end_whole = L::truncate(end_pixel);
    first_whole.store(first);
    end_whole.store(end);
    return first_whole < end_whole;
  };
  const auto has_columns = range_of(column, boxes.first_column, boxes.end_column);
  const auto has_rows = range_of(row, boxes.first_row, boxes.end_row);
  boxes.covering = (has_columns & has_rows).bits();
}

/// For each column (or row) of subpackets, the set of subpackets before it.
struct SubpacketsBefore {
  SubpacketSet column[9];
  SubpacketSet row[9];
};
inline constexpr SubpacketsBefore kSubpacketsBefore = [] {
  SubpacketsBefore before{};
  for (std::uint32_t edge = 0; edge < 9; ++edge) {
    for (std::uint32_t i = 0; i < 64; ++i) {
      // The difference wraps, its highest bit is set, where it is before the edge.
      before.column[edge] |= SubpacketSet{(z_curve_column(i) - edge) >> 31} << i;
      before.row[edge] |= SubpacketSet{(z_curve_row(i) - edge) >> 31} << i;
    }
  }
  return before;
}();

/// One triangle's box, not empty, in pixels of the packet.
struct PixelBox {
  std::uint32_t first_column, end_column, first_row, end_row;

  /// @returns the subpackets that it touches.
  [[nodiscard]] GRIDIRON_INLINE SubpacketSet subpackets() const {
    constexpr std::uint32_t kLast = kSubpacketWidth - 1;
    const SubpacketSet before_end = kSubpacketsBefore.column[(end_column + kLast) / kSubpacketWidth] &
                                    kSubpacketsBefore.row[(end_row + kLast) / kSubpacketWidth];
    const SubpacketSet before_first =
        kSubpacketsBefore.column[first_column / kSubpacketWidth] | kSubpacketsBefore.row[first_row / kSubpacketWidth];
    return before_end & ~before_first;
  }
  /// @returns whether it touches at most two by two subpackets.
  [[nodiscard]] GRIDIRON_INLINE bool is_small() const {
    return end_column - first_column / kSubpacketWidth * kSubpacketWidth <= 2 * kSubpacketWidth &&
           end_row - first_row / kSubpacketWidth * kSubpacketWidth <= 2 * kSubpacketWidth;
  }
  /// @returns its rows, bit i = row i of the packet.
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t rows() const {
    return (~0u >> (32 - (end_row - first_row))) << first_row;
  }
};

}  // namespace gridiron
