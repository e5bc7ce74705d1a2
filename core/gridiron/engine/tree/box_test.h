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

  [[nodiscard]] GRIDIRON_INLINE auto met_by(const BoxRay<L>& ray) const {
    Float in[3], out[3];
    for (int axis = 0; axis < 3; ++axis) {
      in[axis] = (near[axis] - ray.origin[axis]) * ray.inverse[axis];
      out[axis] = (far[axis] - ray.origin[axis]) * ray.inverse[axis];
    }
    const Float first = L::max(L::max(in[0], in[1]), L::max(in[2], Float(0.0f)));
    const Float last = L::min(L::min(out[0], out[1]), L::min(out[2], ray.t));
    return first <= last * Float(kExitFactor);
  }
};

/// @param base  the first of the boxes: a multiple of L::kCount.
template <class L>
[[nodiscard]] GRIDIRON_INLINE BoxSides<L> sides_of(const TreeNode& node, std::uint32_t octant, std::uint32_t base) {
  BoxSides<L> sides;
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const bool is_backwards = (octant >> axis & 1u) != 0;
    sides.near[axis] = L::Float::load((is_backwards ? node.high[axis] : node.low[axis]) + base);
    sides.far[axis] = L::Float::load((is_backwards ? node.low[axis] : node.high[axis]) + base);
  }
  return sides;
}

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

/// @returns the quads whose union box a ray meets, as bits.
template <class L>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t quads_met(const NodeUnions& unions, std::uint32_t octant,
                                                      const BoxRay<L>& ray) {
  std::uint32_t met = 0;
  for (std::uint32_t base = 0; base < 4; base += L::kCount) {
    BoxSides<L> sides;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const bool is_backwards = (octant >> axis & 1u) != 0;
      sides.near[axis] = L::Float::load((is_backwards ? unions.high[axis] : unions.low[axis]) + base);
      sides.far[axis] = L::Float::load((is_backwards ? unions.low[axis] : unions.high[axis]) + base);
    }
    met |= sides.met_by(ray).bits() << base;
  }
  return met;
}

/// Finds the boxes of a node that each ray of a list meets: bit i of its mask = child i.
/// @param masks  room for `count`. @returns the children that any ray meets.
template <class L>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t mark_boxes(const TreeNode& node, BatchRay* rays, const std::uint16_t* list,
                                                       std::uint32_t count, std::uint16_t* masks, WorkCounters& work) {
  const std::uint32_t there = (2u << (node.child_count - 1)) - 1;
  std::uint32_t open = 0;
  NodeUnions unions;
  if constexpr (L::kCount <= 4) unite_boxes<L>(node, unions);
  work.add(Work::kListRayNode, count);
  for (std::uint32_t i = 0; i < count;) {
    const std::uint32_t octant = octant_of(list[i]);
    if constexpr (L::kCount > 4) {
      const BoxSides<L> sides = sides_of<L>(node, octant, 0);
      const BoxSides<L> others = sides_of<L>(node, octant, L::kCount == 16 ? 0 : 8);
      do {
        const BoxRay<L> ray(ray_of(rays, list[i]));
        std::uint32_t met = sides.met_by(ray).bits();
        if constexpr (L::kCount == 8) met |= others.met_by(ray).bits() << 8;
        met &= there;
        masks[i] = static_cast<std::uint16_t>(met);
        open |= met;
        ++i;
      } while (i < count && octant_of(list[i]) == octant);
    } else {
      do {
        work.charge_to(Work::kListRayNode);
        const BoxRay<L> ray(ray_of(rays, list[i]));
        std::uint32_t quads = quads_met<L>(unions, octant, ray), met = 0;
        for (; quads != 0; quads &= quads - 1) {
          work.add(Work::kListBoxQuad);
          work.charge_to(Work::kListBoxQuad);
          const std::uint32_t base = 4 * lowest_bit(quads);
          std::uint32_t of_quad = 0;
          for (std::uint32_t k = 0; k < 4; k += L::kCount) {
            of_quad |= sides_of<L>(node, octant, base + k).met_by(ray).bits() << k;
          }
          met |= of_quad << base;
        }
        work.charge_to(Work::kListRayNode);
        met &= there;
        masks[i] = static_cast<std::uint16_t>(met);
        open |= met;
        ++i;
      } while (i < count && octant_of(list[i]) == octant);
    }
  }
  return open;
}

}  // namespace gridiron
