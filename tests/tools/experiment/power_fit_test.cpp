// Power fit: exponents of known curves. SPDX-License-Identifier: Apache-2.0
#include "experiment/power_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace gridiron::test {
namespace {

using experiment::fit_power;
using experiment::Point2;
using experiment::PowerFit;

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

}  // namespace
}  // namespace gridiron::test
