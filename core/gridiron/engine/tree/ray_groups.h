// Groups: 16 neighbouring rays, one a lane, that one or two beams bound. Nodes are tested against the beams, leaves
// against the rays; rays in no beam go as lists. Source: own; core/TREE.md. Memory: values. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/engine/tree/box_test.h>
#include <gridiron/engine/tree/leaf_test.h>
#include <gridiron/engine/tree/list_memory.h>
#include <gridiron/engine/tree/list_rays.h>
#include <gridiron/engine/tree/ray_beams.h>
#include <gridiron/ray/distance.h>
#include <gridiron/ray/ray_batch.h>

#include <cstddef>
#include <cstdint>

namespace gridiron {

// A group runs along an axis w; u and v are the others, in the order of the axes. Seen from its corner, w is measured
// the way that the rays run: no ray begins at w < 0. With slopes m = d.u / |d.w| of its rays, each of which begins at
// (U, W), s <= m for all of them and the offset o <= U - s W for all, a point of any ray has u >= s w + o: that is the
// lower plane of u, likewise the upper one, and those of v.
//
// With e = 2^-23, the largest relative error of an operation in any rounding mode: a slope has an error of 2 e |m|; U
// and W one of e each of themselves, and an offset 3 e (|U| + |s| W) with them. In the test of a box its sides seen
// from the corner have one of e; s w one of 2 e with that, and the sum rounds once more. Where the box just touches,
// its u is |s| w + |o| at most. So kGroupMargin of each slope, and of |U| + |s| W, is enough. What is lost below the
// least normal float is less than kLeastGroupMargin of the scene.
//
// Beside each plane stands a bound: the least or greatest u of all starts and ends, U and U + t d.u, moved outwards by
// kGroupMargin of |U| + |t d.u|, of which they round by 3 e.
inline constexpr float kGroupMargin = 0x1p-19f, kLeastGroupMargin = 0x1p-40f;
/// Added to where a beam ends, once hits have shortened it to what no factor lengthens: kLeastGroupMargin of the
/// smallest scene that has beams.
inline constexpr float kLeastReach = kLeastBeamScene * kLeastGroupMargin;
/// No beam is made if its slopes differ by more than kGroupSpread, or its rays begin farther apart than kGroupWidth of
/// its length, which counts as the scene's largest |coordinate| at most. Found by trials: wider beams meet too much.
inline constexpr float kGroupSpread = 0.25f, kGroupWidth = 0.1f;
/// Rays that a beam is worth its work for. Of fewer, scanned mirrors visit nodes twice.
inline constexpr std::uint32_t kLeastGroup = 8;
/// Once so many rays of a batch, and this part of those tried, are in no beam, the others are not tried any more: nodes
/// would be visited twice, by beams and by rays.
inline constexpr std::uint32_t kLoneRays = 48, kLoneShare = 3;

/// Puts kBeamRays rays in lanes.
/// @param largest  as in RayLists::trace(). @returns the rays that floats can test, as bits.
template <class L>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t load_group(const BatchRay* rays, float largest, RayGroup& group) {
  using Float = typename L::Float;
  const float farthest = largest * kFarBeam;
  const Float most_place(farthest < kGreatestListPlace ? farthest : kGreatestListPlace);
  std::uint32_t usual = 0;
  for (std::uint32_t base = 0; base < kBeamRays; base += L::kCount) {
    Float place[4], dir[4];
    load_ray_words<L>(rays[base].origin, place);
    load_ray_words<L>(rays[base].dir, dir);
    const Float longest = L::max(L::max(L::abs(dir[0]), L::abs(dir[1])), L::abs(dir[2]));
    const Float least = longest * Float(kLeastListComponent);
    for (int axis = 0; axis < 3; ++axis) {
      place[axis].store(group.origin[axis] + base);
      dir[axis].store(group.dir[axis] + base);
      const Float away = L::select(L::abs(dir[axis]) < least, L::turn_by(dir[axis], least), dir[axis]);
      (Float(1.0f) / away).store(group.inverse[axis] + base);
    }
    usual |= ((L::abs(place[0]) <= most_place) & (L::abs(place[1]) <= most_place) & (L::abs(place[2]) <= most_place) &
              (place[3] > Float(0.0f)) & (longest >= Float(kLeastListDirection)) &
              (longest <= Float(kGreatestListDirection)))
                 .bits()
             << base;
    place[3].store(group.t + base);
    longest.store(group.dir_max + base);
    L::words_of(dir[3]).store(group.ids + base);
  }
  return largest <= kGreatestListPlace ? usual : std::uint32_t{0};
}

/// The axes of a beam.
struct BeamAxes {
  std::uint32_t u, v, w;

  explicit constexpr BeamAxes(std::uint32_t along) : u(along == 0 ? 1 : 0), v(along == 2 ? 1 : 2), w(along) {}
  /// The axis along which a ray of a group runs the farthest.
  [[nodiscard]] static GRIDIRON_INLINE BeamAxes of_ray(const RayGroup& group, std::uint32_t ray) {
    const float x = magnitude(group.dir[0][ray]), y = magnitude(group.dir[1][ray]), z = magnitude(group.dir[2][ray]);
    return BeamAxes(x > y ? (x > z ? 0u : 2u) : (y > z ? 1u : 2u));
  }
};

/// @returns those of some rays of a group that run near one of them, and as it does, as bits.
template <class L>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t lanes_beside(const RayGroup& group, std::uint32_t lanes, std::uint32_t ray,
                                                         float largest) {
  using Float = typename L::Float;
  const BeamAxes axes = BeamAxes::of_ray(group, ray);
  const float along = magnitude(group.dir[axes.w][ray]), reach = group.t[ray] * along;
  const Float width(0.5f * kGroupWidth * (reach < largest ? reach : largest)), spread(0.5f * kGroupSpread);
  std::uint32_t beside = 0;
  for (std::uint32_t base = 0; base < kBeamRays; base += L::kCount) {
    const Float inverse = Float::load(group.inverse[axes.w] + base);
    const Float away = Float::load(group.origin[axes.w] + base) - Float(group.origin[axes.w][ray]);
    auto is_beside = inverse * Float(group.dir[axes.w][ray]) > Float(0.0f);
    const std::uint32_t others[2] = {axes.u, axes.v};
    for (const std::uint32_t axis : others) {
      const Float slope(group.dir[axis][ray] * group.inverse[axes.w][ray]);
      const Float turn = Float::load(group.dir[axis] + base) * inverse - slope;
      const Float start = Float::load(group.origin[axis] + base) - Float(group.origin[axis][ray]) - away * slope;
      is_beside = is_beside & (L::abs(turn) <= spread) & (L::abs(start) <= width);
    }
    beside |= is_beside.bits() << base;
  }
  return beside & lanes;
}

/// How far along its axis a beam looks from its corner. @returns below 0: its rays have all been answered.
template <class L>
[[nodiscard]] GRIDIRON_INLINE float group_reach(const RayGroup& group, const GroupBeam& beam, std::uint32_t axis) {
  using Float = typename L::Float;
  Float reach(-1.0f);
  for (std::uint32_t base = 0; base < kBeamRays; base += L::kCount) {
    const Float start = (Float::load(group.origin[axis] + base) - Float(beam.corner[2])) * Float(beam.turn);
    const Float t = Float::load(group.t + base);
    const Float end = L::bounded_sum(t, L::abs(Float::load(group.dir[axis] + base)), start);
    const auto looks = L::mask_from_bits(beam.lanes >> base & L::kAllBits) & (t >= Float(0.0f));
    reach = L::max(L::select(looks, end, Float(-1.0f)), reach);
  }
  return L::horizontal_max(reach) * (1.0f + kGroupMargin) + kLeastReach;
}

/// Makes a beam of some rays of a group. @param lanes  the rays, as bits; not 0.
/// @param largest  as in RayLists::trace(). @param reach  gets group_reach(). @param octant  gets that of the first
/// ray.
/// @returns the beam's axis, or kNoBeam.
template <class L>
[[nodiscard]] GRIDIRON_OUTLINE std::uint32_t make_group_beam(const RayGroup& group, std::uint32_t lanes, float largest,
                                                             GroupBeam& beam, float& reach, std::uint32_t& octant) {
  using Float = typename L::Float;
  static constexpr std::uint32_t kVectors = kBeamRays / L::kCount;
  const std::uint32_t ray = lowest_bit(lanes);
  const BeamAxes axes = BeamAxes::of_ray(group, ray);
  octant = (group.dir[0][ray] < 0.0f ? 1u : 0u) | (group.dir[1][ray] < 0.0f ? 2u : 0u) |
           (group.dir[2][ray] < 0.0f ? 4u : 0u);
  beam.turn = group.dir[axes.w][ray] < 0.0f ? -1.0f : 1.0f;
  beam.lanes = lanes;
  // In the other lanes the first of the rays stands again.
  const auto load = [&](const float* words, std::uint32_t base) GRIDIRON_INLINE_LAMBDA {
    return L::select(L::mask_from_bits(lanes >> base & L::kAllBits), Float::load(words + base), Float(words[ray]));
  };
  Float along[kVectors], inverse[kVectors], least_along(kFloatMax);
  std::uint32_t forward = L::kAllBits;
  for (std::uint32_t i = 0; i < kVectors; ++i) {
    const std::uint32_t base = i * L::kCount;
    const Float toward = load(group.inverse[axes.w], base) * Float(beam.turn);
    forward &= (toward > Float(0.0f)).bits();
    inverse[i] = toward;
    along[i] = load(group.origin[axes.w], base) * Float(beam.turn);
    least_along = L::min(along[i], least_along);
  }
  if (forward != L::kAllBits) return kNoBeam;
  const float nearest = L::horizontal_min(least_along);
  beam.corner[2] = nearest * beam.turn;
  reach = group_reach<L>(group, beam, axes.w);
  const float length = reach < largest ? reach : largest, least_margin = largest * kLeastGroupMargin;
  for (std::uint32_t k = 0; k < 2; ++k) {
    const std::uint32_t other = k == 0 ? axes.u : axes.v;
    const float corner = group.origin[other][ray];
    beam.corner[k] = corner;
    Float low_slope(kFloatMax), high_slope(-kFloatMax), lowest(kFloatMax), highest(-kFloatMax), starts[kVectors];
    for (std::uint32_t i = 0; i < kVectors; ++i) {
      const std::uint32_t base = i * L::kCount;
      const Float dir = load(group.dir[other], base), slope = dir * inverse[i];
      low_slope = L::min(slope, low_slope);
      high_slope = L::max(slope, high_slope);
      const Float start = load(group.origin[other], base) - Float(corner);
      // As far as rays without end go: beyond every scene that floats can test.
      const Float far(0x1p100f), way = L::max(L::min(load(group.t, base) * dir, far), -far), end = start + way;
      const Float margin = L::abs(start) * Float(kGroupMargin) + Float(least_margin);
      const Float end_margin = (L::abs(start) + L::abs(way)) * Float(kGroupMargin) + Float(least_margin);
      lowest = L::min(L::min(start - margin, end - end_margin), lowest);
      highest = L::max(L::max(start + margin, end + end_margin), highest);
      starts[i] = start;
    }
    float low = L::horizontal_min(low_slope), high = L::horizontal_max(high_slope);
    if (!(high - low <= kGroupSpread)) return kNoBeam;
    low = low - magnitude(low) * kGroupMargin;
    high = high + magnitude(high) * kGroupMargin;
    Float low_offsets(kFloatMax), high_offsets(-kFloatMax);
    for (std::uint32_t i = 0; i < kVectors; ++i) {
      const Float away = along[i] - Float(nearest), to_low = Float(low) * away, to_high = Float(high) * away;
      const Float size = L::abs(starts[i]);
      low_offsets = L::min(starts[i] - to_low - ((size + L::abs(to_low)) * Float(kGroupMargin) + Float(least_margin)),
                           low_offsets);
      high_offsets = L::max(
          starts[i] - to_high + ((size + L::abs(to_high)) * Float(kGroupMargin) + Float(least_margin)), high_offsets);
    }
    const float low_offset = L::horizontal_min(low_offsets), high_offset = L::horizontal_max(high_offsets);
    if (!(high_offset - low_offset <= kGroupWidth * length)) return kNoBeam;
    const auto set = [](float slope, float offset, float bound, float* plane) {
      plane[0] = slope > 0.0f ? slope : 0.0f;
      plane[1] = slope > 0.0f ? 0.0f : slope;
      plane[2] = offset;
      plane[3] = bound;
    };
    set(low, low_offset, L::horizontal_min(lowest), beam.planes[2 * k]);
    set(high, high_offset, L::horizontal_max(highest), beam.planes[2 * k + 1]);
  }
  return axes.w;
}

/// A group's beam in all lanes.
template <class L>
struct GroupPlanes {
  using Float = typename L::Float;
  Float corner[3], up[4], down[4], offset[4], bound[4], turn, reach;
  BeamAxes axes;
  bool is_backwards;

  GRIDIRON_INLINE GroupPlanes(const GroupBeam& beam, float looks, std::uint32_t axis)
      : turn(beam.turn), reach(looks), axes(axis), is_backwards(beam.turn < 0.0f) {
    for (int i = 0; i < 3; ++i) corner[i] = Float(beam.corner[i]);
    for (int i = 0; i < 4; ++i) {
      up[i] = Float(beam.planes[i][0]);
      down[i] = Float(beam.planes[i][1]);
      offset[i] = Float(beam.planes[i][2]);
      bound[i] = Float(beam.planes[i][3]);
    }
  }

  /// @returns the boxes that the group misses, of those from `base` on, as bits. @tparam Boxes  TreeNode, GroupLeaf.
  template <class Boxes>
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t missed_boxes(const Boxes& node, std::uint32_t base) const {
    const float* const near_side = is_backwards ? node.high[axes.w] : node.low[axes.w];
    const float* const far_side = is_backwards ? node.low[axes.w] : node.high[axes.w];
    const Float entry = (Float::load(near_side + base) - corner[2]) * turn,
                exit = (Float::load(far_side + base) - corner[2]) * turn;
    const Float first = L::max(entry, Float(0.0f)), last = L::min(exit, reach);
    const auto least = [&](int plane) GRIDIRON_INLINE_LAMBDA {
      return L::max(L::bounded_sum(up[plane], first, L::bounded_sum(down[plane], last, offset[plane])), bound[plane]);
    };
    const auto most = [&](int plane) GRIDIRON_INLINE_LAMBDA {
      return L::min(L::bounded_sum(up[plane], last, L::bounded_sum(down[plane], first, offset[plane])), bound[plane]);
    };
    // Differences have the sign of what they compare: one comparison decides.
    const Float beside_u = L::max(least(0) - (Float::load(node.high[axes.u] + base) - corner[0]),
                                  (Float::load(node.low[axes.u] + base) - corner[0]) - most(1));
    const Float beside_v = L::max(least(2) - (Float::load(node.high[axes.v] + base) - corner[1]),
                                  (Float::load(node.low[axes.v] + base) - corner[1]) - most(3));
    return (L::max(L::max(beside_u, beside_v), first - last) > Float(0.0f)).bits();
  }
};

/// Marks the boxes of a node that each group of a list misses. @returns those that any group meets.
template <class L>
[[nodiscard]] GRIDIRON_OUTLINE std::uint32_t mark_groups(const TreeNode& node, const GroupBeam* beams,
                                                         const float* reaches, std::uint32_t* list, std::uint32_t count,
                                                         WorkCounters& work) {
  work.add(Work::kListBeamNode, count);
  std::uint32_t closed = kMaskBits;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t word = list[i], beam = beam_index(word);
    const GroupPlanes<L> planes(beams[beam], reaches[beam], beam_axis(word));
    std::uint32_t missed = 0;
    for (std::uint32_t base = 0; base < kTreeWidth; base += L::kCount)
      missed |= planes.missed_boxes(node, base) << base;
    list[i] = word | missed;
    closed &= missed;
  }
  for (std::uint32_t i = count; i % L::kCount != 0; ++i) list[i] = kMaskBits;
  return ~closed & kMaskBits;
}

/// Distances of a group's rays from `base` on to a triangle, as ray_distance() gives them, from doubles alone.
/// @param distance  gets them, aligned to lanes. @returns the lanes that doubles leave open.
template <class L>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t group_distances(const RayGroup& group, std::uint32_t base,
                                                            const VertexTriangle& triangle, const PlaneNormal& plane,
                                                            float* distance) {
  using Double = typename L::Double;
  using Long = typename L::Long;
  static constexpr std::uint32_t kHalf = L::kCount / 2;
  const double normal_error = kDistanceError * (plane.products[0] + plane.products[1] + plane.products[2]);
  std::uint32_t open = 0;
  for (std::uint32_t half = 0; half < 2; ++half) {
    const std::uint32_t first = base + half * kHalf;
    Double volume(0.0), volume_size(0.0), denominator(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      const Double a = Double(double{triangle.v[0][axis]}) - Double::load_floats(group.origin[axis] + first);
      const Double normal(plane.normal[axis]);
      volume = volume + a * normal;
      volume_size = volume_size + L::abs(a) * Double(plane.products[axis]);
      denominator = denominator + Double::load_floats(group.dir[axis] + first) * normal;
    }
    // As distance_interval() has it.
    const Double inverse = Double(1.0) / denominator, quotient = volume * inverse, size = L::abs(quotient);
    const Double turn = size * (Double::load_floats(group.dir_max + first) * Double(normal_error));
    const Double error = (volume_size * Double(kDistanceError) + turn) * L::abs(inverse) + Double(0x1p-49) * size;
    static constexpr std::int64_t kHalfStep = std::int64_t{1} << 28, kRebias = std::int64_t{1023 - 127} << 23;
    const Long low = ((quotient - error).pattern() + kHalfStep) >> 29;
    const Long high = ((quotient + error).pattern() + kHalfStep) >> 29;
    const Long pattern = low - kRebias;
    const Long known = (Double(0.0) < size) & (error < Double(0x1p-10) * size);
    const Long behind = known & (quotient + error < 0.0);
    const Long rounded = known & (low == high) & (pattern >= 0x00800000) & (pattern <= 0x7F7FFFFF);
    L::store_patterns(pattern & rounded, distance + half * kHalf);
    open |= (L::half_bits(~behind) & L::half_bits(~rounded)) << half * kHalf;
  }
  return open;
}

/// @returns the triangles of a leaf whose boxes a group may meet, as bits.
template <class L>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t triangles_in_group(const GroupBeam& beam, float reach, std::uint32_t axis,
                                                               const GroupLeaf& leaf, std::uint32_t count) {
  const GroupPlanes<L> planes(beam, reach, axis);
  std::uint32_t missed = 0;
  for (std::uint32_t base = 0; base < count; base += L::kCount) missed |= planes.missed_boxes(leaf, base) << base;
  return ~missed & ((2u << (count - 1)) - 1);
}

/// Keeps the boxes of a node's children while leaves are visited.
template <class L>
GRIDIRON_INLINE void copy_boxes(const TreeNode& node, ChildBoxes& boxes) {
  using Float = typename L::Float;
  for (int axis = 0; axis < 3; ++axis) {
    for (std::uint32_t i = 0; i < kTreeWidth; i += L::kCount) {
      Float::load(node.low[axis] + i).store(boxes.low[axis] + i);
      Float::load(node.high[axis] + i).store(boxes.high[axis] + i);
    }
  }
}

/// @returns the rays of a group, from `base` on, that may meet a child's box, as bits: box_test.h.
template <class L>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t rays_in_box(const RayGroup& group, std::uint32_t base,
                                                        const ChildBoxes& boxes, std::uint32_t child) {
  using Float = typename L::Float;
  Float first(0.0f), last = Float::load(group.t + base);
  for (int axis = 0; axis < 3; ++axis) {
    const Float origin = Float::load(group.origin[axis] + base), inverse = Float::load(group.inverse[axis] + base);
    const Float one = (Float(boxes.low[axis][child]) - origin) * inverse,
                other = (Float(boxes.high[axis][child]) - origin) * inverse;
    first = L::max(L::min(one, other), first);
    last = L::min(L::max(one, other), last);
  }
  return (first <= last * Float(kExitFactor)).bits();
}

/// One triangle of a leaf against the rays of groups, by wider bounds than LeafLanes: what these leave open is tested
/// again. @tparam kShares  the rays have one origin, and set_up_origin() prepared the leaf.
template <class L, bool kShares>
class GroupTriangle : LeafSums<L, true> {
 public:
  using Float = typename L::Float;
  using LeafSums<L, true>::sum, LeafSums<L, true>::difference, LeafSums<L, true>::inner;

  GRIDIRON_INLINE GroupTriangle(const TriangleLanes& lanes, const GroupLeaf& leaf, std::uint32_t triangle)
      : words_(lanes.v[0] + triangle), more_words_(leaf.low[0] + triangle), own_id_(leaf.own_ids[triangle]) {}

  /// @returns whether one of the rays from `base` on may hit it.
  [[nodiscard]] GRIDIRON_INLINE bool may_be_hit(const RayGroup& group, std::uint32_t base) const {
    const LeafRay<L> q(group, base);
    const auto is_own = L::equal(own_id_, group.ids + base);
    const Float normal[3] = {word(kNormal), word(kNormal + 1), word(kNormal + 2)};
    const Float denominator = inner(q.dir, normal), size = L::abs(denominator);
    // Three numbers above 0 where the ray passes beside, and where its hit is before it or behind its end.
    Float beside, before, behind, turn;
    if constexpr (kShares) {
      const Float first[3] = {word(kCorner), word(kCorner + 1), word(kCorner + 2)},
                  second[3] = {word(kBackEdge), word(kBackEdge + 1), word(kBackEdge + 2)};
      const Float a = L::turn_by(denominator, inner(q.dir, first)), b = L::turn_by(denominator, inner(q.dir, second));
      const Float least = L::min(L::min(a, b), size - a - b);
      const Float ahead = L::turn_by(denominator, word(kEdge)), error = word(kEdge + 1);
      turn = word(kNormalError) * q.dir_max;
      beside = -(least + word(kEdgeError) * q.dir_max);
      before = -(ahead + error);
      behind = (ahead - error) - (size + turn) * q.t * Float(1.0f + 0x1p-20f);
    } else {
      const Float place[3] = {word(kCorner) - q.origin[0], word(kCorner + 1) - q.origin[1],
                              word(kCorner + 2) - q.origin[2]};
      const Float r[3] = {difference(place[1], q.dir[2], place[2], q.dir[1]),
                          difference(place[2], q.dir[0], place[0], q.dir[2]),
                          difference(place[0], q.dir[1], place[1], q.dir[0])};
      const Float edge[3] = {word(kEdge), word(kEdge + 1), word(kEdge + 2)},
                  back[3] = {word(kBackEdge), word(kBackEdge + 1), word(kBackEdge + 2)};
      const Float a = L::turn_by(denominator, inner(r, edge)), b = L::turn_by(denominator, inner(r, back));
      const Float least = L::min(L::min(a, b), size - a - b);
      // Three times the largest component in place of the sum.
      const Float most = L::larger_size(L::larger_size(place[0], place[1]), place[2]) + Float(kLeastListSize);
      const Float ahead = L::turn_by(denominator, inner(place, normal)), error = more_word(kWideNormal);
      turn = error * q.dir_max;
      beside = -sum(sum(most, more_word(kWideEdge), more_word(kLeast)), q.dir_max, least);
      before = -sum(most, error, ahead + Float(2.0f * kLeastAhead));
      behind = sum(most, -error, ahead) - sum(sum(size, Float(1.0f + 0x1p-20f), turn), q.t, Float(2.0f * kLeastAhead));
    }
    const Float away = L::min(L::max(before, behind), size - turn);
    return (L::kAllBits & ~((L::max(away, beside) > Float(0.0f)) | is_own).bits()) != 0;
  }

 private:
  // Rows of the arrays.
  static constexpr int kCorner = 0, kBackEdge = 3, kEdge = 6, kNormal = 9, kEdgeError = 12, kNormalError = 13;
  static constexpr int kWideEdge = 6, kWideNormal = 7, kLeast = 8;
  static_assert(offsetof(TriangleLanes, normal_error) == kNormalError * kMaxTreeLeaf * sizeof(float));
  static_assert(offsetof(GroupLeaf, least_error) == kLeast * kMaxTreeLeaf * sizeof(float));
  // By constant distances: an address for each array would not fit the registers.
  [[nodiscard]] GRIDIRON_INLINE Float word(int row) const {
    return Float(words_[static_cast<std::uint32_t>(row) * kMaxTreeLeaf]);
  }
  [[nodiscard]] GRIDIRON_INLINE Float more_word(int row) const {
    return Float(more_words_[static_cast<std::uint32_t>(row) * kMaxTreeLeaf]);
  }

  const float *words_, *more_words_;
  std::uint32_t own_id_;
};

}  // namespace gridiron
