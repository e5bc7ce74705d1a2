// Suggestions: the known words that are similar to a mistyped one.
// Memory: std::string. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gridiron::tool {

/// @returns the known word that differs from `word` in capitals alone; nothing if there is none.
[[nodiscard]] std::optional<std::string> word_in_capitals(std::string_view word, std::span<const std::string> known);

/// @returns the fewest letters to add, leave out, replace or exchange with their neighbour to turn a into b, ignoring
/// case. Source: "optimal string alignment" distance.
[[nodiscard]] std::size_t word_distance(std::string_view a, std::string_view b);

/// @returns the words that `word` may have been meant for, three at most, in the list's order: the nearest with at most
/// a third of the letters different, or those that begin with it, end with it or contain it.
[[nodiscard]] std::vector<std::string> near_words(std::string_view word, std::span<const std::string> known);

/// @returns "; did you mean size?", "; did you mean tile-width or macro-width?", or nothing if no word is near.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string> known);

}  // namespace gridiron::tool
