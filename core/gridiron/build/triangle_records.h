// Zero-area decision and the stored forms of a triangle.
// Source: Wald 2004, section 7.1.2 (projection). Memory: stack. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>
#include <gridiron/base/records.h>

#include <cstdint>

namespace gridiron {

/// Decides has_zero_area where doubles in one plane are not sure.
[[nodiscard]] bool decide_zero_area(const Vec3& a, const Vec3& b, const Vec3& c);

/// @returns true if the triangle has exactly zero area. Corners finite. Doubles decide nearly always, else integers.
///
/// Sure, with u = 2^-53: each edge component has an error of u of itself, a product of two 3 u, the difference u more,
/// together less than 3.01 u (|p| + |q|) + u |p - q| <= 4.01 u (|p| + |q|). Differences of floats are 0 or at least
/// 2^-149 and below 2^129, so nothing underflows or overflows.
[[nodiscard]] inline bool has_zero_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double p = (double{b.x} - double{a.x}) * (double{c.y} - double{a.y});
  const double q = (double{b.y} - double{a.y}) * (double{c.x} - double{a.x});
  const double difference = p - q;
  const double error = 0x1p-50 * (__builtin_fabs(p) + __builtin_fabs(q));
  if (__builtin_fabs(difference) > error) return false;
  return decide_zero_area(a, b, c);
}

/// Fills `record` with the triangle's projection along the axis of its largest normal component (least axis of equals).
///
/// Computed in double and rounded to float once; values beyond the floats saturate, so all are finite.
/// Precondition: the triangle has an area.
void make_projection_triangle(const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t triangle_id,
                              ProjectionTriangle& record);

}  // namespace gridiron
