// Rules of effects that a scene, the writer of an image and its checks share.
// Source: core/EFFECTS.md. Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/image_rules.h>
#include <gridiron/scene/effects.h>

#include <cstdint>

namespace gridiron {

inline constexpr float kMaxShine = 1e5f;
inline constexpr float kLeastIndex = 0.1f;
inline constexpr float kGreatestIndex = 10.0f;
inline constexpr float kMaxShareSum = 1.0f + 0x1p-20f;  ///< of scaled shares: 1 and their roundings

/// @returns whether low <= value <= high; never for NaN.
[[nodiscard]] constexpr bool within(float value, float low, float high) {
  return value >= low && value <= high;
}

/// Shares divided by m = max(1, (kd + ks) + T), each on its own; then diffuse = (kd / m) color and transmitted = (T /
/// m) color. Every operation is rounded to float. The index becomes 1 if nothing is transmitted.
[[nodiscard]] MaterialRecord scaled_material(const Material& material);

/// @returns the light as the image holds it: an area light's color divided by its samples, edges of a point light 0.
/// @param grid  decides is_near: its bounds.
[[nodiscard]] LightRecord light_record(const Light& light, const GridRecord& grid);

/// @returns 1 if no coordinate of the light's point, or of an area light's four corners, exceeds kNearLightFactor times
/// the largest of the grid's bounds.
[[nodiscard]] std::uint32_t light_is_near(const LightRecord& light, const GridRecord& grid);

/// @returns whether no coordinate of the light's point or corners is beyond kCoordinateLimit, and an area light's edges
/// span a parallelogram (decided exactly).
[[nodiscard]] bool light_has_place(const LightRecord& light);

/// @returns whether the light's point or corners lie within kCellSpaceLimit cells of the grid, as an eye must.
[[nodiscard]] bool light_is_in_reach(const LightRecord& light, const GridRecord& grid);

/// @returns whether directions as long as the radius of ambient occlusion stay within kCellDirectionLimit.
[[nodiscard]] bool radius_is_in_reach(float radius, const GridRecord& grid);

/// @returns the nearest colour that an image can hold. @param color  0..1 each.
[[nodiscard]] PackedColor packed_color(const Vec3& color);

/// @returns whether a normal's length differs from 1 by 2^-10 at most.
[[nodiscard]] bool is_unit(const float normal[3]);

/// The lights and the materials in use, which decide the effects that a scene needs.
struct EffectsCall {
  bool point_light = false, area_light = false;  ///< of a color that is not 0
  bool reflects = false, refracts = false, shines = false, smooth = false, colors = false;

  void add_light(const LightRecord& light);
  void add_material(const MaterialRecord& material);

  /// @returns EffectBits. @param scene  recursion_depth, samples_per_pixel, occlusion_samples, has_shadows and
  /// environment_width.
  [[nodiscard]] std::uint32_t called_for(const EffectsRecord& scene) const;
};

/// @returns the fields of the record that follow from the view alone; counts of triangles, called_for and offsets are
/// 0.
[[nodiscard]] EffectsRecord scene_settings(const EffectsView& effects);

/// Checks the record's settings that are no counts; check_effect_counts (base/image_rules.h) checks those.
/// @param base  the record's place in the image.
template <class Checker>
[[nodiscard]] bool check_effect_measures(Checker&& checker, std::uint64_t base, const EffectsRecord& effects) {
  const float radius = effects.occlusion_radius;
  GRIDIRON_RULE_OF(0, effects.occlusion_samples == 0 ? radius == 0.0f : radius > 0.0f && radius <= kCoordinateLimit,
                   base, effects, occlusion_radius);
  GRIDIRON_RULE_OF(effects.levels, effects.levels <= static_cast<std::uint32_t>(ColorLevels::kSrgb), base, effects,
                   levels);
  for (const float color : effects.background) {
    GRIDIRON_RULE_OF(0, within(color, 0.0f, 1.0f), base, effects, background);
  }
  return true;
}

}  // namespace gridiron
