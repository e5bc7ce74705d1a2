// Suggestions: the known words that a mistyped one is near to.
// Memory: std::string. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gridiron::tool {

/// @returns how many letters must be added, left out, replaced or exchanged with their neighbour to make b of a, upper
///          and lower case alike. Source: "optimal string alignment" distance.
[[nodiscard]] std::size_t word_distance(std::string_view a, std::string_view b);

/// @returns the words that `word` may have been meant for, three at most, the list's order: those nearest to it, where
///          at most a third of the letters differ, or those that it begins, ends or lies within.
[[nodiscard]] std::vector<std::string> near_words(std::string_view word, std::span<const std::string> known);

/// @returns "; did you mean size?", "; did you mean tile-width or macro-width?", or nothing where no word is near.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string> known);

}  // namespace gridiron::tool
