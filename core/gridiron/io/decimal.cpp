// Decimal text to numbers. The exact route is integer long division; the quick one a double with an error bound.
// Memory: stack. Threads: any. SPDX-License-Identifier: Apache-2.0
#include <gridiron/io/decimal.h>

#include <bit>

namespace gridiron {
namespace {

constexpr std::uint32_t kInfinityBits = 0x7F800000u;
constexpr int kMaxStoredDigits = 19;  // 10^19 - 1 fits 64 bits
constexpr int kExponentCap = 100000;  // beyond any exponent that matters, far from overflow

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

char lower(char c) {
  return (c >= 'A' && c <= 'Z') ? static_cast<char>(c - 'A' + 'a') : c;
}

// The value is +-mantissa * 10^exponent, plus less than one unit of the mantissa if it has kMaxStoredDigits digits.
struct Scan {
  std::uint64_t mantissa = 0;
  int exponent = 0;
  bool negative = false;
};

bool scan_decimal(const char* text, std::size_t text_bytes, Scan& scan) {
  if (text_bytes > kMaxDecimalBytes) return false;
  std::size_t i = 0;
  if (i < text_bytes && (text[i] == '+' || text[i] == '-')) {
    scan.negative = text[i] == '-';
    ++i;
  }
  int stored = 0;
  bool any = false;
  bool point = false;
  for (; i < text_bytes; ++i) {
    const char c = text[i];
    if (is_digit(c)) {
      any = true;
      if (stored < kMaxStoredDigits) {
        scan.mantissa = scan.mantissa * 10 + static_cast<std::uint64_t>(c - '0');
        if (scan.mantissa != 0) ++stored;
        if (point) --scan.exponent;
      } else {
        if (!point) ++scan.exponent;
      }
    } else if (c == '.' && !point) {
      point = true;
    } else {
      break;
    }
  }
  if (!any) return false;
  if (i == text_bytes) return true;

  if (text[i] != 'e' && text[i] != 'E') return false;
  ++i;
  bool negative_exponent = false;
  if (i < text_bytes && (text[i] == '+' || text[i] == '-')) {
    negative_exponent = text[i] == '-';
    ++i;
  }
  if (i == text_bytes) return false;
  int exponent = 0;
  for (; i < text_bytes; ++i) {
    if (!is_digit(text[i])) return false;
    if (exponent < kExponentCap) exponent = exponent * 10 + (text[i] - '0');
  }
  scan.exponent += negative_exponent ? -exponent : exponent;
  return true;
}

bool matches(const char* text, std::size_t text_bytes, const char* word) {
  std::size_t i = 0;
  while (i < text_bytes && word[i] != '\0' && lower(text[i]) == word[i]) ++i;
  return i == text_bytes && word[i] == '\0';
}

bool is_named(const char* text, std::size_t text_bytes) {
  if (text_bytes > 0 && (*text == '+' || *text == '-')) {
    ++text;
    --text_bytes;
  }
  if (matches(text, text_bytes, "inf") || matches(text, text_bytes, "infinity") || matches(text, text_bytes, "nan")) {
    return true;
  }
  return text_bytes > 4 && matches(text, 4, "nan(") && text[text_bytes - 1] == ')';
}

// Rounds (q + f) * 2^exponent with 0 <= f < 1, f > 0 exactly where sticky is set. Precondition: q >= 2^24.
std::uint32_t round_to_float(std::uint64_t q, int exponent, bool sticky) {
  const int width = static_cast<int>(std::bit_width(q));
  const int top = width - 1 + exponent;  // the value lies in [2^top, 2^(top + 1))
  if (top > 127) return kInfinityBits;
  const bool normal = top >= -126;
  const int kept = normal ? 24 : 150 + top;
  if (kept < 0) return 0;
  const int dropped = width - kept;
  const std::uint64_t half = std::uint64_t{1} << (dropped - 1);
  const std::uint64_t rest = q & (2 * half - 1);
  std::uint64_t mantissa = q >> dropped;
  if (rest > half || (rest == half && (sticky || (mantissa & 1) != 0))) ++mantissa;
  // A carry out of the mantissa goes into the exponent, which is correct, infinity included.
  const std::uint64_t base = normal ? static_cast<std::uint64_t>(top + 126) << 23 : 0;
  return static_cast<std::uint32_t>(base + mantissa);
}

// A natural number of at most 1,280 bits. Largest use: 10^302 or a number of 256 digits, aligned to each other.
class Natural {
 public:
  void multiply_add(std::uint32_t factor, std::uint32_t summand) {
    std::uint64_t carry = summand;
    for (int i = 0; i < count_; ++i) {
      carry += std::uint64_t{limbs_[i]} * factor;
      limbs_[i] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    if (carry != 0) limbs_[count_++] = static_cast<std::uint32_t>(carry);
  }

  void multiply_power_of_ten(int power) {
    for (; power >= 9; power -= 9) multiply_add(1000000000u, 0);
    for (; power > 0; --power) multiply_add(10, 0);
  }

  void shift_left(int bits) {
    const int limbs = bits / 32;
    const int rest = bits % 32;
    std::uint32_t above = 0;
    for (int i = count_ - 1; i >= 0; --i) {
      const std::uint64_t wide = std::uint64_t{limbs_[i]} << rest;
      limbs_[i + limbs + 1] = above | static_cast<std::uint32_t>(wide >> 32);
      above = static_cast<std::uint32_t>(wide);
    }
    limbs_[limbs] = above;
    for (int i = 0; i < limbs; ++i) limbs_[i] = 0;
    count_ += limbs + 1;
    trim();
  }

  [[nodiscard]] bool at_least(const Natural& other) const {
    if (count_ != other.count_) return count_ > other.count_;
    for (int i = count_ - 1; i >= 0; --i) {
      if (limbs_[i] != other.limbs_[i]) return limbs_[i] > other.limbs_[i];
    }
    return true;
  }

  // Precondition: at_least(other).
  void subtract(const Natural& other) {
    std::uint64_t borrow = 0;
    for (int i = 0; i < count_; ++i) {
      const std::uint64_t take = borrow + (i < other.count_ ? other.limbs_[i] : 0u);
      borrow = limbs_[i] < take ? 1 : 0;
      limbs_[i] = static_cast<std::uint32_t>((borrow << 32) + limbs_[i] - take);
    }
    trim();
  }

  [[nodiscard]] bool is_zero() const { return count_ == 0; }
  [[nodiscard]] int bit_width() const {
    return count_ == 0 ? 0 : 32 * (count_ - 1) + static_cast<int>(std::bit_width(limbs_[count_ - 1]));
  }

 private:
  static constexpr int kLimbCount = 40;

  void trim() {
    while (count_ > 0 && limbs_[count_ - 1] == 0) --count_;
  }

  std::uint32_t limbs_[kLimbCount];
  int count_ = 0;
};

// Magnitude of a number that scan_decimal has accepted, whatever its length.
std::uint32_t round_exactly(const char* text, std::size_t text_bytes) {
  Natural numerator;
  int digits = 0;  // of the numerator
  int exponent = 0;
  bool point = false;
  std::size_t i = 0;
  for (; i < text_bytes && text[i] != 'e' && text[i] != 'E'; ++i) {
    if (text[i] == '.') point = true;
    if (!is_digit(text[i])) continue;
    numerator.multiply_add(10, static_cast<std::uint32_t>(text[i] - '0'));
    if (!numerator.is_zero()) ++digits;
    if (point) --exponent;
  }
  if (i < text_bytes) {
    const bool negative = text[i + 1] == '-';
    int written = 0;
    for (++i; i < text_bytes; ++i) {
      if (is_digit(text[i]) && written < kExponentCap) written = written * 10 + (text[i] - '0');
    }
    exponent += negative ? -written : written;
  }
  // The value lies in [10^(digits + exponent - 1), 10^(digits + exponent)).
  if (numerator.is_zero() || digits + exponent <= -46) return 0;  // 10^-46 is below half the least denormal
  if (digits + exponent > 40) return kInfinityBits;

  Natural denominator;
  denominator.multiply_add(1, 1);
  if (exponent >= 0) {
    numerator.multiply_power_of_ten(exponent);
  } else {
    denominator.multiply_power_of_ten(-exponent);
  }
  // Align the leading bits, so that the quotient lies between 1/2 and 2, and take 27 bits of it.
  const int shift = denominator.bit_width() - numerator.bit_width();
  if (shift > 0) numerator.shift_left(shift);
  if (shift < 0) denominator.shift_left(-shift);
  constexpr int kQuotientBits = 27;
  std::uint64_t quotient = 0;
  for (int step = 0; step < kQuotientBits; ++step) {
    quotient <<= 1;
    if (numerator.at_least(denominator)) {
      numerator.subtract(denominator);
      quotient |= 1;
    }
    numerator.shift_left(1);
  }
  return round_to_float(quotient, -(kQuotientBits - 1) - shift, !numerator.is_zero());
}

// 10^power exactly; 0 <= power <= 22. Every partial product is exact, since 5^22 < 2^53.
double power_of_ten(int power) {
  double result = 1.0;
  if ((power & 1) != 0) result *= 1e1;
  if ((power & 2) != 0) result *= 1e2;
  if ((power & 4) != 0) result *= 1e4;
  if ((power & 8) != 0) result *= 1e8;
  if ((power & 16) != 0) result *= 1e16;
  return result;
}

// Takes the quick route where its error provably cannot change the rounded float; otherwise returns false.
bool round_quickly(const Scan& scan, std::uint32_t& magnitude) {
  const int power = scan.exponent < 0 ? -scan.exponent : scan.exponent;
  if (power > 44) return false;
  // Roundings: mantissa to double, and one or two operations. Each is half a unit, at most one unit after the scaling
  // by the quotient of the mantissas. Digits beyond the stored ones add 2^-59 of the value. Sixteen units bound the
  // sum.
  const bool exact = scan.mantissa <= (std::uint64_t{1} << 53) && power <= 22;
  double value = static_cast<double>(scan.mantissa);
  const double first = power_of_ten(power <= 22 ? power : 22);
  value = scan.exponent < 0 ? value / first : value * first;
  if (power > 22) {
    const double second = power_of_ten(power - 22);
    value = scan.exponent < 0 ? value / second : value * second;
  }
  if (!(value >= 1.2e-38)) return false;  // 1.02 times the least normal float
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(value);
  constexpr std::uint64_t kMiddle = std::uint64_t{1} << 28;  // of the 29 bits that a float lacks
  const std::uint64_t low = bits & (2 * kMiddle - 1);
  const std::uint64_t distance = low > kMiddle ? low - kMiddle : kMiddle - low;
  if (distance <= (exact ? 0u : 16u)) return false;
  constexpr std::uint64_t kBiasDifference = std::uint64_t{1023 - 127} << 23;
  const std::uint64_t rounded = ((bits + kMiddle) >> 29) - kBiasDifference;
  magnitude = rounded < kInfinityBits ? static_cast<std::uint32_t>(rounded) : kInfinityBits;
  return true;
}

}  // namespace

DecimalStatus parse_float(const char* text, std::size_t text_bytes, std::uint32_t& float_bits) {
  Scan scan;
  if (!scan_decimal(text, text_bytes, scan)) {
    return is_named(text, text_bytes) ? DecimalStatus::kNotFinite : DecimalStatus::kSyntax;
  }
  std::uint32_t magnitude = 0;
  if (scan.mantissa != 0 && !round_quickly(scan, magnitude)) magnitude = round_exactly(text, text_bytes);
  if (magnitude >= kInfinityBits) return DecimalStatus::kNotFinite;
  float_bits = magnitude | (scan.negative ? 0x80000000u : 0u);
  return DecimalStatus::kOk;
}

DecimalStatus parse_integer(const char* text, std::size_t text_bytes, std::int64_t& value) {
  std::size_t i = 0;
  bool negative = false;
  if (i < text_bytes && (text[i] == '+' || text[i] == '-')) {
    negative = text[i] == '-';
    ++i;
  }
  if (i == text_bytes) return DecimalStatus::kSyntax;
  const std::uint64_t limit = (std::uint64_t{1} << 63) - (negative ? 0u : 1u);
  std::uint64_t magnitude = 0;
  bool fits = true;
  for (; i < text_bytes; ++i) {
    if (!is_digit(text[i])) return DecimalStatus::kSyntax;
    const std::uint64_t digit = static_cast<std::uint64_t>(text[i] - '0');
    if (!fits || magnitude > (limit - digit) / 10) {
      fits = false;
    } else {
      magnitude = magnitude * 10 + digit;
    }
  }
  if (!fits) return DecimalStatus::kRange;
  value = static_cast<std::int64_t>(negative ? ~magnitude + 1 : magnitude);
  return DecimalStatus::kOk;
}

bool is_number(const char* text, std::size_t text_bytes) {
  Scan scan;
  return scan_decimal(text, text_bytes, scan) || is_named(text, text_bytes);
}

std::uint32_t float_bits_from_double_bits(std::uint64_t double_bits) {
  const std::uint32_t sign = static_cast<std::uint32_t>(double_bits >> 32) & 0x80000000u;
  const int biased = static_cast<int>((double_bits >> 52) & 0x7FF);
  const std::uint64_t fraction = double_bits & ((std::uint64_t{1} << 52) - 1);
  if (biased == 0x7FF) return sign | kInfinityBits | (fraction != 0 ? 0x00400000u : 0u);
  if (biased == 0) return sign;  // zero, or a denormal double: far below the least float
  return sign | round_to_float(fraction | (std::uint64_t{1} << 52), biased - 1075, false);
}

}  // namespace gridiron
