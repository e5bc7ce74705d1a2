// The `standard` ray/triangle test: edge signs by a filtered float test with exact integers behind it, distances
// rounded correctly. Watertight by construction: every decision equals the one exact arithmetic takes.
// Source: own; the edge functions' form n = (a + b) x (b - a) follows Kensler, Shirley 2006 in spirit.
// Memory: values. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/exact_sum.h>
#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/packet.h>

#include <cstdint>

namespace gridiron {

/// Edge functions of one triangle for all rays of one packet (they share the origin o). Lane k = edge k, from
/// vertex k to vertex k + 1: with a = A - o, b = B - o, n = (a + b) x (b - a), so that n . d = 2 det[d, a, b].
///
/// Error of n . d in single precision, e = 2^-23 (one unit in any rounding mode), S = |a| + |b|, F = |b - a| per
/// component: S and a + b carry 2 e S, F carries e F, a product of them adds e, so each of the two products of a
/// component is within 4 e S_j F_k, their difference within 5 e (S_j F_k + S_k F_j). Times d and summed over three
/// components: 3 e more. In all 8 e sum_i |d_i| (S_j F_k + S_k F_j) <= 16 e |d|max |F|max |S|1, and the bound itself
/// is computed with less than 1 e of relative error per operation: 17 e covers it. kUnderflow, times |d|max where that
/// is above 1, covers what products below the least normal float lose. Edges whose magnitudes leave the range where this
/// holds are decided exactly.
template <class L>
struct StandardEdges {
  using Four = Lanes<4>;
  typename Four::Float n_x, n_y, n_z;  ///< signed so that inside means n . d >= 0 on all three edges
  typename Four::Float error;          ///< |n . d| above this has the right sign, for every active ray
  bool in_range;                       ///< false: the float test says nothing
};

inline constexpr float kEdgeErrorFactor = 17.0f * 0x1p-23f;
inline constexpr float kUnderflow = 0x1p-100f;
inline constexpr float kEdgeRangeLimit = 0x1p100f;
inline constexpr float kVolumeErrorLimit = 0x1p90f;

/// A bound of the rounding of pixel directions themselves, added where the corner rays speak for all others.
inline constexpr float kCornerErrorFactor = 5.0f * 0x1p-23f;

/// @returns sign of det[a - o, b - o, c - o]: float filter by the caller, then double, then integers.
[[nodiscard]] int volume_sign_in_double(const float origin[3], const VertexTriangle& triangle, WorkCounters& work);

/// @returns sign of det[dir, a - o, b - o]: in double where that is sure, else in integers.
[[nodiscard]] int edge_sign_in_double(const float origin[3], const float dir[3], const float a[3], const float b[3],
                                      WorkCounters& work);

/// What the distances of one triangle need, in double. Distance of a ray = numerator / (normal . d).
///
/// With u = 2^-52: normal = (b - a) x (c - a) has error 4 u M per component, M_x = |e1_y e2_z| + |e1_z e2_y|; the
/// numerator (a - o) . normal 8 u sum |a_i| M_i; the denominator 7 u |d|max sum M_i. kDistanceError is twice that.
struct DistanceSetup {
  double normal[3];
  double numerator;
  double relative_error;        ///< of the quotient, but for the denominator's part
  double relative_error_per_t;  ///< times the quotient: the denominator's part
  double facing_scale;          ///< 1 / |normal|
};
inline constexpr double kDistanceError = 0x1p-48;

void set_up_distance(const float origin[3], float dir_max, const VertexTriangle& triangle, DistanceSetup& setup);

/// Prepares the edge functions of a triangle for a packet.
///
/// @param range_factor  the larger of dir_max and 1.
/// @returns +1 or -1, the orientation as seen from the packet's origin, or 0: the origin lies in the triangle's plane
///          and no ray of the packet can hit it at a distance above 0.
template <class L>
[[nodiscard]] GRIDIRON_INLINE int set_up_edges(const float origin[3], float dir_max, float range_factor,
                                               const VertexTriangle& triangle, StandardEdges<L>& edges,
                                               WorkCounters& work) {
  using Four = Lanes<4>;
  using Float = typename Four::Float;
  using Vector = typename Four::FloatVector;
  // The record's first 36 bytes are x0 y0 z0 x1 | y1 z1 x2 y2 | z2: turn them into one vector per axis.
  const float* values = &triangle.v[0][0];
  const Vector row0 = Float::load(values).v;
  const Vector row1 = Float::load(values + 4).v;
  const Float z2(values[8]);
  const Vector xs = __builtin_shufflevector(row0, row1, 0, 3, 6, 6);
  const Vector ys = __builtin_shufflevector(row0, row1, 1, 4, 7, 7);
  const Vector zs = __builtin_shufflevector(__builtin_shufflevector(row0, row1, 2, 5, 5, 5), z2.v, 0, 1, 4, 4);
  const Float a_x = Float(xs) - Float(origin[0]);
  const Float a_y = Float(ys) - Float(origin[1]);
  const Float a_z = Float(zs) - Float(origin[2]);
  const Float b_x(__builtin_shufflevector(a_x.v, a_x.v, 1, 2, 0, 0));
  const Float b_y(__builtin_shufflevector(a_y.v, a_y.v, 1, 2, 0, 0));
  const Float b_z(__builtin_shufflevector(a_z.v, a_z.v, 1, 2, 0, 0));
  // Lane 3 repeats vertex 2 against vertex 0, the same edge as lane 2: it never says anything new.
  const Float s_x = a_x + b_x, s_y = a_y + b_y, s_z = a_z + b_z;
  const Float f_x = Float(__builtin_shufflevector(xs, xs, 1, 2, 0, 0)) - Float(xs);
  const Float f_y = Float(__builtin_shufflevector(ys, ys, 1, 2, 0, 0)) - Float(ys);
  const Float f_z = Float(__builtin_shufflevector(zs, zs, 1, 2, 0, 0)) - Float(zs);
  const Float n_x = s_y * f_z - s_z * f_y;
  const Float n_y = s_z * f_x - s_x * f_z;
  const Float n_z = s_x * f_y - s_y * f_x;
  const Float size_a = Four::abs(a_x) + Four::abs(a_y) + Four::abs(a_z);
  const Float size_b(__builtin_shufflevector(size_a.v, size_a.v, 1, 2, 0, 0));
  const Float size_f = Four::max(Four::max(Four::abs(f_x), Four::abs(f_y)), Four::abs(f_z));
  const Float scale = (size_a + size_b) * size_f;
  edges.in_range = (scale * Float(range_factor) < Float(kEdgeRangeLimit)).bits() == 0xFu;
  edges.error = scale * Float(kEdgeErrorFactor * dir_max) + Float(kUnderflow * range_factor);

  // Orientation: with c the vertex opposite an edge, n . c = 2 det[a, b, c], by the same bound with c in the place of
  // d. The three edges give the same determinant; lane 0 is used.
  const Float c_x(__builtin_shufflevector(a_x.v, a_x.v, 2, 0, 1, 1));
  const Float c_y(__builtin_shufflevector(a_y.v, a_y.v, 2, 0, 1, 1));
  const Float c_z(__builtin_shufflevector(a_z.v, a_z.v, 2, 0, 1, 1));
  const Float size_c(__builtin_shufflevector(size_a.v, size_a.v, 2, 0, 1, 1));
  const Float volume = n_x * c_x + n_y * c_y + n_z * c_z;
  const Float volume_error =
      scale * (size_c * Float(2.0f * kEdgeErrorFactor)) + size_c * Float(kUnderflow) + Float(kUnderflow);
  const std::uint32_t sure = ((Four::abs(volume) > volume_error) & (volume_error < Float(kVolumeErrorLimit))).bits();
  int orientation = (volume < Float(0.0f)).bits() & 1u ? -1 : 1;
  if ((sure & 1u) == 0) [[unlikely]]
    orientation = volume_sign_in_double(origin, triangle, work);
  const Float flip(orientation < 0 ? -1.0f : 1.0f);
  edges.n_x = n_x * flip;
  edges.n_y = n_y * flip;
  edges.n_z = n_z * flip;
  return orientation;
}

/// @returns true where all four corner rays, and with them every ray between them, pass the triangle on the outside
///          of one and the same edge. Source: Dmitriev, Havran, Seidel 2004.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_INLINE bool corners_miss(const PacketType& packet, const StandardEdges<L>& edges) {
  using Four = Lanes<4>;
  using Float = typename Four::Float;
  Float nearest(-kFloatMax);
  for (int corner = 0; corner < 4; ++corner) {
    const Float value = edges.n_x * Float(packet.corner_dir[0][corner]) +
                        edges.n_y * Float(packet.corner_dir[1][corner]) +
                        edges.n_z * Float(packet.corner_dir[2][corner]);
    nearest = Four::max(nearest, value);
  }
  return edges.in_range && (nearest < -(edges.error * Float(packet.corner_widening))).bits() != 0;
}

/// Decides the lanes of one group that the float test left open. @returns those that hit the triangle's area.
///
/// @param sure_inside  per edge, the lanes whose float test surely passed on the inside.
template <class L, class PacketType>
[[nodiscard]] std::uint32_t settle_open_lanes(const PacketType& packet, std::uint32_t base, std::uint32_t open_bits,
                                              const std::uint32_t sure_inside[3], const VertexTriangle& triangle,
                                              int orientation, WorkCounters& work) {
  std::uint32_t inside = 0;
  for (std::uint32_t rest = open_bits; rest != 0; rest &= rest - 1) {
    const std::uint32_t lane = static_cast<std::uint32_t>(__builtin_ctz(rest));
    const float dir[3] = {packet.dir[0][base + lane], packet.dir[1][base + lane], packet.dir[2][base + lane]};
    bool hit = true;
    bool any = false;
    for (int edge = 0; edge < 3 && hit; ++edge) {
      int sign = 1;
      if (((sure_inside[edge] >> lane) & 1u) == 0) {
        sign =
            orientation * edge_sign_in_double(packet.origin, dir, triangle.v[edge], triangle.v[(edge + 1) % 3], work);
      }
      hit = sign >= 0;
      any = any || sign > 0;
    }
    if (hit && any) inside |= 1u << lane;
  }
  return inside;
}

/// Distances of a group's rays to a triangle, rounded to the nearest float, for the lanes in `bits`.
///
/// The quotient in double comes with a relative error; where both ends of its interval round to the same float, that
/// float is the answer, else integers give it. Rounding is done on bit patterns: no rounding mode can change it.
template <class L, class PacketType>
GRIDIRON_INLINE void distances_of(const PacketType& packet, std::uint32_t base, std::uint32_t bits,
                                  const VertexTriangle& triangle, const DistanceSetup& setup, float* distance,
                                  WorkCounters& work) {
  using Double = typename L::DoubleVector;
  using Long = typename L::LongVector;
  using HalfMemory = typename L::HalfFloatMemory;
  using HalfInt = typename L::HalfIntVector;
  constexpr std::uint32_t kHalf = L::kCount / 2;
  std::uint32_t unsure = 0;
  for (std::uint32_t half = 0; half < 2; ++half) {
    const std::uint32_t first = base + half * kHalf;
    const Double d_x = __builtin_convertvector(*reinterpret_cast<const HalfMemory*>(packet.dir[0] + first), Double);
    const Double d_y = __builtin_convertvector(*reinterpret_cast<const HalfMemory*>(packet.dir[1] + first), Double);
    const Double d_z = __builtin_convertvector(*reinterpret_cast<const HalfMemory*>(packet.dir[2] + first), Double);
    const Double denominator = d_x * setup.normal[0] + d_y * setup.normal[1] + d_z * setup.normal[2];
    const Double quotient = setup.numerator / denominator;
    // error(D) / |D| = error(D) |t| / |N|
    const Double relative = quotient * setup.relative_error_per_t + setup.relative_error;
    constexpr std::int64_t kHalfStep = std::int64_t{1} << 28;
    const Long low = (reinterpret_cast<Long>(quotient - quotient * relative) + kHalfStep) >> 29;
    const Long high = (reinterpret_cast<Long>(quotient + quotient * relative) + kHalfStep) >> 29;
    constexpr std::int64_t kRebias = std::int64_t{1023 - 127} << 23;
    const Long pattern = low - kRebias;
    const Long sure = (low == high) & (pattern >= 0x00800000) & (pattern <= 0x7F7FFFFF) & (relative < 0x1p-10);
    *reinterpret_cast<typename L::HalfIntMemory*>(distance + half * kHalf) = __builtin_convertvector(pattern, HalfInt);
    unsure |= L::half_bits(~sure) << (half * kHalf);
  }
  unsure &= bits;
  for (std::uint32_t lane = 0; unsure != 0 && lane < L::kCount; ++lane) {
    if (((unsure >> lane) & 1u) == 0) continue;
    const float dir[3] = {packet.dir[0][base + lane], packet.dir[1][base + lane], packet.dir[2][base + lane]};
    distance[lane] = exact_distance(packet.origin, dir, triangle.v[0], triangle.v[1], triangle.v[2]);
    work.add(Work::kExactDistance);
  }
}

/// Intersects one triangle with every active ray of a packet, keeping the least (t, id).
///
/// @param packet    t, id (and facing where wanted) are updated. @param use_culling  the corner rays bound the packet.
/// @returns         true where a ray's hit changed.
/// Errors: none (hot path). Cost: one set-up, at most kRayCount / L::kCount group tests.
template <class L, bool kWantFacing, class PacketType>
[[nodiscard]] GRIDIRON_INLINE bool intersect_standard(PacketType& packet, const VertexTriangle& triangle,
                                                      bool use_culling, WorkCounters& work) {
  using Float = typename L::Float;
  StandardEdges<L> edges;
  work.add(Work::kTriangleSetup);
  const int orientation = set_up_edges<L>(packet.origin, packet.dir_max, packet.range_factor, triangle, edges, work);
  if (orientation == 0) return false;
  if (use_culling) {
    work.add(Work::kCullTest);
    if (corners_miss<L>(packet, edges)) return false;
  }
  const Float n0_x(edges.n_x.v[0]), n0_y(edges.n_y.v[0]), n0_z(edges.n_z.v[0]), error0(edges.error.v[0]);
  const Float n1_x(edges.n_x.v[1]), n1_y(edges.n_y.v[1]), n1_z(edges.n_z.v[1]), error1(edges.error.v[1]);
  const Float n2_x(edges.n_x.v[2]), n2_y(edges.n_y.v[2]), n2_z(edges.n_z.v[2]), error2(edges.error.v[2]);

  DistanceSetup setup;
  bool setup_done = false;
  bool changed = false;
  for (std::uint32_t base = 0; base < PacketType::kRayCount; base += L::kCount) {
    const std::uint32_t active = packet.active.template group<L>(base);
    if (active == 0) continue;
    work.add(Work::kGroupTestStandard);
    const Float d_x = Float::load(packet.dir[0] + base);
    const Float d_y = Float::load(packet.dir[1] + base);
    const Float d_z = Float::load(packet.dir[2] + base);
    const Float e0 = n0_x * d_x + n0_y * d_y + n0_z * d_z;
    const Float e1 = n1_x * d_x + n1_y * d_y + n1_z * d_z;
    const Float e2 = n2_x * d_x + n2_y * d_y + n2_z * d_z;
    // 1. One edge that is surely passed on the outside ends it.
    const std::uint32_t outside = ((e0 < -error0) | (e1 < -error1) | (e2 < -error2)).bits();
    std::uint32_t open = active & (edges.in_range ? ~outside : ~0u);
    if (open == 0) continue;
    // 2. Three edges surely passed on the inside: a hit. Anything else is decided in double, then exactly.
    const std::uint32_t known = edges.in_range ? ~0u : 0u;
    const std::uint32_t sure_inside[3] = {(e0 > error0).bits() & known, (e1 > error1).bits() & known,
                                          (e2 > error2).bits() & known};
    std::uint32_t inside = open & sure_inside[0] & sure_inside[1] & sure_inside[2];
    open &= ~inside;
    if (open != 0) [[unlikely]] {
      inside |= settle_open_lanes<L>(packet, base, open, sure_inside, triangle, orientation, work);
    }
    if (inside == 0) continue;
    // 3. Distances, and the least (t, id).
    if (!setup_done) {
      set_up_distance(packet.origin, packet.dir_max, triangle, setup);
      work.add(Work::kHitSetup);
      setup_done = true;
    }
    work.add(Work::kHitGroup);
    alignas(64) float distance[L::kCount];
    distances_of<L>(packet, base, inside, triangle, setup, distance, work);
    for (std::uint32_t rest = inside; rest != 0; rest &= rest - 1) {
      const std::uint32_t lane = static_cast<std::uint32_t>(__builtin_ctz(rest));
      const float t = distance[lane];
      float& best_t = packet.t[base + lane];
      std::uint32_t& best_id = packet.id[base + lane];
      const bool nearer = t > 0.0f && (t < best_t || (t == best_t && triangle.triangle_id < best_id));
      if (!nearer) continue;
      best_t = t;
      best_id = triangle.triangle_id;
      changed = true;
      if constexpr (kWantFacing) {
        const double along = setup.normal[0] * packet.dir[0][base + lane] +
                             setup.normal[1] * packet.dir[1][base + lane] +
                             setup.normal[2] * packet.dir[2][base + lane];
        const float cosine = static_cast<float>(along * setup.facing_scale);
        packet.facing[base + lane] = cosine < 0.0f ? -cosine : cosine;
      }
    }
  }
  return changed;
}

}  // namespace gridiron
