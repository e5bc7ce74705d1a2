// The Cell's numbers: by hand where they differ from IEEE's, by the host's own rounding to zero where they do not.
// SPDX-License-Identifier: Apache-2.0
#include "numeric/watertight/cell/cell_float.h"

#include <cfenv>

#include "core/seeds.h"
#include "numeric/watertight/cell/cell_vector.h"
#include "numeric/watertight/machines.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using watertight::CellDouble;
using watertight::CellFloat;
using watertight::CellVector;

constexpr std::uint32_t kLargest = 0x7FFFFFFFu;
constexpr std::uint32_t kMinusLargest = 0xFFFFFFFFu;

CellFloat of_bits(std::uint32_t bits) {
  return CellFloat::from_bits(bits);
}

TEST(CellFloat, AnExponentOf255IsANumber) {
  const CellFloat beyond = of_bits(0x7F800000u);  // IEEE's infinity
  EXPECT_EQ(beyond.value(), 0x1p128);
  EXPECT_EQ((beyond * CellFloat(0.5f)).bits(), 0x7F000000u);
  EXPECT_EQ((beyond - CellFloat(0x1p127f)).bits(), 0x7F000000u);
  EXPECT_EQ((CellFloat(0x1p127f) + CellFloat(0x1p127f)).bits(), 0x7F800000u);
  EXPECT_EQ(of_bits(0x7FC00000u).value(), 0x1.8p128);  // a NaN
  EXPECT_TRUE(of_bits(0x7FC00000u) == of_bits(0x7FC00000u));
  EXPECT_TRUE(beyond < of_bits(0x7F800001u));
}

TEST(CellFloat, WhatIsTooLargeBecomesTheLargest) {
  EXPECT_EQ((of_bits(0x7F800000u) * CellFloat(2.0f)).bits(), kLargest);
  EXPECT_EQ((of_bits(0x7F800000u) * CellFloat(-2.0f)).bits(), kMinusLargest);
  EXPECT_EQ((of_bits(kLargest) + of_bits(kLargest)).bits(), kLargest);
  EXPECT_EQ((CellFloat(-1.0f) / CellFloat(0.0f)).bits(), kMinusLargest);
}

TEST(CellFloat, ZerosArePositiveAndDenormalsAreZero) {
  EXPECT_EQ((CellFloat(0x1p-100f) * CellFloat(-0x1p-100f)).bits(), 0u);
  EXPECT_EQ((CellFloat(1.0f) - CellFloat(1.0f)).bits(), 0u);
  EXPECT_EQ((CellFloat(-0.0f) + CellFloat(-0.0f)).bits(), 0u);
  EXPECT_EQ((CellFloat(0x1.8p-126f) - CellFloat(0x1p-126f)).bits(), 0u);
  EXPECT_EQ((CellFloat(0x1p-130f) * CellFloat(0x1p100f)).bits(), 0u);
  EXPECT_TRUE(CellFloat(0x1p-130f) == CellFloat(-0.0f));
}

TEST(CellFloat, SumsAreRoundedToZeroWhateverIsFarBelow) {
  const std::uint32_t below_one = std::bit_cast<std::uint32_t>(std::nextafter(1.0f, 0.0f));
  EXPECT_EQ((CellFloat(1.0f) - CellFloat(0x1p-25f)).bits(), below_one);
  EXPECT_EQ((CellFloat(1.0f) - CellFloat(0x1p-60f)).bits(), below_one);
  EXPECT_EQ((CellFloat(1.0f) - CellFloat(0x1p-126f)).bits(), below_one);
  EXPECT_EQ((CellFloat(-1.0f) + CellFloat(0x1p-126f)).bits(), below_one | 0x80000000u);
  EXPECT_EQ((CellFloat(1.0f) + CellFloat(0x1p-24f)).same_bits(), 1.0f);
  EXPECT_EQ((CellFloat(1.0f) + CellFloat(0x1.fffffep-24f)).same_bits(), 1.0f);
}

TEST(CellFloat, DoublesReadDenormalsAsZero) {
  EXPECT_EQ((CellDouble(0x1p-1060) + CellDouble(0.0)).value(), 0.0);
  EXPECT_EQ(CellDouble(CellFloat(0x1p-130f)).value(), 0.0);
  EXPECT_EQ(static_cast<CellFloat>(CellDouble(0x1p-140)).bits(), 0u);
  EXPECT_EQ((CellDouble(1.0) + CellDouble(0x1.8p-53)).value(), 1.0 + 0x1p-52);  // to nearest
}

// A float whose products and quotients with others of its kind are normal numbers of IEEE, or 0.
float random_float(TestRandom& random) {
  const std::uint32_t exponent = 127 - 40 + random.below(80);
  std::uint32_t mantissa = static_cast<std::uint32_t>(random.next()) & 0x7FFFFFu;
  if (random.below(4) == 0) mantissa &= 0x7F0000u;
  if (random.below(4) == 0) mantissa |= 0x00FFFFu;
  return std::bit_cast<float>(random.below(2) << 31 | exponent << 23 | mantissa);
}

TEST(CellFloat, IsTheHostRoundingToZeroWhereBothHaveNumbers) {
  const Machine* to_zero = nullptr;
  for (const Machine& machine : machines()) {
    if (machine.rounding == FE_TOWARDZERO) to_zero = &machine;
  }
  ASSERT_NE(to_zero, nullptr);
  TestRandom random(1);
  for (int i = 0; i < 400000; ++i) {
    const float a = random_float(random);
    const float b = random.below(8) == 0 ? std::nextafter(-a, random_float(random)) : random_float(random);
    volatile float x = a, y = b;
    float sum, difference, product, quotient;
    {
      const RoundingGuard guard(*to_zero);
      sum = x + y;
      difference = x - y;
      product = x * y;
      quotient = x / y;
    }
    const auto expect_bits = [&](CellFloat found, float wanted) {
      if (wanted == 0.0f) wanted = 0.0f;
      ASSERT_EQ(found.bits(), std::bit_cast<std::uint32_t>(wanted + 0.0f)) << std::hexfloat << a << ' ' << b;
    };
    expect_bits(CellFloat(a) + CellFloat(b), sum);
    expect_bits(CellFloat(a) - CellFloat(b), difference);
    expect_bits(CellFloat(a) * CellFloat(b), product);
    expect_bits(CellFloat(a) / CellFloat(b), quotient);
    ASSERT_EQ(CellFloat(a) < CellFloat(b), a < b);
    ASSERT_EQ(CellFloat(a) <= CellFloat(b), a <= b);
  }
}

TEST(CellFloat, FourAtOnceAreFourOnes) {
  TestRandom random(2);
  for (int i = 0; i < 200000; ++i) {
    CellFloat a[4], b[4];
    for (int lane = 0; lane < 4; ++lane) {
      a[lane] = of_bits(static_cast<std::uint32_t>(random.next()));
      b[lane] = of_bits(static_cast<std::uint32_t>(random.next()));
      if (random.below(4) == 0) b[lane] = of_bits(a[lane].bits() + random.below(3) - 1);
      if (random.below(4) == 0) b[lane] = -b[lane];
      if (random.below(8) == 0) b[lane] = of_bits(random.below(2) << 31 | random.below(2) * kLargest);
    }
    const CellVector x = CellVector::load(a), y = CellVector::load(b);
    for (std::uint32_t lane = 0; lane < 4; ++lane) {
      ASSERT_EQ(x.values()[lane], a[lane].value());
      ASSERT_EQ((x + y).lane(lane).bits(), (a[lane] + b[lane]).bits()) << a[lane].bits() << ' ' << b[lane].bits();
      ASSERT_EQ((x - y).lane(lane).bits(), (a[lane] - b[lane]).bits()) << a[lane].bits() << ' ' << b[lane].bits();
      ASSERT_EQ((x * y).lane(lane).bits(), (a[lane] * b[lane]).bits()) << a[lane].bits() << ' ' << b[lane].bits();
      ASSERT_EQ((x < y) >> lane & 1u, a[lane] < b[lane] ? 1u : 0u);
      ASSERT_EQ((x <= y) >> lane & 1u, a[lane] <= b[lane] ? 1u : 0u);
    }
  }
}

}  // namespace
}  // namespace gridiron::test
