// Quality of a prediction. SPDX-License-Identifier: Apache-2.0
#include "prediction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace gridiron::tool {
namespace {

// Ranks from 0; equal values share the mean of their ranks.
std::vector<double> ranks_of(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    for (std::size_t i = first; i < end; ++i) ranks[order[i]] = 0.5 * static_cast<double>(first + end - 1);
    first = end;
  }
  return ranks;
}

double correlation_of(std::span<const double> a, std::span<const double> b) {
  const auto count = static_cast<double>(a.size());
  const double mean_a = std::accumulate(a.begin(), a.end(), 0.0) / count;
  const double mean_b = std::accumulate(b.begin(), b.end(), 0.0) / count;
  double product = 0, square_a = 0, square_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    product += (a[i] - mean_a) * (b[i] - mean_b);
    square_a += (a[i] - mean_a) * (a[i] - mean_a);
    square_b += (b[i] - mean_b) * (b[i] - mean_b);
  }
  if (square_a == 0 || square_b == 0) return square_a == square_b ? 1 : 0;
  return product / std::sqrt(square_a * square_b);
}

}  // namespace

double PredictionQuality::frame_error() const {
  return predicted / counted - 1;
}

PredictionQuality quality_of(std::span<const double> counted, std::span<const double> predicted) {
  PredictionQuality quality;
  quality.counted = std::accumulate(counted.begin(), counted.end(), 0.0);
  quality.predicted = std::accumulate(predicted.begin(), predicted.end(), 0.0);
  quality.rank_correlation = correlation_of(ranks_of(counted), ranks_of(predicted));
  for (std::size_t i = 0; i < counted.size(); ++i) {
    quality.largest_tile_error =
        std::max(quality.largest_tile_error, std::abs(predicted[i] - counted[i]) / counted[i]);
  }
  return quality;
}

}  // namespace gridiron::tool
