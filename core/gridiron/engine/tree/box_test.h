// Boxes of a node against the rays of a list. A ray meets a box unless exact arithmetic says that it misses what is in
// it: entry and exit are (side - origin) x reciprocal, three roundings of 2^-24 and less each, and exits are taken
// 2^-19 later. Boxes are stored grown, which covers the rest; core/TREE.md.
// Source: own. Memory: values. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/engine/tree/list_rays.h>
#include <gridiron/ray/ray_batch.h>

#include <cstdint>

namespace gridiron {

inline constexpr float kExitFactor = 1.0f + 0x1p-19f;

/// What the box test needs of a ray, in every lane.
template <class L>
struct BoxRay {
  typename L::Float origin[3], inverse[3], t;

  GRIDIRON_INLINE explicit BoxRay(const BatchRay& ray) {
    using Float = typename L::Float;
    if constexpr (L::kCount == 4) {
      const Float place = Float::load(ray.origin), reciprocals = Float::load(ray.inverse);
      origin[0] = L::template shuffle_quads<0, 0, 0, 0>(place);
      origin[1] = L::template shuffle_quads<1, 1, 1, 1>(place);
      origin[2] = L::template shuffle_quads<2, 2, 2, 2>(place);
      t = L::template shuffle_quads<3, 3, 3, 3>(place);
      inverse[0] = L::template shuffle_quads<0, 0, 0, 0>(reciprocals);
      inverse[1] = L::template shuffle_quads<1, 1, 1, 1>(reciprocals);
      inverse[2] = L::template shuffle_quads<2, 2, 2, 2>(reciprocals);
    } else {
      for (int axis = 0; axis < 3; ++axis) {
        origin[axis] = Float(ray.origin[axis]);
        inverse[axis] = Float(ray.inverse[axis]);
      }
      t = Float(ray.t);
    }
  }
};

/// The sides of L::kCount boxes that rays of one octant enter and leave by.
template <class L>
struct BoxSides {
  using Float = typename L::Float;
  Float near[3], far[3];

  /// @returns the boxes that a ray meets, as bits.
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t met_by(const BoxRay<L>& ray) const {
    Float in[3], out[3];
    for (int axis = 0; axis < 3; ++axis) {
      in[axis] = (near[axis] - ray.origin[axis]) * ray.inverse[axis];
      out[axis] = (far[axis] - ray.origin[axis]) * ray.inverse[axis];
    }
    const Float first = L::max(L::max(in[0], in[1]), L::max(in[2], Float(0.0f)));
    const Float last = L::min(L::min(out[0], out[1]), L::min(out[2], ray.t));
    return ~(first > last * Float(kExitFactor)).bits() & L::kAllBits;
  }
};

/// Where the sides of a node's boxes, or of their unions, lie that rays of one octant enter and leave by.
struct SidePlaces {
  const float *near[3], *far[3];

  template <class Boxes>
  GRIDIRON_INLINE SidePlaces(const Boxes& boxes, std::uint32_t octant) {
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const bool is_backwards = (octant >> axis & 1u) != 0;
      near[axis] = is_backwards ? boxes.high[axis] : boxes.low[axis];
      far[axis] = is_backwards ? boxes.low[axis] : boxes.high[axis];
    }
  }
  /// @param base  the first of the boxes: a multiple of L::kCount.
  template <class L>
  [[nodiscard]] GRIDIRON_INLINE BoxSides<L> load(std::uint32_t base) const {
    BoxSides<L> sides;
    for (int axis = 0; axis < 3; ++axis) {
      sides.near[axis] = L::Float::load(near[axis] + base);
      sides.far[axis] = L::Float::load(far[axis] + base);
    }
    return sides;
  }
};

/// The union boxes of a node's four quads of children.
struct NodeUnions {
  alignas(16) float low[3][4];
  alignas(16) float high[3][4];
};
template <class L>
GRIDIRON_INLINE void unite_boxes(const TreeNode& node, NodeUnions& unions) {
  using Float = typename L::Float;
  const auto unite = [](const float* sides, auto least, float* united) GRIDIRON_INLINE_LAMBDA {
    if constexpr (L::kCount == 4) {
      const Float a = Float::load(sides), b = Float::load(sides + 4), c = Float::load(sides + 8),
                  d = Float::load(sides + 12);
      const Float ab =
          least(L::template shuffle_quads<0, 4, 1, 5>(a, b), L::template shuffle_quads<2, 6, 3, 7>(a, b));
      const Float cd =
          least(L::template shuffle_quads<0, 4, 1, 5>(c, d), L::template shuffle_quads<2, 6, 3, 7>(c, d));
      least(L::template shuffle_quads<0, 1, 4, 5>(ab, cd), L::template shuffle_quads<2, 3, 6, 7>(ab, cd)).store(united);
    } else {
      for (std::uint32_t quad = 0; quad < 4; ++quad) {
        const float* const four = sides + 4 * quad;
        least(least(Float(four[0]), Float(four[1])), least(Float(four[2]), Float(four[3]))).store(united + quad);
      }
    }
  };
  for (int axis = 0; axis < 3; ++axis) {
    unite(node.low[axis], [](Float a, Float b) GRIDIRON_INLINE_LAMBDA { return L::min(a, b); }, unions.low[axis]);
    unite(node.high[axis], [](Float a, Float b) GRIDIRON_INLINE_LAMBDA { return L::max(a, b); }, unions.high[axis]);
  }
}

/// Finds the boxes of a node that each ray of a list meets, and writes them into its word.
/// @returns the children that any ray meets.
template <class L>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t mark_boxes(const TreeNode& node, BatchRay* rays, std::uint32_t* list,
                                                       std::uint32_t count, WorkCounters& work) {
  const std::uint32_t there = (2u << (node.child_count - 1)) - 1;
  std::uint32_t open = 0;
  NodeUnions unions;
  if constexpr (L::kCount <= 4) unite_boxes<L>(node, unions);
  work.add(Work::kListRayNode, count);
  for (std::uint32_t i = 0; i < count;) {
    const std::uint32_t octant = octant_of(list[i]);
    const SidePlaces boxes(node, octant);
    if constexpr (L::kCount > 4) {
      const BoxSides<L> sides = boxes.load<L>(0), others = boxes.load<L>(L::kCount == 16 ? 0 : 8);
      do {
        const BoxRay<L> ray(ray_of(rays, list[i]));
        std::uint32_t met = sides.met_by(ray);
        if constexpr (L::kCount == 8) met |= others.met_by(ray) << 8;
        met &= there;
        list[i] = (list[i] & ~kMaskBits) | met;
        open |= met;
        ++i;
      } while (i < count && octant_of(list[i]) == octant);
    } else {
      const SidePlaces united(unions, octant);
      work.charge_to(Work::kListRayNode);
      do {
        const std::uint32_t word = list[i];
        const BoxRay<L> ray(ray_of(rays, word));
        std::uint32_t quads = 0, met = 0;
        for (std::uint32_t base = 0; base < 4; base += L::kCount) quads |= united.load<L>(base).met_by(ray) << base;
        work.charge_to(Work::kListBoxQuad);
        for (; quads != 0; quads &= quads - 1) {
          work.add(Work::kListBoxQuad);
          const std::uint32_t base = 4 * lowest_bit(quads);
          std::uint32_t of_quad = 0;
          for (std::uint32_t k = 0; k < 4; k += L::kCount) of_quad |= boxes.load<L>(base + k).met_by(ray) << k;
          met |= of_quad << base;
        }
        work.charge_to(Work::kListRayNode);
        met &= there;
        list[i] = (word & ~kMaskBits) | met;
        open |= met;
        ++i;
      } while (i < count && octant_of(list[i]) == octant);
    }
  }
  return open;
}

}  // namespace gridiron
