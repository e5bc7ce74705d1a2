// Which cells a triangle touches, as rows of cells along x. Conservative: reports every cell whose closed box the
// triangle touches, and no cell whose box, grown by 2^-34 of a cell, it does not touch.
// Memory: stack. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>
#include <gridiron/base/records.h>
#include <gridiron/build/build_step.h>
#include <gridiron/build/grid/grid_builder.h>

#include <cstddef>
#include <cstdint>

namespace gridiron {

/// Why kCellPad is enough, with u = 2^-53 and coordinates of at most 2048 cells:
/// - A computed cell coordinate (p - minimum) * cells_per_unit has two roundings and no underflow: its error is at most
///   2048 * 2.01 u < 2^-40. Call the triangle of the computed corners T'. Every point of the true triangle has a
///   partner in T' within 2^-40 per axis (the same barycentric weights).
/// - A cut point of T' and a plane is r + (plane - s) * slope with plane between the ends of the edge: four roundings
///   of terms of at most 2048, an error below 2^-39. Exact comparisons decide which edge is cut. Two cuts follow each
///   other (z, then y): at most 2^-38.
/// - Every slab is grown, and every range widened, by kCellPad = 2^-36, more than the sum of all these errors.
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
  double low;
  double high;

  void include(double value) {
    low = value < low ? value : low;
    high = value > high ? value : high;
  }
};

/// dr / ds; 0 where s does not change.
inline double slope_of(double s0, double r0, double s1, double r1) {
  return s0 != s1 ? (r1 - r0) / (s1 - s0) : 0.0;
}

/// A triangle's corners in ascending order of one coordinate.
struct SortedCorners {
  int low, middle, high;

  explicit SortedCorners(const double s[3]) {
    const bool swap01 = s[1] < s[0];
    const int low01 = swap01 ? 1 : 0;
    const int high01 = swap01 ? 0 : 1;
    const bool second_lowest = s[2] < s[low01];
    low = second_lowest ? 2 : low01;
    const int rest = second_lowest ? low01 : 2;
    const bool swap_rest = s[rest] < s[high01];
    middle = swap_rest ? rest : high01;
    high = swap_rest ? high01 : rest;
  }
};

/// The two chains of a triangle's outline as functions of coordinate s: one edge from the lowest corner to the highest,
/// and two edges through the middle corner. r is another coordinate.
struct Chains {
  double s_low, s_middle, s_high, r_low, r_middle, r_high;
  double slope_long, slope_below, slope_above;

  Chains(const SortedCorners& corners, const double s[3], const double r[3])
      : s_low(s[corners.low]),
        s_middle(s[corners.middle]),
        s_high(s[corners.high]),
        r_low(r[corners.low]),
        r_middle(r[corners.middle]),
        r_high(r[corners.high]),
        slope_long(slope_of(s_low, r_low, s_high, r_high)),
        slope_below(slope_of(s_low, r_low, s_middle, r_middle)),
        slope_above(slope_of(s_middle, r_middle, s_high, r_high)) {}

  /// The long edge at a slab's lower and upper plane: r_low and r_high where s does not change at all.
  [[nodiscard]] double long_from(double at) const { return r_low + (at - s_low) * slope_long; }
  [[nodiscard]] double long_to(double at) const { return at < s_high ? r_low + (at - s_low) * slope_long : r_high; }
  [[nodiscard]] double middle_at(double at) const {
    const bool below = at < s_middle;
    return (below ? r_low : r_middle) + (at - (below ? s_low : s_middle)) * (below ? slope_below : slope_above);
  }
};

/// A convex polygon of at most five corners in order, in the plane of coordinates y and x.
struct Polygon {
  double y[5];
  double x[5];
  double slope[5];  ///< x per y along the edge from corner i to the next
  int count;

  void set_slopes() {
    for (int i = 0; i < count; ++i) {
      const int j = i + 1 < count ? i + 1 : 0;
      slope[i] = slope_of(y[i], x[i], y[j], x[j]);
    }
  }

  /// Range of x over the part with low <= y <= high; empty if there is no such part.
  [[nodiscard]] Range range_in_slab(double low, double high) const {
    Range range{kNothing, -kNothing};
    for (int i = 0; i < count; ++i) {
      const int j = i + 1 < count ? i + 1 : 0;
      // The edge's part within the slab: its ends, clamped. There is none if both ends lie beyond the same plane.
      const double start = y[i] < low ? low : y[i] > high ? high : y[i];
      const double end = y[j] < low ? low : y[j] > high ? high : y[j];
      const bool outside = (y[i] < low && y[j] < low) || (y[i] > high && y[j] > high);
      if (outside) continue;
      range.include(x[i] + (start - y[i]) * slope[i]);
      range.include(x[i] + (end - y[i]) * slope[i]);
    }
    return range;
  }
};

/// Which cells of a 2 x 2 square around the corner (corner_s, corner_r) a triangle touches. The triangle's range must
/// span both axes.
///
/// A quadrant is missed only if an edge's normal n separates it: n points into it, and the corner lies farther along n
/// than all of the triangle. Rounding: the edge is off by u of itself, the sums by less than 2^-49 |n|, and the partner
/// point by 2^-40 |n|, |n| = |n_s| + |n_r|; kCellPad |n| covers both.
/// @returns  bit 2 * (s is above) + (r is above).
inline std::uint32_t touched_quadrants(const double s[3], const double r[3], double corner_s, double corner_r) {
  const double area = (s[1] - s[0]) * (r[2] - r[0]) - (r[1] - r[0]) * (s[2] - s[0]);
  const double greatest = area > 0.0 ? area : 0.0;
  const double least = area > 0.0 ? 0.0 : area;
  std::uint32_t missed = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = i < 2 ? i + 1 : 0;
    const double n_r = s[j] - s[i];
    const double n_s = r[i] - r[j];
    const double margin = kCellPad * (__builtin_fabs(n_r) + __builtin_fabs(n_s));
    const double side = n_r * (corner_r - r[i]) + n_s * (corner_s - s[i]);
    const std::uint32_t ahead = static_cast<std::uint32_t>(n_s > 0.0) << 1 | static_cast<std::uint32_t>(n_r > 0.0);
    missed |= static_cast<std::uint32_t>(side > greatest + margin) << ahead;
    missed |= static_cast<std::uint32_t>(side < least - margin) << (3u - ahead);
  }
  return ~missed & 15u;
}

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

  [[nodiscard]] bool has_one_cell() const { return first[0] == last[0] && first[1] == last[1] && first[2] == last[2]; }
};

/// Calls row(first_x, last_x, y, z), bounds included, for every row of cells the triangle touches; each cell once.
///
/// @param cuts  adds what was cut for it.
/// Errors: none. Cost: O(slabs in z + rows), each with at most two cuts of the outline; no memory but the stack.
template <class Row>
inline void for_each_cell_row(const CellBox& box, CellCuts& cuts, Row&& row) {
  using namespace cell_rows_detail;
  const auto& p = box.p;
  const auto& first = box.first;
  const auto& last = box.last;
  // Bit i: axis i is wide, that is, its range has more than one cell. Kept as arithmetic: the classes are hard to
  // predict.
  const auto wide_bit = [&](int axis) { return static_cast<std::uint32_t>(first[axis] != last[axis]) << axis; };
  const std::uint32_t wide = wide_bit(0) | wide_bit(1) | wide_bit(2);

  // At most one wide axis: the triangle is connected, so it touches every cell of its box.
  if ((wide & (wide - 1)) == 0) {
    for (std::int32_t z = first[2]; z <= last[2]; ++z) {
      for (std::int32_t y = first[1]; y <= last[1]; ++y) row(first[0], last[0], y, z);
    }
    return;
  }

  // Two wide axes make a plane in which the third does not matter: `s` in slabs of one cell, `r` within them.
  const bool all_wide = wide == 7u;
  const int slab_axis = (wide & 4u) != 0 ? 2 : 1;
  const int range_axis = (wide & 1u) != 0 ? 0 : 1;
  const double* const s = p[slab_axis];
  const double* const r = p[range_axis];
  const auto emit = [&](std::int32_t slab, std::int32_t from, std::int32_t to) {
    if (range_axis == 0) {
      row(from, to, slab_axis == 1 ? slab : first[1], slab_axis == 1 ? first[2] : slab);
    } else {
      for (std::int32_t y = from; y <= to; ++y) row(first[0], first[0], y, slab);
    }
  };
  if (!all_wide && last[slab_axis] == first[slab_axis] + 1 && last[range_axis] == first[range_axis] + 1) {
    enter_step<GridStep::kSquareTest>();
    ++cuts.square_count;
    const std::uint32_t touched = touched_quadrants(s, r, last[slab_axis], last[range_axis]);
    const std::int32_t from = first[range_axis];
    for (std::int32_t i = 0; i < 2; ++i) {
      const std::uint32_t pair = touched >> (2 * i) & 3u;
      if (pair != 0) emit(first[slab_axis] + i, pair == 2 ? from + 1 : from, pair == 1 ? from : from + 1);
    }
    return;
  }

  // Larger: cut the outline into slabs and take the range of r in each.
  enter_step<GridStep::kOutline>();
  cuts.outline_count += all_wide ? 2 : 1;
  const SortedCorners corners(s);
  const double s_middle = s[corners.middle];
  // Cuts stay on the outline, also where rounding puts a slab's plane beyond its end.
  const auto clamped = [&](double at) {
    const double above = at > s[corners.low] ? at : s[corners.low];
    return above < s[corners.high] ? above : s[corners.high];
  };
  const auto lowest_in = [&](std::int32_t slab) { return clamped(slab - kCellPad); };
  const auto highest_in = [&](std::int32_t slab) { return clamped(slab + 1 + kCellPad); };
  if (!all_wide) {
    const Chains chains(corners, s, r);
    for (std::int32_t slab = first[slab_axis]; slab <= last[slab_axis]; ++slab) {
      enter_step<GridStep::kSlabCut>();
      ++cuts.slab_count;
      const double low = lowest_in(slab);
      const double high = highest_in(slab);
      const double start = chains.long_from(low);
      Range range{start, start};
      range.include(chains.long_to(high));
      range.include(chains.middle_at(low));
      range.include(chains.middle_at(high));
      range.include(low <= s_middle && s_middle <= high ? r[corners.middle] : start);
      const CellRange cells(range, first[range_axis], last[range_axis]);
      emit(slab, cells.first, cells.last);
    }
    return;
  }

  // Three wide axes: each slab of z is a polygon, cut into rows of y, and take the range of x.
  const Chains chains_y(corners, s, p[1]);
  const Chains chains_x(corners, s, p[0]);
  for (std::int32_t z = first[2]; z <= last[2]; ++z) {
    enter_step<GridStep::kPolygonCut>();
    ++cuts.polygon_count;
    const double low = lowest_in(z);
    const double high = highest_in(z);
    Polygon part;
    part.y[0] = chains_y.long_from(low);
    part.x[0] = chains_x.long_from(low);
    part.y[1] = chains_y.long_to(high);
    part.x[1] = chains_x.long_to(high);
    part.y[2] = chains_y.middle_at(high);
    part.x[2] = chains_x.middle_at(high);
    part.count = 3;
    if (low <= s_middle && s_middle <= high) {
      part.y[3] = p[1][corners.middle];
      part.x[3] = p[0][corners.middle];
      part.count = 4;
    }
    part.y[part.count] = chains_y.middle_at(low);
    part.x[part.count] = chains_x.middle_at(low);
    ++part.count;
    Range y_range{part.y[0], part.y[0]};
    Range x_range{part.x[0], part.x[0]};
    for (int i = 1; i < part.count; ++i) {
      y_range.include(part.y[i]);
      x_range.include(part.x[i]);
    }
    const CellRange rows(y_range, first[1], last[1]);
    const CellRange columns(x_range, first[0], last[0]);
    if (rows.first >= rows.last || columns.first >= columns.last) {  // connected: all of them
      for (std::int32_t y = rows.first; y <= rows.last; ++y) row(columns.first, columns.last, y, z);
      continue;
    }
    part.set_slopes();
    for (std::int32_t y = rows.first; y <= rows.last; ++y) {
      enter_step<GridStep::kPolygonRow>();
      ++cuts.polygon_row_count;
      const Range in_row = part.range_in_slab(y - kCellPad, y + 1 + kCellPad);
      if (in_row.low > in_row.high) continue;
      const CellRange cells(in_row, first[0], last[0]);
      row(cells.first, cells.last, y, z);
    }
  }
}

/// The same for those who do not count.
template <class Row>
inline void for_each_cell_row(const CellBox& box, Row&& row) {
  CellCuts cuts{};
  for_each_cell_row(box, cuts, row);
}

}  // namespace gridiron
