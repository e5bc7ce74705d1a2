// Sine, cosine and power of the effects: polynomials in floats instead of libm, without tables. Coefficients: minimax
// by Remez' exchange, rounded to floats. Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>

#include <bit>
#include <cstdint>

namespace gridiron {

/// Sine and cosine of 2 pi turn, each within 2^-22, and exact at whole quarters. Precondition: turn in [0, 1].
///
/// What is left of the turn beside the nearest quarter, r in [-1/8, 1/8], is exact: from 1/8 on a float is a multiple
/// of 2^-26. Polynomials: 2^-29.6 (sine), 2^-24.8 (cosine); the rest is rounding of values up to 1.
/// Source: core/EFFECTS.md, "Ambient light".
inline void sine_cosine_of_turn(float turn, float& sine, float& cosine) {
  const auto quarter = static_cast<std::int32_t>(4.0f * turn + 0.5f);
  const float r = turn - 0.25f * static_cast<float>(quarter);
  const float q = r * r;
  const float s = r * (6.28318501f + q * (-41.341629f + q * (81.5881271f + q * -75.2400665f)));
  const float c = 1.0f + q * (-19.7391682f + q * (64.9232254f + q * -83.6659241f));
  const bool is_odd = (quarter & 1) != 0;
  const float sine_part = is_odd ? c : s;
  const float cosine_part = is_odd ? s : c;
  sine = (quarter & 2) != 0 ? -sine_part : sine_part;
  cosine = ((quarter + 1) & 2) != 0 ? -cosine_part : cosine_part;
}

/// base^exponent for base in [0, 1], exponent in [0, 1e5]: in [0, 1], within 2^-21, and results of at least 2^-126
/// within 2^-14 of themselves. Smaller results are 0. Exponent 0 gives 1; else a base below 2^-126 gives 0. A base
/// above 1, which rounding can make of a cosine, counts as 1.
///
/// With z = exponent log2(base), a small error of z relative to z is enough, for 2^z |z| ln 2 never exceeds 1 / e: so
/// floats suffice for any exponent. log2(base) = k + log2(m), m in [sqrt(1/2), sqrt(2)): near base 1, k is 0 and m - 1
/// exact; else |log2(base)| >= 1/2 and nothing cancels. log2(m) = s P(s^2), s = (m - 1) / (m + 1), |s| < 0.172, P
/// within 2^-30.4 of itself. 2^z = 2^n 2^r, |r| <= 1/2, the latter within 2^-28.5 of itself.
/// Source: core/EFFECTS.md, "Lights".
[[nodiscard]] GRIDIRON_OUTLINE inline float power(float base, float exponent) {
  static constexpr std::uint32_t kOne = 0x3F800000u, kRootOfHalf = 0x3F3504F3u;  // 1, sqrt(1/2), as patterns
  static constexpr float kLeast = 0x1p-126f;
  const float from = base < 1.0f ? (base >= kLeast ? base : kLeast) : 1.0f;
  const std::uint32_t pattern = std::bit_cast<std::uint32_t>(from) + (kOne - kRootOfHalf);
  const float k = static_cast<float>(static_cast<std::int32_t>(pattern >> 23) - 127);
  const float m = std::bit_cast<float>((pattern & 0x007FFFFFu) + kRootOfHalf);
  const float s = (m - 1.0f) / (m + 1.0f);
  const float q = s * s;
  const float log2_m = s * (2.88539004f + q * (0.961798847f + q * (0.576714396f + q * 0.431735516f)));

  const float z = exponent * (k + log2_m);
  const float within = z >= -126.0f ? z : -126.0f;
  const auto n = static_cast<std::int32_t>(within - 0.5f);  // the nearest: z is not above 0
  const float r = within - static_cast<float>(n);
  const float high = 0.0555031039f + r * (0.00961769279f + r * (0.00134066434f + r * 0.000155946778f));
  const float exp2_r = 1.0f + r * (0.693147242f + r * (0.240226522f + r * high));
  const float result = exp2_r * std::bit_cast<float>(static_cast<std::uint32_t>(n + 127) << 23);
  const bool is_zero = z < -126.0f || (base < kLeast && exponent > 0.0f);
  return is_zero ? 0.0f : result;
}

}  // namespace gridiron
