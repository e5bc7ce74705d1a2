// Rays that begin on surfaces: reflections and shadows on convex and in closed bodies, lights on surfaces, mirrors that
// face each other. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/exact_sum.h>
#include <gridiron/ray/secondary_origin.h>

#include "core/ray/packet_cases.h"
#include "numeric/hard_cases/shapes.h"
#include "numeric/hard_cases/trial.h"

namespace gridiron::test::hard {
namespace {

// A point on the surface where a ray hits it, lifted off, and what the ray was.
struct SurfacePoint {
  Vec3 point;
  Vec3 normal;  ///< towards where the ray came from, of length 1
  std::uint32_t triangle_id;
};

// Shoots features of a mesh from around a place and collects where it is hit: on faces that turn the outside, or the
// inside, to where the ray comes from. One that passes a silhouette's vertex exactly meets others there too.
std::vector<SurfacePoint> surface_points(const TestMesh& mesh, Vec3 middle, float room, bool is_inside,
                                         std::uint32_t count, std::uint64_t seed) {
  const Oracle oracle(mesh.view(), {.reading = Reading::kStandard});
  std::vector<SurfacePoint> points;
  for (const Rays& rays : salvo(mesh, middle, room, {kFeatures, count, 8, 0}, seed)) {
    for (std::size_t i = 0; i < rays.directions.size(); ++i) {
      const Vec3& d = rays.directions[i];
      const float origin[3] = {rays.origin.x, rays.origin.y, rays.origin.z}, dir[3] = {d.x, d.y, d.z};
      for (const std::uint32_t id : oracle.nearest(oracle_ray(rays, i)).float_ties) {
        const VertexTriangle triangle = triangle_of(mesh, id);
        const bool is_along = exact_volume_sign(origin, triangle.v[0], triangle.v[1], triangle.v[2]) > 0;
        if (is_along != is_inside) continue;
        WorkCounters work;
        const SecondaryOrigin begin = secondary_origin(triangle, origin, dir, false, work);
        float normal[3];
        set_up_normal(triangle, normal);
        points.push_back({{begin.point[0], begin.point[1], begin.point[2]},
                          (is_along ? -1.0f : 1.0f) * Vec3(normal[0], normal[1], normal[2]),
                          id});
        break;
      }
    }
  }
  return points;
}

// Directions from a surface: over the plane at random, and the most grazing ones.
std::vector<Vec3> directions_above(const Vec3& normal, TestRandom& random, std::uint32_t count) {
  std::vector<Vec3> directions;
  while (directions.size() < count) {
    Vec3 d = random_vec(random, 1.0f);
    const float along = d.x * normal.x + d.y * normal.y + d.z * normal.z;
    if (std::fabs(along) < 1e-3f) continue;
    if (along < 0.0f) d = -d;
    // Every third one leaves at an angle of 1e-2 to 1e-5.
    if (directions.size() % 3 == 2) d += (std::pow(10.0f, -2.0f - 3.0f * random.unit()) - std::fabs(along)) * normal;
    directions.push_back(d);
  }
  return directions;
}

// From outside of convex bodies nothing of them is hit again, from inside of closed ones something always is: at any
// offset, by every profile that promises it.
TEST(HardCase35, SecondaryRaysLeaveTheSurface) {
  const TestMesh octahedron = on_lattice(make_sphere(2, 4, 1.0f), 1.0f);
  Tally outside, inside;
  for (const float offset : {0.0f, 1e2f, 1e4f, 1e6f}) {
    SCOPED_TRACE(offset);
    const Vec3 place = offset * Vec3(1.0f, -0.7f, 0.3f);
    for (const TestMesh& body : {octahedron, make_box({-1, -0.5f, -0.75f}, {1, 0.5f, 0.75f})}) {
      const TestMesh mesh = moved(body, 64.0f, place);  // whole numbers, so that it stays convex
      const auto rays_of = [&](const TestMesh& stored, bool is_inside) {
        TestRandom random(35);
        const Vec3 from = is_inside ? place : place + Vec3(0, 0, 200);
        std::vector<Rays> all;
        for (const SurfacePoint& at :
             surface_points(stored, from, is_inside ? 16.0f : 100.0f, is_inside, times(3), 35)) {
          Rays rays{at.point};
          rays.directions = directions_above(at.normal, random, 12);
          // A light beyond the body: in the shadow, or not.
          rays.directions.push_back(place + random_vec(random, 200.0f) - rays.origin);
          if (!is_inside) rays.directions.pop_back();
          all.push_back(rays);
        }
        return all;
      };
      outside += shoot({.mesh = mesh, .aim = [&](const TestMesh& stored) { return rays_of(stored, false); }});
      inside += shoot({.mesh = mesh, .grade = Grade::kClosed, .aim = [&](const TestMesh& stored) {
                         return rays_of(stored, true);
                       }});
    }
  }
  EXPECT_EQ(outside.hits, 0u);
  EXPECT_EQ(inside.hits, inside.rays);
  EXPECT_GT(outside.rays, 1000u);
  EXPECT_GT(inside.rays, 1000u);
}

// Shadow rays to a light that lies on the surface, at the hit, at a vertex, where the ray itself begins: no direction
// is a miss, and t_far = 1 keeps what lies at the light itself.
TEST(HardCase36, LightOnTheSurface) {
  const TestMesh sphere = make_sphere(10, 13, 1.0f);
  const auto wanted_rays = [](const TestMesh& mesh) {
    std::vector<SurfacePoint> points = surface_points(mesh, Vec3(0.0f), 0.5f, true, times(6), 36);
    const std::vector<SurfacePoint> from_outside = surface_points(mesh, Vec3(0, 0, 3), 1.0f, false, times(6), 37);
    points.insert(points.end(), from_outside.begin(), from_outside.end());
    std::vector<Rays> all;
    TestRandom random(36);
    for (const SurfacePoint& at : points) {
      const SurfacePoint& other = points[random.below(static_cast<std::uint32_t>(points.size()))];
      const Vec3& vertex = mesh.vertices[random.below(static_cast<std::uint32_t>(mesh.vertices.size()))];
      const UVec3& t = mesh.triangles[at.triangle_id];
      Rays rays{at.point};
      rays.directions = {Vec3(0.0f),
                         other.point - at.point,
                         vertex - at.point,
                         mesh.vertices[t.x] - at.point,
                         (mesh.vertices[t.x] + mesh.vertices[t.y]) * 0.5f - at.point,
                         -0x1p-20f * at.normal};
      for (const float limit : {1.0f, std::nextafter(1.0f, 0.0f)}) {
        rays.t_far = limit;
        all.push_back(rays);
      }
    }
    return all;
  };
  const Tally tally = shoot({.mesh = sphere, .aim = wanted_rays});
  EXPECT_GT(tally.hits, tally.rays / 10);
  EXPECT_LT(tally.hits, tally.rays);
}

// Two mirrors that face each other, rays from steep to grazing: of 32 bounces all distances are numbers, no mirror is
// hit twice in a row, the light does not grow, and where the ray leaves the mirrors, it is gone.
TEST(HardCase37, ParallelMirrors) {
  std::uint64_t bounces = 0;
  for (const Profile& profile : kProfiles) {
    SCOPED_TRACE(profile.name);
    TestMesh mirrors;
    for (const float z : {0.0f, 1.0f}) {
      mirrors.append(make_triangle({-4096, -4096, z}, {4096, -4096, z}, {4096, 4096, z}));
      mirrors.append(make_triangle({-4096, -4096, z}, {4096, 4096, z}, {-4096, 4096, z}));
    }
    Target target(mirrors, {}, profile);
    ASSERT_EQ(target.status(), Status::kOk);
    TestRandom random(37);
    for (std::uint32_t chain = 0; chain < times(60); ++chain) {
      // Some along the diagonal, on which the triangles of a mirror meet.
      const float rise = std::pow(10.0f, -static_cast<float>(chain % 7) * 0.5f);
      Vec3 origin(0, 0, 0.5f), direction(1, chain % 2 == 0 ? 1.0f : random.between(-1, 1), rise);
      float light = 1.0f;
      std::uint32_t last_mirror = 2;
      for (int bounce = 0; bounce < 32; ++bounce) {
        const Rays ray = one_ray(origin, direction);
        const PipelineWay& way = pipeline_ways()[0];
        const Answer alone = target.by_intersector(ray, {4, 8, IntersectorWay::Order::kAscending})[0];
        const Answer seen = target.by_pipeline(ray, way)[0];
        ASSERT_TRUE(!profile.is_exact || alone.id == seen.id);
        if (alone.id == kNoTriangle) {
          // Gone beyond the mirrors' ends; or by a leak, where these are not excluded.
          const bool is_beyond =
              std::fabs(origin.x) + 1.0f / rise > 4095.0f || std::fabs(origin.y) + 1.0f / rise > 4095.0f;
          EXPECT_TRUE(is_beyond || !profile.is_exact) << "chain " << chain << ", bounce " << bounce;
          break;
        }
        ASSERT_TRUE(std::isfinite(alone.t) && alone.t > 0.0f);
        ASSERT_TRUE(std::isfinite(seen.t));
        const std::uint32_t mirror = alone.id / 2;
        ASSERT_TRUE(mirror != last_mirror) << "chain " << chain << ", bounce " << bounce;
        last_mirror = mirror;
        const float from[3] = {origin.x, origin.y, origin.z}, along[3] = {direction.x, direction.y, direction.z};
        WorkCounters work;
        const SecondaryOrigin begin = secondary_origin(triangle_of(target.mesh(), alone.id), from, along, false, work);
        origin = {begin.point[0], begin.point[1], begin.point[2]};
        ASSERT_TRUE(std::isfinite(origin.x + origin.y + origin.z));
        direction.z = -direction.z;
        light *= 0.95f;
        ASSERT_TRUE(light > 0.0f && light <= 1.0f);
        ++bounces;
      }
    }
  }
  EXPECT_GT(bounces, 5000u);
}

}  // namespace
}  // namespace gridiron::test::hard
