// The effects of a scene in the caller's memory: lights, materials, normals, environment. Readers fill it and the image
// builder takes it. Model: core/EFFECTS.md.
// Memory: borrowed. Threads: read-only. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/math.h>
#include <gridiron/platform/status.h>
#include <gridiron/scene/mesh.h>

#include <cstdint>
#include <span>

namespace gridiron {

/// A material as a scene describes it; the image holds it scaled, so that energy never grows.
struct Material {
  Vec3 color{1, 1, 1};         ///< 0..1 each
  float kd = 1.0f;             ///< diffuse share, 0..1
  float ks = 0.0f;             ///< specular share, 0..1
  float shine = 0.0f;          ///< exponent of the highlight, 0..1e5; 0: none
  float transmittance = 0.0f;  ///< share let through, 0..1
  float index = 1.0f;          ///< of refraction, 0.1..10 where transmittance is above 0
  bool smooth_normals = false;  ///< its triangles have normals at their corners
  bool vertex_colors = false;   ///< and colours, which its diffuse share is multiplied by; only with smooth_normals
};

/// A point light (samples = 0), or an area light corner + a edge_u + b edge_v; both are equally bright.
struct Light {
  Vec3 corner{0, 0, 0};       ///< where it is, or begins
  /// One edge of an area light.
  Vec3 edge_u{0, 0, 0}, edge_v{0, 0, 0};  ///< its other edge
  Vec3 color{1, 1, 1};        ///< 0..kMaxLightColor
  std::uint32_t samples = 0;  ///< ..kMaxEffectSamples
};

/// Effects of a scene. Counts agree with the mesh that it goes with.
struct EffectsView {
  std::span<const Material> materials;                  ///< 1..kMaxMaterials
  std::span<const std::uint16_t> triangle_materials;    ///< one per triangle of the mesh
  std::span<const Vec3> normals;                        ///< unit to 2^-10
  std::span<const UVec3> triangle_normals;              ///< empty, or one per triangle: into normals, or kNoNormals
  std::span<const Vec3> colors;                         ///< linear, 0..1 each
  std::span<const UVec3> triangle_colors;               ///< empty, or one per triangle: into colors, or kNoNormals
  std::span<const Light> lights;                        ///< 0..kMaxLights, point lights first
  Vec3 background{0, 0, 0};                             ///< 0..1 each
  bool has_shadows = true;                              ///< of all lights
  std::uint32_t recursion_depth = 5;                    ///< 1..kMaxRecursionDepth
  std::uint32_t samples_per_pixel = 1;                  ///< 1, 4, 16
  ColorLevels levels = ColorLevels::kLinear;            ///< of the picture
  std::uint32_t occlusion_samples = 0;                  ///< 0: no ambient occlusion
  float occlusion_radius = 0.0f;                        ///< > 0 where there is
  std::uint32_t environment_width = 0;                  ///< texels of a face's edge, 0: no environment
  std::span<const Vec3> environment_faces[6];           ///< +x -x +y -y +z -z; width^2 texels, first row on top; >= 0
};

/// @returns the EffectBits that a scene needs for its lights and its materials in use. Reflection and refraction need a
/// material in use with a share of them and a sufficient depth of recursion.
[[nodiscard]] std::uint32_t effects_called_for(const EffectsView& effects);

/// Checks every range and count against the mesh, also for materials that are not in use. Lights and all corners of
/// area lights lie within kCoordinateLimit, edges of area lights are not parallel, exactly the triangles with smooth
/// materials have normals, and exactly those of materials with colours have colours. count_scene_image checks what
/// depends on the grid.
/// Errors: kBadEffects, kBadIndex (of a normal, a colour or a material). Cost: linear.
[[nodiscard]] Status check_effects(const MeshView& mesh, const EffectsView& effects);

}  // namespace gridiron
