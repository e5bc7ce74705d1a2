// Rays against triangles of a leaf, which they surely hit and which they may hit: triangles in lanes for one ray, or
// rays of a group in lanes for one triangle.
// Source: own; bounds below. Memory: values. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/engine/tree/list_memory.h>
#include <gridiron/ray/ray_batch.h>

#include <cstddef>
#include <cstdint>

namespace gridiron {

// With e = 2^-23, the largest relative error of an operation in any rounding mode, X, D, E the sums of magnitudes of
// the components of corner - origin, direction and edge: products of three carry 4 e by their factors, 3 e by their own
// products and differences, and two sums 2 e, together less than 10 e X D E. The normal's products have 3 e, its
// components 4 e, their product with the direction and its sums 7 e. The third side is the difference of these: less
// than 2 e of both more. 14 e with what computing the bound loses; D is at most 3 times the largest component.
inline constexpr float kSideErrorFactor = 3.0f * 14.0f * 0x1p-23f;
/// Added to sizes, so that what becomes subnormal on the way is covered, with denormals flushed too. Directions are at
/// least 2^-16: the bound of a product with the normal is at least 2^-119, where losses are below 2^-122; that of three
/// factors is at least 2^-119 times the edge, of which inner products lose 2^-125.
inline constexpr float kLeastListSize = 0x1p-85f;
inline constexpr float kLeastAhead = 0x1p-120f;
/// No product of such coordinates, and of directions up to 2^40, overflows. Rays that start beyond, or are in a larger
/// scene, have no bound: everything about them is unsure.
inline constexpr float kGreatestListPlace = 0x1p40f;

/// Word w of the records in words[w]: of record base in the first lane, and so on; behind the last one it again.
template <class L>
GRIDIRON_INLINE void load_records(const VertexTriangle* records, std::uint32_t base, std::uint32_t count,
                                  typename L::Float (&words)[12]) {
  using Float = typename L::Float;
  static_assert(sizeof(VertexTriangle) == 48);
  if constexpr (L::kCount == 1) {
    for (int word = 0; word < 9; ++word) words[word] = Float(records[base].v[word / 3][word % 3]);
  } else {
    const float* places[4][L::kCount / 4];
    if constexpr (L::kCount == 4) {
      for (std::uint32_t i = 0; i < L::kCount; ++i) {
        places[i % 4][i / 4] = records[base + i < count ? base + i : count - 1].v[0];
      }
    } else {
      // By a table, without a comparison a lane.
      static constexpr auto kOffsets = [] {
        struct {
          std::uint16_t bytes[L::kCount][L::kCount];
        } offsets{};
        for (std::uint32_t last = 0; last < L::kCount; ++last) {
          for (std::uint32_t i = 0; i < L::kCount; ++i) {
            offsets.bytes[last][i] = static_cast<std::uint16_t>(sizeof(VertexTriangle) * (i < last ? i : last));
          }
        }
        return offsets;
      }();
      const std::uint32_t rest = count - base, last = (rest < L::kCount ? rest : L::kCount) - 1;
      const auto* const first = reinterpret_cast<const std::byte*>(records + base);
      for (std::uint32_t i = 0; i < L::kCount; ++i) {
        places[i % 4][i / 4] = reinterpret_cast<const float*>(first + kOffsets.bytes[last][i]);
      }
    }
    for (int part = 0; part < 3; ++part) {
      Float rows[4];
      for (int i = 0; i < 4; ++i) {
        rows[i] = L::load_quads(places[i]);
        for (const float*& place : places[i]) place += 4;
      }
      const Float low_01 = L::template shuffle_quads<0, 4, 1, 5>(rows[0], rows[1]),
                  low_23 = L::template shuffle_quads<0, 4, 1, 5>(rows[2], rows[3]);
      words[4 * part] = L::template shuffle_quads<0, 1, 4, 5>(low_01, low_23);
      if (part == 2) break;  // what follows the last coordinate is no float
      const Float high_01 = L::template shuffle_quads<2, 6, 3, 7>(rows[0], rows[1]),
                  high_23 = L::template shuffle_quads<2, 6, 3, 7>(rows[2], rows[3]);
      words[4 * part + 1] = L::template shuffle_quads<2, 3, 6, 7>(low_01, low_23);
      words[4 * part + 2] = L::template shuffle_quads<0, 1, 4, 5>(high_01, high_23);
      words[4 * part + 3] = L::template shuffle_quads<2, 3, 6, 7>(high_01, high_23);
    }
  }
}

/// Spreads `count` records over lanes. @param group_leaf  is filled too, unless it is null.
template <class L>
GRIDIRON_OUTLINE void set_up_leaf(const VertexTriangle* records, std::uint32_t count, TriangleLanes& lanes,
                                  GroupLeaf* group_leaf = nullptr) {
  using Float = typename L::Float;
  const Float factor(kSideErrorFactor);
  for (std::uint32_t base = 0; base < count; base += L::kCount) {
    Float corners[12];  // nine coordinates
    load_records<L>(records, base, count, corners);
    Float e1[3], e2[3], sizes(kLeastListSize), edges(kLeastListSize);
    for (int axis = 0; axis < 3; ++axis) {
      const Float v = corners[axis];
      e1[axis] = corners[3 + axis] - v;
      e2[axis] = corners[6 + axis] - v;
      v.store(lanes.v[axis] + base);
      (-e1[axis]).store(lanes.back_e1[axis] + base);
      e2[axis].store(lanes.e2[axis] + base);
      edges = edges + (L::abs(e1[axis]) + L::abs(e2[axis]));
    }
    for (int axis = 0; axis < 3; ++axis) {
      const int j = axis == 2 ? 0 : axis + 1, k = j == 2 ? 0 : j + 1;
      const Float p = e1[j] * e2[k], q = e1[k] * e2[j];
      (p - q).store(lanes.normal[axis] + base);
      sizes = sizes + (L::abs(p) + L::abs(q));
    }
    const Float edge_error = edges * factor, normal_error = sizes * factor;
    edge_error.store(lanes.edge_error + base);
    normal_error.store(lanes.normal_error + base);
    if constexpr (L::kCount > 4) {
      if (group_leaf == nullptr) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const Float a = corners[axis], b = corners[3 + axis], c = corners[6 + axis];
        L::min(L::min(a, b), c).store(group_leaf->low[axis] + base);
        L::max(L::max(a, b), c).store(group_leaf->high[axis] + base);
      }
      (edge_error * Float(3.0f)).store(group_leaf->edge_error + base);
      (normal_error * Float(3.0f)).store(group_leaf->normal_error + base);
      (normal_error + edge_error * Float(kLeastListSize)).store(group_leaf->least_error + base);
    }
  }
}

/// Prepares the lanes for rays of one origin: v becomes the normals of the planes through it and the edge from corner
/// 0 to 2, back_e1 of those through the edge from corner 0 to 1, e2 what rays have in common (SharedLanes). Each has
/// the roundings that the bound of a side allows for.
template <class L>
GRIDIRON_OUTLINE void set_up_origin(const float* origin, std::uint32_t count, TriangleLanes& lanes) {
  using Float = typename L::Float;
  for (std::uint32_t base = 0; base < count; base += L::kCount) {
    Float place[3], first[3], second[3];
    for (int axis = 0; axis < 3; ++axis) {
      place[axis] = Float::load(lanes.v[axis] + base) - Float(origin[axis]);
      first[axis] = Float::load(lanes.e2[axis] + base);
      second[axis] = Float::load(lanes.back_e1[axis] + base);
    }
    Float ahead(0.0f), far(kLeastListSize);
    for (int axis = 0; axis < 3; ++axis) {
      const int j = axis == 2 ? 0 : axis + 1, k = j == 2 ? 0 : j + 1;
      (first[j] * place[k] - first[k] * place[j]).store(lanes.v[axis] + base);
      (second[j] * place[k] - second[k] * place[j]).store(lanes.back_e1[axis] + base);
      ahead = ahead + place[axis] * Float::load(lanes.normal[axis] + base);
      far = far + L::abs(place[axis]);
    }
    const Float normal_error = Float::load(lanes.normal_error + base);
    ahead.store(lanes.e2[0] + base);
    (far * normal_error + Float(kLeastAhead)).store(lanes.e2[1] + base);
    (far * Float::load(lanes.edge_error + base) + normal_error).store(lanes.edge_error + base);
  }
}

/// What floats say of L::kCount triangles and a ray, or as many rays and a triangle; bit i = lane i.
template <class L>
struct LeafAnswer {
  using Float = typename L::Float;
  std::uint32_t inside;           ///< the ray's line surely passes through, and the plane is not surely out of reach
  std::uint32_t unsure;           ///< the line may pass through, likewise
  std::uint32_t within;           ///< the plane is surely at 0 < t <= the ray's
  Float least_ahead, size, turn;  ///< of t = ahead / size: a bound of ahead from below, size, a bound of its error

  /// @returns a bound of t from below. Where the sign of size is not known, or products may have overflowed, it is
  /// below 0: never NaN, which would come behind all others.
  [[nodiscard]] GRIDIRON_INLINE Float least_t() const {
    return L::select(size > turn, least_ahead / (size + turn) * Float(1.0f - 0x1p-20f), Float(-1.0f));
  }

  /// That no triangle is hit.
  [[nodiscard]] static GRIDIRON_INLINE LeafAnswer none() { return {0, 0, 0, Float(0.0f), Float(0.0f), Float(0.0f)}; }

  /// Where along the ray the planes of triangles are. What rounds after the bounds of ahead and size is less than 2^-20
  /// of their products. @param candidates  that the ray's line may pass through. @param passed  that it surely does.
  [[nodiscard]] static GRIDIRON_INLINE LeafAnswer judge(std::uint32_t candidates, std::uint32_t passed, Float ahead,
                                                        Float ahead_error, Float size, Float turn, Float t) {
    const Float least_ahead = ahead - ahead_error, most_ahead = ahead + ahead_error;
    const Float least_limit = (size - turn) * t * Float(1.0f - 0x1p-20f),
                most_limit = (size + turn) * t * Float(1.0f + 0x1p-20f);
    const std::uint32_t sign_known = (size > turn).bits();
    const std::uint32_t in_front = (least_ahead > Float(0.0f)).bits() & sign_known;
    const std::uint32_t behind = (most_ahead < Float(0.0f)).bits() & sign_known;
    const std::uint32_t beyond = (least_ahead > most_limit).bits() & sign_known;
    const std::uint32_t in_reach = candidates & ~(behind | beyond);
    return {
        in_reach & passed, in_reach & ~passed, (most_ahead < least_limit).bits() & in_front, least_ahead, size, turn};
  }
};

/// What leaves need of a ray, in every lane.
template <class L>
struct LeafRay {
  using Float = typename L::Float;
  Float origin[3], dir[3], t, dir_max;

  GRIDIRON_INLINE explicit LeafRay(const BatchRay& ray) {
    if constexpr (L::kCount == 4) {
      const Float place = Float::load(ray.origin), sizes = Float::load(ray.inverse), way = Float::load(ray.dir);
      origin[0] = L::template shuffle_quads<0, 0, 0, 0>(place);
      origin[1] = L::template shuffle_quads<1, 1, 1, 1>(place);
      origin[2] = L::template shuffle_quads<2, 2, 2, 2>(place);
      t = L::template shuffle_quads<3, 3, 3, 3>(place);
      dir[0] = L::template shuffle_quads<0, 0, 0, 0>(way);
      dir[1] = L::template shuffle_quads<1, 1, 1, 1>(way);
      dir[2] = L::template shuffle_quads<2, 2, 2, 2>(way);
      dir_max = L::template shuffle_quads<3, 3, 3, 3>(sizes);
    } else {
      for (int axis = 0; axis < 3; ++axis) {
        origin[axis] = Float(ray.origin[axis]);
        dir[axis] = Float(ray.dir[axis]);
      }
      t = Float(ray.t), dir_max = Float(ray.dir_max);
    }
  }
  /// Rays of a group instead, one a lane, from `base` on.
  GRIDIRON_INLINE LeafRay(const RayGroup& group, std::uint32_t base)
      : t(Float::load(group.t + base)), dir_max(Float::load(group.dir_max + base)) {
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = Float::load(group.origin[axis] + base);
      dir[axis] = Float::load(group.dir[axis] + base);
    }
  }
};

/// One triangle in all lanes, or as many triangles as there are lanes.
template <class L, bool kIsOne>
[[nodiscard]] GRIDIRON_INLINE typename L::Float load_triangles(const float* words) {
  if constexpr (kIsOne) return typename L::Float(*words);
  return L::Float::load(words);
}

/// Wide lanes first rule out what they can by wider bounds of less work, without a branch between sides and distance:
/// half of the rays pass through their own triangle's plane within its sides. Few lanes would gain no more than it
/// costs.
template <class L, bool kBounded, bool kIsOne>
inline constexpr bool kFiltersFirst = L::kRoundsOnce&& kBounded && !kIsOne;

/// Sums of products. @tparam kBounded  what is unsure is decided exactly. With Accuracy::kFast it is not always, so all
/// lanes compute the same bits.
template <class L, bool kBounded>
struct LeafSums {
  using Float = typename L::Float;
  [[nodiscard]] static GRIDIRON_INLINE Float sum(Float a, Float b, Float c) {
    if constexpr (kBounded) return L::bounded_sum(a, b, c);
    return a * b + c;
  }
  [[nodiscard]] static GRIDIRON_INLINE Float difference(Float a, Float b, Float c, Float d) {
    if constexpr (kBounded) return L::bounded_difference(a, b, c, d);
    return a * b - c * d;
  }
  [[nodiscard]] static GRIDIRON_INLINE Float inner(const Float (&a)[3], const Float (&b)[3]) {
    return sum(a[2], b[2], sum(a[1], b[1], a[0] * b[0]));
  }
};

/// The lanes of a leaf from `base` on, in registers. @tparam kIsOne  the triangle at `base` is in all lanes instead.
template <class L, bool kBounded, bool kIsOne = false>
struct LeafLanes : LeafSums<L, kBounded> {
  using Float = typename L::Float;
  using LeafSums<L, kBounded>::sum, LeafSums<L, kBounded>::difference, LeafSums<L, kBounded>::inner;
  Float v[3], back_e1[3], e2[3], n[3], edge_error, normal_error;
  Float wide_edge_error, wide_normal_error, least_error;  ///< if kFiltersFirst

  GRIDIRON_INLINE LeafLanes(const TriangleLanes& lanes, std::uint32_t base)
      : edge_error(load_triangles<L, kIsOne>(lanes.edge_error + base)),
        normal_error(load_triangles<L, kIsOne>(lanes.normal_error + base)),
        wide_edge_error(edge_error),
        wide_normal_error(edge_error),
        least_error(edge_error) {
    for (int axis = 0; axis < 3; ++axis) {
      v[axis] = load_triangles<L, kIsOne>(lanes.v[axis] + base);
      back_e1[axis] = load_triangles<L, kIsOne>(lanes.back_e1[axis] + base);
      e2[axis] = load_triangles<L, kIsOne>(lanes.e2[axis] + base);
      n[axis] = load_triangles<L, kIsOne>(lanes.normal[axis] + base);
    }
    if constexpr (kFiltersFirst<L, kBounded, kIsOne>) {
      wide_edge_error = edge_error * Float(3.0f);
      wide_normal_error = normal_error * Float(3.0f);
      least_error = normal_error + edge_error * Float(kLeastListSize);
    }
  }

  /// @param there  the lanes that have a triangle.
  [[nodiscard]] GRIDIRON_INLINE LeafAnswer<L> test(const BatchRay& ray, std::uint32_t there) const {
    return test(LeafRay<L>(ray), there);
  }
  [[nodiscard]] GRIDIRON_INLINE LeafAnswer<L> test(const LeafRay<L>& q, std::uint32_t there) const {
    const Float x = v[0] - q.origin[0], y = v[1] - q.origin[1], z = v[2] - q.origin[2];
    const Float r[3] = {difference(y, q.dir[2], z, q.dir[1]), difference(z, q.dir[0], x, q.dir[2]),
                        difference(x, q.dir[1], y, q.dir[0])};
    const Float denominator = inner(q.dir, n);
    const Float first = L::turn_by(denominator, inner(r, e2));
    const Float second = L::turn_by(denominator, inner(r, back_e1));
    const Float size = L::abs(denominator);
    const Float third = size - first - second;
    const Float least = L::min(L::min(first, second), third);
    const Float place[3] = {x, y, z};
    if constexpr (kFiltersFirst<L, kBounded, kIsOne>) {
      // The bounds below with three times the largest component in place of the sum.
      const Float most = L::larger_size(L::larger_size(x, y), z) + Float(kLeastListSize);
      const Float side = sum(sum(most, wide_edge_error, least_error), q.dir_max, least);
      const Float ahead = L::turn_by(denominator, inner(place, n));
      const Float turn = wide_normal_error * q.dir_max;
      const Float limit = sum(sum(size, Float(1.0f + 0x1p-20f), turn), q.t, Float(2.0f * kLeastAhead));
      const auto away = (sum(most, wide_normal_error, ahead) < Float(-2.0f * kLeastAhead)) |
                        (sum(most, -wide_normal_error, ahead) > limit);
      if ((there & ~((side < Float(0.0f)) | (away & (size > turn))).bits()) == 0) return LeafAnswer<L>::none();
    }
    const Float far = L::abs(x) + L::abs(y) + (L::abs(z) + Float(kLeastListSize));
    const Float turn = normal_error * q.dir_max;
    const Float error = far * q.dir_max * edge_error + turn;
    // Where there is no bound, nothing is outside or inside.
    const std::uint32_t candidates = there & ~(least + error < Float(0.0f)).bits();
    if (candidates == 0) return LeafAnswer<L>::none();
    return LeafAnswer<L>::judge(candidates, (least > error).bits(), L::turn_by(denominator, inner(place, n)),
                                far * normal_error + Float(kLeastAhead), size, turn, q.t);
  }
};

/// The same of lanes that set_up_origin() prepared.
template <class L, bool kBounded, bool kIsOne = false>
struct SharedLanes : LeafSums<L, kBounded> {
  using Float = typename L::Float;
  using LeafSums<L, kBounded>::inner;
  Float first[3], second[3], n[3], ahead, ahead_error, error, normal_error;

  const std::uint32_t* own_ids;

  /// @param ids  no_hit() of the triangles.
  GRIDIRON_INLINE SharedLanes(const TriangleLanes& lanes, std::uint32_t base, const std::uint32_t* ids)
      : ahead(load_triangles<L, kIsOne>(lanes.e2[0] + base)),
        ahead_error(load_triangles<L, kIsOne>(lanes.e2[1] + base)),
        error(load_triangles<L, kIsOne>(lanes.edge_error + base)),
        normal_error(load_triangles<L, kIsOne>(lanes.normal_error + base)),
        own_ids(ids + base) {
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = load_triangles<L, kIsOne>(lanes.v[axis] + base);
      second[axis] = load_triangles<L, kIsOne>(lanes.back_e1[axis] + base);
      n[axis] = load_triangles<L, kIsOne>(lanes.normal[axis] + base);
    }
  }

  /// @param there  the lanes that have a triangle.
  [[nodiscard]] GRIDIRON_INLINE LeafAnswer<L> test(const BatchRay& ray, std::uint32_t there) const {
    // Rays from a light end on their own triangles, which would all be candidates.
    return test(LeafRay<L>(ray), there, L::equal(ray.id, own_ids));
  }
  [[nodiscard]] GRIDIRON_INLINE LeafAnswer<L> test(const LeafRay<L>& q, std::uint32_t there) const {
    return test(q, there, L::mask_from_bits(0));
  }
  /// @param own  lanes of a ray and its own triangle.
  [[nodiscard]] GRIDIRON_INLINE LeafAnswer<L> test(const LeafRay<L>& q, std::uint32_t there,
                                                   typename L::Mask own) const {
    const Float denominator = inner(q.dir, n);
    const Float side = L::turn_by(denominator, inner(q.dir, first));
    const Float other = L::turn_by(denominator, inner(q.dir, second));
    const Float size = L::abs(denominator);
    const Float least = L::min(L::min(side, other), size - side - other);
    const Float most_error = error * q.dir_max;
    const std::uint32_t candidates = there & ~((least + most_error < Float(0.0f)) | own).bits();
    if (candidates == 0) return LeafAnswer<L>::none();
    return LeafAnswer<L>::judge(candidates, (least > most_error).bits(), L::turn_by(denominator, ahead), ahead_error,
                                size, normal_error * q.dir_max, q.t);
  }
};

}  // namespace gridiron
