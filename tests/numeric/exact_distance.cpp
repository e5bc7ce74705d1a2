// Distances as fractions: see the header. SPDX-License-Identifier: Apache-2.0
#include "numeric/exact_distance.h"

#include <bit>
#include <cmath>
#include <limits>

namespace gridiron::test {
namespace {

// value = (quotient + fraction) * 2^exponent, 2^62 <= quotient < 2^64, fraction in [0, 1), 0 where !sticky.
struct Quotient {
  std::uint64_t quotient;
  int exponent;
  bool sticky;
};

int width_of(const WideInt& value) {
  return static_cast<int>(boost::multiprecision::msb(value)) + 1;
}

Quotient divide(WideInt numerator, WideInt denominator) {
  // A numerator of 63 bits more than the denominator makes a quotient of 63 or 64.
  const int exponent = width_of(numerator) - width_of(denominator) - 63;
  if (exponent < 0) {
    numerator <<= static_cast<unsigned>(-exponent);
  } else {
    denominator <<= static_cast<unsigned>(exponent);
  }
  WideInt quotient, remainder;
  boost::multiprecision::divide_qr(numerator, denominator, quotient, remainder);
  return {static_cast<std::uint64_t>(quotient), exponent, remainder != 0};
}

}  // namespace

float rounded_float(std::uint64_t quotient, int exponent, bool sticky, Reading reading) {
  constexpr int kFloatBits = 24;
  constexpr int kLeastUnit = -149;
  const int width = 64 - std::countl_zero(quotient);
  // The last place of the result has weight 2^unit.
  int unit = exponent + width - kFloatBits;
  if (reading == Reading::kExact && unit < kLeastUnit) unit = kLeastUnit;
  const int shift = unit - exponent;  // at least 2
  if (shift > 64) return 0.0f;
  std::uint64_t kept = shift == 64 ? 0 : quotient >> shift;
  const std::uint64_t half = std::uint64_t{1} << (shift - 1);
  const std::uint64_t rest = quotient & (half + (half - 1));
  const bool is_tie = rest == half && !sticky;
  if (rest > half || (rest == half && sticky) || (is_tie && (reading == Reading::kStandard || kept % 2 != 0))) ++kept;
  if (kept == std::uint64_t{1} << kFloatBits) {
    kept /= 2;
    ++unit;
  }
  if (kept < std::uint64_t{1} << (kFloatBits - 1)) return std::bit_cast<float>(static_cast<std::uint32_t>(kept));
  const int biased = unit - kLeastUnit + 1;
  if (biased >= 255) {
    return reading == Reading::kStandard ? std::numeric_limits<float>::max() : std::numeric_limits<float>::infinity();
  }
  if (biased < 1) return 0.0f;
  return std::bit_cast<float>(static_cast<std::uint32_t>(biased) << 23 |
                              (static_cast<std::uint32_t>(kept) & 0x7FFFFFu));
}

float rounded_float(double value, Reading reading) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  if (bits == 0) return 0.0f;
  const std::uint64_t mantissa = (bits & ((std::uint64_t{1} << 52) - 1)) | std::uint64_t{1} << 52;
  return rounded_float(mantissa, static_cast<int>(bits >> 52 & 0x7FF) - 1075, false, reading);
}

float ExactDistance::rounded(Reading reading) const {
  if (numerator == 0) return 0.0f;
  const Quotient found = divide(numerator, denominator);
  return rounded_float(found.quotient, found.exponent, found.sticky, reading);
}

Rational ExactDistance::rational() const {
  return {BigInt(numerator), BigInt(denominator)};
}

std::array<double, 2> ExactDistance::bounds() const {
  if (numerator == 0) return {0.0, 0.0};
  const Quotient found = divide(numerator, denominator);
  // 53 bits convert exactly.
  const std::uint64_t kept = found.quotient >> 11;
  return {std::ldexp(static_cast<double>(kept), found.exponent + 11),
          std::ldexp(static_cast<double>(kept + 1), found.exponent + 11)};
}

std::strong_ordering operator<=>(const ExactDistance& a, const ExactDistance& b) {
  const int order = WideInt(a.numerator * b.denominator).compare(WideInt(b.numerator * a.denominator));
  return order <=> 0;
}

ExactDistance exact_distance_of(float value) {
  const Dyadic dyadic(value);
  const int unit = dyadic.exponent < 0 ? dyadic.exponent : 0;
  return {dyadic.in_units_of<WideInt>(unit), WideInt(1) << static_cast<unsigned>(-unit)};
}

}  // namespace gridiron::test
