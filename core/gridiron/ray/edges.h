// Edges: on which sides of a triangle's edges rays pass. A float test with a bound of its error, then doubles, then
// integers: every decision equals that of exact arithmetic.
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

/// Edge functions of L::kCount / 4 triangles for all rays of one packet (they share the origin o). Each triangle has a
/// quad of lanes, lane k = edge k, from vertex k to vertex k + 1 (lane 3 repeats edge 2): with a = A - o, b = B - o,
/// n = (a + b) x (b - a), so that n . d = 2 det[d, a, b].
///
/// Error of n . d in single precision, e = 2^-23 (one unit in any rounding mode), S = |a| + |b|, F = |b - a| per
/// component: S and a + b carry 2 e S, F carries e F, a product of them adds e, so each of the two products of a
/// component is within 4 e S_j F_k, their difference within 5 e (S_j F_k + S_k F_j). Times d and summed over three
/// components: 3 e more. In all 8 e sum_i |d_i| (S_j F_k + S_k F_j) <= 16 e |d|max |F|max |S|1, and the bound itself
/// is computed with less than 1 e of relative error per operation: 17 e covers it. kUnderflow, times |d|max where that
/// is above 1, covers what products below the least normal float lose. Edges whose magnitudes leave the range where
/// this holds are decided exactly.
///
/// Only e enters, so this holds in every rounding mode, and with fused operations, which round less often. Below the
/// least normal float, with denormals: sums of floats are exact, and nine products lose 2^-149 each, 6 of them times
/// |d|: far less than kUnderflow. With denormals flushed, in and out, it holds where coordinates are 0 or at least
/// 2^-102 and |d|max is at least 2^-70, as a frame's is: such coordinates are multiples of 2^-125, and so are all their
/// sums and differences, none of which is lost; products and sums of products lose 2^-126 each, 9 |d|max + 5 times that
/// in all; a component of d that is lost, 2 scale times that, less than the 1 e scale |d|max left over.
/// The doubles below have the same error with 2^-52 for e, twice that charged, and no denormals then.
template <class L>
struct EdgeBatch {
  static constexpr std::uint32_t kTriangles = L::kCount / 4;
  alignas(64) float n[3][L::kCount];     ///< signed so that inside means n . d >= 0 on all three edges
  alignas(64) float error[L::kCount];    ///< |n . d| above this has the right sign, for every active ray
  std::uint32_t in_range;                ///< lanes for which the float test is valid
  std::uint32_t missed;                  ///< lanes whose edge all four corner rays surely pass on the outside
  std::int32_t orientation[kTriangles];  ///< +1, -1; 0: the origin lies in the triangle's plane, nothing can be hit

  // For culling subpackets: n . d as a linear function of the pixel, and the value below which a ray surely passes the
  // edge on the outside.
  alignas(64) float per_column[L::kCount];
  alignas(64) float per_row[L::kCount];
  alignas(64) float surely_outside[L::kCount];
  // Its largest value over a quarter, a square and a row whose first pixel is that of the packet, and the offsets from
  // there to the largest and to the least value of a subpacket.
  alignas(64) float first_quarter[L::kCount];
  alignas(64) float first_square[L::kCount];
  alignas(64) float first_row[L::kCount];
  alignas(64) float square_to_subpacket[L::kCount];
  alignas(64) float subpacket_span[L::kCount];
};

/// Tests that may be skipped by looking at several rays at once.
struct Culling {
  bool corner_rays;  ///< the packet's corner rays bound it
  bool subpackets;   ///< its rays are a linear function of the pixel
};

inline constexpr float kEdgeErrorFactor = 17.0f * 0x1p-23f;
inline constexpr float kUnderflow = 0x1p-100f;
inline constexpr float kEdgeRangeLimit = 0x1p100f;
inline constexpr float kVolumeErrorLimit = 0x1p90f;

/// A bound of the rounding of pixel directions themselves, added where the corner rays speak for all others: with D as
/// below, the edge function of a rounded ray is above the largest of the corner rays' by at most
/// (5 D + |d|max) e scale, in every rounding mode; tests/numeric/proofs/README.md has the argument.
inline constexpr float kCornerErrorFactor = 5.0f * 0x1p-23f;

/// The same for n . d evaluated as first + column * per_column + row * per_row. With D the largest sum of magnitudes
/// that goes into a direction's component and scale = |F|max |S|1 >= |n|1 / 2: the rounding of n itself is within
/// 16 e scale D; the direction differs from the linear form by less than 6 e D, 12 e scale D in all; and at most 16
/// roundings of sums of at most 2 scale D each, 32 e scale D, happen on the way. 60 e covers all, 68 e is charged.
inline constexpr float kSubpacketErrorFactor = 68.0f * 0x1p-23f;

/// @returns sign of det[a - o, b - o, c - o]: the caller has tried floats; here doubles, then integers.
[[nodiscard]] std::int32_t volume_sign(const float origin[3], const VertexTriangle& triangle, WorkCounters& work);

/// @returns sign of det[dir, a - o, b - o]: doubles if they are sure, else integers.
[[nodiscard]] std::int32_t edge_sign(const float origin[3], const float dir[3], const float a[3], const float b[3],
                                     WorkCounters& work);

/// Prepares the edge functions of a batch of triangles for a packet, and tests its corner rays: if all four pass on the
/// outside of the same edge, so does every ray between them (Dmitriev, Havran, Seidel 2004).
///
/// @param triangles  EdgeBatch<L>::kTriangles of them; a shorter batch repeats one.
template <class L, class PacketType>
GRIDIRON_OUTLINE void set_up_edges(const PacketType& packet, const VertexTriangle* const* triangles, Culling culling,
                                   EdgeBatch<L>& batch, WorkCounters& work) {
  using Float = typename L::Float;
  static constexpr std::uint32_t kTriangles = EdgeBatch<L>::kTriangles;
  // A record's first 36 bytes are x0 y0 z0 x1 | y1 z1 x2 y2 | z2; this makes one vector per axis of them.
  const float* rows[3][kTriangles];
  for (std::uint32_t i = 0; i < kTriangles; ++i) {
    for (int row = 0; row < 3; ++row) rows[row][i] = &triangles[i]->v[0][0] + 4 * row;
  }
  const Float row0 = L::load_quads(rows[0]);
  const Float row1 = L::load_quads(rows[1]);
  const Float row2 = L::load_quads(rows[2]);
  const Float x = L::template shuffle_quads<0, 3, 6, 6>(row0, row1);
  const Float y = L::template shuffle_quads<1, 4, 7, 7>(row0, row1);
  const Float z = L::template shuffle_quads<0, 1, 4, 4>(L::template shuffle_quads<2, 5, 5, 5>(row0, row1), row2);
  const auto next = [](Float value) { return L::template shuffle_quads<1, 2, 0, 0>(value); };
  const auto opposite = [](Float value) { return L::template shuffle_quads<2, 0, 1, 1>(value); };
  const Float a_x = x - Float(packet.origin[0]);
  const Float a_y = y - Float(packet.origin[1]);
  const Float a_z = z - Float(packet.origin[2]);
  const Float s_x = a_x + next(a_x), s_y = a_y + next(a_y), s_z = a_z + next(a_z);
  const Float f_x = next(x) - x, f_y = next(y) - y, f_z = next(z) - z;
  const Float n_x = s_y * f_z - s_z * f_y;
  const Float n_y = s_z * f_x - s_x * f_z;
  const Float n_z = s_x * f_y - s_y * f_x;
  const Float size_a = L::abs(a_x) + L::abs(a_y) + L::abs(a_z);
  const Float size_f = L::max(L::max(L::abs(f_x), L::abs(f_y)), L::abs(f_z));
  const Float scale = (size_a + next(size_a)) * size_f;
  const Float error = scale * Float(kEdgeErrorFactor * packet.dir_max) + Float(kUnderflow * packet.range_factor);
  batch.in_range = (scale * Float(packet.range_factor) < Float(kEdgeRangeLimit)).bits();

  // Orientation: with c the vertex opposite an edge, n . c = 2 det[a, b, c], with the same bound and c in place of d.
  // The three edges give the same determinant, so the quad's first lane is enough.
  const Float size_c = opposite(size_a);
  const Float volume = n_x * opposite(a_x) + n_y * opposite(a_y) + n_z * opposite(a_z);
  const Float volume_error =
      scale * (size_c * Float(2.0f * kEdgeErrorFactor)) + size_c * Float(kUnderflow) + Float(kUnderflow);
  const std::uint32_t sure = ((L::abs(volume) > volume_error) & (volume_error < Float(kVolumeErrorLimit))).bits();
  const std::uint32_t negative = (L::template shuffle_quads<0, 0, 0, 0>(volume) < Float(0.0f)).bits();
  std::uint32_t flipped = negative;
  for (std::uint32_t i = 0; i < kTriangles; ++i) {
    const std::uint32_t first_lane = 4 * i;
    batch.orientation[i] = ((negative >> first_lane) & 1u) != 0 ? -1 : 1;
    if (((sure >> first_lane) & 1u) != 0 || packet.trusts_floats) [[likely]]
      continue;
    batch.orientation[i] = volume_sign(packet.origin, *triangles[i], work);
    flipped &= ~(0xFu << first_lane);
    if (batch.orientation[i] < 0) flipped |= 0xFu << first_lane;
  }
  const auto flip = L::mask_from_bits(flipped);
  const Float inward_x = L::flip_sign(flip, n_x);
  const Float inward_y = L::flip_sign(flip, n_y);
  const Float inward_z = L::flip_sign(flip, n_z);
  inward_x.store(batch.n[0]);
  inward_y.store(batch.n[1]);
  inward_z.store(batch.n[2]);
  error.store(batch.error);

  if (culling.subpackets) {
    work.charge_to(Work::kSlopeSetup);
    const auto along = [&](const float* direction) {
      return inward_x * Float(direction[0]) + inward_y * Float(direction[1]) + inward_z * Float(direction[2]);
    };
    static constexpr float kSubpacketSpan = kSubpacketWidth - 1.0f;
    static constexpr float kSquareSpan = 2.0f * kSubpacketWidth - 1.0f;
    static constexpr float kQuarterSpan = 4.0f * kSubpacketWidth - 1.0f;
    const Float first = along(packet.first_dir);
    const Float per_column = along(packet.step_x);
    const Float per_row = along(packet.step_y);
    const Float rise_column = L::max(per_column, Float(0.0f));
    const Float rise = rise_column + L::max(per_row, Float(0.0f));  // per pixel of a square's side
    per_column.store(batch.per_column);
    per_row.store(batch.per_row);
    (-(error * Float(packet.subpacket_widening))).store(batch.surely_outside);
    (first + rise * Float(kQuarterSpan)).store(batch.first_quarter);
    (first + rise * Float(kSquareSpan)).store(batch.first_square);
    (first + rise_column * Float(kSubpacketSpan)).store(batch.first_row);
    (rise * Float(kSubpacketSpan - kSquareSpan)).store(batch.square_to_subpacket);
    ((L::abs(per_column) + L::abs(per_row)) * Float(kSubpacketSpan)).store(batch.subpacket_span);
  }

  batch.missed = 0;
  if (!culling.corner_rays) return;
  work.charge_to(Work::kCullTest);
  Float nearest(-kFloatMax);
  for (int corner = 0; corner < 4; ++corner) {
    nearest = L::max(nearest, inward_x * Float(packet.corner_dir[0][corner]) +
                                  inward_y * Float(packet.corner_dir[1][corner]) +
                                  inward_z * Float(packet.corner_dir[2][corner]));
  }
  batch.missed = (nearest < -(error * Float(packet.corner_widening))).bits() & batch.in_range;
}

/// Decides the lanes of one group that the float test left open. @returns those that hit the triangle's area.
///
/// @param sure_inside  per edge, the lanes whose float test surely passed on the inside.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_OUTLINE std::uint32_t settle_open_lanes(const PacketType& packet, std::uint32_t base,
                                                               std::uint32_t open_bits,
                                                               const std::uint32_t sure_inside[3],
                                                               const VertexTriangle& triangle, std::int32_t orientation,
                                                               WorkCounters& work) {
  std::uint32_t inside = 0;
  for (std::uint32_t rest = open_bits; rest != 0; rest &= rest - 1) {
    const std::uint32_t lane = lowest_bit(rest);
    const float dir[3] = {packet.dir[0][base + lane], packet.dir[1][base + lane], packet.dir[2][base + lane]};
    bool hit = true;
    bool any = false;
    for (int edge = 0; edge < 3 && hit; ++edge) {
      std::int32_t sign = 1;
      if (((sure_inside[edge] >> lane) & 1u) == 0) {
        sign = orientation * edge_sign(packet.origin, dir, triangle.v[edge], triangle.v[(edge + 1) % 3], work);
      }
      hit = sign >= 0;
      any = any || sign > 0;
    }
    if (hit && any) inside |= 1u << lane;
  }
  return inside;
}

/// One triangle's edge functions, each in all lanes.
template <class L>
struct SplatEdges {
  using Float = typename L::Float;
  Float n[3][3];  ///< edge, axis
  Float error[3];
  std::uint32_t known;  ///< all lanes or none: whether the float test is valid

  GRIDIRON_INLINE SplatEdges(const EdgeBatch<L>& batch, std::uint32_t index) {
    const std::uint32_t first_lane = 4 * index;
    for (std::uint32_t edge = 0; edge < 3; ++edge) {
      for (std::uint32_t axis = 0; axis < 3; ++axis) n[edge][axis] = Float(batch.n[axis][first_lane + edge]);
      error[edge] = Float(batch.error[first_lane + edge]);
    }
    known = ((batch.in_range >> first_lane) & 0xFu) == 0xFu ? ~0u : 0u;
  }
};

/// @returns those of a group's active rays that hit the triangle's area.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t lanes_inside(const PacketType& packet, std::uint32_t base,
                                                         std::uint32_t active, const SplatEdges<L>& edges,
                                                         const VertexTriangle& triangle, std::int32_t orientation,
                                                         bool is_row, WorkCounters& work) {
  using Float = typename L::Float;
  work.add(is_row ? Work::kRowTest : Work::kGroupTestStandard);
  const Float d_x = Float::load(packet.dir[0] + base);
  const Float d_y = Float::load(packet.dir[1] + base);
  const Float d_z = Float::load(packet.dir[2] + base);
  const auto along = [&](int edge) GRIDIRON_INLINE_LAMBDA {
    return edges.n[edge][0] * d_x + edges.n[edge][1] * d_y + edges.n[edge][2] * d_z;
  };
  const Float e0 = along(0), e1 = along(1), e2 = along(2);
  // 1. If a ray surely passes one edge on the outside, it misses.
  const std::uint32_t outside = ((e0 < -edges.error[0]) | (e1 < -edges.error[1]) | (e2 < -edges.error[2])).bits();
  std::uint32_t open = active & ~(outside & edges.known);
  if (open == 0) return 0;
  const Work inside_kind = is_row ? Work::kRowInsideTest : Work::kInsideTest;
  work.add(inside_kind);
  // 2. If it surely passes all three on the inside, it hits. Anything else is decided in double, then exactly.
  const auto inside0 = e0 > edges.error[0], inside1 = e1 > edges.error[1], inside2 = e2 > edges.error[2];
  const std::uint32_t inside = (inside0 & inside1 & inside2).bits() & open & edges.known;
  open &= ~inside;
  if (open == 0) [[likely]]
    return inside;
  if (packet.trusts_floats) {
    return inside | (((e0 >= Float(0.0f)) & (e1 >= Float(0.0f)) & (e2 >= Float(0.0f))).bits() & open);
  }
  const std::uint32_t sure_inside[3] = {inside0.bits() & edges.known, inside1.bits() & edges.known,
                                        inside2.bits() & edges.known};
  const std::uint32_t settled = settle_open_lanes<L>(packet, base, open, sure_inside, triangle, orientation, work);
  work.charge_to(inside_kind);
  return inside | settled;
}

}  // namespace gridiron
