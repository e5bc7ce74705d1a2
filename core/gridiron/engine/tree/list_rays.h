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

[[nodiscard]] constexpr GRIDIRON_INLINE std::uint32_t list_word(std::uint32_t ray, std::uint32_t octant) {
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
inline constexpr std::uint32_t kPlaceBits = ((1u << kOctantShift) - 1) & ~kMaskBits;
[[nodiscard]] GRIDIRON_INLINE BatchRay& ray_of(BatchRay* rays, std::uint32_t word) {
  return *reinterpret_cast<BatchRay*>(reinterpret_cast<std::byte*>(rays) + ((word & kPlaceBits) >> (kPlaceShift - 4)));
}

[[nodiscard]] GRIDIRON_INLINE const RayTerms& terms_of(const RayTerms* terms, std::uint32_t word) {
  return *reinterpret_cast<const RayTerms*>(reinterpret_cast<const std::byte*>(terms) +
                                            ((word & kPlaceBits) >> (kPlaceShift - 4)));
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

// Terms, in any rounding mode: with e = 2^-23, o, d a component of the origin and direction, n a side moved outwards by
// w: scale is 1 / d with an error of e, shift -o times that with one of e more, and their product and sum is fused: it
// rounds once. So the distance (n - o) / d has errors of 2.01 e |n - o| / |d| and 1.01 e |o / d|. n itself rounds by
// e |n|. Together that is less than 3.1 e (|n| + |o|) / |d|, and moving a side by w moves its distance by w / |d|.
// Stored boxes are grown by more than 1.5 e |n| + S / 2^25, S the scene's largest |coordinate|, so with
// w = 2 e |n| + 4 e O, O the largest |o| of the batch, a ray enters a box no later than it truly does and leaves it no
// earlier. S / 2^25 covers the rest: components below 2^-40 of the largest count as that much, which moves a ray by
// less than 2^-30 S on the 2^10 S it has to go; what is flushed is below 2^-124 in t. No product reaches 2^105.
inline constexpr float kWidening = 0x1p-22f, kGreatestRatio = 0x1p40f;
/// Scenes of such sizes, with origins so far away in their largest |coordinate|, are tested by terms.
inline constexpr float kLeastTermScene = 0x1p-56f, kFarTermOrigin = 0x1p8f;

/// What set_up_ray_terms() does with other rays than most.
template <class L>
GRIDIRON_RARE inline void set_up_odd_terms(const BatchRay& ray, RayTerms& terms) {
  const float most = kGreatestRatio / ray.dir_max;  // 0 where dir_max is infinite
  for (int axis = 0; axis < 3; ++axis) {
    float scale = ray.inverse[axis];
    if (most > 0.0f && magnitude(scale) > most) scale = scale < 0.0f ? -most : most;
    terms.scale[axis] = scale;
    terms.shift[axis] = scale == 0.0f ? 0.0f : -(ray.origin[axis] * scale);
  }
}

/// Prepares a ray that set_up_list_ray() has prepared for boxes by terms.
template <class L>
GRIDIRON_INLINE void set_up_ray_terms(const BatchRay& ray, RayTerms& terms) {
  using Quad = Lanes<4>;
  using Float = typename Quad::Float;
  const Float place = Float::load(ray.origin), inverse = Float::load(ray.inverse);
  const auto is_t = Quad::mask_from_bits(8);
  Quad::select(is_t, place, inverse).store(terms.scale);
  (-(place * inverse)).store(terms.shift);
  const Float ratio = Quad::abs(inverse) * Float(ray.dir_max);
  if (((ratio <= Float(kGreatestRatio)) | is_t).bits() != 15) [[unlikely]]
    set_up_odd_terms<L>(ray, terms);
}

/// Four words of each of L::kCount rays, ray by ray in rows of quads, to lanes and back: `words` has ray i in lane i.
/// @param rays  the first ray's words; the next ray's are sizeof(BatchRay) behind.
template <class L>
GRIDIRON_INLINE void load_ray_words(const float* rays, typename L::Float (&words)[4]) {
  using Float = typename L::Float;
  static constexpr std::uint32_t kStride = sizeof(BatchRay) / sizeof(float);
  Float rows[4];
  for (std::uint32_t row = 0; row < 4; ++row) {
    const float* places[L::kCount / 4];
    for (std::uint32_t quad = 0; quad < L::kCount / 4; ++quad) places[quad] = rays + (4 * quad + row) * kStride;
    rows[row] = L::load_quads(places);
  }
  const Float low_01 = L::template shuffle_quads<0, 4, 1, 5>(rows[0], rows[1]),
              low_23 = L::template shuffle_quads<0, 4, 1, 5>(rows[2], rows[3]),
              high_01 = L::template shuffle_quads<2, 6, 3, 7>(rows[0], rows[1]),
              high_23 = L::template shuffle_quads<2, 6, 3, 7>(rows[2], rows[3]);
  words[0] = L::template shuffle_quads<0, 1, 4, 5>(low_01, low_23);
  words[1] = L::template shuffle_quads<2, 3, 6, 7>(low_01, low_23);
  words[2] = L::template shuffle_quads<0, 1, 4, 5>(high_01, high_23);
  words[3] = L::template shuffle_quads<2, 3, 6, 7>(high_01, high_23);
}
template <class L>
GRIDIRON_INLINE void store_ray_words(typename L::Float x, typename L::Float y, typename L::Float z, typename L::Float w,
                                     float* rays) {
  using Float = typename L::Float;
  static constexpr std::uint32_t kStride = sizeof(BatchRay) / sizeof(float);
  const Float low_xy = L::template shuffle_quads<0, 4, 1, 5>(x, y),
              high_xy = L::template shuffle_quads<2, 6, 3, 7>(x, y),
              low_zw = L::template shuffle_quads<0, 4, 1, 5>(z, w),
              high_zw = L::template shuffle_quads<2, 6, 3, 7>(z, w);
  L::store_quads(L::template shuffle_quads<0, 1, 4, 5>(low_xy, low_zw), rays, 4 * kStride);
  L::store_quads(L::template shuffle_quads<2, 3, 6, 7>(low_xy, low_zw), rays + kStride, 4 * kStride);
  L::store_quads(L::template shuffle_quads<0, 1, 4, 5>(high_xy, high_zw), rays + 2 * kStride, 4 * kStride);
  L::store_quads(L::template shuffle_quads<2, 3, 6, 7>(high_xy, high_zw), rays + 3 * kStride, 4 * kStride);
}

/// What set_up_list_ray() and set_up_ray_terms() do, for L::kCount rays at once: wide lanes prepare a batch by it.
template <class L, bool kHasTerms>
class RaySetup {
 public:
  /// @param largest  |coordinate| of the scene.
  GRIDIRON_INLINE explicit RaySetup(float largest) : largest_(largest) {
    const float far = largest * kFarOrigin;
    // No origin is usual in scenes that are too large.
    most_ = !(largest <= kGreatestListPlace) ? -1.0f : far < kGreatestListPlace ? far : kGreatestListPlace;
  }

  /// Prepares as many rays as there are lanes.
  /// @param terms  of the rays, if they have some. @param words  get the rays' words, aligned to lanes; each misses all
  /// octants but its
  ///               own. @param first  the first ray's number.
  GRIDIRON_INLINE void add(BatchRay* rays, RayTerms* terms, std::uint32_t first, std::uint32_t* words) {
    static constexpr auto kWords = [] {
      struct {
        alignas(64) std::uint32_t of[L::kCount];
      } made{};
      for (std::uint32_t i = 0; i < L::kCount; ++i) made.of[i] = (kRayQuads * i) << kPlaceShift | 0xFF00u;
      return made;
    }();
    Float place[4], dir[4], sizes[3], inverse[3];
    load_ray_words<L>(rays->origin, place);
    load_ray_words<L>(rays->dir, dir);
    for (int axis = 0; axis < 3; ++axis) {
      sizes[axis] = L::abs(dir[axis]);
      const Float distance = L::abs(place[axis]);
      farthest_[axis] = L::max(distance, farthest_[axis]);  // in this order a NaN changes nothing
    }
    const Float longest = L::max(L::max(sizes[0], sizes[1]), sizes[2]), least = longest * Float(kLeastListComponent);
    Mask is_usual = (longest >= Float(kLeastListDirection)) & (longest <= Float(kGreatestListDirection));
    Int missed = Int::splat(1), octant = Int::splat(first * kRayQuads << kPlaceShift);
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const Mask is_backwards = dir[axis] < Float(0.0f);
      inverse[axis] = Float(1.0f) / L::select(sizes[axis] < least, L::flip_sign(is_backwards, least), dir[axis]);
      is_usual = is_usual & (L::abs(place[axis]) <= Float(most_));
      if constexpr (kHasTerms) is_usual = is_usual & (L::abs(inverse[axis]) * longest <= Float(kGreatestRatio));
      // Of twice as many octants those of the other half are missed.
      const std::uint32_t half = 1u << axis, bits = (1u << half) - 1;
      const Int others = Int::splat(bits);
      missed = axis == 0 ? L::select(is_backwards, Int::splat(1), Int::splat(2))
                         : L::select(is_backwards, (missed << static_cast<int>(half)) | others,
                                     missed | (others << static_cast<int>(half)));
      octant = octant + L::select(is_backwards, Int::splat(1u << (kOctantShift + axis)), Int::splat(0));
    }
    store_ray_words<L>(inverse[0], inverse[1], inverse[2], longest, rays->inverse);
    if constexpr (kHasTerms) {
      store_ray_words<L>(inverse[0], inverse[1], inverse[2], place[3], terms->scale);
      store_ray_words<L>(-(place[0] * inverse[0]), -(place[1] * inverse[1]), -(place[2] * inverse[2]), place[3],
                         terms->shift);
    }
    missed_ = missed_ & missed;
    ((octant + Int::load(kWords.of)) | missed).store(words);
    for (std::uint32_t odd = L::kAllBits & ~is_usual.bits(); odd != 0; odd &= odd - 1) {
      const std::uint32_t lane = lowest_bit(odd);
      // The octant does not change.
      (void)set_up_list_ray<L>(rays[lane], largest_);
      if constexpr (kHasTerms) set_up_ray_terms<L>(rays[lane], terms[lane]);
    }
  }
  /// @returns the octants of rays so far, as bits.
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t octants() const {
    alignas(64) std::uint32_t missed[L::kCount];
    missed_.store(missed);
    std::uint32_t all = 0xFF;
    for (const std::uint32_t one : missed) all &= one;
    return ~all & 0xFF;
  }
  /// @returns the largest |component| of the origins so far.
  [[nodiscard]] GRIDIRON_INLINE float farthest(std::uint32_t axis) const { return L::horizontal_max(farthest_[axis]); }

 private:
  using Float = typename L::Float;
  using Int = typename L::Int;
  using Mask = typename L::Mask;
  float largest_, most_;
  Float farthest_[3] = {Float(0.0f), Float(0.0f), Float(0.0f)};
  Int missed_ = Int::splat(0xFF);
};

/// Terms of all rays, and what they widen boxes by.
struct TermsList {
  const RayTerms* terms = nullptr;
  float twice_farthest[3] = {};  ///< the largest |component| of origins, doubled

  /// @param largest  |coordinate| of the scene. @returns whether the rays can be tested by terms.
  [[nodiscard]] bool set_up(const RayTerms* of_rays, const float (&farthest)[3], float largest) {
    terms = of_rays;
    bool is_possible = largest >= kLeastTermScene && largest <= kGreatestListPlace;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      is_possible = is_possible && farthest[axis] <= largest * kFarTermOrigin;
      twice_farthest[axis] = 2.0f * farthest[axis];
    }
    return is_possible;
  }
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

/// Leaves those words of rays in a list that have no hit yet. @param list  with room for L::kCount words more, aligned
/// to as many. @returns how many.
template <class L>
GRIDIRON_INLINE std::uint32_t take_living(const BatchRay* rays, std::uint32_t* list, std::uint32_t count) {
  using Int = typename L::Int;
  std::uint32_t living = 0;
  for (std::uint32_t i = 0; i < count; i += L::kCount) {
    const Int words = Int::load(list + i);
    const std::uint32_t rest = count - i;
    const std::uint32_t there = rest >= L::kCount ? std::uint32_t{L::kAllBits} : (1u << rest) - 1u;
    const Int ids = L::gather(&rays->id, (words & Int::splat(kPlaceBits)) >> static_cast<int>(kPlaceShift - 4));
    const std::uint32_t open = (ids < Int::splat(0)).bits() & there;
    L::compress(words, open, list + living);
    living += count_bits(open);
  }
  return living;
}

}  // namespace gridiron
