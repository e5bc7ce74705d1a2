// From world space to the pixels of a tile: the inverse of the camera's matrix, with bounds of what rounding moves.
// A place p before the eye has three coordinates: (column w, row w, w) with w its distance t along the ray through its
// pixel. Pixels are counted from the tile's first one.
// Source: Olano, Greer 1997 (homogeneous coordinates); bounds own, core/TREE.md. Memory: values. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/ray/hits.h>

#include <bit>
#include <cstdint>
#include <initializer_list>

namespace gridiron {

/// The largest relative error of an operation in any rounding mode.
inline constexpr double kFloatUnit = 0x1p-23;
inline constexpr std::uint32_t kMostTileWidth = 64;
/// Pixels by which a direction may be off, so that bounds hold; and so that the usual margins of boxes have room for
/// it.
inline constexpr double kMostMoved = 1.5, kUsuallyMoved = 0.6 * 0x1p-6;
/// Whether tiles of a width go on with wider margins where the usual ones are too narrow. Those of 64 KB have no room
/// for the code.
template <std::uint32_t Width>
inline constexpr bool kHasWiderMargins = Width >= 32;

/// What all tiles of a frame share, in double.
struct EyeProjection {
  double rows[3][3];  ///< column, row, w: of a place less the eye
  double sizes[3];    ///< sums of the rows' magnitudes
  double offsets[3];  ///< of the rows: what makes them take places themselves
  double eye[3];
  float most;        ///< no component of a place or of the eye is larger
  float base_error;  ///< what doubles may lose of a place's coordinate, w's counted twice a tile's width
  float dir_max;     ///< no component of a direction is larger
  float unit;        ///< a power of two: w is t times it, so that the scene's size is a number like others
  float per_off;     ///< what a direction is moved by in pixels and in w, for each unit of its components' roundings
  bool has_bounds;   ///< if not, no bound holds and every pixel is decided exactly
  bool is_trusted;   ///< has bounds, with the usual margins

  /// Whether tiles of a width use the bounds.
  template <std::uint32_t Width>
  [[nodiscard]] GRIDIRON_INLINE bool is_bounded() const {
    return kHasWiderMargins<Width> ? has_bounds : is_trusted;
  }
};

/// What the roundings of a direction move, at most: over a frame as project_tile() has it over a tile.
struct MovedPixels {
  double pixels;  ///< along columns and rows, w's share counted twice the widest tile's width
  double w;       ///< relative
};
GRIDIRON_RARE inline MovedPixels moved_pixels(const FrameHead& frame, const EyeProjection& eye) {
  const auto larger = [](double a, double b) { return magnitude(a) > magnitude(b) ? magnitude(a) : magnitude(b); };
  // The last tile may end beyond the picture.
  const double width = double(frame.width) + kMostTileWidth, height = double(frame.height) + kMostTileWidth;
  double moved[3] = {0.0, 0.0, 0.0};
  for (int axis = 0; axis < 3; ++axis) {
    const double corner{frame.corner[axis]}, step_x{frame.step_x[axis]}, step_y{frame.step_y[axis]};
    const double first_column = -step_x, last_column = width * step_x, first_row = -step_y, last_row = height * step_y;
    const double left = corner + first_column, right = corner + last_column;
    const double off =
        magnitude(larger(first_column, last_column)) + magnitude(larger(left, right)) +
        magnitude(larger(first_row, last_row)) +
        magnitude(larger(larger(left + first_row, left + last_row), larger(right + first_row, right + last_row)));
    const double w = eye.rows[2][axis];
    moved[0] += magnitude(larger(eye.rows[0][axis] + w, eye.rows[0][axis] - width * w)) * off;
    moved[1] += magnitude(larger(eye.rows[1][axis] + w, eye.rows[1][axis] - height * w)) * off;
    moved[2] += magnitude(w) * off;
  }
  const double share = 1.02 * kFloatUnit / double{eye.unit};
  return {share * (larger(moved[0], moved[1]) + 2.0 * kMostTileWidth * moved[2]), share * moved[2]};
}

/// @returns a power of two near 1 / size, and 1 where size is no extreme number.
[[nodiscard]] GRIDIRON_RARE inline double unit_of(double size) {
  if (size > 0x1p-24 && size < 0x1p24) return 1.0;
  static constexpr std::uint64_t kExponent = 0x7FF0000000000000u, kTwiceBias = std::uint64_t{2 * 1023} << 52;
  return std::bit_cast<double>(kTwiceBias - (std::bit_cast<std::uint64_t>(size) & kExponent));
}

/// Inverts the camera's matrix.
///
/// Rows are products of two columns over the determinant: with doubles of 2^-52
/// their error is below 2^-50 |a||b| / det each, and the determinant's own relative error below 2^-49 scale / det. As
/// det > 2^-12 scale, both together are below 2^-36 of a row's size.
GRIDIRON_RARE inline EyeProjection project_eye(const FrameHead& frame, float largest) {
  EyeProjection eye{};
  double first[3], step_x[3], step_y[3], most = 0.0, far = double{largest};
  for (int axis = 0; axis < 3; ++axis) {
    first[axis] = double{frame.corner[axis]};
    step_x[axis] = double{frame.step_x[axis]};
    step_y[axis] = double{frame.step_y[axis]};
    eye.eye[axis] = double{frame.eye[axis]};
    const double sum = magnitude(first[axis]) + (double(frame.width) + 1.0) * magnitude(step_x[axis]) +
                       (double(frame.height) + 1.0) * magnitude(step_y[axis]);
    most = sum > most ? sum : most;
    far = magnitude(eye.eye[axis]) > far ? magnitude(eye.eye[axis]) : far;
  }
  double scale = 1.0;
  for (const double* const column : {first, step_x, step_y}) {
    scale *= magnitude(column[0]) + magnitude(column[1]) + magnitude(column[2]);
  }
  double det = 0.0;
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1, k = j == 2 ? 0 : j + 1;
    eye.rows[0][i] = step_y[j] * first[k] - step_y[k] * first[j];
    eye.rows[1][i] = first[j] * step_x[k] - first[k] * step_x[j];
    eye.rows[2][i] = step_x[j] * step_y[k] - step_x[k] * step_y[j];
    det += first[i] * eye.rows[2][i];
  }
  const bool is_of_any_size = far > 0x1p-80 && far < 0x1p80;
  const double w_size = magnitude(eye.rows[2][0]) + magnitude(eye.rows[2][1]) + magnitude(eye.rows[2][2]);
  const double unit = is_of_any_size ? unit_of(far * w_size / magnitude(det)) : 1.0;
  eye.unit = static_cast<float>(unit);
  eye.per_off = static_cast<float>(1.01 * kFloatUnit / unit);
  const double divisor = det / unit;
  for (int row = 0; row < 3; ++row) {
    for (int axis = 0; axis < 3; ++axis) {
      double& value = eye.rows[row][axis];
      value = value / divisor;
      eye.sizes[row] += magnitude(value);
      eye.offsets[row] -= value * eye.eye[axis];
    }
  }
  // Of the eye's rows, not of a tile's.
  const double widest = double(frame.width) + double(frame.height) + 4.0 * kMostTileWidth;
  const double lost = eye.sizes[0] + eye.sizes[1] + widest * eye.sizes[2];
  eye.most = static_cast<float>(far * 1.0001);
  eye.base_error = static_cast<float>(0x1p-36 * lost * 2.0 * far + 0x1p-100);
  eye.dir_max = static_cast<float>(most * 1.0001);
  // Where pixels are far smaller than rounding, or numbers leave the range in which products of four keep their
  // precision, exact arithmetic decides everything.
  const MovedPixels moved = moved_pixels(frame, eye);
  eye.has_bounds = magnitude(det) > 0x1p-12 * scale && moved.pixels < kMostMoved && moved.w < 0.6 * 0x1p-9 &&
                   is_of_any_size && far * eye.sizes[2] < 0x1p24 && far * (eye.sizes[0] + eye.sizes[1]) < 0x1p36 &&
                   far * eye.sizes[2] > 0x1p-24;
  eye.is_trusted = eye.has_bounds && moved.pixels < kUsuallyMoved;
  return eye;
}

/// Of one tile, in floats.
/// @tparam Width  pixels along its edge.
struct TileProjection {
  float rows[3][3];  ///< column, row, w; of a place less the eye
  double exact_rows[3][3];
  float error_per_size;   ///< of a coordinate of a corner, times the largest component of its way from the leaf's base
  float error_per_base;   ///< the same, times the base's own coordinates
  float base_error;       ///< the same, of a base
  float direction_error;  ///< of a direction, in pixels
  float w_error;          ///< of w along a direction, relative
  // Boxes: planes through the eye, left, right, top, bottom, then w itself.
  float planes[5][4];  ///< inside is where x p0 + y p1 + z p2 + p3 >= 0; the last one gives w, or less
};

/// How far outside a tile's pixels a box still counts, in pixels.
inline constexpr double kPlaneMargin = 0x1p-5;

/// The error of a box's value at a plane, as a share of its parts' magnitudes.
inline constexpr float kPlaneError = 10.0f * 0x1p-23f;
/// Makes up for what a sum of a few positive floats loses.
inline constexpr float kRoundedUp = 1.0f + 0x1p-16f;

/// @param width  pixels along the tile's edge, at most kMostTileWidth.
///
/// With q a corner's way from the leaf's base: rows rounded to floats carry 1 kFloatUnit, q and its products with them
/// 2, three sums 3: 6 kFloatUnit size |q|. The base is rounded once and goes through all three sums: 4 kFloatUnit
/// |base|. A pixel's place less an offset of up to `width` takes that much of w's error too, twice where a pixel is up
/// to `width` away from the offset. tests/numeric/proofs proves these, and what tile_triangles.h charges.
///
/// A direction's component is a linear function of the pixel but for four roundings of at most kFloatUnit each: of two
/// products and two sums. Over a tile each of them is largest at a corner. Where these sums cancel, floats lose a few
/// kFloatUnit of the other terms: far less than the share of 0.01 that is added.
GRIDIRON_OUTLINE inline void project_tile(const FrameHead& frame, const EyeProjection& eye, const TileView& view,
                                          std::uint32_t width, TileProjection& tile) {
  const double x = double(view.left) + double{view.dx}, y = double(view.top) + double{view.dy};
  float sizes[3] = {0.0f, 0.0f, 0.0f};
  for (int axis = 0; axis < 3; ++axis) {
    tile.exact_rows[0][axis] = eye.rows[0][axis] - x * eye.rows[2][axis];
    tile.exact_rows[1][axis] = eye.rows[1][axis] - y * eye.rows[2][axis];
    tile.exact_rows[2][axis] = eye.rows[2][axis];
    for (int row = 0; row < 3; ++row) {
      tile.rows[row][axis] = static_cast<float>(tile.exact_rows[row][axis]);
      sizes[row] += magnitude(tile.rows[row][axis]);
    }
  }
  const float wide = static_cast<float>(width), span = 2.0f * wide;
  const float size = ((sizes[0] > sizes[1] ? sizes[0] : sizes[1]) + span * sizes[2]) * kRoundedUp;
  tile.error_per_size = static_cast<float>(6.1 * kFloatUnit) * size;
  tile.error_per_base = static_cast<float>(4.1 * kFloatUnit);
  tile.base_error = eye.base_error;

  // What directions' roundings move.
  const float left_x = static_cast<float>(x), top_y = static_cast<float>(y);
  float moved[3] = {0.0f, 0.0f, 0.0f};
  for (int axis = 0; axis < 3; ++axis) {
    const auto larger = [](float a, float b) { return magnitude(a) > magnitude(b) ? magnitude(a) : magnitude(b); };
    const float corner = frame.corner[axis], step_x = frame.step_x[axis], step_y = frame.step_y[axis];
    const float column0 = left_x * step_x, column1 = (left_x + wide) * step_x;
    const float left = corner + column0, right = corner + column1;
    const float top = top_y * step_y, bottom = (top_y + wide) * step_y;
    const float ends = larger(larger(left + top, left + bottom), larger(right + top, right + bottom));
    const float off = larger(column0, column1) + larger(left, right) + larger(top, bottom) + ends;
    for (int row = 0; row < 3; ++row) moved[row] += magnitude(tile.rows[row][axis]) * off;
  }
  tile.direction_error = eye.per_off * ((moved[0] > moved[1] ? moved[0] : moved[1]) + span * moved[2]);
  tile.w_error = eye.per_off * moved[2];

  // Planes. A component takes 3 kFloatUnit of the two parts that it is the sum of: their own, a product, the sum. Three
  // products and sums take 4, of the offset 5 with its own two: 7 at most. The rest is room.
  static constexpr float kMargin = static_cast<float>(kPlaneMargin);
  const double offsets[3] = {eye.offsets[0] - x * eye.offsets[2], eye.offsets[1] - y * eye.offsets[2], eye.offsets[2]};
  const double last = double(width - 1) + kPlaneMargin;
  const float last_w = static_cast<float>(last);
  for (int row = 0; row < 2; ++row) {
    float(&first)[4] = tile.planes[2 * row];
    float(&second)[4] = tile.planes[2 * row + 1];
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = tile.rows[row][axis] + kMargin * tile.rows[2][axis];
      second[axis] = last_w * tile.rows[2][axis] - tile.rows[row][axis];
    }
    const float near_offset = static_cast<float>(offsets[row] + kPlaneMargin * offsets[2]);
    const float far_offset = static_cast<float>(last * offsets[2] - offsets[row]);
    const float lost = (sizes[row] + last_w * sizes[2]) * eye.most;
    first[3] = near_offset + (kPlaneError * (lost + magnitude(near_offset)) + tile.base_error);
    second[3] = far_offset + (kPlaneError * (lost + magnitude(far_offset)) + tile.base_error);
  }
  const float offset = static_cast<float>(offsets[2]);
  for (int axis = 0; axis < 3; ++axis) tile.planes[4][axis] = tile.rows[2][axis];
  tile.planes[4][3] = offset - (kPlaneError * (sizes[2] * eye.most + magnitude(offset)) + tile.base_error);
}

/// The children whose boxes a tile meets if directions are off by more than kUsuallyMoved, as bits: the planes'
/// margins are wider by twice tile.direction_error. @param far  w beyond which everything is hidden.
[[nodiscard]] GRIDIRON_RARE inline std::uint32_t boxes_in_wide_margins(const EyeProjection& eye,
                                                                       const TileProjection& tile, const TreeNode& node,
                                                                       float far) {
  // By what w may be above the sum.
  const float* const of_w = tile.planes[4];
  const float sizes = magnitude(of_w[0]) + magnitude(of_w[1]) + magnitude(of_w[2]);
  const float lost = 4.0f * (kPlaneError * (sizes * eye.most + magnitude(of_w[3])) + tile.base_error);
  std::uint32_t met = 0;
  for (std::uint32_t child = 0; child < node.child_count; ++child) {
    const auto end_of = [&](int p, bool is_least) GRIDIRON_INLINE_LAMBDA {
      const float* const k = tile.planes[p];
      float sum = k[3];
      for (int axis = 2; axis >= 0; --axis) {
        sum = ((k[axis] > 0.0f) == is_least ? node.low : node.high)[axis][child] * k[axis] + sum;
      }
      return sum;
    };
    const float most_w = end_of(4, false) + lost;
    const float room = most_w > 0.0f ? 2.0f * tile.direction_error * most_w : 0.0f;
    bool is_met = end_of(4, true) <= far;
    for (int p = 0; p < 4; ++p) is_met = is_met && end_of(p, false) + room >= 0.0f;
    if (is_met) met |= 1u << child;
  }
  return met;
}

}  // namespace gridiron
