// Where rays run through the cells of a grid, in integers without end: the oracle of frustum and slice walk.
// A float is an integer times a power of two, so cell space is too; nothing here rounds.
// Memory: heap. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>

#include "core/ray/packet_cases.h"
#include "numeric/exact_numbers.h"

namespace gridiron::test {

/// Cells along one axis, inclusive; empty where first > last.
struct CellSpan {
  std::int32_t first, last;
  [[nodiscard]] bool empty() const { return first > last; }
};

/// The cells a ray touches between two planes, as the box around that piece of it.
struct CellBox {
  CellSpan u, v;
};

/// A ray in the cell space of a grid, origin + s * direction with s >= 0.
class ExactRay {
 public:
  ExactRay(const GridRecord& grid, const float origin[3], const float direction[3]) {
    const int place_unit = common_unit({origin, grid.minimum});
    const int scale_unit = common_unit({grid.cells_per_unit});
    const int direction_unit = common_unit({direction});
    // One cell is `cell_` units of 2^(place_unit + scale_unit), or those are cells already.
    const int unit = place_unit + scale_unit;
    cell_ = unit < 0 ? BigInt(1) << static_cast<unsigned>(-unit) : BigInt(1);
    step_unit_ = direction_unit + scale_unit;
    for (int axis = 0; axis < 3; ++axis) {
      const BigInt scale = Dyadic(grid.cells_per_unit[axis]).in_units_of(scale_unit);
      const BigInt place =
          Dyadic(origin[axis]).in_units_of(place_unit) - Dyadic(grid.minimum[axis]).in_units_of(place_unit);
      place_[axis] = place * scale;
      if (unit > 0) place_[axis] <<= static_cast<unsigned>(unit);
      step_[axis] = Dyadic(direction[axis]).in_units_of(direction_unit) * scale;
      cells_[axis] = static_cast<std::int32_t>(grid.cell_count[axis]);
    }
  }

  /// One of the rays of a packet.
  template <class PacketType>
  ExactRay(const GridRecord& grid, const PacketType& packet, std::uint32_t ray)
      : ExactRay(grid, packet.origin, direction_of(packet, ray).data()) {}

  /// A parameter t as numerator / denominator * 2^n, n the same for all of a ray. The denominator is positive.
  struct Parameter {
    BigInt numerator, denominator;
  };
  /// Where the ray meets plane `plane` of an axis along which it moves.
  [[nodiscard]] Parameter crossing(std::uint32_t axis, std::int32_t plane) const {
    Parameter result{plane * cell_ - place_[axis], step_[axis] * cell_};
    if (result.denominator < 0) {
      result.numerator = -result.numerator;
      result.denominator = -result.denominator;
    }
    return result;
  }

  /// A parameter in the same terms.
  [[nodiscard]] Parameter parameter(float t) const {
    const Dyadic value(t);
    const int shift = value.exponent + step_unit_;
    if (shift >= 0) return {BigInt(value.mantissa) << static_cast<unsigned>(shift), 1};
    return {value.mantissa, BigInt(1) << static_cast<unsigned>(-shift)};
  }

  /// @returns -1, 0 or 1: the order of two such parameters.
  [[nodiscard]] static int compare(const Parameter& a, const Parameter& b) {
    return BigInt(a.numerator * b.denominator).compare(BigInt(b.numerator * a.denominator));
  }

  /// The one or two closed cells along `axis` that hold the ray's point at a parameter, not clipped to the grid but for
  /// numbers that lie outside of [-1, cell_count].
  [[nodiscard]] CellSpan cells_at(std::uint32_t axis, const Parameter& at) const {
    const BigInt place = place_[axis] * at.denominator + step_[axis] * cell_ * at.numerator;
    // In units of cell_ * at.denominator.
    const BigInt denominator = cell_ * at.denominator;
    const auto clipped = [&](const BigInt& cell) {
      if (cell < -1) return std::int32_t{-1};
      return cell > cells_[axis] ? cells_[axis] : static_cast<std::int32_t>(cell);
    };
    return {clipped(-floor_of(-place, denominator) - 1), clipped(floor_of(place, denominator))};
  }

  /// The closed cells of the plane u, v that the ray's piece with first <= k <= last + 1 touches, clipped to the grid:
  /// the box around the piece. Nothing where the ray has no such piece or it lies beside the grid.
  [[nodiscard]] std::optional<CellBox> box_between(std::uint32_t k, std::int32_t first, std::int32_t last) const {
    BigInt low = first * cell_;
    BigInt high = (last + 1) * cell_;
    if (step_[k] > 0) {
      if (place_[k] > high) return std::nullopt;
      if (place_[k] > low) low = place_[k];
    } else if (step_[k] < 0) {
      if (place_[k] < low) return std::nullopt;
      if (place_[k] < high) high = place_[k];
    } else {
      return std::nullopt;
    }
    const CellBox box{span_on((k + 1) % 3, k, low, high), span_on((k + 2) % 3, k, low, high)};
    if (box.u.empty() || box.v.empty()) return std::nullopt;
    return box;
  }

  /// @returns true where the ray reaches a point with first <= k <= last + 1 at a parameter of at most `t`.
  [[nodiscard]] bool reaches(std::uint32_t k, std::int32_t first, std::int32_t last, float t) const {
    const BigInt low = first * cell_;
    const BigInt high = (last + 1) * cell_;
    BigInt way;
    if (step_[k] > 0) {
      if (place_[k] > high) return false;
      way = low - place_[k];
    } else if (step_[k] < 0) {
      if (place_[k] < low) return false;
      way = place_[k] - high;
    } else {
      return false;
    }
    if (way <= 0) return true;
    // way / cell_ <= t * |step| * 2^step_unit_
    const Dyadic limit(t);
    BigInt march = limit.mantissa * abs(step_[k]) * cell_;
    const int shift = limit.exponent + step_unit_;
    if (shift >= 0) {
      march <<= static_cast<unsigned>(shift);
    } else {
      way <<= static_cast<unsigned>(-shift);
    }
    return way <= march;
  }

 private:
  // Cells of `axis` for k between two places, in units of cell_.
  [[nodiscard]] CellSpan span_on(std::uint32_t axis, std::uint32_t k, const BigInt& low, const BigInt& high) const {
    const BigInt size = abs(step_[k]);
    const BigInt slope = step_[k] > 0 ? step_[axis] : BigInt(-step_[axis]);
    const BigInt at_low = place_[axis] * size + (low - place_[k]) * slope;
    const BigInt at_high = place_[axis] * size + (high - place_[k]) * slope;
    const BigInt denominator = cell_ * size;
    const BigInt& least = at_low < at_high ? at_low : at_high;
    const BigInt& most = at_low < at_high ? at_high : at_low;
    if (most < 0 || least > cells_[axis] * denominator) return {1, 0};
    // A point on a face belongs to both cells: up to and with ceil(least) - 1.
    BigInt first = -floor_of(-least, denominator) - 1;
    BigInt last = floor_of(most, denominator);
    if (first < 0) first = 0;
    if (last > cells_[axis] - 1) last = cells_[axis] - 1;
    return {static_cast<std::int32_t>(first), static_cast<std::int32_t>(last)};
  }

  BigInt place_[3], step_[3], cell_;
  std::int32_t cells_[3];
  int step_unit_;
};

}  // namespace gridiron::test
