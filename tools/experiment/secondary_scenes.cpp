// Scenes of one kind of secondary rays. SPDX-License-Identifier: Apache-2.0
#include "experiment/secondary_scenes.h"

#include <glm/geometric.hpp>
#include <utility>

namespace gridiron::experiment {
namespace {

constexpr std::uint32_t kSamples = 4;      ///< of area lights and occlusion
constexpr std::uint32_t kMirrorDepth = 3;  ///< of recursion; the eye ray is of depth 1
constexpr std::uint32_t kGlassDepth = 4;
constexpr std::uint32_t kOneHitDepth = 2;

// A ball of glass in a ball; the eye is between them, the light outside. The numbers are none that facets share.
constexpr std::string_view kRoom = R"(v
from 0.31 0.22 0.73
at -0.3 -0.2 -0.3
up 0 1 0
angle 95
hither 0
resolution 96 96
l 1.3 2.9 1.7
ao 4 5
f 0.8 0.75 0.65  1 0 0 0 0
s 0 0 0 1
f 0.35 0.55 0.8  1 0 0 0 0
s -0.31 -0.17 -0.29 0.37
)";
constexpr std::string_view kBody = R"(v
from 0.6 0.8 4
at 0 0 0
up 0 1 0
angle 30
hither 0
resolution 96 96
l 0.9 1.2 6
ao 4 5
f 0.8 0.75 0.65  1 0 0 0 0
s 0 0 0 1
)";

// A square about the place of a point, as wide as a tenth of its distance from what the camera looks at.
tool::AreaLight light_around(const tool::PointLight& light, const tool::SceneView& view) {
  const Vec3 forward = view.at - light.position;
  const float distance = glm::length(forward);
  const Vec3 axis = glm::abs(forward.y) < 0.9f * distance ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
  const Vec3 right = glm::normalize(glm::cross(forward, axis)), up = glm::cross(right, forward / distance);
  const Vec3 edge_u = 0.1f * distance * right, edge_v = 0.1f * distance * up;
  return {.corner = light.position - 0.5f * (edge_u + edge_v),
          .edge_u = edge_u,
          .edge_v = edge_v,
          .color = light.color,
          .samples = kSamples};
}

// A light on the camera's left, above it.
tool::PointLight light_beside(const tool::SceneView& view) {
  const Vec3 forward = view.at - view.from;
  const Vec3 right = glm::normalize(glm::cross(forward, view.up)), up = glm::normalize(glm::cross(right, forward));
  return {.position = view.from + glm::length(forward) * (0.3f * up - 0.5f * right), .color = Vec3(1)};
}

void make_materials(std::vector<tool::SceneMaterial>& materials, std::optional<RayKind> kind) {
  for (std::size_t i = 0; i < materials.size(); ++i) {
    tool::SceneMaterial material;
    material.color = materials[i].color;
    const bool is_floor = i == 0 && materials.size() > 1;
    if (!is_floor && kind == RayKind::kReflection) {
      material.kd = 0.4f;
      material.ks = 0.6f;
    }
    if (!is_floor && kind == RayKind::kRefraction) {
      material.kd = 0.2f;
      material.transmittance = 0.8f;
      material.index_of_refraction = 1.5f;
    }
    materials[i] = material;
  }
}

void move_scene(tool::SceneDescription& scene, Vec3 offset) {
  scene.view.from += offset;
  scene.view.at += offset;
  for (Vec3& vertex : scene.geometry.vertices) vertex += offset;
  for (tool::PointLight& light : scene.point_lights) light.position += offset;
  for (tool::AreaLight& light : scene.area_lights) light.corner += offset;
}

}  // namespace

EffectScene with_rays_of(EffectScene scene, std::optional<RayKind> kind) {
  tool::SceneDescription& description = scene.description;
  make_materials(description.materials, kind);
  description.geometry.normals.clear();
  description.geometry.triangle_normals.clear();
  description.geometry.colors.clear();
  description.geometry.triangle_colors.clear();
  description.environment.reset();
  description.background = Vec3(0.2f, 0.3f, 0.45f);
  description.samples_per_pixel = 1;
  description.shadows = kind == RayKind::kShadow || kind == RayKind::kArea;
  description.recursion_depth = kind == RayKind::kReflection   ? kMirrorDepth
                                : kind == RayKind::kRefraction ? kGlassDepth
                                                               : 1;
  description.area_lights.clear();
  if (description.point_lights.empty()) description.point_lights.push_back(light_beside(description.view));
  if (kind == RayKind::kArea) {
    for (const tool::PointLight& light : description.point_lights) {
      description.area_lights.push_back(light_around(light, description.view));
    }
    description.point_lights.clear();
  }
  tool::AmbientOcclusion occlusion = description.ambient_occlusion.value_or(occlusion_of(description.view));
  occlusion.samples = kSamples;
  description.ambient_occlusion.reset();
  if (kind == RayKind::kOcclusion) description.ambient_occlusion = occlusion;
  return scene;
}

EffectScene scene_of_view(const View& view) {
  EffectScene scene;
  scene.key = view.key;
  scene.words = view.title + ", which has one material";
  tool::SceneDescription& description = scene.description;
  const MeshView mesh = view.mesh().view();
  description.geometry.vertices.assign(mesh.vertices.begin(), mesh.vertices.end());
  description.geometry.triangles.assign(mesh.triangles.begin(), mesh.triangles.end());
  description.geometry.triangle_materials.assign(mesh.triangles.size(), 0);
  description.materials.emplace_back();
  description.view.from = *view.camera.eye;
  description.view.at = *view.camera.at;
  if (view.camera.up) description.view.up = *view.camera.up;
  if (view.camera.fov_degrees) description.view.angle_degrees = *view.camera.fov_degrees;
  return scene;
}

std::vector<Solid> make_solids(RayKind kind) {
  std::vector<Solid> solids;
  for (const bool is_room : {true, false}) {
    for (const bool is_far : {false, true}) {
      EffectScene scene;
      scene.key = std::string(is_far ? "far_" : "") + (is_room ? "room" : "body");
      scene.description = read_effect_scene(scene.key, is_room ? kRoom : kBody);
      scene = with_rays_of(std::move(scene), kind);
      // No ray may leave a room but by a leak: its walls may be mirrors, not glass.
      if (kind == RayKind::kReflection) scene.description.materials.front() = scene.description.materials.back();
      if (!is_room && kind == RayKind::kRefraction) scene.description.recursion_depth = kOneHitDepth;
      if (is_far) move_scene(scene.description, Vec3(1000, -300, 70));
      solids.push_back({std::move(scene), is_room});
    }
  }
  return solids;
}

}  // namespace gridiron::experiment
