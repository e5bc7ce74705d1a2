// What a view's bound is made of: the scene, and triangles on their way to a tile's pixels with what hits may store.
// Source: own; core/README.md, "The worst tile of a view". Memory: values; borrows the image. Threads: any.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/dma/transfers.h>
#include <gridiron/engine/tree/tile_projection.h>
#include <gridiron/sim/view_bound.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace gridiron::sim::view {

using L = Lanes<4>;
using Float = L::Float;
using Int = L::Int;
inline constexpr std::uint32_t kLanes = L::kCount;

// Two ways to sum up a linear function at a pixel differ by less than this share of its span: each rounds at most 11
// times sums of at most 2 size^2, by half a kFloatUnit each time, and the span is twice 30 kFloatUnit size^2 or more.
inline constexpr float kEdgeSlack = 0.4f;
// In spans of a triangle's 1 / t, whose function's sum at a pixel may round by 12 of the 35 kFloatUnit that a span has
// at least: how far the kernel's sum may be off; from there on, how far what is stored for a hit may be below (an exact
// decision stores 2^-19 less) and above.
inline constexpr double kSumSlack = 0.35, kLessStored = 0.9, kMoreStored = 1.35;
// An exact decision stores a span of its own.
inline constexpr float kStoredSpan = 0x1.01p-17f;
// Blocks with more triangles than this, and tiles with more open pixels, are not looked into: each pixel is open, and
// costs the most.
inline constexpr std::size_t kMostOfBlock = 512;
inline constexpr std::uint64_t kMostLookedInto = 1u << 15;

// What is drawn: functions of the pixel as in memory, relative to an offset.
struct Shape {
  enum class Kind : std::uint8_t { kTiny, kDrawn, kCareful };

  float value[4], x[4], y[4];  // edges, then 1 / t
  float offset_x, offset_y;
  float edge_span;
  std::uint32_t box;
  std::uint32_t record;
  std::uint32_t node;  // nodes that the tile had entered when it was queued
  Kind kind;
  float span;  // of 1 / t

  // 1 / t at a pixel.
  [[nodiscard]] double near(std::uint32_t column, std::uint32_t row) const {
    return double{value[3]} + double{x[3]} * (column - double{offset_x}) + double{y[3]} * (row - double{offset_y});
  }
  // What is drawn block by block comes after all before it; else this depends on what else is kept.
  [[nodiscard]] bool is_in_order() const { return kind == Kind::kDrawn; }
};

// A shape's pixels of a block, by bits.
struct BlockPart {
  std::uint16_t possible;  // where it may be hit
  std::uint16_t edges;     // of these, where edges are open
  std::uint16_t open;      // and where it may have to be decided
  bool is_in_order;        // as of the shape
  std::uint32_t shape;
  float low, high;  // of what may be stored there

  [[nodiscard]] bool may_be(std::uint32_t pixel) const { return (possible >> pixel & 1u) != 0; }
  [[nodiscard]] bool is_sure(std::uint32_t pixel) const { return (possible >> pixel & ~edges >> pixel & 1) != 0; }
};

// What tiles of a frame have in common.
struct Scene {
  FrameHead head;
  TreeRecord tree{};
  const TreeNode* nodes = nullptr;
  const VertexTriangle* triangles = nullptr;
  std::uint64_t nodes_address = 0, triangles_address = 0;  // in main memory
  EyeProjection eye{};
  bool has_facing = false, trusts_floats = false, breaks_ties = false;

  explicit Scene(const ViewFrame& frame) : head(frame.head) {
    std::memcpy(&tree, frame.image.data() + (head.tree_address - head.image_address), sizeof tree);
    nodes = reinterpret_cast<const TreeNode*>(frame.image.data() + tree.nodes_offset_bytes);
    triangles = reinterpret_cast<const VertexTriangle*>(frame.image.data() + tree.triangles_offset_bytes);
    nodes_address = head.image_address + tree.nodes_offset_bytes;
    triangles_address = head.image_address + tree.triangles_offset_bytes;
    float largest = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      largest = std::max({largest, magnitude(tree.bounds_minimum[axis]), magnitude(tree.bounds_maximum[axis])});
    }
    eye = project_eye(head, largest);
    has_facing = head.shading == static_cast<std::uint32_t>(Shading::kSimple);
    trusts_floats = head.accuracy == static_cast<std::uint32_t>(Accuracy::kFast);
    breaks_ties = head.accuracy == static_cast<std::uint32_t>(Accuracy::kExact);
  }
};

// Commands and bytes of a transfer.
struct Transfer {
  std::uint64_t commands = 0, bytes = 0;
};
inline Transfer transfer_of(std::uint64_t address, std::uint32_t bytes) {
  Transfer transfer{0, bytes};
  for (std::uint32_t rest = bytes; rest != 0; ++transfer.commands) {
    const std::uint32_t piece = next_piece_bytes(MainAddress{address}, rest);
    address += piece;
    rest -= piece;
  }
  return transfer;
}
inline Transfer transfer_of(const Scene& scene, TreeChild child) {
  if (!child.is_leaf()) {
    return transfer_of(scene.nodes_address + std::uint64_t{child.node_index()} * sizeof(TreeNode), sizeof(TreeNode));
  }
  return transfer_of(scene.triangles_address + std::uint64_t{child.first()} * sizeof(VertexTriangle),
                     child.count() * static_cast<std::uint32_t>(sizeof(VertexTriangle)));
}

}  // namespace gridiron::sim::view
