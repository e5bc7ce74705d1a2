// Exact signs and distances: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/exact_sum.h>

#include <bit>

namespace gridiron {
namespace {

constexpr int kFloatLowestExponent = -149;

struct Decomposed {
  std::uint32_t mantissa;
  int exponent;  ///< value = +-mantissa * 2^exponent
  bool negative;
};

Decomposed decompose(float value) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t biased = (bits >> 23) & 0xFFu;
  const std::uint32_t fraction = bits & 0x7FFFFFu;
  if (biased == 0) return {fraction, kFloatLowestExponent, (bits >> 31) != 0};
  return {fraction | 0x800000u, static_cast<int>(biased) - 150, (bits >> 31) != 0};
}

// Adds limb * 2^(32 index + shift) to a magnitude whose bits there are still zero or come from lower limbs.
void shift_in(std::uint32_t* out, int shift, int index, std::uint64_t limb) {
  const int base = index + shift / 32;
  const std::uint64_t moved = limb << (shift % 32);
  out[base] |= static_cast<std::uint32_t>(moved);
  out[base + 1] |= static_cast<std::uint32_t>(moved >> 32);
}

// Compares numerator with denominator * mantissa * 2^exponent, all non-negative, -160 <= exponent <= 128.
// The window is wide enough for a shift of one operand by any float exponent.
int compare_with_multiple(const ExactSum& numerator, const ExactSum& denominator, std::uint32_t mantissa,
                          int exponent) {
  constexpr int kWideLimbs = ExactSum::kLimbCount + 7;
  std::uint32_t left[kWideLimbs] = {};
  std::uint32_t right[kWideLimbs] = {};
  const int left_shift = exponent < 0 ? -exponent : 0;
  const int right_shift = exponent > 0 ? exponent : 0;
  for (int i = 0; i < ExactSum::kLimbCount; ++i) shift_in(left, left_shift, i, numerator.limb(i));
  std::uint64_t carry = 0;
  for (int i = 0; i < ExactSum::kLimbCount + 1; ++i) {
    if (i < ExactSum::kLimbCount) carry += std::uint64_t{denominator.limb(i)} * mantissa;
    shift_in(right, right_shift, i, carry & 0xFFFFFFFFu);
    carry >>= 32;
  }
  for (int i = kWideLimbs - 1; i >= 0; --i) {
    if (left[i] != right[i]) return left[i] < right[i] ? -1 : 1;
  }
  return 0;
}

void add_volume(ExactSum& sum, const float org[3], const float a[3], const float b[3], const float c[3]) {
  sum.add_determinant(1, a, b, c);
  sum.add_determinant(-1, org, b, c);
  sum.add_determinant(-1, a, org, c);
  sum.add_determinant(-1, a, b, org);
}

// The distance at which a ray meets a triangle's plane is that volume over this one.
void add_slope(ExactSum& sum, const float dir[3], const float a[3], const float b[3], const float c[3]) {
  sum.add_determinant(1, dir, b, c);  // det[d, b-a, c-a] = det[d,b,c] - det[d,a,c] - det[d,b,a]
  sum.add_determinant(-1, dir, a, c);
  sum.add_determinant(-1, dir, b, a);
}

// A magnitude in half the bytes of its sum, because four of them are needed at once.
struct Digits {
  std::uint32_t digits[ExactSum::kLimbCount];
};

[[gnu::noinline]] void store_magnitude(ExactSum& sum, Digits& magnitude) {
  (void)sum.take_magnitude();
  for (int i = 0; i < ExactSum::kLimbCount; ++i) magnitude.digits[i] = sum.limb(i);
}

[[gnu::noinline]] void store_quotient(const float org[3], const float dir[3], const float (&v)[3][3], Digits& numerator,
                                      Digits& denominator) {
  {
    ExactSum sum;
    add_volume(sum, org, v[0], v[1], v[2]);
    store_magnitude(sum, numerator);
  }
  ExactSum sum;
  add_slope(sum, dir, v[0], v[1], v[2]);
  store_magnitude(sum, denominator);
}

}  // namespace

void ExactSum::add_product(int sign, float a, float b, float c) {
  const Decomposed x = decompose(a);
  const Decomposed y = decompose(b);
  const Decomposed z = decompose(c);
  const std::uint64_t xy = std::uint64_t{x.mantissa} * y.mantissa;              // 48 bits
  const std::uint64_t low = (xy & 0xFFFFFFFFu) * z.mantissa;                    // 56 bits
  const std::uint64_t high = (xy >> 32) * z.mantissa + (low >> 32);             // product = high * 2^32 + low's 32 bits
  const int position = x.exponent + y.exponent + z.exponent - kLowestExponent;  // 0..759
  const int index = position / 32;
  const int shift = position % 32;
  const std::uint64_t part0 = (low & 0xFFFFFFFFu) << shift;
  const std::uint64_t part1 = ((high & 0xFFFFFFFFu) << shift) + (part0 >> 32);
  const std::uint64_t part2 = ((high >> 32) << shift) + (part1 >> 32);
  const bool negative = (x.negative != y.negative) != (z.negative != (sign < 0));
  const std::int64_t unit = negative ? -1 : 1;
  limbs_[index] += unit * static_cast<std::int64_t>(part0 & 0xFFFFFFFFu);
  limbs_[index + 1] += unit * static_cast<std::int64_t>(part1 & 0xFFFFFFFFu);
  limbs_[index + 2] += unit * static_cast<std::int64_t>(part2 & 0xFFFFFFFFu);
  limbs_[index + 3] += unit * static_cast<std::int64_t>(part2 >> 32);
}

void ExactSum::add_determinant(int sign, const float a[3], const float b[3], const float c[3]) {
  add_product(sign, a[0], b[1], c[2]);
  add_product(sign, a[1], b[2], c[0]);
  add_product(sign, a[2], b[0], c[1]);
  add_product(-sign, a[2], b[1], c[0]);
  add_product(-sign, a[1], b[0], c[2]);
  add_product(-sign, a[0], b[2], c[1]);
}

void ExactSum::add_normal_component(const float a[3], const float b[3], const float c[3], int v, int w) {
  // a_v * a_w cancels.
  add_product(1, b[v], c[w], 1.0f);
  add_product(-1, b[v], a[w], 1.0f);
  add_product(-1, a[v], c[w], 1.0f);
  add_product(-1, b[w], c[v], 1.0f);
  add_product(1, b[w], a[v], 1.0f);
  add_product(1, a[w], c[v], 1.0f);
}

int ExactSum::sign() {
  std::int64_t carry = 0;
  std::uint32_t any = 0;
  for (std::int64_t& limb : limbs_) {
    const std::int64_t value = limb + carry;
    const std::uint32_t digit = static_cast<std::uint32_t>(value);
    carry = value >> 32;
    limb = digit;
    any |= digit;
  }
  // A negative sum leaves carry -1. The top limb takes it back, so that the limbs still have the same value.
  limbs_[kLimbCount - 1] += carry * (std::int64_t{1} << 32);
  if (carry < 0) return -1;
  return any != 0 ? 1 : 0;
}

int ExactSum::take_magnitude() {
  const int had = sign();
  if (had < 0) {
    for (std::int64_t& limb : limbs_) limb = -limb;
    (void)sign();
  }
  return had;
}

int exact_edge_sign(const float org[3], const float dir[3], const float a[3], const float b[3]) {
  ExactSum sum;  // det[d, a-o, b-o] = det[d,a,b] - det[d,o,b] - det[d,a,o]
  sum.add_determinant(1, dir, a, b);
  sum.add_determinant(-1, dir, org, b);
  sum.add_determinant(-1, dir, a, org);
  return sum.sign();
}

int exact_volume_sign(const float org[3], const float a[3], const float b[3], const float c[3]) {
  ExactSum sum;
  add_volume(sum, org, a, b, c);
  return sum.sign();
}

bool exact_zero_area(const float a[3], const float b[3], const float c[3]) {
  for (int u = 0; u < 3; ++u) {
    ExactSum sum;
    sum.add_normal_component(a, b, c, u, (u + 1) % 3);
    if (sum.sign() != 0) return false;
  }
  return true;
}

void exact_normal(const float a[3], const float b[3], const float c[3], double normal[3]) {
  Digits magnitudes[3];
  int signs[3];
  int top = 2;
  for (int u = 0; u < 3; ++u) {
    ExactSum sum;
    sum.add_normal_component(a, b, c, (u + 1) % 3, (u + 2) % 3);
    signs[u] = sum.take_magnitude();
    for (int i = 0; i < ExactSum::kLimbCount; ++i) {
      magnitudes[u].digits[i] = sum.limb(i);
      if (magnitudes[u].digits[i] != 0 && i > top) top = i;
    }
  }
  for (int u = 0; u < 3; ++u) {
    const std::uint32_t* const digits = magnitudes[u].digits;
    const auto part = [&](int i) { return static_cast<double>(digits[i]); };
    const double size = part(top) + (part(top - 1) + part(top - 2) * 0x1p-32) * 0x1p-32;
    normal[u] = signs[u] < 0 ? -size : size;
  }
}

float exact_distance(const float org[3], const float dir[3], const float a[3], const float b[3], const float c[3]) {
  ExactSum numerator, denominator;
  add_volume(numerator, org, a, b, c);
  add_slope(denominator, dir, a, b, c);
  const int numerator_sign = numerator.take_magnitude();
  const int denominator_sign = denominator.take_magnitude();
  if (numerator_sign == 0 || denominator_sign == 0 || numerator_sign != denominator_sign) return 0.0f;

  // Bisect over the bit patterns of the positive normal floats, which order them, for the largest f whose lower
  // rounding boundary is not above the quotient. The boundary is the midpoint of f = m 2^e and its predecessor:
  // (2 m - 1) 2^(e-1), or (4 m - 1) 2^(e-2) where f is a power of two.
  constexpr std::uint32_t kLeastNormal = 0x00800000u;
  std::uint32_t low = kLeastNormal - 1;
  std::uint32_t high = 0x7F7FFFFFu;
  while (low < high) {
    const std::uint32_t middle = low + (high - low + 1) / 2;
    const std::uint32_t mantissa = (middle & 0x7FFFFFu) | 0x800000u;
    const int exponent = static_cast<int>(middle >> 23) - 150;
    const bool power_of_two = mantissa == 0x800000u;
    const int order = power_of_two ? compare_with_multiple(numerator, denominator, 4 * mantissa - 1, exponent - 2)
                                   : compare_with_multiple(numerator, denominator, 2 * mantissa - 1, exponent - 1);
    if (order >= 0) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return low < kLeastNormal ? 0.0f : std::bit_cast<float>(low);
}

int exact_distance_order(const float org[3], const float dir[3], const float (&first)[3][3],
                         const float (&second)[3][3]) {
  Digits numerators[2], denominators[2];
  store_quotient(org, dir, first, numerators[0], denominators[0]);
  store_quotient(org, dir, second, numerators[1], denominators[1]);
  // The sign of N0 D1 - N1 D0, column by column from the lowest: sums of halves of at most 27 products each.
  constexpr int kLimbs = ExactSum::kLimbCount;
  std::int64_t carry = 0;
  std::uint32_t any = 0;
  for (int column = 0; column < 2 * kLimbs; ++column) {
    std::int64_t low = carry, high = 0;
    int begin = column - kLimbs + 1, end = column + 1;
    if (begin < 0) begin = 0;
    if (end > kLimbs) end = kLimbs;
    for (int i = begin; i < end; ++i) {
      const int j = column - i;
      const std::uint64_t left = std::uint64_t{numerators[0].digits[i]} * denominators[1].digits[j];
      const std::uint64_t right = std::uint64_t{numerators[1].digits[i]} * denominators[0].digits[j];
      low += static_cast<std::int64_t>(left & 0xFFFFFFFFu) - static_cast<std::int64_t>(right & 0xFFFFFFFFu);
      high += static_cast<std::int64_t>(left >> 32) - static_cast<std::int64_t>(right >> 32);
    }
    any |= static_cast<std::uint32_t>(low);
    carry = (low >> 32) + high;
  }
  if (carry < 0) return -1;
  return carry > 0 || any != 0 ? 1 : 0;
}

}  // namespace gridiron
