// A point in lanes, its loads and stores: what corner_quad.h is made of. tools/calibrate has a counted form of this
// file. Internal header. Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace gridiron {

/// x, y and z, and a number without meaning.
using CornerQuad = Lanes<4>::Float;
/// One that lies in the store or in main memory, aligned to 16 bytes.
using StoredQuad = CornerQuad;

/// @returns four words that lie anywhere.
[[nodiscard]] GRIDIRON_INLINE CornerQuad quad_at(const void* words) {
  Lanes<4>::FloatVector loaded;
  __builtin_memcpy(&loaded, words, sizeof loaded);
  return CornerQuad(loaded);
}
/// Stores four words anywhere.
GRIDIRON_INLINE void store_at(CornerQuad quad, void* words) {
  __builtin_memcpy(words, &quad.v, sizeof quad.v);
}
/// @returns the point; the last lane is 0.
[[nodiscard]] GRIDIRON_INLINE CornerQuad quad_of(const Vec3& point) {
  typedef double PointHalves __attribute__((vector_size(16)));
  static_assert(sizeof(Vec3) == 12);
  double first_two;  // one load of eight bytes; their pattern is no number
  __builtin_memcpy(&first_two, &point, sizeof first_two);
  const PointHalves low = {first_two, 0.0};
  const Lanes<4>::FloatVector high = {point.z, 0.0f, 0.0f, 0.0f};
  return CornerQuad(__builtin_shufflevector(reinterpret_cast<Lanes<4>::FloatVector>(low), high, 0, 1, 4, 5));
}
/// @returns a point that is not the last one; the last lane is a coordinate of the next one.
[[nodiscard]] GRIDIRON_INLINE CornerQuad inner_quad(std::span<const Vec3> points, std::size_t index) {
  return quad_at(reinterpret_cast<const std::byte*>(points.data()) + index * sizeof(Vec3));
}
[[nodiscard]] GRIDIRON_INLINE Vec3 vec3_of(CornerQuad quad) {
  return {quad.v[0], quad.v[1], quad.v[2]};
}
/// @returns a word of four.
[[nodiscard]] GRIDIRON_INLINE float lane_of(CornerQuad quad, int lane) {
  return quad.v[lane];
}
/// @returns four words.
[[nodiscard]] GRIDIRON_INLINE Lanes<4>::Int words_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c,
                                                       std::uint32_t d) {
  return {Lanes<4>::IntVector{static_cast<std::int32_t>(a), static_cast<std::int32_t>(b), static_cast<std::int32_t>(c),
                              static_cast<std::int32_t>(d)}};
}

}  // namespace gridiron
