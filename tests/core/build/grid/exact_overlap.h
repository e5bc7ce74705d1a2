// Does a triangle touch a box? Decided with rational numbers by cutting the triangle with the box's six half-spaces.
// Memory: heap. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>
#include <gridiron/base/records.h>

#include "support/rational_vectors.h"

namespace gridiron::test {

/// The point's exact place in cell space.
inline RationalPoint exact_cell_point(const GridRecord& grid, const Vec3& p) {
  RationalPoint cell;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    cell[i] = (exact_rational(p[axis]) - exact_rational(grid.minimum[i])) * exact_rational(grid.cells_per_unit[i]);
  }
  return cell;
}

/// The part of a convex polygon where sign * (coordinate - plane) >= 0.
inline std::vector<RationalPoint> cut_polygon(const std::vector<RationalPoint>& polygon, std::size_t axis, int sign,
                                              const Rational& plane) {
  std::vector<RationalPoint> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const RationalPoint& a = polygon[i];
    const RationalPoint& b = polygon[(i + 1) % polygon.size()];
    const Rational side_a = sign * (a[axis] - plane);
    const Rational side_b = sign * (b[axis] - plane);
    if (side_a >= 0) kept.push_back(a);
    if ((side_a > 0 && side_b < 0) || (side_a < 0 && side_b > 0)) {
      const Rational weight = side_a / (side_a - side_b);
      RationalPoint cut;
      for (std::size_t k = 0; k < 3; ++k) cut[k] = a[k] + (b[k] - a[k]) * weight;
      kept.push_back(cut);
    }
  }
  return kept;
}

/// @returns true where the triangle touches the closed cell (x, y, z), grown by `grown` on every side.
inline bool touches_cell(const std::array<RationalPoint, 3>& triangle, const std::array<int, 3>& cell,
                         const Rational& grown) {
  std::vector<RationalPoint> polygon(triangle.begin(), triangle.end());
  for (std::size_t axis = 0; axis < 3 && !polygon.empty(); ++axis) {
    polygon = cut_polygon(polygon, axis, 1, Rational(cell[axis]) - grown);
    if (!polygon.empty()) polygon = cut_polygon(polygon, axis, -1, Rational(cell[axis] + 1) + grown);
  }
  return !polygon.empty();
}

}  // namespace gridiron::test
