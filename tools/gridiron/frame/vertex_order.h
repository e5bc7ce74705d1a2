// Vertex order: where the vertices of a mesh lie in main memory, so that triangles one after another find theirs in few
// lines. Triangles keep their order and ids, so no byte of a scene image depends on it.
// Memory: 4 bytes a vertex. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "gridiron/scene/scene_input.h"

namespace gridiron::tool {

class VertexOrder {
 public:
  /// Finds the order: that of the mesh, that of their first use by triangles, or one along a curve through space; the
  /// one for which a core that builds gets the fewest lines. Preconditions: valid indices, finite vertices.
  explicit VertexOrder(const Mesh& mesh);

  /// @returns whether the order was found for the same triangles: so it is for all meshes of a series that only move.
  [[nodiscard]] bool is_of(const Mesh& mesh) const;

  /// Writes the mesh with its vertices in this order. Precondition: is_of(mesh).
  void place(const Mesh& mesh, Vec3* vertices, UVec3* triangles) const;

  /// Lines of vertices that cores of 256 KB get to code the triangles, in this order and in that of the mesh.
  [[nodiscard]] std::uint64_t lines() const { return lines_; }
  [[nodiscard]] std::uint64_t lines_before() const { return lines_before_; }

 private:
  std::vector<std::uint32_t> places_;  // of the mesh's vertices
  std::uint64_t triangles_hash_;
  std::uint64_t lines_before_, lines_;
};

}  // namespace gridiron::tool
