// Power fit: the exponent of a quantity that grows as a power of another.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace gridiron::experiment {

struct Point2 {
  double x = 0, y = 0;
};

/// y = factor * x^exponent.
struct PowerFit {
  double exponent = 0, factor = 0;
  double r_squared = 0;  ///< of the logarithms; 1: every point is on the curve
};

/// Least squares through the logarithms. Points with x or y <= 0 are left out. @returns all zero if fewer than two
/// different x remain.
[[nodiscard]] PowerFit fit_power(std::span<const Point2> points);

}  // namespace gridiron::experiment
