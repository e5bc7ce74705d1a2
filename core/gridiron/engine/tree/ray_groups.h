// Groups: the rays of a beam in lanes, for wide lanes. What a beam meets is tested against all its rays at once, so no
// ray goes down the tree by itself. Source: own; core/TREE.md. Memory: values. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/engine/tree/leaf_test.h>
#include <gridiron/engine/tree/list_memory.h>
#include <gridiron/engine/tree/list_rays.h>
#include <gridiron/engine/tree/ray_beams.h>
#include <gridiron/ray/distance.h>
#include <gridiron/ray/ray_batch.h>

#include <cstdint>

namespace gridiron {

/// Puts kBeamRays rays in lanes and makes their beam.
/// @param rays     in any octants. @param largest  as in RayLists::trace().
/// @param octant   gets that of the first ray.
/// @returns the beam's axis; kNoBeam if they make none, or floats cannot test one of them.
template <class L>
[[nodiscard]] GRIDIRON_OUTLINE std::uint32_t make_group(const BatchRay* rays, float largest, RayGroup& group,
                                                        RayBeam& beam, std::uint32_t& octant) {
  using Float = typename L::Float;
  using Int = typename L::Int;
  static constexpr std::uint32_t kVectors = kBeamRays / L::kCount;
  const float far = 2.0f * largest, farthest = far * kFarBeam;
  const Float most_place(farthest < kGreatestListPlace ? farthest : kGreatestListPlace);
  std::uint32_t usual = L::kAllBits;
  for (std::uint32_t i = 0; i < kVectors; ++i) {
    const std::uint32_t base = i * L::kCount;
    Float place[4], dir[4];
    load_ray_words<L>(rays[base].origin, place);
    load_ray_words<L>(rays[base].dir, dir);
    for (int axis = 0; axis < 3; ++axis) {
      place[axis].store(group.origin[axis] + base);
      dir[axis].store(group.dir[axis] + base);
      usual &= (L::abs(place[axis]) <= most_place).bits();
    }
    const Float longest = L::max(L::max(L::abs(dir[0]), L::abs(dir[1])), L::abs(dir[2]));
    usual &= ((longest >= Float(kLeastListDirection)) & (longest <= Float(kGreatestListDirection))).bits();
    place[3].store(group.t + base);
    longest.store(group.dir_max + base);
    Int{L::words_of(dir[3])}.store(group.ids + base);
  }
  if (usual != L::kAllBits || !(largest <= kGreatestListPlace)) return kNoBeam;
  const float x = magnitude(group.dir[0][0]), y = magnitude(group.dir[1][0]), z = magnitude(group.dir[2][0]);
  const std::uint32_t axis = x > y ? (x > z ? 0u : 2u) : (y > z ? 1u : 2u);
  octant = (group.dir[0][0] < 0.0f ? 1u : 0u) | (group.dir[1][0] < 0.0f ? 2u : 0u) |
           (group.dir[2][0] < 0.0f ? 4u : 0u);

  Float starts[3][kVectors], ends[3][kVectors];
  std::uint32_t bounded = L::kAllBits, backwards = 0, forwards = 0;
  Float dir_size(0.0f);
  for (std::uint32_t i = 0; i < kVectors; ++i) {
    const std::uint32_t base = i * L::kCount;
    const Float dir_w = Float::load(group.dir[axis] + base), start_w = Float::load(group.origin[axis] + base);
    const Float size = L::abs(dir_w);
    // Behind this the rest of a ray is outside the scene.
    const Float t = L::min((L::abs(start_w) + Float(far)) / size, Float::load(group.t + base));
    bounded &= ((t > Float(0.0f)) & (t < Float(kFloatMax))).bits();
    const std::uint32_t turned = (dir_w < Float(0.0f)).bits();
    backwards |= turned, forwards |= ~turned;
    dir_size = L::max(size, dir_size);
    for (int k = 0; k < 3; ++k) {
      starts[k][i] = Float::load(group.origin[k] + base);
      ends[k][i] = L::bounded_sum(t, Float::load(group.dir[k] + base), starts[k][i]);
    }
  }
  // Nor NaN. All run the same way along the axis.
  if (bounded != L::kAllBits || (backwards != 0 && (forwards & L::kAllBits) != 0)) return kNoBeam;
  const auto least = [](const Float (&values)[kVectors]) GRIDIRON_INLINE_LAMBDA {
    Float low = values[0];
    if constexpr (kVectors > 1) low = L::min(low, values[1]);
    return L::horizontal_min(low);
  };
  const auto most = [](const Float (&values)[kVectors]) GRIDIRON_INLINE_LAMBDA {
    Float high = values[0];
    if constexpr (kVectors > 1) high = L::max(high, values[1]);
    return L::horizontal_max(high);
  };
  using Quad = Lanes<4>;
  const auto quad = [](float a, float b, float c) GRIDIRON_INLINE_LAMBDA {
    return Quad::Float(Quad::FloatVector{a, b, c, a});
  };
  const BeamEnds all{quad(least(starts[0]), least(starts[1]), least(starts[2])),
                     quad(most(starts[0]), most(starts[1]), most(starts[2])),
                     quad(least(ends[0]), least(ends[1]), least(ends[2])),
                     quad(most(ends[0]), most(ends[1]), most(ends[2]))};
  const BeamShape shape(all, axis, far);
  if (!shape.is_narrow || !(shape.most <= kGreatestListPlace)) return kNoBeam;
  // Of the axis itself 0: nothing asks for it.
  float low_offset[3] = {}, high_offset[3] = {};
  const Float* const along_start = starts[axis];
  const Float* const along_end = ends[axis];
  for (std::uint32_t k = 0; k < 3; ++k) {
    if (k == axis) continue;
    const Float low_slope(Quad::lane(shape.low_slope, k)), high_slope(Quad::lane(shape.high_slope, k));
    Float lows[kVectors], highs[kVectors];
    for (std::uint32_t i = 0; i < kVectors; ++i) {
      lows[i] = L::min(starts[k][i] - low_slope * along_start[i], ends[k][i] - low_slope * along_end[i]);
      highs[i] = L::max(starts[k][i] - high_slope * along_start[i], ends[k][i] - high_slope * along_end[i]);
    }
    low_offset[k] = least(lows);
    high_offset[k] = most(highs);
  }
  write_beam(all, shape, quad(low_offset[0], low_offset[1], low_offset[2]),
             quad(high_offset[0], high_offset[1], high_offset[2]), L::horizontal_max(dir_size), axis, far, beam);
  return axis;
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
    const Double error =
        (volume_size * Double(kDistanceError) + turn) * L::abs(inverse) + Double(0x1p-49) * size;
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

/// @returns the triangles of a leaf that a beam may meet, as bits.
template <class L>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t triangles_in_beam(const RayBeam& beam, std::uint32_t axis,
                                                              const GroupCorners& corners, std::uint32_t count) {
  const BeamPlanes<L> planes(beam);
  std::uint32_t missed = 0;
  for (std::uint32_t base = 0; base < count; base += L::kCount) {
    missed |= planes.missed_by(corners, axis, base) << base;
  }
  return ~missed & ((2u << (count - 1)) - 1);
}

}  // namespace gridiron
