// Which cells a triangle touches, as rows of cells along x. Conservative: every cell whose closed box the triangle
// touches is reported, and no cell whose box, grown by 2^-34 of a cell, it does not touch.
// Memory: stack. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>
#include <gridiron/base/records.h>

#include <cstddef>
#include <cstdint>

namespace gridiron {

/// Why kCellPad is enough, with u = 2^-53 and coordinates of at most 2048 cells:
/// - A computed cell coordinate (p - minimum) * cells_per_unit has two roundings and no underflow: it is off by at most
///   2048 * 2.01 u < 2^-40. Call the triangle of the computed corners T'. Every point of the true triangle has a
///   partner in T' within 2^-40 per axis (the same barycentric weights).
/// - T' is cut at planes with exact comparisons, so which edges are cut is decided without error. A cut point is
///   r + (plane - s) * slope, four roundings of terms of at most 2048, and its weight lies in [0, 1]: off by < 2^-39.
///   Two cuts follow each other (z, then y): at most 2^-38.
/// - Every slab is grown, and every range widened, by kCellPad = 2^-36, more than the sum of it all.
inline constexpr double kCellPad = 0x1p-36;

/// World space to cell space, and the last cell of each axis.
struct CellSpace {
  double minimum[3];
  double cells_per_unit[3];
  std::int32_t last_cell[3];

  [[nodiscard]] static CellSpace of(const GridRecord& grid) {
    CellSpace space{};
    for (int axis = 0; axis < 3; ++axis) {
      space.minimum[axis] = double{grid.minimum[axis]};
      space.cells_per_unit[axis] = double{grid.cells_per_unit[axis]};
      space.last_cell[axis] = static_cast<std::int32_t>(grid.cell_count[axis]) - 1;
    }
    return space;
  }
};

namespace cell_rows_detail {

inline constexpr double kNothing = 1e300;  ///< beyond every coordinate

struct Range {
  double low = kNothing;
  double high = -kNothing;

  void include(bool wanted, double value) {
    const double for_low = wanted ? value : kNothing;
    const double for_high = wanted ? value : -kNothing;
    low = for_low < low ? for_low : low;
    high = for_high > high ? for_high : high;
  }
  [[nodiscard]] bool empty() const { return low > high; }
};

/// A convex outline in the plane of axes s and r, kMaxPoints corners in order.
template <std::size_t kMaxPoints>
struct Outline {
  double s[kMaxPoints];
  double r[kMaxPoints];
  double slope[kMaxPoints];  ///< r per s along the edge from corner i to the next; 0 where s does not change

  static double slope_of(double s0, double r0, double s1, double r1) { return s0 != s1 ? (r1 - r0) / (s1 - s0) : 0.0; }

  void set_slopes(int count) {
    for (int i = 0; i < count; ++i) {
      const int j = i + 1 < count ? i + 1 : 0;
      slope[i] = slope_of(s[i], r[i], s[j], r[j]);
    }
  }

  /// Range of r over the part with low <= s <= high.
  [[nodiscard]] Range range_in_slab(int count, double low, double high) const {
    Range range;
    for (int i = 0; i < count; ++i) {
      const int j = i + 1 < count ? i + 1 : 0;
      range.include(s[i] >= low && s[i] <= high, r[i]);
      range.include((s[i] < low) != (s[j] < low), r[i] + (low - s[i]) * slope[i]);
      range.include((s[i] > high) != (s[j] > high), r[i] + (high - s[i]) * slope[i]);
    }
    return range;
  }
};

/// Cells that the closed range touches, within [first, last].
struct CellRange {
  std::int32_t first, last;

  CellRange(const Range& range, std::int32_t least, std::int32_t greatest)
      : first(static_cast<std::int32_t>(range.low - kCellPad)), last(static_cast<std::int32_t>(range.high + kCellPad)) {
    first = first < least ? least : first;
    last = last > greatest ? greatest : last;
  }
};

}  // namespace cell_rows_detail

/// A triangle's corners in cell space and the box of cells around it.
struct CellBox {
  double p[3][3];  ///< [axis][corner]
  std::int32_t first[3];
  std::int32_t last[3];

  /// @param a, b, c  corners in world space, finite, inside the grid: 0 <= cell coordinate <= cell count as real
  /// numbers.
  [[nodiscard]] static CellBox of(const CellSpace& space, const Vec3& a, const Vec3& b, const Vec3& c) {
    CellBox box;
    for (int axis = 0; axis < 3; ++axis) {
      const double p0 = (double{a[axis]} - space.minimum[axis]) * space.cells_per_unit[axis];
      const double p1 = (double{b[axis]} - space.minimum[axis]) * space.cells_per_unit[axis];
      const double p2 = (double{c[axis]} - space.minimum[axis]) * space.cells_per_unit[axis];
      box.p[axis][0] = p0;
      box.p[axis][1] = p1;
      box.p[axis][2] = p2;
      const double low01 = p0 < p1 ? p0 : p1;
      const double high01 = p0 < p1 ? p1 : p0;
      // The closed box [i, i + 1] meets [low, high] only if i <= high and i + 1 >= low. With the pad above the rounding
      // error, truncation of low - pad is the least such i, and a negative value truncates to 0.
      box.first[axis] = static_cast<std::int32_t>((low01 < p2 ? low01 : p2) - kCellPad);
      const std::int32_t end = static_cast<std::int32_t>((high01 > p2 ? high01 : p2) + kCellPad);
      box.last[axis] = end < space.last_cell[axis] ? end : space.last_cell[axis];
    }
    return box;
  }
};

/// Calls row(first_x, last_x, y, z), bounds included, for every row of cells the triangle touches; each cell once.
///
/// Errors: none. Cost: O(slabs in z + rows), each with at most two cuts of the outline; no memory but the stack.
template <class Row>
inline void for_each_cell_row(const CellBox& box, Row&& row) {
  using namespace cell_rows_detail;
  const auto& p = box.p;
  const auto& first = box.first;
  const auto& last = box.last;
  const bool wide_x = first[0] != last[0];
  const bool wide_y = first[1] != last[1];
  const bool wide_z = first[2] != last[2];

  // One wide axis: the triangle is connected, so it touches every cell of its box.
  if (static_cast<int>(wide_x) + static_cast<int>(wide_y) + static_cast<int>(wide_z) <= 1) {
    for (std::int32_t z = first[2]; z <= last[2]; ++z) {
      for (std::int32_t y = first[1]; y <= last[1]; ++y) row(first[0], last[0], y, z);
    }
    return;
  }

  // Two wide axes: cut the outline in their plane into slabs of one, take the range of the other.
  if (!(wide_x && wide_y && wide_z)) {
    const int slab_axis = wide_z ? 2 : 1;
    const int range_axis = wide_x ? 0 : 1;
    Outline<3> outline;
    for (int i = 0; i < 3; ++i) {
      outline.s[i] = p[slab_axis][i];
      outline.r[i] = p[range_axis][i];
    }
    outline.set_slopes(3);
    for (std::int32_t slab = first[slab_axis]; slab <= last[slab_axis]; ++slab) {
      const Range range = outline.range_in_slab(3, slab - kCellPad, slab + 1 + kCellPad);
      if (range.empty()) continue;
      const CellRange cells(range, first[range_axis], last[range_axis]);
      if (slab_axis == 1) {
        row(cells.first, cells.last, slab, first[2]);
      } else if (range_axis == 0) {
        row(cells.first, cells.last, first[1], slab);
      } else {
        for (std::int32_t y = cells.first; y <= cells.last; ++y) row(first[0], last[0], y, slab);
      }
    }
    return;
  }

  // Three: cut into slabs of z, each slab's polygon into rows of y, and take the range of x.
  double slope_y[3];
  double slope_x[3];
  for (int i = 0; i < 3; ++i) {
    const int j = i < 2 ? i + 1 : 0;
    slope_y[i] = Outline<3>::slope_of(p[2][i], p[1][i], p[2][j], p[1][j]);
    slope_x[i] = Outline<3>::slope_of(p[2][i], p[0][i], p[2][j], p[0][j]);
  }
  for (std::int32_t z = first[2]; z <= last[2]; ++z) {
    const double low = z - kCellPad;
    const double high = z + 1 + kCellPad;
    Outline<6> part;  // s = y, r = x; each of the two planes adds at most one corner to the three
    int count = 0;
    Range y_range;
    const auto add = [&](double y, double x) {
      part.s[count] = y;
      part.r[count] = x;
      ++count;
      y_range.include(true, y);
    };
    for (int i = 0; i < 3; ++i) {
      const int j = i < 2 ? i + 1 : 0;
      const double zi = p[2][i];
      const double zj = p[2][j];
      const auto cut = [&](double plane) {
        add(p[1][i] + (plane - zi) * slope_y[i], p[0][i] + (plane - zi) * slope_x[i]);
      };
      if (zi >= low && zi <= high) add(p[1][i], p[0][i]);
      const bool cuts_low = (zi < low) != (zj < low);
      const bool cuts_high = (zi > high) != (zj > high);
      if (cuts_low && zi < low) cut(low);
      if (cuts_high) cut(high);
      if (cuts_low && zi >= low) cut(low);
    }
    if (count == 0) continue;
    const CellRange rows(y_range, first[1], last[1]);
    if (rows.first == rows.last) {
      Range x_range;
      for (int i = 0; i < count; ++i) x_range.include(true, part.r[i]);
      const CellRange cells(x_range, first[0], last[0]);
      row(cells.first, cells.last, rows.first, z);
      continue;
    }
    part.set_slopes(count);
    for (std::int32_t y = rows.first; y <= rows.last; ++y) {
      const Range x_range = part.range_in_slab(count, y - kCellPad, y + 1 + kCellPad);
      if (x_range.empty()) continue;
      const CellRange cells(x_range, first[0], last[0]);
      row(cells.first, cells.last, y, z);
    }
  }
}

}  // namespace gridiron
