// Statistics: exponents of power laws, errors in steps of floats, percentiles, signal to noise, Pareto front.
// Memory: std::vector. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "report/svg_plot.h"

namespace gridiron::experiment {

using plot::Point2;

/// y = factor * x^exponent.
struct PowerFit {
  double exponent = 0, factor = 0;
  double r_squared = 0;  ///< of the logarithms; 1: every point is on the curve
};

/// Least squares through the logarithms. Points with x or y <= 0 are left out. @returns all zero if fewer than two
/// different x remain.
[[nodiscard]] PowerFit fit_power(std::span<const Point2> points);

/// @returns the number of steps between two floats through all floats between them, which are units in the last place
/// if no power of two lies between: 0 for equal ones, 1 for neighbours; +0 and -0 are one float. Precondition: none is
/// NaN.
[[nodiscard]] std::uint64_t ulp_distance(float a, float b);

/// @returns |value - truth| / |truth|, 0 if they are equal.
[[nodiscard]] double relative_error(float value, float truth);

/// Percentiles of errors by nearest rank: the least error that `percent` of all do not exceed. NaN without errors.
struct Spread {
  std::uint64_t count = 0;
  double median = 0, percentile_99 = 0, greatest = 0;
};

[[nodiscard]] Spread spread_of(std::vector<double> errors);

/// @returns 10 log10(255^2 / mean square), decibels; infinite if nothing differs.
/// @param square_sum    of the differences of `sample_count` samples of 8 bits.
[[nodiscard]] double peak_signal_to_noise(std::uint64_t square_sum, std::uint64_t sample_count);

/// @returns for each point whether it is on the Pareto front: no other is at most as great in both coordinates and less
/// in one. Infinite points and NaN are not on it.
[[nodiscard]] std::vector<bool> pareto_front(std::span<const Point2> points);

}  // namespace gridiron::experiment
