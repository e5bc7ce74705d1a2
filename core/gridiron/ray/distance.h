// Distances: which of a ray's hits is the nearest. Estimates with a bound of their error; if they cannot decide or t is
// requested, distances are rounded correctly. So the least (t, id) is the one of exact arithmetic.
// Source: own. Memory: values. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/exact_sum.h>
#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/packet.h>

#include <cstdint>

namespace gridiron {

/// What the distances of one triangle need, in double. Distance of a ray = numerator / (normal . d).
///
/// With u = 2^-52: normal = (b - a) x (c - a) has error 4 u M per component, M_x = |e1_y e2_z| + |e1_z e2_y|; the
/// numerator (a - o) . normal 8 u sum |a_i| M_i; the denominator 7 u |d|max sum M_i. kDistanceError is twice that; the
/// quotient's own rounding and those of the interval around it are below the 4 u added. u is one unit in any rounding
/// mode. No product leaves the range of a double; with denormals flushed the coordinates must be as in edges.h.
struct DistanceSetup {
  double normal[3];
  double numerator;
  double relative_error;        ///< of the quotient, but for the denominator's part
  double relative_error_per_t;  ///< times the quotient: the denominator's part
};
inline constexpr double kDistanceError = 0x1p-48;

void set_up_distance(const float origin[3], float dir_max, const VertexTriangle& triangle, DistanceSetup& setup);

/// The same in single precision: a ray's distance with a relative error of at most kEstimateError, if that can be had.
///
/// Errors as in DistanceSetup with e = 2^-23 in place of u: 8 e and 7 e; 8.5 e is charged. If neither numerator nor
/// denominator is uncertain by more than 4/9 of kEstimateError, their quotient is within 9/10 of it, and within all of
/// it once rounded. Values below the least normal float may be lost; in the accepted range the loss is less than the
/// excess charge: at most 2^-126 times 2^40 is lost of sums above 2^-60. The quotient of a ray that passes the test
/// lies above the least normal float. Numerator and t * denominator are compared with a hit at t: if that product
/// overflows, the quotient is far nearer; if it vanishes, far behind.
///
/// Numerator and normal are signed so that a positive denominator means a hit in front of the origin.
struct DistanceEstimate {
  float normal[3];
  float numerator;          ///< not negative
  float least_denominator;  ///< above it the quotient is that close, below its negative the hit is behind the origin;
                            ///< infinite: nothing can be told
};
inline constexpr float kFloatError = 8.5f * 0x1p-23f;
inline constexpr float kUncertain = kFloatError * 2.25f / kEstimateError;

[[nodiscard]] DistanceEstimate set_up_estimate(const float origin[3], float dir_max, const VertexTriangle& triangle);

/// The unit normal of a triangle that has an area, to 2^-15. Single precision is used if the triangle's shape allows
/// it, else double, else integers, so all callers get the same bits.
void set_up_normal(const VertexTriangle& triangle, float normal[3]);

/// Distances of a group's rays to a triangle, rounded to the nearest float, for the lanes in `bits`.
///
/// The quotient in double has a relative error. If both ends of its interval round to the same float, that float is the
/// answer, else integers give it. Rounding works on bit patterns, so no rounding mode can change it.
template <class L, class PacketType>
GRIDIRON_INLINE void distances_of(const PacketType& packet, std::uint32_t base, std::uint32_t bits,
                                  const VertexTriangle& triangle, const DistanceSetup& setup, float* distance,
                                  WorkCounters& work) {
  using Double = typename L::Double;
  using Long = typename L::Long;
  static constexpr std::uint32_t kHalf = L::kCount == 1 ? 1 : L::kCount / 2, kHalves = L::kCount / kHalf;
  std::uint32_t unsure = 0;
  for (std::uint32_t half = 0; half < kHalves; ++half) {
    if ((bits >> (half * kHalf) & ((1u << kHalf) - 1u)) == 0) continue;
    work.add(Work::kHitHalf);
    const std::uint32_t first = base + half * kHalf;
    const Double d_x = Double::load_floats(packet.dir[0] + first);
    const Double d_y = Double::load_floats(packet.dir[1] + first);
    const Double d_z = Double::load_floats(packet.dir[2] + first);
    const Double denominator =
        d_x * Double(setup.normal[0]) + d_y * Double(setup.normal[1]) + d_z * Double(setup.normal[2]);
    const Double quotient = Double(setup.numerator) / denominator;
    // error(D) / |D| = error(D) |t| / |N|
    const Double relative = quotient * Double(setup.relative_error_per_t) + Double(setup.relative_error);
    static constexpr std::int64_t kHalfStep = std::int64_t{1} << 28;
    const Long low = ((quotient - quotient * relative).pattern() + kHalfStep) >> 29;
    const Long high = ((quotient + quotient * relative).pattern() + kHalfStep) >> 29;
    static constexpr std::int64_t kRebias = std::int64_t{1023 - 127} << 23;
    const Long pattern = low - kRebias;
    const Long sure = (low == high) & (pattern >= 0x00800000) & (pattern <= 0x7F7FFFFF) & (relative < 0x1p-10);
    L::store_patterns(pattern, distance + half * kHalf);
    unsure |= L::half_bits(~sure) << (half * kHalf);
  }
  unsure &= bits;
  for (std::uint32_t lane = 0; unsure != 0 && lane < L::kCount; ++lane) {
    if (((unsure >> lane) & 1u) == 0) continue;
    const float dir[3] = {packet.dir[0][base + lane], packet.dir[1][base + lane], packet.dir[2][base + lane]};
    work.add(Work::kExactDistance);
    distance[lane] = exact_distance(packet.origin, dir, triangle.v[0], triangle.v[1], triangle.v[2]);
  }
}

/// What the hits of one triangle need, computed when the first of them does; numbers in all lanes.
template <class L>
struct HitSetups {
  using Float = typename L::Float;
  Float normal[3], numerator, least_denominator;  ///< DistanceEstimate
  Float unit_normal[3];
  DistanceSetup distance;
  bool has_estimate = false;
  bool has_distance = false;
  bool has_unit_normal = false;

  template <class PacketType>
  GRIDIRON_INLINE void estimate(PacketType& packet, const VertexTriangle& triangle, WorkCounters& work) {
    if (has_estimate) return;
    work.add(Work::kEstimateSetup);
    const DistanceEstimate found = set_up_estimate(packet.origin, packet.dir_max, triangle);
    for (int axis = 0; axis < 3; ++axis) normal[axis] = Float(found.normal[axis]);
    numerator = Float(found.numerator);
    // A numerator of 0 (the origin in the plane) makes the error infinite. t > 0 is required with floats too.
    const bool trusts_quotient = packet.trusts_floats && found.numerator > 0.0f;
    least_denominator = Float(trusts_quotient ? 0.0f : found.least_denominator);
    packet.keep(triangle);
    has_estimate = true;
  }
  GRIDIRON_INLINE void find_normal(const VertexTriangle& triangle, WorkCounters& work) {
    if (has_unit_normal) return;
    work.add(Work::kNormalSetup);
    float found[3];
    set_up_normal(triangle, found);
    for (int axis = 0; axis < 3; ++axis) unit_normal[axis] = Float(found[axis]);
    has_unit_normal = true;
  }
};

/// A triangle's normal in double, and the sums of magnitudes of the products that its components are.
struct PlaneNormal {
  double normal[3], products[3];
};
void set_up_plane_normal(const VertexTriangle& triangle, PlaneNormal& plane);

/// An interval that contains a ray's distance to a triangle, from doubles.
struct DistanceInterval {
  double low, high;
};
[[nodiscard]] DistanceInterval distance_interval(const float origin[3], float dir_max, const float dir[3],
                                                 const VertexTriangle& triangle);

/// @returns whether two triangles obviously lie in one plane: one across an axis, or by equal vertices.
[[nodiscard]] bool in_one_plane(const VertexTriangle& first, const VertexTriangle& second);

/// @returns whether two triangles lie in one plane, decided exactly: the first one's plane contains all corners of the
/// second.
[[nodiscard]] bool surely_in_one_plane(const VertexTriangle& first, const VertexTriangle& second, WorkCounters& work);

/// @returns comes_first() by exact arithmetic: the nearer triangle, or the lower id in one plane or at one place.
[[nodiscard]] GRIDIRON_INLINE bool comes_first_exactly(const float origin[3], const float dir[3],
                                                       const VertexTriangle& first, const VertexTriangle& second,
                                                       bool has_lower_id, WorkCounters& work) {
  if (surely_in_one_plane(first, second, work)) return has_lower_id;
  work.add(Work::kExactOrder);
  const int order = exact_distance_order(origin, dir, first.v, second.v);
  return order < 0 || (order == 0 && has_lower_id);
}

/// @returns whether the first of two triangles at the same rounded distance is the ray's hit.
template <class PacketType>
[[nodiscard]] GRIDIRON_RARE bool comes_first(const PacketType& packet, std::uint32_t ray, const VertexTriangle& first,
                                             const VertexTriangle& second, WorkCounters& work) {
  const bool has_lower_id = first.triangle_id < second.triangle_id;
  if (!packet.breaks_ties || in_one_plane(first, second)) return has_lower_id;
  work.add(Work::kHitSetup, 2);
  work.add(Work::kHitHalf);
  const float dir[3] = {packet.dir[0][ray], packet.dir[1][ray], packet.dir[2][ray]};
  const DistanceInterval one = distance_interval(packet.origin, packet.dir_max, dir, first);
  const DistanceInterval other = distance_interval(packet.origin, packet.dir_max, dir, second);
  if (one.high < other.low) return true;
  if (other.high < one.low) return false;
  return comes_first_exactly(packet.origin, dir, first, second, has_lower_id, work);
}

/// Decides hits that are too close to the rays' earlier ones: both distances exact, then the least (t, id).
///
/// @param close  lanes. @param distance  of the new hits, exact. @returns the lanes whose new hit is nearer; t of the
///               others becomes exact. If a ray's old triangle is no longer kept, the ray becomes unsure.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_RARE std::uint32_t settle_close_hits(PacketType& packet, std::uint32_t base, std::uint32_t close,
                                                            const VertexTriangle& triangle, const float* distance,
                                                            WorkCounters& work) {
  std::uint32_t nearer = 0;
  while (close != 0) {
    const std::uint32_t old_id = packet.id[base + lowest_bit(close)];
    std::uint32_t alike = 0;  // the lanes that had hit the same triangle
    for (std::uint32_t rest = close; rest != 0; rest &= rest - 1) {
      const std::uint32_t lane = lowest_bit(rest);
      if (packet.id[base + lane] == old_id) alike |= 1u << lane;
    }
    close &= ~alike;
    alignas(64) float old_distance[L::kCount];
    const VertexTriangle* const old_triangle = packet.find(old_id);
    if (old_triangle != nullptr) {
      work.add(Work::kHitSetup);
      DistanceSetup setup;
      set_up_distance(packet.origin, packet.dir_max, *old_triangle, setup);
      distances_of<L>(packet, base, alike, *old_triangle, setup, old_distance, work);
    }
    work.charge_to(Work::kHitHalf);
    for (std::uint32_t rest = alike; rest != 0; rest &= rest - 1) {
      const std::uint32_t lane = lowest_bit(rest);
      const std::uint32_t ray = base + lane;
      if (old_triangle == nullptr) {
        packet.unsure.insert(ray);
        continue;
      }
      packet.t[ray] = old_distance[lane];
      const bool is_tie = distance[lane] == old_distance[lane];
      if (distance[lane] < old_distance[lane] || (is_tie && comes_first(packet, ray, triangle, *old_triangle, work))) {
        nearer |= 1u << lane;
      }
    }
  }
  return nearer;
}

/// Decides, by exact distances, those hits of a group that the estimates leave open.
///
/// @param open  lanes. @param distance  out, in these lanes. @returns the lanes that are nearer than what they had hit.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_OUTLINE std::uint32_t settle_hits(PacketType& packet, std::uint32_t base, std::uint32_t open,
                                                         const VertexTriangle& triangle, HitSetups<L>& setups,
                                                         float* distance, WorkCounters& work) {
  using Float = typename L::Float;
  if (!setups.has_distance) {
    work.add(Work::kHitSetup);
    set_up_distance(packet.origin, packet.dir_max, triangle, setups.distance);
    setups.has_distance = true;
  }
  distances_of<L>(packet, base, open, triangle, setups.distance, distance, work);
  work.charge_to(Work::kHitHalf);
  const Float t = Float::load(distance);
  const Float old_t = Float::load(packet.t + base);
  const std::uint32_t in_front = (t > Float(0.0f)).bits() & open;
  std::uint32_t nearer = (t < old_t * Float(packet.surely_nearer)).bits() & in_front;
  const std::uint32_t behind = (t > old_t * Float(packet.surely_behind)).bits();
  std::uint32_t close = in_front & ~nearer & ~behind;
  if (packet.estimates != 0) {
    if (close == 0) [[likely]]
      return nearer;
    return nearer | settle_close_hits<L>(packet, base, close, triangle, distance, work);
  }
  for (; close != 0; close &= close - 1) {
    const std::uint32_t ray = base + lowest_bit(close);
    const VertexTriangle* const old_triangle = packet.find(packet.id[ray]);
    bool is_first = triangle.triangle_id < packet.id[ray];
    if (packet.breaks_ties && packet.id[ray] != kNoTriangle) {
      if (old_triangle == nullptr) {
        packet.unsure.insert(ray);
        continue;
      }
      is_first = comes_first(packet, ray, triangle, *old_triangle, work);
    }
    if (is_first) nearer |= 1u << (ray - base);
  }
  if (packet.breaks_ties && nearer != 0) packet.taken = triangle;
  return nearer;
}

/// Merges a triangle's hits into a group of rays, all but facing: the least (t, id) stays. @returns the lanes whose new
/// hit is nearer.
///
/// An estimate of the distance decides nearly always. If it cannot, or packet.estimates is 0 and t has to be exact, the
/// distance is computed in double.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_OUTLINE std::uint32_t merge_distances(PacketType& packet, std::uint32_t base, std::uint32_t hit,
                                                             const VertexTriangle& triangle, HitSetups<L>& setups,
                                                             WorkCounters& work) {
  using Float = typename L::Float;
  setups.estimate(packet, triangle, work);
  work.add(Work::kHitGroup);
  const Float d_x = Float::load(packet.dir[0] + base);
  const Float d_y = Float::load(packet.dir[1] + base);
  const Float d_z = Float::load(packet.dir[2] + base);
  const Float denominator = setups.normal[0] * d_x + setups.normal[1] * d_y + setups.normal[2] * d_z;
  Float old_t = Float::load(packet.t + base);
  // Compared without the quotient, to avoid waiting for it.
  const Float old_numerator = old_t * denominator;
  const auto is_close = denominator > setups.least_denominator;
  std::uint32_t nearer =
      (is_close & (setups.numerator < old_numerator * Float(kSurelyNearer))).bits() & hit & packet.estimates;
  Float t = setups.numerator / denominator;
  if (nearer != hit) [[unlikely]] {
    work.add(Work::kOpenHitGroup);
    // A hit behind another or behind the origin, or of a triangle that was tested before, changes nothing.
    const auto is_behind = (denominator < -setups.least_denominator) |
                           (is_close & (setups.numerator > old_numerator * Float(kSurelyBehind)));
    hit &= ~(is_behind | L::equal(triangle.triangle_id, packet.id + base)).bits();
    if (packet.trusts_floats) {
      nearer = (is_close & (setups.numerator < old_numerator)).bits() & hit;
    } else if (nearer != hit) {
      work.add(Work::kSettledGroup);
      alignas(64) float distance[L::kCount];
      const auto estimated = L::mask_from_bits(nearer);
      nearer |= settle_hits<L>(packet, base, hit & ~nearer, triangle, setups, distance, work);
      work.charge_to(Work::kSettledGroup);
      t = L::select(estimated, t, Float::load(distance));
      old_t = Float::load(packet.t + base);  // may have become exact
    }
    if (nearer == 0) return 0;
    work.charge_to(Work::kHitGroup);
  }
  const auto taken = L::mask_from_bits(nearer);
  L::select(taken, t, old_t).store(packet.t + base);
  L::store_where(taken, triangle.triangle_id, packet.id + base);
  return nearer;
}

/// @returns the cosines of a group's directions with a triangle's unit normal, times their lengths.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_INLINE typename L::Float facing_of(const PacketType& packet, std::uint32_t base,
                                                          const HitSetups<L>& setups) {
  using Float = typename L::Float;
  return L::abs(setups.unit_normal[0] * Float::load(packet.dir[0] + base) +
                setups.unit_normal[1] * Float::load(packet.dir[1] + base) +
                setups.unit_normal[2] * Float::load(packet.dir[2] + base));
}

/// Merges a triangle's hits into a group of rays: the least (t, id) stays. @returns whether one of them is nearer.
template <class L, bool kWantFacing, class PacketType>
[[nodiscard]] GRIDIRON_INLINE bool merge_hits(PacketType& packet, std::uint32_t base, std::uint32_t hit,
                                              const VertexTriangle& triangle, HitSetups<L>& setups,
                                              WorkCounters& work) {
  const std::uint32_t nearer = merge_distances<L>(packet, base, hit, triangle, setups, work);
  if constexpr (kWantFacing) {
    if (nearer == 0) return false;
    using Float = typename L::Float;
    setups.find_normal(triangle, work);
    work.add(Work::kFacingGroup);
    L::select(L::mask_from_bits(nearer), facing_of<L>(packet, base, setups), Float::load(packet.facing + base))
        .store(packet.facing + base);
  }
  return nearer != 0;
}

/// Takes a triangle's hits of a whole subpacket, all but facing, if it is surely the nearest of all its rays.
/// @returns whether it is; if not, nothing has changed.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_OUTLINE bool take_distances(PacketType& packet, std::uint32_t first_ray,
                                                   const VertexTriangle& triangle, HitSetups<L>& setups,
                                                   WorkCounters& work) {
  using Float = typename L::Float;
  static constexpr std::uint32_t kGroups = kSubpacketRays / L::kCount;
  setups.estimate(packet, triangle, work);
  work.add(Work::kHitSubpacket);
  Float denominator[kGroups];
  auto is_nearer = L::mask_from_bits(packet.estimates);
  for (std::uint32_t group = 0; group < kGroups; ++group) {
    const std::uint32_t base = first_ray + group * L::kCount;
    denominator[group] = setups.normal[0] * Float::load(packet.dir[0] + base) +
                         setups.normal[1] * Float::load(packet.dir[1] + base) +
                         setups.normal[2] * Float::load(packet.dir[2] + base);
    const Float old_numerator = Float::load(packet.t + base) * denominator[group];
    is_nearer = is_nearer & (denominator[group] > setups.least_denominator) &
                (setups.numerator < old_numerator * Float(kSurelyNearer));
  }
  if (is_nearer.bits() != L::kAllBits) return false;
  work.add(Work::kTakenSubpacket);
  const typename L::Int id = L::Int::splat(triangle.triangle_id);
  for (std::uint32_t group = 0; group < kGroups; ++group) {
    const std::uint32_t base = first_ray + group * L::kCount;
    (setups.numerator / denominator[group]).store(packet.t + base);
    id.store(packet.id + base);
  }
  return true;
}

/// Takes a triangle's hits of a whole subpacket if it is surely the nearest of all its rays.
/// @returns whether it is; if not, nothing has changed.
template <class L, bool kWantFacing, class PacketType>
[[nodiscard]] GRIDIRON_INLINE bool take_subpacket(PacketType& packet, std::uint32_t first_ray,
                                                  const VertexTriangle& triangle, HitSetups<L>& setups,
                                                  WorkCounters& work) {
  if (!take_distances<L>(packet, first_ray, triangle, setups, work)) return false;
  if constexpr (kWantFacing) {
    setups.find_normal(triangle, work);
    work.add(Work::kFacingGroup, kSubpacketRays / L::kCount);
    for (std::uint32_t ray = first_ray; ray < first_ray + kSubpacketRays; ray += L::kCount) {
      facing_of<L>(packet, ray, setups).store(packet.facing + ray);
    }
  }
  return true;
}

}  // namespace gridiron
