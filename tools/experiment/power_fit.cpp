// Power fit. SPDX-License-Identifier: Apache-2.0
#include "experiment/power_fit.h"

#include <cmath>
#include <vector>

namespace gridiron::experiment {

PowerFit fit_power(std::span<const Point2> points) {
  std::vector<Point2> logs;
  Point2 mean;
  for (const Point2& point : points) {
    if (!(point.x > 0) || !(point.y > 0)) continue;
    logs.push_back({std::log(point.x), std::log(point.y)});
    mean.x += logs.back().x;
    mean.y += logs.back().y;
  }
  if (logs.size() < 2) return {};
  mean.x /= static_cast<double>(logs.size());
  mean.y /= static_cast<double>(logs.size());

  double xx = 0, xy = 0, yy = 0;
  for (const Point2& point : logs) {
    xx += (point.x - mean.x) * (point.x - mean.x);
    xy += (point.x - mean.x) * (point.y - mean.y);
    yy += (point.y - mean.y) * (point.y - mean.y);
  }
  if (!(xx > 0)) return {};
  const double exponent = xy / xx;
  return {.exponent = exponent,
          .factor = std::exp(mean.y - exponent * mean.x),
          .r_squared = yy > 0 ? xy * xy / (xx * yy) : 1.0};
}

}  // namespace gridiron::experiment
