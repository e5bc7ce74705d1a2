// Boxes of the wide tree, as its builder makes them and its checks expect them, bit for bit. Internal header.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/base/records.h>
#include <gridiron/base/tree_records.h>

#include <cstddef>
#include <cstdint>

namespace gridiron {

/// A box of triangles or of a node; at first empty.
struct TreeBox {
  float low[3] = {kFloatMax, kFloatMax, kFloatMax};
  float high[3] = {-kFloatMax, -kFloatMax, -kFloatMax};

  void add(int axis, float value) {
    low[axis] = value < low[axis] ? value : low[axis];
    high[axis] = value > high[axis] ? value : high[axis];
  }
  void add(const Vec3& p) {
    for (int axis = 0; axis < 3; ++axis) add(axis, p[axis]);
  }
  void add(const TreeBox& box) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = box.low[axis] < low[axis] ? box.low[axis] : low[axis];
      high[axis] = box.high[axis] > high[axis] ? box.high[axis] : high[axis];
    }
  }
  /// @param margin  tree_margin() of all triangles.
  void grow(float margin) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = grown_low(low[axis], margin);
      high[axis] = grown_high(high[axis], margin);
    }
  }
  /// Twice the centre, rounded; the least and the greatest that boxes inside can have.
  [[nodiscard]] Vec3 middle() const { return {low[0] + high[0], low[1] + high[1], low[2] + high[2]}; }
  [[nodiscard]] Vec3 low_middle() const { return {low[0] + low[0], low[1] + low[1], low[2] + low[2]}; }
  [[nodiscard]] Vec3 high_middle() const { return {high[0] + high[0], high[1] + high[1], high[2] + high[2]}; }
  [[nodiscard]] float half_surface() const {
    float size[3];
    for (int axis = 0; axis < 3; ++axis) size[axis] = high[axis] - low[axis];
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
  }
};

/// x, y and z of a corner, and a number without meaning.
using CornerQuad = Lanes<4>::Float;
[[nodiscard]] inline CornerQuad corner_quad(const VertexTriangle& record, int corner) {
  // Behind the last corner there is a reserved word, behind another one the next.
  float words[4];
  __builtin_memcpy(words, reinterpret_cast<const std::byte*>(&record) + corner * std::ptrdiff_t{12}, sizeof words);
  return CornerQuad::load(words);
}

/// The box of triangles, in lanes; zeros may have another sign than TreeBox gives them, which is lost when it grows.
struct QuadBox {
  CornerQuad low{kFloatMax}, high{-kFloatMax};

  void add(CornerQuad a, CornerQuad b, CornerQuad c) {
    low = Lanes<4>::min(Lanes<4>::min(a, b), Lanes<4>::min(c, low));
    high = Lanes<4>::max(Lanes<4>::max(a, b), Lanes<4>::max(c, high));
  }
  /// @returns the box, grown.
  [[nodiscard]] TreeBox grown(float margin) const {
    TreeBox box;
    for (int axis = 0; axis < 3; ++axis) {
      box.low[axis] = low.v[axis];
      box.high[axis] = high.v[axis];
    }
    box.grow(margin);
    return box;
  }
};

/// @returns the box of a triangle.
[[nodiscard]] inline TreeBox box_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  TreeBox box;
  box.add(a);
  box.add(b);
  box.add(c);
  return box;
}

/// @returns the box of a node: that of its children's boxes. Those that are not there change nothing.
[[nodiscard]] inline TreeBox box_of_node(const TreeNode& node) {
  using Quad = Lanes<4>::Float;
  TreeBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const auto low_at = [&node, axis](int i) { return Quad::load(node.low[axis] + 4 * i); };
    const auto high_at = [&node, axis](int i) { return Quad::load(node.high[axis] + 4 * i); };
    const Quad low = Lanes<4>::min(Lanes<4>::min(low_at(0), low_at(1)), Lanes<4>::min(low_at(2), low_at(3)));
    const Quad high = Lanes<4>::max(Lanes<4>::max(high_at(0), high_at(1)), Lanes<4>::max(high_at(2), high_at(3)));
    for (int i = 0; i < 4; ++i) {
      box.low[axis] = low.v[i] < box.low[axis] ? low.v[i] : box.low[axis];
      box.high[axis] = high.v[i] > box.high[axis] ? high.v[i] : box.high[axis];
    }
  }
  return box;
}

/// @returns the margin by which boxes of triangles within these bounds are grown.
[[nodiscard]] inline float tree_margin_of(const float minimum[3], const float maximum[3]) {
  float largest = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    const float low = __builtin_fabsf(minimum[axis]), high = __builtin_fabsf(maximum[axis]);
    largest = low > largest ? low : largest;
    largest = high > largest ? high : largest;
  }
  return tree_margin(largest);
}

}  // namespace gridiron
