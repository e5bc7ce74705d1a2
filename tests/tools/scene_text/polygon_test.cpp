// Polygons to triangles: the outline kept, the area kept, nothing turned over. SPDX-License-Identifier: Apache-2.0
#include "scene_text/polygon.h"

#include <glm/geometric.hpp>
#include <numbers>

#include "check_scene.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using tool::PolygonDefect;
using tool::PolygonResult;
using tool::triangulate_polygon;

DVec3 newell(std::span<const Vec3> corners) {
  DVec3 sum(0.0);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    sum +=
        glm::cross(DVec3(corners[i]) - DVec3(corners[0]), DVec3(corners[(i + 1) % corners.size()]) - DVec3(corners[0]));
  }
  return sum;
}

// Cuts a polygon that must be fine and checks what came out: triangles of its direction, the same area, each edge of
// the outline used once, every other edge by two triangles in opposite directions.
void expect_cut(const std::vector<Vec3>& corners, std::size_t triangle_count) {
  std::vector<UVec3> triangles;
  const PolygonResult result = triangulate_polygon(corners, triangles);
  ASSERT_EQ(result.defect, PolygonDefect::kNone);
  EXPECT_EQ(triangles.size(), triangle_count);
  const DVec3 whole = newell(corners);
  double sum = 0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto here = static_cast<std::uint32_t>(i), next = static_cast<std::uint32_t>((i + 1) % corners.size());
    balance[{std::min(here, next), std::max(here, next)}] += here < next ? 1 : -1;
  }
  for (const UVec3& triangle : triangles) {
    const DVec3 area = doubled_area(corners, std::span(&triangle, 1));
    EXPECT_GT(glm::dot(area, whole), 0);
    sum += glm::dot(area, whole) / glm::length(whole);
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t from = triangle[corner], to = triangle[(corner + 1) % 3];
      balance[{std::min(from, to), std::max(from, to)}] -= from < to ? 1 : -1;
    }
  }
  EXPECT_NEAR(sum, glm::length(whole), 1e-6 * glm::length(whole));
  for (const auto& [edge, uses] : balance) EXPECT_EQ(uses, 0) << "edge " << edge.first << ", " << edge.second;
}

// Both directions, and along three axes.
void expect_cut_everywhere(const std::vector<Vec3>& flat, std::size_t triangle_count) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Vec3> turned;
    for (const Vec3& p : flat) {
      const float coordinates[3] = {p.x, p.y, 0.25f * p.x - 0.125f * p.y + 3};
      turned.emplace_back(coordinates[(3 - axis) % 3], coordinates[(4 - axis) % 3], coordinates[(5 - axis) % 3]);
    }
    SCOPED_TRACE(axis);
    expect_cut(turned, triangle_count);
    std::reverse(turned.begin(), turned.end());
    expect_cut(turned, triangle_count);
  }
}

TEST(Polygon, ConvexAndConcave) {
  expect_cut_everywhere({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, 1);
  expect_cut_everywhere({Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(2, 1, 0), Vec3(1, 1, 0), Vec3(1, 2, 0), Vec3(0, 2, 0)}, 4);
  // A comb.
  std::vector<Vec3> comb = {Vec3(0, 0, 0), Vec3(20, 0, 0)};
  for (int i = 10; i-- > 0;) {
    const auto x = static_cast<float>(2 * i);
    comb.insert(comb.end(), {Vec3(x + 2, 5, 0), Vec3(x + 1, 5, 0), Vec3(x + 1, 1, 0), Vec3(x + 0.5f, 1, 0)});
  }
  expect_cut_everywhere(comb, comb.size() - 2);
}

TEST(Polygon, CornersOnEdgesStay) {
  // Whoever shares the edge has the corner too: left out it would be a crack.
  expect_cut_everywhere({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(0, 2, 0)}, 2);
  expect_cut_everywhere({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(2, 1, 0), Vec3(2, 2, 0), Vec3(1, 2, 0),
                         Vec3(0, 2, 0), Vec3(0, 1, 0)},
                        6);
}

TEST(Polygon, AHoleByABridge) {
  const std::vector<Vec3> frame = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(4, 4, 0), Vec3(0, 4, 0), Vec3(0, 0, 0),
                                   Vec3(1, 1, 0), Vec3(1, 3, 0), Vec3(3, 3, 0), Vec3(3, 1, 0), Vec3(1, 1, 0)};
  expect_cut_everywhere(frame, 8);
}

TEST(Polygon, RandomStarsAndSpirals) {
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    TestRandom random(seed);
    const std::uint32_t count = 3 + random.below(120);
    std::vector<Vec3> star;
    for (std::uint32_t i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * i / count, r = static_cast<double>(random.between(0.05f, 1.0f));
      star.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
    }
    expect_cut(star, count - 2);
  }
  // A spiral of five turns, as many corners as allowed.
  std::vector<Vec3> spiral;
  for (int i = 0; i < 512; ++i) {
    const double angle = 10 * std::numbers::pi * i / 511;
    spiral.emplace_back((1 + angle) * std::cos(angle), (1 + angle) * std::sin(angle), 0);
  }
  for (int i = 511; i >= 0; --i) {
    const double angle = 10 * std::numbers::pi * i / 511;
    spiral.emplace_back((2 + angle) * std::cos(angle), (2 + angle) * std::sin(angle), 0);
  }
  ASSERT_EQ(spiral.size(), tool::kMostPolygonCorners);
  expect_cut(spiral, spiral.size() - 2);
}

TEST(Polygon, SignsAreExact) {
  // Far from the origin, one unit in the last place deep: floats and doubles of the coordinates alone lose it.
  const float far = 8388608;  // 2^23: neighbours differ by 1
  expect_cut({Vec3(far, far, 0), Vec3(far + 4, far, 0), Vec3(far + 4, far + 4, 0), Vec3(far + 3, far + 1, 0)}, 2);
  // Differences to the far corner lose the near one whole: only the integers see which way this sliver turns.
  expect_cut({Vec3(0, 0, 0), Vec3(1e10f, 1e10f, 0), Vec3(1e-10f, 2e-10f, 0)}, 1);
  // Corners 1e-38 apart, together with corners 1e18 away.
  expect_cut({Vec3(0, 0, 0), Vec3(1e18f, 0, 0), Vec3(1e18f, 1e18f, 0), Vec3(1e-38f, 2e-38f, 0)}, 2);
}

TEST(Polygon, RepeatedCornersAndSpikesMakeNoTriangle) {
  std::vector<UVec3> triangles;
  const std::vector<Vec3> repeated = {Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0),
                                      Vec3(1, 1, 0), Vec3(0, 1, 0), Vec3(0, 0, 0)};
  EXPECT_EQ(triangulate_polygon(repeated, triangles).defect, PolygonDefect::kNone);
  EXPECT_EQ(triangles.size(), 2u);
  triangles.clear();
  const std::vector<Vec3> spike = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(3, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0)};
  EXPECT_EQ(triangulate_polygon(spike, triangles).defect, PolygonDefect::kNone);
  EXPECT_NEAR(glm::length(doubled_area(spike, triangles)), 1, 1e-12);
}

TEST(Polygon, TellsDefects) {
  std::vector<UVec3> triangles;
  const auto defect = [&](const std::vector<Vec3>& corners) { return triangulate_polygon(corners, triangles).defect; };
  EXPECT_EQ(defect({Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(2, 2, 2)}), PolygonDefect::kNoArea);
  EXPECT_EQ(defect({Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3)}), PolygonDefect::kNoArea);
  EXPECT_EQ(defect({Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(0, 1, 0), Vec3(2, 2, 0)}), PolygonDefect::kCrosses);
  EXPECT_EQ(defect({Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}), PolygonDefect::kCrosses)
      << "a bow tie whose halves cancel";
  EXPECT_EQ(defect({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(1, 0, 0)}), PolygonDefect::kCrosses)
      << "there and back";
  // A star of five points drawn in one go.
  std::vector<Vec3> star;
  for (int i = 0; i < 5; ++i) {
    const double angle = 4 * std::numbers::pi * i / 5;
    star.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  EXPECT_EQ(defect(star), PolygonDefect::kCrosses);
  // Twice around, every corner to the left: without a search for crossings the triangles would overlap.
  EXPECT_EQ(defect({Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(4, 4, 0), Vec3(0, 4, 0), Vec3(1, 1, 0), Vec3(3, 1, 0),
                    Vec3(3, 3, 0), Vec3(1, 3, 0)}),
            PolygonDefect::kCrosses);
  EXPECT_TRUE(triangles.empty()) << "nothing is left of what failed";
}

TEST(Polygon, MeasuresHowFarFromPlanar) {
  std::vector<UVec3> triangles;
  const std::vector<Vec3> bent = {Vec3(0, 0, 0.5f), Vec3(1, 0, -0.5f), Vec3(1, 1, 0.5f), Vec3(0, 1, -0.5f)};
  EXPECT_NEAR(triangulate_polygon(bent, triangles).plane_distance, 0.5, 1e-12);
}

}  // namespace
}  // namespace gridiron::test
