// The scenes of the effects experiment, made in process: four of the Standard Procedural Databases with some effects
// added, and a gallery that calls for all.
// Memory: owns the scenes. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "gridiron/scene/scene_input.h"
#include "scene_text/scene_description.h"

namespace gridiron::experiment {

struct EffectScene {
  std::string key;    ///< part of file names
  std::string words;  ///< a sentence for the page that describes it
  tool::SceneDescription description;
};

/// Keys of all scenes, in the order of the page.
inline constexpr std::string_view kEffectSceneKeys[] = {"balls", "tetra", "mount", "rings", "gallery"};

/// @returns the scene of that key. Precondition: there is one.
[[nodiscard]] EffectScene make_effect_scene(std::string_view key);

/// Reads a text scene. Round shapes are coarser than the program makes them: sufficient for small pictures.
[[nodiscard]] tool::SceneDescription read_effect_scene(std::string_view key, std::string_view text);

/// @returns ambient occlusion as far as a twentieth of the distance to the point that the camera looks at.
[[nodiscard]] tool::AmbientOcclusion occlusion_of(const tool::SceneView& view);

/// @returns the scene in the form that prepare_frame takes.
[[nodiscard]] tool::SceneInput input_of(const EffectScene& scene);

/// @returns the EffectBits that a scene calls for.
[[nodiscard]] std::uint32_t called_for(const EffectScene& scene);

/// @returns the scene changed so that it does not call for `effect`: area lights become points of the same colour in
/// their middle; shadows of all lights are switched off; for reflection the depth of recursion becomes 1; for others a
/// share, an exponent or a count becomes 0 or 1. Precondition: not kSceneShading.
[[nodiscard]] EffectScene without_effect(EffectScene scene, EffectBits effect);

/// @returns the set that remains of `called` without an effect: glass reflects, so without reflection there is no
/// refraction.
[[nodiscard]] std::uint32_t left_without(std::uint32_t called, EffectBits effect);

}  // namespace gridiron::experiment
