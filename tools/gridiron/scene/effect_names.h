// Effect names: sets of EffectBits in words. The names themselves: gridiron/base/effect_names.h.
// Memory: static text. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_names.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gridiron::tool {

/// All effects, scene shading first, then in the order of their bits.
[[nodiscard]] std::span<const EffectName> effects();

/// @returns the names of a set, in the order of effects().
[[nodiscard]] std::vector<std::string_view> effect_names(std::uint32_t bits);

/// @returns "scene_shading, reflection", "none" for no effect.
[[nodiscard]] std::string words_of_effects(std::uint32_t bits);

/// @returns a description of Status::kMissingEffect that names the effects: a phrase like those of words_of(Status).
[[nodiscard]] std::string words_of_missing_effects(std::uint32_t bits);

/// @returns the layout of a local store that renders a scene, as firmware writes it: `EffectLayout256K<kSceneShading |
/// kReflection, 8>`, or `StoreLayout128K<8>` without effects.
/// @param store_kilobytes  64, 128, 256 or 512; with effects always 256.
[[nodiscard]] std::string renderer_type(std::uint32_t called_for, std::uint32_t store_kilobytes,
                                        std::uint32_t packet_width);

}  // namespace gridiron::tool
