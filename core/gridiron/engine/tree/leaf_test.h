// Triangles of a leaf, in lanes, against one ray after another: which it surely hits, which it may hit.
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

/// Spreads `count` records over lanes. @param trusts_floats  no errors of sides: Accuracy::kFast.
template <class L>
GRIDIRON_OUTLINE void set_up_leaf(const VertexTriangle* records, std::uint32_t count, bool trusts_floats,
                                  TriangleLanes& lanes) {
  using Float = typename L::Float;
  const Float factor(trusts_floats ? 0.0f : kSideErrorFactor);
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
    (edges * factor).store(lanes.edge_error + base);
    (sizes * factor).store(lanes.normal_error + base);
  }
}

/// What floats say of L::kCount triangles and a ray; bit i = triangle i of the lanes.
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
};

/// Wide lanes first rule out what they can by wider bounds of less work, without a branch between sides and distance:
/// half of the rays pass through their own triangle's plane within its sides. Few lanes would gain no more than it
/// costs.
template <class L, bool kBounded>
inline constexpr bool kFiltersFirst = L::kRoundsOnce&& kBounded;

/// The lanes of a leaf from `base` on, in registers.
/// @tparam kBounded  decisions have bounds of their error. Accuracy::kFast has none, so it computes the same bits with
///                   all lanes.
template <class L, bool kBounded>
struct LeafLanes {
  using Float = typename L::Float;
  Float v[3], back_e1[3], e2[3], n[3], edge_error, normal_error;
  Float wide_edge_error, wide_normal_error, least_error;  ///< if kFiltersFirst

  GRIDIRON_INLINE LeafLanes(const TriangleLanes& lanes, std::uint32_t base)
      : v{Float::load(lanes.v[0] + base), Float::load(lanes.v[1] + base), Float::load(lanes.v[2] + base)},
        back_e1{Float::load(lanes.back_e1[0] + base), Float::load(lanes.back_e1[1] + base),
                Float::load(lanes.back_e1[2] + base)},
        e2{Float::load(lanes.e2[0] + base), Float::load(lanes.e2[1] + base), Float::load(lanes.e2[2] + base)},
        n{Float::load(lanes.normal[0] + base), Float::load(lanes.normal[1] + base),
          Float::load(lanes.normal[2] + base)},
        edge_error(Float::load(lanes.edge_error + base)),
        normal_error(Float::load(lanes.normal_error + base)),
        wide_edge_error(edge_error),
        wide_normal_error(edge_error),
        least_error(edge_error) {
    if constexpr (kFiltersFirst<L, kBounded>) {
      wide_edge_error = edge_error * Float(3.0f);
      wide_normal_error = normal_error * Float(3.0f);
      least_error = normal_error + edge_error * Float(kLeastListSize);
    }
  }

  /// @param there  the lanes that have a triangle.
  [[nodiscard]] GRIDIRON_INLINE LeafAnswer<L> test(const BatchRay& ray, std::uint32_t there) const {
    Float o_x, o_y, o_z, d_x, d_y, d_z, t, dir_max;
    if constexpr (L::kCount == 4) {
      const Float place = Float::load(ray.origin), sizes = Float::load(ray.inverse), dir = Float::load(ray.dir);
      o_x = L::template shuffle_quads<0, 0, 0, 0>(place);
      o_y = L::template shuffle_quads<1, 1, 1, 1>(place);
      o_z = L::template shuffle_quads<2, 2, 2, 2>(place);
      t = L::template shuffle_quads<3, 3, 3, 3>(place);
      d_x = L::template shuffle_quads<0, 0, 0, 0>(dir);
      d_y = L::template shuffle_quads<1, 1, 1, 1>(dir);
      d_z = L::template shuffle_quads<2, 2, 2, 2>(dir);
      dir_max = L::template shuffle_quads<3, 3, 3, 3>(sizes);
    } else {
      o_x = Float(ray.origin[0]), o_y = Float(ray.origin[1]), o_z = Float(ray.origin[2]);
      d_x = Float(ray.dir[0]), d_y = Float(ray.dir[1]), d_z = Float(ray.dir[2]);
      t = Float(ray.t), dir_max = Float(ray.dir_max);
    }
    const Float x = v[0] - o_x, y = v[1] - o_y, z = v[2] - o_z;
    const Float r_x = difference(y, d_z, z, d_y), r_y = difference(z, d_x, x, d_z), r_z = difference(x, d_y, y, d_x);
    const Float denominator = inner(d_x, d_y, d_z, n);
    const Float first = L::turn_by(denominator, inner(r_x, r_y, r_z, e2));
    const Float second = L::turn_by(denominator, inner(r_x, r_y, r_z, back_e1));
    const Float size = L::abs(denominator);
    const Float third = size - first - second;
    const Float least = L::min(L::min(first, second), third);
    if constexpr (kFiltersFirst<L, kBounded>) {
      // The bounds below with three times the largest component in place of the sum.
      const Float most = L::larger_size(L::larger_size(x, y), z);
      const Float side = sum(sum(most, wide_edge_error, least_error), dir_max, least);
      const Float ahead = L::turn_by(denominator, inner(x, y, z, n));
      const Float turn = wide_normal_error * dir_max;
      const Float limit = sum(sum(size, Float(1.0f + 0x1p-20f), turn), t, Float(2.0f * kLeastAhead));
      const auto away = (sum(most, wide_normal_error, ahead) < Float(-2.0f * kLeastAhead)) |
                        (sum(most, -wide_normal_error, ahead) > limit);
      if ((there & ~((side < Float(0.0f)) | (away & (size > turn))).bits()) == 0) return none();
    }
    const Float far = L::abs(x) + L::abs(y) + (L::abs(z) + Float(kLeastListSize));
    const Float turn = normal_error * dir_max;
    const Float error = far * dir_max * edge_error + turn;
    // Where there is no bound, nothing is outside or inside.
    const std::uint32_t candidates = there & ~(least + error < Float(0.0f)).bits();
    if (candidates == 0) return none();
    // Where along the ray. What rounds after the bounds of ahead and size is less than 2^-20 of their products.
    const Float ahead = L::turn_by(denominator, inner(x, y, z, n));
    const Float ahead_error = far * normal_error + Float(kLeastAhead);
    const Float least_ahead = ahead - ahead_error, most_ahead = ahead + ahead_error;
    const Float least_limit = (size - turn) * t * Float(1.0f - 0x1p-20f),
                most_limit = (size + turn) * t * Float(1.0f + 0x1p-20f);
    const std::uint32_t sign_known = (size > turn).bits();
    const std::uint32_t in_front = (least_ahead > Float(0.0f)).bits() & sign_known;
    const std::uint32_t behind = (most_ahead < Float(0.0f)).bits() & sign_known;
    const std::uint32_t beyond = (least_ahead > most_limit).bits() & sign_known;
    const std::uint32_t in_reach = candidates & ~(behind | beyond);
    const std::uint32_t inside = (least > error).bits();
    return {
        in_reach & inside, in_reach & ~inside, (most_ahead < least_limit).bits() & in_front, least_ahead, size, turn};
  }

 private:
  [[nodiscard]] static GRIDIRON_INLINE LeafAnswer<L> none() { return {0, 0, 0, Float(0.0f), Float(0.0f), Float(0.0f)}; }
  [[nodiscard]] static GRIDIRON_INLINE Float sum(Float a, Float b, Float c) {
    if constexpr (kBounded) return L::bounded_sum(a, b, c);
    return a * b + c;
  }
  [[nodiscard]] static GRIDIRON_INLINE Float difference(Float a, Float b, Float c, Float d) {
    if constexpr (kBounded) return L::bounded_difference(a, b, c, d);
    return a * b - c * d;
  }
  [[nodiscard]] static GRIDIRON_INLINE Float inner(Float x, Float y, Float z, const Float (&other)[3]) {
    return sum(z, other[2], sum(y, other[1], x * other[0]));
  }
};

}  // namespace gridiron
