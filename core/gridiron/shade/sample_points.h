// Where samples lie: in a pixel, on an area light, in the hemisphere over a point; and the numbers that move them.
// Source: core/EFFECTS.md; hash: C. Wellons, lowbias32; tangents: Duff et al. 2017, "Building an Orthonormal Basis,
// Revisited". Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/shade/elementary.h>
#include <gridiron/shade/vectors.h>

#include <cstdint>

namespace gridiron {

/// A word whose every bit depends on every bit of `h`; one-to-one. Source: "Jitter".
[[nodiscard]] constexpr std::uint32_t mix32(std::uint32_t h) {
  h ^= h >> 16;
  h *= 0x7feb352du;
  h ^= h >> 15;
  h *= 0x846ca68bu;
  return h ^ (h >> 16);
}

/// The upper 24 bits as a fraction: [0, 1), exact. Source: "Jitter".
[[nodiscard]] constexpr float unit_float(std::uint32_t word) {
  return static_cast<float>(static_cast<std::int32_t>(word >> 8)) * 0x1p-24f;
}

/// Start of the jitter of a ray's hit. @param pixel  row * width + column in the frame. Source: "Jitter".
[[nodiscard]] constexpr std::uint32_t sample_seed(std::uint32_t path, std::uint32_t sample, std::uint32_t pixel) {
  return mix32(mix32(mix32(path) + sample) + pixel);
}

inline constexpr std::uint32_t kOcclusionPurpose = 0;
/// @param light  index among all lights, point lights first.
[[nodiscard]] constexpr std::uint32_t area_light_purpose(std::uint32_t light) {
  return 1 + light;
}

/// Two numbers in [0, 1).
struct Jitter {
  float j1, j2;
};

/// Source: "Jitter". @param seed  of sample_seed.
[[nodiscard]] constexpr Jitter jitter_of(std::uint32_t seed, std::uint32_t purpose) {
  const std::uint32_t key = mix32(seed + purpose * 0x9E3779B9u);
  return {unit_float(key), unit_float(mix32(key + 1))};
}

/// The 32 bits of s in reverse as a fraction of 2^32, exact. Precondition: s < 256. Source: "Lights".
[[nodiscard]] constexpr float reversed_fraction(std::uint32_t s) {
  s = (s & 0x55u) << 1 | (s & 0xAAu) >> 1;
  s = (s & 0x33u) << 2 | (s & 0xCCu) >> 2;
  s = (s & 0x0Fu) << 4 | s >> 4;
  return static_cast<float>(static_cast<std::int32_t>(s)) * 0x1p-8f;
}

/// Offset from a pixel's centre, in pixels, exact.
struct PixelOffset {
  float dx, dy;
};

/// Source: "Pixel". @param samples_per_pixel  1, 4 or 16. @param s  below it.
[[nodiscard]] constexpr PixelOffset pixel_offset(std::uint32_t samples_per_pixel, std::uint32_t s) {
  const float step = samples_per_pixel == 1 ? 1.0f : samples_per_pixel == 4 ? 0.25f : 0.0625f;
  const auto row_of_4 = static_cast<std::int32_t>(0x2031u >> (4 * s & 31u) & 15u);  // 1 3 0 2, the first lowest
  const float row = samples_per_pixel == 4 ? static_cast<float>(row_of_4) : 16.0f * reversed_fraction(s);
  const float column = static_cast<float>(static_cast<std::int32_t>(s));
  return {(column + 0.5f) * step - 0.5f, (row + 0.5f) * step - 0.5f};
}

/// A point along the edges of an area light, or of the unit square.
struct SquarePlace {
  float a;  ///< [0, 1]; 1 by rounding alone
  float b;  ///< [0, 1)
};

/// Point s of `count`: one in each stripe of a, well spread in b. Source: "Lights".
/// @param s  below count. @param count  1..kMaxEffectSamples.
[[nodiscard]] inline SquarePlace area_light_place(std::uint32_t s, std::uint32_t count, Jitter jitter) {
  const float index = static_cast<float>(static_cast<std::int32_t>(s));
  const float b = reversed_fraction(s) + jitter.j2;
  return {(index + jitter.j1) / static_cast<float>(static_cast<std::int32_t>(count)), b < 1.0f ? b : b - 1.0f};
}

/// Two unit vectors, perpendicular to a normal and to each other.
struct Tangents {
  Vector3 a, b;
};

/// Source: "Ambient light". @param normal  unit to rounding.
[[nodiscard]] inline Tangents tangents_of(Vector3 normal) {
  const float x = normal.x, y = normal.y, z = normal.z;
  const float g = z >= 0.0f ? 1.0f : -1.0f;
  const float q = -1.0f / (g + z);
  const float p = x * y * q;
  return {{1.0f + g * x * x * q, g * p, -g * x}, {p, g + y * y * q, -y}};
}

/// Direction s of `count` over a normal, unit to 2^-20, distributed by the cosine to the normal. Source: "Ambient
/// light".
/// @param s  below count. @param count  1..kMaxEffectSamples. @param normal  unit to rounding.
[[nodiscard]] inline Vector3 occlusion_direction(std::uint32_t s, std::uint32_t count, Jitter jitter, Vector3 normal) {
  const SquarePlace place = area_light_place(s, count, jitter);  // turn and u
  float sine, cosine;
  sine_cosine_of_turn(place.a, sine, cosine);
  const float r = square_root(place.b);
  const Tangents tangents = tangents_of(normal);
  return ((r * cosine) * tangents.a + (r * sine) * tangents.b) + square_root(1.0f - place.b) * normal;
}

}  // namespace gridiron
