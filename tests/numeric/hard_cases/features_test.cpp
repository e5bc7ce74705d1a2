// Rays at features: through edges and vertices, along edges and in planes, edge-on. SPDX-License-Identifier: Apache-2.0
#include <glm/geometric.hpp>

#include "numeric/hard_cases/shapes.h"
#include "numeric/hard_cases/trial.h"

namespace gridiron::test::hard {
namespace {

// From inside of closed meshes: a salvo, and pictures whose pixels are the eighths of triangles.
Tally shoot_from_inside(const std::vector<Solid>& targets, const Salvo& count, std::uint64_t seed) {
  Tally tally;
  for (const Solid& solid : targets) {
    SCOPED_TRACE(solid.name);
    EXPECT_TRUE(is_closed(solid.mesh));
    const auto add = [&](std::vector<Rays>& all, std::uint32_t, TestRandom& random, const TestMesh& mesh) {
      const auto triangle = random.below(static_cast<std::uint32_t>(mesh.triangles.size()));
      const Rays one = picture_of_triangle(mesh, triangle, solid.middle);
      if (are_rays(one)) all.push_back(one);
    };
    tally += shoot({.mesh = solid.mesh,
                    .grade = Grade::kClosed,
                    .aim = all_of({salvo_at(solid.middle, solid.room, count, seed), rounds(6, seed, add)})});
  }
  EXPECT_EQ(tally.hits, tally.rays);
  return tally;
}

TEST(HardCase01, RayThroughSharedEdge) {
  const Tally tally = shoot_from_inside(solids(), {{Aim::kEdge}, times(16), 40, 1}, 1);
  EXPECT_GT(tally.rays, 20000u);
  EXPECT_GT(tally.ties, 1000u);
}

// Three triangles at a vertex, four and five, two hundred; the poles also from where the ray runs along the axis.
TEST(HardCase02, RayThroughSharedVertex) {
  std::vector<Solid> targets = solids();
  targets.push_back({"tetrahedron",
                     {{{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}}, {{0, 1, 3}, {0, 2, 1}, {0, 3, 2}, {1, 2, 3}}},
                     Vec3(0.0f),
                     0.25f});
  targets.push_back({"octahedron", on_lattice(make_sphere(2, 4, 1.0f), 1.0f), Vec3(0.0f), 0.3f});
  targets.push_back({"sphere of 200 segments", make_sphere(5, 200, 1.0f), Vec3(0.0f), 0.5f});
  Tally tally = shoot_from_inside(targets, {{Aim::kVertex}, times(5), 40, 1}, 2);
  const TestMesh sphere = make_sphere(5, 200, 1.0f);
  const auto add = [](std::vector<Rays>& all, std::uint32_t i, TestRandom& random, const TestMesh& mesh) {
    Vec3 origin = i < 4 ? Vec3(0.0f) : random_vec(random, 0.5f);
    if (i % 3 == 0) origin.x = origin.z = 0.0f;
    Rays at_poles{origin};
    for (const Vec3& pole : {mesh.vertices.front(), mesh.vertices.back()}) {
      at_poles.directions.push_back(pole - origin);
      const float step = std::ldexp(1.0f, -24 + static_cast<int>(i % 8));
      all.push_back(picture(origin, pole - origin - Vec3(8 * step, 0, 8 * step), {step, 0, 0}, {0, 0, step}, 17, 17));
    }
    all.push_back(at_poles);
  };
  tally += shoot({.mesh = sphere, .grade = Grade::kClosed, .aim = rounds(10, 2, add)});
  EXPECT_EQ(tally.hits, tally.rays);
  EXPECT_GT(tally.rays, 15000u);
  EXPECT_GT(tally.ties, 1000u);
}

// Cubes on whole numbers, from points and in directions of few bits: rays run along edges and in the planes of faces,
// and end where other faces meet them. And along edges of all solids, from outside.
TEST(HardCase03, RayAlongEdgeAndInPlane) {
  const auto whole = [](TestRandom& random, std::uint32_t most) {
    return static_cast<float>(random.below(2 * most + 1)) - static_cast<float>(most);
  };
  Tally inside;
  for (std::uint64_t seed = 1; seed <= times(2); ++seed) {
    const TestMesh cubes = make_cubes(6, seed);
    ASSERT_TRUE(is_closed(cubes));
    const auto aim = [&](const TestMesh&) {
      TestRandom random(seed);
      std::vector<Rays> all;
      for (std::uint32_t i = 0; i < 8; ++i) {
        Rays rays{Vec3(3.0f)};
        if (i % 2 == 1) rays.origin += Vec3(whole(random, 1), whole(random, 1), whole(random, 1)) * 0.5f;
        while (rays.directions.size() < 64) {
          Vec3 d(whole(random, 3), whole(random, 3), whole(random, 3));
          if (random.below(2) == 0) d[static_cast<int>(random.below(3))] = 0.0f;
          if (d != Vec3(0.0f)) rays.directions.push_back(d);
        }
        all.push_back(rays);
        // Pictures in whole steps; one pixel has no direction where they pass the origin.
        const float k = 0.5f + static_cast<float>(random.below(3));
        all.push_back(picture(rays.origin, {-3, -3, k}, {0.5f, 0, 0}, {0, 0.5f, 0}, 13, 13));
        all.push_back(picture(rays.origin, {k, -2, 0}, {0, 0.25f, 0}, {0, 0, 0x1p-20f}, 17, 8));
      }
      return all;
    };
    inside += shoot({.mesh = cubes, .grade = Grade::kClosed, .aim = aim});
  }
  EXPECT_EQ(inside.hits, inside.rays);
  EXPECT_GT(inside.ties, inside.rays / 4);
  Tally outside;
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.name);
    const auto add = [&](std::vector<Rays>& all, std::uint32_t i, TestRandom& random, const TestMesh& mesh) {
      const UVec3& t = mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
      const Vec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
      const Vec3 d = i % 2 == 0 ? b - a : (b - a) + 0.5f * (c - a);
      all.push_back(one_ray(a - 2.0f * d, d));
    };
    outside += shoot({.mesh = solid.mesh, .aim = rounds(120, 3, add)});
  }
  EXPECT_GT(outside.hits, outside.rays / 4);
}

// Rays that rise by 1e-1 to 1e-8 above the plane of the triangle they aim at.
TEST(HardCase04, TriangleEdgeOn) {
  const TestMesh soup = make_random_soup(40, 0.5f, 4);
  const auto add = [](std::vector<Rays>& all, std::uint32_t i, TestRandom& random, const TestMesh& mesh) {
    const UVec3& t = mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
    const DVec3 a(mesh.vertices[t.x]), b(mesh.vertices[t.y]), c(mesh.vertices[t.z]);
    const DVec3 normal =
        glm::cross(b - a, c - a) / std::sqrt(glm::dot(glm::cross(b - a, c - a), glm::cross(b - a, c - a)));
    const DVec3 along = double{random.between(-1, 1)} * (b - a) + double{random.between(-1, 1)} * (c - a);
    const double rise = std::pow(10.0, -1.0 - static_cast<double>(i % 8)) * std::sqrt(glm::dot(along, along));
    const DVec3 d = along + rise * normal;
    const DVec3 target = a + 0.3 * (b - a) + 0.3 * (c - a);
    all.push_back(one_ray(Vec3(target - 2.0 * d), Vec3(d)));
  };
  const Tally tally = shoot({.mesh = soup, .grade = Grade::kTie, .aim = rounds(1600, 4, add)});
  EXPECT_GT(tally.hits, tally.rays / 2);
}

}  // namespace
}  // namespace gridiron::test::hard
