// Builds the wide tree of a mesh: triangles sorted along a Z curve, and nodes of 16 children over their runs.
// Source: own; Morton codes and splits at their highest bits as in Lauterbach and others 2009, "Fast BVH Construction
// on GPUs". Memory: caller's. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/tree_records.h>
#include <gridiron/build/lattice.h>
#include <gridiron/platform/status.h>
#include <gridiron/scene/mesh.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace gridiron {

/// From how many triangles on codes are sorted by two large digits, not three small ones.
inline constexpr std::uint64_t kManyTreeTriangles = 1u << 15;

/// @returns bytes of working memory for a mesh of so many triangles, dropped ones included: two keys each, and how
/// often each value of each digit occurs.
[[nodiscard]] constexpr std::uint64_t tree_scratch_bytes(std::uint64_t triangle_count) {
  const std::uint64_t counts = triangle_count < kManyTreeTriangles ? 3u << 10 : 2u << 15;
  return 16 * triangle_count + counts * sizeof(std::uint32_t);
}

/// @returns a number of nodes that no mesh of so many triangles exceeds.
///
/// A node has exactly 16 children, or leaves alone: F of the first kind and B of the second have 15 F + 1 + (children
/// of B) leaves. With n triangles, more than L in each of B and at least one in each leaf of F: 15 F - B + 1 + (L + 1)
/// B <= n. And F nodes have room for B: B - 1 <= 15 F. F + B is greatest where both are equal, or for L = 15 and more
/// where B = 1; a root with a leaf alone is one more.
[[nodiscard]] constexpr std::uint64_t most_tree_nodes(std::uint64_t triangle_count, std::uint32_t leaf_triangles) {
  const std::uint64_t bottoms = triangle_count / (leaf_triangles + 1);
  return triangle_count / 15 + (leaf_triangles < 15 ? bottoms * (15 - leaf_triangles) / 15 : 0) + 2;
}

/// In which order TreeNode::order names the children of a node.
enum class TreeOrder : std::uint8_t {
  kForAnyHit,  ///< the densest first
  kByNumber,   ///< where no rays ask for any hit: saves the time to find another
};

/// What was built.
struct TreeSize {
  std::uint32_t node_count;              ///< node 0 is the root
  std::uint32_t triangle_count;          ///< records
  std::uint32_t dropped_triangle_count;  ///< zero-area triangles (decided exactly)
  std::uint32_t depth;                   ///< nodes on the longest path, 1..kMaxTreeDepth
  float low[3], high[3];                 ///< tight bounds of the triangles
};

/// Builds the tree. Same bytes for the same input on every host.
///
/// @param leaf_triangles  most records of a leaf, 1..kMaxTreeLeaf.
/// @param records  VertexTriangle of a MeshView, LatticeTriangle of a LatticeMesh; room for all triangles that have an
///                 area.
/// @param nodes    room for all nodes; most_tree_nodes() is enough.
/// @param scratch  8-byte aligned, at least tree_scratch_bytes().
/// Errors: kBadParameter, kBadVertex (beyond kCoordinateLimit), kBadIndex, kNoTriangles, kTooManyTriangles
/// (kMaxTreeTriangles); kMemoryTooSmall: of any of the three, whose contents are then undefined. Cost: linear.
[[nodiscard]] Status build_tree(const MeshView& mesh, std::uint32_t leaf_triangles, std::span<VertexTriangle> records,
                                std::span<TreeNode> nodes, std::span<std::byte> scratch, TreeSize& size,
                                TreeOrder order = TreeOrder::kForAnyHit);
[[nodiscard]] Status build_tree(const LatticeMesh& mesh, std::uint32_t leaf_triangles,
                                std::span<LatticeTriangle> records, std::span<TreeNode> nodes,
                                std::span<std::byte> scratch, TreeSize& size, TreeOrder order = TreeOrder::kForAnyHit);

}  // namespace gridiron
