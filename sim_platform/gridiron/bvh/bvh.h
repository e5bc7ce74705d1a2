// Bounding volume hierarchy: four children a node, one node a line of main memory.
// Source: Wald 2007 (binned build by surface area), Dammertz, Hanika, Keller 2008 (four children).
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/bvh/bvh_node.h>
#include <gridiron/platform/status.h>
#include <gridiron/scene/mesh.h>

#include <atomic>
#include <cstdint>
#include <vector>

namespace gridiron::bvh {

inline constexpr std::uint32_t kMaxLineTriangles = 128;  ///< records of a cache line at most

struct BvhParameters {
  std::uint32_t bin_count = 8;        ///< per axis, 2..64
  std::uint32_t leaf_triangles = 24;  ///< most triangles of a leaf, 1..kMaxLeafTriangles
  float triangle_cost = 0.15f;        ///< of a test, in tests of a child's box
  std::uint32_t line_triangles = 64;  ///< records of a line of the triangle cache; a leaf lies in one line
  std::uint32_t line_nodes = 16;      ///< nodes of a line of the node cache, neighbours in the tree
  /// Nodes of so many triangles bin every axis, smaller ones the widest alone.
  std::uint32_t every_axis_from = kWidestAxisAlone;
  static constexpr std::uint32_t kWidestAxisAlone = 0xFFFFFFFF;
};

/// Counts of a build, to be priced on a machine. Integers, the same on every host.
struct BuildCounts {
  std::uint64_t bin_updates = 0;      ///< triangle boxes merged into bins, one per triangle, axis and split
  std::uint64_t bins_swept = 0;       ///< bins merged when splits were priced
  std::uint64_t triangles_moved = 0;  ///< places in the order written while partitioning
  std::uint64_t halving_steps = 0;    ///< triangles of nodes that were halved, times the bits of their number
  std::uint64_t boxes_bounded = 0;    ///< triangles of the root and of halves, whose bounds no bins tell
  std::uint64_t far_triangles = 0;    ///< triangles of nodes with more than kNearTriangles and at most a quarter of all
  static constexpr std::uint32_t kNearTriangles =
      4096;                           ///< their boxes fit 512 KB though each lies in a line of its own
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
  float low[3] = {}, high[3] = {};   ///< bounds of everything
  std::uint32_t depth = 0;           ///< nodes on the longest way to a leaf
  std::uint32_t triangle_count = 0;  ///< of the mesh, dropped ones included
};

/// Builds the hierarchy.
///
/// @param abort  stop between two nodes when it becomes true; may be null.
/// Errors: kBadParameter, kTooManyTriangles (2^25 records), kBadIndex, kBadVertex (not finite), kNoTriangles (none has
/// an area), kAborted. Cost: some 20 passes over the triangles.
[[nodiscard]] Status build_bvh(const MeshView& mesh, const BvhParameters& parameters, Bvh& bvh,
                               const std::atomic<bool>* abort = nullptr);

}  // namespace gridiron::bvh
