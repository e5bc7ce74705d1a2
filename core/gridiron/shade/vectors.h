// Vectors and colours of the effects: three floats with just what the formulas of core/EFFECTS.md need. Every operation
// is the IEEE one in the order written. Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/lanes.h>

#include <bit>
#include <cstdint>

namespace gridiron {

/// A vector, a point or a linear RGB colour.
struct Vector3 {
  float x, y, z;
};

/// @param source  three floats, as records hold them.
[[nodiscard]] constexpr GRIDIRON_INLINE Vector3 vector_of(const float* source) {
  return {source[0], source[1], source[2]};
}
constexpr GRIDIRON_INLINE void store(Vector3 a, float* target) {
  target[0] = a.x;
  target[1] = a.y;
  target[2] = a.z;
}

[[nodiscard]] constexpr GRIDIRON_INLINE Vector3 operator+(Vector3 a, Vector3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
[[nodiscard]] constexpr GRIDIRON_INLINE Vector3 operator-(Vector3 a, Vector3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
[[nodiscard]] constexpr GRIDIRON_INLINE Vector3 operator-(Vector3 a) {
  return {-a.x, -a.y, -a.z};
}
[[nodiscard]] constexpr GRIDIRON_INLINE Vector3 operator*(float factor, Vector3 a) {
  return {factor * a.x, factor * a.y, factor * a.z};
}
/// Component by component, as light is filtered.
[[nodiscard]] constexpr GRIDIRON_INLINE Vector3 operator*(Vector3 a, Vector3 b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
[[nodiscard]] constexpr GRIDIRON_INLINE float dot(Vector3 a, Vector3 b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

/// @returns a channel of a colour, 0 red to 2 blue: 0..1.
[[nodiscard]] GRIDIRON_INLINE float unpacked_channel(PackedColor word, std::uint32_t channel) {
  const std::uint32_t steps = word >> (kColorBits * channel) & kColorSteps;
  const float root = static_cast<float>(static_cast<std::int32_t>(steps)) * (1.0f / 1023.0f);
  return root * root;
}

/// a / |a|, its length 1 within 2^-21, for any finite size of a. The zero vector stays zero, so that a dot product with
/// it is 0. Where a core flushes denormals, vectors of denormals alone count as zero.
[[nodiscard]] inline Vector3 normalized(Vector3 a) {
  const float xy = magnitude(a.x) > magnitude(a.y) ? magnitude(a.x) : magnitude(a.y);
  const float size = magnitude(a.z) > xy ? magnitude(a.z) : xy;
  // A power of two that brings the size near 1, so that squares neither overflow nor vanish; 2^-127 is not a normal
  // float.
  std::uint32_t exponent = std::bit_cast<std::uint32_t>(size) >> 23;
  exponent = exponent < 1 ? std::uint32_t{1} : exponent > 253 ? std::uint32_t{253} : exponent;
  const Vector3 near_one = std::bit_cast<float>((254 - exponent) << 23) * a;
  const float squared = dot(near_one, near_one);
  return (squared > 0.0f ? 1.0f / square_root(squared) : 0.0f) * near_one;
}

}  // namespace gridiron
