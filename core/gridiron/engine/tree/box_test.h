// Boxes of a node against the rays of a list. A ray meets a box unless exact arithmetic says that it misses what is in
// it: entry and exit are (side - origin) x reciprocal, three roundings of at most 2^-23 each, and exits are taken
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

/// The same of its terms.
template <class L>
struct BoxTerms {
  typename L::Float scale[3], shift[3], t;

  GRIDIRON_INLINE explicit BoxTerms(const RayTerms& terms) : t(terms.t) {
    for (int axis = 0; axis < 3; ++axis) {
      scale[axis] = typename L::Float(terms.scale[axis]);
      shift[axis] = typename L::Float(terms.shift[axis]);
    }
  }
};

/// The sides of L::kCount boxes that rays of one octant enter and leave by.
template <class L>
struct BoxSides {
  using Float = typename L::Float;
  Float near[3], far[3];

  /// Measures the sides from a place.
  GRIDIRON_INLINE void measure_from(const float* place) {
    for (int axis = 0; axis < 3; ++axis) {
      near[axis] = near[axis] - Float(place[axis]);
      far[axis] = far[axis] - Float(place[axis]);
    }
  }

  /// @returns the boxes that a ray misses, as bits. @tparam kAreMeasured  from its origin.
  template <bool kAreMeasured>
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t missed_by(const BoxRay<L>& ray) const {
    Float in[3], out[3];
    for (int axis = 0; axis < 3; ++axis) {
      in[axis] = (kAreMeasured ? near[axis] : near[axis] - ray.origin[axis]) * ray.inverse[axis];
      out[axis] = (kAreMeasured ? far[axis] : far[axis] - ray.origin[axis]) * ray.inverse[axis];
    }
    const Float first = L::max(L::max(in[0], in[1]), L::max(in[2], Float(0.0f)));
    const Float last = L::min(L::min(out[0], out[1]), L::min(out[2], ray.t));
    return (first > last * Float(kExitFactor)).bits();
  }
  template <bool>
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t missed_by(const BoxTerms<L>& ray) const {
    Float in[3], out[3];
    for (int axis = 0; axis < 3; ++axis) {
      in[axis] = L::bounded_sum(near[axis], ray.scale[axis], ray.shift[axis]);
      out[axis] = L::bounded_sum(far[axis], ray.scale[axis], ray.shift[axis]);
    }
    const Float first = L::max(L::max(in[0], in[1]), L::max(in[2], Float(0.0f)));
    const Float last = L::min(L::min(out[0], out[1]), L::min(out[2], ray.t));
    return (first > last).bits();
  }
  /// Makes them fit terms of rays.
  GRIDIRON_INLINE void widen(const float* twice_farthest, std::uint32_t octant) {
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const Float outwards((octant >> axis & 1u) != 0 ? kWidening : -kWidening), most(twice_farthest[axis]);
      near[axis] = near[axis] + (L::abs(near[axis]) + most) * outwards;
      far[axis] = far[axis] - (L::abs(far[axis]) + most) * outwards;
    }
  }
};

/// Boxes of a node, or their unions: [axis][box].
struct BoxTable {
  const float *low, *high;
  std::uint32_t boxes;  ///< of an axis

  /// @returns the sides that rays of an octant enter and leave by. @param base  the first box: a multiple of L::kCount.
  template <class L>
  [[nodiscard]] GRIDIRON_INLINE BoxSides<L> sides(std::uint32_t octant, std::uint32_t base) const {
    BoxSides<L> sides;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const bool is_backwards = (octant >> axis & 1u) != 0;
      const std::uint32_t place = axis * boxes + base;
      sides.near[axis] = L::Float::load((is_backwards ? high : low) + place);
      sides.far[axis] = L::Float::load((is_backwards ? low : high) + place);
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
      const Float ab = least(L::template shuffle_quads<0, 4, 1, 5>(a, b), L::template shuffle_quads<2, 6, 3, 7>(a, b));
      const Float cd = least(L::template shuffle_quads<0, 4, 1, 5>(c, d), L::template shuffle_quads<2, 6, 3, 7>(c, d));
      least(L::template shuffle_quads<0, 1, 4, 5>(ab, cd), L::template shuffle_quads<2, 3, 6, 7>(ab, cd)).store(united);
    } else {
      for (std::uint32_t quad = 0; quad < 4; ++quad) {
        const float* const four = sides + 4 * quad;
        least(least(Float(four[0]), Float(four[1])), least(Float(four[2]), Float(four[3]))).store(united + quad);
      }
    }
  };
  for (int axis = 0; axis < 3; ++axis) {
    unite(
        node.low[axis], [](Float a, Float b) GRIDIRON_INLINE_LAMBDA { return L::min(a, b); }, unions.low[axis]);
    unite(
        node.high[axis], [](Float a, Float b) GRIDIRON_INLINE_LAMBDA { return L::max(a, b); }, unions.high[axis]);
  }
}

/// What lists are tested by: the rays, or their terms. box_ray_of() is one of them, fit_sides() prepares boxes.
template <class L>
[[nodiscard]] GRIDIRON_INLINE BoxRay<L> box_ray_of(BatchRay* rays, std::uint32_t word) {
  return BoxRay<L>(ray_of(rays, word));
}
template <class L>
GRIDIRON_INLINE void fit_sides(const BatchRay*, std::uint32_t, BoxSides<L>&) {}
template <class L>
[[nodiscard]] GRIDIRON_INLINE BoxTerms<L> box_ray_of(const TermsList* list, std::uint32_t word) {
  return BoxTerms<L>(terms_of(list->terms, word));
}
template <class L>
GRIDIRON_INLINE void fit_sides(const TermsList* list, std::uint32_t octant, BoxSides<L>& sides) {
  sides.widen(list->twice_farthest, octant);
}

/// Rays that are tested at once: one ray's test is a chain of results, two of them fill four lanes' pipes.
template <class L>
inline constexpr std::uint32_t kBoxRays = L::kCount == 4 ? 2 : 1;

/// Tests rays of one octant, those of a list from `begin` on, against the same boxes.
/// @param rays    or a TermsList.
/// @param list    ends with kListEnd; its words get bits of missed boxes, from `place` on.
/// @param closed  boxes that no ray meets so far. @returns where the octant ends.
template <bool kAreMeasured, class L, class Rays>
GRIDIRON_INLINE std::uint32_t mark_run(const BoxSides<L>* sides, Rays* rays, std::uint32_t* list, std::uint32_t begin,
                                       std::uint32_t place, Work kind, std::uint32_t& closed, WorkCounters& work) {
  static constexpr std::uint32_t kGroups = L::kCount < 4 ? 4 : L::kCount == 8 ? 2 : 1;
  const std::uint32_t behind = behind_octant(list[begin]);
  std::uint32_t i = begin, word = list[i], tests = 0;
  do {
    ++tests;
    if constexpr (kBoxRays<L> == 2) {
      // The last ray of an odd number is tested twice.
      const std::uint32_t next = list[i + 1];
      const bool are_two = next < behind;
      const std::uint32_t second = are_two ? i + 1 : i, second_word = are_two ? next : word;
      const BoxRay<L> first_ray(ray_of(rays, word)), second_ray(ray_of(rays, second_word));
      const std::uint32_t first_missed = sides->template missed_by<kAreMeasured>(first_ray),
                          second_missed = sides->template missed_by<kAreMeasured>(second_ray);
      list[i] = word | first_missed << place;
      list[second] = second_word | second_missed << place;
      closed &= first_missed & second_missed;
      i = second + 1;
    } else {
      const auto ray = box_ray_of<L>(rays, word);
      std::uint32_t missed = 0;
      for (std::uint32_t group = 0; group < kGroups; ++group) {
        missed |= sides[group].template missed_by<kAreMeasured>(ray) << group * L::kCount;
      }
      list[i] = word | missed << place;
      closed &= missed;
      ++i;
    }
    word = list[i];
  } while (word < behind);
  work.add(kind, tests);
  return i;
}

/// The same for all octants of a list, with room for L::kCount words more.
/// @param base   the first box: as many are tested as a part has. @param place  of its bit.
/// @tparam kShares  rays may have one origin. @param origin  this; null: each has its own.
/// @param kind  of work that a test of kBoxRays is. @returns the boxes that any ray meets.
template <class L, bool kShares, class Rays>
GRIDIRON_OUTLINE std::uint32_t mark_list(const BoxTable& boxes, std::uint32_t base, std::uint32_t place, Rays* rays,
                                         const float* origin, std::uint32_t* list, std::uint32_t count, Work kind,
                                         WorkCounters& work) {
  static constexpr std::uint32_t kGroups = L::kCount < 4 ? 4 : L::kCount == 8 ? 2 : 1;
  static constexpr std::uint32_t kBoxes = kTreeWidth / kBoxParts<L>;
  std::uint32_t closed = (1u << kBoxes) - 1;
  list[count] = kListEnd;
  for (std::uint32_t i = 0; i < count;) {
    work.add(Work::kListRun);
    work.charge_to(Work::kListRun);
    BoxSides<L> sides[kGroups];
    for (std::uint32_t group = 0; group < kGroups; ++group) {
      sides[group] = boxes.template sides<L>(octant_of(list[i]), base + group * L::kCount);
      fit_sides<L>(rays, octant_of(list[i]), sides[group]);
    }
    if (kShares && origin != nullptr) {
      for (BoxSides<L>& group : sides) group.measure_from(origin);
      work.charge_to(Work::kListSharedBox);
      i = mark_run<true, L>(sides, rays, list, i, place, Work::kListSharedBox, closed, work);
    } else {
      work.charge_to(kind);
      i = mark_run<false, L>(sides, rays, list, i, place, kind, closed, work);
    }
  }
  work.charge_to(Work::kListNode);
  // Words up to the next group of lanes miss all, so that take_marked() need not look where the list ends.
  for (std::uint32_t i = count; i % L::kCount != 0; ++i) list[i] = kMaskBits;
  return ~closed & ((1u << kBoxes) - 1);
}

/// Nodes of so many children are tested as they are, without unions.
inline constexpr std::uint32_t kFewChildren = 8;

/// Finds the boxes of a node that each ray of a list meets. @param level  gets the lists of its parts, behind `list`.
/// @param arena  of the lists. @returns the children that any ray meets.
template <class L, bool kShares, class Rays>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t mark_boxes(const TreeNode& node, Rays* rays, const float* origin,
                                                       std::uint32_t* arena, std::uint32_t list, std::uint32_t count,
                                                       ListLevel& level, WorkCounters& work) {
  const std::uint32_t there = (2u << (node.child_count - 1)) - 1;
  static constexpr std::uint32_t kStep = kListStep<L>, kParts = kBoxParts<L>, kPartBoxes = kTreeWidth / kParts;
  std::uint32_t end = (list + count + (kStep - 1)) & ~(kStep - 1);
  std::uint32_t open = 0;
  const BoxTable boxes{node.low[0], node.high[0], kTreeWidth};
  if (kParts == 1 || node.child_count <= kFewChildren) {
    static constexpr Work kKind = kParts == 1 ? Work::kListRayNode : Work::kListBoxQuad;
    for (std::uint32_t part = 0; part * kPartBoxes < node.child_count; ++part) {
      const std::uint32_t base = part * kPartBoxes;
      level.set_part(part, list, count);
      open |= mark_list<L, kShares>(boxes, base, base, rays, origin, arena + list, count, kKind, work) << base;
    }
  } else {
    NodeUnions unions;
    unite_boxes<L>(node, unions);
    const BoxTable united{unions.low[0], unions.high[0], 4};
    const std::uint32_t quads =
        mark_list<L, kShares>(united, 0, 0, rays, origin, arena + list, count, Work::kListRayNode, work);
    for (std::uint32_t rest = quads; rest != 0; rest &= rest - 1) {
      const std::uint32_t part = lowest_bit(rest);
      work.add(Work::kListEntry, count);
      work.charge_to(Work::kListEntry);
      const std::uint32_t taken = take_marked<L>(arena + list, count, part, arena + end);
      const std::uint32_t base = part * kPartBoxes;
      level.set_part(part, end, taken);
      open |= mark_list<L, kShares>(boxes, base, base, rays, origin, arena + end, taken, Work::kListBoxQuad, work)
              << base;
      end = (end + taken + (kStep - 1)) & ~(kStep - 1);
    }
  }
  level.end = end;
  return open & there;
}

}  // namespace gridiron
