// Scene effects: lights, materials, normals and environment of a text scene in the image builder's form.
// Memory: std::vector. Threads: any may read. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/scene/effects.h>
#include <gridiron/scene/mesh.h>

#include <array>
#include <cstdint>
#include <vector>

#include "scene_text/scene_description.h"

namespace gridiron::tool {

/// Effects of one scene, owned. Fields as those of EffectsView.
struct SceneEffects {
  std::vector<Material> materials;
  std::vector<std::uint16_t> triangle_materials;
  std::vector<Vec3> normals;
  std::vector<UVec3> triangle_normals;
  std::vector<Vec3> colors;
  std::vector<UVec3> triangle_colors;
  std::vector<Light> lights;  ///< point lights first, each kind in the text's order
  Vec3 background{0, 0, 0};
  bool has_shadows = true;
  std::uint32_t recursion_depth = kDefaultRecursionDepth;
  std::uint32_t samples_per_pixel = 1;
  ColorLevels levels = ColorLevels::kLinear;
  std::uint32_t occlusion_samples = 0;
  float occlusion_radius = 0.0f;
  std::uint32_t environment_width = 0;
  std::array<std::vector<Vec3>, kCubeFaceCount> environment_faces;

  /// Spans into this object; they remain valid when it is moved.
  [[nodiscard]] EffectsView view() const;
};

/// @returns a material in the image builder's form.
[[nodiscard]] Material material_of(const SceneMaterial& material);

/// Takes the effects out of a scene: geometry keeps only its vertices and triangles, the environment its width and
/// paths.
[[nodiscard]] SceneEffects take_scene_effects(SceneDescription& scene);

/// @returns vertices and triangles of a scene, which must outlive the view.
[[nodiscard]] MeshView mesh_view(const SceneDescription& scene);

}  // namespace gridiron::tool
