// Exact signs, zero areas and distances against rational numbers. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/exact_sum.h>

#include "support/rational_vectors.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using Floats = std::array<float, 3>;

int sign_of(const Rational& value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

Rational power_of_two(int exponent) {
  return exponent >= 0 ? Rational(BigInt(1) << exponent) : Rational(1, BigInt(1) << -exponent);
}

// Nearest float with unbounded exponent, halves away from zero; then 0 below the normal floats, kFloatMax above.
float rounded(const Rational& value) {
  if (value <= 0) return 0.0f;
  int exponent = static_cast<int>(msb(numerator(value))) - static_cast<int>(msb(denominator(value)));
  while (power_of_two(exponent) > value) --exponent;
  while (power_of_two(exponent + 1) <= value) ++exponent;
  const Rational scaled = value / power_of_two(exponent - 23) + Rational(1, 2);
  const BigInt mantissa = numerator(scaled) / denominator(scaled);
  const Rational result = Rational(mantissa) * power_of_two(exponent - 23);
  if (result < power_of_two(-126)) return 0.0f;
  if (result > Rational(kFloatMax)) return kFloatMax;
  return result.convert_to<float>();
}

// Where a ray meets a triangle's plane, 0 where it does not or the triangle has no area.
Rational exact_quotient(const Floats& o, const Floats& d, const Floats& a, const Floats& b, const Floats& c) {
  const Rational n =
      determinant(exact_point(a) - exact_point(o), exact_point(b) - exact_point(o), exact_point(c) - exact_point(o));
  const Rational m = determinant(exact_point(d), exact_point(b) - exact_point(a), exact_point(c) - exact_point(a));
  return n == 0 || m == 0 ? Rational(0) : Rational(n / m);
}

float distance_by_rationals(const Floats& o, const Floats& d, const Floats& a, const Floats& b, const Floats& c) {
  return rounded(exact_quotient(o, d, a, b, c));
}

// Any finite float, all bit patterns alike: denormals, zeros of both signs and the largest included.
float any_float(TestRandom& random) {
  for (;;) {
    const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random.next()));
    if (std::isfinite(value)) return value;
  }
}

// Few mantissa bits around one scale: ties and zeros are frequent.
float lattice_float(TestRandom& random, int exponent) {
  return std::ldexp(static_cast<float>(random.below(9)) - 4.0f, exponent);
}

struct Source {
  const char* name;
  int seeds;
  std::function<float(TestRandom&)> draw;
};

class Sources : public ::testing::TestWithParam<Source> {
 protected:
  Floats point(TestRandom& random) {
    return {GetParam().draw(random), GetParam().draw(random), GetParam().draw(random)};
  }
};

TEST_P(Sources, SignsEqualRationalSigns) {
  std::array<int, 3> seen{};
  for (int seed = 0; seed < GetParam().seeds; ++seed) {
    TestRandom random(static_cast<std::uint64_t>(seed));
    const Floats o = point(random), d = point(random), a = point(random), b = point(random), c = point(random);
    const RationalPoint ao = exact_point(a) - exact_point(o), bo = exact_point(b) - exact_point(o),
                        co = exact_point(c) - exact_point(o);
    const int edge = exact_edge_sign(o.data(), d.data(), a.data(), b.data());
    EXPECT_EQ(edge, sign_of(determinant(exact_point(d), ao, bo))) << GetParam().name << " seed " << seed;
    EXPECT_EQ(edge, -exact_edge_sign(o.data(), d.data(), b.data(), a.data())) << GetParam().name << " seed " << seed;
    const int volume = exact_volume_sign(o.data(), a.data(), b.data(), c.data());
    EXPECT_EQ(volume, sign_of(determinant(ao, bo, co))) << GetParam().name << " seed " << seed;
    ++seen[static_cast<std::size_t>(edge + 1)];
  }
  EXPECT_GT(seen[0], 0);
  EXPECT_GT(seen[2], 0);
}

TEST_P(Sources, ZeroAreaEqualsRationalZeroArea) {
  int zeros = 0;
  for (int seed = 0; seed < GetParam().seeds; ++seed) {
    TestRandom random(static_cast<std::uint64_t>(seed) + 1000000);
    const Floats a = point(random), b = point(random);
    Floats c = point(random);
    if (seed % 3 == 0) c[0] = a[0], c[1] = a[1];
    const RationalPoint e1 = exact_point(b) - exact_point(a), e2 = exact_point(c) - exact_point(a);
    const bool expected = cross(e1, e2) == RationalPoint{};
    EXPECT_EQ(exact_zero_area(a.data(), b.data(), c.data()), expected) << GetParam().name << " seed " << seed;
    if (expected) ++zeros;
  }
  if (std::string(GetParam().name).starts_with("lattice")) {
    EXPECT_GT(zeros, 0);
  }
}

TEST_P(Sources, DistanceIsTheRationalOneRounded) {
  int positive = 0;
  for (int seed = 0; seed < GetParam().seeds; ++seed) {
    TestRandom random(static_cast<std::uint64_t>(seed) + 2000000);
    const Floats o = point(random), d = point(random), a = point(random), b = point(random), c = point(random);
    const float expected = distance_by_rationals(o, d, a, b, c);
    const float got = exact_distance(o.data(), d.data(), a.data(), b.data(), c.data());
    EXPECT_EQ(std::bit_cast<std::uint32_t>(got), std::bit_cast<std::uint32_t>(expected))
        << GetParam().name << " seed " << seed << ": " << got << " for " << expected;
    if (expected > 0) ++positive;
  }
  EXPECT_GT(positive, 0);
}

TEST_P(Sources, OrderIsThatOfTheRationalDistances) {
  int compared = 0;
  for (int seed = 0; seed < GetParam().seeds; ++seed) {
    TestRandom random(static_cast<std::uint64_t>(seed) + 3000000);
    const Floats o = point(random), d = point(random);
    const std::array<Floats, 3> one = {point(random), point(random), point(random)};
    std::array<Floats, 3> other = {point(random), point(random), point(random)};
    if (seed % 4 == 1) other = {one[1], one[2], one[0]};
    if (seed % 4 == 2) other = {one[0], one[1], other[2]};
    if (seed % 4 == 3) {  // one unit in the last place apart
      other = one;
      other[random.below(3)][random.below(3)] = std::nextafter(one[0][0], 0.0f);
    }
    const Rational first = exact_quotient(o, d, one[0], one[1], one[2]);
    const Rational second = exact_quotient(o, d, other[0], other[1], other[2]);
    if (first <= 0 || second <= 0) continue;
    float vertices[2][3][3];
    for (std::size_t i = 0; i < 9; ++i) {
      vertices[0][i / 3][i % 3] = one[i / 3][i % 3];
      vertices[1][i / 3][i % 3] = other[i / 3][i % 3];
    }
    const int expected = sign_of(first - second);
    EXPECT_EQ(exact_distance_order(o.data(), d.data(), vertices[0], vertices[1]), expected)
        << GetParam().name << " seed " << seed;
    EXPECT_EQ(exact_distance_order(o.data(), d.data(), vertices[1], vertices[0]), -expected)
        << GetParam().name << " seed " << seed;
    ++compared;
  }
  EXPECT_GT(compared, 0);
}

// Distances that are the same float and not the same number.
TEST(ExactDistanceOrder, TellsApartWhatRoundsAlike) {
  const Floats o = {0, 0, 0}, d = {0, 0, 1};
  const float near[3][3] = {{-1, -1, 1}, {1, -1, 1}, {0, 2, 1}};
  float far[3][3] = {{-1, -1, 1}, {1, -1, 1}, {0, 0x1p30f, 0x1.000002p0f}};
  EXPECT_EQ(exact_distance(o.data(), d.data(), far[0], far[1], far[2]), 1.0f);
  EXPECT_EQ(exact_distance_order(o.data(), d.data(), near, far), -1);
  EXPECT_EQ(exact_distance_order(o.data(), d.data(), far, near), 1);
  EXPECT_EQ(exact_distance_order(o.data(), d.data(), far, far), 0);
  far[2][2] = 1;
  EXPECT_EQ(exact_distance_order(o.data(), d.data(), near, far), 0);
}

INSTANTIATE_TEST_SUITE_P(
    All, Sources,
    ::testing::Values(
        Source{"any_bits", 1500, any_float}, Source{"unit", 1500, [](TestRandom& r) { return r.between(-1, 1); }},
        Source{"lattice_one", 3000, [](TestRandom& r) { return lattice_float(r, 0); }},
        Source{"lattice_tiny", 2000, [](TestRandom& r) { return lattice_float(r, -149); }},
        Source{"lattice_huge", 2000, [](TestRandom& r) { return lattice_float(r, 125); }},
        Source{"denormal", 1000,
               [](TestRandom& r) { return std::bit_cast<float>(r.below(0x800000u) | (r.below(2) << 31)); }},
        Source{"moved", 1000, [](TestRandom& r) { return 1e7f + r.between(-64, 64); }},
        Source{"mixed", 1500,
               [](TestRandom& r) { return std::ldexp(r.between(-1, 1), static_cast<int>(r.below(60)) - 30); }}),
    [](const auto& test) { return test.param.name; });

// A ray along x onto the plane x = n: the distance is n / d, so quotients can be chosen.
float quotient(float n, float d) {
  const Floats o = {0, 0, 0}, dir = {d, 0, 0}, a = {n, 0, 0}, b = {n, 1, 0}, c = {n, 0, 1};
  const float got = exact_distance(o.data(), dir.data(), a.data(), b.data(), c.data());
  EXPECT_EQ(got, distance_by_rationals(o, dir, a, b, c)) << n << " / " << d;
  return got;
}

TEST(ExactDistance, Quotients) {
  EXPECT_EQ(quotient(6, 2), 3.0f);
  EXPECT_EQ(quotient(1, 3), 1.0f / 3.0f);
  EXPECT_EQ(quotient(-6, 2), 0.0f);
  EXPECT_EQ(quotient(-6, -2), 3.0f);
  EXPECT_EQ(quotient(0, 2), 0.0f);
  EXPECT_EQ(quotient(5, 0), 0.0f);
}

// (2^24 + 1) / 2^k lies half-way between two floats; its neighbours do not.
TEST(ExactDistance, HalvesGoAwayFromZero) {
  const float even = 16777216.0f;
  for (const float scale : {1.0f, 1048576.0f, 0x1p-60f}) {
    // x = even + 1: the plane x + y = even + 1 met along x, built from corners that are floats.
    const Floats o = {0, 0, 0}, dir = {1.0f / scale, 0, 0};
    const Floats a = {even, 1, 0}, b = {even - 1, 2, 0}, c = {even, 1, 1};
    const float got = exact_distance(o.data(), dir.data(), a.data(), b.data(), c.data());
    EXPECT_EQ(got, (even + 2.0f) * scale);
    EXPECT_EQ(got, distance_by_rationals(o, dir, a, b, c));
    const Floats a3 = {even + 2, 1, 0}, b3 = {even, 3, 0}, c3 = {even + 2, 1, 1};
    EXPECT_EQ(exact_distance(o.data(), dir.data(), a3.data(), b3.data(), c3.data()), (even + 4.0f) * scale);
  }
}

// Below a power of two floats are twice as close as above it, and so is the place where rounding changes.
TEST(ExactDistance, BelowAPowerOfTwoStepsAreHalfAsLong) {
  for (const float scale : {1.0f, 0x1p20f, 0x1p-60f}) {
    for (int eighths = 1; eighths <= 16; ++eighths) {
      // From x = eighths 2^-27 to the plane x = 1; 2^-24 is the step below 1.
      const Floats o = {scale * 0x1p-27f * static_cast<float>(eighths), 0, 0}, dir = {1, 0, 0};
      const Floats a = {scale, 0, 0}, b = {scale, 1, 0}, c = {scale, 0, 1};
      const float expected = eighths <= 4 ? 1.0f : eighths <= 12 ? 1.0f - 0x1p-24f : 1.0f - 0x1p-23f;
      const float got = exact_distance(o.data(), dir.data(), a.data(), b.data(), c.data());
      EXPECT_EQ(got, expected * scale) << eighths;
      EXPECT_EQ(got, distance_by_rationals(o, dir, a, b, c)) << eighths;
    }
  }
}

TEST(ExactDistance, EndsOfTheRange) {
  const float least = std::numeric_limits<float>::min();
  const float tiniest = std::numeric_limits<float>::denorm_min();
  EXPECT_EQ(quotient(kFloatMax, 1), kFloatMax);
  EXPECT_EQ(quotient(kFloatMax, 0.5f), kFloatMax);
  EXPECT_EQ(quotient(kFloatMax, tiniest), kFloatMax);
  EXPECT_EQ(quotient(std::nextafter(kFloatMax, 0.0f), 1), std::nextafter(kFloatMax, 0.0f));
  EXPECT_EQ(quotient(least, 1), least);
  EXPECT_EQ(quotient(std::nextafter(least, 1.0f), 1), std::nextafter(least, 1.0f));
  EXPECT_EQ(quotient(std::nextafter(least, 0.0f), 1), 0.0f);
  EXPECT_EQ(quotient(tiniest, 1), 0.0f);
  EXPECT_EQ(quotient(tiniest, kFloatMax), 0.0f);
  EXPECT_EQ(quotient(tiniest, tiniest), 1.0f);
  EXPECT_EQ(quotient(kFloatMax, kFloatMax), 1.0f);
  // Quotients around the least normal float, where rounding carries into it.
  for (const float d : {std::nextafter(1.0f, 2.0f), std::nextafter(1.0f, 0.0f), 0x1.000002p0f, 0x1.fffffep0f}) {
    (void)quotient(least, d);
    (void)quotient(2.0f * least, d);
  }
}

// Neighbouring triangles give the same bits on the edge they share: the distance depends on the point alone.
TEST(ExactDistance, AgreesOnBothSidesOfAnEdge) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    TestRandom random(seed);
    const auto point = [&] {
      return Floats{lattice_float(random, 0), lattice_float(random, 0), lattice_float(random, 0)};
    };
    const Floats o = point(), a = point(), b = point(), c = point(), e = point();
    const Floats d = {0.5f * (a[0] + b[0]) - o[0], 0.5f * (a[1] + b[1]) - o[1], 0.5f * (a[2] + b[2]) - o[2]};
    const float one = exact_distance(o.data(), d.data(), a.data(), b.data(), c.data());
    const float other = exact_distance(o.data(), d.data(), b.data(), a.data(), e.data());
    if (one != 0 && other != 0) {
      EXPECT_EQ(one, 1.0f) << "seed " << seed;
      EXPECT_EQ(other, 1.0f) << "seed " << seed;
    }
  }
}

TEST(ExactSum, HoldsManyProductsOfTheLargestFloats) {
  ExactSum sum;
  for (int i = 0; i < 100000; ++i) sum.add_product(1, kFloatMax, kFloatMax, kFloatMax);
  EXPECT_EQ(sum.sign(), 1);
  for (int i = 0; i < 100000; ++i) sum.add_product(-1, kFloatMax, -kFloatMax, -kFloatMax);
  EXPECT_EQ(sum.sign(), 0);
  const float tiniest = std::numeric_limits<float>::denorm_min();
  sum.add_product(1, -tiniest, tiniest, tiniest);
  EXPECT_EQ(sum.sign(), -1);
  sum.add_product(1, kFloatMax, kFloatMax, kFloatMax);
  sum.add_product(1, kFloatMax, kFloatMax, -kFloatMax);
  EXPECT_EQ(sum.sign(), -1) << "settled limbs keep the number";
  EXPECT_EQ(sum.take_magnitude(), -1);
  EXPECT_EQ(sum.limb(0), 1u);
  for (int i = 1; i < ExactSum::kLimbCount; ++i) EXPECT_EQ(sum.limb(i), 0u);
}

}  // namespace
}  // namespace gridiron::test
