// Rays of a list: what is prepared for each, and how those that meet a box are taken out of a list.
// Source: own; core/TREE.md. Memory: the caller's. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/engine/tree/list_memory.h>
#include <gridiron/ray/ray_batch.h>

#include <bit>
#include <cstdint>

namespace gridiron {

/// An entry of a list: a ray's octant above its place, in quads of words from the first ray.
inline constexpr std::uint32_t kOctantShift = 13;
inline constexpr std::uint32_t kPlaceBits = (1u << kOctantShift) - 1;
inline constexpr std::uint32_t kRayQuads = sizeof(BatchRay) / 16;

/// @returns the octant: bit 0, 1, 2 where the ray runs towards smaller x, y, z.
[[nodiscard]] GRIDIRON_INLINE std::uint32_t octant_of(std::uint32_t entry) { return entry >> kOctantShift; }
[[nodiscard]] GRIDIRON_INLINE BatchRay& ray_of(BatchRay* rays, std::uint32_t entry) {
  return *reinterpret_cast<BatchRay*>(reinterpret_cast<std::byte*>(rays) + 16 * (entry & kPlaceBits));
}

/// Rays with directions of such sizes, and origins at most so far away, in the scene's largest |coordinate|, are tested
/// against boxes as they are: no product overflows, none that counts is subnormal, and what kLeastListComponent changes
/// is less than the growth of boxes.
inline constexpr float kLeastListDirection = 0x1p-40f, kGreatestListDirection = 0x1p40f, kFarOrigin = 0x1p40f;
/// Of the largest component: smaller ones are taken for this much.
inline constexpr float kLeastListComponent = 0x1p-80f;

/// Brings a ray's direction to a size of 1 by a power of two, and t with it. @returns whether that lost no bit.
GRIDIRON_RARE inline bool scale_list_ray(BatchRay& ray) {
  std::uint32_t exponent = std::bit_cast<std::uint32_t>(ray.dir_max) >> 23;
  if (exponent == 0) exponent = 1;
  if (exponent > 252) return false;
  const float up = std::bit_cast<float>((254 - exponent) << 23), down = std::bit_cast<float>(exponent << 23);
  bool is_exact = ray.dir_max > 0.0f;
  for (const float component : ray.dir) is_exact = is_exact && component * up * down == component;
  if (!is_exact) return false;
  for (float& component : ray.dir) component = component * up;
  ray.dir_max = ray.dir_max * up;
  ray.t = ray.t * down;
  return true;
}

/// Reciprocals of a ray's direction, and dir_max. @returns its octant.
template <class L>
GRIDIRON_INLINE std::uint32_t set_up_reciprocals(BatchRay& ray) {
  if constexpr (L::kCount == 1) {
    float most = 0.0f;
    for (const float component : ray.dir) most = magnitude(component) > most ? magnitude(component) : most;
    const float least = most * kLeastListComponent;
    std::uint32_t octant = 0;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const float component = ray.dir[axis];
      const bool is_backwards = component < 0.0f;
      if (is_backwards) octant |= 1u << axis;
      const float away = magnitude(component) < least ? (is_backwards ? -least : least) : component;
      ray.inverse[axis] = 1.0f / away;
    }
    ray.dir_max = most;
    return octant;
  } else {
    // The ray's words are quads: lanes are components.
    using Quad = Lanes<4>;
    using Float = typename Quad::Float;
    const Float dir = Quad::template shuffle_quads<0, 1, 2, 0>(Float::load(ray.dir));
    const Float size = Quad::abs(dir);
    const Float most = Quad::max(Quad::max(size, Quad::template shuffle_quads<1, 2, 0, 1>(size)),
                                 Quad::template shuffle_quads<2, 0, 1, 2>(size));
    const Float least = most * Float(kLeastListComponent);
    const auto is_backwards = dir < Float(0.0f);
    const Float away = Quad::select(size < least, Quad::flip_sign(is_backwards, least), dir);
    Quad::select(Quad::mask_from_bits(8), most, Float(1.0f) / away).store(ray.inverse);
    return is_backwards.bits() & 7u;
  }
}

/// Prepares a ray for lists. One that boxes cannot be tested against meets all of them.
/// @param largest  |coordinate| of the scene. @returns its octant.
template <class L>
GRIDIRON_INLINE std::uint32_t set_up_list_ray(BatchRay& ray, float largest) {
  const std::uint32_t octant = set_up_reciprocals<L>(ray);
  const float far = largest * kFarOrigin;
  const bool is_near =
      magnitude(ray.origin[0]) <= far && magnitude(ray.origin[1]) <= far && magnitude(ray.origin[2]) <= far;
  if (is_near && ray.dir_max >= kLeastListDirection && ray.dir_max <= kGreatestListDirection) [[likely]]
    return octant;
  if (is_near && scale_list_ray(ray)) return set_up_reciprocals<L>(ray);
  for (float& component : ray.inverse) component = 0.0f;
  return octant;
}

/// Copies the entries whose mask has bit `place`, in order. @param count  at most kListStep.
/// @param target  room for kListStep entries. @returns how many.
template <class L>
GRIDIRON_INLINE std::uint32_t take_marked(const std::uint16_t* list, const std::uint16_t* masks, std::uint32_t count,
                                          std::uint32_t place, std::uint16_t* target) {
#if defined(__AVX512VBMI2__)
  if constexpr (L::kCount == 16) {
    const __mmask32 there = count < 32 ? (__mmask32{1} << count) - 1 : ~__mmask32{0};
    const __mmask32 marked = _mm512_mask_test_epi16_mask(there, _mm512_loadu_si512(masks),
                                                         _mm512_set1_epi16(static_cast<short>(1u << place)));
    _mm512_storeu_si512(target, _mm512_maskz_compress_epi16(marked, _mm512_loadu_si512(list)));
    return static_cast<std::uint32_t>(__builtin_popcount(marked));
  }
#endif
  std::uint32_t taken = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    target[taken] = list[i];
    taken += std::uint32_t{masks[i]} >> place & 1u;
  }
  return taken;
}

}  // namespace gridiron
