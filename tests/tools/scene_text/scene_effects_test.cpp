// Scene effects: text scenes as the image builder takes them, and what they call for.
// SPDX-License-Identifier: Apache-2.0
#include "scene_text/scene_effects.h"

#include "check_scene.h"
#include "support/test_headers.h"

namespace gridiron::test {
namespace {

using tool::SceneDescription;
using tool::SceneEffects;

const std::filesystem::path kFolder = std::filesystem::path(GRIDIRON_SOURCE_DIR) / "scenes";

TEST(SceneEffects, EachSceneCallsForItsEffect) {
  const struct {
    const char* name;
    std::uint32_t effects;
  } cases[] = {
      {"shadow", kPointShadows},         {"area_light", kAreaLights},
      {"mirror", kReflection},           {"glass", kRefraction | kReflection},  // glass mirrors, too
      {"highlight", kHighlights},        {"ambient_occlusion", kAmbientOcclusion},
      {"environment", kEnvironment},     {"smooth_normals", kSmoothNormals},
      {"multisampling", kMultisampling}, {"everything", kAllEffects & ~kVertexColors},
  };
  for (const auto& of : cases) {
    SCOPED_TRACE(of.name);
    SceneDescription scene = tool::read_scene_text(kFolder / (std::string(of.name) + ".nff"));
    const std::size_t triangles = scene.geometry.triangles.size();
    const SceneEffects effects = tool::take_scene_effects(scene);
    EXPECT_EQ(effects_called_for(effects.view()), of.effects | kSceneShading);
    EXPECT_EQ(check_effects(tool::mesh_view(scene), effects.view()), Status::kOk);
    EXPECT_EQ(tool::mesh_view(scene).triangles.size(), triangles);
    EXPECT_EQ(effects.triangle_materials.size(), triangles);
    EXPECT_FALSE(effects.materials.empty());
  }
}

TEST(SceneEffects, EveryValueArrives) {
  SceneDescription scene = read_good(
      "v from 0 0 9 at 0 0 0 up 0 1 0 angle 40 hither 0 resolution 8 6 b 0.1 0.2 0.3\n"
      "la 1 2 3  1 0 0  0 2 0  4 5 6  7  l 9 8 7 0.5 0.25 0.125\n"
      "ao 3 2.5 ms 16 d 7 sh off\n"
      "f 0.5 0.6 0.7 0.8 0.3 25 0.1 1.5 s 0 0 0 1  sn off f 1 1 1 1 0 0 0 0 p 3 5 0 0 6 0 0 5 1 0");
  const std::size_t triangles = scene.geometry.triangles.size();
  const SceneEffects first = tool::take_scene_effects(scene);
  const SceneEffects effects = SceneEffects(first);
  const EffectsView view = effects.view();

  ASSERT_EQ(view.lights.size(), 2u);
  EXPECT_EQ(view.lights[0].samples, 0u) << "points first, whatever the text's order";
  EXPECT_EQ(view.lights[0].corner, Vec3(9, 8, 7));
  EXPECT_EQ(view.lights[0].color, Vec3(0.5f, 0.25f, 0.125f));
  EXPECT_EQ(view.lights[1].samples, 7u);
  EXPECT_EQ(view.lights[1].corner, Vec3(1, 2, 3));
  EXPECT_EQ(view.lights[1].edge_u, Vec3(1, 0, 0));
  EXPECT_EQ(view.lights[1].edge_v, Vec3(0, 2, 0));
  EXPECT_EQ(view.lights[1].color, Vec3(4, 5, 6));

  ASSERT_EQ(view.materials.size(), 2u);
  const Material& ball = view.materials[0];
  EXPECT_EQ(ball.color, Vec3(0.5f, 0.6f, 0.7f));
  EXPECT_EQ(ball.kd, 0.8f);
  EXPECT_EQ(ball.ks, 0.3f);
  EXPECT_EQ(ball.shine, 25.0f);
  EXPECT_EQ(ball.transmittance, 0.1f);
  EXPECT_EQ(ball.index, 1.5f);
  EXPECT_TRUE(ball.smooth_normals);
  EXPECT_FALSE(view.materials[1].smooth_normals);
  ASSERT_EQ(view.triangle_materials.size(), triangles);
  ASSERT_EQ(view.triangle_normals.size(), triangles);
  EXPECT_EQ(view.triangle_materials[0], 0u);
  EXPECT_EQ(view.triangle_materials[triangles - 1], 1u);
  EXPECT_LT(view.triangle_normals[0].x, view.normals.size());
  EXPECT_EQ(view.triangle_normals[triangles - 1], UVec3(kNoNormals));

  EXPECT_EQ(view.background, Vec3(0.1f, 0.2f, 0.3f));
  EXPECT_FALSE(view.has_shadows);
  EXPECT_EQ(view.recursion_depth, 7u);
  EXPECT_EQ(view.samples_per_pixel, 16u);
  EXPECT_EQ(view.occlusion_samples, 3u);
  EXPECT_EQ(view.occlusion_radius, 2.5f);
  EXPECT_EQ(view.environment_width, 0u);
  EXPECT_EQ(effects_called_for(view), kAllEffects & ~kPointShadows & ~kEnvironment & ~kVertexColors);
}

TEST(SceneEffects, FacesKeepTheirOrder) {
  SceneDescription scene = tool::read_scene_text(kFolder / "environment.nff");
  ASSERT_TRUE(scene.environment.has_value());
  const tool::EnvironmentMap map = *scene.environment;
  const SceneEffects effects = tool::take_scene_effects(scene);
  const EffectsView view = effects.view();
  EXPECT_EQ(view.environment_width, map.width);
  for (std::size_t face = 0; face < tool::kCubeFaceCount; ++face) {
    ASSERT_EQ(view.environment_faces[face].size(), std::size_t{map.width} * map.width);
    EXPECT_TRUE(std::equal(map.texels[face].begin(), map.texels[face].end(), view.environment_faces[face].begin()));
  }
  EXPECT_TRUE(scene.environment->texels[0].empty()) << "taken, not copied";
}

TEST(SceneEffects, SpansOutliveAMove) {
  SceneDescription scene = tool::read_scene_text(kFolder / "everything.nff");
  SceneEffects effects = tool::take_scene_effects(scene);
  const EffectsView before = effects.view();
  const SceneEffects moved = std::move(effects);
  const EffectsView after = moved.view();
  EXPECT_EQ(before.materials.data(), after.materials.data());
  EXPECT_EQ(before.normals.data(), after.normals.data());
  EXPECT_EQ(before.environment_faces[5].data(), after.environment_faces[5].data());
}

}  // namespace
}  // namespace gridiron::test
