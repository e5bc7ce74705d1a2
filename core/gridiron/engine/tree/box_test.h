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

/// Tests rays of one octant, those of a list from `begin` on, against the same boxes: words get their masks.
/// @param there  the boxes that there are. @returns where the octant ends.
template <class L>
GRIDIRON_INLINE std::uint32_t mark_run(const BoxSides<L>* sides, std::uint32_t there, BatchRay* rays,
                                       std::uint32_t* list, std::uint32_t begin, std::uint32_t count,
                                       std::uint32_t& open) {
  static constexpr std::uint32_t kGroups = L::kCount < 4 ? 4 : L::kCount == 8 ? 2 : 1;
  const std::uint32_t octant = octant_of(list[begin]);
  std::uint32_t i = begin;
  do {
    const std::uint32_t word = list[i];
    const BoxRay<L> ray(ray_of(rays, word));
    std::uint32_t met = 0;
    for (std::uint32_t group = 0; group < kGroups; ++group) met |= sides[group].met_by(ray) << group * L::kCount;
    met &= there;
    list[i] = (word & ~kMaskBits) | met;
    open |= met;
    ++i;
  } while (i < count && octant_of(list[i]) == octant);
  return i;
}

/// The same for all octants of a list, with room for L::kCount words more. @param boxes  TreeNode or NodeUnions.
/// @param base  the first of them. @param kind  of work that a ray is. @returns the boxes that any ray meets.
template <class L, class Boxes>
GRIDIRON_INLINE std::uint32_t mark_list(const Boxes& boxes, std::uint32_t base, std::uint32_t there, BatchRay* rays,
                                        std::uint32_t* list, std::uint32_t count, Work kind, WorkCounters& work) {
  static constexpr std::uint32_t kGroups = L::kCount < 4 ? 4 : L::kCount == 8 ? 2 : 1;
  std::uint32_t open = 0;
  work.add(kind, count);
  for (std::uint32_t i = 0; i < count;) {
    work.add(Work::kListRun);
    work.charge_to(Work::kListRun);
    const SidePlaces places(boxes, octant_of(list[i]));
    BoxSides<L> sides[kGroups];
    for (std::uint32_t group = 0; group < kGroups; ++group) sides[group] = places.load<L>(base + group * L::kCount);
    work.charge_to(kind);
    i = mark_run<L>(sides, there, rays, list, i, count, open);
  }
  work.charge_to(Work::kListNode);
  // Words up to the next group of lanes meet nothing, so that take_marked() need not look where the list ends.
  for (std::uint32_t i = count; i % L::kCount != 0; ++i) list[i] = 0;
  return open;
}

/// Finds the boxes of a node that each ray of a list meets. @param level  gets the lists of its parts, behind `list`.
/// @param arena  of the lists. @returns the children that any ray meets.
template <class L>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t mark_boxes(const TreeNode& node, BatchRay* rays, std::uint32_t* arena,
                                                       std::uint32_t list, std::uint32_t count, ListLevel& level,
                                                       WorkCounters& work) {
  const std::uint32_t there = (2u << (node.child_count - 1)) - 1;
  static constexpr std::uint32_t kStep = kListStep<L>;
  std::uint32_t end = (list + count + (kStep - 1)) & ~(kStep - 1);
  std::uint32_t open = 0;
  if constexpr (kBoxParts<L> == 1) {
    open = mark_list<L>(node, 0, there, rays, arena + list, count, Work::kListRayNode, work);
    level.lists[0] = list;
    level.ray_counts[0] = count;
  } else {
    NodeUnions unions;
    unite_boxes<L>(node, unions);
    const std::uint32_t quads = mark_list<L>(unions, 0, 15, rays, arena + list, count, Work::kListRayNode, work);
    for (std::uint32_t quad = 0; quad < kBoxParts<L>; ++quad) {
      level.ray_counts[quad] = 0;
      if ((quads >> quad & 1u) == 0) continue;
      work.add(Work::kListEntry, count);
      work.charge_to(Work::kListEntry);
      const std::uint32_t taken = take_marked<L>(arena + list, count, quad, arena + end);
      level.lists[quad] = end;
      level.ray_counts[quad] = taken;
      open |= mark_list<L>(node, 4 * quad, there >> 4 * quad & 15, rays, arena + end, taken, Work::kListBoxQuad, work)
              << 4 * quad;
      end = (end + taken + (kStep - 1)) & ~(kStep - 1);
    }
  }
  level.end = end;
  return open;
}

}  // namespace gridiron
