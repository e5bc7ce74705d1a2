// Cells along a ray, exactly: see the header. SPDX-License-Identifier: Apache-2.0
#include "numeric/exact_cells.h"

#include "core/ray/exact_ray.h"

namespace gridiron::test {
namespace {

// With e = 2^-52, one rounding in any mode, none of these passes more than six roundings; 16 e is charged. No number
// comes near the ends of the range of doubles.
constexpr double kRoundingError = 0x1p-48;

// A parameter of the ray: where it crosses a plane of the grid, or one of its limits.
struct Moment {
  int axis;  // kLimit: a limit
  std::int32_t plane;
  float t;  // the limit
  double value, error;

  static constexpr int kLimit = -1;
};

class CellWalk {
 public:
  CellWalk(const GridRecord& grid, const OracleRay& ray, bool use_filter, CellCounts& counts)
      : grid_(grid), ray_(ray), use_filter_(use_filter), counts_(counts) {
    for (int axis = 0; axis < 3; ++axis) {
      minimum_[axis] = exact_double(grid.minimum[axis]);
      scale_[axis] = exact_double(grid.cells_per_unit[axis]);
      origin_[axis] = exact_double(ray.origin[axis]);
      direction_[axis] = exact_double(ray.direction[axis]);
      count_[axis] = static_cast<std::int32_t>(grid.cell_count[axis]);
    }
  }

  std::vector<CellIndex> walk() {
    CellSpan spans[3];
    if (!enter(spans)) return {};
    cells_.reserve(static_cast<std::size_t>(count_[0]) + static_cast<std::size_t>(count_[1]) +
                   static_cast<std::size_t>(count_[2]) + 8);
    emit(spans, nullptr);
    Moment next[3];
    std::int32_t current[3];
    for (int axis = 0; axis < 3; ++axis) {
      if (direction_[axis] == 0.0) continue;
      // On a face the ray goes on into the one behind it.
      current[axis] = is_upward(axis) ? spans[axis].last : spans[axis].first;
      if (current[axis] < 0 || current[axis] >= count_[axis]) return std::move(cells_);
      spans[axis] = {current[axis], current[axis]};
      next[axis] = crossing(axis, current[axis] + (is_upward(axis) ? 1 : 0));
    }
    const Moment end = limit(ray_.t_max);
    for (;;) {
      int first = -1;
      bool is_tied[3] = {};
      for (int axis = 0; axis < 3; ++axis) {
        if (direction_[axis] == 0.0) continue;
        const int order = first < 0 ? -1 : compare(next[axis], next[first]);
        if (order > 0) continue;
        if (order < 0) {
          std::fill(is_tied, is_tied + 3, false);
          first = axis;
        }
        is_tied[axis] = true;
      }
      if (first < 0 || compare(next[first], end) > 0) break;
      // At this point both cells next to each crossed plane are touched.
      bool leaves = false;
      const CellSpan before[3] = {spans[0], spans[1], spans[2]};
      for (int axis = 0; axis < 3; ++axis) {
        if (!is_tied[axis]) continue;
        current[axis] += is_upward(axis) ? 1 : -1;
        leaves = leaves || current[axis] < 0 || current[axis] >= count_[axis];
        spans[axis] = {std::min(spans[axis].first, current[axis]), std::max(spans[axis].last, current[axis])};
        next[axis] = crossing(axis, current[axis] + (is_upward(axis) ? 1 : 0));
      }
      emit(spans, before);
      if (leaves) break;
      for (int axis = 0; axis < 3; ++axis) {
        if (is_tied[axis]) spans[axis] = {current[axis], current[axis]};
      }
    }
    return std::move(cells_);
  }

 private:
  [[nodiscard]] bool is_upward(int axis) const { return direction_[axis] > 0.0; }

  [[nodiscard]] Moment crossing(int axis, std::int32_t plane) const {
    const double offset = plane / scale_[axis];
    return {axis, plane, 0.0f, (minimum_[axis] + offset - origin_[axis]) / direction_[axis],
            kRoundingError * (std::fabs(minimum_[axis]) + offset + std::fabs(origin_[axis])) /
                std::fabs(direction_[axis])};
  }

  [[nodiscard]] static Moment limit(float t) { return {Moment::kLimit, 0, t, exact_double(t), 0.0}; }

  const ExactRay& exact() {
    if (!exact_) exact_.emplace(grid_, ray_.origin, ray_.direction);
    return *exact_;
  }

  ExactRay::Parameter exact_parameter(const Moment& at) {
    return at.axis == Moment::kLimit ? exact().parameter(at.t)
                                     : exact().crossing(static_cast<std::uint32_t>(at.axis), at.plane);
  }

  int compare(const Moment& a, const Moment& b) {
    if (use_filter_) {
      const double apart = a.value - b.value;
      const double error = 2.0 * (a.error + b.error);
      if (apart > error) return 1;
      if (apart < -error) return -1;
      if (a.error == 0.0 && b.error == 0.0) return 0;
    }
    ++counts_.exact_orders;
    return ExactRay::compare(exact_parameter(a), exact_parameter(b));
  }

  // Finds the cells of the first point between the limits that lies in the grid, if there is one.
  bool enter(CellSpan spans[3]) {
    Moment first = limit(ray_.t_min);
    Moment last = limit(ray_.t_max);
    for (int axis = 0; axis < 3; ++axis) {
      if (direction_[axis] == 0.0) continue;
      const Moment in = crossing(axis, is_upward(axis) ? 0 : count_[axis]);
      const Moment out = crossing(axis, is_upward(axis) ? count_[axis] : 0);
      if (compare(in, first) > 0) first = in;
      if (compare(out, last) < 0) last = out;
    }
    if (compare(first, last) > 0) return false;
    for (int axis = 0; axis < 3; ++axis) {
      spans[axis] = cells_at(axis, first);
      // Along an axis on which the ray does not move, or where it enters by a face, some may lie outside.
      const CellSpan inside{std::max(spans[axis].first, 0), std::min(spans[axis].last, count_[axis] - 1)};
      if (inside.empty()) return false;
    }
    return true;
  }

  CellSpan cells_at(int axis, const Moment& at) {
    if (use_filter_) {
      const double place = ((origin_[axis] - minimum_[axis]) + at.value * direction_[axis]) * scale_[axis];
      const double error =
          2.0 * scale_[axis] *
          (kRoundingError * (std::fabs(origin_[axis]) + std::fabs(minimum_[axis]) +
                             std::fabs(at.value * direction_[axis])) +
           at.error * std::fabs(direction_[axis]));
      const double low = std::floor(place - error);
      if (low == std::floor(place + error) && low < place - error && low >= 0.0 && low < count_[axis]) {
        return {static_cast<std::int32_t>(low), static_cast<std::int32_t>(low)};
      }
    }
    ++counts_.exact_starts;
    return exact().cells_at(static_cast<std::uint32_t>(axis), exact_parameter(at));
  }

  // Appends the cells of the grid in a box, but for those of a box inside it.
  void emit(const CellSpan spans[3], const CellSpan* without) {
    const auto is_in = [](const CellSpan& span, std::int32_t cell) { return cell >= span.first && cell <= span.last; };
    for (std::int32_t z = std::max(spans[2].first, 0); z <= std::min(spans[2].last, count_[2] - 1); ++z) {
      for (std::int32_t y = std::max(spans[1].first, 0); y <= std::min(spans[1].last, count_[1] - 1); ++y) {
        for (std::int32_t x = std::max(spans[0].first, 0); x <= std::min(spans[0].last, count_[0] - 1); ++x) {
          if (without != nullptr && is_in(without[0], x) && is_in(without[1], y) && is_in(without[2], z)) continue;
          cells_.push_back({x, y, z});
          ++counts_.cells;
        }
      }
    }
  }

  const GridRecord& grid_;
  const OracleRay& ray_;
  bool use_filter_;
  CellCounts& counts_;
  double minimum_[3], scale_[3], origin_[3], direction_[3];
  std::int32_t count_[3];
  std::optional<ExactRay> exact_;
  std::vector<CellIndex> cells_;
};

}  // namespace

std::vector<CellIndex> touched_cells(const GridRecord& grid, const OracleRay& ray, bool use_filter,
                                     CellCounts* counts) {
  CellCounts work;
  std::vector<CellIndex> cells = CellWalk(grid, ray, use_filter, work).walk();
  if (counts != nullptr) {
    counts->cells += work.cells;
    counts->exact_orders += work.exact_orders;
    counts->exact_starts += work.exact_starts;
  }
  return cells;
}

}  // namespace gridiron::test
