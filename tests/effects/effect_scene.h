// Scenes with effects made in code, for the kernel and for the reference alike. Scenes in text come by
// tool::read_scene_text.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>

#include <cstdint>

#include "scene_text/scene_description.h"

namespace gridiron::test {

// --- Parts. They keep what SceneDescription promises: counts agree, triangles are counter-clockwise from outside.

/// @returns a scene with a view and nothing else: no light, black background, shadows on, depth 5, 1 sample.
[[nodiscard]] tool::SceneDescription empty_scene(Vec3 from, Vec3 at, Vec3 up, float angle_degrees);

/// @returns the material's index.
std::uint16_t add_material(tool::SceneDescription& scene, const tool::SceneMaterial& material);

/// Appends a triangle; of a smooth material, with these normals (unit), or with that of its plane where none are
/// given, as parallelograms and boxes have them. Normals are for smooth materials only.
/// @returns its id.
std::uint32_t add_triangle(tool::SceneDescription& scene, const Vec3 (&corners)[3], std::uint16_t material);
std::uint32_t add_triangle(tool::SceneDescription& scene, const Vec3 (&corners)[3], const Vec3 (&normals)[3],
                           std::uint16_t material);

/// Appends a parallelogram, counter-clockwise corner, + u, + u + v, + v: 2 triangles that share the diagonal.
/// @returns the first one's id.
std::uint32_t add_parallelogram(tool::SceneDescription& scene, Vec3 corner, Vec3 u, Vec3 v, std::uint16_t material);

/// Appends a box of 12 triangles and 8 shared vertices, seen from outside; inwards: like a room, seen from inside.
std::uint32_t add_box(tool::SceneDescription& scene, Vec3 low, Vec3 high, std::uint16_t material,
                      bool is_inwards = false);

/// Appends a closed ball of 8 f^2 triangles, vertices shared; a smooth material gets the sphere's normals.
std::uint32_t add_ball(tool::SceneDescription& scene, Vec3 center, float radius, std::uint32_t f,
                       std::uint16_t material);

/// An environment of one colour.
void set_environment(tool::SceneDescription& scene, Vec3 color, std::uint32_t width = 1);

/// Moves everything: p becomes float(p * scale + offset); normals, colours and counts stay.
void transform_scene(tool::SceneDescription& scene, float scale, Vec3 offset);

// --- Scenes.

/// A box or a ball in an environment of white 1. Where a material keeps all light (kd 0, ks + T 1, colour 1) no pixel
/// is above 1, and it is below 1 only by what the depth of recursion cuts.
[[nodiscard]] tool::SceneDescription furnace_box_scene(const tool::SceneMaterial& material);
[[nodiscard]] tool::SceneDescription furnace_ball_scene(const tool::SceneMaterial& material, std::uint32_t f = 6);

/// A room whose six walls are half mirrors, a matt box in it, a point light, depth 8.
[[nodiscard]] tool::SceneDescription mirror_room_scene();

/// A ball of glass (index 1.5, flat or smooth) above a floor of two colours; point light, depth 6.
[[nodiscard]] tool::SceneDescription glass_ball_scene(bool is_smooth, std::uint32_t f = 8);

/// A ball above a floor, both with colours at their vertices, on the curve of sRGB; point light, mirrors a little.
[[nodiscard]] tool::SceneDescription colored_ball_scene(std::uint32_t f = 8);

/// Floor y = 0 and wall x = 0, both of extent `size`, seen from where both are positive; ambient occlusion only.
[[nodiscard]] tool::SceneDescription occlusion_corner_scene(float size, float radius, std::uint32_t samples);

/// A white ball alone, seen from the side of its only light, right behind the eye: whatever is turned to the light is
/// lit, so no pixel on it may be black. Scaled, then moved. On demand an area light or ambient occlusion in its place.
enum class AcneLight : std::uint8_t { kPoint, kArea, kAmbient };
[[nodiscard]] tool::SceneDescription acne_scene(AcneLight light, float scale, Vec3 offset, std::uint32_t f = 12);

}  // namespace gridiron::test
