// Floats as integers times powers of two, and integers of any length: the base of every exact check of the tests.
// Bits are taken apart by integers: no rounding mode and no flushing of denormals reaches them.
// Memory: heap. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstdint>
#include <initializer_list>

namespace gridiron::test {

using BigInt = boost::multiprecision::cpp_int;
using Rational = boost::multiprecision::cpp_rational;

/// value = mantissa * 2^exponent, exactly; the mantissa is odd, or 0 with exponent 0.
struct Dyadic {
  std::int64_t mantissa = 0;
  int exponent = 0;

  /// Precondition: `value` is finite.
  explicit Dyadic(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t biased = (bits >> 23) & 0xFFu;
    const std::uint32_t magnitude = biased == 0 ? bits & 0x7FFFFFu : (bits & 0x7FFFFFu) | 0x800000u;
    if (magnitude == 0) return;
    const int zeros = std::countr_zero(magnitude);
    mantissa = static_cast<std::int64_t>(magnitude >> zeros);
    if ((bits >> 31) != 0) mantissa = -mantissa;
    exponent = (biased == 0 ? -149 : static_cast<int>(biased) - 150) + zeros;
  }

  /// value * 2^-unit. Precondition: unit <= exponent, or the value is 0.
  template <class Integer = BigInt>
  [[nodiscard]] Integer in_units_of(int unit) const {
    Integer result(mantissa);
    if (mantissa != 0) result <<= static_cast<unsigned>(exponent - unit);
    return result;
  }
};

/// The least exponent of some vectors of floats, so that all are integers in units of 2 to that power; 0 if all are 0.
inline int common_unit(std::initializer_list<const float*> vectors) {
  constexpr int kNone = 1000;
  int unit = kNone;
  for (const float* vector : vectors) {
    for (int axis = 0; axis < 3; ++axis) {
      const Dyadic value(vector[axis]);
      if (value.mantissa != 0 && value.exponent < unit) unit = value.exponent;
    }
  }
  return unit == kNone ? 0 : unit;
}

/// The same float as a double, even where the processor takes denormal floats for zero.
inline double exact_double(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  if ((bits & 0x7F800000u) != 0) return static_cast<double>(value);
  const double magnitude = static_cast<double>(bits & 0x7FFFFFu) * 0x1p-149;
  return (bits >> 31) != 0 ? -magnitude : magnitude;
}

inline bool is_finite(float value) {
  return (std::bit_cast<std::uint32_t>(value) & 0x7F800000u) != 0x7F800000u;
}

/// Exactly the float.
inline Rational exact_rational(float value) {
  const Dyadic dyadic(value);
  if (dyadic.exponent >= 0) return Rational(BigInt(BigInt(dyadic.mantissa) << static_cast<unsigned>(dyadic.exponent)));
  return Rational(BigInt(dyadic.mantissa), BigInt(BigInt(1) << static_cast<unsigned>(-dyadic.exponent)));
}

/// Greatest integer not above the quotient. Precondition: denominator > 0.
inline BigInt floor_of(const BigInt& numerator, const BigInt& denominator) {
  BigInt quotient, remainder;
  boost::multiprecision::divide_qr(numerator, denominator, quotient, remainder);
  return remainder < 0 ? BigInt(quotient - 1) : quotient;
}

}  // namespace gridiron::test
