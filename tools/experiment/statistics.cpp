// Statistics. SPDX-License-Identifier: Apache-2.0
#include "experiment/statistics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace gridiron::experiment {
namespace {

// Rises by 1 from each float to the next; both zeros are 0.
std::int64_t ordinal_of(float number) {
  const std::int64_t bits = std::bit_cast<std::uint32_t>(number);
  constexpr std::int64_t kSign = std::int64_t{1} << 31;
  return bits < kSign ? bits : kSign - bits;
}

double nearest_rank(const std::vector<double>& sorted, std::size_t percent) {
  return sorted[(sorted.size() * percent + 99) / 100 - 1];
}

}  // namespace

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

std::uint64_t ulp_distance(float a, float b) {
  const std::int64_t difference = ordinal_of(a) - ordinal_of(b);
  return static_cast<std::uint64_t>(difference < 0 ? -difference : difference);
}

double relative_error(float value, float truth) {
  return value == truth ? 0.0 : std::fabs(double{value} - double{truth}) / std::fabs(double{truth});
}

Spread spread_of(std::vector<double> errors) {
  if (errors.empty()) return {0, std::nan(""), std::nan(""), std::nan("")};
  std::ranges::sort(errors);
  return {errors.size(), nearest_rank(errors, 50), nearest_rank(errors, 99), errors.back()};
}

double peak_signal_to_noise(std::uint64_t square_sum, std::uint64_t sample_count) {
  if (square_sum == 0) return std::numeric_limits<double>::infinity();
  constexpr double kPeak = 255;
  return 10 * std::log10(kPeak * kPeak * static_cast<double>(sample_count) / static_cast<double>(square_sum));
}

std::vector<bool> pareto_front(std::span<const Point2> points) {
  const auto is_finite = [](const Point2& point) { return std::isfinite(point.x) && std::isfinite(point.y); };
  const auto beats = [](const Point2& a, const Point2& b) {
    return a.x <= b.x && a.y <= b.y && (a.x < b.x || a.y < b.y);
  };
  std::vector<bool> front;
  for (const Point2& point : points) {
    const bool beaten =
        std::ranges::any_of(points, [&](const Point2& other) { return is_finite(other) && beats(other, point); });
    front.push_back(is_finite(point) && !beaten);
  }
  return front;
}

}  // namespace gridiron::experiment
