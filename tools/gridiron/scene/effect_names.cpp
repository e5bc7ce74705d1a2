// Effect names. SPDX-License-Identifier: Apache-2.0
#include "effect_names.h"

#include <iterator>

namespace gridiron::tool {
namespace {

constexpr EffectName kEffects[] = {
    {kSceneShading, "scene_shading", "kSceneShading"}, {kPointShadows, "point_shadows", "kPointShadows"},
    {kAreaLights, "area_lights", "kAreaLights"},       {kReflection, "reflection", "kReflection"},
    {kRefraction, "refraction", "kRefraction"},        {kAmbientOcclusion, "ambient_occlusion", "kAmbientOcclusion"},
    {kEnvironment, "environment", "kEnvironment"},     {kSmoothNormals, "smooth_normals", "kSmoothNormals"},
    {kHighlights, "highlights", "kHighlights"},        {kMultisampling, "multisampling", "kMultisampling"},
};
static_assert(std::size(kEffects) == kEffectCount);

}  // namespace

std::span<const EffectName> effects() {
  return kEffects;
}

std::vector<std::string_view> effect_names(std::uint32_t bits) {
  std::vector<std::string_view> names;
  for (const EffectName& effect : kEffects) {
    if ((bits & effect.bit) != 0) names.push_back(effect.name);
  }
  return names;
}

std::string words_of_effects(std::uint32_t bits) {
  std::string words;
  for (const std::string_view name : effect_names(bits)) {
    if (!words.empty()) words.append(", ");
    words.append(name);
  }
  return words.empty() ? "none" : words;
}

std::string renderer_type(std::uint32_t called_for, std::uint32_t store_kilobytes, std::uint32_t packet_width) {
  if ((called_for & kAllEffects) == 0) {
    return "StoreLayout" + std::to_string(store_kilobytes) + "K<" + std::to_string(packet_width) + ">";
  }
  std::string constants(kEffects[0].constant);  // no effect goes without it
  for (const EffectName& effect : kEffects) {
    if (effect.bit != kSceneShading && (called_for & effect.bit) != 0) constants.append(" | ").append(effect.constant);
  }
  if (packet_width == 0) return "EffectLayout64K<" + constants + ">";
  constexpr std::uint32_t kDefaultPacketWidth = 32;  // of the template
  if (packet_width != kDefaultPacketWidth) constants.append(", ").append(std::to_string(packet_width));
  return "EffectLayout256K<" + constants + ">";
}

}  // namespace gridiron::tool
