// A triangle mesh in the caller's memory: readers fill it and the grid builder takes it.
// Memory: borrowed. Threads: read-only. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>

#include <span>

namespace gridiron {

/// Indexed triangles. Triangle i is (vertices[t.x], vertices[t.y], vertices[t.z]) with t = triangles[i].
struct MeshView {
  std::span<const Vec3> vertices;    ///< finite, each coordinate within kCoordinateLimit
  std::span<const UVec3> triangles;  ///< indices of vertices
};

}  // namespace gridiron
