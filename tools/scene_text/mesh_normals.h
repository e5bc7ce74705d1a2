// Normals at the vertices of a mesh that brings none.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>

#include <span>
#include <vector>

namespace gridiron::tool {

struct MeshNormals {
  std::vector<Vec3> normals;     ///< unit
  std::vector<UVec3> triangles;  ///< one per triangle, of indices into normals
};

/// Means of the normals of the triangles around each vertex, weighted so that vertices on a sphere get the sphere's.
///
/// A vertex whose mean is 0, as on both sides of a sheet, lends each of its triangles that triangle's own normal; one
/// without area has z. Vertices are told apart by index, so where a mesh doubles a vertex it keeps an edge.
/// Cost: linear. Source: N. Max, "Weights for computing vertex normals from facet normals", 1999.
[[nodiscard]] MeshNormals make_mesh_normals(std::span<const Vec3> vertices, std::span<const UVec3> triangles);

}  // namespace gridiron::tool
