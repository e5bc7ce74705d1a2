// Where rays run through the cells of a grid, in integers without end: the oracle of frustum and walks.
// A float is an integer times a power of two, so cell space is too; nothing here rounds.
// Memory: heap. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <optional>

namespace gridiron::test {

using BigInt = boost::multiprecision::cpp_int;

/// Cells along one axis, inclusive; empty where first > last.
struct CellSpan {
  std::int32_t first, last;
  [[nodiscard]] bool empty() const { return first > last; }
};

/// The cells a ray touches between two planes, as the box around that piece of it.
struct CellBox {
  CellSpan u, v;
};

namespace exact_detail {

/// value = mantissa * 2^exponent, exactly.
struct Dyadic {
  std::int64_t mantissa;
  int exponent;

  explicit Dyadic(float value) {
    int power = 0;
    const float fraction = std::frexp(value, &power);
    mantissa = static_cast<std::int64_t>(std::ldexp(fraction, 24));
    exponent = power - 24;
    while (mantissa != 0 && mantissa % 2 == 0) {
      mantissa /= 2;
      ++exponent;
    }
  }
  /// value * 2^-unit. Precondition: unit <= exponent, or the value is 0.
  [[nodiscard]] BigInt in_units_of(int unit) const {
    return mantissa == 0 ? BigInt(0) : BigInt(mantissa) << static_cast<unsigned>(exponent - unit);
  }
};

/// The least exponent of some floats, so that all are integers in units of 2 to that power.
inline int common_unit(std::initializer_list<const float*> vectors) {
  int unit = 1000;
  for (const float* vector : vectors) {
    for (int axis = 0; axis < 3; ++axis) {
      const Dyadic value(vector[axis]);
      if (value.mantissa != 0 && value.exponent < unit) unit = value.exponent;
    }
  }
  return unit == 1000 ? 0 : unit;
}

inline BigInt floor_of(const BigInt& numerator, const BigInt& denominator) {
  BigInt quotient, remainder;
  boost::multiprecision::divide_qr(numerator, denominator, quotient, remainder);
  return remainder < 0 ? BigInt(quotient - 1) : quotient;
}

}  // namespace exact_detail

/// A ray in the cell space of a grid, origin + s * direction with s >= 0.
class ExactRay {
 public:
  ExactRay(const GridRecord& grid, const float origin[3], const float direction[3]) {
    using exact_detail::Dyadic;
    const int place_unit = exact_detail::common_unit({origin, grid.minimum});
    const int scale_unit = exact_detail::common_unit({grid.cells_per_unit});
    const int direction_unit = exact_detail::common_unit({direction});
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
    const exact_detail::Dyadic limit(t);
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
    BigInt first = -exact_detail::floor_of(-least, denominator) - 1;
    BigInt last = exact_detail::floor_of(most, denominator);
    if (first < 0) first = 0;
    if (last > cells_[axis] - 1) last = cells_[axis] - 1;
    return {static_cast<std::int32_t>(first), static_cast<std::int32_t>(last)};
  }

  BigInt place_[3], step_[3], cell_;
  std::int32_t cells_[3];
  int step_unit_;
};

}  // namespace gridiron::test
