// Packet: primary rays of a square of pixels, traced together. All of them start at the eye.
// Memory: inside the local store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/base/records.h>

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
    for (std::uint32_t i = 0; i < kWordCount; ++i) words[i] = RayCount < 32 ? (1u << (RayCount % 32)) - 1u : ~0u;
  }
  GRIDIRON_INLINE void insert(std::uint32_t ray) { words[ray / 32] |= 1u << (ray % 32); }
  GRIDIRON_INLINE void erase(std::uint32_t ray) { words[ray / 32] &= ~(1u << (ray % 32)); }
  [[nodiscard]] GRIDIRON_INLINE bool contains(std::uint32_t ray) const { return (words[ray / 32] >> (ray % 32)) & 1u; }
  /// Bits of the group of L::kCount rays that begins at ray `base`, a multiple of L::kCount.
  template <class L>
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t group(std::uint32_t base) const {
    return (words[base / 32] >> (base % 32)) & L::kAllBits;
  }
  template <class L>
  GRIDIRON_INLINE void set_group(std::uint32_t base, std::uint32_t bits) {
    words[base / 32] = (words[base / 32] & ~(L::kAllBits << (base % 32))) | (bits << (base % 32));
  }
};

/// A subpacket is a square of a packet's pixels, the finest piece that is culled as a whole. Its rays follow each
/// other, row by row; subpackets follow each other along a Z curve, so that every four of them are a square too.
inline constexpr std::uint32_t kSubpacketWidth = 4;
inline constexpr std::uint32_t kSubpacketRays = kSubpacketWidth * kSubpacketWidth;

/// Subpackets of a packet, bit i = subpacket i.
using SubpacketSet = std::uint64_t;

/// Column of subpacket i in its packet, in subpackets: the even bits of i. subpacket_row: the odd ones.
[[nodiscard]] GRIDIRON_INLINE constexpr std::uint32_t subpacket_column(std::uint32_t i) {
  return (i & 1u) | ((i >> 1) & 2u) | ((i >> 2) & 4u);
}
[[nodiscard]] GRIDIRON_INLINE constexpr std::uint32_t subpacket_row(std::uint32_t i) {
  return subpacket_column(i >> 1);
}

/// Calls visit(i) for every subpacket i of a set, in order. Of few, each is asked for: the loop can be unrolled.
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

/// Width x Width rays, SoA. World space, directions not normalised.
template <std::uint32_t Width>
struct alignas(128) Packet {
  static constexpr std::uint32_t kWidth = Width;
  static constexpr std::uint32_t kRayCount = Width * Width;
  static constexpr std::uint32_t kSubpacketCount = kRayCount / kSubpacketRays;
  static constexpr SubpacketSet kAllSubpackets = ~SubpacketSet{0} >> (64 - kSubpacketCount);
  static_assert(Width == 4 || Width == 8 || Width == 16 || Width == 32);

  /// Column and row of a ray's pixel in the packet.
  [[nodiscard]] static GRIDIRON_INLINE constexpr std::uint32_t column_of(std::uint32_t ray) {
    return subpacket_column(ray / kSubpacketRays) * kSubpacketWidth + ray % kSubpacketWidth;
  }
  [[nodiscard]] static GRIDIRON_INLINE constexpr std::uint32_t row_of(std::uint32_t ray) {
    return subpacket_row(ray / kSubpacketRays) * kSubpacketWidth + ray % kSubpacketRays / kSubpacketWidth;
  }

  alignas(64) float dir[3][kRayCount];      ///< direction
  alignas(64) float t[kRayCount];           ///< nearest hit so far; t_far before the first
  alignas(64) std::uint32_t id[kRayCount];  ///< its triangle, kNoTriangle before the first
  alignas(64) float facing[kRayCount];      ///< |normal . dir| of the nearest hit, normal of length 1
  RaySet<kRayCount> active;                 ///< the rays of this pass
  alignas(16) float corner_dir[3][4];       ///< the four corner rays, for culling
  float origin[3];
  float dir_max;          ///< largest |component| of all active directions
  float range_factor;     ///< the larger of dir_max and 1
  float corner_widening;  ///< factor on edge errors that lets the corner rays speak for all

  // The rays as a linear function of column and row: first_dir + column * step_x + row * step_y.
  float first_dir[3];
  float step_x[3];
  float step_y[3];
  float subpacket_widening;  ///< factor on edge errors that covers this form and its evaluation

  // Slopes of this pass, in cells along u and v per cell along the march: least and greatest of the active rays of each
  // square of 2x2 subpackets. Where none is active the least is above the greatest.
  static constexpr std::uint32_t kSquareCount = kSubpacketCount < 4 ? 1 : kSubpacketCount / 4;
  alignas(64) float slope_low[2][kSquareCount];
  alignas(64) float slope_high[2][kSquareCount];
};

}  // namespace gridiron
