// Answers: the hits of every pixel of a frame, compared with the truth.
// Memory: std::vector. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "experiment/statistics.h"

namespace gridiron::experiment {

/// The answers of a frame for its pixels, row-major, first row on top.
struct Answers {
  std::vector<std::uint32_t> color;  ///< 0xAABBGGRR; empty if not requested
  std::vector<std::uint32_t> ids;    ///< kNoTriangle where nothing is hit
  std::vector<float> depth;          ///< t times the length of the ray's direction, each rounded
};

/// Errors of t by their size in ulp: none, 1, 2 to 3, 4 to 7, ... the last bin also holds all greater ones.
inline constexpr std::size_t kUlpBinCount = 25;

/// @returns the bin of an error. @param ulps  as ulp_distance() gives it.
[[nodiscard]] std::size_t ulp_bin(std::uint64_t ulps);

/// The hits of rays, compared with the true ones.
struct HitCounts {
  std::uint64_t rays = 0;
  std::uint64_t true_hits = 0;        ///< rays that hit something in truth
  std::uint64_t holes = 0;            ///< of these, rays that hit nothing
  std::uint64_t false_hits = 0;       ///< rays that hit something and nothing in truth
  std::uint64_t wrong_triangles = 0;  ///< rays that hit another triangle than in truth
  std::uint64_t seen_through = 0;     ///< of these, rays that hit it farther away by more than kBehind of the distance

  /// `count` as a share of all rays, in millionths.
  [[nodiscard]] double per_million(std::uint64_t count) const;
  /// Rays that neither hit the true triangle nor correctly miss.
  [[nodiscard]] std::uint64_t wrong_rays() const { return holes + false_hits + wrong_triangles; }
  /// Rays that pass through their true hit.
  [[nodiscard]] std::uint64_t leaks() const { return holes + seen_through; }
};

inline constexpr double kBehind = 1e-3;

/// Adds counts of other rays.
HitCounts& operator+=(HitCounts& sum, const HitCounts& more);

/// Precondition: as many rays of each. Ignores colours.
[[nodiscard]] HitCounts count_hits(const Answers& truth, const Answers& answers);

/// The errors in the colours of a picture.
struct PictureErrors {
  std::uint64_t pixels = 0;
  std::uint64_t differing_pixels = 0;      ///< of another colour
  std::uint32_t greatest_pixel_error = 0;  ///< 0 to 255, of red, green or blue
  std::uint64_t square_sum = 0;            ///< of the errors of red, green and blue of all pixels

  [[nodiscard]] double psnr_db() const;    ///< over red, green and blue of all pixels; infinite if none differs
  [[nodiscard]] double rms_error() const;  ///< likewise, 0 to 255; 0 without pixels
};

/// Precondition: as many pixels of each, 0xAABBGGRR.
[[nodiscard]] PictureErrors compare_colors(std::span<const std::uint32_t> truth, std::span<const std::uint32_t> colors);

/// The errors in the answers of a frame. A pixel is a ray.
struct Comparison {
  HitCounts hits;
  std::uint64_t wrong_at_true_depth = 0;                    ///< of the wrong triangles, those at the true distance
  std::array<std::uint64_t, kUlpBinCount> ulp_histogram{};  ///< of the rays that hit the true triangle
  Spread ulps, relative;                                    ///< error of t of the rays that hit the true triangle
  Spread all_ulps, all_relative;                            ///< and of all that hit something and should
  PictureErrors picture;
};

/// Precondition: planes of the same size.
[[nodiscard]] Comparison compare_answers(const Answers& truth, const Answers& answers);

}  // namespace gridiron::experiment
