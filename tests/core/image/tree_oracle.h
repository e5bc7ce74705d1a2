// What a kernel may rely on in the tree of an opened image, checked independently: by walking it, from the bytes.
// Source: core/SPEC.md. Memory: a set of ids. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/image/scene_image.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace gridiron::test {

/// Walks the tree of an image as a kernel does, but with every read checked.
class TreeWalk {
 public:
  TreeWalk(std::span<const std::byte> bytes, const SceneImageView& view)
      : bytes_(bytes), tree_(view.tree), view_(view), seen_(view.header.triangle_count, false) {}

  /// @returns what is wrong, or null.
  [[nodiscard]] const char* broken() {
    if (!view_.has_tree && (!view_.has_grid || view_.has_effects)) return "no tree";
    if (!view_.has_tree) return tree_.node_count == 0 && view_.tree_offset_bytes == 0 ? nullptr : "a tree of none";
    TreeRecord stored{};
    if (!read(view_.tree_offset_bytes, stored) || std::memcmp(&stored, &tree_, sizeof stored) != 0) return "the record";
    if (tree_.triangle_count != view_.header.triangle_count - view_.header.dropped_triangle_count) return "the count";
    if (tree_.depth > kMaxTreeDepth) return "the depth";
    float low[3], high[3];
    visit(TreeChild::node(0), 1, low, high);
    if (what_ == nullptr && next_record_ != tree_.triangle_count) what_ = "triangles that no leaf has";
    if (what_ == nullptr && node_count_ != tree_.node_count) what_ = "nodes that none names";
    if (what_ == nullptr && deepest_ != tree_.depth) what_ = "another depth";
    return what_;
  }

 private:
  template <class Record>
  bool read(std::uint64_t offset, Record& record) {
    if (offset > bytes_.size() || sizeof(Record) > bytes_.size() - offset) {
      what_ = "a record outside";
      return false;
    }
    std::memcpy(&record, bytes_.data() + offset, sizeof(Record));
    return true;
  }

  // Bounds the triangles below a child.
  void visit(TreeChild child, std::uint32_t depth, float (&low)[3], float (&high)[3]) {
    std::fill(low, low + 3, 3.4e38f);
    std::fill(high, high + 3, -3.4e38f);
    if (child.is_leaf()) {
      visit_leaf(child, low, high);
      return;
    }
    deepest_ = std::max(deepest_, depth);
    TreeNode node{};
    if (depth > kMaxTreeDepth) what_ = "a path that is too long";
    if (++node_count_ > tree_.node_count) what_ = "a node of two";
    if (child.node_index() >= tree_.node_count) what_ = "a node that is not there";
    if (what_ != nullptr) return;
    if (!read(tree_.nodes_offset_bytes + std::uint64_t{child.node_index()} * sizeof node, node)) return;
    if (node.child_count < 1 || node.child_count > kTreeWidth) {
      what_ = "child_count";
      return;
    }
    std::uint32_t asked = 0;
    for (std::uint32_t place = 0; place < node.child_count; ++place) asked |= 1u << (node.order >> 4 * place & 15u);
    if (asked != (1u << node.child_count) - 1) what_ = "order";
    for (std::uint32_t i = 0; i < kTreeWidth && what_ == nullptr; ++i) {
      if (i >= node.child_count) {
        for (int axis = 0; axis < 3; ++axis) {
          if (!(node.low[axis][i] > 3e38f && node.high[axis][i] < -3e38f)) what_ = "a box of no child";
        }
        continue;
      }
      float child_low[3], child_high[3];
      visit(node.children[i], depth + 1, child_low, child_high);
      for (int axis = 0; axis < 3 && what_ == nullptr; ++axis) {
        if (!(node.low[axis][i] < child_low[axis] && node.high[axis][i] > child_high[axis])) what_ = "a box too small";
        low[axis] = std::min(low[axis], child_low[axis]);
        high[axis] = std::max(high[axis], child_high[axis]);
      }
    }
  }

  void visit_leaf(TreeChild leaf, float (&low)[3], float (&high)[3]) {
    if (leaf.count() > tree_.leaf_triangles) what_ = "a leaf too large";
    if (leaf.first() != next_record_) what_ = "a leaf out of order";
    next_record_ += leaf.count();
    for (std::uint32_t i = leaf.first(); what_ == nullptr && i < leaf.first() + leaf.count(); ++i) {
      const std::uint64_t place = tree_.triangles_offset_bytes + std::uint64_t{i} * tree_.triangle_bytes;
      std::uint32_t id = 0;
      SurfaceRecord surface{};
      if (!read(place + tree_.triangle_bytes - sizeof id, id)) return;
      if (id >= view_.header.triangle_count || (view_.has_effects && seen_[id])) {
        what_ = "an id";
        return;
      }
      seen_[id] = true;
      if (view_.has_effects && !read(view_.effects.surfaces_offset_bytes + std::uint64_t{id} * sizeof surface, surface))
        return;
      for (int corner = 0; corner < 3; ++corner) {
        for (int axis = 0; axis < 3; ++axis) {
          float at = 0;
          if (tree_.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kLattice)) {
            std::uint16_t step = 0;
            if (!read(place + static_cast<std::uint64_t>(corner * 3 + axis) * sizeof step, step)) return;
            at = tree_.lattice.origin[axis] + tree_.lattice.step * static_cast<float>(step);
          } else if (!read(place + static_cast<std::uint64_t>(corner * 3 + axis) * sizeof at, at)) {
            return;
          }
          if (!(std::fabs(at) <= 0x1p121f)) what_ = "a corner out of range";
          if (view_.has_effects && std::memcmp(&at, &surface.v[corner][axis], sizeof at) != 0)
            what_ = "corners of another";
          low[axis] = std::min(low[axis], at);
          high[axis] = std::max(high[axis], at);
        }
      }
    }
  }

  std::span<const std::byte> bytes_;
  const TreeRecord& tree_;
  const SceneImageView& view_;
  std::vector<bool> seen_;  // by id
  std::uint32_t next_record_ = 0, node_count_ = 0, deepest_ = 0;
  const char* what_ = nullptr;
};

/// @returns what is wrong with the tree of an image that was opened, or null.
inline const char* broken_tree(std::span<const std::byte> bytes, const SceneImageView& view) {
  return TreeWalk(bytes, view).broken();
}

}  // namespace gridiron::test
