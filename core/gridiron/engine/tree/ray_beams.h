// Beams: 16 neighbouring rays of a batch between four planes, which boxes are tested against in the place of the rays.
// A beam meets all boxes that its rays meet. Source: own; core/TREE.md. Memory: values. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/engine/tree/list_memory.h>
#include <gridiron/engine/tree/list_rays.h>
#include <gridiron/ray/ray_batch.h>

#include <cstdint>

namespace gridiron {

// A beam runs along an axis w, the others are u and v in the order of the axes. Its rays are segments up to their t, or
// to where they have left the scene along w. A point p of any of them has p.u >= slope p.w + offset, for a slope and
// offset of the lower plane, likewise for the upper plane and for v: the offset is the least of all ends of segments,
// lowered by a bound of the error.
//
// Let M be the greatest |coordinate| of all ends and of the scene, e = 2^-23, the largest
// relative error of an operation in any rounding mode. An end o + t d is within 4 e M of its exact place; what its
// offset comes from within 4 e (1 + |slope|) M more, and its distance from a plane within (1 + |slope|) times these. In
// the test of a box slope x w has |w| <= M, and two sums: 8 e (1 + |slope|) M. All are less than kBeamMargin (1 +
// |slope|) M.
inline constexpr float kBeamMargin = 0x1p-18f;
/// A beam that is wider than this share of its length would meet too much.
inline constexpr float kBeamWidth = 0.2f;
/// Nor are rays bounded that begin or end farther away than this, in the scene's sizes.
inline constexpr float kFarBeam = 0x1p10f;
/// In smaller scenes what is lost below the least normal float would be more than the margin.
inline constexpr float kLeastBeamScene = 0x1p-60f;
/// Groups of rays that make no beam, beyond a quarter of all, before the others are not tried any more.
inline constexpr std::uint32_t kVainBeams = 1;

/// Words of a list of beams are as those of rays, with the axis below the place, which is a multiple of 4.
[[nodiscard]] GRIDIRON_INLINE std::uint32_t beam_word(std::uint32_t beam, std::uint32_t axis, std::uint32_t octant) {
  return octant << kOctantShift | (4 * beam + axis) << kPlaceShift;
}
[[nodiscard]] GRIDIRON_INLINE std::uint32_t beam_axis(std::uint32_t word) {
  return word >> kPlaceShift & 3u;
}
[[nodiscard]] GRIDIRON_INLINE std::uint32_t beam_index(std::uint32_t word) {
  return word >> (kPlaceShift + 2) & ((1u << (kOctantShift - kPlaceShift - 2)) - 1);
}

/// No axis: rays that make no beam.
inline constexpr std::uint32_t kNoBeam = 3;

/// Makes the beam of some rays. @param rays  of one octant, prepared for lists, 1 to kBeamRays.
/// @param largest  as in RayLists::trace().
/// @returns its axis, or kNoBeam.
GRIDIRON_OUTLINE inline std::uint32_t make_beam(const BatchRay* rays, std::uint32_t count, float largest,
                                                RayBeam& beam) {
  using Quad = Lanes<4>;
  using Float = Quad::Float;
  const float x = magnitude(rays[0].dir[0]), y = magnitude(rays[0].dir[1]), z = magnitude(rays[0].dir[2]);
  const std::uint32_t axis = x > y ? (x > z ? 0u : 2u) : (y > z ? 1u : 2u);
  const float far = 2.0f * largest;
  Float starts[kBeamRays], ends[kBeamRays];
  Float low_start(kFloatMax), high_start(-kFloatMax), low_end(kFloatMax), high_end(-kFloatMax), dir_size(0.0f);
  bool are_bounded = true;
  for (std::uint32_t i = 0; i < count; ++i) {
    const BatchRay& ray = rays[i];
    // Behind this the rest of the ray is outside the scene. A ray that boxes cannot be tested against has 0 here.
    const float reach = (magnitude(ray.origin[axis]) + far) * magnitude(ray.inverse[axis]);
    const float t = ray.t < reach ? ray.t : reach;
    are_bounded = are_bounded && t > 0.0f && t < kFloatMax;  // nor NaN
    const Float start = Quad::shuffle_quads<0, 1, 2, 0>(Float::load(ray.origin));
    const Float dir = Quad::shuffle_quads<0, 1, 2, 0>(Float::load(ray.dir));
    const Float end = start + Float(t) * dir;
    starts[i] = start;
    ends[i] = end;
    low_start = Quad::min(start, low_start);
    high_start = Quad::max(start, high_start);
    low_end = Quad::min(end, low_end);
    high_end = Quad::max(end, high_end);
    dir_size = Quad::max(Quad::abs(dir), dir_size);
  }
  const Float sizes = Quad::max(Quad::max(Quad::abs(low_start), Quad::abs(high_start)),
                                Quad::max(Quad::abs(low_end), Quad::abs(high_end)));
  const float most = Quad::horizontal_max(sizes);
  if (!are_bounded || !(most <= far * kFarBeam)) return kNoBeam;
  const Float half(0.5f);
  const float length = Quad::lane((low_end + high_end) * half - (low_start + high_start) * half, axis);
  const bool is_forward = length > 0.0f;
  const Float spread(magnitude(length) * kBeamWidth);
  const std::uint32_t others = 7u & ~(1u << axis);
  const std::uint32_t wide = ((high_start - low_start > spread) | (high_end - low_end > spread)).bits();
  if ((wide & others) != 0) return kNoBeam;
  const Float low_slope = (low_end - low_start) / Float(length), high_slope = (high_end - high_start) / Float(length);
  Float low_offset(kFloatMax), high_offset(-kFloatMax);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Float start_w = Float(Quad::lane(starts[i], axis)), end_w = Float(Quad::lane(ends[i], axis));
    low_offset = Quad::min(low_offset, Quad::min(starts[i] - low_slope * start_w, ends[i] - low_slope * end_w));
    high_offset = Quad::max(high_offset, Quad::max(starts[i] - high_slope * start_w, ends[i] - high_slope * end_w));
  }
  const float margin = (most > far ? most : far) * kBeamMargin;
  low_offset = low_offset - (Float(1.0f) + Quad::abs(low_slope)) * Float(margin);
  high_offset = high_offset + (Float(1.0f) + Quad::abs(high_slope)) * Float(margin);
  const auto plane = [](Float slope, Float offset, std::uint32_t lane, float* words) {
    const float value = Quad::lane(slope, lane), none = 0.0f;
    words[0] = value > none ? value : none;
    words[1] = value > none ? none : value;
    words[2] = Quad::lane(offset, lane);
  };
  const std::uint32_t u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
  plane(low_slope, low_offset, u, beam.planes[0]);
  plane(high_slope, high_offset, u, beam.planes[1]);
  plane(low_slope, low_offset, v, beam.planes[2]);
  plane(high_slope, high_offset, v, beam.planes[3]);
  beam.planes[0][3] = Quad::lane(is_forward ? low_start : low_end, axis) - margin;
  beam.planes[1][3] = Quad::lane(is_forward ? high_end : high_start, axis) + margin;
  beam.planes[2][3] = is_forward ? Quad::lane(high_start, axis) + margin : Quad::lane(low_start, axis) - margin;
  beam.planes[3][3] = is_forward ? Quad::lane(dir_size, axis) : -Quad::lane(dir_size, axis);
  return axis;
}

/// Shortens a beam whose rays look no farther than `most_t`; below 0: none is left.
GRIDIRON_INLINE void shorten_beam(RayBeam& beam, float most_t) {
  if (most_t < 0.0f) {
    beam.planes[0][3] = kFloatMax;
    beam.planes[1][3] = -kFloatMax;
    return;
  }
  const float rate = beam.planes[3][3], end = beam.planes[2][3] + most_t * rate;
  if (rate > 0.0f) {
    beam.planes[1][3] = end < beam.planes[1][3] ? end : beam.planes[1][3];
  } else {
    beam.planes[0][3] = end > beam.planes[0][3] ? end : beam.planes[0][3];
  }
}

/// A beam in all lanes.
template <class L>
struct BeamPlanes {
  using Float = typename L::Float;
  Float up[4], down[4], offset[4], low_w, high_w;

  GRIDIRON_INLINE explicit BeamPlanes(const RayBeam& beam) {
    if constexpr (L::kCount == 4) {
      Float words[4];
      for (int i = 0; i < 4; ++i) {
        words[i] = Float::load(beam.planes[i]);
        up[i] = L::template shuffle_quads<0, 0, 0, 0>(words[i]);
        down[i] = L::template shuffle_quads<1, 1, 1, 1>(words[i]);
        offset[i] = L::template shuffle_quads<2, 2, 2, 2>(words[i]);
      }
      low_w = L::template shuffle_quads<3, 3, 3, 3>(words[0]);
      high_w = L::template shuffle_quads<3, 3, 3, 3>(words[1]);
    } else {
      for (int i = 0; i < 4; ++i) {
        up[i] = Float(beam.planes[i][0]);
        down[i] = Float(beam.planes[i][1]);
        offset[i] = Float(beam.planes[i][2]);
      }
      low_w = Float(beam.planes[0][3]);
      high_w = Float(beam.planes[1][3]);
    }
  }

  /// @returns the boxes of a node, from `base` on, that the beam misses, as bits.
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t missed_by(const TreeNode& node, std::uint32_t axis,
                                                        std::uint32_t base) const {
    const std::uint32_t u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    const Float first = L::max(Float::load(node.low[axis] + base), low_w);
    const Float last = L::min(Float::load(node.high[axis] + base), high_w);
    const auto least = [&](int plane) GRIDIRON_INLINE_LAMBDA {
      return L::bounded_sum(up[plane], first, L::bounded_sum(down[plane], last, offset[plane]));
    };
    const auto most = [&](int plane) GRIDIRON_INLINE_LAMBDA {
      return L::bounded_sum(up[plane], last, L::bounded_sum(down[plane], first, offset[plane]));
    };
    return ((first > last) | (Float::load(node.high[u] + base) < least(0)) |
            (Float::load(node.low[u] + base) > most(1)) | (Float::load(node.high[v] + base) < least(2)) |
            (Float::load(node.low[v] + base) > most(3)))
        .bits();
  }
};

/// Marks the boxes of a node that each beam of a list misses. @returns those that any beam meets.
template <class L>
[[nodiscard]] GRIDIRON_OUTLINE std::uint32_t mark_beams(const TreeNode& node, const RayBeam* beams, std::uint32_t* list,
                                                        std::uint32_t count, WorkCounters& work) {
  work.add(Work::kListBeamNode, count);
  work.charge_to(Work::kListBeamNode);
  std::uint32_t closed = kMaskBits;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t word = list[i];
    const BeamPlanes<L> planes(beams[beam_index(word)]);
    std::uint32_t missed = 0;
    for (std::uint32_t base = 0; base < kTreeWidth; base += L::kCount) {
      missed |= planes.missed_by(node, beam_axis(word), base) << base;
    }
    list[i] = word | missed;
    closed &= missed;
  }
  for (std::uint32_t i = count; i % L::kCount != 0; ++i) list[i] = kMaskBits;
  return ~closed & kMaskBits;
}

/// Lists the rays of beams that are left, and shortens the beams. @param rays  of the batch, `ray_count` of them.
/// @returns how many.
GRIDIRON_OUTLINE inline std::uint32_t list_beam_rays(RayBeam* beams, const std::uint32_t* list, std::uint32_t count,
                                                     BatchRay* rays, std::uint32_t ray_count, std::uint32_t* target,
                                                     WorkCounters& work) {
  std::uint32_t listed = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    if ((list[i] & kMaskBits) == kMaskBits) continue;
    const std::uint32_t beam = beam_index(list[i]), first = beam * kBeamRays, octant = octant_of(list[i]);
    const std::uint32_t rest = ray_count - first, here = rest < kBeamRays ? rest : kBeamRays;
    work.add(Work::kListEntry, here);
    float most_t = -1.0f;
    for (std::uint32_t j = 0; j < here; ++j) {
      const float t = rays[first + j].t;
      target[listed] = list_word(first + j, octant);
      listed += t >= 0.0f ? std::uint32_t{1} : std::uint32_t{0};
      most_t = t > most_t ? t : most_t;
    }
    shorten_beam(beams[beam], most_t);
  }
  return listed;
}

}  // namespace gridiron
