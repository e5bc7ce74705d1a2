// Nodes of the hierarchy as stored in main memory: four children, one node a line.
// Source: Dammertz, Hanika, Keller 2008. Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron::bvh {

inline constexpr std::uint32_t kNodeWidth = 4;          ///< children a node has at most
inline constexpr std::uint32_t kMaxLeafTriangles = 64;  ///< triangles a leaf has at most, a power of two
inline constexpr std::uint32_t kMaxBvhDepth = 40;       ///< nodes on any way from the root to a leaf
/// A traversal needs no more: each node on the way leaves all children but one on the stack, the last one all.
inline constexpr std::uint32_t kStackEntries = (kNodeWidth - 1) * kMaxBvhDepth + 4;

/// Names a node or a leaf: a node by its index, a leaf by its first triangle, their count and the top bit.
struct BvhChild {
  std::uint32_t bits;

  static constexpr std::uint32_t kFirstBits = 25;
  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;  ///< no child
  [[nodiscard]] static constexpr BvhChild node(std::uint32_t index) { return {index}; }
  [[nodiscard]] static constexpr BvhChild leaf(std::uint32_t first, std::uint32_t count) {
    return {1u << 31 | (count - 1) << kFirstBits | first};
  }
  [[nodiscard]] constexpr bool is_leaf() const { return (bits >> 31) != 0; }
  [[nodiscard]] constexpr std::uint32_t node_index() const { return bits; }
  [[nodiscard]] constexpr std::uint32_t first_triangle() const { return bits & ((1u << kFirstBits) - 1); }
  [[nodiscard]] constexpr std::uint32_t triangle_count() const {
    return (bits >> kFirstBits & (kMaxLeafTriangles - 1)) + 1;
  }
};

/// A stored node: the boxes of its children, side by side in lanes. 128 bytes, 128-byte aligned.
struct alignas(128) BvhNode {
  alignas(16) float bounds[2][3][kNodeWidth];  ///< [low, high][axis][child], tight: the vertices' own floats
  alignas(16) BvhChild children[kNodeWidth];   ///< the first child_count are there, the others kNone
  std::uint32_t child_count;                   ///< 1..kNodeWidth
  std::uint32_t reserved[3];
};
inline constexpr std::uint32_t kNodeBytes = 128;
static_assert(sizeof(BvhNode) == kNodeBytes);

}  // namespace gridiron::bvh
