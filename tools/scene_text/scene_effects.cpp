// Scene effects. SPDX-License-Identifier: Apache-2.0
#include "scene_text/scene_effects.h"

#include <tuple>
#include <utility>

namespace gridiron::tool {
namespace {

static_assert(kMostSceneMaterials <= kMaxMaterials && kMostSceneLights <= kMaxLights);
static_assert(kMostEffectSamples <= kMaxEffectSamples && kMostRecursionDepth <= kMaxRecursionDepth);
static_assert(kMostEnvironmentWidth <= kMaxEnvironmentWidth && kMostLightColor <= kMaxLightColor);
static_assert(kNoNormal == kNoNormals &&
              kCubeFaceCount == std::tuple_size_v<decltype(SceneEffects::environment_faces)>);

}  // namespace

Material material_of(const SceneMaterial& material) {
  return {.color = material.color,
          .kd = material.kd,
          .ks = material.ks,
          .shine = material.shine,
          .transmittance = material.transmittance,
          .index = material.index_of_refraction,
          .smooth_normals = material.smooth_normals,
          .vertex_colors = material.vertex_colors};
}

EffectsView SceneEffects::view() const {
  EffectsView effects;
  effects.materials = materials;
  effects.triangle_materials = triangle_materials;
  effects.normals = normals;
  effects.triangle_normals = triangle_normals;
  effects.colors = colors;
  effects.triangle_colors = triangle_colors;
  effects.lights = lights;
  effects.background = background;
  effects.has_shadows = has_shadows;
  effects.recursion_depth = recursion_depth;
  effects.samples_per_pixel = samples_per_pixel;
  effects.levels = levels;
  effects.occlusion_samples = occlusion_samples;
  effects.occlusion_radius = occlusion_radius;
  effects.environment_width = environment_width;
  for (std::size_t face = 0; face < environment_faces.size(); ++face) {
    effects.environment_faces[face] = environment_faces[face];
  }
  return effects;
}

SceneEffects take_scene_effects(SceneDescription& scene) {
  SceneEffects effects;
  effects.materials.reserve(scene.materials.size());
  for (const SceneMaterial& material : scene.materials) effects.materials.push_back(material_of(material));
  effects.triangle_materials = std::exchange(scene.geometry.triangle_materials, {});
  effects.normals = std::exchange(scene.geometry.normals, {});
  effects.triangle_normals = std::exchange(scene.geometry.triangle_normals, {});
  effects.colors = std::exchange(scene.geometry.colors, {});
  effects.triangle_colors = std::exchange(scene.geometry.triangle_colors, {});
  effects.lights.reserve(scene.point_lights.size() + scene.area_lights.size());
  for (const PointLight& light : scene.point_lights) {
    effects.lights.push_back({.corner = light.position, .color = light.color});
  }
  for (const AreaLight& light : scene.area_lights) {
    effects.lights.push_back({.corner = light.corner,
                              .edge_u = light.edge_u,
                              .edge_v = light.edge_v,
                              .color = light.color,
                              .samples = light.samples});
  }
  effects.background = scene.background;
  effects.has_shadows = scene.shadows;
  effects.recursion_depth = scene.recursion_depth;
  effects.samples_per_pixel = scene.samples_per_pixel;
  effects.levels = scene.levels;
  if (scene.ambient_occlusion) {
    effects.occlusion_samples = scene.ambient_occlusion->samples;
    effects.occlusion_radius = scene.ambient_occlusion->radius;
  }
  if (scene.environment) {
    effects.environment_width = scene.environment->width;
    effects.environment_faces = std::exchange(scene.environment->texels, {});
  }
  return effects;
}

MeshView mesh_view(const SceneDescription& scene) {
  return {scene.geometry.vertices, scene.geometry.triangles};
}

}  // namespace gridiron::tool
