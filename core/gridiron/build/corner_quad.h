// A triangle's corners in lanes, and its area by floats: for what goes over all triangles of a mesh.
// Internal header. Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/build/lattice.h>
#include <gridiron/build/triangle_records.h>
#include <gridiron/platform/status.h>
#include <gridiron/scene/mesh.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace gridiron {

/// Triangles ahead of those that are taken whose corners the caches are asked for; a multiple of four.
inline constexpr std::size_t kTrianglesAhead = 16;

/// x, y and z, and a number without meaning.
using CornerQuad = Lanes<4>::Float;

/// @returns the point; the last lane is 0.
[[nodiscard]] GRIDIRON_INLINE CornerQuad quad_of(const Vec3& point) {
  typedef double PointHalves __attribute__((vector_size(16)));
  static_assert(sizeof(Vec3) == 12);
  double first_two;  // one load of eight bytes; their pattern is no number
  __builtin_memcpy(&first_two, &point, sizeof first_two);
  const PointHalves low = {first_two, 0.0};
  const Lanes<4>::FloatVector high = {point.z, 0.0f, 0.0f, 0.0f};
  return CornerQuad(__builtin_shufflevector(reinterpret_cast<Lanes<4>::FloatVector>(low), high, 0, 1, 4, 5));
}
/// @returns a point that is not the last one; the last lane is a coordinate of the next one.
[[nodiscard]] GRIDIRON_INLINE CornerQuad inner_quad(std::span<const Vec3> points, std::size_t index) {
  Lanes<4>::FloatVector words;
  __builtin_memcpy(&words, reinterpret_cast<const std::byte*>(points.data()) + index * sizeof(Vec3), sizeof words);
  return CornerQuad(words);
}
[[nodiscard]] GRIDIRON_INLINE Vec3 vec3_of(CornerQuad quad) {
  return {quad.v[0], quad.v[1], quad.v[2]};
}

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

// --- Prefetch -----------------------------------------------------------------------------------------------------

[[nodiscard]] GRIDIRON_INLINE std::span<const Vec3> stored_vertices(const MeshView& mesh) {
  return mesh.vertices;
}
[[nodiscard]] GRIDIRON_INLINE std::span<const Vec3> stored_vertices(const LatticeMesh& mesh) {
  return mesh.vertices.vertices;
}
/// Asks the caches for a triangle's corners, whose indices may be wrong.
template <class Mesh>
GRIDIRON_INLINE void ask_for_corners(const Mesh& mesh, const UVec3& triangle) {
  const std::uint64_t vertices = reinterpret_cast<std::uintptr_t>(stored_vertices(mesh).data());
  for (int corner = 0; corner < 3; ++corner) {
    __builtin_prefetch(reinterpret_cast<const void*>(vertices + triangle[corner] * std::uint64_t{sizeof(Vec3)}));
  }
}

[[nodiscard]] GRIDIRON_INLINE bool are_below(const UVec3& indices, std::int64_t end) {
  return indices.x < end && indices.y < end && indices.z < end;
}
/// Whether a triangle's indices are right, and none is the last one.
template <class Mesh>
[[nodiscard]] GRIDIRON_INLINE bool are_inner(const Mesh& mesh, const UVec3& triangle) {
  return are_below(triangle, static_cast<std::int64_t>(mesh.vertices.size()) - 1);
}

// --- Triangles ----------------------------------------------------------------------------------------------------

/// The corners of a triangle.
struct CornerQuads {
  CornerQuad a, b, c;

  // Of the bound below.
  static constexpr Lanes<4>::FloatVector kShare = {0x1p-20f, 0x1p-20f, 0x1p-20f, 0x1p-20f};
  static constexpr Lanes<4>::FloatVector kLeast = {0x1p-140f, 0x1p-140f, 0x1p-140f, 0x1p-140f};

  /// @param triangle  its indices are right.
  template <class Mesh>
  [[nodiscard]] static GRIDIRON_INLINE CornerQuads of(const Mesh& mesh, const UVec3& triangle) {
    return {quad_of(mesh.vertices[triangle.x]), quad_of(mesh.vertices[triangle.y]), quad_of(mesh.vertices[triangle.z])};
  }
  /// The same with single loads, where no corner is the last vertex: see are_inner().
  [[nodiscard]] static GRIDIRON_INLINE CornerQuads inner(const MeshView& mesh, const UVec3& triangle) {
    return {inner_quad(mesh.vertices, triangle.x), inner_quad(mesh.vertices, triangle.y),
            inner_quad(mesh.vertices, triangle.z)};
  }
  [[nodiscard]] static GRIDIRON_INLINE CornerQuads inner(const LatticeMesh& mesh, const UVec3& triangle) {
    return of(mesh, triangle);
  }

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
    for (int lane = 0; lane < 4; ++lane) {
      if ((bits >> lane & 1u) != 0) continue;
      for (CornerQuad* row : {&low.x, &low.y, &low.z}) row->v[lane] = kFloatMax;
      for (CornerQuad* row : {&high.x, &high.y, &high.z}) row->v[lane] = -kFloatMax;
    }
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
      const auto corner = [lane](const QuadRows& rows) { return Vec3(rows.x.v[lane], rows.y.v[lane], rows.z.v[lane]); };
      if ((open >> lane & 1u) != 0 && !has_zero_area(corner(a), corner(b), corner(c))) sure |= 1u << lane;
    }
    return sure;
  }
};

/// Calls take(triangle number of the first, four triangles, bits of those that are there and have an area) for all
/// triangles of a mesh, in order.
///
/// Errors: kBadIndex.
template <class Mesh, class Take>
[[nodiscard]] GRIDIRON_INLINE Status for_each_four(const Mesh& mesh, Take&& take) {
  const std::size_t count = mesh.triangles.size();
  const auto vertex_count = static_cast<std::int64_t>(mesh.vertices.size());
  UVec3 last_four[4];
  for (std::size_t i = 0; i < count; i += 4) {
    const UVec3* four = &mesh.triangles[i];
    std::uint32_t there = 15u;
    if (count - i < 4) {
      there = (1u << (count - i)) - 1u;
      for (std::size_t k = 0; k < 4; ++k) last_four[k] = mesh.triangles[i + k < count ? i + k : count - 1];
      four = last_four;
    }
    if (i + kTrianglesAhead + 4 <= count) {
      const UVec3* const later = four + kTrianglesAhead;
      for (int k = 0; k < 4; ++k) ask_for_corners(mesh, later[k]);
    }
    CornerQuads corners[4];
    if (are_inner(mesh, four[0]) && are_inner(mesh, four[1]) && are_inner(mesh, four[2]) && are_inner(mesh, four[3])) {
      for (int k = 0; k < 4; ++k) corners[k] = CornerQuads::inner(mesh, four[k]);
    } else {
      for (int k = 0; k < 4; ++k) {
        if (!are_below(four[k], vertex_count)) return Status::kBadIndex;
        corners[k] = CornerQuads::of(mesh, four[k]);
      }
    }
    const FourTriangles triangles = FourTriangles::of(corners);
    take(static_cast<std::uint32_t>(i), triangles, triangles.with_area() & there);
  }
  return Status::kOk;
}

}  // namespace gridiron
