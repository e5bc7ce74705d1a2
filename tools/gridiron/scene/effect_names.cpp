// Effect names. SPDX-License-Identifier: Apache-2.0
#include "effect_names.h"

#include <array>
#include <cstddef>

namespace gridiron::tool {
namespace {

// Every effect requires scene shading, which therefore comes first.
constexpr auto kEffects = [] {
  std::array<EffectName, kEffectCount> effects{effect_name(kSceneShading)};
  std::size_t count = 1;
  for (std::uint32_t bit = 1; bit < kAllEffects; bit <<= 1) {
    if (bit != kSceneShading) effects[count++] = effect_name(static_cast<EffectBits>(bit));
  }
  return effects;
}();

// Labels stand below the bars of a chart.
consteval bool have_names_of_their_own() {
  const auto is_same = [](std::string_view a, std::string_view b) { return a == b; };
  for (const EffectName& effect : kEffects) {
    if (std::string_view(effect.label).size() > 10) return false;
    for (const EffectName& other : kEffects) {
      if (effect.bit == other.bit) continue;
      if (is_same(effect.name, other.name) || is_same(effect.words, other.words) ||
          is_same(effect.label, other.label)) {
        return false;
      }
    }
  }
  return true;
}
static_assert(have_names_of_their_own(), "an effect has the name of another, or a label longer than ten letters");

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

std::string words_of_missing_effects(std::uint32_t bits) {
  std::string words;
  for (const EffectName& effect : kEffects) {
    if ((bits & effect.bit) != 0) words.append(words.empty() ? "" : ", ").append(effect.words);
  }
  return "the scene calls for " + words + ", which this renderer was built without";
}

std::string renderer_type(std::uint32_t called_for, std::uint32_t store_kilobytes, std::uint32_t packet_width) {
  if ((called_for & kAllEffects) == 0) {
    if (packet_width == 0 && store_kilobytes == 16) return "TreeLayout16K";
    if (packet_width == 0) return store_kilobytes == 64 ? "TreeLayout64K" : "TreeLayout256K<>";
    return "StoreLayout" + std::to_string(store_kilobytes) + "K<" + std::to_string(packet_width) + ">";
  }
  std::string constants(kEffects[0].constant);
  for (const EffectName& effect : kEffects) {
    if (effect.bit != kSceneShading && (called_for & effect.bit) != 0) constants.append(" | ").append(effect.constant);
  }
  if (store_kilobytes == 64) return "EffectLayout64K<" + constants + ">";
  constexpr std::uint32_t kDefaultPacketWidth = 32;  // of the template
  if (packet_width != kDefaultPacketWidth) constants.append(", ").append(std::to_string(packet_width));
  return "EffectLayout256K<" + constants + ">";
}

}  // namespace gridiron::tool
