// What a node says of its children: their boxes, and in which order rays for any hit ask them. Internal header.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/build/corner_quad.h>
#include <gridiron/build/tree/tree_box.h>

#include <cstdint>

namespace gridiron {

/// TreeNode::order where no rays ask for any hit.
inline constexpr std::uint64_t kTreeOrderByNumber = 0xFEDCBA9876543210u;

/// A leaf stands for more of what it holds than a node, whose triangles a ray may still miss.
inline constexpr float kTreeLeafDensity = 1.5f;

/// @returns twice the area; where floats overflow or underflow any number, as it decides an order alone.
[[nodiscard]] inline float area_of(const CornerQuads& corners) {
  const CornerQuad e = corners.b - corners.a, f = corners.c - corners.a;
  const CornerQuad normal = e * turned(f) - turned(e) * f;  // z, x, y
  const CornerQuad squares = normal * normal;
  return square_root(lane_of(squares, 1) + lane_of(squares, 2) + lane_of(squares, 0));
}

/// @returns twice the areas of four triangles, bit by bit what area_of() gives for each.
[[nodiscard]] GRIDIRON_INLINE CornerQuad areas_of(const FourTriangles& triangles) {
  const auto difference = [](const QuadRows& p, const QuadRows& q) GRIDIRON_INLINE_LAMBDA {
    return QuadRows{p.x - q.x, p.y - q.y, p.z - q.z};
  };
  const QuadRows e = difference(triangles.b, triangles.a), f = difference(triangles.c, triangles.a);
  const CornerQuad x = e.y * f.z - e.z * f.y, y = e.z * f.x - e.x * f.z, z = e.x * f.y - e.y * f.x;
  return Lanes<4>::square_root(x * x + y * y + z * z);
}

/// @returns how much of a child's box its triangles fill.
[[nodiscard]] GRIDIRON_INLINE float density_of(float area, bool is_leaf, const QuadBox& box) {
  return area * (is_leaf ? kTreeLeafDensity : float{1.0f}) / box.half_surface();
}

/// @returns TreeNode::order: the densest first; of equal ones the first.
[[nodiscard]] inline std::uint64_t order_of(const float* densities, std::uint32_t count) {
  std::uint32_t children[kTreeWidth];
  for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
    std::uint32_t place = i;
    if (i < count) {
      for (; place > 0 && densities[children[place - 1]] < densities[i]; --place) {
        children[place] = children[place - 1];
      }
    }
    children[place] = i;
  }
  std::uint64_t order = 0;
  for (std::uint32_t i = 0; i < kTreeWidth; ++i) order |= std::uint64_t{children[i]} << 4 * i;
  return order;
}

/// Stores the boxes of a node's children. @param boxes  kTreeWidth of `low` and `high`; of children that are not there
/// empty.
template <class Box>
GRIDIRON_OUTLINE void store_child_boxes(const Box* boxes, TreeNode& node) {
  for (std::uint32_t i = 0; i < kTreeWidth; i += 4) {
    CornerQuad lows[4], highs[4];
    for (std::uint32_t k = 0; k < 4; ++k) {
      lows[k] = boxes[i + k].low;
      highs[k] = boxes[i + k].high;
    }
    QuadRows::of(lows).store(node.low, i);
    QuadRows::of(highs).store(node.high, i);
  }
}

}  // namespace gridiron
