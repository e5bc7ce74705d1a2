// A tree in the host's memory, as a source of lists of rays. Memory: std::vector. Threads: read by any.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/tree/tree_builder.h>
#include <gridiron/platform/contract.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace gridiron::test {

/// A mesh's tree, and what RayLists asks of a source.
class MemoryTree {
 public:
  MemoryTree(const MeshView& mesh, std::uint32_t leaf_triangles)
      : records_(mesh.triangles.size()), nodes_(most_tree_nodes(mesh.triangles.size(), leaf_triangles)) {
    std::vector<std::uint64_t> scratch(tree_scratch_bytes(mesh.triangles.size()) / 8);
    TreeSize size{};
    status_ = build_tree(mesh, leaf_triangles, records_, nodes_, std::as_writable_bytes(std::span(scratch)), size);
    for (int axis = 0; axis < 3; ++axis) {
      largest_ = std::max({largest_, std::fabs(size.low[axis]), std::fabs(size.high[axis])});
    }
    nodes_.resize(size.node_count);
  }
  [[nodiscard]] Status status() const { return status_; }    ///< of the build
  [[nodiscard]] float largest() const { return largest_; }   ///< |coordinate|
  [[nodiscard]] std::uint64_t bytes() const {                ///< of nodes and records
    return nodes_.size() * sizeof(TreeNode) + records_.size() * sizeof(VertexTriangle);
  }

  // As a source.
  [[nodiscard]] static std::uint32_t window() { return 2; }
  [[nodiscard]] Status ahead(TreeChild child) const {
    if (child.is_leaf()) {
      __builtin_prefetch(&records_[child.first()]);
      __builtin_prefetch(reinterpret_cast<const std::byte*>(&records_[child.first()]) + 64);
    } else {
      for (int line = 0; line < 8; ++line) {
        __builtin_prefetch(reinterpret_cast<const std::byte*>(&nodes_[child.node_index()]) + 64 * line);
      }
    }
    return Status::kOk;
  }
  [[nodiscard]] Status node(std::uint32_t index, const TreeNode*& node) const {
    node = &nodes_[index];
    return Status::kOk;
  }
  [[nodiscard]] Status leaf(TreeChild child, const VertexTriangle*& records) const {
    records = &records_[child.first()];
    return Status::kOk;
  }
  [[nodiscard]] Status record(std::uint32_t number, VertexTriangle& triangle) const {
    triangle = records_[number];
    return Status::kOk;
  }
  [[nodiscard]] Status triangle_of(MainAddress, std::uint32_t id, VertexTriangle& triangle) const {
    const auto found =
        std::find_if(records_.begin(), records_.end(), [&](const VertexTriangle& t) { return t.triangle_id == id; });
    if (found == records_.end()) return Status::kBadIndex;
    triangle = *found;
    return Status::kOk;
  }

 private:
  std::vector<VertexTriangle> records_;
  std::vector<TreeNode> nodes_;
  Status status_ = Status::kOk;
  float largest_ = 0.0f;
};

}  // namespace gridiron::test
