// The ground truth's own truth: filter against integers, integers against rationals.
// SPDX-License-Identifier: Apache-2.0
#include "support/brute_force.h"

#include <gridiron/base/exact_sum.h>

#include "support/rational_vectors.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

// The float nearest to a positive rational: start from a guess, walk to the neighbour while it is nearer.
float round_to_float(const Rational& value) {
  auto guess = value.convert_to<float>();
  const auto distance_to = [&value](float f) { return Rational(abs(Rational(f) - value)); };
  for (int step = 0; step < 8; ++step) {
    const float up = std::nextafter(guess, std::numeric_limits<float>::infinity());
    const float down = std::nextafter(guess, 0.0f);
    if (std::isfinite(up) && distance_to(up) <= distance_to(guess)) {
      guess = up;  // halves away from zero
    } else if (distance_to(down) < distance_to(guess)) {
      guess = down;
    } else {
      break;
    }
  }
  return guess;
}

// Accuracy `standard` word for word, in rationals.
TrueHit trace_in_rationals(const TestMesh& mesh, Vec3 origin, Vec3 direction, float t_far) {
  TrueHit best;
  const RationalPoint o = exact_point(origin);
  const RationalPoint d = exact_point(direction);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const UVec3& t = mesh.triangles[i];
    const RationalPoint a = exact_point(mesh.vertices[t.x]) - o;
    const RationalPoint b = exact_point(mesh.vertices[t.y]) - o;
    const RationalPoint c = exact_point(mesh.vertices[t.z]) - o;
    const Rational edges[3] = {determinant(d, a, b), determinant(d, b, c), determinant(d, c, a)};
    bool positive = false;
    bool negative = false;
    for (const Rational& edge : edges) {
      positive = positive || edge > 0;
      negative = negative || edge < 0;
    }
    if (positive == negative) continue;
    const Rational distance = determinant(a, b, c) / determinant(d, b - a, c - a);
    if (distance <= 0) continue;
    const float rounded = round_to_float(distance);
    if (rounded < std::numeric_limits<float>::min() || rounded > t_far) continue;
    const auto triangle_id = static_cast<std::uint32_t>(i);
    if (rounded < best.distance || (rounded == best.distance && triangle_id < best.triangle_id)) {
      best = {triangle_id, rounded};
    }
  }
  return best;
}

struct Case {
  std::string name;
  TestMesh mesh;
  Vec3 origin;
};

std::vector<Case> make_cases() {
  const TestMesh doubled = joined(make_sphere(6, 8, 1.0f), make_sphere(6, 8, 1.0f));
  TestMesh coplanar = make_height_field(6, 0.0f, 1);
  coplanar.append(make_box({-0.5f, 0, -0.5f}, {0.5f, 0.5f, 0.5f}));
  return {
      {"soup", make_random_soup(60, 0.5f, 11), {0.1f, 0.2f, 3.0f}},
      {"soup_from_inside", make_random_soup(60, 0.8f, 12), {0.0f, 0.0f, 0.0f}},
      {"sphere", make_sphere(6, 8, 1.0f), {0.0f, 0.0f, 4.0f}},
      {"sphere_from_its_pole", make_sphere(6, 8, 1.0f), {0.0f, 1.0f, 0.0f}},
      {"sphere_twice", doubled, {0.3f, 2.5f, 1.0f}},
      {"far_sphere", moved(make_sphere(6, 8, 1.0f), 1.0f, {1e6f, -1e6f, 1e6f}), {1e6f, -1e6f, 1e6f + 4.0f}},
      {"tiny_torus", moved(make_torus(6, 5, 1.0f, 0.4f), 1e-30f, {}), {0.0f, 2e-30f, 3e-30f}},
      {"huge_torus", moved(make_torus(6, 5, 1.0f, 0.4f), 1e30f, {}), {0.0f, 2e30f, 3e30f}},
      {"slivers", make_sliver_fan(50, 1e-6f), {0.0f, 0.5f, 2.0f}},
      {"coplanar_pieces", coplanar, {0.25f, 1.0f, 0.25f}},
      {"in_the_plane", make_height_field(6, 0.0f, 1), {-3.0f, 0.0f, 0.1f}},
  };
}

// Half the rays anywhere, half at features: vertices, edges, corners of the triangles' own plane.
std::vector<Vec3> make_directions(const Case& c, std::uint32_t count, std::uint64_t seed) {
  TestRandom random(seed);
  std::vector<Vec3> directions;
  for (std::uint32_t i = 0; i < count; ++i) {
    const UVec3& t = c.mesh.triangles[random.below(static_cast<std::uint32_t>(c.mesh.triangles.size()))];
    const Vec3 p = c.mesh.vertices[t.x];
    const Vec3 q = c.mesh.vertices[t.y];
    const Vec3 r = c.mesh.vertices[t.z];
    const float s = random.unit();
    const float u = random.unit() * (1.0f - s);
    switch (i % 4) {
      case 0:
        directions.push_back(p - c.origin);
        break;
      case 1:
        directions.push_back(p + s * (q - p) - c.origin);
        break;
      case 2:
        directions.push_back(p + s * (q - p) + u * (r - p) - c.origin);
        break;
      default:
        directions.push_back({random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)});
        break;
    }
  }
  return directions;
}

class BruteForceTest : public testing::TestWithParam<std::size_t> {};

TEST_P(BruteForceTest, FilterAgreesWithIntegers) {
  const Case c = make_cases()[GetParam()];
  const BruteForce truth(c.mesh.view(), c.origin);
  const std::vector<Vec3> directions = make_directions(c, 403, 100 + GetParam());
  for (const float t_far : {kFloatMax, 1.0f}) {
    const std::vector<TrueHit> hits = truth.trace(directions, t_far, 2);
    std::size_t hit_count = 0;
    for (std::size_t i = 0; i < directions.size(); ++i) {
      ASSERT_EQ(hits[i], truth.trace_in_integers(directions[i], t_far)) << c.name << ", ray " << i;
      hit_count += hits[i].triangle_id != kNoTriangle;
    }
    if (t_far == kFloatMax && c.name != "in_the_plane") {
      EXPECT_GT(hit_count, directions.size() / 8) << c.name;
    }
  }
}

TEST_P(BruteForceTest, IntegersAgreeWithRationals) {
  const Case c = make_cases()[GetParam()];
  const BruteForce truth(c.mesh.view(), c.origin);
  const std::vector<Vec3> directions = make_directions(c, 48, 200 + GetParam());
  for (std::size_t i = 0; i < directions.size(); ++i) {
    ASSERT_EQ(truth.trace_in_integers(directions[i], kFloatMax),
              trace_in_rationals(c.mesh, c.origin, directions[i], kFloatMax))
        << c.name << ", ray " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, BruteForceTest, testing::Range<std::size_t>(0, make_cases().size()),
                         [](const auto& tested) { return make_cases()[tested.param].name; });

TEST(BruteForceFilter, RejectsAlmostEverythingByItself) {
  const TestMesh mesh = make_sphere(40, 60, 1.0f);
  const BruteForce truth(mesh.view(), {0, 0, 4});
  TestRandom random(7);
  std::vector<Vec3> directions;
  for (int i = 0; i < 1000; ++i)
    directions.push_back({random.between(-0.17f, 0.17f), random.between(-0.17f, 0.17f), -1});
  BruteForceCounts counts;
  const std::vector<TrueHit> hits = truth.trace(directions, kFloatMax, 1, &counts);
  EXPECT_EQ(counts.pairs, mesh.triangles.size() * directions.size());
  EXPECT_LT(counts.candidates, 4 * directions.size());
  EXPECT_LT(counts.exact_signs, directions.size() / 50);
  EXPECT_LT(counts.exact_distances, directions.size() / 50);
  for (const TrueHit& hit : hits) EXPECT_NE(hit.triangle_id, kNoTriangle);
}

TEST(BruteForceFilter, DistanceAtTheLimitCounts) {
  const TestMesh mesh = make_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
  const BruteForce truth(mesh.view(), {0, 0, 2});
  const std::vector<Vec3> directions = {{0, 0, -1}};
  EXPECT_EQ(truth.trace(directions, 2.0f, 1)[0], (TrueHit{0, 2.0f}));
  EXPECT_EQ(truth.trace(directions, std::nextafter(2.0f, 0.0f), 1)[0], TrueHit{});
  EXPECT_EQ(BruteForce(mesh.view(), {0, 0, 0}).trace(directions, 2.0f, 1)[0], TrueHit{});
}

}  // namespace
}  // namespace gridiron::test
