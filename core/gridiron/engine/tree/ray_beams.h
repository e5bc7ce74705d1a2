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

/// The least and greatest places where segments of rays begin and end: quads of coordinates.
struct BeamEnds {
  Lanes<4>::Float low_start, high_start, low_end, high_end;
};

/// What the ends of segments say of their beam.
struct BeamShape {
  Lanes<4>::Float low_slope, high_slope;
  float most;        ///< the greatest |coordinate| of ends
  bool is_narrow;    ///< they make a beam
  bool is_forward;

  /// @param far  twice the scene's largest |coordinate|.
  GRIDIRON_INLINE BeamShape(const BeamEnds& ends, std::uint32_t axis, float far)
      : low_slope(0.0f), high_slope(0.0f), most(0.0f), is_narrow(false), is_forward(false) {
    using Quad = Lanes<4>;
    using Float = Quad::Float;
    const Float sizes = Quad::max(Quad::max(Quad::abs(ends.low_start), Quad::abs(ends.high_start)),
                                  Quad::max(Quad::abs(ends.low_end), Quad::abs(ends.high_end)));
    most = Quad::horizontal_max(sizes);
    if (!(most <= far * kFarBeam)) return;
    const Float half(0.5f);
    const float length =
        Quad::lane((ends.low_end + ends.high_end) * half - (ends.low_start + ends.high_start) * half, axis);
    is_forward = length > 0.0f;
    const Float spread(magnitude(length) * kBeamWidth);
    const std::uint32_t others = 7u & ~(1u << axis);
    const std::uint32_t wide =
        ((ends.high_start - ends.low_start > spread) | (ends.high_end - ends.low_end > spread)).bits();
    is_narrow = (wide & others) == 0;
    low_slope = (ends.low_end - ends.low_start) / Float(length);
    high_slope = (ends.high_end - ends.high_start) / Float(length);
  }
};

/// Writes a beam. @param low_offset  the least distances of ends from the lower planes, @param high_offset  the greatest
/// from the upper ones: quads of axes. @param dir_size  the greatest |component| of a direction along the axis.
GRIDIRON_INLINE void write_beam(const BeamEnds& ends, const BeamShape& shape, Lanes<4>::Float low_offset,
                                Lanes<4>::Float high_offset, float dir_size, std::uint32_t axis, float far,
                                RayBeam& beam) {
  using Quad = Lanes<4>;
  using Float = Quad::Float;
  const float margin = (shape.most > far ? shape.most : far) * kBeamMargin;
  low_offset = low_offset - (Float(1.0f) + Quad::abs(shape.low_slope)) * Float(margin);
  high_offset = high_offset + (Float(1.0f) + Quad::abs(shape.high_slope)) * Float(margin);
  const auto plane = [](Float slope, Float offset, std::uint32_t lane, float* words) {
    const float value = Quad::lane(slope, lane), none = 0.0f;
    words[0] = value > none ? value : none;
    words[1] = value > none ? none : value;
    words[2] = Quad::lane(offset, lane);
  };
  const std::uint32_t u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
  plane(shape.low_slope, low_offset, u, beam.planes[0]);
  plane(shape.high_slope, high_offset, u, beam.planes[1]);
  plane(shape.low_slope, low_offset, v, beam.planes[2]);
  plane(shape.high_slope, high_offset, v, beam.planes[3]);
  const bool is_forward = shape.is_forward;
  beam.planes[0][3] = Quad::lane(is_forward ? ends.low_start : ends.low_end, axis) - margin;
  beam.planes[1][3] = Quad::lane(is_forward ? ends.high_end : ends.high_start, axis) + margin;
  beam.planes[2][3] =
      is_forward ? Quad::lane(ends.high_start, axis) + margin : Quad::lane(ends.low_start, axis) - margin;
  beam.planes[3][3] = is_forward ? dir_size : -dir_size;
}

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
  BeamEnds all{Float(kFloatMax), Float(-kFloatMax), Float(kFloatMax), Float(-kFloatMax)};
  Float dir_size(0.0f);
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
    all.low_start = Quad::min(start, all.low_start);
    all.high_start = Quad::max(start, all.high_start);
    all.low_end = Quad::min(end, all.low_end);
    all.high_end = Quad::max(end, all.high_end);
    dir_size = Quad::max(Quad::abs(dir), dir_size);
  }
  if (!are_bounded) return kNoBeam;
  const BeamShape shape(all, axis, far);
  if (!shape.is_narrow) return kNoBeam;
  Float low_offset(kFloatMax), high_offset(-kFloatMax);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Float start_w = Float(Quad::lane(starts[i], axis)), end_w = Float(Quad::lane(ends[i], axis));
    low_offset =
        Quad::min(low_offset, Quad::min(starts[i] - shape.low_slope * start_w, ends[i] - shape.low_slope * end_w));
    high_offset =
        Quad::max(high_offset, Quad::max(starts[i] - shape.high_slope * start_w, ends[i] - shape.high_slope * end_w));
  }
  write_beam(all, shape, low_offset, high_offset, Quad::lane(dir_size, axis), axis, far, beam);
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

  /// @returns the triangles of a leaf, from `base` on, that lie outside one of the beam's planes, as bits.
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t missed_by(const GroupCorners& corners, std::uint32_t axis,
                                                        std::uint32_t base) const {
    const std::uint32_t u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    Float slopes[4], along[3];
    for (int plane = 0; plane < 4; ++plane) slopes[plane] = up[plane] + down[plane];
    for (int corner = 0; corner < 3; ++corner) along[corner] = Float::load(corners.of[corner][axis] + base);
    const auto place = [&](int corner, int plane) GRIDIRON_INLINE_LAMBDA {
      return L::bounded_sum(slopes[plane], along[corner], offset[plane]);
    };
    const auto are_below = [&](std::uint32_t other, int plane) GRIDIRON_INLINE_LAMBDA {
      return (Float::load(corners.of[0][other] + base) < place(0, plane)) &
             (Float::load(corners.of[1][other] + base) < place(1, plane)) &
             (Float::load(corners.of[2][other] + base) < place(2, plane));
    };
    const auto are_above = [&](std::uint32_t other, int plane) GRIDIRON_INLINE_LAMBDA {
      return (Float::load(corners.of[0][other] + base) > place(0, plane)) &
             (Float::load(corners.of[1][other] + base) > place(1, plane)) &
             (Float::load(corners.of[2][other] + base) > place(2, plane));
    };
    return (are_below(u, 0) | are_above(u, 1) | are_below(v, 2) | are_above(v, 3) |
            (L::max(L::max(along[0], along[1]), along[2]) < low_w) |
            (L::min(L::min(along[0], along[1]), along[2]) > high_w))
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
