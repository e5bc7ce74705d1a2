// Sine, cosine and power against those of doubles. SPDX-License-Identifier: Apache-2.0
#include <gridiron/shade/elementary.h>

#include <numbers>

#include "support/test_headers.h"

namespace gridiron::test {
namespace {

double worst_of_turn(float turn) {
  float sine, cosine;
  sine_cosine_of_turn(turn, sine, cosine);
  const double angle = 2.0 * std::numbers::pi * static_cast<double>(turn);
  return std::max(std::abs(static_cast<double>(sine) - std::sin(angle)),
                  std::abs(static_cast<double>(cosine) - std::cos(angle)));
}

TEST(SineCosine, AreWithin22BitsAtEveryMultipleOfTheJittersStep) {
  double worst = 0.0;
  for (std::uint32_t i = 0; i <= 1u << 24; ++i) {
    worst = std::max(worst, worst_of_turn(static_cast<float>(i) * 0x1p-24f));
  }
  RecordProperty("worst_log2", std::to_string(std::log2(worst)));
  EXPECT_LE(worst, 0x1p-22);
  EXPECT_GT(worst, 0x1p-30) << "nothing was compared";
}

TEST(SineCosine, AreWithin22BitsAtSmallTurns) {
  for (std::uint32_t pattern = 0; pattern < std::bit_cast<std::uint32_t>(0.01f); pattern += 997) {
    ASSERT_LE(worst_of_turn(std::bit_cast<float>(pattern)), 0x1p-22) << pattern;
  }
}

TEST(SineCosine, AreExactAtQuarters) {
  const float wanted[5][2] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}, {0, 1}};
  for (int i = 0; i <= 4; ++i) {
    float sine, cosine;
    sine_cosine_of_turn(0.25f * static_cast<float>(i), sine, cosine);
    EXPECT_EQ(sine, wanted[i][0]) << i;
    EXPECT_EQ(cosine, wanted[i][1]) << i;
  }
}

class Power : public testing::Test {
 protected:
  void compare(float base, float exponent) {
    const double wanted = std::pow(static_cast<double>(base), static_cast<double>(exponent));
    const float got = power(base, exponent);
    ASSERT_GE(got, 0.0f) << base << " ^ " << exponent;
    ASSERT_LE(got, 1.0f) << base << " ^ " << exponent;
    const double error = std::abs(static_cast<double>(got) - wanted);
    ASSERT_LE(error, 0x1p-21) << base << " ^ " << exponent;
    worst_absolute_ = std::max(worst_absolute_, error);
    if (wanted < 0x1.001p-126) {
      ASSERT_LE(got, 0x1.002p-126f) << base << " ^ " << exponent;
    } else {
      ASSERT_LE(error, wanted * 0x1p-14) << base << " ^ " << exponent;
      worst_relative_ = std::max(worst_relative_, error / wanted);
      ++compared_;
    }
  }
  double worst_absolute_ = 0.0, worst_relative_ = 0.0;
  std::uint64_t compared_ = 0;
};

TEST_F(Power, IsThatOfDoublesForAllBasesAndExponents) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> fraction(0.0f, 1.0f);
  for (int i = 0; i < 4000000; ++i) {
    const float exponent = i % 4 == 0 ? std::round(1000.0f * fraction(random))
                                      : std::exp2(20.0f * fraction(random)) * (100000.0f / 1048576.0f);
    // Bases spread evenly, or so that the result is, or as patterns are.
    float base = fraction(random);
    if (i % 3 == 1) base = std::exp2(-20.0f * fraction(random) / (exponent + 1.0f));
    if (i % 3 == 2) {
      base = std::bit_cast<float>(std::uniform_int_distribution<std::uint32_t>(0x00800000u, 0x3F800000u)(random));
    }
    compare(base, exponent);
    if (HasFatalFailure()) FAIL() << "case " << i;
  }
  RecordProperty("worst_absolute_log2", std::to_string(std::log2(worst_absolute_)));
  RecordProperty("worst_relative_log2", std::to_string(std::log2(worst_relative_)));
  EXPECT_GT(compared_, 2000000u);
}

TEST_F(Power, IsThatOfDoublesForTheBasesNextToOneAndToTheRootOfHalf) {
  for (const float exponent : {0.25f, 1.0f, 2.0f, 32.0f, 1000.0f, 65536.0f, 99999.0f, 100000.0f}) {
    for (std::uint32_t i = 0; i < 100000; ++i) {
      compare(std::bit_cast<float>(0x3F800000u - i), exponent);
      compare(std::bit_cast<float>(0x3F3504F3u + 1000u - std::min(i, 2000u)), exponent);
      if (HasFatalFailure()) FAIL() << "step " << i;
    }
  }
}

TEST_F(Power, NeverFallsByMoreThanRoundingAsTheBaseGrows) {
  for (const float exponent : {1.0f, 10.0f, 300.0f, 100000.0f}) {
    float last = 0.0f;
    for (std::uint32_t pattern = 0x3F000000u; pattern <= 0x3F800000u; pattern += exponent > 1000.0f ? 1 : 16) {
      const float next = power(std::bit_cast<float>(pattern), exponent);
      ASSERT_GE(next, last * (1.0f - 0x1p-14f)) << pattern << " ^ " << exponent;
      last = next;
    }
    EXPECT_EQ(last, 1.0f);
  }
}

TEST_F(Power, HasItsEnds) {
  EXPECT_EQ(power(0.0f, 1.0f), 0.0f);
  EXPECT_EQ(power(0.0f, 1e5f), 0.0f);
  EXPECT_EQ(power(0.0f, 1e-3f), 0.0f);
  EXPECT_EQ(power(0x1p-127f, 1e-3f), 0.0f);
  EXPECT_EQ(power(0.0f, 0.0f), 1.0f);
  EXPECT_EQ(power(0.3f, 0.0f), 1.0f);
  EXPECT_EQ(power(1.0f, 0.0f), 1.0f);
  EXPECT_EQ(power(1.0f, 1e5f), 1.0f);
  EXPECT_EQ(power(1.0f + 0x1p-20f, 1e5f), 1.0f);
  EXPECT_EQ(power(0.5f, 1e5f), 0.0f);
  EXPECT_EQ(power(0.5f, 126.0f), 0x1p-126f);
}

}  // namespace
}  // namespace gridiron::test
