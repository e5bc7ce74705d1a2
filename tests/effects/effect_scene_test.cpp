// Scenes in code: closed, turned outwards, and rendered by the reference as their names say.
// SPDX-License-Identifier: Apache-2.0
#include "effects/effect_scene.h"

#include <glm/geometric.hpp>

#include "effects/reference/reference_renderer.h"

namespace gridiron::test {
namespace {

using tool::SceneDescription;
using tool::SceneMaterial;

double volume_of(const tool::SceneGeometry& geometry) {
  double volume = 0.0;
  for (const UVec3& t : geometry.triangles) {
    const auto v = [&](std::uint32_t i) { return DVec3(geometry.vertices[i]); };
    volume += glm::dot(v(t.x), glm::cross(v(t.y), v(t.z))) / 6.0;
  }
  return volume;
}

bool is_closed(const tool::SceneGeometry& geometry) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const UVec3& t : geometry.triangles) {
    for (int k = 0; k < 3; ++k) {
      ++edges[{t[k], t[(k + 1) % 3]}];
      --edges[{t[(k + 1) % 3], t[k]}];
    }
  }
  for (const auto& [edge, count] : edges) {
    if (count != 0) return false;
  }
  return true;
}

TEST(EffectScene, BoxesAndBallsAreClosedAndTurnedOutwards) {
  SceneDescription box = empty_scene({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 45);
  add_box(box, {-1, -2, -3}, {1, 2, 3}, add_material(box, {}));
  EXPECT_TRUE(is_closed(box.geometry));
  EXPECT_NEAR(volume_of(box.geometry), 48.0, 1e-9);
  SceneDescription room = empty_scene({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 45);
  add_box(room, {-1, -2, -3}, {1, 2, 3}, add_material(room, {}), /*is_inwards=*/true);
  EXPECT_TRUE(is_closed(room.geometry));
  EXPECT_NEAR(volume_of(room.geometry), -48.0, 1e-9);
  SceneDescription ball = empty_scene({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 45);
  const SceneMaterial smooth{.smooth_normals = true};
  add_ball(ball, Vec3(0), 2, 16, add_material(ball, smooth));
  EXPECT_EQ(ball.geometry.triangles.size(), 8u * 16 * 16);
  EXPECT_EQ(ball.geometry.vertices.size(), 4u * 16 * 16 + 2);
  EXPECT_TRUE(is_closed(ball.geometry));
  EXPECT_NEAR(volume_of(ball.geometry), 4.0 / 3.0 * 3.14159265 * 8.0, 0.3);
  for (std::size_t id = 0; id < ball.geometry.triangles.size(); ++id) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 v = ball.geometry.vertices[ball.geometry.triangles[id][k]];
      const Vec3 n = ball.geometry.normals[ball.geometry.triangle_normals[id][k]];
      ASSERT_NEAR(glm::dot(v, n), 2.0f, 1e-5f);
    }
  }
}

TEST(EffectScene, FlatTrianglesBesideSmoothOnesHaveNoNormals) {
  SceneDescription scene = empty_scene({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 45);
  const SceneMaterial smooth{.smooth_normals = true};
  const std::uint16_t flat_material = add_material(scene, {});
  const std::uint16_t smooth_material = add_material(scene, smooth);
  add_parallelogram(scene, Vec3(0), {1, 0, 0}, {0, 1, 0}, flat_material);
  EXPECT_TRUE(scene.geometry.triangle_normals.empty());
  add_ball(scene, Vec3(0), 1, 1, smooth_material);
  add_parallelogram(scene, Vec3(0), {1, 0, 0}, {0, 1, 0}, flat_material);
  ASSERT_EQ(scene.geometry.triangle_normals.size(), 12u);
  for (std::size_t id = 0; id < 12; ++id) {
    EXPECT_EQ(scene.geometry.triangle_normals[id].x == tool::kNoNormal, id < 2 || id >= 10);
  }
  const std::uint32_t id = add_box(scene, Vec3(0), Vec3(1), smooth_material);
  ASSERT_EQ(scene.geometry.triangle_normals.size(), 24u);
  EXPECT_EQ(scene.geometry.normals[scene.geometry.triangle_normals[id].x], Vec3(-1, 0, 0));
}

// Nothing between the ball and a light right behind the eye, wherever the ball is and whatever its size.
TEST(EffectScene, NothingOfAnAcneSceneIsBlack) {
  for (const AcneLight light : {AcneLight::kPoint, AcneLight::kArea, AcneLight::kAmbient}) {
    for (const auto& [scale, offset] : {std::pair{1.0f, 0.0f}, {1e-6f, 0.0f}, {1e6f, 0.0f}, {1.0f, 100.0f}}) {
      const SceneDescription scene = acne_scene(light, scale, Vec3(offset));
      const ReferencePicture picture = render_reference(scene, 32, 32);
      std::size_t hits = 0;
      for (std::size_t i = 0; i < picture.ids.size(); ++i) {
        if (picture.ids[i] == kReferenceNoTriangle) continue;
        ++hits;
        EXPECT_GT(picture.linear[i].x, 0.0) << i << " at scale " << scale << ", offset " << offset;
        if (light == AcneLight::kAmbient) {
          EXPECT_NEAR(picture.linear[i].x, 0.5, 1e-12) << "convex: all is open";
        }
      }
      EXPECT_GT(hits, 500u);
    }
  }
}

}  // namespace
}  // namespace gridiron::test
