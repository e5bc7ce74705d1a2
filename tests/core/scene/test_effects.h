// A small scene that has every effect, in memory of its own: what tests of effects start from.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/scene/effects.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gridiron::test {

/// A mesh and its effects. Triangle 2 has no area. Materials: 0 matte, 1 smooth glass that shines, 2 not in use.
struct TestEffects {
  std::vector<Vec3> vertices;
  std::vector<UVec3> triangles;
  std::vector<Material> materials;
  std::vector<std::uint16_t> triangle_materials;
  std::vector<Vec3> normals;
  std::vector<UVec3> triangle_normals;
  std::vector<Vec3> colors;
  std::vector<UVec3> triangle_colors;
  std::vector<Light> lights;
  std::vector<Vec3> faces[6];
  EffectsView settings;  ///< all of the view that is no array

  [[nodiscard]] MeshView mesh() const { return {vertices, triangles}; }
  [[nodiscard]] EffectsView view() const {
    EffectsView view = settings;
    view.materials = materials;
    view.triangle_materials = triangle_materials;
    view.normals = normals;
    view.triangle_normals = triangle_normals;
    view.colors = colors;
    view.triangle_colors = triangle_colors;
    view.lights = lights;
    for (std::size_t face = 0; face < 6; ++face) view.environment_faces[face] = faces[face];
    return view;
  }

  /// Faces of width^2 texels, every one of a value of its own; 0: no environment.
  void set_environment(std::uint32_t width) {
    settings.environment_width = width;
    for (std::size_t face = 0; face < 6; ++face) {
      faces[face].assign(std::size_t{width} * width, Vec3(0));
      for (std::size_t i = 0; i < faces[face].size(); ++i) {
        faces[face][i] = Vec3(static_cast<float>(face), static_cast<float>(i / width), static_cast<float>(i % width));
      }
    }
  }
};

inline TestEffects all_effects(std::uint32_t environment_width = 3) {
  TestEffects scene;
  scene.vertices = {{0.1f, 0, 0},       {1, 0.5f, 0.25f}, {0.25f, 1, 0.75f},
                    {0.5f, 0.5f, 0.5f}, {1, 0.5f, 1},     {0.25f, 0.75f, 0}};
  scene.triangles = {{0, 1, 2}, {3, 4, 5}, {1, 1, 2}, {2, 1, 5}};
  Material matte;
  matte.color = {0.5f, 0.25f, 1};
  matte.kd = 0.75f;
  Material glass;
  glass.color = {0.75f, 0.5f, 0.25f};
  glass.kd = 0.7f;
  glass.ks = 0.6f;
  glass.shine = 20.0f;
  glass.transmittance = 0.9f;
  glass.index = 1.5f;
  glass.smooth_normals = true;
  glass.vertex_colors = true;
  scene.materials = {matte, glass, glass};
  scene.triangle_materials = {0, 1, 1, 0};
  scene.normals = {{0, 0, 1}, {0.6f, 0, 0.8f}, {0, -0.8f, 0.6f}};
  scene.triangle_normals = {UVec3(kNoNormals), {0, 1, 2}, {2, 2, 1}, UVec3(kNoNormals)};
  scene.colors = {{1, 0.5f, 0}, {0.25f, 0, 1}};
  scene.triangle_colors = {UVec3(kNoNormals), {0, 1, 0}, {1, 1, 0}, UVec3(kNoNormals)};
  Light point;
  point.corner = {2, 3, 3.5f};
  point.color = {1, 0.5f, 0.25f};
  Light area;
  area.corner = {-1, 2, -1};
  area.edge_u = {1, 0, 0};
  area.edge_v = {0, 0, 100};
  area.color = {4, 8, 12};
  area.samples = 16;
  scene.lights = {point, area};
  scene.settings.background = {0.25f, 0.5f, 0.75f};
  scene.settings.recursion_depth = 3;
  scene.settings.samples_per_pixel = 4;
  scene.settings.levels = ColorLevels::kSrgb;
  scene.settings.occlusion_samples = 8;
  scene.settings.occlusion_radius = 0.5f;
  scene.set_environment(environment_width);
  return scene;
}

}  // namespace gridiron::test
