// Meshes and rays that need exact arithmetic: few hard triangles, or whole meshes with rays at their features.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/ray/packet.h>

#include "core/ray/packet_cases.h"
#include "numeric/oracle.h"
#include "support/test_mesh.h"

namespace gridiron::test {

/// A few triangles and 16 rays from one origin.
struct HardCase {
  TestMesh mesh;
  std::vector<OracleRay> rays;
};

/// packet_cases.h's triangles and rays: slivers, needles of one step, no area, repeated; rays at vertices and edges, in
/// planes, backwards. Here also on a lattice, where ties are the rule, at 2^-140..2^100 of the size, and with limits.
inline HardCase make_hard_case(std::uint64_t seed) {
  TestRandom random(seed);
  TriangleCase shown = random_triangles(random, 4);
  if (random.below(3) == 0) {  // multiples of 1/2 in [-2, 2]
    for (VertexTriangle& triangle : shown.triangles) {
      for (auto& corner : triangle.v) {
        for (float& value : corner) value = 0.5f * static_cast<float>(random.below(9)) - 2.0f;
      }
    }
    for (float& value : shown.origin) value = 0.5f * static_cast<float>(random.below(13)) - 3.0f;
  }
  if (random.below(4) == 0) {
    constexpr int kExponents[] = {-60, 60, -100, 40, -140, 20};
    int exponent = kExponents[random.below(6)];
    float largest = 0.0f;
    for (const VertexTriangle& triangle : shown.triangles) {
      for (const auto& corner : triangle.v) {
        for (const float value : corner) largest = std::fmax(largest, std::fabs(value));
      }
    }
    for (const float value : shown.origin) largest = std::fmax(largest, std::fabs(value));
    if (std::ilogb(largest) + exponent > 120) exponent = 120 - std::ilogb(largest);
    for (VertexTriangle& triangle : shown.triangles) {
      for (auto& corner : triangle.v) {
        for (float& value : corner) value = std::ldexp(value, exponent);
      }
    }
    for (float& value : shown.origin) value = std::ldexp(value, exponent);
  }
  HardCase result;
  for (const VertexTriangle& triangle : shown.triangles) {
    const auto first = static_cast<std::uint32_t>(result.mesh.vertices.size());
    for (const auto& corner : triangle.v) result.mesh.vertices.push_back({corner[0], corner[1], corner[2]});
    result.mesh.triangles.push_back({first, first + 1, first + 2});
  }
  Packet<4> packet{};
  aim_at(random, shown, packet);
  for (std::uint32_t i = 0; i < Packet<4>::kRayCount; ++i) {
    OracleRay ray{};
    for (int axis = 0; axis < 3; ++axis) {
      ray.origin[axis] = shown.origin[axis];
      ray.direction[axis] = packet.dir[axis][i];
    }
    // A length beyond all floats would not be a ray.
    if (!is_finite(ray.direction[0] + ray.direction[1] + ray.direction[2])) continue;
    if (random.below(4) == 0) ray.t_min = 0.5f + static_cast<float>(random.below(2));
    if (random.below(4) == 0) ray.t_max = 1.0f + static_cast<float>(random.below(2));
    result.rays.push_back(ray);
  }
  return result;
}

/// A mesh's triangle as the intersector takes it.
inline VertexTriangle triangle_of(const TestMesh& mesh, std::uint32_t id) {
  const UVec3& t = mesh.triangles[id];
  return vertex_triangle(mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z], id);
}

/// Where a ray is aimed.
enum class Aim : std::uint32_t { kVertex, kEdge, kInside, kAxis, kEdgeToEdge, kCount };

/// A ray from `origin` at a feature of a random triangle; of Aim::kEdgeToEdge, from a point of another edge.
inline OracleRay ray_at(const TestMesh& mesh, Vec3 origin, Aim aim, TestRandom& random) {
  const auto triangle_count = static_cast<std::uint32_t>(mesh.triangles.size());
  const auto corner = [&](const UVec3& t, std::uint32_t i) {
    return mesh.vertices[t[static_cast<int>(i % 3)]];
  };
  const auto edge_point = [&] {
    const UVec3& t = mesh.triangles[random.below(triangle_count)];
    const std::uint32_t first = random.below(3);
    const Vec3 a = corner(t, first);
    return a + random.unit() * (corner(t, first + 1) - a);
  };
  const UVec3& t = mesh.triangles[random.below(triangle_count)];
  const std::uint32_t first = random.below(3);
  Vec3 target = corner(t, first);
  if (aim == Aim::kEdge) target = edge_point();
  if (aim == Aim::kEdgeToEdge) {
    origin = edge_point();
    target = edge_point();
  }
  if (aim == Aim::kInside) {
    const float r = random.unit();
    const float s = random.unit() * (1.0f - r);
    target = target + r * (corner(t, first + 1) - target) + s * (corner(t, first + 2) - target);
  }
  Vec3 direction = target - origin;
  if (aim == Aim::kAxis) {
    const auto axis = static_cast<int>(random.below(3));
    const float length = direction[axis];
    origin = target;
    origin[axis] -= length;
    direction = Vec3(0.0f);
    direction[axis] = length;
  }
  return {{origin.x, origin.y, origin.z}, {direction.x, direction.y, direction.z}};
}

/// Appends rays from one random origin near a mesh, at its vertices, edges and insides, along axes, between edges.
inline void append_rays_at(const TestMesh& mesh, std::uint64_t seed, std::uint32_t count,
                           std::vector<OracleRay>& rays) {
  TestRandom random(seed);
  const auto vertex_count = static_cast<std::uint32_t>(mesh.vertices.size());
  const Vec3 a = mesh.vertices[random.below(vertex_count)];
  const Vec3 b = mesh.vertices[random.below(vertex_count)];
  const Vec3 origin = a + random.between(-1.0f, 2.0f) * (b - a);
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto aim = static_cast<Aim>(random.below(static_cast<std::uint32_t>(Aim::kCount)));
    rays.push_back(ray_at(mesh, origin, aim, random));
  }
}

}  // namespace gridiron::test
