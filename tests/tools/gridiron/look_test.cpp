// Looks of meshes: words of colours and lights, normals with creases, what each part calls for.
// SPDX-License-Identifier: Apache-2.0
#include "gridiron/scene/look.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

#include "base/failure.h"
#include "gridiron/scene/crease_normals.h"
#include "gridiron/scene/scene_points.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using tool::LookRequest;
using tool::SceneInput;

SceneInput input_of(const TestMesh& mesh) {
  return {.path = "mesh.ply", .content = tool::Mesh{.vertices = mesh.vertices, .triangles = mesh.triangles}};
}

// The scene with its look, seen from the default side.
SceneInput with_look(SceneInput input, const LookRequest& request) {
  const tool::PointSource points = [&input](const tool::PointVisitor& visitor) {
    tool::visit_points(std::get<tool::Mesh>(input.content).view(), visitor);
  };
  const Camera camera = tool::complete_view({}, 1, points);
  tool::apply_look(input, request, camera, tool::look_bounds_of(points, tool::kUsualUp));
  return input;
}

std::uint32_t calls_of(const SceneInput& input) {
  const auto& mesh = std::get<tool::Mesh>(input.content);
  EXPECT_EQ(check_effects(mesh.view(), input.effects->view()), Status::kOk);
  return effects_called_for(input.effects->view());
}

TEST(Colors, AreReadAsSrgb) {
  EXPECT_EQ(tool::parse_color("ffffff"), Vec3(1));
  EXPECT_EQ(tool::parse_color("#000000"), Vec3(0));
  EXPECT_EQ(tool::parse_color("white"), Vec3(1));
  const Vec3 mixed = tool::parse_color("#80Ff00").value();
  EXPECT_NEAR(mixed.x, 0.2158605, 1e-6);
  EXPECT_EQ(mixed.y, 1.0f);
  EXPECT_EQ(mixed.z, 0.0f);
  for (const std::string_view name : tool::color_names()) EXPECT_TRUE(tool::parse_color(name)) << name;
  for (const char* const wrong : {"", "#", "fff", "#fffffff", "ggffff", "White", "ff ff0"}) {
    EXPECT_FALSE(tool::parse_color(wrong)) << wrong;
  }
}

TEST(Lights, AreAListOfWords) {
  const auto lights = [](const char* text) { return tool::parse_lights(text).value(); };
  EXPECT_FALSE(lights("none").head || lights("none").key || lights("none").area);
  EXPECT_TRUE(lights("key,area").key && lights("key,area").area && !lights("key,area").head);
  EXPECT_TRUE(lights("head").head);
  for (const char* const wrong : {"", ",", "key,", "key,key", "none,key", "lamp", "key area"}) {
    EXPECT_FALSE(tool::parse_lights(wrong)) << wrong;
  }
}

// Two squares that meet at an angle, without shared vertices.
TestMesh bent_sheet(double degrees) {
  const auto c = static_cast<float>(std::cos(degrees * 0.017453292519943295));
  const auto s = static_cast<float>(std::sin(degrees * 0.017453292519943295));
  const Vec3 a(0, 0, 0), b(0, 1, 0), left_a(-1, 0, 0), left_b(-1, 1, 0), right_a(c, 0, -s), right_b(c, 1, -s);
  TestMesh mesh;
  mesh.append(make_triangle(left_a, a, b));
  mesh.append(make_triangle(left_a, b, left_b));
  mesh.append(make_triangle(a, right_a, right_b));
  mesh.append(make_triangle(a, right_b, b));
  return mesh;
}

TEST(CreaseNormals, AreSmoothBelowTheAngleAndSharpAbove) {
  const TestMesh mesh = bent_sheet(40);
  const auto normal_at = [&mesh](float limit, std::uint32_t triangle, int corner) {
    const tool::MeshNormals made = tool::make_crease_normals(mesh.vertices, mesh.triangles, limit);
    return made.normals[made.triangles[triangle][corner]];
  };
  for (const float limit : {0.0f, 39.9f}) {
    EXPECT_NEAR(normal_at(limit, 0, 1).z, 1, 1e-6) << limit;
    EXPECT_NEAR(normal_at(limit, 2, 0).z, std::cos(40 * 0.0174533), 1e-5) << limit;
  }
  for (const float limit : {40.1f, 180.0f}) {
    EXPECT_NEAR(glm::length(normal_at(limit, 0, 1) - normal_at(limit, 2, 0)), 0, 1e-6) << limit;
    EXPECT_NEAR(normal_at(limit, 0, 1).x, std::sin(20 * 0.0174533), 0.1) << limit;
    EXPECT_NEAR(normal_at(limit, 0, 0).z, 1, 1e-6) << "far from the edge";
  }
}

// At most: the angle itself is smooth.
TEST(CreaseNormals, OfARightAngleAreSmoothAtNinety) {
  const TestMesh mesh = bent_sheet(90);
  const auto joined_at = [&mesh](float limit) {
    const tool::MeshNormals made = tool::make_crease_normals(mesh.vertices, mesh.triangles, limit);
    return made.triangles[0].y == made.triangles[2].x;
  };
  EXPECT_TRUE(joined_at(90));
  EXPECT_FALSE(joined_at(89.9f));
}

TEST(CreaseNormals, OfABallAreTheBalls) {
  const TestMesh ball = make_sphere(24, 48, 2.0f);
  const tool::MeshNormals made = tool::make_crease_normals(ball.vertices, ball.triangles, 35);
  for (std::size_t i = 0; i < ball.triangles.size(); ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      const Vec3 out = glm::normalize(ball.vertices[ball.triangles[i][corner]]);
      EXPECT_GT(glm::dot(out, made.normals[made.triangles[i][corner]]), 0.999f);
    }
  }
}

TEST(CreaseNormals, TakeWhatHasNoArea) {
  TestMesh mesh = make_triangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0});
  mesh.append(make_triangle({0, 0, 0}, {1, 0, 0}, {2, 0, 0}));
  mesh.append(make_triangle({0, 0, 0}, {1e30f, 0, 0}, {0, 1e30f, 0}));
  const tool::MeshNormals made = tool::make_crease_normals(mesh.vertices, mesh.triangles, 35);
  ASSERT_EQ(made.triangles.size(), 3u);
  for (const Vec3& normal : made.normals) EXPECT_NEAR(glm::length(normal), 1, 1e-6);
}

// As many materials as there may be, each with a triangle that has colours: there is no room for half of them again.
TEST(Look, ColoursWithoutAMaterialAreCounted) {
  constexpr std::uint32_t kMaterials = 40000, kRoom = tool::kMostSceneMaterials - 1 - kMaterials;
  TestMesh triangles;
  for (std::uint32_t i = 0; i < kMaterials; ++i) {
    const float x = static_cast<float>(i) / 4096;
    triangles.append(make_triangle({x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}));
  }
  const auto colorless = [&](std::uint32_t materials) {
    SceneInput input = input_of(triangles);
    tool::MeshSurface& surface = std::get<tool::Mesh>(input.content).surface;
    surface.materials.resize(materials);
    surface.colors = {Vec3(1, 0, 0)};
    surface.triangle_colors.assign(kMaterials, UVec3(0));
    for (std::uint32_t i = 0; i < kMaterials; ++i) {
      surface.triangle_materials.push_back(static_cast<std::uint16_t>(i % materials));
    }
    return with_look(std::move(input), {.is_studio = true}).colorless_triangles;
  };
  EXPECT_EQ(colorless(kMaterials), kMaterials - kRoom);
  EXPECT_EQ(colorless(100), 0u);
}

// Each part alone calls for its own effect and nothing else.
TEST(Look, PartsCallForTheirEffects) {
  constexpr std::uint32_t kPlain = kSceneShading | kPointShadows | kHighlights;  // of the light at the eye
  const struct {
    const char* name;
    LookRequest request;
    std::uint32_t effects;
  } cases[] = {
      {"studio", {.is_studio = true},
       kSceneShading | kHighlights | kAreaLights | kAmbientOcclusion | kSmoothNormals | kMultisampling},
      {"background", {.background = Vec3(0)}, kPlain},
      {"color", {.color = Vec3(1, 0, 0)}, kPlain},
      {"ground", {.ground = true}, kPlain},
      {"no light", {.lights = tool::LookLights{}}, kSceneShading},
      {"area", {.lights = tool::LookLights{.area = true}}, kPlain | kAreaLights},
      {"ao", {.occlusion = 4}, kPlain | kAmbientOcclusion},
      {"no ao", {.occlusion = 0}, kPlain},
      {"samples", {.samples = 16}, kPlain | kMultisampling},
      {"smooth", {.smooth_degrees = 30.0f}, kPlain | kSmoothNormals},
      {"facets", {.smooth_degrees = 0.0f}, kPlain},
      {"levels", {.levels = ColorLevels::kSrgb}, kPlain},
  };
  for (const auto& part : cases) {
    EXPECT_TRUE(part.request.is_given()) << part.name;
    const SceneInput made = with_look(input_of(make_sphere(8, 12, 1)), part.request);
    EXPECT_EQ(calls_of(made), part.effects) << part.name;
  }
  EXPECT_FALSE(LookRequest{}.is_given());
}

// The mesh stays what and where it was; the ground comes behind it, below it, and does not touch it.
TEST(Look, TheGroundLiesBelow) {
  const TestMesh ball = make_sphere(8, 12, 3.0f);
  const SceneInput made = with_look(input_of(ball), {.is_studio = true});
  const auto& mesh = std::get<tool::Mesh>(made.content);
  ASSERT_GT(mesh.triangles.size(), ball.triangles.size());
  EXPECT_TRUE(std::equal(ball.triangles.begin(), ball.triangles.end(), mesh.triangles.begin()));
  EXPECT_TRUE(std::equal(ball.vertices.begin(), ball.vertices.end(), mesh.vertices.begin()));
  for (std::size_t i = ball.vertices.size(); i < mesh.vertices.size(); ++i) {
    EXPECT_LT(mesh.vertices[i].y, -3.0f);
    EXPECT_GT(mesh.vertices[i].y, -3.01f);
  }
  for (std::size_t i = ball.triangles.size(); i < mesh.triangles.size(); ++i) {
    const UVec3& t = mesh.triangles[i];
    const Vec3 up = glm::cross(mesh.vertices[t.y] - mesh.vertices[t.x], mesh.vertices[t.z] - mesh.vertices[t.x]);
    EXPECT_GT(up.y, 0) << "it is wound to be seen from above";
  }
}

// From above the camera's up lies in the ground; the ground follows that of the world.
TEST(Look, TheGroundFollowsUpFromAnySide) {
  for (const double elevation : {-90.0, 0.0, 90.0}) {
    SceneInput input = input_of(make_sphere(8, 12, 1));
    const tool::PointSource points = [&input](const tool::PointVisitor& visitor) {
      tool::visit_points(std::get<tool::Mesh>(input.content).view(), visitor);
    };
    tool::ViewRequest view;
    view.from = tool::ViewAngles{.azimuth = 0, .elevation = elevation};
    view.up = Vec3(0, 0, 1);
    const tool::LookBounds bounds = tool::look_bounds_of(points, {0, 0, 1});
    const std::size_t own = std::get<tool::Mesh>(input.content).vertices.size();
    tool::apply_look(input, {.is_studio = true}, tool::complete_view(view, 1, points), bounds);
    const auto& mesh = std::get<tool::Mesh>(input.content);
    for (std::size_t i = own; i < mesh.vertices.size(); ++i) {
      EXPECT_LT(mesh.vertices[i].z, -0.9f) << elevation;
      EXPECT_GT(mesh.vertices[i].z, -1.1f) << elevation;
    }
  }
}

// Below every vertex, nearly touching: whatever up is, and where the ground's own vertices are rounded.
TEST(Look, TheGroundLiesJustBelow) {
  for (const Vec3& up : {Vec3(0, 1, 0), Vec3(0, 0, -2), Vec3(1, 1, 0), Vec3(0.3f, -0.5f, 0.8f)}) {
    for (const float away : {0.0f, 1e5f}) {
      TestMesh sphere = make_sphere(16, 24, 1);
      for (Vec3& vertex : sphere.vertices) vertex += away;
      SceneInput input = input_of(sphere);
      const tool::PointSource points = [&sphere](const tool::PointVisitor& visitor) { visitor(sphere.vertices); };
      const tool::LookBounds bounds = tool::look_bounds_of(points, up);
      tool::apply_look(input, {.is_studio = true}, tool::complete_view({}, 1, points), bounds);
      const DVec3 unit = tool::unit_or_zero(DVec3(up));
      double lowest = std::numeric_limits<double>::infinity();
      for (const Vec3& vertex : sphere.vertices) lowest = std::min(lowest, glm::dot(unit, DVec3(vertex)));
      const auto& mesh = std::get<tool::Mesh>(input.content);
      for (std::size_t i = sphere.vertices.size(); i < mesh.vertices.size(); ++i) {
        const double height = glm::dot(unit, DVec3(mesh.vertices[i]));
        EXPECT_LT(height, lowest) << away;
        EXPECT_GT(height, lowest - (away == 0 ? 0.001 : 0.1)) << away;
      }
    }
  }
}

TEST(Look, MayDisappointAndSaysWhy) {
  const auto notes = [](float away, const Vec3& eye) {
    TestMesh sphere = make_sphere(8, 12, 1);
    for (Vec3& vertex : sphere.vertices) vertex.x += away;
    SceneInput input = input_of(sphere);
    const tool::PointSource points = [&sphere](const tool::PointVisitor& visitor) { visitor(sphere.vertices); };
    const Camera camera{eye + Vec3(away, 0, 0), Vec3(away, 0, 0), {0, 0, 1}, 0.5f};
    tool::apply_look(input, {.is_studio = true}, camera, tool::look_bounds_of(points, tool::kUsualUp));
    return input.look_notes;
  };
  EXPECT_TRUE(notes(0, {0, 0.5f, 5}).empty());
  ASSERT_EQ(notes(1e5f, {0, 0.5f, 5}).size(), 1u);
  EXPECT_NE(notes(1e5f, {0, 0.5f, 5})[0].find("far from the origin"), std::string::npos);
  ASSERT_EQ(notes(0, {0, -5, 0.1f}).size(), 1u);
  EXPECT_NE(notes(0, {0, -5, 0.1f})[0].find("--ground off"), std::string::npos);
}

TEST(Look, ColorsOfTheFileAreKeptUnlessOneIsGiven) {
  const auto input = [] {
    SceneInput made = input_of(make_sphere(8, 12, 1));
    auto& mesh = std::get<tool::Mesh>(made.content);
    mesh.surface.colors.assign(mesh.vertices.size(), Vec3(0.25f, 0.5f, 1));
    mesh.surface.triangle_colors = mesh.triangles;
    mesh.surface.triangle_colors[0] = UVec3(tool::kNoNormal);
    return made;
  };
  const SceneInput colored = with_look(input(), {.is_studio = true});
  EXPECT_EQ(calls_of(colored) & kVertexColors, kVertexColors);
  EXPECT_EQ(colored.effects->triangle_colors[0], UVec3(tool::kNoNormal));
  EXPECT_NE(colored.effects->triangle_materials[0], colored.effects->triangle_materials[1]);
  const SceneInput plain = with_look(input(), {.is_studio = true, .color = Vec3(1, 0, 0)});
  EXPECT_EQ(calls_of(plain) & kVertexColors, 0u);
  EXPECT_EQ(plain.effects->materials[0].color, Vec3(1, 0, 0));
  const SceneInput flat = with_look(input(), {.smooth_degrees = 0.0f});
  EXPECT_EQ(calls_of(flat) & kVertexColors, kVertexColors) << "facets have colours too";
}

TEST(Look, IsOfMeshesAndInPartOfTextScenes) {
  EXPECT_NO_THROW(tool::check_look({}, tool::SceneKind::kPacked));
  EXPECT_THROW(tool::check_look({.samples = 4}, tool::SceneKind::kPacked), tool::Failure);
  EXPECT_NO_THROW(tool::check_look({.is_studio = true, .color = Vec3(1)}, tool::SceneKind::kMesh));
  EXPECT_NO_THROW(tool::check_look({.background = Vec3(0), .samples = 4, .occlusion = 2, .levels = ColorLevels::kSrgb},
                                   tool::SceneKind::kText));
  for (const LookRequest& request :
       {LookRequest{.is_studio = true}, LookRequest{.color = Vec3(1)}, LookRequest{.ground = false},
        LookRequest{.lights = tool::LookLights{}}, LookRequest{.smooth_degrees = 3.0f}}) {
    EXPECT_THROW(tool::check_look(request, tool::SceneKind::kText), tool::Failure);
  }
}

}  // namespace
}  // namespace gridiron::test
