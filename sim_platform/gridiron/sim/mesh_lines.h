// Lines of memory that passes over a mesh miss in a cache: what the order of its triangles and vertices costs a
// builder. Memory: 8 bytes a triangle while it counts. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/scene/mesh.h>

#include <cstdint>

namespace gridiron::sim {

inline constexpr std::uint64_t kCachedBytes = 512 * 1024;  ///< of the general core's cache
inline constexpr std::uint64_t kCachedLineBytes = 128;
inline constexpr std::uint64_t kCachedLines = kCachedBytes / kCachedLineBytes;

/// Lines asked for out of sequence that a cache does not hold. Lines one behind the other are fetched ahead and not
/// counted. All 0 where the mesh fits the cache.
struct MeshLines {
  std::uint64_t vertices_in_order = 0;   ///< of vertices, triangle by triangle as the mesh has them
  std::uint64_t vertices_in_space = 0;   ///< the same, by the triangles' places in space, as cells and leaves have them
  std::uint64_t triangles_in_space = 0;  ///< of triangles, in that order
  /// Of the boxes of triangles, which lie as the mesh has these: piece by piece of space, each piece in the mesh's
  /// order, as a hierarchy's builder goes through its nodes.
  std::uint64_t boxes_in_space = 0;
};

/// @returns the same on every host. Precondition: indices and vertices are valid. Cost: a sort of the triangles.
[[nodiscard]] MeshLines count_mesh_lines(const MeshView& mesh);

}  // namespace gridiron::sim
