// A triangle's corners in lanes, and its area by floats: for what goes over all triangles of a mesh.
// Internal header. Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/build/quad_words.h>
#include <gridiron/build/triangle_records.h>

#include <cstddef>
#include <cstdint>

namespace gridiron {

/// y, z, x.
[[nodiscard]] GRIDIRON_INLINE CornerQuad turned(CornerQuad quad) {
  return Lanes<4>::shuffle_quads<1, 2, 0, 3>(quad);
}

/// Four points, a lane each.
struct QuadRows {
  CornerQuad x, y, z;

  [[nodiscard]] static GRIDIRON_INLINE QuadRows of(const CornerQuad* quads) {
    using L = Lanes<4>;
    const CornerQuad xy01 = L::shuffle_quads<0, 1, 4, 5>(quads[0], quads[1]);
    const CornerQuad xy23 = L::shuffle_quads<0, 1, 4, 5>(quads[2], quads[3]);
    const CornerQuad z01 = L::shuffle_quads<2, 2, 6, 6>(quads[0], quads[1]);
    const CornerQuad z23 = L::shuffle_quads<2, 2, 6, 6>(quads[2], quads[3]);
    return {L::shuffle_quads<0, 2, 4, 6>(xy01, xy23), L::shuffle_quads<1, 3, 5, 7>(xy01, xy23),
            L::shuffle_quads<0, 2, 4, 6>(z01, z23)};
  }
  template <std::size_t kWidth>
  GRIDIRON_INLINE void store(float (*rows)[kWidth], std::uint32_t column) const {
    x.store(rows[0] + column);
    y.store(rows[1] + column);
    z.store(rows[2] + column);
  }
  /// Of each row the least or the greatest lane.
  template <class Choose>
  [[nodiscard]] GRIDIRON_INLINE CornerQuad reduced(Choose&& choose) const {
    using L = Lanes<4>;
    // x and y at once: of two columns each, then of one; then z.
    const CornerQuad low_xy = L::shuffle_quads<0, 1, 4, 5>(x, y), high_xy = L::shuffle_quads<2, 3, 6, 7>(x, y);
    const CornerQuad xy = choose(low_xy, high_xy);                     // x x y y
    const CornerQuad zz = choose(z, L::shuffle_quads<2, 3, 0, 1>(z));  // z z
    const CornerQuad even = L::shuffle_quads<0, 2, 4, 4>(xy, zz), odd = L::shuffle_quads<1, 3, 5, 5>(xy, zz);
    return choose(even, odd);
  }
};

/// The corners of a triangle.
struct CornerQuads {
  CornerQuad a, b, c;

  // Of the bound below.
  static constexpr float kShare = 0x1p-20f, kLeast = 0x1p-140f;

  [[nodiscard]] GRIDIRON_INLINE CornerQuad low() const { return Lanes<4>::min(Lanes<4>::min(a, b), c); }
  [[nodiscard]] GRIDIRON_INLINE CornerQuad high() const { return Lanes<4>::max(Lanes<4>::max(a, b), c); }

  /// False where floats do not decide. Sure, with u = 2^-24 and p - q a component of the normal: an edge component has
  /// an error of u of itself, a product of two 3 u and 2^-150, the difference u more, together less than 3.01 u (|p| +
  /// |q|)
  /// + u |p - q| + 2^-148. As |q| <= |p| + |p - q|, this is less than 7 u |p| + 5 u |p - q| + 2^-148. Where numbers
  /// overflow the bound is infinite or none, and nothing is greater.
  [[nodiscard]] GRIDIRON_INLINE bool surely_have_area() const {
    using L = Lanes<4>;
    const CornerQuad e = b - a, f = c - a;
    const CornerQuad p = e * turned(f), q = turned(e) * f;
    const CornerQuad error = L::abs(p) * CornerQuad(kShare) + CornerQuad(kLeast);
    return ((L::abs(p - q) > error).bits() & 7u) != 0;
  }
  /// The function of triangle_records.h.
  [[nodiscard]] GRIDIRON_INLINE bool have_zero_area() const {
    return !surely_have_area() && has_zero_area(vec3_of(a), vec3_of(b), vec3_of(c));
  }
};

/// Boxes of four triangles, a lane each.
struct FourBoxes {
  QuadRows low, high;

  /// At first empty, for add().
  [[nodiscard]] static GRIDIRON_INLINE FourBoxes none() {
    const CornerQuad most(kFloatMax), least(-kFloatMax);
    return {{most, most, most}, {least, least, least}};
  }
  GRIDIRON_INLINE void add(const FourBoxes& boxes) {
    using L = Lanes<4>;
    low = {L::min(boxes.low.x, low.x), L::min(boxes.low.y, low.y), L::min(boxes.low.z, low.z)};
    high = {L::max(boxes.high.x, high.x), L::max(boxes.high.y, high.y), L::max(boxes.high.z, high.z)};
  }
  /// Empties the boxes whose bit is not set.
  void keep(std::uint32_t bits) {
    using L = Lanes<4>;
    const L::Mask kept = L::mask_from_bits(bits);
    const CornerQuad most(kFloatMax), least(-kFloatMax);
    low = {L::select(kept, low.x, most), L::select(kept, low.y, most), L::select(kept, low.z, most)};
    high = {L::select(kept, high.x, least), L::select(kept, high.y, least), L::select(kept, high.z, least)};
  }
};

/// Four triangles, a lane each.
struct FourTriangles {
  QuadRows a, b, c;

  [[nodiscard]] static GRIDIRON_INLINE FourTriangles of(const CornerQuads* corners) {
    const CornerQuad a_of[4] = {corners[0].a, corners[1].a, corners[2].a, corners[3].a};
    const CornerQuad b_of[4] = {corners[0].b, corners[1].b, corners[2].b, corners[3].b};
    const CornerQuad c_of[4] = {corners[0].c, corners[1].c, corners[2].c, corners[3].c};
    return {QuadRows::of(a_of), QuadRows::of(b_of), QuadRows::of(c_of)};
  }

  [[nodiscard]] GRIDIRON_INLINE FourBoxes boxes() const {
    using L = Lanes<4>;
    const auto least = [](CornerQuad p, CornerQuad q, CornerQuad r)
                           GRIDIRON_INLINE_LAMBDA { return L::min(L::min(p, q), r); };
    const auto greatest = [](CornerQuad p, CornerQuad q, CornerQuad r)
                              GRIDIRON_INLINE_LAMBDA { return L::max(L::max(p, q), r); };
    return {{least(a.x, b.x, c.x), least(a.y, b.y, c.y), least(a.z, b.z, c.z)},
            {greatest(a.x, b.x, c.x), greatest(a.y, b.y, c.y), greatest(a.z, b.z, c.z)}};
  }

  /// @returns a bit for each triangle that has an area.
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t with_area() const {
    using L = Lanes<4>;
    const QuadRows e = difference(b, a), f = difference(c, a);
    const auto is_sure = [](CornerQuad p, CornerQuad q) GRIDIRON_INLINE_LAMBDA {
      return L::abs(p - q) > L::abs(p) * CornerQuad(CornerQuads::kShare) + CornerQuad(CornerQuads::kLeast);
    };
    const std::uint32_t sure =
        (is_sure(e.x * f.y, e.y * f.x) | is_sure(e.y * f.z, e.z * f.y) | is_sure(e.z * f.x, e.x * f.z)).bits();
    return sure == 15u ? sure : decide_areas(sure);
  }

 private:
  [[nodiscard]] static GRIDIRON_INLINE QuadRows difference(const QuadRows& p, const QuadRows& q) {
    return {p.x - q.x, p.y - q.y, p.z - q.z};
  }
  [[nodiscard]] GRIDIRON_RARE std::uint32_t decide_areas(std::uint32_t sure) const {
    // Of those with two equal corners nothing need be computed.
    const auto have_size = [](const QuadRows& edge) {
      using L = Lanes<4>;
      return L::Float(0.0f) < L::larger_size(L::larger_size(edge.x, edge.y), edge.z);
    };
    const std::uint32_t open =
        (have_size(difference(b, a)) & have_size(difference(c, a)) & have_size(difference(c, b))).bits() & ~sure;
    for (int lane = 0; lane < 4 && open != 0; ++lane) {
      const auto corner = [lane](const QuadRows& rows) {
        return Vec3(lane_of(rows.x, lane), lane_of(rows.y, lane), lane_of(rows.z, lane));
      };
      if ((open >> lane & 1u) != 0 && !has_zero_area(corner(a), corner(b), corner(c))) sure |= 1u << lane;
    }
    return sure;
  }
};

}  // namespace gridiron
