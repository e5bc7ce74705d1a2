// A ray's distance to a triangle as a fraction of integers, and what float it rounds to.
// Memory: 600 bytes by value, no heap. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <compare>
#include <cstdint>

#include "numeric/exact_numbers.h"

namespace gridiron::test {

/// Integer of up to 2048 bits. A determinant of three differences of floats has at most 837 in units of 2^-447, and
/// the product of two of them fits.
using WideInt = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<
    2048, 2048, boost::multiprecision::signed_magnitude, boost::multiprecision::unchecked, void>>;

/// How a distance is compared with a ray's limits, and rounded.
enum class Reading {
  kExact,     ///< limits: t_min < t <= t_max for the exact t. Floats: IEEE's nearest, ties to even, with denormals.
  kStandard,  ///< as core's `standard`: the limits hold for the float; halves away from zero; below the least normal
              ///< float 0, above the greatest one that.
};

/// The float that (quotient + a fraction of one, zero where !sticky) * 2^exponent reads as.
///
/// @param quotient  at least 2^25, so that what was cut off decides no more than a tie.
[[nodiscard]] float rounded_float(std::uint64_t quotient, int exponent, bool sticky, Reading reading);

/// The same for a double. Precondition: not negative, finite, 0 or normal.
[[nodiscard]] float rounded_float(double value, Reading reading);

/// An exact number not below 0.
struct ExactDistance {
  WideInt numerator;    ///< not negative
  WideInt denominator;  ///< positive; the fraction need not be in lowest terms

  [[nodiscard]] float rounded(Reading reading) const;
  [[nodiscard]] Rational rational() const;
  /// Doubles below and above, at most 2^-50 of the number apart, or both 0.
  [[nodiscard]] std::array<double, 2> bounds() const;

  friend std::strong_ordering operator<=>(const ExactDistance& a, const ExactDistance& b);
  friend bool operator==(const ExactDistance& a, const ExactDistance& b) { return (a <=> b) == 0; }
};

/// A float as such a number. Precondition: not negative, finite.
[[nodiscard]] ExactDistance exact_distance_of(float value);

}  // namespace gridiron::test
