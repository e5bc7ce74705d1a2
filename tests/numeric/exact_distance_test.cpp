// Fractions and the floats they round to, against the definition and against the processor.
// SPDX-License-Identifier: Apache-2.0
#include "numeric/exact_distance.h"

#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

constexpr float kMax = std::numeric_limits<float>::max();
constexpr float kMin = std::numeric_limits<float>::min();
constexpr float kLeast = std::numeric_limits<float>::denorm_min();
constexpr float kInf = std::numeric_limits<float>::infinity();

ExactDistance fraction(std::int64_t numerator, int numerator_shift, std::int64_t denominator, int denominator_shift) {
  return {WideInt(numerator) << static_cast<unsigned>(numerator_shift),
          WideInt(denominator) << static_cast<unsigned>(denominator_shift)};
}

Rational distance_of(const Rational& a, const Rational& b) {
  return a < b ? Rational(b - a) : Rational(a - b);
}

bool is_even(float value) {
  return std::bit_cast<std::uint32_t>(value) % 2 == 0;
}

TEST(ExactDistance, DyadicIsTheFloat) {
  for_each_seed(20000, [](std::uint64_t seed) {
    TestRandom random(seed);
    const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random.next()));
    if (!std::isfinite(value)) return;
    const Dyadic dyadic(value);
    ASSERT_EQ(std::ldexp(static_cast<double>(dyadic.mantissa), dyadic.exponent), double{value}) << "seed " << seed;
    ASSERT_TRUE(dyadic.mantissa % 2 != 0 || value == 0.0f);
    ASSERT_EQ(exact_double(value), double{value});
    ASSERT_EQ(exact_rational(value), Rational(double{value}));
  });
  EXPECT_TRUE(std::signbit(exact_double(-0.0f)));
  EXPECT_EQ(exact_double(-kLeast), -0x1p-149);
}

TEST(ExactDistance, RoundsToTheNearestFloat) {
  for_each_seed(20000, [](std::uint64_t seed) {
    TestRandom random(seed);
    const auto numerator = static_cast<std::int64_t>(random.next() >> (1 + random.below(62)));
    const auto denominator = static_cast<std::int64_t>(random.next() >> (1 + random.below(62))) + 1;
    const ExactDistance t = fraction(numerator, static_cast<int>(random.below(180)), denominator,
                                     static_cast<int>(random.below(180)));
    const float rounded = t.rounded(Reading::kExact);
    const Rational exact = t.rational();
    if (std::isinf(rounded)) {
      ASSERT_GE(exact, Rational(exact_rational(kMax) + exact_rational(0x1p103f))) << "seed " << seed;
      ASSERT_EQ(t.rounded(Reading::kStandard), kMax);
      return;
    }
    for (const float other : {std::nextafter(rounded, 0.0f), std::nextafter(rounded, kMax)}) {
      if (other == rounded) continue;
      const Rational own = distance_of(exact, exact_rational(rounded));
      const Rational its = distance_of(exact, exact_rational(other));
      ASSERT_TRUE(own < its || (own == its && is_even(rounded))) << "seed " << seed;
    }
    const auto [low, high] = t.bounds();
    ASSERT_LE(Rational(low), exact) << "seed " << seed;
    ASSERT_GE(Rational(high), exact) << "seed " << seed;
    ASSERT_LE(high - low, 0x1p-50 * low) << "seed " << seed;
  });
}

TEST(ExactDistance, DoublesRoundAsTheProcessorRounds) {
  for_each_seed(100000, [](std::uint64_t seed) {
    TestRandom random(seed);
    // Bits below the float's last are few now and then, so that halves occur.
    const std::uint64_t mantissa = (random.next() >> 11 | std::uint64_t{1} << 52) & ~std::uint64_t{0}
                                                                                        << random.below(31);
    const double value = std::ldexp(static_cast<double>(mantissa), static_cast<int>(random.below(310)) - 215);
    const auto wanted = static_cast<float>(value);
    ASSERT_EQ(rounded_float(value, Reading::kExact), wanted) << std::hexfloat << value << ", seed " << seed;
    if (wanted > kMin && wanted < kMax && !(is_even(wanted) && std::abs(double{wanted} - value) > 0)) {
      ASSERT_EQ(rounded_float(value, Reading::kStandard), wanted) << std::hexfloat << value << ", seed " << seed;
    }
  });
}

TEST(ExactDistance, EndsAndTies) {
  const auto both = [](double value, float exact, float standard) {
    EXPECT_EQ(rounded_float(value, Reading::kExact), exact) << std::hexfloat << value;
    EXPECT_EQ(rounded_float(value, Reading::kStandard), standard) << std::hexfloat << value;
  };
  both(0.0, 0.0f, 0.0f);
  both(0x1.000001p0, 1.0f, 0x1.000002p0f);
  both(0x1.000003p0, 0x1.000004p0f, 0x1.000004p0f);
  both(0x1.0000010000001p0, 0x1.000002p0f, 0x1.000002p0f);
  both(0x1.fffffffp127, kInf, kMax);
  both(0x1.fffffefffffffp127, kMax, kMax);
  both(0x1p-149, kLeast, 0.0f);
  both(0x1p-150, 0.0f, 0.0f);
  both(0x1.8p-149, 2 * kLeast, 0.0f);
  both(0x1.0000000000001p-150, kLeast, 0.0f);
  both(0x1.fffffep-127, kMin, 0.0f);           // halfway between denormals
  both(0x1.ffffffp-127, kMin, kMin);           // halfway below the least normal with 24 bits
  both(0x1p-1022, 0.0f, 0.0f);
}

TEST(ExactDistance, WhatLiesFarBehindAHalfCounts) {
  const WideInt one = WideInt(1) << 100;
  const WideInt half = one + (WideInt(1) << 76);  // between 1 and the float above
  EXPECT_EQ((ExactDistance{half, one}).rounded(Reading::kExact), 1.0f);
  EXPECT_EQ((ExactDistance{half, one}).rounded(Reading::kStandard), 0x1.000002p0f);
  EXPECT_EQ((ExactDistance{half + 1, one}).rounded(Reading::kExact), 0x1.000002p0f);
  EXPECT_EQ((ExactDistance{half - 1, one}).rounded(Reading::kStandard), 1.0f);
}

TEST(ExactDistance, OrderIsThatOfTheFractions) {
  for_each_seed(5000, [](std::uint64_t seed) {
    TestRandom random(seed);
    const auto draw = [&] {
      return fraction(random.below(5), static_cast<int>(random.below(3)), 1 + random.below(5),
                      static_cast<int>(random.below(3)));
    };
    const ExactDistance a = draw(), b = draw();
    ASSERT_EQ(a < b, a.rational() < b.rational()) << "seed " << seed;
    ASSERT_EQ(a == b, a.rational() == b.rational()) << "seed " << seed;
  });
  // Closer than any double can distinguish, and with the longest integers.
  const WideInt big = (WideInt(1) << 836) - 1;
  EXPECT_LT((ExactDistance{big - 2, big - 1}), (ExactDistance{big - 1, big}));
  EXPECT_EQ((ExactDistance{big - 1, big}), (ExactDistance{big - 1, big}));
  EXPECT_EQ((ExactDistance{big - 1, big}).rounded(Reading::kExact), 1.0f);
}

}  // namespace
}  // namespace gridiron::test
