// Prediction: the cost of a frame's tiles by a machine profile, compared with the counts of a device.
// Memory: std::vector. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace gridiron::tool {

/// How well predicted tiles match counted ones.
struct PredictionQuality {
  double counted = 0, predicted = 0;   ///< sums over the tiles
  double rank_correlation = 0;         ///< Spearman's, of the tiles; ties share their rank; 1 where all are tied
  double largest_tile_error = 0;       ///< largest |predicted - counted| / counted of a tile

  /// @returns predicted over counted, less 1.
  [[nodiscard]] double frame_error() const;
};

/// @param counted, predicted  a value for each tile, above 0, equally many.
[[nodiscard]] PredictionQuality quality_of(std::span<const double> counted, std::span<const double> predicted);

}  // namespace gridiron::tool
