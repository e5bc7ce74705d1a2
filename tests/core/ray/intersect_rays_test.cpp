// Secondary rays against triangles: what they hit and where, by the oracle's integers; no ray leaves a closed mesh.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/ray/intersect_rays.h>

#include "core/lane_types.h"
#include "core/seeds.h"
#include "numeric/hard_rays.h"
#include "numeric/oracle.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

constexpr std::uint32_t kAll = (1u << kWalkRays) - 1;

template <class L>
class IntersectRaysTest : public testing::Test {};
TYPED_TEST_SUITE(IntersectRaysTest, WalkLaneTypes, LaneNames);

void set_ray(WalkRays& rays, std::uint32_t i, const OracleRay& ray) {
  rays.dir_max[i] = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    rays.origin[axis][i] = ray.origin[axis];
    rays.dir[axis][i] = ray.direction[axis];
    rays.dir_max[i] = std::fmax(rays.dir_max[i], std::fabs(ray.direction[axis]));
  }
  rays.t[i] = ray.t_max;
  rays.id[i] = kNoTriangle;
}

bool is_a_ray(const OracleRay& ray) {
  bool finite = true;
  for (int axis = 0; axis < 3; ++axis) finite = finite && is_finite(ray.origin[axis]) && is_finite(ray.direction[axis]);
  return finite;
}

// A hard case's rays, half of them with origins of their own: on vertices, on edges, in planes, in triangles, anywhere.
std::vector<OracleRay> hard_rays(const HardCase& hard, TestRandom& random) {
  std::vector<OracleRay> rays;
  while (rays.size() < kWalkRays) {
    OracleRay ray{};
    if (!hard.rays.empty() && random.below(2) == 0) {
      ray = hard.rays[random.below(static_cast<std::uint32_t>(hard.rays.size()))];
    } else {
      const auto corner = [&] {
        return hard.mesh.vertices[random.below(static_cast<std::uint32_t>(hard.mesh.vertices.size()))];
      };
      const UVec3& t = hard.mesh.triangles[random.below(static_cast<std::uint32_t>(hard.mesh.triangles.size()))];
      const Vec3 a = hard.mesh.vertices[t.x], b = hard.mesh.vertices[t.y], c = hard.mesh.vertices[t.z];
      Vec3 origin = a;
      const std::uint32_t place = random.below(6);
      const float r = random.unit(), s = random.unit() * (1.0f - r);
      if (place == 1) origin = a + r * (b - a);
      if (place == 2) origin = a + r * (b - a) + s * (c - a);
      if (place == 3) origin = a + 3.0f * r * (b - a) - 2.0f * s * (c - a);
      if (place >= 4) origin = a + (2.0f * r - 0.5f) * (corner() - a) + (2.0f * s - 0.5f) * (corner() - b);
      ray = ray_at(hard.mesh, origin, static_cast<Aim>(random.below(static_cast<std::uint32_t>(Aim::kCount))), random);
      if (random.below(6) == 0) {
        for (float& value : ray.direction) value = -value;
      }
    }
    ray.t_min = 0.0f;
    ray.t_max = kFloatMax;
    if (!is_a_ray(ray)) continue;
    rays.push_back(ray);
  }
  return rays;
}

// Distances of a mesh's triangles along a ray, by id; 0 where it misses.
std::vector<float> true_distances(const Oracle& oracle, const OracleRay& ray, std::size_t count) {
  std::vector<float> result(count, 0.0f);
  for (const OracleHit& hit : oracle.hits(ray)) {
    result[hit.triangle_id] = oracle.distance(ray, hit.triangle_id).rounded(Reading::kStandard);
  }
  return result;
}

// The rays that a triangle stops: those settled, and those left open whose distance is within their limit.
template <class L>
std::uint32_t rays_stopped(const WalkRays& rays, const VertexTriangle& triangle, bool trusts_floats,
                           WorkCounters& work) {
  std::uint32_t settled = 0;
  std::uint32_t open = rays_near<L>(rays, kAll, triangle, trusts_floats, settled, work);
  for (std::uint32_t rest = open; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
    const float t = ray_distance(rays, i, triangle, work);
    if (!(t > 0.0f && t <= rays.t[i])) open &= ~(1u << i);
  }
  return open | settled;
}

TYPED_TEST(IntersectRaysTest, DecideAsTheOracleDoes) {
  std::uint64_t hits = 0, settled_hits = 0, open_rays = 0, at_limit = 0, pairs = 0;
  WorkCounters work;
  for_each_seed(1500, [&](std::uint64_t seed) {
    TestRandom random(seed * 7919);
    const HardCase hard = make_hard_case(seed);
    const Oracle oracle(hard.mesh.view(), {.reading = Reading::kStandard});
    const std::vector<OracleRay> shot = hard_rays(hard, random);
    const std::size_t triangle_count = hard.mesh.triangles.size();
    WalkRays rays{};
    std::vector<std::vector<float>> distances;
    for (std::uint32_t i = 0; i < kWalkRays; ++i) {
      set_ray(rays, i, shot[i]);
      distances.push_back(true_distances(oracle, shot[i], triangle_count));
      // Limits: none, anywhere, at a hit or one float away from it.
      const float hit = distances[i][random.below(static_cast<std::uint32_t>(triangle_count))];
      const std::uint32_t limit = random.below(6);
      if (limit == 1) rays.t[i] = 0.5f + random.unit();
      if (hit > 0.0f && limit == 2) rays.t[i] = hit;
      if (hit > 0x1p-126f && limit == 3) rays.t[i] = std::nextafter(hit, 0.0f);
      if (hit > 0.0f && limit == 4) rays.t[i] = hit * 1.000001f < kFloatMax ? hit * 1.000001f : kFloatMax;
    }
    for (std::uint32_t id = 0; id < triangle_count; ++id) {
      const VertexTriangle triangle = triangle_of(hard.mesh, id);
      const std::uint32_t wanted = random.below(3) == 0 ? static_cast<std::uint32_t>(random.next()) & kAll : kAll;
      std::uint32_t settled = 0;
      const std::uint32_t open = rays_near<TypeParam>(rays, wanted, triangle, false, settled, work);
      ASSERT_EQ((open | settled) & ~wanted, 0u) << "triangle " << id;
      ASSERT_EQ(open & settled, 0u) << "triangle " << id;
      for (std::uint32_t i = 0; i < kWalkRays; ++i) {
        if ((wanted >> i & 1u) == 0) continue;
        const float truth = distances[i][id];
        if (truth == kFloatMax) continue;  // farther than all floats: may be a hit or none
        const bool is_hit = truth > 0.0f && truth <= rays.t[i];
        const bool is_settled = (settled >> i & 1u) != 0, is_open = (open >> i & 1u) != 0;
        ASSERT_FALSE(is_settled && !is_hit) << "triangle " << id << " ray " << i;
        const float found = is_settled || is_open ? ray_distance(rays, i, triangle, work) : 0.0f;
        if (is_settled || is_open) {
          ASSERT_EQ(found, truth) << "triangle " << id << " ray " << i;
        }
        ASSERT_EQ(is_settled || (is_open && found > 0.0f && found <= rays.t[i]), is_hit)
            << "triangle " << id << " ray " << i << " at " << truth << " of " << rays.t[i];
        ++pairs;
        hits += is_hit ? 1u : 0u;
        settled_hits += is_settled ? 1u : 0u;
        open_rays += is_open ? 1u : 0u;
        at_limit += truth == rays.t[i] ? 1u : 0u;
      }
      // Other lanes, the same answer.
      std::uint32_t other_settled = 0;
      ASSERT_EQ(rays_near<Lanes<4>>(rays, wanted, triangle, false, other_settled, work), open);
      ASSERT_EQ(other_settled, settled);
    }
  });
  if (testing::Test::HasFailure() || !all_seeds_run()) return;
  EXPECT_GT(pairs, 50'000u);
  EXPECT_GT(hits, 5'000u);
  EXPECT_GT(settled_hits, 1'000u);
  EXPECT_GT(open_rays, 1'000u);
  EXPECT_GT(at_limit, 500u);
  EXPECT_GT(work[Work::kExactDistance], 0u);
}

// Plain scenes: floats settle nearly all, or the filter would be none.
TYPED_TEST(IntersectRaysTest, FloatsSettleNearlyAll) {
  std::uint64_t hits = 0, settled_hits = 0;
  WorkCounters work;
  const TestMesh mesh = make_random_soup(60, 0.5f, 11);
  const Oracle oracle(mesh.view(), {.reading = Reading::kStandard});
  TestRandom random(12);
  for (std::uint32_t round = 0; round < 60; ++round) {
    WalkRays rays{};
    std::vector<OracleRay> shot;
    for (std::uint32_t i = 0; i < kWalkRays; ++i) {
      const Vec3 origin = random_vec(random, 2.0f);
      shot.push_back(ray_at(mesh, origin, Aim::kInside, random));
      shot[i].t_max = random.below(2) != 0 ? kFloatMax : 0.5f + 2.0f * random.unit();
      set_ray(rays, i, shot[i]);
    }
    for (std::uint32_t id = 0; id < 60; ++id) {
      std::uint32_t settled = 0;
      const std::uint32_t open = rays_near<TypeParam>(rays, kAll, triangle_of(mesh, id), false, settled, work);
      settled_hits += static_cast<std::uint32_t>(std::popcount(settled));
      for (std::uint32_t i = 0; i < kWalkRays; ++i) {
        const bool is_hit = true_distances(oracle, shot[i], 60)[id] > 0.0f;
        hits += is_hit ? 1u : 0u;
        ASSERT_TRUE(is_hit || (settled >> i & 1u) == 0);
        ASSERT_TRUE(!is_hit || ((open | settled) >> i & 1u) != 0);
      }
    }
  }
  EXPECT_GT(hits, 1000u);
  EXPECT_GT(settled_hits, hits - hits / 10);
}

// Where floats are trusted: rays well inside hit, rays well outside do not, at any scale that floats reach.
TYPED_TEST(IntersectRaysTest, TrustedFloatsAreRightAwayFromEdges) {
  std::uint64_t inside = 0, outside = 0;
  WorkCounters work;
  TestRandom random(21);
  for (std::uint32_t round = 0; round < 3000; ++round) {
    const float scale = std::ldexp(1.0f, static_cast<int>(random.below(41)) - 20);
    const TestMesh mesh = make_random_soup(1, 1.0f, random.next());
    const Vec3 a = mesh.vertices[0] * scale, b = mesh.vertices[1] * scale, c = mesh.vertices[2] * scale;
    const Vec3 n = {(b - a).y * (c - a).z - (b - a).z * (c - a).y, (b - a).z * (c - a).x - (b - a).x * (c - a).z,
                    (b - a).x * (c - a).y - (b - a).y * (c - a).x};
    const float area = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z) / (scale * scale);
    if (area < 0.05f) continue;
    const VertexTriangle triangle = vertex_triangle(a, b, c, 0);
    WalkRays rays{};
    std::uint32_t expected = 0;
    for (std::uint32_t i = 0; i < kWalkRays; ++i) {
      float r = random.between(0.05f, 0.9f), s = random.between(0.05f, 0.95f - r);
      const bool hits = random.below(2) != 0;
      if (!hits) r = random.below(2) != 0 ? -0.05f - random.unit() : 1.05f + random.unit();
      const Vec3 target = a + r * (b - a) + s * (c - a);
      const Vec3 origin = target + n * (random.between(0.5f, 2.0f) / (scale * area)) + random_vec(random, 0.3f * scale);
      OracleRay ray{{origin.x, origin.y, origin.z}, {}};
      for (int axis = 0; axis < 3; ++axis) ray.direction[axis] = target[axis] - origin[axis];
      ray.t_max = random.below(2) != 0 ? 1.001f : kFloatMax;
      if (hits && random.below(4) == 0) ray.t_max = 0.999f;  // ends before it
      set_ray(rays, i, ray);
      expected |= hits && ray.t_max > 1.0f ? 1u << i : 0u;
      (hits ? inside : outside) += 1;
    }
    ASSERT_EQ(rays_stopped<TypeParam>(rays, triangle, true, work), expected) << "round " << round;
  }
  EXPECT_GT(inside, 10'000u);
  EXPECT_GT(outside, 10'000u);
}

TYPED_TEST(IntersectRaysTest, NothingIsHitWithoutADirectionOrAnArea) {
  WorkCounters work;
  const VertexTriangle triangle = vertex_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
  const VertexTriangle line = vertex_triangle({0, 0, 0}, {1, 1, 0}, {2, 2, 0}, 1);
  const VertexTriangle point = vertex_triangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 2);
  WalkRays rays{};
  for (std::uint32_t i = 0; i < kWalkRays; ++i) {
    OracleRay ray{{0.25f, 0.25f, 1.0f}, {0, 0, 0}};
    if (i == 1) ray = {{0, 0, 1}, {0, 0, -1}};              // at a corner
    if (i == 2) ray = {{0.5f, 0.5f, 1}, {0, 0, -1}};        // at the edge, and at the line
    if (i == 3) ray = {{-1, 0.25f, 0}, {1, 0, 0}};          // in the plane
    if (i == 4) ray = {{0.25f, 0.25f, 0}, {0, 0, 1}};       // from within it
    if (i == 5) ray = {{0.25f, 0.25f, 1}, {0, 0, 1}};       // away from it
    set_ray(rays, i, ray);
  }
  EXPECT_EQ(rays_stopped<TypeParam>(rays, triangle, false, work), 1u << 1 | 1u << 2);
  EXPECT_EQ(rays_stopped<TypeParam>(rays, line, false, work), 0u);
  EXPECT_EQ(rays_stopped<TypeParam>(rays, point, false, work), 0u);
}

// A closed mesh and what lies inside it, well away from its faces.
struct Body {
  TestMesh mesh;
  std::uint32_t kind;  // box, sphere, torus

  [[nodiscard]] Vec3 inside(TestRandom& random) const {
    if (kind == 0) return random_vec(random, 0.9f);
    if (kind == 1) return random_vec(random, 0.45f);
    const float angle = 6.2831853f * random.unit();
    return Vec3(std::cos(angle), 0.0f, std::sin(angle)) + random_vec(random, 0.1f);
  }
};

TYPED_TEST(IntersectRaysTest, NoRayLeavesAClosedMesh) {
  const Body bodies[] = {{make_box({-1, -1, -1}, {1, 1, 1}), 0},
                         {make_sphere(7, 9, 1.0f), 1},
                         {make_torus(10, 7, 1.0f, 0.4f), 2}};
  const struct {
    int exponent;
    Vec3 offset;
  } places[] = {{0, {0, 0, 0}}, {0, {100, -37, 13}}, {-60, {0, 0, 0}}, {60, {0, 0, 0}}, {0, {3000, 3000, -3000}}};
  std::uint64_t rays_shot = 0, leaks = 0, doubles = 0;
  WorkCounters work;
  TestRandom random(31 + TypeParam::kCount);
  for (const Body& body : bodies) {
    for (const auto& place : places) {
      TestMesh mesh = body.mesh;
      const auto put = [&](const Vec3& v) { return (v + place.offset) * std::ldexp(1.0f, place.exponent); };
      for (Vec3& vertex : mesh.vertices) vertex = put(vertex);
      std::vector<VertexTriangle> triangles;
      for (std::uint32_t id = 0; id < mesh.triangles.size(); ++id) triangles.push_back(triangle_of(mesh, id));
      for (std::uint32_t round = 0; round < 300; ++round) {
        WalkRays rays{};
        const int stretch = random.below(3) == 0 ? static_cast<int>(random.below(41)) - 20 : 0;
        for (std::uint32_t i = 0; i < kWalkRays; ++i) {
          const Aim aim = random.below(2) != 0 ? Aim::kVertex : Aim::kEdge;
          OracleRay ray = ray_at(mesh, put(body.inside(random)), aim, random);
          for (float& value : ray.direction) value = std::ldexp(value, stretch);
          set_ray(rays, i, ray);
        }
        std::uint32_t stopped = 0, twice = 0;
        for (const VertexTriangle& triangle : triangles) {
          const std::uint32_t now = rays_stopped<TypeParam>(rays, triangle, false, work);
          twice |= stopped & now;
          stopped |= now;
        }
        rays_shot += kWalkRays;
        leaks += static_cast<std::uint32_t>(std::popcount(kAll & ~stopped));
        doubles += static_cast<std::uint32_t>(std::popcount(twice));
      }
    }
  }
  EXPECT_GE(rays_shot, 70'000u);  // with each width of lanes
  EXPECT_EQ(leaks, 0u);
  EXPECT_GT(doubles, rays_shot / 50) << "rays at edges that more than one triangle stops";
}

}  // namespace
}  // namespace gridiron::test
