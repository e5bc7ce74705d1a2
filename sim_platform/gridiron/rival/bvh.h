// Bounding volume hierarchy of the rival: four children a node, one node a line of main memory.
// Source: Wald 2007 (binned build by surface area), Dammertz, Hanika, Keller 2008 (four children).
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/platform/status.h>
#include <gridiron/scene/mesh.h>

#include <cstdint>
#include <vector>

namespace gridiron::rival {

inline constexpr std::uint32_t kNodeWidth = 4;            ///< children a node has at most
inline constexpr std::uint32_t kMaxLeafTriangles = 8;     ///< triangles a leaf has at most
inline constexpr std::uint32_t kMaxBvhDepth = 40;         ///< nodes on any way from the root to a leaf
inline constexpr std::uint32_t kStackEntries = (kNodeWidth - 1) * kMaxBvhDepth + 1;  ///< a traversal needs no more

/// Names a node or a leaf: a node by its index, a leaf by its first triangle, their count and the top bit.
struct BvhChild {
  std::uint32_t bits;

  static constexpr std::uint32_t kFirstBits = 27;
  [[nodiscard]] static constexpr BvhChild node(std::uint32_t index) { return {index}; }
  [[nodiscard]] static constexpr BvhChild leaf(std::uint32_t first, std::uint32_t count) {
    return {1u << 31 | (count - 1) << kFirstBits | first};
  }
  [[nodiscard]] constexpr bool is_leaf() const { return (bits >> 31) != 0; }
  [[nodiscard]] constexpr std::uint32_t node_index() const { return bits; }
  [[nodiscard]] constexpr std::uint32_t first_triangle() const { return bits & ((1u << kFirstBits) - 1); }
  [[nodiscard]] constexpr std::uint32_t triangle_count() const { return (bits >> kFirstBits & 0xFu) + 1; }
};

/// A node as it lies in main memory: the boxes of its children, side by side in lanes. 128 bytes, 128-byte aligned.
struct alignas(128) BvhNode {
  float bounds[2][3][kNodeWidth];  ///< [low, high][axis][child], tight: the vertices' own floats
  BvhChild children[kNodeWidth];   ///< the first child_count are there
  std::uint32_t child_count;       ///< 1..kNodeWidth
  std::uint32_t reserved[3];
};
static_assert(sizeof(BvhNode) == 128);

struct BvhParameters {
  std::uint32_t bin_count = 16;          ///< per axis, 2..64
  std::uint32_t leaf_triangles = 4;      ///< most triangles of a leaf, 1..kMaxLeafTriangles
  float triangle_cost = 2;               ///< of a test, in tests of a child's box
  std::uint32_t line_triangles = 16;     ///< records of a line of the triangle cache; a leaf lies in one line
  std::uint32_t line_nodes = 8;          ///< nodes of a line of the node cache, neighbours in the tree
};

/// What a build did, for a price on a machine. Integers, the same on every host.
struct BuildCounts {
  std::uint64_t bin_updates = 0;      ///< triangle boxes merged into bins, one per triangle, axis and split
  std::uint64_t bins_swept = 0;       ///< bins merged when splits were priced
  std::uint64_t triangles_moved = 0;  ///< places in the order written while partitioning
  std::uint64_t records_written = 0;  ///< triangle records
  std::uint64_t binary_nodes = 0;     ///< nodes of the tree of pairs, leaves included
  std::uint64_t wide_nodes = 0;       ///< nodes after merging to four children
  std::uint64_t leaves = 0;
};

/// A hierarchy over the triangles of a mesh that have an area.
struct Bvh {
  std::vector<BvhNode> nodes;             ///< node 0 is the root; padded to whole cache lines
  std::vector<VertexTriangle> triangles;  ///< leaf by leaf, padded so that no leaf crosses a cache line
  BvhParameters parameters;
  BuildCounts counts;
  float low[3] = {}, high[3] = {};        ///< bounds of everything
  std::uint32_t depth = 0;                ///< nodes on the longest way to a leaf
  std::uint32_t triangle_count = 0;       ///< of the mesh, dropped ones included
};

/// Builds the hierarchy.
///
/// Errors: kBadParameter, kTooManyTriangles (2^27 records), kBadIndex, kBadVertex (not finite), kNoTriangles (none has
/// an area). Cost: some 20 passes over the triangles.
[[nodiscard]] Status build_bvh(const MeshView& mesh, const BvhParameters& parameters, Bvh& bvh);

}  // namespace gridiron::rival
