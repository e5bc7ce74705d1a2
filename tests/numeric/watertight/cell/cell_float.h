// CellFloat, CellDouble: numbers with the rules of the Cell's SPU, in software, from the public instruction set manual.
// A float has no denormals, no infinity and no NaN: an exponent of 255 is one more binade of numbers. Results are
// rounded to zero, those beyond the range become the largest number, those below it +0; a result of zero is +0. A
// double is IEEE's, to nearest; denormals that go in count as zero. Memory: 4 and 8 bytes by value. Threads: any.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <compare>
#include <concepts>
#include <cstdint>

namespace watertight {

class CellDouble;

class CellFloat {
 public:
  CellFloat() = default;
  /// A constant, or a number that comes from elsewhere: the same bits.
  constexpr CellFloat(float same_bits) : bits_(std::bit_cast<std::uint32_t>(same_bits)) {}
  CellFloat(double) = delete;  // what a chip would do in double is not to be done in float
  template <std::integral Integer>
  constexpr CellFloat(Integer value) : CellFloat(truncated(static_cast<double>(value))) {}
  constexpr explicit CellFloat(const CellDouble& value);

  [[nodiscard]] static constexpr CellFloat from_bits(std::uint32_t bits) {
    CellFloat result;
    result.bits_ = bits;
    return result;
  }
  [[nodiscard]] constexpr std::uint32_t bits() const { return bits_; }
  [[nodiscard]] constexpr float same_bits() const { return std::bit_cast<float>(bits_); }

  /// The number that the bits stand for.
  [[nodiscard]] constexpr double value() const {
    const std::uint32_t exponent = bits_ >> 23 & 0xFFu;
    if (exponent == 0) return 0.0;
    const std::uint64_t sign = std::uint64_t{bits_ >> 31} << 63;
    return std::bit_cast<double>(sign | std::uint64_t{exponent + (1023 - 127)} << 52 |
                                 std::uint64_t{bits_ & 0x7FFFFFu} << 29);
  }

  /// The whole part, where 32 bits hold it.
  constexpr explicit operator std::int32_t() const { return static_cast<std::int32_t>(value()); }

  friend constexpr CellFloat operator+(CellFloat a, CellFloat b) { return sum(a.value(), b.value()); }
  friend constexpr CellFloat operator-(CellFloat a, CellFloat b) { return sum(a.value(), -b.value()); }
  /// 48 bits: exact in double.
  friend constexpr CellFloat operator*(CellFloat a, CellFloat b) { return truncated(a.value() * b.value()); }
  /// A quotient of two mantissas of 24 bits that is no float differs from every float by 2^-48 of itself at least: a
  /// double cannot have been rounded to one. The chip divides by a sequence of instructions; this is the best of them.
  friend constexpr CellFloat operator/(CellFloat a, CellFloat b) {
    if (b.value() == 0.0) {
      return a.value() == 0.0 ? from_bits(0) : from_bits(((a.bits_ ^ b.bits_) & kSign) | kLargest);
    }
    return truncated(a.value() / b.value());
  }
  /// The sign's bit, also of a zero.
  friend constexpr CellFloat operator-(CellFloat a) { return from_bits(a.bits_ ^ kSign); }

  constexpr CellFloat& operator+=(CellFloat other) { return *this = *this + other; }
  constexpr CellFloat& operator-=(CellFloat other) { return *this = *this - other; }
  constexpr CellFloat& operator*=(CellFloat other) { return *this = *this * other; }

  friend constexpr bool operator==(CellFloat a, CellFloat b) { return a.value() == b.value(); }
  friend constexpr auto operator<=>(CellFloat a, CellFloat b) { return a.value() <=> b.value(); }

  /// The part of a double that a float holds, see above.
  [[nodiscard]] static constexpr CellFloat truncated(double value) {
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(value);
    const std::uint32_t sign = static_cast<std::uint32_t>(bits >> 32) & kSign;
    const int exponent = static_cast<int>(bits >> 52 & 0x7FFu) - (1023 - 127);
    if (exponent <= 0) return from_bits(0);
    if (exponent > 255) return from_bits(sign | kLargest);
    return from_bits(sign | static_cast<std::uint32_t>(exponent) << 23 |
                     (static_cast<std::uint32_t>(bits >> 29) & 0x7FFFFFu));
  }

 private:
  static constexpr std::uint32_t kSign = 0x80000000u;
  static constexpr std::uint32_t kLargest = 0x7FFFFFFFu;

  // The double nearest to the sum may be a float that lies farther from 0 than the sum: then it is the one before that
  // counts. Knuth's two-sum tells.
  [[nodiscard]] static constexpr CellFloat sum(double a, double b) {
    const double near = a + b;
    std::uint64_t bits = std::bit_cast<std::uint64_t>(near);
    if ((bits & 0x1FFFFFFFu) == 0) {
      const double b_part = near - a;
      const double rest = (a - (near - b_part)) + (b - b_part);
      if (rest != 0.0 && (rest < 0.0) != (near < 0.0)) --bits;
    }
    return truncated(std::bit_cast<double>(bits));
  }

  std::uint32_t bits_;
};
static_assert(sizeof(CellFloat) == 4);

class CellDouble {
 public:
  CellDouble() = default;
  constexpr CellDouble(double value) : value_(value) {}
  /// The conversion knows IEEE's floats, denormals as zero: an exponent of 255 is no number to it.
  constexpr CellDouble(CellFloat value)
      : value_((value.bits() >> 23 & 0xFFu) == 255 ? double{value.same_bits()} : value.value()) {}

  [[nodiscard]] constexpr double value() const { return value_; }

  friend constexpr CellDouble operator+(CellDouble a, CellDouble b) { return a.operand() + b.operand(); }
  friend constexpr CellDouble operator-(CellDouble a, CellDouble b) { return a.operand() - b.operand(); }
  friend constexpr CellDouble operator*(CellDouble a, CellDouble b) { return a.operand() * b.operand(); }
  friend constexpr CellDouble operator/(CellDouble a, CellDouble b) { return a.operand() / b.operand(); }
  friend constexpr CellDouble operator-(CellDouble a) { return -a.value_; }

  constexpr CellDouble& operator+=(CellDouble other) { return *this = *this + other; }
  constexpr CellDouble& operator-=(CellDouble other) { return *this = *this - other; }
  constexpr CellDouble& operator*=(CellDouble other) { return *this = *this * other; }

  friend constexpr bool operator==(CellDouble a, CellDouble b) { return a.operand() == b.operand(); }
  friend constexpr auto operator<=>(CellDouble a, CellDouble b) { return a.operand() <=> b.operand(); }

 private:
  [[nodiscard]] constexpr double operand() const {
    const bool is_denormal = (std::bit_cast<std::uint64_t>(value_) >> 52 & 0x7FFu) == 0;
    return is_denormal ? 0.0 : value_;
  }

  double value_;
};

/// To nearest; a result below the least normal float is +0.
constexpr CellFloat::CellFloat(const CellDouble& value)
    : bits_(std::bit_cast<std::uint32_t>(static_cast<float>(value.value()))) {
  if ((bits_ >> 23 & 0xFFu) == 0) bits_ = 0;
}

}  // namespace watertight
