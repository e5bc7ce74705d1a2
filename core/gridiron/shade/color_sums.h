// Sums of a tile's pixels: integers, so that the order in which colours are added changes nothing.
// Source: core/EFFECTS.md, "Pixel". Memory: EffectStore. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/shade/elementary.h>

#include <cstdint>

namespace gridiron {

inline constexpr float kSumSteps = 0x1p20f;   ///< to a brightness of 1
inline constexpr float kMostAdded = 4095.0f;  ///< brighter values count as this

/// @returns the steps that one component adds; 0 unless it is above 0 (NaN included).
[[nodiscard]] GRIDIRON_INLINE std::uint32_t sum_steps(float value) {
  const float positive = value > 0.0f ? value : 0.0f;
  const float within = positive < kMostAdded ? positive : kMostAdded;
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(within * kSumSteps + 0.5f));
}

/// Adds with saturation; for numbers that are not negative the order does not matter.
GRIDIRON_INLINE void add_steps(std::uint32_t& sum, std::uint32_t steps) {
  const std::uint32_t total = sum + steps;
  sum = total < sum ? ~std::uint32_t{0} : total;
}

/// @returns the brightness that a sum stands for, 0..1. @param per_step  1 / (kSumSteps * samples of a pixel).
[[nodiscard]] GRIDIRON_INLINE float brightness_of(std::uint32_t sum, float per_step) {
  const float value = static_cast<float>(static_cast<std::int64_t>(sum)) * per_step;
  return value < 1.0f ? value : 1.0f;
}

/// @returns a brightness 0..1 as screens expect it, within 2^-20: 0..1. Source: IEC 61966-2-1.
[[nodiscard]] inline float srgb_of(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * power(linear, 1.0f / 2.4f) - 0.055f;
}

/// @returns 0..255. @param value  0..1.
[[nodiscard]] GRIDIRON_INLINE std::uint32_t level_of(float value) {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(value * 255.0f + 0.5f));
}

}  // namespace gridiron
