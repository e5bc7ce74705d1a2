// The triangles of a mesh in the caller's memory, in lanes, four after four, with what the caches are asked for.
// Internal header. Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/build/corner_quad.h>
#include <gridiron/build/lattice.h>
#include <gridiron/platform/status.h>
#include <gridiron/scene/mesh.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace gridiron {

/// Triangles ahead of those that are taken whose corners the caches are asked for; a multiple of four.
inline constexpr std::size_t kTrianglesAhead = 16;

[[nodiscard]] GRIDIRON_INLINE std::span<const Vec3> stored_vertices(const MeshView& mesh) {
  return mesh.vertices;
}
[[nodiscard]] GRIDIRON_INLINE std::span<const Vec3> stored_vertices(const LatticeMesh& mesh) {
  return mesh.vertices.vertices;
}
/// Asks the caches for a triangle's corners, whose indices may be wrong.
template <class Mesh>
GRIDIRON_INLINE void ask_for_corners(const Mesh& mesh, const UVec3& triangle) {
  const std::uint64_t vertices = reinterpret_cast<std::uintptr_t>(stored_vertices(mesh).data());
  for (int corner = 0; corner < 3; ++corner) {
    __builtin_prefetch(reinterpret_cast<const void*>(vertices + triangle[corner] * std::uint64_t{sizeof(Vec3)}));
  }
}

[[nodiscard]] GRIDIRON_INLINE bool are_below(const UVec3& indices, std::int64_t end) {
  return indices.x < end && indices.y < end && indices.z < end;
}
/// Whether a triangle's indices are right, and none is the last one.
template <class Mesh>
[[nodiscard]] GRIDIRON_INLINE bool are_inner(const Mesh& mesh, const UVec3& triangle) {
  return are_below(triangle, static_cast<std::int64_t>(mesh.vertices.size()) - 1);
}

/// @returns a triangle's corners. @param triangle  its indices are right.
template <class Mesh>
[[nodiscard]] GRIDIRON_INLINE CornerQuads corners_of(const Mesh& mesh, const UVec3& triangle) {
  return {quad_of(mesh.vertices[triangle.x]), quad_of(mesh.vertices[triangle.y]), quad_of(mesh.vertices[triangle.z])};
}
/// The same with single loads, where no corner is the last vertex: see are_inner().
[[nodiscard]] GRIDIRON_INLINE CornerQuads inner_corners_of(const MeshView& mesh, const UVec3& triangle) {
  return {inner_quad(mesh.vertices, triangle.x), inner_quad(mesh.vertices, triangle.y),
          inner_quad(mesh.vertices, triangle.z)};
}
[[nodiscard]] GRIDIRON_INLINE CornerQuads inner_corners_of(const LatticeMesh& mesh, const UVec3& triangle) {
  return corners_of(mesh, triangle);
}

/// Calls take(triangle number of the first, four triangles, bits of those that are there and have an area) for all
/// triangles of a mesh, in order.
///
/// Errors: kBadIndex.
template <class Mesh, class Take>
[[nodiscard]] GRIDIRON_INLINE Status for_each_four(const Mesh& mesh, Take&& take) {
  const std::size_t count = mesh.triangles.size();
  const auto vertex_count = static_cast<std::int64_t>(mesh.vertices.size());
  UVec3 last_four[4];
  for (std::size_t i = 0; i < count; i += 4) {
    const UVec3* four = &mesh.triangles[i];
    std::uint32_t there = 15u;
    if (count - i < 4) {
      there = (1u << (count - i)) - 1u;
      for (std::size_t k = 0; k < 4; ++k) last_four[k] = mesh.triangles[i + k < count ? i + k : count - 1];
      four = last_four;
    }
    if (i + kTrianglesAhead + 4 <= count) {
      const UVec3* const later = four + kTrianglesAhead;
      for (int k = 0; k < 4; ++k) ask_for_corners(mesh, later[k]);
    }
    CornerQuads corners[4];
    if (are_inner(mesh, four[0]) && are_inner(mesh, four[1]) && are_inner(mesh, four[2]) && are_inner(mesh, four[3])) {
      for (int k = 0; k < 4; ++k) corners[k] = inner_corners_of(mesh, four[k]);
    } else {
      for (int k = 0; k < 4; ++k) {
        if (!are_below(four[k], vertex_count)) return Status::kBadIndex;
        corners[k] = corners_of(mesh, four[k]);
      }
    }
    const FourTriangles triangles = FourTriangles::of(corners);
    take(static_cast<std::uint32_t>(i), triangles, triangles.with_area() & there);
  }
  return Status::kOk;
}

}  // namespace gridiron
