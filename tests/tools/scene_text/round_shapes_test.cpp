// Spheres and cones as triangles: closed, turned outwards, no farther from the true surface than stated.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#include "scene_text/round_shapes.h"

#include <glm/geometric.hpp>
#include <numbers>
#include <tuple>

#include "check_scene.h"
#include "support/test_headers.h"

namespace gridiron::test {
namespace {

using tool::RoundShapes;
using tool::SceneDescription;
using tool::SceneGeometry;
using tool::SceneOptions;
using tool::UnitSphere;

// Nearest point of a triangle to the origin, by its regions: corners, edges, inside.
double distance_from_origin(const DVec3& a, const DVec3& b, const DVec3& c) {
  const DVec3 normal = glm::cross(b - a, c - a);
  const auto inside = [&](const DVec3& p, const DVec3& q) { return glm::dot(glm::cross(q - p, -p), normal) >= 0; };
  if (inside(a, b) && inside(b, c) && inside(c, a)) return std::fabs(glm::dot(normal, a)) / glm::length(normal);
  const auto to_edge = [](const DVec3& p, const DVec3& q) {
    const double t = std::clamp(-glm::dot(p, q - p) / glm::dot(q - p, q - p), 0.0, 1.0);
    return glm::length(p + (q - p) * t);
  };
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

TEST(RoundShapes, UnitSpheresAreClosedRoundAndOutwards) {
  RoundShapes shapes;
  for (const std::uint32_t frequency : {1u, 2u, 3u, 7u, 16u, 45u}) {
    SCOPED_TRACE(frequency);
    const UnitSphere& sphere = shapes.sphere(frequency);
    EXPECT_EQ(sphere.vertices.size(), 10u * frequency * frequency + 2);
    EXPECT_EQ(sphere.triangles.size(), 20u * frequency * frequency);
    EXPECT_EQ(count_open_edges(sphere.triangles), 0u);
    std::set<std::tuple<double, double, double>> places;
    for (const DVec3& vertex : sphere.vertices) {
      EXPECT_NEAR(glm::length(vertex), 1, 1e-15);
      places.emplace(vertex.x, vertex.y, vertex.z);
    }
    EXPECT_EQ(places.size(), sphere.vertices.size()) << "each vertex once";
    for (const UVec3& t : sphere.triangles) {
      const DVec3 &a = sphere.vertices[t.x], &b = sphere.vertices[t.y], &c = sphere.vertices[t.z];
      ASSERT_GT(glm::dot(glm::cross(b - a, c - a), a + b + c), 0);
    }
  }
}

TEST(RoundShapes, TheFrequencyIsTheLeastThatHolds) {
  RoundShapes shapes;
  EXPECT_EQ(shapes.sphere_frequency(0.5), 1u);
  for (const double deviation : {0.2, 0.05, 0.01, 1e-3, 1e-4}) {
    const std::uint32_t frequency = shapes.sphere_frequency(deviation);
    const auto worst = [&](std::uint32_t of) {
      double farthest = 0;
      const UnitSphere& sphere = shapes.sphere(of);
      for (const UVec3& t : sphere.triangles) {
        farthest = std::max(farthest,
                            1 - distance_from_origin(sphere.vertices[t.x], sphere.vertices[t.y], sphere.vertices[t.z]));
      }
      return farthest;
    };
    EXPECT_LE(worst(frequency), deviation * (1 + 1e-9));
    EXPECT_TRUE(frequency == 1 || worst(frequency - 1) > deviation);
  }
  EXPECT_EQ(shapes.sphere_frequency(1e-9), 0u) << "more than a table holds";
}

TEST(RoundShapes, CirclesAreRoundAndFineEnough) {
  RoundShapes shapes;
  EXPECT_EQ(RoundShapes::circle_segments(0.6), 3u);
  EXPECT_EQ(RoundShapes::circle_segments(0.4), 4u);
  EXPECT_EQ(RoundShapes::circle_segments(0.2), 6u);
  EXPECT_EQ(RoundShapes::circle_segments(1e-13), 0u);
  for (const double deviation : {0.1, 0.01, 1e-3, 1e-5, 1e-8}) {
    const std::uint32_t segments = RoundShapes::circle_segments(deviation);
    EXPECT_LE(1 - std::cos(std::numbers::pi / segments), deviation * (1 + 1e-6));
    EXPECT_GT(1 - std::cos(std::numbers::pi / (0.66 * segments)), deviation) << "not finer than need be";
    const std::vector<DVec3>& circle = shapes.circle(segments);
    ASSERT_EQ(circle.size(), segments);
    for (std::uint32_t i = 0; i < segments; ++i) {
      const double angle = 2 * std::numbers::pi * i / segments;
      ASSERT_NEAR(circle[i].x, std::cos(angle), 1e-14);
      ASSERT_NEAR(circle[i].y, std::sin(angle), 1e-14);
    }
  }
}

SceneDescription read_shape(const std::string& shape, float tolerance) {
  SceneOptions options;
  options.tolerance = tolerance;
  const SceneDescription scene = read_good(std::string(kViewAndFill) + shape, options);
  expect_sound(scene);
  return scene;
}

std::string line(const char* word, std::initializer_list<double> numbers) {
  std::ostringstream text;
  text.precision(17);
  text << word;
  for (const double number : numbers) text << ' ' << number;
  return text.str();
}

TEST(RoundShapes, SpheresHoldTheToleranceAlsoFarFromTheOrigin) {
  struct Case {
    DVec3 center;
    double radius;
    float tolerance;
  };
  for (const Case& of :
       {Case{DVec3(0), 1, 0.001f}, Case{DVec3(1, -2, 3), 0.25, 0.01f}, Case{DVec3(1000, 0, -500), 2, 1e-3f},
        Case{DVec3(1e5, 1e5, 1e5), 10, 0.03f}, Case{DVec3(0), 1e-3, 1e-6f}, Case{DVec3(0), 1, 5.0f}}) {
    const SceneDescription scene =
        read_shape(line("s", {of.center.x, of.center.y, of.center.z, of.radius}), of.tolerance);
    const SceneGeometry& geometry = scene.geometry;
    EXPECT_EQ(scene.tolerance, of.tolerance);
    EXPECT_EQ(count_open_edges(geometry.triangles), 0u);
    const double volume = 4.0 / 3 * std::numbers::pi * of.radius * of.radius * of.radius;
    std::vector<Vec3> centered;
    double farthest = 0;
    for (const Vec3& vertex : geometry.vertices) {
      centered.emplace_back(DVec3(vertex) - of.center);
      farthest = std::max(farthest, glm::length(DVec3(vertex) - of.center) - of.radius);
    }
    for (const UVec3& t : geometry.triangles) {
      const auto at = [&](std::uint32_t i) { return DVec3(geometry.vertices[i]) - of.center; };
      farthest = std::max(farthest, of.radius - distance_from_origin(at(t.x), at(t.y), at(t.z)));
      ASSERT_GT(glm::dot(glm::cross(at(t.y) - at(t.x), at(t.z) - at(t.x)), at(t.x) + at(t.y) + at(t.z)), 0)
          << "outwards";
    }
    EXPECT_LE(farthest, static_cast<double>(of.tolerance));
    EXPECT_GT(signed_volume(centered, geometry.triangles), 0.5 * volume);
    for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
      for (int corner = 0; corner < 3; ++corner) {
        const DVec3 place = DVec3(geometry.vertices[geometry.triangles[i][corner]]) - of.center;
        const DVec3 off = DVec3(geometry.normals[geometry.triangle_normals[i][corner]]) - place / of.radius;
        ASSERT_LT(glm::length(off), 1e-6 + 2e-7 * glm::length(of.center) / of.radius) << "the sphere's own normal";
      }
    }
  }
}

TEST(RoundShapes, SpheresOfOneFinenessShareNormals) {
  const SceneDescription scene = read_shape("s 0 0 0 1 s 5 0 0 1 s 0 5 0 1", 0.01f);
  EXPECT_EQ(scene.geometry.normals.size() * 3, scene.geometry.vertices.size());
}

// An open cone or cylinder: base, apex, their radii.
struct Cone {
  DVec3 base, apex;
  double base_radius, apex_radius;
};

TEST(RoundShapes, ConesHoldTheToleranceAndHaveTheirOwnNormals) {
  for (const Cone& cone : {Cone{DVec3(0), DVec3(0, 0, 2), 1, 1}, Cone{DVec3(1, 2, 3), DVec3(-1, 4, 2), 1, 0.5},
                           Cone{DVec3(0), DVec3(0, 3, 0), 1, 0}, Cone{DVec3(0), DVec3(1, 1, 1), 0, 2},
                           Cone{DVec3(500, 0, 0), DVec3(500, 9, 9), 0.5, 3}}) {
    constexpr float kTolerance = 0.004f;
    const SceneDescription scene = read_shape(line("c", {cone.base.x, cone.base.y, cone.base.z, cone.base_radius,
                                                         cone.apex.x, cone.apex.y, cone.apex.z, cone.apex_radius}),
                                              kTolerance);
    const SceneGeometry& geometry = scene.geometry;
    const double length = glm::length(cone.apex - cone.base);
    const DVec3 axis = (cone.apex - cone.base) / length;
    const double slope = (cone.base_radius - cone.apex_radius) / length;
    // Where a point is: along the axis, away from it, and its direction away from it.
    const auto distance = [&](const DVec3& point) {
      const double along = glm::dot(point - cone.base, axis);
      const double away = glm::length(point - cone.base - axis * along);
      return std::fabs(away - (cone.base_radius - slope * along)) / std::sqrt(1 + slope * slope);
    };
    double farthest = 0;
    for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
      const UVec3& t = geometry.triangles[i];
      const DVec3 corners[3] = {DVec3(geometry.vertices[t.x]), DVec3(geometry.vertices[t.y]),
                                DVec3(geometry.vertices[t.z])};
      constexpr int kSteps = 12;
      for (int u = 0; u <= kSteps; ++u) {
        for (int v = 0; u + v <= kSteps; ++v) {
          const DVec3 point = (corners[0] * static_cast<double>(u) + corners[1] * static_cast<double>(v) +
                               corners[2] * static_cast<double>(kSteps - u - v)) /
                              static_cast<double>(kSteps);
          farthest = std::max(farthest, distance(point));
        }
      }
      const DVec3 facet = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
      for (int corner = 0; corner < 3; ++corner) {
        const DVec3 normal(geometry.normals[geometry.triangle_normals[i][corner]]);
        ASSERT_GT(glm::dot(normal, facet), 0.9) << "outwards";
        ASSERT_NEAR(glm::dot(normal, axis), slope / std::sqrt(1 + slope * slope), 1e-6) << "as steep as the cone";
        const double along = glm::dot(corners[corner] - cone.base, axis);
        const DVec3 away = corners[corner] - cone.base - axis * along;
        if (glm::length(away) < 0.01) continue;  // a point has the normals of its facets
        const DVec3 expected = glm::normalize(glm::normalize(away) + axis * slope);
        ASSERT_LT(glm::length(normal - expected), 1e-3) << "the cone's own normal";
      }
    }
    EXPECT_LE(farthest, static_cast<double>(kTolerance));
    EXPECT_GT(farthest, 0.3 * static_cast<double>(kTolerance)) << "no finer than need be";
    // Open: the edges of both ends, or of one where the other is a point, and no others.
    const bool is_pointed = cone.base_radius == 0 || cone.apex_radius == 0;
    const std::size_t segments = geometry.triangles.size() / (is_pointed ? 1 : 2);
    EXPECT_EQ(count_open_edges(geometry.triangles), segments * (is_pointed ? 1 : 2));
    EXPECT_EQ(geometry.vertices.size(), is_pointed ? segments + 1 : 2 * segments);
  }
}

TEST(RoundShapes, ToleranceIsRelativeToTheSceneUnlessItIsGiven) {
  const SceneDescription scene = read_good(std::string(kViewAndFill) + "s 0 0 0 1 p 3 0 0 0 3 4 0 -1 -1 0");
  EXPECT_FLOAT_EQ(scene.tolerance, static_cast<float>(1e-4 * std::sqrt(16.0 + 25.0 + 4.0)));
  SceneOptions coarse;
  coarse.relative_tolerance = 0.01f;
  EXPECT_LT(read_good(std::string(kViewAndFill) + "s 0 0 0 1", coarse).geometry.triangles.size(), 400u);
}

}  // namespace
}  // namespace gridiron::test
