// Scenes in code: see the header. SPDX-License-Identifier: Apache-2.0
#include "effects/effect_scene.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <tuple>

namespace gridiron::test {
namespace {

using tool::SceneDescription;
using tool::SceneMaterial;

std::uint32_t add_vertex(SceneDescription& scene, Vec3 vertex) {
  scene.geometry.vertices.push_back(vertex);
  return static_cast<std::uint32_t>(scene.geometry.vertices.size() - 1);
}

std::uint32_t add_normal(SceneDescription& scene, Vec3 normal) {
  scene.geometry.normals.push_back(normal);
  return static_cast<std::uint32_t>(scene.geometry.normals.size() - 1);
}

// Without normals of its own, a triangle of a smooth material gets that of its plane three times.
std::uint32_t add_indexed(SceneDescription& scene, UVec3 corners, UVec3 normals, std::uint16_t material) {
  auto& geometry = scene.geometry;
  const auto id = static_cast<std::uint32_t>(geometry.triangles.size());
  if (scene.materials[material].smooth_normals) {
    if (normals.x == tool::kNoNormal) {
      const auto v = [&](int k) { return DVec3(geometry.vertices[corners[k]]); };
      const DVec3 normal = glm::normalize(glm::cross(v(1) - v(0), v(2) - v(0)));
      normals = UVec3(add_normal(scene, Vec3(normal)));
    }
    geometry.triangle_normals.resize(id, UVec3(tool::kNoNormal));
  }
  geometry.triangles.push_back(corners);
  geometry.triangle_materials.push_back(material);
  if (scene.materials[material].smooth_normals || !geometry.triangle_normals.empty()) {
    geometry.triangle_normals.push_back(normals);
  }
  return id;
}

void add_point_light(SceneDescription& scene, Vec3 position, Vec3 color) {
  scene.point_lights.push_back({position, color});
}

}  // namespace

SceneDescription empty_scene(Vec3 from, Vec3 at, Vec3 up, float angle_degrees) {
  SceneDescription scene;
  scene.view = {from, at, up, angle_degrees, 0.0f, 64, 64};
  return scene;
}

std::uint16_t add_material(SceneDescription& scene, const SceneMaterial& material) {
  scene.materials.push_back(material);
  return static_cast<std::uint16_t>(scene.materials.size() - 1);
}

std::uint32_t add_triangle(SceneDescription& scene, const Vec3 (&corners)[3], std::uint16_t material) {
  UVec3 indices;
  for (int k = 0; k < 3; ++k) indices[k] = add_vertex(scene, corners[k]);
  return add_indexed(scene, indices, UVec3(tool::kNoNormal), material);
}

std::uint32_t add_triangle(SceneDescription& scene, const Vec3 (&corners)[3], const Vec3 (&normals)[3],
                           std::uint16_t material) {
  UVec3 indices, normal_indices;
  for (int k = 0; k < 3; ++k) {
    indices[k] = add_vertex(scene, corners[k]);
    normal_indices[k] = add_normal(scene, normals[k]);
  }
  return add_indexed(scene, indices, normal_indices, material);
}

std::uint32_t add_parallelogram(SceneDescription& scene, Vec3 corner, Vec3 u, Vec3 v, std::uint16_t material) {
  const std::uint32_t a = add_vertex(scene, corner);
  const std::uint32_t b = add_vertex(scene, corner + u);
  const std::uint32_t c = add_vertex(scene, corner + u + v);
  const std::uint32_t d = add_vertex(scene, corner + v);
  const std::uint32_t id = add_indexed(scene, {a, b, c}, UVec3(tool::kNoNormal), material);
  add_indexed(scene, {a, c, d}, UVec3(tool::kNoNormal), material);
  return id;
}

std::uint32_t add_box(SceneDescription& scene, Vec3 low, Vec3 high, std::uint16_t material, bool is_inwards) {
  const auto base = static_cast<std::uint32_t>(scene.geometry.vertices.size());
  for (std::uint32_t i = 0; i < 8; ++i) {
    add_vertex(scene, {(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z});
  }
  static constexpr std::uint32_t kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                                 {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  const auto first = static_cast<std::uint32_t>(scene.geometry.triangles.size());
  for (const auto& face : kFaces) {
    const UVec3 one(face[0], face[is_inwards ? 2 : 1], face[is_inwards ? 1 : 2]);
    const UVec3 other(face[0], face[is_inwards ? 3 : 2], face[is_inwards ? 2 : 3]);
    add_indexed(scene, one + base, UVec3(tool::kNoNormal), material);
    add_indexed(scene, other + base, UVec3(tool::kNoNormal), material);
  }
  return first;
}

std::uint32_t add_ball(SceneDescription& scene, Vec3 center, float radius, std::uint32_t f, std::uint16_t material) {
  // An octahedron |x| + |y| + |z| = f of whole places, pushed out.
  const bool is_smooth = scene.materials[material].smooth_normals;
  std::map<std::tuple<int, int, int>, std::pair<std::uint32_t, std::uint32_t>> known;
  const auto at = [&](glm::ivec3 place) {
    const auto [entry, is_new] = known.try_emplace({place.x, place.y, place.z}, 0u, tool::kNoNormal);
    if (is_new) {
      const DVec3 out = glm::normalize(DVec3(place));
      entry->second.first = add_vertex(scene, Vec3(DVec3(center) + double{radius} * out));
      if (is_smooth) entry->second.second = add_normal(scene, Vec3(out));
    }
    return entry->second;
  };
  const auto first = static_cast<std::uint32_t>(scene.geometry.triangles.size());
  for (int octant = 0; octant < 8; ++octant) {
    const glm::ivec3 sign((octant & 1) != 0 ? -1 : 1, (octant & 2) != 0 ? -1 : 1, (octant & 4) != 0 ? -1 : 1);
    const bool is_mirrored = sign.x * sign.y * sign.z < 0;
    const auto add = [&](glm::ivec3 a, glm::ivec3 b, glm::ivec3 c) {
      const auto i = at(a * sign), j = at((is_mirrored ? c : b) * sign), k = at((is_mirrored ? b : c) * sign);
      add_indexed(scene, {i.first, j.first, k.first}, {i.second, j.second, k.second}, material);
    };
    const int n = static_cast<int>(f);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        const int k = n - i - j;
        add({i + 1, j, k - 1}, {i, j + 1, k - 1}, {i, j, k});
        if (k >= 2) add({i + 1, j, k - 1}, {i + 1, j + 1, k - 2}, {i, j + 1, k - 1});
      }
    }
  }
  return first;
}

void set_environment(SceneDescription& scene, Vec3 color, std::uint32_t width) {
  tool::EnvironmentMap& map = scene.environment.emplace();
  map.width = width;
  for (auto& face : map.texels) face.assign(std::size_t{width} * width, color);
}

void transform_scene(SceneDescription& scene, float scale, Vec3 offset) {
  const auto moved = [&](Vec3 p) { return Vec3(DVec3(p) * double{scale} + DVec3(offset)); };
  scene.view.from = moved(scene.view.from);
  scene.view.at = moved(scene.view.at);
  for (Vec3& vertex : scene.geometry.vertices) vertex = moved(vertex);
  for (tool::PointLight& light : scene.point_lights) light.position = moved(light.position);
  for (tool::AreaLight& light : scene.area_lights) {
    light.corner = moved(light.corner);
    light.edge_u *= scale;
    light.edge_v *= scale;
  }
  if (scene.ambient_occlusion) scene.ambient_occlusion->radius *= scale;
}

SceneDescription furnace_box_scene(const SceneMaterial& material) {
  SceneDescription scene = empty_scene({1.7f, 1.9f, 4.1f}, {0, 0, 0}, {0, 1, 0}, 35);
  set_environment(scene, Vec3(1));
  scene.recursion_depth = tool::kMostRecursionDepth;
  add_box(scene, Vec3(-1), Vec3(1), add_material(scene, material));
  return scene;
}

SceneDescription furnace_ball_scene(const SceneMaterial& material, std::uint32_t f) {
  SceneDescription scene = empty_scene({0.3f, 0.4f, 4}, {0, 0, 0}, {0, 1, 0}, 35);
  set_environment(scene, Vec3(1));
  scene.recursion_depth = tool::kMostRecursionDepth;
  add_ball(scene, Vec3(0), 1, f, add_material(scene, material));
  return scene;
}

SceneDescription mirror_room_scene() {
  SceneDescription scene = empty_scene({1.5f, 0.7f, 1.8f}, {-0.3f, -0.4f, -0.5f}, {0, 1, 0}, 60);
  scene.recursion_depth = tool::kMostRecursionDepth;
  add_box(scene, Vec3(-2), Vec3(2), add_material(scene, {.color = {0.9f, 0.85f, 0.8f}, .kd = 0.4f, .ks = 0.6f}),
          /*is_inwards=*/true);
  add_box(scene, {-0.9f, -1.6f, -0.8f}, {0.2f, -0.4f, 0.3f}, add_material(scene, {.color = {0.2f, 0.6f, 0.9f}}));
  add_point_light(scene, {0.6f, 1.5f, 0.9f}, Vec3(0.9f));
  return scene;
}

SceneDescription glass_ball_scene(bool is_smooth, std::uint32_t f) {
  SceneDescription scene = empty_scene({0.5f, 1.6f, 4}, {0, 0.4f, 0}, {0, 1, 0}, 40);
  scene.background = {0.3f, 0.4f, 0.6f};
  scene.recursion_depth = 6;
  const std::uint16_t red = add_material(scene, {.color = {0.9f, 0.3f, 0.2f}});
  const std::uint16_t green = add_material(scene, {.color = {0.3f, 0.8f, 0.3f}});
  add_parallelogram(scene, {-3, -0.7f, 3}, {3, 0, 0}, {0, 0, -6}, red);
  add_parallelogram(scene, {0, -0.7f, 3}, {3, 0, 0}, {0, 0, -6}, green);
  const SceneMaterial glass{.kd = 0.0f,
                            .ks = 0.05f,
                            .shine = 80.0f,
                            .transmittance = 0.95f,
                            .index_of_refraction = 1.5f,
                            .smooth_normals = is_smooth};
  add_ball(scene, {0, 0.4f, 0}, 1, f, add_material(scene, glass));
  add_point_light(scene, {-2, 5, 3}, Vec3(0.8f));
  return scene;
}

SceneDescription colored_ball_scene(std::uint32_t f) {
  SceneDescription scene = empty_scene({0, 2, 6}, {0, 0.8f, 0}, {0, 1, 0}, 40);
  scene.background = {0.02f, 0.05f, 0.3f};
  scene.levels = ColorLevels::kSrgb;
  scene.samples_per_pixel = 4;  // their mean is put on the curve, not each
  add_point_light(scene, {3, 6, 5}, Vec3(1));
  const std::uint16_t material =
      add_material(scene, {.kd = 0.9f, .ks = 0.1f, .shine = 20, .smooth_normals = true, .vertex_colors = true});
  add_ball(scene, {0, 1, 0}, 1, f, material);
  add_box(scene, {-3, -0.5f, -3}, {3, 0, 3}, material);
  tool::SceneGeometry& geometry = scene.geometry;
  for (const Vec3& vertex : geometry.vertices) {
    geometry.colors.push_back(glm::clamp(0.5f + 0.25f * vertex, 0.0f, 1.0f) * Vec3(1, 0.6f, 0.1f));
  }
  geometry.triangle_colors = geometry.triangles;
  return scene;
}

SceneDescription occlusion_corner_scene(float size, float radius, std::uint32_t samples) {
  SceneDescription scene = empty_scene({2.1f, 2.2f, 0.1f}, {0, 0, 0}, {0, 1, 0}, 50);
  scene.ambient_occlusion = tool::AmbientOcclusion{samples, radius};
  const std::uint16_t white = add_material(scene, {.color = Vec3(1)});
  add_parallelogram(scene, {0, 0, size}, {size, 0, 0}, {0, 0, -2 * size}, white);
  add_parallelogram(scene, {0, 0, size}, {0, 0, -2 * size}, {0, size, 0}, white);
  return scene;
}

SceneDescription acne_scene(AcneLight light, float scale, Vec3 offset, std::uint32_t f) {
  SceneDescription scene = empty_scene({0.6f, 0.8f, 4}, {0, 0, 0}, {0, 1, 0}, 32);
  add_ball(scene, Vec3(0), 1, f, add_material(scene, {.color = Vec3(1)}));
  const Vec3 behind = scene.view.from * 1.5f;
  if (light == AcneLight::kPoint) add_point_light(scene, behind, Vec3(1));
  if (light == AcneLight::kArea) {
    scene.area_lights.push_back({behind, {0.05f, 0, 0}, {0, 0.05f, 0}, Vec3(1), 16});
  }
  if (light == AcneLight::kAmbient) scene.ambient_occlusion = tool::AmbientOcclusion{16, 4.0f};
  transform_scene(scene, scale, offset);
  return scene;
}

}  // namespace gridiron::test
