// Rays and triangles that are hard for a ray/triangle test, and what exact arithmetic says of them.
// Memory: values, std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/exact_sum.h>
#include <gridiron/base/records.h>
#include <gridiron/ray/packet.h>

#include "support/test_mesh.h"

namespace gridiron::test {

/// Distance of a ray's hit by accuracy `standard`, decided in integers; 0 where the ray misses.
inline float true_distance(const float origin[3], const float direction[3], const VertexTriangle& triangle) {
  const float* a = triangle.v[0];
  const float* b = triangle.v[1];
  const float* c = triangle.v[2];
  const int side[3] = {exact_edge_sign(origin, direction, a, b), exact_edge_sign(origin, direction, b, c),
                       exact_edge_sign(origin, direction, c, a)};
  const bool positive = side[0] > 0 || side[1] > 0 || side[2] > 0;
  const bool negative = side[0] < 0 || side[1] < 0 || side[2] < 0;
  return positive != negative ? exact_distance(origin, direction, a, b, c) : 0.0f;
}

/// The direction of one of the rays of a packet.
template <class PacketType>
std::array<float, 3> direction_of(const PacketType& packet, std::uint32_t ray) {
  return {packet.dir[0][ray], packet.dir[1][ray], packet.dir[2][ray]};
}
template <class PacketType>
float true_distance(const PacketType& packet, std::uint32_t ray, const VertexTriangle& triangle) {
  return true_distance(packet.origin, direction_of(packet, ray).data(), triangle);
}

/// One origin and some triangles around it.
struct TriangleCase {
  float origin[3];
  std::vector<VertexTriangle> triangles;
};

enum class ShapeKind : std::uint32_t { kPlain, kSliver, kNeedle, kNoArea, kAxisAligned, kCount };
enum class PlaceKind : std::uint32_t { kBeside, kFar, kOnVertex, kOnEdge, kInPlane, kZero, kCount };

inline Vec3 random_vec(TestRandom& random, float scale) {
  const float x = random.between(-1, 1);
  const float y = random.between(-1, 1);
  const float z = random.between(-1, 1);
  return Vec3(x, y, z) * scale;
}

inline VertexTriangle vertex_triangle(Vec3 a, Vec3 b, Vec3 c, std::uint32_t id) {
  return {{{a.x, a.y, a.z}, {b.x, b.y, b.z}, {c.x, c.y, c.z}}, {}, id};
}
/// The three numbers of a corner, an origin or a direction.
inline Vec3 vec_of(const float v[3]) {
  return {v[0], v[1], v[2]};
}

/// Triangles of one size and place, some twice under other ids and turned round, some sharing an edge with the one
/// before.
inline TriangleCase random_triangles(TestRandom& random, std::uint32_t count) {
  constexpr float kScales[] = {1.0f, 1.0f, 1.0f, 1e-30f, 1e-23f, 1e-15f, 1e15f, 1e19f};
  const float scale = kScales[random.below(8)];
  const Vec3 offset = random.below(4) == 0
                          ? random_vec(random, scale * std::ldexp(1.0f, static_cast<int>(random.below(24))))
                          : Vec3(0.0f);
  TriangleCase result{};
  Vec3 last_b(0.0f), last_c(0.0f);
  for (std::uint32_t i = 0; i < count; ++i) {
    Vec3 a = offset + random_vec(random, scale);
    Vec3 b = offset + random_vec(random, scale);
    Vec3 c = offset + random_vec(random, scale);
    if (i > 0 && random.below(3) == 0) {  // shares an edge
      a = last_c;
      b = last_b;
    }
    const auto shape = static_cast<ShapeKind>(random.below(2 * static_cast<std::uint32_t>(ShapeKind::kCount)));
    if (shape == ShapeKind::kSliver) {  // aspects from 1e2 to 1e8
      const float width = std::pow(10.0f, -2.0f - 6.0f * random.unit());
      c = a + random.unit() * (b - a) + random_vec(random, scale * width);
    } else if (shape == ShapeKind::kNeedle) {
      b = a;
      const auto axis = static_cast<int>(random.below(3));
      b[axis] = std::nextafter(b[axis], scale);
    } else if (shape == ShapeKind::kNoArea) {
      if (random.below(2) != 0) {
        c = random.below(2) != 0 ? a : b;
      } else {  // collinear without rounding
        a = Vec3(1, 2, -3) * scale;
        b = 2.0f * a;
        c = 4.0f * a;
      }
    } else if (shape == ShapeKind::kAxisAligned) {
      const auto axis = static_cast<int>(random.below(3));
      b[axis] = c[axis] = a[axis];
    }
    result.triangles.push_back(vertex_triangle(a, b, c, 10 * i + random.below(10)));
    if (random.below(4) == 0) {  // again, turned round or over
      const bool over = random.below(2) != 0;
      const std::uint32_t id = 10 * i + random.below(10);
      result.triangles.push_back(over ? vertex_triangle(b, a, c, id) : vertex_triangle(c, b, a, id));
    }
    last_b = b;
    last_c = c;
  }
  const VertexTriangle& seen = result.triangles[random.below(static_cast<std::uint32_t>(result.triangles.size()))];
  const Vec3 a = vec_of(seen.v[0]), b = vec_of(seen.v[1]), c = vec_of(seen.v[2]);
  Vec3 origin = offset + random_vec(random, 3.0f * scale);
  switch (static_cast<PlaceKind>(random.below(2 * static_cast<std::uint32_t>(PlaceKind::kCount)))) {
    case PlaceKind::kFar:
      origin = offset + random_vec(random, scale * 1e7f);
      break;
    case PlaceKind::kOnVertex:
      origin = a;
      break;
    case PlaceKind::kOnEdge:
      origin = 0.5f * a + 0.5f * b;
      break;
    case PlaceKind::kInPlane:
      origin = a + 2.0f * (b - a) + random.unit() * (c - a);
      break;
    case PlaceKind::kZero:
      origin = Vec3(0.0f, -0.0f, 0.0f);
      break;
    default:
      break;
  }
  for (int axis = 0; axis < 3; ++axis) result.origin[axis] = origin[axis];
  return result;
}

inline bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

/// Fills the data about a packet's directions as a whole, and requests exact distances.
template <class PacketType>
void set_direction_bounds(PacketType& packet) {
  packet.dir_max = 0.0f;
  for (const auto& component : packet.dir) {
    for (const float value : component) packet.dir_max = std::fmax(packet.dir_max, std::fabs(value));
  }
  packet.range_factor = std::fmax(packet.dir_max, 1.0f);
  packet.ask_for_distances(true);
}

template <class PacketType>
void reset_hits(PacketType& packet) {
  std::ranges::fill(packet.t, kFloatMax);
  std::ranges::fill(packet.id, kNoTriangle);
  std::ranges::fill(packet.facing, -1.0f);
}
/// To be called when a packet's directions stand: all its rays are to be traced, and none has hit.
template <class PacketType>
void start_all(PacketType& packet) {
  set_direction_bounds(packet);
  packet.active.fill();
  reset_hits(packet);
}

/// Directions at vertices, edges and insides of the triangles, in their planes, backwards, past them; of any length.
/// All rays are to be traced, and none has hit.
template <class PacketType>
void aim_at(TestRandom& random, const TriangleCase& shown, PacketType& packet) {
  const Vec3 origin = vec_of(shown.origin);
  // By powers of two, so that the aim stays: as it comes, or to a length that has nothing to do with the triangles'.
  constexpr int kExponents[] = {0, 60, -60, -100, 100};
  const std::uint32_t stretch = random.below(10);
  for (std::uint32_t ray = 0; ray < PacketType::kRayCount; ++ray) {
    const VertexTriangle& target = shown.triangles[random.below(static_cast<std::uint32_t>(shown.triangles.size()))];
    const std::uint32_t first = random.below(3);
    const float s = random.unit();
    const float r = random.unit() * (1.0f - s);
    const Vec3 p = vec_of(target.v[first]);
    const Vec3 along = vec_of(target.v[(first + 1) % 3]) - p;
    const Vec3 across = vec_of(target.v[(first + 2) % 3]) - p;
    Vec3 direction = p + s * along + r * across - origin;
    switch (random.below(10)) {
      case 0:
      case 1:
        direction = p - origin;
        break;
      case 2:
      case 3:
        direction = p + s * along - origin;
        break;
      case 4:
        direction = s * along + r * across;
        break;
      case 5:
        direction = -direction;
        break;
      case 6:
        direction[static_cast<int>(random.below(3))] = random.below(2) != 0 ? 0.0f : -0.0f;
        break;
      case 7:
        direction = p + (2.0f * s) * along + (2.0f * r) * across - origin;
        break;
      default:
        break;
    }
    float size = 0.0f;
    for (int axis = 0; axis < 3; ++axis) size = std::fmax(size, std::fabs(direction[axis]));
    for (int axis = 0; axis < 3; ++axis) {
      float value = direction[axis];
      if (stretch < 5 && size > 0.0f) value = std::ldexp(value, kExponents[stretch] - std::ilogb(size));
      packet.dir[axis][ray] = value;
    }
  }
  start_all(packet);
  std::ranges::copy(shown.origin, packet.origin);
}

}  // namespace gridiron::test
