// The scenes of the effects experiment. SPDX-License-Identifier: Apache-2.0
#include "experiment/effect_scenes.h"

#include <algorithm>
#include <cstring>
#include <glm/geometric.hpp>
#include <utility>

#include "scene_makers/procedural.h"
#include "scene_text/scene_effects.h"
#include "scene_text/scene_reader.h"

namespace gridiron::experiment {
namespace {

constexpr std::uint32_t kSkyWidth = 32;

// scenes/everything.nff without the files that it names: the teapot is a ball here.
constexpr std::string_view kGallery = R"(v
from 4 3.5 9
at 0 1.1 0
up 0 1 0
angle 40
hither 0
resolution 96 96
l -3 6 8  0.5 0.5 0.5
la 2 6 2  1.5 0 0  0 0 1.5  0.5 0.5 0.45  4
ao 4 1
ms 4
d 5
f 0.8 0.75 0.65  1 0 0 0 0
p 4
  -4 0  4
   4 0  4
   4 0 -4
  -4 0 -4
f 0.9 0.85 0.7  0.3 0.6 60 0 0
s -1.2 0.9 0.5 0.9
f 1 1 1  0.05 0.1 100 0.9 1.5
s 2 0.8 0.5 0.8
f 0.35 0.55 0.8  0.9 0 0 0 0
c 1.5 0 -1.8 0.6
  1.5 1.2 -1.8 0.3
pp 3
  -3 0 -2    0 0.3 1
  -1 0 -2    0.3 0.3 1
  -2 2 -2.5  0 0.6 1
p 7
  -3.5 0 -3
   3.5 0 -3
   3.5 2 -3
   0.6 2 -3
   0 1 -3
  -0.6 2 -3
  -3.5 2 -3
)";

// The faces of the sky, made as bytes of PFM files: little-endian floats, the lowest row first.
tool::EnvironmentMap make_sky() {
  tool::EnvironmentMap sky;
  sky.width = kSkyWidth;
  constexpr std::size_t kRowTexels = kSkyWidth, kTexels = kRowTexels * kRowTexels;
  for (std::uint32_t face = 0; face < tool::kCubeFaceCount; ++face) {
    const std::vector<char> bytes = scene_makers::make_sky_face(face, kSkyWidth);
    const char* texels = bytes.data() + (bytes.size() - kTexels * sizeof(float[3]));
    sky.texels[face].resize(kTexels);
    for (std::size_t i = 0; i < kTexels; ++i) {
      const std::size_t row = kRowTexels - 1 - i / kRowTexels, column = i % kRowTexels;
      float color[3];
      std::memcpy(color, texels + i * sizeof color, sizeof color);
      sky.texels[face][row * kRowTexels + column] = Vec3(color[0], color[1], color[2]);
    }
  }
  return sky;
}

// A light on the camera's left, as wide as a tenth of the distance to the point it looks at.
tool::AreaLight light_beside(const tool::SceneView& view) {
  const Vec3 forward = view.at - view.from;
  const Vec3 right = glm::cross(forward, view.up), up = glm::cross(right, forward);
  const float distance = glm::length(forward);
  const Vec3 edge_u = right * (0.1f * distance / glm::length(right));
  const Vec3 edge_v = up * (0.1f * distance / glm::length(up));
  return {.corner = view.from - 5.0f * edge_u + 3.0f * edge_v,
          .edge_u = edge_u,
          .edge_v = edge_v,
          .color = {0.5f, 0.5f, 0.45f},
          .samples = 4};
}

// The existing lights are dimmed, so that pictures are not too bright.
void add_area_light(tool::SceneDescription& scene) {
  for (tool::PointLight& light : scene.point_lights) light.color *= 0.5f;
  scene.area_lights.push_back(light_beside(scene.view));
}

}  // namespace

tool::SceneDescription read_effect_scene(std::string_view key, std::string_view text) {
  tool::SceneOptions options;
  options.relative_tolerance = 5e-4f;
  return tool::read_scene_text(text, std::string(key), options);
}

tool::AmbientOcclusion occlusion_of(const tool::SceneView& view) {
  return {.samples = 4, .radius = 0.05f * glm::length(view.at - view.from)};
}

// Colours by height for all smooth materials, as no text has them.
void color_vertices(tool::SceneDescription& description) {
  tool::SceneGeometry& geometry = description.geometry;
  for (tool::SceneMaterial& material : description.materials) material.vertex_colors = material.smooth_normals;
  for (const Vec3& vertex : geometry.vertices) {
    const float share = std::clamp(0.5f + 0.5f * vertex.y, 0.0f, 1.0f);
    geometry.colors.emplace_back(1.0f - 0.5f * share, 0.6f + 0.4f * share, 0.8f);
  }
  for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
    const bool is_colored = description.materials[geometry.triangle_materials[i]].vertex_colors;
    geometry.triangle_colors.push_back(is_colored ? geometry.triangles[i] : UVec3(tool::kNoNormal));
  }
}

EffectScene make_effect_scene(std::string_view key) {
  EffectScene scene;
  scene.key = key;
  if (key == "balls") {
    scene.description = read_effect_scene(key, scene_makers::make_balls(2));
    add_area_light(scene.description);
    scene.words =
        "the sphereflake of the Standard Procedural Databases, 91 mirroring balls on a floor, with an area light more";
  } else if (key == "tetra") {
    scene.description = read_effect_scene(key, scene_makers::make_tetra(5));
    scene.description.ambient_occlusion = occlusion_of(scene.description.view);
    scene.description.samples_per_pixel = 4;
    scene.words =
        "the tetrahedral pyramid of the Standard Procedural Databases, 1,024 matt triangles, with ambient occlusion "
        "and four samples a pixel";
  } else if (key == "mount") {
    scene.description = read_effect_scene(key, scene_makers::make_mount(6));
    scene.description.environment = make_sky();
    scene.description.ambient_occlusion = occlusion_of(scene.description.view);
    scene.words =
        "the fractal mountain of the Standard Procedural Databases behind four balls of glass, under a sky, with "
        "ambient occlusion";
  } else if (key == "rings") {
    scene.description = read_effect_scene(key, scene_makers::make_rings(2));
    add_area_light(scene.description);
    scene.description.samples_per_pixel = 4;
    scene.words =
        "rings of the Standard Procedural Databases, 5 objects of 30 cylinders and 30 balls each, with an area light "
        "and four samples a pixel";
  } else {
    scene.description = read_effect_scene(key, kGallery);
    scene.description.environment = make_sky();
    color_vertices(scene.description);
    scene.words =
        "a scene of our own that calls for every effect: a mirror, a ball of glass, a matt cone and a patch; what is "
        "smooth has colours at its vertices";
  }
  return scene;
}

tool::SceneInput input_of(const EffectScene& scene) {
  tool::SceneDescription description = scene.description;
  tool::SceneEffects effects = tool::take_scene_effects(description);
  tool::Mesh mesh{std::move(description.geometry.vertices), std::move(description.geometry.triangles)};
  return {.path = scene.key,
          .content = std::move(mesh),
          .effects = std::move(effects),
          .text = tool::TextScene{description.view, {}, 0, {}}};
}

std::uint32_t called_for(const EffectScene& scene) {
  tool::SceneDescription description = scene.description;
  return effects_called_for(tool::take_scene_effects(description).view());
}

EffectScene without_effect(EffectScene scene, EffectBits effect) {
  tool::SceneDescription& description = scene.description;
  switch (effect) {
    case kPointShadows:
      description.shadows = false;
      break;
    case kAreaLights:
      for (const tool::AreaLight& light : description.area_lights) {
        description.point_lights.push_back(
            {.position = light.corner + 0.5f * (light.edge_u + light.edge_v), .color = light.color});
      }
      description.area_lights.clear();
      break;
    case kReflection:
      description.recursion_depth = 1;
      break;
    case kRefraction:
      for (tool::SceneMaterial& material : description.materials) material.transmittance = 0;
      break;
    case kAmbientOcclusion:
      description.ambient_occlusion.reset();
      break;
    case kEnvironment:
      description.environment.reset();
      break;
    case kSmoothNormals:
      for (tool::SceneMaterial& material : description.materials) {
        material.smooth_normals = material.vertex_colors = false;
      }
      description.geometry.normals.clear();
      description.geometry.triangle_normals.clear();
      description.geometry.triangle_colors.clear();
      break;
    case kVertexColors:
      for (tool::SceneMaterial& material : description.materials) material.vertex_colors = false;
      description.geometry.triangle_colors.clear();
      break;
    case kHighlights:
      for (tool::SceneMaterial& material : description.materials) material.shine = 0;
      break;
    case kMultisampling:
      description.samples_per_pixel = 1;
      break;
    case kSceneShading:
      break;
  }
  return scene;
}

std::uint32_t left_without(std::uint32_t called, EffectBits effect) {
  const std::uint32_t built_on_it = effect == kReflection ? kRefraction : effect == kSmoothNormals ? kVertexColors : 0u;
  return called & ~static_cast<std::uint32_t>(effect) & ~built_on_it;
}

}  // namespace gridiron::experiment
