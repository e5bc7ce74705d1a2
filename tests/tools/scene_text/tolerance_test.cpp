// The tolerance of round shapes that a picture allows. SPDX-License-Identifier: Apache-2.0
#include <glm/common.hpp>

#include "check_scene.h"
#include "failure_of.h"
#include "scene_makers/procedural.h"
#include "support/test_headers.h"

namespace gridiron::test {
namespace {

using tool::SceneDescription;
using tool::SceneOptions;
using tool::SceneRoundness;
using tool::ToleranceRule;

SceneDescription read(const std::string& text, const SceneOptions& options) {
  return tool::read_scene_text(text, "made.nff", options);
}

using Change = std::function<void(tool::ScenePicture&)>;

// @param change  makes another picture of the scene's own.
SceneOptions for_its_picture(std::uint64_t many = 1000, const Change& change = {}) {
  SceneOptions options;
  options.picture = [change](const tool::SceneView& own, const tool::PointSource&) {
    tool::ScenePicture picture{own.from, std::tan(own.angle_degrees * 3.14159265f / 360), own.height};
    if (change) change(picture);
    return picture;
  };
  options.many_triangles = many;
  return options;
}

TEST(Tolerance, FewTrianglesStayAsTheyAre) {
  const std::string text = scene_makers::make_lattice(1);
  const SceneDescription plain = read(text, {});
  const SceneDescription scene = read(text, for_its_picture(tool::kManyRoundTriangles));
  EXPECT_EQ(scene.roundness.rule, ToleranceRule::kDiagonal);
  EXPECT_EQ(scene.roundness.least_tolerance, plain.tolerance);
  EXPECT_EQ(scene.roundness.most_tolerance, plain.tolerance);
  EXPECT_EQ(scene.geometry.vertices, plain.geometry.vertices);
}

TEST(Tolerance, ManyBecomeFewerWhereThePictureHidesIt) {
  for (const std::string& text : {scene_makers::make_lattice(3), scene_makers::make_shells(1)}) {
    const SceneDescription plain = read(text, {}), scene = read(text, for_its_picture());
    const SceneRoundness& roundness = scene.roundness;
    EXPECT_EQ(roundness.rule, ToleranceRule::kPicture);
    EXPECT_EQ(roundness.diagonal_tolerance, plain.tolerance);
    EXPECT_GE(roundness.least_tolerance, plain.tolerance);
    EXPECT_GT(roundness.most_tolerance, plain.tolerance);
    EXPECT_LE(roundness.most_tolerance, 16.001f * plain.tolerance);
    EXPECT_LT(4 * scene.geometry.triangles.size(), 3 * plain.geometry.triangles.size());
    EXPECT_GE(roundness.diagonal_triangles, plain.geometry.triangles.size());
    EXPECT_LE(roundness.diagonal_triangles, plain.geometry.triangles.size() * 5 / 4);
    // A finer picture needs more, and one that is seen from within as many as the diagonal gives where the eye is.
    const SceneOptions finer = for_its_picture(1000, [](tool::ScenePicture& picture) { picture.height *= 4; });
    EXPECT_GT(read(text, finer).geometry.triangles.size(), scene.geometry.triangles.size());
    const SceneOptions narrow = for_its_picture(1000, [](tool::ScenePicture& picture) { picture.tan_half_fov /= 8; });
    EXPECT_GT(read(text, narrow).geometry.triangles.size(), scene.geometry.triangles.size());
    const SceneOptions far = for_its_picture(1000, [](tool::ScenePicture& picture) { picture.eye *= 100.0f; });
    EXPECT_LT(read(text, far).geometry.triangles.size(), scene.geometry.triangles.size());
  }
}

TEST(Tolerance, NearObjectsAreFinerThanFarOnes) {
  const std::string view = "v\nfrom 0 0 0\nat 0 0 -1\nup 0 1 0\nangle 45\nhither 0\nresolution 64 64\n";
  const std::string text = view + "f 1 1 1 1 0 0 0 1\ns 0 0 -2 1\ns 0 0 -200 1\n";
  const SceneDescription scene = read(text, for_its_picture(1));
  std::size_t near = 0, far = 0;
  for (const auto& triangle : scene.geometry.triangles) {
    (scene.geometry.vertices[triangle.x].z > -100 ? near : far) += 1;
  }
  EXPECT_GT(near, far);
  EXPECT_GE(far, 20u * 9) << "a thirty-second of the radius at most";
}

TEST(Tolerance, ObjectsAlikeHaveOne) {
  const std::string view = "v\nfrom 0 0 0\nat 0 0 -1\nup 0 1 0\nangle 45\nhither 0\nresolution 64 64\n";
  const std::string text = view + "f 1 1 1 1 0 0 0 1\ns 0 0 -200 1\n";
  const SceneRoundness far = read(text, for_its_picture(1)).roundness;
  EXPECT_EQ(far.rule, ToleranceRule::kPicture);
  EXPECT_EQ(far.least_tolerance, far.most_tolerance);
  EXPECT_GT(far.least_tolerance, far.diagonal_tolerance);
  // A picture that shows everything as finely as the diagonal's tolerance chooses nothing.
  const float share = 4 * far.diagonal_tolerance / 199 * 32;  // a quarter of it is the diagonal's in 64 pixels
  for (const float nearness : {1e-5f, 1.01f * share}) {
    const auto enlarge = [nearness](tool::ScenePicture& picture) { picture.tan_half_fov = nearness; };
    const SceneDescription near = read(text, for_its_picture(1, enlarge));
    EXPECT_EQ(near.roundness.rule, ToleranceRule::kDiagonal);
    EXPECT_EQ(near.roundness.least_tolerance, near.tolerance);
    EXPECT_EQ(near.roundness.most_tolerance, near.tolerance);
  }
}

TEST(Tolerance, PictureIsAskedWithPointsAroundAllShapes) {
  DVec3 low(1e9), high(-1e9);
  SceneOptions options;
  options.many_triangles = 1;
  options.picture = [&](const tool::SceneView& own, const tool::PointSource& points) {
    EXPECT_FALSE(own.is_given());
    points([&](std::span<const Vec3> some) {
      for (const Vec3& point : some) {
        low = glm::min(low, DVec3(point));
        high = glm::max(high, DVec3(point));
      }
    });
    return tool::ScenePicture{Vec3(0, 0, 100), 0.4f, 64};
  };
  (void)read("f 1 1 1 1 0 0 0 1\ns -2 0 0 1\nc 5 0 0 1  5 7 0 0.5\np 3 0 0 -9  1 0 -9  0 1 -9\n", options);
  EXPECT_NEAR(low.x, -3, 0.06);
  EXPECT_NEAR(low.y, -1, 0.06);
  EXPECT_EQ(low.z, -9);
  EXPECT_NEAR(high.x, 6, 0.06);
  EXPECT_NEAR(high.y, 7, 0.06);
  EXPECT_NEAR(high.z, 1, 0.06);
}

TEST(Tolerance, WhatIsAskedForIsKept) {
  SceneOptions options = for_its_picture(1);
  options.tolerance = 0.001f;
  const SceneDescription scene = read(scene_makers::make_lattice(2), options);
  EXPECT_EQ(scene.roundness.rule, ToleranceRule::kAsked);
  EXPECT_EQ(scene.roundness.most_tolerance, 0.001f);
}

TEST(Tolerance, OneThatMakesFewEnoughIsKnown) {
  const std::string text = scene_makers::make_lattice(3);
  const SceneDescription scene = read(text, {});
  const std::uint64_t most = scene.geometry.triangles.size() / 4;
  const std::optional<float> tolerance = tool::tolerance_for(scene.roundness, most);
  ASSERT_TRUE(tolerance);
  SceneOptions options;
  options.tolerance = tolerance;
  const std::size_t triangles = read(text, options).geometry.triangles.size();
  EXPECT_LE(triangles, most);
  EXPECT_GE(triangles, most / 3) << "not coarser than it must be";
  EXPECT_FALSE(tool::tolerance_for(scene.roundness, 10)) << "no ball has so few";

  // A scene of too many triangles says so.
  SceneOptions few;
  few.most_triangles = static_cast<std::uint32_t>(most);
  const std::string words = failure_of([&] { return read(text, few); });
  EXPECT_NE(words.find("--tolerance 0.00"), std::string::npos) << words;
}

}  // namespace
}  // namespace gridiron::test
