// Computes normals at the vertices of a mesh without normals.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>

#include <span>
#include <vector>

namespace gridiron::tool {

/// @returns the vector of length 1 in its direction, 0 for the vector 0; whatever its length, no square overflows.
[[nodiscard]] DVec3 unit_or_zero(const DVec3& vector);

struct MeshNormals {
  std::vector<Vec3> normals;     ///< unit
  std::vector<UVec3> triangles;  ///< one per triangle, of indices into normals
};

/// Means of the normals of the triangles around each vertex, weighted so that vertices on a sphere get the sphere's.
///
/// If the mean of a vertex is 0, as on both sides of a sheet, each of its triangles gets that triangle's own normal
/// there; z if it has no area. Vertices are distinguished by index, so a mesh keeps an edge by doubling its vertices.
/// Cost: linear. Source: N. Max, "Weights for computing vertex normals from facet normals", 1999.
[[nodiscard]] MeshNormals make_mesh_normals(std::span<const Vec3> vertices, std::span<const UVec3> triangles);

}  // namespace gridiron::tool
