// Build work of the wide tree: the steps of build_tree() on the general core, priced by the same table as the grid's.
// Memory: 8 bytes a triangle while it counts. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/tree_records.h>
#include <gridiron/build/tree/tree_size.h>
#include <gridiron/scene/mesh.h>
#include <gridiron/sim/build_work.h>

#include <cstdint>
#include <span>

namespace gridiron::sim {

/// What build_tree() was asked for and has made.
struct BuiltTree {
  std::uint32_t leaf_triangles;     ///< most of a leaf
  TreeOrder order;                  ///< of children
  std::span<const TreeNode> nodes;  ///< all
};

/// Steps of build_tree() of a mesh of vertices as they are. A tree on a lattice has no prices.
/// @param lines  of the mesh.
[[nodiscard]] BuildWork tree_build_work(const MeshView& mesh, const BuiltTree& tree, const MeshLines& lines);

/// The same of a whole scene image that holds nothing but the tree: count_scene_image(), then build_scene_image().
/// @param image_bytes  of the image as it was written.
[[nodiscard]] BuildWork tree_image_work(const MeshView& mesh, const BuiltTree& tree, std::uint64_t image_bytes,
                                        const MeshLines& lines);

}  // namespace gridiron::sim
