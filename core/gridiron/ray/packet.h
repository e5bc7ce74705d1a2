// Packet: eye rays of a square of pixels, traced together. All of them start at the eye.
// Memory: inside the local store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/z_curve.h>

#include <cstdint>

namespace gridiron {

/// A set of a packet's rays, one bit each.
template <std::uint32_t RayCount>
struct RaySet {
  static constexpr std::uint32_t kWordCount = (RayCount + 31) / 32;
  std::uint32_t words[kWordCount];

  GRIDIRON_INLINE void clear() {
    for (std::uint32_t i = 0; i < kWordCount; ++i) words[i] = 0;
  }
  GRIDIRON_INLINE void fill() {
    static_assert(RayCount % 32 == 0 || RayCount < 32);
    for (std::uint32_t i = 0; i < kWordCount; ++i) words[i] = ~0u >> ((32 - RayCount % 32) % 32);
  }
  GRIDIRON_INLINE void insert(std::uint32_t ray) { words[ray / 32] |= 1u << (ray % 32); }
  GRIDIRON_INLINE void erase(std::uint32_t ray) { words[ray / 32] &= ~(1u << (ray % 32)); }
  [[nodiscard]] GRIDIRON_INLINE bool contains(std::uint32_t ray) const { return (words[ray / 32] >> (ray % 32)) & 1u; }
  /// Bits of the group of L::kCount rays that begins at ray `base`, a multiple of L::kCount.
  template <class L>
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t group(std::uint32_t base) const {
    return (words[base / 32] >> (base % 32)) & L::kAllBits;
  }
  /// Bits of subpacket i.
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t subpacket(std::uint32_t i) const {
    return (words[i / 2] >> (16 * (i % 2))) & 0xFFFFu;
  }
  template <class L>
  GRIDIRON_INLINE void set_group(std::uint32_t base, std::uint32_t bits) {
    words[base / 32] = (words[base / 32] & ~(L::kAllBits << (base % 32))) | (bits << (base % 32));
  }
};

/// A subpacket is a square of a packet's pixels, the smallest part that is culled as a whole. Its rays are contiguous,
/// row by row. Subpackets follow a Z curve, so that every four of them are a square too.
inline constexpr std::uint32_t kSubpacketWidth = 4;
inline constexpr std::uint32_t kSubpacketRays = kSubpacketWidth * kSubpacketWidth;
inline constexpr std::uint32_t kAllSubpacketRays = (1u << kSubpacketRays) - 1u;

/// Subpackets of a packet, bit i = subpacket i.
using SubpacketSet = std::uint64_t;

/// @returns the four subpackets of each square: bit i becomes bits 4 i to 4 i + 3. @param squares  16 bits.
[[nodiscard]] GRIDIRON_INLINE constexpr SubpacketSet subpackets_of_squares(std::uint64_t squares) {
  squares = (squares | squares << 24) & 0x000000FF000000FFu;
  squares = (squares | squares << 12) & 0x000F000F000F000Fu;
  squares = (squares | squares << 6) & 0x0303030303030303u;
  squares = (squares | squares << 3) & 0x1111111111111111u;
  return squares * 0xFu;
}

/// Calls visit(i) for every subpacket i of a set, in order. A short loop tests each bit, so that it can be unrolled.
template <std::uint32_t SubpacketCount, class Visit>
GRIDIRON_INLINE void for_each_subpacket(SubpacketSet set, Visit&& visit) {
  if constexpr (SubpacketCount <= 4) {
    for (std::uint32_t i = 0; i < SubpacketCount; ++i) {
      if ((set >> i & 1u) != 0) visit(i);
    }
  } else {
    for (; set != 0; set &= set - 1) visit(lowest_bit(set));
  }
}

/// Error of a direction as a linear function of the pixel, in units of the largest sum of magnitudes that goes into a
/// component: less than 6 e between the two, 4 e for the function's own sums and products, twice at most.
inline constexpr float kLinearError = 16.0f * 0x1p-23f;

/// Relative error of an estimated distance.
inline constexpr float kEstimateError = 0x1p-14f;
/// Factor on a distance: one beyond the product is surely nearer, or behind, even if both are estimates.
inline constexpr float kSurelyNearer = 1.0f - 3.0f * kEstimateError;
inline constexpr float kSurelyBehind = 1.0f + 3.0f * kEstimateError;

/// Maps points, less the origin, to pixels of a packet: pixel_box.h.
struct PixelProjection {
  float rows[3][3];      ///< depth, column times depth, row times depth, all three times one factor
  float margin;          ///< by how many pixels a place may be off
  float most_per_depth;  ///< the margin holds up to this ratio of a point's largest component to its depth
};

// The parts of a packet, in the order in which they lie in memory. SoA: ray i is element i of each array.

/// Directions in world space, not normalised.
template <std::uint32_t RayCount>
struct PacketDirections {
  alignas(64) float dir[3][RayCount];
};

template <std::uint32_t RayCount>
struct PacketHits {
  alignas(64) float t[RayCount];           ///< nearest hit so far, see `estimates`; t_far before the first
  alignas(64) std::uint32_t id[RayCount];  ///< its triangle, kNoTriangle before the first
  alignas(64) float facing[RayCount];      ///< |normal . dir| of the nearest hit, normal of length 1
};

template <std::uint32_t RayCount>
struct alignas(16) PacketSets {
  RaySet<RayCount> active;  ///< the rays of this pass
  RaySet<RayCount> unsure;  ///< rays whose nearest hit the estimates left open
};

/// Where the rays start, and what bounds their directions.
struct PacketBounds {
  float corner_dir[3][4];  ///< the four corner rays, for culling
  float origin[3];
  float dir_max;          ///< largest |component| of all active directions
  float range_factor;     ///< the larger of dir_max and 1
  float corner_widening;  ///< factor on edge errors with which the corner rays bound all others
};

/// Whether t is an estimate within kEstimateError, or the distance rounded to the nearest float.
struct DistancePolicy {
  std::uint32_t estimates;  ///< all bits, or none
  float surely_nearer;      ///< times t: a distance below is nearer, whatever the error of t
  float surely_behind;      ///< times t: a distance above is behind
  bool trusts_floats;       ///< nothing is settled beyond single precision
  bool breaks_ties;         ///< of equal rounded distances the exact ones decide, not the triangles' ids

  GRIDIRON_INLINE void choose(bool exact) {
    estimates = exact ? 0u : ~0u;
    surely_nearer = exact ? 1.0f : kSurelyNearer;
    surely_behind = exact ? 1.0f : kSurelyBehind;
  }
};

/// Recently hit triangles, each in the slot that its id gives. If two estimates are too close to decide, the earlier
/// triangle can be measured again.
template <std::uint32_t RecentCountV>
struct RecentTriangles {
  static constexpr std::uint32_t kRecentCount = RecentCountV;
  alignas(16) VertexTriangle recent[kRecentCount];
  VertexTriangle taken;  ///< the nearer one of the last exact comparison: with one active ray, its nearest hit

  GRIDIRON_INLINE void forget() {
    for (VertexTriangle& triangle : recent) triangle.triangle_id = kNoTriangle;
    taken.triangle_id = kNoTriangle;
  }
  GRIDIRON_INLINE void keep(const VertexTriangle& triangle) { recent[triangle.triangle_id % kRecentCount] = triangle; }
  /// @returns the triangle if it is among the recent ones, else null.
  [[nodiscard]] GRIDIRON_INLINE const VertexTriangle* find(std::uint32_t triangle_id) const {
    const VertexTriangle& triangle = taken.triangle_id == triangle_id ? taken : recent[triangle_id % kRecentCount];
    return triangle.triangle_id == triangle_id && triangle_id != kNoTriangle ? &triangle : nullptr;
  }
};

/// The rays as a linear function of column and row, where is_linear: first_dir + column * step_x + row * step_y.
struct LinearRays {
  float first_dir[3];
  float step_x[3];
  float step_y[3];
  bool is_linear;
  float linear_error;          ///< by how much a component of a direction may differ from it, as evaluated in floats
  float subpacket_widening;    ///< factor on edge errors that covers this form and its evaluation
  PixelProjection projection;  ///< where triangles appear, for packets that are large compared with them
};

/// Slopes of a grid's pass, in cells along u and v per cell along the march: least and greatest of the active rays of
/// each square of 2x2 subpackets. Without active rays the least is above the greatest.
template <std::uint32_t SquareCount>
struct PassSlopes {
  alignas(64) float slope_low[2][SquareCount];
  alignas(64) float slope_high[2][SquareCount];
  alignas(16) float march_high[SquareCount];  ///< the most cells along the march per unit of t; 0 without active rays
};

/// Width x Width rays. Functions that need one part of them take that part.
/// @tparam RecentCount  number of recently hit triangles that are kept, a power of two.
template <std::uint32_t Width, std::uint32_t RecentCount = 16>
struct alignas(128) Packet : PacketDirections<Width * Width>,
                             PacketHits<Width * Width>,
                             PacketSets<Width * Width>,
                             PacketBounds,
                             DistancePolicy,
                             RecentTriangles<RecentCount>,
                             LinearRays,
                             PassSlopes<(Width * Width + 4 * kSubpacketRays - 1) / (4 * kSubpacketRays)> {
  static constexpr std::uint32_t kWidth = Width;
  static constexpr std::uint32_t kRayCount = Width * Width;
  static constexpr std::uint32_t kSubpacketCount = kRayCount / kSubpacketRays;
  static constexpr std::uint32_t kSquareCount = (kSubpacketCount + 3) / 4;
  static constexpr SubpacketSet kAllSubpackets = ~SubpacketSet{0} >> (64 - kSubpacketCount);
  static constexpr bool kHasBoxes = kSubpacketCount >= 16;  ///< `projection` is in use
  static_assert(Width == 4 || Width == 8 || Width == 16 || Width == 32);

  /// Column and row of a ray's pixel in the packet.
  [[nodiscard]] static GRIDIRON_INLINE constexpr std::uint32_t column_of(std::uint32_t ray) {
    return z_curve_column(ray / kSubpacketRays) * kSubpacketWidth + ray % kSubpacketWidth;
  }
  [[nodiscard]] static GRIDIRON_INLINE constexpr std::uint32_t row_of(std::uint32_t ray) {
    return z_curve_row(ray / kSubpacketRays) * kSubpacketWidth + ray % kSubpacketRays / kSubpacketWidth;
  }

  /// Chooses between correctly rounded distances and estimates. Called before any ray is traced.
  GRIDIRON_INLINE void ask_for_distances(bool exact) {
    this->choose(exact);
    this->forget();
  }
};

/// Prepares the rays that estimates left unsure for another pass with exact distances. Their hits are discarded, except
/// as a bound: their nearest hit lies in front of it. Work::kRaySetWord is charged.
///
/// @param unsure  out: these rays. @returns whether there are any.
template <class PacketType>
[[nodiscard]] GRIDIRON_OUTLINE bool take_unsure_rays(PacketType& packet, float t_far,
                                                     RaySet<PacketType::kRayCount>& unsure, WorkCounters& work) {
  work.add(Work::kRaySetWord, unsure.kWordCount);
  std::uint32_t any = 0;
  for (std::uint32_t i = 0; i < unsure.kWordCount; ++i) any |= packet.unsure.words[i];
  if (any == 0) [[likely]]
    return false;
  work.add(Work::kRaySetWord, unsure.kWordCount);
  unsure = packet.unsure;
  packet.unsure.clear();
  for (std::uint32_t i = 0; i < unsure.kWordCount; ++i) {
    for (std::uint32_t rest = unsure.words[i]; rest != 0; rest &= rest - 1) {
      const std::uint32_t ray = 32 * i + lowest_bit(rest);
      const float bound = packet.t[ray] * (kSurelyBehind * kSurelyBehind);
      packet.t[ray] = bound < t_far ? bound : t_far;
      packet.id[ray] = kNoTriangle;
    }
  }
  work.add(Work::kRecentSlot, PacketType::kRecentCount);
  packet.ask_for_distances(true);
  return true;
}

}  // namespace gridiron
