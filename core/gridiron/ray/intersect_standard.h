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
template <class L>
struct EdgeBatch {
  static constexpr std::uint32_t kTriangles = L::kCount / 4;
  alignas(64) float n[3][L::kCount];     ///< signed so that inside means n . d >= 0 on all three edges
  alignas(64) float error[L::kCount];    ///< |n . d| above this has the right sign, for every active ray
  std::uint32_t in_range;                ///< lanes for which the float test says something
  std::uint32_t missed;                  ///< lanes whose edge all four corner rays surely pass on the outside
  std::int32_t orientation[kTriangles];  ///< +1, -1; 0: the origin lies in the triangle's plane, nothing can be hit

  // For culling subpackets: n . d as a linear function of the pixel, and the value below which an edge is surely
  // passed on the outside.
  alignas(64) float per_column[L::kCount];
  alignas(64) float per_row[L::kCount];
  alignas(64) float surely_outside[L::kCount];
  // Its largest value over a quarter, a square and a row whose first pixel is that of the packet, and what leads from
  // there to the largest and to the least value of a subpacket.
  alignas(64) float first_quarter[L::kCount];
  alignas(64) float first_square[L::kCount];
  alignas(64) float first_row[L::kCount];
  alignas(64) float square_to_subpacket[L::kCount];
  alignas(64) float subpacket_span[L::kCount];
};

/// What a test may leave out by looking at several rays at once.
struct Culling {
  bool corner_rays;  ///< the packet's corner rays bound it
  bool subpackets;   ///< its rays are a linear function of the pixel
};

inline constexpr float kEdgeErrorFactor = 17.0f * 0x1p-23f;
inline constexpr float kUnderflow = 0x1p-100f;
inline constexpr float kEdgeRangeLimit = 0x1p100f;
inline constexpr float kVolumeErrorLimit = 0x1p90f;

/// A bound of the rounding of pixel directions themselves, added where the corner rays speak for all others.
inline constexpr float kCornerErrorFactor = 5.0f * 0x1p-23f;

/// The same for n . d evaluated as first + column * per_column + row * per_row. With D the largest sum of magnitudes
/// that goes into a direction's component and scale = |F|max |S|1 >= |n|1 / 2: the rounding of n itself is within
/// 16 e scale D; the direction differs from the linear form by less than 6 e D, 12 e scale D in all; and at most 16
/// roundings of sums of at most 2 scale D each, 32 e scale D, happen on the way. 60 e covers all, 68 e is charged.
inline constexpr float kSubpacketErrorFactor = 68.0f * 0x1p-23f;

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
};
inline constexpr double kDistanceError = 0x1p-48;

void set_up_distance(const float origin[3], float dir_max, const VertexTriangle& triangle, DistanceSetup& setup);

/// The same in single precision: a ray's distance but for a relative error of kEstimateError, where that can be had.
///
/// Errors as in DistanceSetup with e = 2^-23 in the place of u: 8 e and 7 e; 8.5 e is charged. Where neither numerator
/// nor denominator is uncertain by more than 4/9 of kEstimateError, their quotient is within 9/10 of it, and within all
/// of it once rounded. Values below the least normal float may be lost; in the range that is asked for, that is less
/// than what was charged too much: at most 2^-126 times 2^40 is lost of sums above 2^-60. The quotient of a ray that
/// passes the test lies above the least normal float; an infinite one is neither surely nearer nor surely behind.
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

/// The unit normal of a triangle for shading, in single precision where the triangle's shape allows it to 2^-15, else
/// from double: the same bits whoever asks.
void set_up_normal(const VertexTriangle& triangle, float normal[3]);

/// Prepares the edge functions of a batch of triangles for a packet, and holds them against its corner rays: where all
/// four pass on the outside of one and the same edge, so does every ray between them (Dmitriev, Havran, Seidel 2004).
///
/// @param triangles  EdgeBatch<L>::kTriangles of them; a shorter batch repeats one.
template <class L, class PacketType>
GRIDIRON_INLINE void set_up_edges(const PacketType& packet, const VertexTriangle* const* triangles, Culling culling,
                                  EdgeBatch<L>& batch, WorkCounters& work) {
  using Float = typename L::Float;
  constexpr std::uint32_t kTriangles = EdgeBatch<L>::kTriangles;
  // A record's first 36 bytes are x0 y0 z0 x1 | y1 z1 x2 y2 | z2: turn them into one vector per axis.
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

  // Orientation: with c the vertex opposite an edge, n . c = 2 det[a, b, c], by the same bound with c in the place of
  // d. The three edges give the same determinant; the quad's first lane speaks for it.
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
    if (((sure >> first_lane) & 1u) != 0) [[likely]]
      continue;
    batch.orientation[i] = volume_sign_in_double(packet.origin, *triangles[i], work);
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
    const auto along = [&](const float* direction) {
      return inward_x * Float(direction[0]) + inward_y * Float(direction[1]) + inward_z * Float(direction[2]);
    };
    constexpr float kSubpacketSpan = kSubpacketWidth - 1.0f;
    constexpr float kSquareSpan = 2.0f * kSubpacketWidth - 1.0f;
    constexpr float kQuarterSpan = 4.0f * kSubpacketWidth - 1.0f;
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
[[nodiscard]] std::uint32_t settle_open_lanes(const PacketType& packet, std::uint32_t base, std::uint32_t open_bits,
                                              const std::uint32_t sure_inside[3], const VertexTriangle& triangle,
                                              int orientation, WorkCounters& work) {
  std::uint32_t inside = 0;
  for (std::uint32_t rest = open_bits; rest != 0; rest &= rest - 1) {
    const std::uint32_t lane = lowest_bit(rest);
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
  using Double = typename L::Double;
  using Long = typename L::Long;
  constexpr std::uint32_t kHalf = L::kCount / 2;
  std::uint32_t unsure = 0;
  for (std::uint32_t half = 0; half < 2; ++half) {
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
    constexpr std::int64_t kHalfStep = std::int64_t{1} << 28;
    const Long low = ((quotient - quotient * relative).pattern() + kHalfStep) >> 29;
    const Long high = ((quotient + quotient * relative).pattern() + kHalfStep) >> 29;
    constexpr std::int64_t kRebias = std::int64_t{1023 - 127} << 23;
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

/// Origins of squares of 2x2 subpackets in a packet, in pixels, along the Z curve.
struct SquareOrigins {
  alignas(64) float column[16];
  alignas(64) float row[16];
};
inline constexpr SquareOrigins kSquareOrigins = [] {
  SquareOrigins origins{};
  for (std::uint32_t i = 0; i < 16; ++i) {
    origins.column[i] = static_cast<float>(2 * kSubpacketWidth * subpacket_column(i));
    origins.row[i] = static_cast<float>(2 * kSubpacketWidth * subpacket_row(i));
  }
  return origins;
}();

/// Where the four lanes of a test stand, in pixels: quarters in a packet of 8x8 subpackets, subpackets in a square,
/// rows in a subpacket.
struct LanePlaces {
  alignas(16) float quarter_column[4];
  alignas(16) float quarter_row[4];
  alignas(16) float subpacket_column[4];
  alignas(16) float subpacket_row[4];
  alignas(16) float row[4];
};
inline constexpr LanePlaces kLanePlaces = {{0, 16, 0, 16}, {0, 0, 16, 16}, {0, 4, 0, 4}, {0, 0, 4, 4}, {0, 1, 2, 3}};

/// @returns the places that an edge of triangle `index` surely passes on the outside, a bit each.
///
/// @param largest  of EdgeBatch: the edge function's largest value over the place at column 0, row 0.
template <class L, class Wide>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t places_outside(const EdgeBatch<L>& batch, std::uint32_t index,
                                                           const float* largest, typename Wide::Float column,
                                                           typename Wide::Float row) {
  using Float = typename Wide::Float;
  std::uint32_t outside = 0;
  for (std::uint32_t edge = 0; edge < 3; ++edge) {
    const std::uint32_t lane = 4 * index + edge;
    const Float value =
        Float(largest[lane]) + (column * Float(batch.per_column[lane]) + row * Float(batch.per_row[lane]));
    outside |= (value < Float(batch.surely_outside[lane])).bits();
  }
  return outside;
}

/// @returns those squares of 2x2 subpackets that triangle `index` of a batch may touch.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t squares_near(const EdgeBatch<L>& batch, std::uint32_t index,
                                                         WorkCounters& work) {
  using Float = typename L::Float;
  using Four = Lanes<4>;
  constexpr std::uint32_t kSquares = PacketType::kSquareCount;
  // A group of four lanes is a quarter of the packet.
  constexpr bool kByQuarters = kSquares == 16 && L::kCount == 4;
  std::uint32_t far_quarters = 0;
  if constexpr (kByQuarters) {
    work.add(Work::kSubpacketGroup);
    far_quarters = places_outside<L, Four>(batch, index, batch.first_quarter,
                                           Four::Float::load(kLanePlaces.quarter_column),
                                           Four::Float::load(kLanePlaces.quarter_row));
  }
  std::uint32_t squares = 0;
  for (std::uint32_t base = 0; base < kSquares; base += L::kCount) {
    if (kByQuarters && (far_quarters >> base / 4 & 1u) != 0) continue;
    work.add(Work::kSubpacketGroup);
    const std::uint32_t outside =
        places_outside<L, L>(batch, index, batch.first_square, Float::load(kSquareOrigins.column + base),
                             Float::load(kSquareOrigins.row + base));
    squares |= (~outside & L::kAllBits) << base;
  }
  return squares & ((1u << kSquares) - 1u);
}

/// Subpackets beside a triangle.
struct NearSubpackets {
  SubpacketSet touching;  ///< may be touched
  SubpacketSet covered;   ///< of these, all rays surely pass inside all three edges
  bool is_linear;         ///< the edge functions' linear form holds
};

/// @returns those of the `wanted` subpackets that triangle `index` of a batch may touch. One is left out where an edge
/// surely passes all its rays on the outside: the edge function is linear, so its largest value is at a corner, and its
/// least value, which shows that all are inside, at the opposite one.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_INLINE NearSubpackets subpackets_near(const EdgeBatch<L>& batch, std::uint32_t index,
                                                             SubpacketSet wanted, WorkCounters& work) {
  using Four = Lanes<4>;
  using Float = Four::Float;
  if constexpr (PacketType::kSubpacketCount < 4) return {wanted, 0, false};
  const std::uint32_t first_lane = 4 * index;
  if (((batch.in_range >> first_lane) & 0xFu) != 0xFu) return {wanted, 0, false};
  std::uint32_t squares = 1;
  if constexpr (PacketType::kSquareCount > 1) squares = squares_near<L, PacketType>(batch, index, work);

  work.charge_to(Work::kSubpacketSetup);
  Float offset[3];  // from a square's largest value to its subpackets'
  Float span[3];
  Float limit[3];
  for (std::uint32_t edge = 0; edge < 3; ++edge) {
    const std::uint32_t lane = first_lane + edge;
    offset[edge] = Float(batch.first_square[lane] + batch.square_to_subpacket[lane]) +
                   (Float::load(kLanePlaces.subpacket_column) * Float(batch.per_column[lane]) +
                    Float::load(kLanePlaces.subpacket_row) * Float(batch.per_row[lane]));
    span[edge] = Float(batch.subpacket_span[lane]);
    limit[edge] = Float(batch.surely_outside[lane]);
  }
  SubpacketSet near = 0;
  SubpacketSet covered = 0;
  for (; squares != 0; squares &= squares - 1) {
    const std::uint32_t square = lowest_bit(squares);
    const SubpacketSet four = SubpacketSet{0xF} << (4 * square);
    if ((wanted & four) == 0) continue;
    work.add(Work::kSubpacketGroup);
    std::uint32_t outside = 0;
    std::uint32_t inside = 0xF;
    for (std::uint32_t edge = 0; edge < 3; ++edge) {
      const std::uint32_t lane = first_lane + edge;
      const Float value = offset[edge] + Float(kSquareOrigins.column[square] * batch.per_column[lane] +
                                               kSquareOrigins.row[square] * batch.per_row[lane]);
      outside |= (value < limit[edge]).bits();
      inside &= (value - span[edge] > -limit[edge]).bits();
    }
    near |= SubpacketSet{~outside & 0xFu} << (4 * square);
    covered |= SubpacketSet{inside} << (4 * square);
  }
  return {near & wanted, covered & wanted, true};
}

/// Origins of subpackets in a packet, in pixels, along the Z curve.
struct SubpacketOrigins {
  float column[64];
  float row[64];
};
inline constexpr SubpacketOrigins kSubpacketOrigins = [] {
  SubpacketOrigins origins{};
  for (std::uint32_t i = 0; i < 64; ++i) {
    origins.column[i] = static_cast<float>(kSubpacketWidth * subpacket_column(i));
    origins.row[i] = static_cast<float>(kSubpacketWidth * subpacket_row(i));
  }
  return origins;
}();

/// @returns those of a subpacket's four rows, bit i = row i, that triangle `index` of a batch may touch.
template <class L>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t rows_near(const EdgeBatch<L>& batch, std::uint32_t index,
                                                      std::uint32_t subpacket, WorkCounters& work) {
  using Float = Lanes<4>::Float;
  work.add(Work::kRowGroup);
  const Float column(kSubpacketOrigins.column[subpacket]);
  const Float row = Float(kSubpacketOrigins.row[subpacket]) + Float::load(kLanePlaces.row);
  return ~places_outside<L, Lanes<4>>(batch, index, batch.first_row, column, row) & 0xFu;
}

/// One triangle's edge functions, each in all lanes.
template <class L>
struct SplatEdges {
  using Float = typename L::Float;
  Float n[3][3];  ///< edge, axis
  Float error[3];
  std::uint32_t known;  ///< all lanes, or none: whether the float test says something

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
                                                         const VertexTriangle& triangle, int orientation,
                                                         WorkCounters& work) {
  using Float = typename L::Float;
  work.add(Work::kGroupTestStandard);
  const Float d_x = Float::load(packet.dir[0] + base);
  const Float d_y = Float::load(packet.dir[1] + base);
  const Float d_z = Float::load(packet.dir[2] + base);
  const auto along = [&](int edge) GRIDIRON_INLINE_LAMBDA {
    return edges.n[edge][0] * d_x + edges.n[edge][1] * d_y + edges.n[edge][2] * d_z;
  };
  const Float e0 = along(0), e1 = along(1), e2 = along(2);
  // 1. One edge that is surely passed on the outside ends it.
  const std::uint32_t outside = ((e0 < -edges.error[0]) | (e1 < -edges.error[1]) | (e2 < -edges.error[2])).bits();
  std::uint32_t open = active & ~(outside & edges.known);
  if (open == 0) return 0;
  // 2. Three edges surely passed on the inside: a hit. Anything else is decided in double, then exactly.
  const std::uint32_t sure_inside[3] = {(e0 > edges.error[0]).bits() & edges.known,
                                        (e1 > edges.error[1]).bits() & edges.known,
                                        (e2 > edges.error[2]).bits() & edges.known};
  const std::uint32_t inside = open & sure_inside[0] & sure_inside[1] & sure_inside[2];
  open &= ~inside;
  if (open == 0) [[likely]]
    return inside;
  const std::uint32_t settled = settle_open_lanes<L>(packet, base, open, sure_inside, triangle, orientation, work);
  work.charge_to(Work::kGroupTestStandard);
  return inside | settled;
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
};

/// Decides hits that lie too close to those that the rays had: both distances exact, then the least (t, id).
///
/// @param close     lanes. @param distance  of the new hits, exact. @returns the lanes whose new hit is nearer; t of the
/// others becomes exact. Where a ray's old triangle is no longer at hand, the ray becomes unsure.
template <class L, class PacketType>
[[nodiscard]] std::uint32_t settle_close_hits(PacketType& packet, std::uint32_t base, std::uint32_t close,
                                              std::uint32_t triangle_id, const float* distance, WorkCounters& work) {
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
      if (distance[lane] < old_distance[lane] || (is_tie && triangle_id < old_id)) nearer |= 1u << lane;
    }
  }
  return nearer;
}

/// Decides, by exact distances, the hits of a group that their estimates leave open.
///
/// @param open  lanes. @param distance  out, in these lanes. @returns the lanes that are nearer than what they had hit.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t settle_hits(PacketType& packet, std::uint32_t base, std::uint32_t open,
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
    if (close == 0) [[likely]] return nearer;
    return nearer | settle_close_hits<L>(packet, base, close, triangle.triangle_id, distance, work);
  }
  for (; close != 0; close &= close - 1) {
    const std::uint32_t lane = lowest_bit(close);
    if (triangle.triangle_id < packet.id[base + lane]) nearer |= 1u << lane;
  }
  return nearer;
}

/// Merges a triangle's hits into a group of rays: the least (t, id) stays. @returns whether one of them is nearer.
///
/// An estimate of the distance decides nearly always; where it cannot, or where packet.estimates is 0 and t has to be
/// exact, the distance is computed in double.
template <class L, bool kWantFacing, class PacketType>
[[nodiscard]] GRIDIRON_INLINE bool merge_hits(PacketType& packet, std::uint32_t base, std::uint32_t hit,
                                              const VertexTriangle& triangle, HitSetups<L>& setups,
                                              WorkCounters& work) {
  using Float = typename L::Float;
  if (!setups.has_estimate) {
    work.add(Work::kEstimateSetup);
    const DistanceEstimate estimate = set_up_estimate(packet.origin, packet.dir_max, triangle);
    for (int axis = 0; axis < 3; ++axis) setups.normal[axis] = Float(estimate.normal[axis]);
    setups.numerator = Float(estimate.numerator);
    setups.least_denominator = Float(estimate.least_denominator);
    packet.keep(triangle);
    setups.has_estimate = true;
  }
  work.add(Work::kHitGroup);
  const Float d_x = Float::load(packet.dir[0] + base);
  const Float d_y = Float::load(packet.dir[1] + base);
  const Float d_z = Float::load(packet.dir[2] + base);
  const Float denominator = setups.normal[0] * d_x + setups.normal[1] * d_y + setups.normal[2] * d_z;
  Float old_t = Float::load(packet.t + base);
  Float t = setups.numerator / denominator;
  const auto is_close = denominator > setups.least_denominator;
  std::uint32_t nearer = (is_close & (t < old_t * Float(kSurelyNearer))).bits() & hit & packet.estimates;
  if (nearer != hit) [[unlikely]] {
    // A hit behind another or behind the origin, or of a triangle that comes again, changes nothing.
    const auto is_behind = (denominator < -setups.least_denominator) | (is_close & (t > old_t * Float(kSurelyBehind)));
    hit &= ~(is_behind | L::equal(triangle.triangle_id, packet.id + base)).bits();
    if (nearer != hit) {
      alignas(64) float distance[L::kCount];
      const auto estimated = L::mask_from_bits(nearer);
      nearer |= settle_hits<L>(packet, base, hit & ~nearer, triangle, setups, distance, work);
      work.charge_to(Work::kHitGroup);
      t = L::select(estimated, t, Float::load(distance));
      old_t = Float::load(packet.t + base);  // may have become exact
    }
    if (nearer == 0) return false;
  }
  const auto taken = L::mask_from_bits(nearer);
  L::select(taken, t, old_t).store(packet.t + base);
  L::store_where(taken, triangle.triangle_id, packet.id + base);
  if constexpr (kWantFacing) {
    if (!setups.has_unit_normal) {
      work.add(Work::kNormalSetup);
      float unit_normal[3];
      set_up_normal(triangle, unit_normal);
      for (int axis = 0; axis < 3; ++axis) setups.unit_normal[axis] = Float(unit_normal[axis]);
      setups.has_unit_normal = true;
      work.charge_to(Work::kHitGroup);
    }
    const Float facing =
        L::abs(setups.unit_normal[0] * d_x + setups.unit_normal[1] * d_y + setups.unit_normal[2] * d_z);
    L::select(taken, facing, Float::load(packet.facing + base)).store(packet.facing + base);
  }
  return true;
}

/// Intersects triangle `index` of a batch with the active rays of some subpackets, keeping the least (t, id).
///
/// @param packet  t, id (and facing where wanted) are updated. @returns the subpackets of which a ray's hit changed.
/// Errors: none (hot path). Cost: at most kSubpacketRays / L::kCount group tests per subpacket.
template <class L, bool kWantFacing, class PacketType>
[[nodiscard]] GRIDIRON_INLINE SubpacketSet test_groups(PacketType& packet, const VertexTriangle& triangle,
                                                       const EdgeBatch<L>& batch, std::uint32_t index,
                                                       const NearSubpackets& near, WorkCounters& work) {
  constexpr bool kGroupsAreRows = L::kCount == kSubpacketWidth;
  work.charge_to(Work::kTriangleSetup);
  const SplatEdges<L> edges(batch, index);
  HitSetups<L> setups;
  SubpacketSet changed = 0;
  for_each_subpacket<PacketType::kSubpacketCount>(near.touching, [&](std::uint32_t subpacket) GRIDIRON_INLINE_LAMBDA {
    const std::uint32_t first_ray = subpacket * kSubpacketRays;
    const bool is_covered = (near.covered >> subpacket & 1u) != 0;
    std::uint32_t rows = ~0u;
    if constexpr (kGroupsAreRows) {
      if (near.is_linear && !is_covered) rows = rows_near(batch, index, subpacket, work);
    }
    work.charge_to(Work::kGroupTestStandard);
    for (std::uint32_t group = 0; group < kSubpacketRays / L::kCount; ++group) {
      const std::uint32_t base = first_ray + group * L::kCount;
      const std::uint32_t active = packet.active.template group<L>(base);
      if (active == 0 || (kGroupsAreRows && (rows >> group & 1u) == 0)) continue;
      const std::uint32_t hit =
          is_covered ? active
                     : lanes_inside<L>(packet, base, active, edges, triangle, batch.orientation[index], work);
      if (hit == 0) continue;
      if (merge_hits<L, kWantFacing>(packet, base, hit, triangle, setups, work)) {
        changed |= SubpacketSet{1} << subpacket;
      }
    }
  });
  return changed;
}

/// Intersects 1..EdgeBatch<L>::kTriangles triangles with the active rays of a packet.
///
/// @param subpackets  per triangle, those to look at. @returns the subpackets of which a ray's hit changed.
template <class L, bool kWantFacing, class PacketType>
[[nodiscard]] GRIDIRON_INLINE SubpacketSet intersect_standard_batch(PacketType& packet,
                                                                    const VertexTriangle* const* triangles,
                                                                    const SubpacketSet* subpackets, std::uint32_t count,
                                                                    Culling culling, WorkCounters& work) {
  EdgeBatch<L> batch;
  const VertexTriangle* padded[EdgeBatch<L>::kTriangles];
  for (std::uint32_t i = 0; i < EdgeBatch<L>::kTriangles; ++i) padded[i] = triangles[i < count ? i : 0];
  work.add(Work::kTriangleSetup, count);
  if (culling.corner_rays) work.add(Work::kCullTest, count);
  work.charge_to(Work::kTriangleSetup);
  set_up_edges<L>(packet, padded, culling, batch, work);
  SubpacketSet changed = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (((batch.missed >> (4 * i)) & 0xFu) != 0 || batch.orientation[i] == 0) continue;
    NearSubpackets near{subpackets[i], 0, false};
    if (culling.subpackets) {
      work.add(Work::kSubpacketSetup);
      near = subpackets_near<L, PacketType>(batch, i, subpackets[i], work);
    }
    changed |= test_groups<L, kWantFacing>(packet, *triangles[i], batch, i, near, work);
  }
  return changed;
}

/// Intersects one triangle with every active ray of a packet.
template <class L, bool kWantFacing, class PacketType>
[[nodiscard]] GRIDIRON_INLINE bool intersect_standard(PacketType& packet, const VertexTriangle& triangle,
                                                      bool use_culling, WorkCounters& work) {
  const VertexTriangle* const triangles[] = {&triangle};
  const SubpacketSet subpackets[] = {PacketType::kAllSubpackets};
  const Culling culling{.corner_rays = use_culling, .subpackets = false};
  return intersect_standard_batch<L, kWantFacing>(packet, triangles, subpackets, 1, culling, work) != 0;
}

}  // namespace gridiron
