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

/// Width x Width rays, SoA, row-major. World space, directions not normalised.
template <std::uint32_t Width>
struct alignas(128) Packet {
  static constexpr std::uint32_t kWidth = Width;
  static constexpr std::uint32_t kRayCount = Width * Width;

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
};

}  // namespace gridiron
