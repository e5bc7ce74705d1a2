// What effects are called: the one table of their names. Apart from effect_records.h, so that only what prints has the
// texts. Memory: constants, where a name is used. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>

namespace gridiron {

/// What one effect is called.
struct EffectName {
  EffectBits bit;        ///< the effect
  const char* name;      ///< one word of reports: "point_shadows"; nullptr where there is no such effect
  const char* constant;  ///< as C++ has it: "kPointShadows"
  const char* words;     ///< in a sentence: "shadows of point lights"
  const char* label;     ///< below a bar of a chart, at most ten letters: "shadows"
};

// A value of EffectBits that is missing here does not compile.
#pragma GCC diagnostic push
#pragma GCC diagnostic error "-Wswitch"
#define GRIDIRON_EFFECT_NAME(bit, name, words, label) \
  case bit:                                           \
    return {bit, name, #bit, words, label};

/// @returns the names of one effect; all of them nullptr where it is no single bit of EffectBits.
[[nodiscard]] constexpr EffectName effect_name(EffectBits effect) {
  switch (effect) {
    GRIDIRON_EFFECT_NAME(kPointShadows, "point_shadows", "shadows of point lights", "shadows")
    GRIDIRON_EFFECT_NAME(kAreaLights, "area_lights", "area lights", "areas")
    GRIDIRON_EFFECT_NAME(kReflection, "reflection", "reflection", "mirrors")
    GRIDIRON_EFFECT_NAME(kRefraction, "refraction", "refraction", "glass")
    GRIDIRON_EFFECT_NAME(kAmbientOcclusion, "ambient_occlusion", "ambient occlusion", "occlusion")
    GRIDIRON_EFFECT_NAME(kEnvironment, "environment", "an environment", "sky")
    GRIDIRON_EFFECT_NAME(kSmoothNormals, "smooth_normals", "smooth normals", "smooth")
    GRIDIRON_EFFECT_NAME(kHighlights, "highlights", "highlights", "shine")
    GRIDIRON_EFFECT_NAME(kMultisampling, "multisampling", "several samples a pixel", "samples")
    GRIDIRON_EFFECT_NAME(kVertexColors, "vertex_colors", "colours at vertices", "colors")
    GRIDIRON_EFFECT_NAME(kSceneShading, "scene_shading", "scene shading", "shading")
  }
  return {effect, nullptr, nullptr, nullptr, nullptr};
}

#undef GRIDIRON_EFFECT_NAME
#pragma GCC diagnostic pop

static_assert(effect_name(static_cast<EffectBits>(1u << (kEffectCount - 1))).name != nullptr &&
                  effect_name(static_cast<EffectBits>(1u << kEffectCount)).name == nullptr,
              "kEffectCount is not the number of effects");

}  // namespace gridiron
