// Boxes of the wide tree, as its builder makes them and its checks expect them, bit for bit. Internal header.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/base/records.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/build/corner_quad.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace gridiron {

/// @returns corner 0..2 of a record.
[[nodiscard]] GRIDIRON_INLINE CornerQuad corner_quad(const VertexTriangle& record, int corner) {
  // Behind the last corner there is a reserved word, behind another one the next.
  return quad_at(reinterpret_cast<const std::byte*>(&record) + corner * std::ptrdiff_t{12});
}
[[nodiscard]] GRIDIRON_INLINE CornerQuads corner_quads(const VertexTriangle& record) {
  return {corner_quad(record, 0), corner_quad(record, 1), corner_quad(record, 2)};
}

/// The box of triangles or of a node, in lanes; at first empty. Zeros may have another sign than in the corners, which
/// is lost when the box grows.
struct QuadBox {
  CornerQuad low{kFloatMax}, high{-kFloatMax};

  GRIDIRON_INLINE void add(const CornerQuads& corners) {
    low = Lanes<4>::min(corners.low(), low);
    high = Lanes<4>::max(corners.high(), high);
  }
  GRIDIRON_INLINE void add(CornerQuad corner) {
    low = Lanes<4>::min(corner, low);
    high = Lanes<4>::max(corner, high);
  }
  /// @param margin  tree_margin() of all triangles.
  [[nodiscard]] GRIDIRON_INLINE QuadBox grown(float margin) const {
    const auto growth_of = [margin](CornerQuad place) GRIDIRON_INLINE_LAMBDA {
      return Lanes<4>::abs(place) * CornerQuad(kTreeGrowth) + CornerQuad(margin);
    };
    return {low - growth_of(low), high + growth_of(high)};
  }
  /// Twice the centre, rounded.
  [[nodiscard]] GRIDIRON_INLINE CornerQuad middle() const { return low + high; }
  [[nodiscard]] GRIDIRON_INLINE float half_surface() const {
    const CornerQuad size = high - low;
    const CornerQuad sides = size * turned(size);
    return lane_of(sides, 0) + lane_of(sides, 1) + lane_of(sides, 2);
  }

  /// The box of four.
  [[nodiscard]] static GRIDIRON_INLINE QuadBox around(const FourBoxes& boxes) {
    return {boxes.low.reduced(least), boxes.high.reduced(greatest)};
  }
  /// The box of a node: that of its children's boxes. Those that are not there change nothing.
  [[nodiscard]] static GRIDIRON_OUTLINE QuadBox of_node(const TreeNode& node) {
    using Quad = CornerQuad;
    const auto column = [](const float* sides, auto&& choose) GRIDIRON_INLINE_LAMBDA {
      return choose(choose(Quad::load(sides), Quad::load(sides + 4)),
                    choose(Quad::load(sides + 8), Quad::load(sides + 12)));
    };
    const QuadRows lows = {column(node.low[0], least), column(node.low[1], least), column(node.low[2], least)};
    const QuadRows highs = {column(node.high[0], greatest), column(node.high[1], greatest),
                            column(node.high[2], greatest)};
    return {lows.reduced(least), highs.reduced(greatest)};
  }

 private:
  [[nodiscard]] static GRIDIRON_INLINE CornerQuad least(CornerQuad a, CornerQuad b) { return Lanes<4>::min(a, b); }
  [[nodiscard]] static GRIDIRON_INLINE CornerQuad greatest(CornerQuad a, CornerQuad b) { return Lanes<4>::max(a, b); }
};

/// Bounds points, all of them. @returns false if a coordinate is no number or beyond kCoordinateLimit.
[[nodiscard]] inline bool bound_points(std::span<const Vec3> points, QuadBox& box) {
  if (points.empty()) return true;
  const CornerQuad limit(kCoordinateLimit);
  QuadBox bounds;
  Lanes<4>::Mask inside = limit <= limit;
  const auto add = [&](CornerQuad point) GRIDIRON_INLINE_LAMBDA {
    bounds.add(point);
    inside = inside & (Lanes<4>::abs(point) <= limit);
  };
  for (std::size_t i = 0; i + 1 < points.size(); ++i) add(inner_quad(points, i));
  add(quad_of(points.back()));
  box = bounds;
  return (inside.bits() & 7u) == 7u;
}

/// @returns the margin by which boxes of triangles within these bounds are grown.
[[nodiscard]] inline float tree_margin_of(const float minimum[3], const float maximum[3]) {
  float largest = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    const float low = magnitude(minimum[axis]), high = magnitude(maximum[axis]);
    largest = low > largest ? low : largest;
    largest = high > largest ? high : largest;
  }
  return tree_margin(largest);
}

}  // namespace gridiron
