// Exact sums of products of up to three floats, in integers: the last word on signs, ties and zero areas.
// Integer arithmetic only, so that no rounding mode, contraction or flush-to-zero affects it.
// Memory: 216 bytes by value. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>

#include <cstdint>

namespace gridiron {

/// A sum of products a * b * c of finite floats, held exactly as a fixed-point number.
///
/// A product of three 24-bit mantissas has 72 bits; its lowest bit is at least 2^-447 and its highest below 2^385,
/// so 27 limbs of 32 bits hold any product and leave 28 bits of head room. Limbs are signed 64-bit with deferred
/// carries: up to 2^28 products may be added.
class ExactSum {
 public:
  static constexpr int kLimbCount = 27;
  static constexpr int kLowestExponent = -447;  ///< weight of bit 0 is 2^-447

  /// Adds sign * a * b * c; sign is +1 or -1. Preconditions: a, b, c finite.
  void add_product(int sign, float a, float b, float c);

  /// Adds sign * det[a, b, c], six products.
  void add_determinant(int sign, const float a[3], const float b[3], const float c[3]);

  /// Adds the component of (b - a) x (c - a) along the axis before v and w, six products.
  void add_normal_component(const float a[3], const float b[3], const float c[3], int v, int w);

  /// @returns -1, 0 or +1: the sign of the exact sum. Carries are settled as a side effect.
  [[nodiscard]] int sign();

  /// Settles carries and makes the sum non-negative; afterwards every limb is in [0, 2^32).
  /// @returns the sign the sum had.
  int take_magnitude();

  [[nodiscard]] std::uint32_t limb(int index) const { return static_cast<std::uint32_t>(limbs_[index]); }

 private:
  std::int64_t limbs_[kLimbCount] = {};
};

/// @returns sign of det[dir, a - org, b - org], exactly: the side of edge (a, b) on which the ray passes.
[[nodiscard, gnu::cold]] int exact_edge_sign(const float org[3], const float dir[3], const float a[3],
                                             const float b[3]);

/// @returns sign of det[a - org, b - org, c - org], exactly: the side of the triangle's plane on which org lies.
[[nodiscard, gnu::cold]] int exact_volume_sign(const float org[3], const float a[3], const float b[3],
                                               const float c[3]);

/// @returns true where (b - a) x (c - a) is exactly zero: the triangle has no area.
[[nodiscard]] bool exact_zero_area(const float a[3], const float b[3], const float c[3]);

/// The direction of (b - a) x (c - a): a positive multiple of it with its largest component in [1, 2^32), rounded to
/// 2^-50 of that component. All zero if the triangle has no area.
[[gnu::cold]] void exact_normal(const float a[3], const float b[3], const float c[3], double normal[3]);

/// Distance at which a ray meets the plane of a triangle, rounded to the nearest float (halves away from zero).
///
/// @returns N / D with N = det[a - org, b - org, c - org], D = det[dir, b - a, c - a]: positive when both have the same
///          sign; 0 when N is zero, D is zero, the quotient is negative, or it rounds below the least normal float;
///          kFloatMax when it is larger. Cost: bounded, at most 31 comparisons of big integers.
[[nodiscard, gnu::cold]] float exact_distance(const float org[3], const float dir[3], const float a[3],
                                              const float b[3], const float c[3]);

/// Order of the distances N / D, as in exact_distance, at which a ray meets the planes of two triangles.
///
/// @param first, second  vertices. Precondition: N and D of each have the same sign, not 0.
/// @returns -1 where the first is nearer, 0 where they are equal, +1. Cost: two products of big integers.
[[nodiscard, gnu::cold]] int exact_distance_order(const float org[3], const float dir[3], const float (&first)[3][3],
                                                  const float (&second)[3][3]);

}  // namespace gridiron
