// Computes normals at the corners of a mesh: smooth across edges that bend little, sharp across the others.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>

#include <span>

#include "scene_text/mesh_normals.h"

namespace gridiron::tool {

/// Corners at one place are joined where their triangles share an edge, are wound alike and differ by at most
/// `degrees`; joined corners get the mean of their triangles' normals, weighted as in make_mesh_normals(). Corners are
/// at one place if their vertices have equal coordinates, so that meshes without shared vertices (STL) are smooth too.
/// Triangles without area join nothing and get the normal z. At an edge of more than two triangles only those that
/// follow each other in the order of the mesh are compared.
///
/// @param degrees  from 0, where every corner gets its triangle's normal, to 180. Cost: n log n.
[[nodiscard]] MeshNormals make_crease_normals(std::span<const Vec3> vertices, std::span<const UVec3> triangles,
                                              float degrees);

}  // namespace gridiron::tool
