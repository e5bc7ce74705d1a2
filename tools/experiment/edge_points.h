// Edge points: points on edges and vertices of a mesh that a picture shows.
// Memory: std::vector. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>
#include <gridiron/scene/mesh.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gridiron::experiment {

/// @returns a point on an edge of a triangle, or every fourth `turn` a vertex; turns go round the edges and along them.
[[nodiscard]] Vec3 edge_point(const MeshView& mesh, std::uint32_t id, std::size_t turn);

/// @returns `count` points on edges of visible triangles, spread evenly over the picture, every fourth of them a
/// vertex; none if nothing is visible. Rounding to floats moves them off the edge.
/// @param ids  the picture's triangles, kNoTriangle without a hit.
[[nodiscard]] std::vector<Vec3> edge_points(const MeshView& mesh, std::span<const std::uint32_t> ids,
                                            std::size_t count);

}  // namespace gridiron::experiment
