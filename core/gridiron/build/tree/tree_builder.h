// Builds the wide tree of a mesh: triangles sorted along a Z curve, and nodes of 16 children over their runs.
// Source: own; Morton codes and splits at their highest bits as in Lauterbach and others 2009, "Fast BVH Construction
// on GPUs". Memory: caller's. Threads: one, or those that share the work. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/tree_records.h>
#include <gridiron/build/lattice.h>
#include <gridiron/build/tree/tree_size.h>
#include <gridiron/build/work_sharing.h>
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

/// Builds the tree. Same bytes for the same input on every host.
///
/// @param leaf_triangles  most records of a leaf, 1..kMaxTreeLeaf.
/// @param records  VertexTriangle of a MeshView, LatticeTriangle of a LatticeMesh; room for all triangles that have an
///                 area.
/// @param nodes    room for all nodes; most_tree_nodes() is enough.
/// @param scratch  8-byte aligned, at least tree_scratch_bytes().
/// @param sharing  threads; meshes below kManyTreeTriangles are not shared. For each thread but one `records` needs
/// room
///                 for 256 KB of counts, which lie there before records do; others do not take part.
/// Errors: kBadParameter, kBadVertex (beyond kCoordinateLimit), kBadIndex, kNoTriangles, kTooManyTriangles
/// (kMaxTreeTriangles); kMemoryTooSmall: of any of the three, whose contents are then undefined. Cost: linear.
[[nodiscard]] Status build_tree(const MeshView& mesh, std::uint32_t leaf_triangles, std::span<VertexTriangle> records,
                                std::span<TreeNode> nodes, std::span<std::byte> scratch, TreeSize& size,
                                TreeOrder order = TreeOrder::kForAnyHit, const WorkSharing& sharing = {});
[[nodiscard]] Status build_tree(const LatticeMesh& mesh, std::uint32_t leaf_triangles,
                                std::span<LatticeTriangle> records, std::span<TreeNode> nodes,
                                std::span<std::byte> scratch, TreeSize& size, TreeOrder order = TreeOrder::kForAnyHit,
                                const WorkSharing& sharing = {});

}  // namespace gridiron
