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

/// @returns what Status::kMissingEffect is to people where it is known which: a phrase as words_of(Status) has.
[[nodiscard]] std::string words_of_missing_effects(std::uint32_t bits);

/// @returns the layout of a local store that renders a scene, as firmware writes it:
/// `EffectLayout256K<kSceneShading | kReflection, 8>`, or `StoreLayout128K<8>` where no effect is called for.
/// @param store_kilobytes  64, 128, 256 or 512; with effects it is 256 always.
[[nodiscard]] std::string renderer_type(std::uint32_t called_for, std::uint32_t store_kilobytes,
                                        std::uint32_t packet_width);

}  // namespace gridiron::tool
