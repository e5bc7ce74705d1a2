// A triangle's corners in lanes, and its area by floats: for what goes over all triangles of a mesh.
// Internal header. Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/build/lattice.h>
#include <gridiron/build/triangle_records.h>
#include <gridiron/scene/mesh.h>

#include <cstdint>

namespace gridiron {

/// x, y and z, and a number without meaning.
using CornerQuad = Lanes<4>::Float;

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
[[nodiscard]] GRIDIRON_INLINE Vec3 vec3_of(CornerQuad quad) {
  return {quad.v[0], quad.v[1], quad.v[2]};
}

/// y, z, x.
[[nodiscard]] GRIDIRON_INLINE CornerQuad turned(CornerQuad quad) {
  return Lanes<4>::shuffle_quads<1, 2, 0, 3>(quad);
}

/// The corners of a triangle.
struct CornerQuads {
  CornerQuad a, b, c;

  /// @param triangle  its indices are right.
  [[nodiscard]] static GRIDIRON_INLINE CornerQuads of(const MeshView& mesh, const UVec3& triangle) {
    return {quad_of(mesh.vertices[triangle.x]), quad_of(mesh.vertices[triangle.y]), quad_of(mesh.vertices[triangle.z])};
  }
  [[nodiscard]] static GRIDIRON_INLINE CornerQuads of(const LatticeMesh& mesh, const UVec3& triangle) {
    return {quad_of(mesh.vertices[triangle.x]), quad_of(mesh.vertices[triangle.y]), quad_of(mesh.vertices[triangle.z])};
  }

  [[nodiscard]] GRIDIRON_INLINE CornerQuad low() const { return Lanes<4>::min(Lanes<4>::min(a, b), c); }
  [[nodiscard]] GRIDIRON_INLINE CornerQuad high() const { return Lanes<4>::max(Lanes<4>::max(a, b), c); }

  /// False where floats do not decide. Sure, with u = 2^-24 and p - q a component of the normal: an edge component has an
  /// error of u of itself, a product of two 3 u and 2^-150, the difference u more, together less than 3.01 u (|p| + |q|)
  /// + u |p - q| + 2^-148. As |q| <= |p| + |p - q|, this is less than 7 u |p| + 5 u |p - q| + 2^-148. Where numbers
  /// overflow the bound is infinite or none, and nothing is greater.
  [[nodiscard]] GRIDIRON_INLINE bool surely_have_area() const {
    using L = Lanes<4>;
    constexpr L::FloatVector kShare = {0x1p-20f, 0x1p-20f, 0x1p-20f, 0x1p-20f};
    constexpr L::FloatVector kLeast = {0x1p-140f, 0x1p-140f, 0x1p-140f, 0x1p-140f};
    const CornerQuad e = b - a, f = c - a;
    const CornerQuad p = e * turned(f), q = turned(e) * f;
    const CornerQuad error = L::abs(p) * CornerQuad(kShare) + CornerQuad(kLeast);
    return ((L::abs(p - q) > error).bits() & 7u) != 0;
  }
  /// The function of triangle_records.h.
  [[nodiscard]] GRIDIRON_INLINE bool have_zero_area() const {
    return !surely_have_area() && has_zero_area(vec3_of(a), vec3_of(b), vec3_of(c));
  }
};

}  // namespace gridiron
