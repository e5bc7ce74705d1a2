// The oracle against rational numbers without any shortcut, and against itself without its shortcuts.
// SPDX-License-Identifier: Apache-2.0
#include "numeric/oracle.h"

#include "core/seeds.h"
#include "numeric/hard_rays.h"
#include "numeric/rounding_scope.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using RationalVec = std::array<Rational, 3>;

RationalVec rational(const float* v) {
  return {exact_rational(v[0]), exact_rational(v[1]), exact_rational(v[2])};
}
RationalVec minus(const RationalVec& a, const RationalVec& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
RationalVec cross(const RationalVec& a, const RationalVec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Rational dot(const RationalVec& a, const RationalVec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Distance of the point in which a line meets a triangle, by way of that point: no signs of edges.
std::optional<Rational> naive_distance(const OracleRay& ray, const TestMesh& mesh, std::size_t triangle) {
  const UVec3& t = mesh.triangles[triangle];
  const RationalVec a = rational(&mesh.vertices[t.x].x);
  const RationalVec b = rational(&mesh.vertices[t.y].x);
  const RationalVec c = rational(&mesh.vertices[t.z].x);
  const RationalVec origin = rational(ray.origin);
  const RationalVec direction = rational(ray.direction);
  const RationalVec normal = cross(minus(b, a), minus(c, a));
  const Rational slope = dot(direction, normal);
  if (slope == 0) return std::nullopt;
  const Rational distance = dot(minus(a, origin), normal) / slope;
  RationalVec p;
  for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = origin[axis] + distance * direction[axis];
  if (dot(cross(minus(b, a), minus(p, a)), normal) < 0) return std::nullopt;
  if (dot(cross(minus(c, b), minus(p, b)), normal) < 0) return std::nullopt;
  if (dot(cross(minus(a, c), minus(p, c)), normal) < 0) return std::nullopt;
  return distance;
}

std::vector<std::uint32_t> ids_of(const std::vector<OracleHit>& hits) {
  std::vector<std::uint32_t> ids;
  for (const OracleHit& hit : hits) ids.push_back(hit.triangle_id);
  return ids;
}

OracleRay ray_of(Vec3 origin, Vec3 direction) {
  return {{origin.x, origin.y, origin.z}, {direction.x, direction.y, direction.z}};
}

using Ids = std::vector<std::uint32_t>;

TEST(Oracle, IsWhatRationalNumbersSay) {
  std::uint64_t hit_count = 0, tie_count = 0, pair_count = 0, rounding_ties = 0;
  for_each_seed(1200, [&](std::uint64_t seed) {
    const HardCase hard = make_hard_case(seed);
    const Oracle oracle(hard.mesh.view());
    for (const OracleRay& ray : hard.rays) {
      Ids wanted, nearest;
      std::optional<Rational> least;
      std::vector<Rational> distances;
      for (std::size_t i = 0; i < hard.mesh.triangles.size(); ++i) {
        ++pair_count;
        const std::optional<Rational> t = naive_distance(ray, hard.mesh, i);
        if (!t || *t <= exact_rational(ray.t_min) || *t > exact_rational(ray.t_max)) continue;
        wanted.push_back(static_cast<std::uint32_t>(i));
        distances.push_back(*t);
        if (least && *t > *least) continue;
        if (!least || *t < *least) nearest.clear();
        least = t;
        nearest.push_back(static_cast<std::uint32_t>(i));
      }
      const std::vector<OracleHit> hits = oracle.hits(ray);
      ASSERT_EQ(ids_of(hits), wanted) << "seed " << seed;
      for (std::size_t i = 0; i < hits.size(); ++i) {
        ASSERT_EQ(oracle.distance(ray, hits[i].triangle_id).rational(), distances[i]) << "seed " << seed;
        ASSERT_LE(Rational(hits[i].low), distances[i]) << "seed " << seed;
        ASSERT_GE(Rational(hits[i].high), distances[i]) << "seed " << seed;
      }
      const NearestHit found = oracle.nearest(ray);
      ASSERT_EQ(found.ties, nearest) << "seed " << seed;
      hit_count += hits.size();
      tie_count += nearest.size() > 1;
      if (!least) {
        ASSERT_EQ(found.t, kFloatMax);
        ASSERT_TRUE(found.float_ties.empty());
        continue;
      }
      const float t = oracle.distance(ray, nearest[0]).rounded(Reading::kExact);
      ASSERT_EQ(found.t, t) << "seed " << seed;
      Ids same;
      for (const std::uint32_t id : wanted) {
        if (oracle.distance(ray, id).rounded(Reading::kExact) == t) same.push_back(id);
      }
      ASSERT_EQ(found.float_ties, same) << "seed " << seed;
      rounding_ties += same.size() > nearest.size();
    }
  });
  if (std::getenv("GRIDIRON_TEST_SEED") != nullptr) return;
  EXPECT_GT(pair_count, 90000u);
  EXPECT_GT(hit_count, 10000u);
  EXPECT_GT(tie_count, 1000u);
  EXPECT_GT(rounding_ties, 10u);
}

TEST(Oracle, FilterAndBoxesChangeNothing) {
  OracleCounts fast, slow;
  for (const Reading reading : {Reading::kExact, Reading::kStandard}) {
    for_each_seed(3300, [&](std::uint64_t seed) {
      const HardCase hard = make_hard_case(100000 + seed);
      const Oracle filtered(hard.mesh.view(), {.reading = reading});
      const Oracle plain(hard.mesh.view(), {.reading = reading, .use_filter = false, .use_boxes = false});
      for (const OracleRay& ray : hard.rays) {
        ASSERT_EQ(ids_of(filtered.hits(ray, &fast)), ids_of(plain.hits(ray, &slow))) << "seed " << seed;
        ASSERT_EQ(filtered.nearest(ray, &fast), plain.nearest(ray, &slow)) << "seed " << seed;
      }
    });
  }
  EXPECT_EQ(fast.rays, slow.rays);
  if (std::getenv("GRIDIRON_TEST_SEED") != nullptr) return;
  EXPECT_GT(fast.rays, 200000u);
  EXPECT_LT(fast.exact_sides * 4, slow.exact_sides);
  EXPECT_LT(fast.pairs, slow.pairs);
}

TEST(Oracle, BoxesAndThreadsChangeNothingOnWholeMeshes) {
  std::vector<TestMesh> meshes = {make_sphere(12, 17, 1.0f), make_height_field(12, 0.2f, 3),
                                  make_random_soup(300, 0.3f, 7), make_sliver_fan(40, 1e-4f)};
  meshes.push_back(moved(meshes[0], 0x1p-60f));
  meshes.push_back(moved(meshes[2], 0x1p60f));
  meshes.push_back(meshes[0]);
  meshes.back().transform(1.0f, {148376.0f, 1234.0f, -223423.0f});
  meshes.push_back(make_box({-1, -1, -1}, {1, 1, 1}));
  std::uint64_t ray_count = 0, hit_count = 0;
  OracleCounts boxed, plain;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const TestMesh& mesh = meshes[i];
    std::vector<OracleRay> rays;
    for (std::uint64_t seed = 1; seed <= 150; ++seed) append_rays_at(mesh, seed, 100, rays);
    const Oracle with(mesh.view());
    const Oracle without(mesh.view(), {.use_boxes = false});
    const std::vector<NearestHit> found = with.nearest(rays, 2, &boxed);
    ASSERT_EQ(found, without.nearest(rays, 1, &plain)) << "mesh " << i;
    for (const NearestHit& hit : found) hit_count += !hit.ties.empty();
    for (std::size_t ray = 0; ray < rays.size(); ray += 50) {
      ASSERT_EQ(ids_of(with.hits(rays[ray])), ids_of(without.hits(rays[ray]))) << "mesh " << i << ", ray " << ray;
    }
    ray_count += rays.size();
  }
  EXPECT_GE(ray_count, 100000u);
  EXPECT_GT(hit_count, ray_count / 3);
  EXPECT_EQ(boxed.rays, plain.rays);
  EXPECT_LT(boxed.pairs * 5, plain.pairs);
}

TEST(Oracle, RoundingModesAndFlushingChangeNothing) {
  std::uint64_t rays = 0;
  for_each_seed(600, [&](std::uint64_t seed) {
    const HardCase hard = make_hard_case(200000 + seed);
    const Oracle nearest(hard.mesh.view());
    std::vector<NearestHit> wanted;
    for (const OracleRay& ray : hard.rays) wanted.push_back(nearest.nearest(ray));
    for (const int mode : kRoundingModes) {
      std::vector<NearestHit> found;
      {
        const RoundingScope scope(mode, true);
        const Oracle oracle(hard.mesh.view());
        for (const OracleRay& ray : hard.rays) found.push_back(oracle.nearest(ray));
      }
      ASSERT_EQ(found, wanted) << "mode " << mode << ", seed " << seed;
      rays += found.size();
    }
  });
  if (std::getenv("GRIDIRON_TEST_SEED") == nullptr) {
    EXPECT_GT(rays, 38000u);
  }
}

TEST(Oracle, ThroughAVertexEveryTriangleAroundItIsHit) {
  const TestMesh fan = make_sliver_fan(200, 1e-3f);
  std::vector<int> uses(fan.vertices.size());
  for (const UVec3& t : fan.triangles) ++uses[t.x], ++uses[t.y], ++uses[t.z];
  const auto apex = static_cast<std::size_t>(std::max_element(uses.begin(), uses.end()) - uses.begin());
  ASSERT_GE(uses[apex], 200);
  const Vec3 p = fan.vertices[apex];
  const Oracle oracle(fan.view());
  // Sums of floats of few bits: the ray meets the apex exactly, at t = 2.
  const Vec3 direction = {0.25f, 0.5f, -1.0f};
  const Vec3 origin = p - 2.0f * direction;
  ASSERT_EQ(origin + 2.0f * direction, p);
  const NearestHit found = oracle.nearest(ray_of(origin, direction));
  EXPECT_EQ(found.t, 2.0f);
  // Only triangles seen edge-on are missing.
  EXPECT_GE(found.ties.size(), static_cast<std::size_t>(uses[apex]) - 2);
  for (const std::uint32_t id : found.ties) {
    EXPECT_EQ(oracle.distance(ray_of(origin, direction), id).rational(), Rational(2));
  }
}

TEST(Oracle, BoundariesAreClosed) {
  TestMesh quad;
  quad.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  quad.triangles = {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}};
  const float scales[] = {0x1p-126f, 0x1p-60f, 1.0f, 0x1p60f, 0x1p100f};
  for (const float scale : scales) {
    const TestMesh mesh = moved(quad, scale);
    const Oracle oracle(mesh.view());
    const auto hits_at = [&](float x, float y) {
      return ids_of(oracle.hits(ray_of(Vec3(x, y, -1) * scale, Vec3(0, 0, scale))));
    };
    EXPECT_EQ(hits_at(0.5f, 0.25f), (Ids{0, 2})) << scale;
    EXPECT_EQ(hits_at(0.25f, 0.5f), (Ids{1})) << scale;
    EXPECT_EQ(hits_at(0.5f, 0.5f), (Ids{0, 1, 2})) << scale;
    EXPECT_EQ(hits_at(0, 0), (Ids{0, 1, 2})) << scale;
    EXPECT_EQ(hits_at(1, 0), (Ids{0, 2})) << scale;
    EXPECT_EQ(hits_at(0, 1), (Ids{1})) << scale;
    EXPECT_EQ(hits_at(0.5f, 0), (Ids{0, 2})) << scale;
    EXPECT_EQ(hits_at(1, 0.5f), (Ids{0, 2})) << scale;
    EXPECT_EQ(hits_at(0.5f, -0x1p-23f), Ids{}) << scale;
    EXPECT_EQ(hits_at(std::nextafter(1.0f, 2.0f), 0.5f), Ids{}) << scale;
    EXPECT_EQ(oracle.nearest(ray_of(Vec3(0.5f, 0.5f, -1) * scale, Vec3(0, 0, scale))).t, 1.0f) << scale;
  }
}

TEST(Oracle, NoAreaAndInPlaneAreNeverHit) {
  TestMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 0, 3}, {1, 1, 1}, {0, 2, 3}};
  const Oracle oracle(mesh.view());
  EXPECT_EQ(ids_of(oracle.hits(ray_of({0.5f, 0, -1}, {0, 0, 1}))), (Ids{3}));
  EXPECT_EQ(ids_of(oracle.hits(ray_of({0, 0, -1}, {0, 0, 1}))), (Ids{3}));
  EXPECT_EQ(ids_of(oracle.hits(ray_of({1, 0, -1}, {0, 0, 1}))), (Ids{3}));
  EXPECT_EQ(ids_of(oracle.hits(ray_of({-1, 0, 0}, {1, 0, 0}))), Ids{});
  EXPECT_EQ(ids_of(oracle.hits(ray_of({-1, 0.25f, 0}, {1, 0, 0}))), Ids{});
  EXPECT_EQ(ids_of(oracle.hits(ray_of({-1, 0.25f, 0x1p-149f}, {1, 0, -0x1p-149f}))), (Ids{3}));
  EXPECT_EQ(ids_of(oracle.hits(ray_of({-1, 0.25f, 1}, {0, 0, 0}))), Ids{});
}

TEST(Oracle, NeedlesOfOneStepAndDenormals) {
  const float next = std::nextafter(1.0f, 2.0f);
  const TestMesh needle = make_triangle({1, 0, 0}, {next, 0, 0}, {1, 1, 0});
  const Oracle oracle(needle.view());
  const auto is_hit = [&](float x, float y) { return !oracle.hits(ray_of({x, y, 3}, {0, 0, -1})).empty(); };
  EXPECT_TRUE(is_hit(1, 0.5f));
  EXPECT_TRUE(is_hit(next, 0));
  EXPECT_TRUE(is_hit(1, 1));
  EXPECT_FALSE(is_hit(next, 0x1p-149f));
  EXPECT_FALSE(is_hit(std::nextafter(1.0f, 0.0f), 0.5f));

  constexpr float kStep = 0x1p-149f;
  const TestMesh dust = make_triangle({0, 0, 0}, {2 * kStep, 0, 0}, {0, 2 * kStep, 0});
  const Oracle dust_oracle(dust.view());
  EXPECT_EQ(dust_oracle.hits(ray_of({kStep, kStep, -1}, {0, 0, 1})).size(), 1u);
  EXPECT_EQ(dust_oracle.hits(ray_of({2 * kStep, kStep, -1}, {0, 0, 1})).size(), 0u);
  // The least and the greatest distance there is.
  EXPECT_EQ(dust_oracle.nearest(ray_of({0, 0, -kStep}, {0, 0, 1})).t, kStep);
  const OracleRay slow = ray_of({kStep, 0, -kFloatMax}, {0, 0, kStep});
  EXPECT_TRUE(dust_oracle.hits(slow).empty()) << "at 2^277, beyond t_max";
  const Oracle standard(dust.view(), {.reading = Reading::kStandard});
  EXPECT_EQ(standard.hits(slow).size(), 1u) << "reads as the greatest float, as core says it does";
  EXPECT_EQ(standard.nearest(slow).t, kFloatMax);
  EXPECT_TRUE(standard.hits(ray_of({0, 0, -kStep}, {0, 0, 1})).empty()) << "reads as 0";
}

TEST(Oracle, LimitsAreOpenBelowAndClosedAbove) {
  const TestMesh mesh = make_triangle({0, 0, 1}, {4, 0, 1}, {0, 4, 1});
  const float third = 1.0f / 3.0f;  // rounded up
  for (const bool use_filter : {true, false}) {
    for (const Reading reading : {Reading::kExact, Reading::kStandard}) {
      const Oracle oracle(mesh.view(), {.reading = reading, .use_filter = use_filter});
      const auto is_hit = [&](float speed, float t_min, float t_max) {
        OracleRay ray = ray_of({1, 1, 0}, {0, 0, speed});
        ray.t_min = t_min;
        ray.t_max = t_max;
        const bool found = !oracle.hits(ray).empty();
        EXPECT_EQ(found, !oracle.nearest(ray).ties.empty());
        return found;
      };
      EXPECT_TRUE(is_hit(1, 0, 1));
      EXPECT_FALSE(is_hit(1, 1, 2));
      EXPECT_FALSE(is_hit(1, 0, std::nextafter(1.0f, 0.0f)));
      EXPECT_TRUE(is_hit(1, std::nextafter(1.0f, 0.0f), 2));
      EXPECT_FALSE(is_hit(-1, 0, 2));
      EXPECT_TRUE(is_hit(3, 0, third));
      EXPECT_FALSE(is_hit(3, third, 1));
      // The exact t lies between `third` and the float below it; as a float it is `third`.
      EXPECT_FALSE(is_hit(3, 0, std::nextafter(third, 0.0f)));
      EXPECT_TRUE(is_hit(3, std::nextafter(third, 0.0f), 1));
    }
  }
  // A quotient whose float lies below it.
  float speed = 3.0f;
  while (exact_rational(1.0f / speed) * exact_rational(speed) >= 1) ++speed;
  OracleRay ray = ray_of({1, 1, 0}, {0, 0, speed});
  ray.t_max = 1.0f / speed;
  EXPECT_TRUE(Oracle(mesh.view()).hits(ray).empty());
  EXPECT_EQ(Oracle(mesh.view(), {.reading = Reading::kStandard}).hits(ray).size(), 1u);
  OracleRay on = ray_of({1, 1, 1}, {0, 0, 1});
  EXPECT_TRUE(Oracle(mesh.view()).hits(on).empty()) << "an origin on a triangle does not hit it";
}

TEST(Oracle, TellsDistancesApartThatDoublesCannot) {
  // Two planes z = 1 and z = 1 + 2^-100 y, and the same again in other corners' order.
  TestMesh mesh;
  mesh.vertices = {{-4, -4, 1}, {4, -4, 1}, {0, 4, 1}, {-0x1p50f, 0, 1}, {0x1p50f, 0, 1}, {0, 0x1p100f, 2}};
  mesh.triangles = {{3, 4, 5}, {0, 1, 2}, {2, 1, 0}};
  const Oracle oracle(mesh.view());
  const OracleRay above = ray_of({0, 1, 0}, {0, 0, 1});
  EXPECT_EQ(oracle.nearest(above).ties, (Ids{1, 2}));
  EXPECT_EQ(oracle.nearest(above).float_ties, (Ids{0, 1, 2}));
  EXPECT_LT(oracle.distance(above, 1), oracle.distance(above, 0));
  EXPECT_EQ(oracle.distance(above, 0).rational() - 1, Rational(BigInt(1), BigInt(1) << 100));
  EXPECT_EQ(oracle.nearest(ray_of({0, 0, 0}, {0, 0, 1})).ties, (Ids{0, 1, 2}));
  EXPECT_EQ(oracle.nearest(ray_of({0, 1, 2}, {0, 0, -1})).ties, (Ids{0}));
}

TEST(Oracle, WhatIsNotFiniteIsNotThere) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  TestMesh mesh = make_triangle({0, 0, 1}, {4, 0, 1}, {0, 4, 1});
  mesh.append(mesh);
  mesh.vertices[0].y = kNan;
  for (const bool use_boxes : {true, false}) {
    const Oracle oracle(mesh.view(), {.use_boxes = use_boxes});
    EXPECT_EQ(ids_of(oracle.hits(ray_of({1, 1, 0}, {0, 0, 1}))), (Ids{1}));
    EXPECT_EQ(ids_of(oracle.hits(ray_of({1, 100, 0}, {0, 0, 1}))), Ids{}) << "a hit, were the bits a number";
    for (const float bad : {kNan, kInfinity, -kInfinity}) {
      EXPECT_TRUE(oracle.hits(ray_of({bad, 1, 0}, {0, 0, 1})).empty());
      EXPECT_TRUE(oracle.nearest(ray_of({1, 1, 0}, {0, bad, 1})).ties.empty());
      EXPECT_TRUE(oracle.hits(ray_of({1, 1, 0}, {0, 0, bad})).empty());
      EXPECT_TRUE(oracle.nearest(ray_of({1, 1, 0}, {0, 0, bad})).ties.empty());
    }
  }
  const TestMesh none;
  EXPECT_TRUE(Oracle(none.view()).hits(ray_of({1, 1, 0}, {0, 0, 1})).empty());
}

}  // namespace
}  // namespace gridiron::test
