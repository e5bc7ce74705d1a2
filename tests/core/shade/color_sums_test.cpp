// Sums of colours: the order of adding changes nothing, too much stays the most, what is no number adds nothing.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/shade/color_sums.h>

#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint32_t kFull = 0xFFFFFFFFu;

std::uint32_t sum_of(const std::vector<float>& values) {
  std::uint32_t sum = 0;
  for (const float value : values) add_steps(sum, sum_steps(value));
  return sum;
}

TEST(SumSteps, RoundToTheNearest) {
  EXPECT_EQ(sum_steps(1.0f), 1u << 20);
  EXPECT_EQ(sum_steps(0x1p-20f), 1u);
  EXPECT_EQ(sum_steps(0x1p-21f), 1u) << "a half rounds up";
  EXPECT_EQ(sum_steps(0x1.FFFFF8p-22f), 0u);
  EXPECT_EQ(sum_steps(0x1.7FFFFEp-20f), 1u);
  EXPECT_EQ(sum_steps(0x1.8p-20f), 2u);
  TestRandom random(3);
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const float value = std::ldexp(random.unit(), static_cast<int>(random.below(36)) - 24);
    const double exact = std::fmin(double{value}, double{kMostAdded}) * 0x1p20;
    // Where value * 2^20 needs all 24 digits, adding 1/2 rounds once more.
    const double step = exact >= 0x1p23 ? 1.0 : 0.0;
    EXPECT_LE(std::fabs(static_cast<double>(sum_steps(value)) - std::floor(exact + 0.5)), step) << value;
  }
}

TEST(SumSteps, NeverFall) {
  std::uint32_t last = 0;
  for (float value = 0x1p-24f; value < 0x1p14f; value *= 1.0f + 0x1p-10f) {
    const std::uint32_t steps = sum_steps(value);
    ASSERT_GE(steps, last) << value;
    last = steps;
  }
}

TEST(SumSteps, OfWhatIsNoColour) {
  for (const float none : {0.0f, -0.0f, -1.0f, -1e30f, -kInfinity, kNaN, -kNaN, 0x1p-149f, -0x1p-149f}) {
    EXPECT_EQ(sum_steps(none), 0u) << none;
  }
  const std::uint32_t most = 4095u << 20;
  for (const float much : {4095.0f, 4095.5f, 4096.0f, 1e6f, 3e38f, kInfinity}) EXPECT_EQ(sum_steps(much), most) << much;
  EXPECT_LT(sum_steps(4094.9995f), most);
}

TEST(AddSteps, StopAtTheMost) {
  for (const std::uint32_t start : {0u, 1u, 0x7FFFFFFFu, 0x80000000u, kFull - 1, kFull}) {
    for (const std::uint32_t steps : {0u, 1u, 2u, 0x7FFFFFFFu, 0x80000000u, kFull - 1, kFull}) {
      std::uint32_t sum = start;
      add_steps(sum, steps);
      EXPECT_EQ(sum, std::min(std::uint64_t{start} + steps, std::uint64_t{kFull})) << start << " + " << steps;
    }
  }
}

TEST(AddSteps, OrderDoesNotMatter) {
  std::uint32_t full = 0, not_full = 0;
  for_each_seed(500, [&](TestRandom& random) {
    std::vector<float> values(1 + random.below(60));
    const int brightest = static_cast<int>(random.below(16)) - 4;
    for (float& value : values) {
      value = std::ldexp(random.unit(), brightest - static_cast<int>(random.below(12)));
      const std::uint32_t special = random.below(40);
      if (special == 0) value = kNaN;
      if (special == 1) value = -value;
      if (special == 2) value = kInfinity;
    }
    const std::uint32_t sum = sum_of(values);
    (sum == kFull ? full : not_full) += 1;
    for (std::uint32_t round = 0; round < 20; ++round) {
      for (std::size_t i = values.size(); i > 1; --i) {
        std::swap(values[i - 1], values[random.below(static_cast<std::uint32_t>(i))]);
      }
      ASSERT_EQ(sum_of(values), sum);
    }
    std::sort(values.begin(), values.end(), [](float a, float b) { return sum_steps(a) < sum_steps(b); });
    ASSERT_EQ(sum_of(values), sum);
  });
  EXPECT_GT(full, 20u);
  EXPECT_GT(not_full, 100u);
}

std::uint32_t level_of_sum(std::uint32_t sum, float per_step) { return level_of(brightness_of(sum, per_step)); }

TEST(LevelOf, EveryLevelAtItsPlace) {
  for (const std::uint32_t samples : {1u, 4u, 16u}) {
    const float per_step = 1.0f / (kSumSteps * static_cast<float>(samples));
    EXPECT_EQ(level_of_sum(0, per_step), 0u);
    EXPECT_EQ(level_of_sum(kFull, per_step), 255u);
    EXPECT_EQ(level_of_sum(samples << 20, per_step), 255u);
    for (std::uint32_t level = 0; level <= 255; ++level) {
      const double middle = level * double(samples << 20) / 255.0;
      const double half = 0.5 * double(samples << 20) / 255.0;
      EXPECT_EQ(level_of_sum(static_cast<std::uint32_t>(middle + 0.5), per_step), level);
      // Two steps off a threshold floats are sure of it.
      if (level < 255) {
        const double slack = 2.0 * samples;
        EXPECT_EQ(level_of_sum(static_cast<std::uint32_t>(middle + half - slack), per_step), level);
        EXPECT_EQ(level_of_sum(static_cast<std::uint32_t>(middle + half + slack), per_step), level + 1);
      }
    }
  }
}

// 0 stays what it is and 1 the highest level, it never falls, and it is the curve of the standard within 2^-20.
TEST(Srgb, IsTheCurveOfTheStandard) {
  EXPECT_EQ(srgb_of(0.0f), 0.0f);
  EXPECT_NEAR(srgb_of(1.0f), 1.0f, 0x1p-20f);
  EXPECT_EQ(level_of(srgb_of(1.0f)), 255u);
  EXPECT_EQ(level_of(srgb_of(0.2158605f)), 128u) << "what the eye takes for the middle";
  float last = 0.0f;
  for (std::uint32_t step = 0; step <= 1u << 20; ++step) {
    const float linear = static_cast<float>(step) * 0x1p-20f;
    const double exact =
        linear <= 0.0031308f ? 12.92 * double{linear} : 1.055 * std::pow(double{linear}, 1 / 2.4) - 0.055;
    const float found = srgb_of(linear);
    ASSERT_NEAR(found, exact, 0x1p-20) << linear;
    ASSERT_GE(found, last - 0x1p-22f) << linear;
    ASSERT_LE(level_of(found), 255u);
    last = found;
  }
}

// The many dark samples of a pixel add up to the same as one sample of their mean, within half a step each.
TEST(LevelOf, SamplesAverage) {
  TestRandom random(5);
  for (std::uint32_t round = 0; round < 2000; ++round) {
    std::uint32_t sum = 0;
    double mean = 0.0;
    for (std::uint32_t i = 0; i < 16; ++i) {
      const float value = random.unit();
      add_steps(sum, sum_steps(value));
      mean += double{value} / 16.0;
    }
    const double level = mean * 255.0;
    const auto found = static_cast<double>(level_of_sum(sum, 1.0f / (kSumSteps * 16.0f)));
    EXPECT_LE(std::fabs(found - level), 0.5 + 255.0 * 0x1p-20);
  }
}

}  // namespace
}  // namespace gridiron::test
