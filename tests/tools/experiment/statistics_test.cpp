// Statistics against closed forms. SPDX-License-Identifier: Apache-2.0
#include "experiment/statistics.h"

#include <numeric>

#include "support/test_headers.h"

namespace gridiron::test {
namespace {

using namespace experiment;

using Limits = std::numeric_limits<float>;

TEST(PowerFit, FindsExactPowers) {
  for (const double exponent : {-1.0, 0.0, 1.0 / 3.0, 1.0, 2.5}) {
    std::vector<Point2> points;
    for (const double x : {10.0, 20.0, 50.0, 1e6}) points.push_back({x, 7 * std::pow(x, exponent)});
    const PowerFit fit = fit_power(points);
    EXPECT_NEAR(fit.exponent, exponent, 1e-12);
    EXPECT_NEAR(fit.factor, 7, 1e-9);
    EXPECT_NEAR(fit.r_squared, 1, 1e-9);
  }
}

TEST(PowerFit, IsTheLeastSquaresLineOfTheLogarithms) {
  // In logarithms to base 10: (0, 0), (1, 0), (2, 3). Slope 3/2, intercept -1/2, r squared 27/36.
  const std::vector<Point2> points = {{1, 1}, {10, 1}, {100, 1000}};
  const PowerFit fit = fit_power(points);
  EXPECT_NEAR(fit.exponent, 1.5, 1e-12);
  EXPECT_NEAR(fit.factor, std::pow(10, -0.5), 1e-12);
  EXPECT_NEAR(fit.r_squared, 0.75, 1e-12);
}

TEST(PowerFit, PointsWithoutALogarithmAreLeftOut) {
  const std::vector<Point2> points = {{0, 5}, {10, 10}, {20, -1}, {100, 100}, {1000, 0}};
  EXPECT_NEAR(fit_power(points).exponent, 1, 1e-12);
}

TEST(PowerFit, NothingToFitIsZero) {
  const std::vector<Point2> one = {{10, 10}}, same = {{10, 10}, {10, 20}};
  EXPECT_EQ(fit_power({}).exponent, 0);
  EXPECT_EQ(fit_power(one).exponent, 0);
  EXPECT_EQ(fit_power(same).exponent, 0);
}

TEST(ErrorStatistics, UlpsCountTheFloatsBetween) {
  EXPECT_EQ(ulp_distance(1.0f, 1.0f), 0u);
  EXPECT_EQ(ulp_distance(0.0f, -0.0f), 0u);
  EXPECT_EQ(ulp_distance(-Limits::denorm_min(), Limits::denorm_min()), 2u);
  EXPECT_EQ(ulp_distance(1.0f, 2.0f), 1u << 23);
  EXPECT_EQ(ulp_distance(Limits::max(), Limits::infinity()), 1u);
  EXPECT_EQ(ulp_distance(Limits::lowest(), Limits::max()), 2ull * 0x7F7FFFFFu);
  // A walk in single steps, over a power of two and over zero.
  for (const float start : {std::nextafter(2.0f, 0.0f), -3 * Limits::denorm_min(), -1.0f, 1e30f}) {
    float walked = start;
    for (std::uint64_t steps = 1; steps <= 7; ++steps) {
      walked = std::nextafter(walked, Limits::infinity());
      EXPECT_EQ(ulp_distance(start, walked), steps) << start;
      EXPECT_EQ(ulp_distance(walked, start), steps) << start;
    }
  }
}

TEST(ErrorStatistics, RelativeErrorsAreSharesOfTheTruth) {
  EXPECT_EQ(relative_error(1.5f, 1.0f), 0.5);
  EXPECT_EQ(relative_error(0.5f, -1.0f), 1.5);
  EXPECT_EQ(relative_error(std::nextafter(1.0f, 2.0f), 1.0f), 0x1p-23);
  EXPECT_EQ(relative_error(0.0f, 0.0f), 0.0);
  EXPECT_EQ(relative_error(1e-45f, 0.0f), std::numeric_limits<double>::infinity());
}

// Nearest rank: the percentile is one of the values, and no more than its share lies above it.
TEST(ErrorStatistics, PercentilesAreNearestRanks) {
  std::vector<double> values(100);
  std::iota(values.begin(), values.end(), 1.0);
  std::ranges::shuffle(values, std::mt19937(7));
  Spread spread = spread_of(values);
  EXPECT_EQ(spread.count, 100u);
  EXPECT_EQ(spread.median, 50);
  EXPECT_EQ(spread.percentile_99, 99);
  EXPECT_EQ(spread.greatest, 100);
  values.push_back(101);
  spread = spread_of(values);
  EXPECT_EQ(spread.median, 51);
  EXPECT_EQ(spread.percentile_99, 100);
  spread = spread_of({3.0});
  EXPECT_EQ(spread.median, 3);
  EXPECT_EQ(spread.percentile_99, 3);
  EXPECT_EQ(spread.greatest, 3);
  spread = spread_of({9.0, 1.0});
  EXPECT_EQ(spread.median, 1);
  EXPECT_EQ(spread.percentile_99, 9);
  spread = spread_of({});
  EXPECT_EQ(spread.count, 0u);
  EXPECT_TRUE(std::isnan(spread.median) && std::isnan(spread.percentile_99) && std::isnan(spread.greatest));
}

TEST(ErrorStatistics, SignalToNoiseHasItsClosedForms) {
  EXPECT_DOUBLE_EQ(peak_signal_to_noise(255 * 255, 1), 0) << "as wrong as can be";
  EXPECT_DOUBLE_EQ(peak_signal_to_noise(300, 300), 20 * std::log10(255.0)) << "each by 1";
  EXPECT_DOUBLE_EQ(peak_signal_to_noise(100 * 255 * 255, 10'000), 20) << "one in a hundred by all";
  EXPECT_EQ(peak_signal_to_noise(0, 5), std::numeric_limits<double>::infinity());
}

// A point is on the front where, of all sorted by x, then y, none before it has as little y; equal points share it.
TEST(ErrorStatistics, TheFrontIsWhatASortFinds) {
  std::mt19937 random(11);
  std::uniform_int_distribution<int> coordinate(0, 12);
  for (int round = 0; round < 200; ++round) {
    std::vector<Point2> points;
    for (int i = 0; i < 20; ++i) {
      points.push_back({static_cast<double>(coordinate(random)), static_cast<double>(coordinate(random))});
    }
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&points](std::size_t i) { return std::pair(points[i].x, points[i].y); });
    std::vector<bool> expected(points.size());
    double least_x = -1, least_y = HUGE_VAL;
    for (const std::size_t i : order) {
      const bool again = points[i].x == least_x && points[i].y == least_y;
      expected[i] = again || points[i].y < least_y;
      if (points[i].y < least_y) {
        least_x = points[i].x;
        least_y = points[i].y;
      }
    }
    EXPECT_EQ(pareto_front(points), expected) << "round " << round;
  }
}

TEST(ErrorStatistics, WhatIsNotFiniteIsNeitherOnTheFrontNorBeats) {
  const double nan = std::nan("");
  EXPECT_EQ(pareto_front(std::vector<Point2>{{nan, 0}, {0, nan}, {1, 1}, {-HUGE_VAL, 0}}),
            (std::vector<bool>{false, false, true, false}));
  EXPECT_TRUE(pareto_front({}).empty());
}

}  // namespace
}  // namespace gridiron::test
