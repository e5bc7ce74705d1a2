// Rays of a list: what is prepared for each, and how those that meet a box are taken out of a list.
// Source: own; core/TREE.md. Memory: the caller's. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/engine/tree/leaf_test.h>
#include <gridiron/engine/tree/list_memory.h>
#include <gridiron/ray/ray_batch.h>

#include <bit>
#include <cstddef>
#include <cstdint>

namespace gridiron {

/// A word of a list: the boxes of the node that its ray misses, bit i = child i, or quad i; above them the ray's place,
/// in quads of words from the first ray, and its octant.
inline constexpr std::uint32_t kPlaceShift = 16, kOctantShift = 29;
inline constexpr std::uint32_t kMaskBits = (1u << kPlaceShift) - 1;
inline constexpr std::uint32_t kRayQuads = sizeof(BatchRay) / 16;

[[nodiscard]] GRIDIRON_INLINE std::uint32_t list_word(std::uint32_t ray, std::uint32_t octant) {
  return octant << kOctantShift | (kRayQuads * ray) << kPlaceShift;
}
/// Behind all words of rays.
inline constexpr std::uint32_t kListEnd = ~0u;
/// @returns a number above the words of a word's octant, and not above those of the next, or of the list's end.
[[nodiscard]] GRIDIRON_INLINE std::uint32_t behind_octant(std::uint32_t word) {
  return word | ((1u << kOctantShift) - 1);
}
/// @returns the octant: bit 0, 1, 2 where the ray runs towards smaller x, y, z.
[[nodiscard]] GRIDIRON_INLINE std::uint32_t octant_of(std::uint32_t word) {
  return word >> kOctantShift;
}
[[nodiscard]] GRIDIRON_INLINE BatchRay& ray_of(BatchRay* rays, std::uint32_t word) {
  constexpr std::uint32_t kPlaces = ((1u << kOctantShift) - 1) & ~kMaskBits;
  return *reinterpret_cast<BatchRay*>(reinterpret_cast<std::byte*>(rays) + ((word & kPlaces) >> (kPlaceShift - 4)));
}

/// Rays with directions of such sizes, and origins at most so far away, in the scene's largest |coordinate|, are tested
/// as they are: no product overflows, and what kLeastListComponent changes is less than the growth of boxes. Products
/// that count are not subnormal, where denormals are flushed neither: leaf_test.h.
inline constexpr float kLeastListDirection = 0x1p-16f, kGreatestListDirection = 0x1p40f, kFarOrigin = 0x1p40f;
/// Of the largest component: smaller ones are taken for this much.
inline constexpr float kLeastListComponent = 0x1p-80f;

/// Brings a ray's direction to a size of kLeastListDirection, or 1 from above, by a power of two, and t with it. A hit
/// must not come below the least normal t, so small directions do not grow more than they have to.
/// @returns whether that lost no bit.
GRIDIRON_RARE inline bool scale_list_ray(BatchRay& ray) {
  std::uint32_t exponent = std::bit_cast<std::uint32_t>(ray.dir_max) >> 23;
  if (exponent == 0) exponent = 1;
  if (exponent > 252) return false;
  const std::uint32_t wanted = exponent < 127 ? std::uint32_t{127 - 16} : std::uint32_t{127};
  static_assert(kLeastListDirection == 0x1p-16f);
  const float up = std::bit_cast<float>((127 + wanted - exponent) << 23),
              down = std::bit_cast<float>((127 + exponent - wanted) << 23);
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

/// What set_up_list_ray() does with other rays than most.
template <class L>
GRIDIRON_RARE inline std::uint32_t set_up_odd_ray(BatchRay& ray, std::uint32_t octant, bool is_near, bool is_large) {
  bool is_scaled = ray.dir_max >= kLeastListDirection && ray.dir_max <= kGreatestListDirection;
  if (!is_scaled && scale_list_ray(ray)) {
    is_scaled = true;
    octant = set_up_reciprocals<L>(ray);
  }
  if (!is_near || !is_scaled) {
    for (float& component : ray.inverse) component = 0.0f;
  }
  if (is_large || !is_scaled) ray.dir_max = kInfinity;
  return octant;
}

/// Prepares a ray for lists. One that boxes cannot be tested against meets all of them, one that triangles cannot be
/// tested against by floats has no bound of its direction.
/// @param largest  |coordinate| of the scene. @returns its octant.
template <class L>
GRIDIRON_INLINE std::uint32_t set_up_list_ray(BatchRay& ray, float largest) {
  const std::uint32_t octant = set_up_reciprocals<L>(ray);
  const auto is_within = [&ray](float limit) GRIDIRON_INLINE_LAMBDA {
    return magnitude(ray.origin[0]) <= limit && magnitude(ray.origin[1]) <= limit && magnitude(ray.origin[2]) <= limit;
  };
  const float far = largest * kFarOrigin;
  const bool is_large = !(largest <= kGreatestListPlace);
  if (is_within(far < kGreatestListPlace ? far : kGreatestListPlace) && !is_large &&
      ray.dir_max >= kLeastListDirection && ray.dir_max <= kGreatestListDirection) [[likely]] {
    return octant;
  }
  return set_up_odd_ray<L>(ray, octant, is_within(far), is_large || !is_within(kGreatestListPlace));
}

/// The largest |x|, |y|, |z| of the origins of rays, where leaves ask for them.
template <class L>
class FarthestOrigin {
 public:
  GRIDIRON_INLINE void add(const BatchRay& ray) {
    if constexpr (kBoundsBatch<L>) {
      // In this order a NaN changes nothing.
      sizes_ = Quad::max(Quad::abs(Quad::Float::load(ray.origin)), sizes_);
    }
  }
  /// @returns their sum; 0 where it is not asked for.
  [[nodiscard]] GRIDIRON_INLINE float sum() const {
    return Quad::lane(sizes_, 0) + Quad::lane(sizes_, 1) + Quad::lane(sizes_, 2);
  }

 private:
  using Quad = Lanes<4>;
  typename Quad::Float sizes_{0.0f};  // the fourth of t
};

/// Copies the words of rays that meet a child, without their masks.
/// @param list    at a multiple of kListStep<L> words, as mark_list() left it.
/// @param count   of words: all, or a multiple of L::kCount.
/// @param place   of the child in their masks. @param target  room for as many, and L::kCount more.
/// @returns how many.
template <class L>
GRIDIRON_INLINE std::uint32_t take_marked(const std::uint32_t* list, std::uint32_t count, std::uint32_t place,
                                          std::uint32_t* target) {
  std::uint32_t taken = 0;
  if constexpr (L::kCount == 1) {
    for (std::uint32_t i = 0; i < count; ++i) {
      target[taken] = list[i] & ~kMaskBits;
      taken += 1 - (list[i] >> place & 1u);
    }
  } else {
    using Int = typename L::Int;
    const Int bit = Int::splat(1u << place), rays = Int::splat(~kMaskBits);
    for (std::uint32_t i = 0; i < count; i += L::kCount) {
      const Int words = Int::load(list + i);
      const std::uint32_t marked = ((words & bit) < bit).bits();
      L::compress(words & rays, marked, target + taken);
      taken += count_bits(marked);
    }
  }
  return taken;
}

}  // namespace gridiron
