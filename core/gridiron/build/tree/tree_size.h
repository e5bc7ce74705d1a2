// What all builders of the wide tree are asked for and say of it. Memory: values. Threads: any.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/tree_records.h>

#include <cstdint>

namespace gridiron {

/// @returns a number of nodes that no mesh of so many triangles exceeds.
///
/// A node has exactly 16 children, or leaves alone: F of the first kind and B of the second have 15 F + 1 + (children
/// of B) leaves. With n triangles, more than L in each of B and at least one in each leaf of F: 15 F - B + 1 + (L + 1)
/// B <= n. And F nodes have room for B: B - 1 <= 15 F. F + B is greatest where both are equal, or for L = 15 and more
/// where B = 1; a root with a leaf alone is one more.
[[nodiscard]] constexpr std::uint64_t most_tree_nodes(std::uint64_t triangle_count, std::uint32_t leaf_triangles) {
  const std::uint64_t bottoms = triangle_count / (leaf_triangles + 1);
  return triangle_count / 15 + (leaf_triangles < 15 ? bottoms * (15 - leaf_triangles) / 15 : std::uint64_t{0}) + 2;
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

}  // namespace gridiron
