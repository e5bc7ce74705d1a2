// Answers. SPDX-License-Identifier: Apache-2.0
#include "experiment/answers.h"

#include <gridiron/base/records.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

namespace gridiron::experiment {
namespace {

constexpr std::uint32_t kChannels = 3;

}  // namespace

std::size_t ulp_bin(std::uint64_t ulps) {
  return std::min<std::size_t>(static_cast<std::size_t>(std::bit_width(ulps)), kUlpBinCount - 1);
}

double HitCounts::per_million(std::uint64_t count) const {
  return rays == 0 ? 0.0 : 1e6 * static_cast<double>(count) / static_cast<double>(rays);
}

HitCounts& operator+=(HitCounts& sum, const HitCounts& more) {
  sum.rays += more.rays;
  sum.true_hits += more.true_hits;
  sum.holes += more.holes;
  sum.false_hits += more.false_hits;
  sum.wrong_triangles += more.wrong_triangles;
  sum.seen_through += more.seen_through;
  return sum;
}

double PictureErrors::psnr_db() const {
  return peak_signal_to_noise(square_sum, pixels * kChannels);
}

double PictureErrors::rms_error() const {
  return pixels == 0 ? 0.0 : std::sqrt(static_cast<double>(square_sum) / static_cast<double>(pixels * kChannels));
}

PictureErrors compare_colors(std::span<const std::uint32_t> truth, std::span<const std::uint32_t> colors) {
  PictureErrors found;
  found.pixels = truth.size();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i] == colors[i]) continue;
    ++found.differing_pixels;
    for (std::uint32_t channel = 0; channel < kChannels; ++channel) {
      const auto value_of = [channel](std::uint32_t pixel) { return static_cast<int>(pixel >> (8 * channel) & 0xFFu); };
      const auto error = static_cast<std::uint32_t>(std::abs(value_of(truth[i]) - value_of(colors[i])));
      found.square_sum += std::uint64_t{error} * error;
      found.greatest_pixel_error = std::max(found.greatest_pixel_error, error);
    }
  }
  return found;
}

HitCounts count_hits(const Answers& truth, const Answers& answers) {
  HitCounts counts;
  counts.rays = truth.ids.size();
  for (std::size_t i = 0; i < truth.ids.size(); ++i) {
    const bool is_true_hit = truth.ids[i] != kNoTriangle, is_hit = answers.ids[i] != kNoTriangle;
    counts.true_hits += is_true_hit ? 1u : 0u;
    counts.holes += is_true_hit && !is_hit ? 1u : 0u;
    counts.false_hits += is_hit && !is_true_hit ? 1u : 0u;
    if (!is_true_hit || !is_hit || truth.ids[i] == answers.ids[i]) continue;
    ++counts.wrong_triangles;
    counts.seen_through += double{answers.depth[i]} > double{truth.depth[i]} * (1 + kBehind) ? 1u : 0u;
  }
  return counts;
}

Comparison compare_answers(const Answers& truth, const Answers& answers) {
  Comparison found;
  found.hits = count_hits(truth, answers);
  std::vector<double> ulps, relative, all_ulps, all_relative;
  for (std::size_t i = 0; i < truth.ids.size(); ++i) {
    if (truth.ids[i] == kNoTriangle || answers.ids[i] == kNoTriangle) continue;
    const std::uint64_t distance = ulp_distance(answers.depth[i], truth.depth[i]);
    all_ulps.push_back(static_cast<double>(distance));
    all_relative.push_back(relative_error(answers.depth[i], truth.depth[i]));
    if (truth.ids[i] != answers.ids[i]) {
      found.wrong_at_true_depth += distance == 0 ? 1u : 0u;
      continue;
    }
    ulps.push_back(all_ulps.back());
    relative.push_back(all_relative.back());
    ++found.ulp_histogram[ulp_bin(distance)];
  }
  found.ulps = spread_of(std::move(ulps));
  found.relative = spread_of(std::move(relative));
  found.all_ulps = spread_of(std::move(all_ulps));
  found.all_relative = spread_of(std::move(all_relative));
  found.picture = compare_colors(truth.color, answers.color);
  return found;
}

}  // namespace gridiron::experiment
