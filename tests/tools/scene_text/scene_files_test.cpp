// The scenes of the repository: readable, sound, and each calls for what it says.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#include "check_scene.h"
#include "scene_makers/procedural.h"
#include "support/test_headers.h"

namespace gridiron::test {
namespace {

using tool::SceneDescription;

const std::filesystem::path kSceneFolder = std::filesystem::path(GRIDIRON_SOURCE_DIR) / "scenes";

// The effects that a scene's lights, materials and settings call for, computed in the simplest way.
std::set<std::string> called_for(const SceneDescription& scene) {
  std::set<std::string> effects;
  if (scene.shadows && !scene.point_lights.empty()) effects.insert("point shadows");
  if (scene.shadows && !scene.area_lights.empty()) effects.insert("area shadows");
  if (scene.environment) effects.insert("environment");
  if (scene.ambient_occlusion) effects.insert("ambient occlusion");
  if (scene.samples_per_pixel > 1) effects.insert("multisampling");
  for (const tool::SceneMaterial& material : scene.materials) {
    if (material.smooth_normals) effects.insert("smooth normals");
    if (material.ks > 0 && material.shine > 0) effects.insert("highlights");
    if (material.ks > 0 && scene.recursion_depth > 1) effects.insert("reflection");
    if (material.transmittance > 0 && scene.recursion_depth > 1) effects.insert("refraction");
  }
  return effects;
}

TEST(SceneFiles, EachCallsForItsEffectAndNoOther) {
  struct Case {
    const char* name;
    std::set<std::string> effects;
  };
  const Case cases[] = {
      {"shadow", {"point shadows"}},
      {"area_light", {"area shadows"}},
      {"mirror", {"reflection"}},
      {"glass", {"refraction"}},
      {"highlight", {"highlights"}},
      {"ambient_occlusion", {"ambient occlusion"}},
      {"environment", {"environment"}},
      {"smooth_normals", {"smooth normals"}},
      {"multisampling", {"multisampling"}},
      {"everything",
       {"point shadows", "area shadows", "reflection", "refraction", "highlights", "ambient occlusion", "environment",
        "smooth normals", "multisampling"}},
  };
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kSceneFolder))
    files += entry.path().extension() == ".nff";
  EXPECT_EQ(files, std::size(cases)) << "a scene that this test does not know";
  for (const Case& of : cases) {
    SCOPED_TRACE(of.name);
    const SceneDescription scene = tool::read_scene_text(kSceneFolder / (std::string(of.name) + ".nff"));
    expect_sound(scene);
    EXPECT_EQ(called_for(scene), of.effects);
    EXPECT_TRUE(scene.notes.empty()) << scene.notes[0].text;
  }
}

TEST(SceneFiles, TheSkyIsItsMakers) {
  for (std::uint32_t face = 0; face < 6; ++face) {
    const std::filesystem::path path = kSceneFolder / (std::string("sky_") + scene_makers::kFaceNames[face] + ".pfm");
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    EXPECT_EQ(bytes, scene_makers::make_sky_face(face, 16)) << path;
    EXPECT_LE(bytes.size(), 8192u);
  }
}

}  // namespace
}  // namespace gridiron::test
