// Zero-area decision and the stored forms of a triangle.
// Source: Wald 2004, section 7.1.2 (projection). Memory: stack. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>
#include <gridiron/base/records.h>

#include <cstdint>

namespace gridiron {

/// @returns true where the triangle has exactly zero area. Corners finite. Double decides nearly always, integers else.
[[nodiscard]] bool has_zero_area(const Vec3& a, const Vec3& b, const Vec3& c);

/// Fills `record` with the triangle's projection along the axis of its largest normal component (least axis of equals).
///
/// Computed in double and rounded to float once; values beyond the floats saturate, so all are finite.
/// Precondition: the triangle has an area.
void make_projection_triangle(const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t triangle_id,
                              ProjectionTriangle& record);

}  // namespace gridiron
