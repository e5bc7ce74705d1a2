// The wide tree in main memory: nodes of 16 children over runs of triangle records. core/SPEC.md is the text form.
// Memory: described, not owned. Threads: read-only during a frame. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>

#include <cstdint>

namespace gridiron {

inline constexpr std::uint32_t kTreeWidth = 16;               ///< children of a node, at most
inline constexpr std::uint32_t kMaxTreeDepth = 12;            ///< nodes on a path
inline constexpr std::uint32_t kMaxTreeLeaf = 16;             ///< triangles of a leaf, at most
inline constexpr std::uint32_t kMaxTreeTriangles = 1u << 27;  ///< records of a tree, at most

/// A child of a node: another node, or a run of triangle records.
struct TreeChild {
  std::uint32_t bits;  ///< node: its index. leaf: bit 31, count - 1 in bits 27 to 30, first record below

  static constexpr std::uint32_t kLeaf = 1u << 31;
  [[nodiscard]] static constexpr TreeChild node(std::uint32_t index) { return {index}; }
  [[nodiscard]] static constexpr TreeChild leaf(std::uint32_t first, std::uint32_t count) {
    return {kLeaf | (count - 1) << 27 | first};
  }
  [[nodiscard]] constexpr bool is_leaf() const { return (bits & kLeaf) != 0; }
  [[nodiscard]] constexpr std::uint32_t node_index() const { return bits; }
  [[nodiscard]] constexpr std::uint32_t first() const { return bits & (kMaxTreeTriangles - 1); }
  [[nodiscard]] constexpr std::uint32_t count() const { return (bits >> 27 & 15u) + 1; }
};

/// How far the side of a box lies outside the triangles: `margin` and a share of its own place, so that a ray along it,
/// with a component of 0, does not leave it. @param margin  tree_margin() of all triangles.
inline constexpr float kTreeGrowth = 0x1p-22f;
[[nodiscard]] constexpr float tree_margin(float largest_coordinate) {
  const float margin = largest_coordinate * 0x1p-24f;
  return margin > 0x1p-126f ? margin : 0x1p-126f;
}
[[nodiscard]] constexpr float grown_low(float low, float margin) {
  return low - ((low < 0.0f ? -low : low) * kTreeGrowth + margin);
}
[[nodiscard]] constexpr float grown_high(float high, float margin) {
  return high + ((high < 0.0f ? -high : high) * kTreeGrowth + margin);
}

/// A node. It has exactly 16 children, or all are leaves. Children cover its records in order. Nodes are numbered level
/// by level, and within a level in the order of their records. Boxes are the least that hold the child's triangles,
/// grown.
struct alignas(64) TreeNode {
  float low[3][kTreeWidth];        ///< axis, child; of a child that is not there kFloatMax
  float high[3][kTreeWidth];       ///< of one that is not there -kFloatMax
  TreeChild children[kTreeWidth];  ///< of one that is not there 0
  std::uint64_t order;             ///< 4 bits a place: which child to ask first where any hit will do, then the next;
                                   ///< a permutation of 16; children that are not there last, by number
  std::uint32_t child_count;       ///< 1..kTreeWidth, at least 2 but in the root
  std::uint32_t reserved[13];
};
static_assert(sizeof(TreeNode) == 4 * kLineBytes);

/// A tree and where it lies. An image has one or none; a core fetches it when a frame begins.
struct TreeRecord {
  std::uint32_t node_count;              ///< 1..; node 0 is the root
  std::uint32_t triangle_count;          ///< records, 1..kMaxTreeTriangles: the kept triangles, each once
  std::uint32_t depth;                   ///< nodes on the longest path, 1..kMaxTreeDepth
  std::uint32_t leaf_triangles;          ///< of a leaf, at most; 1..kMaxTreeLeaf
  std::uint32_t triangle_format;         ///< TriangleFormat, kVertices or kLattice
  std::uint32_t triangle_bytes;          ///< record size
  std::uint64_t nodes_offset_bytes;      ///< TreeNode[node_count], from the image's first byte
  std::uint64_t triangles_offset_bytes;  ///< triangle records in the order of the leaves
  float bounds_minimum[3];               ///< tight bounds of the triangles, world space; a grid's too
  float bounds_maximum[3];               ///< the other corner
  Lattice lattice;                       ///< of kLattice; all zero in other formats
  std::uint32_t reserved[12];
};
static_assert(sizeof(TreeRecord) == 128);

}  // namespace gridiron
