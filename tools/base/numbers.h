// Numbers in text: one strict, locale-free way for the command line and for files.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace gridiron::tool {

/// @returns the shortest decimals that read back as the same number.
template <class Number>
[[nodiscard]] std::string shortest_text(Number number) {
  char text[32];  // more than any number of 64 bits needs
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

/// @returns the float nearest to the decimal number that is the whole of `text`; nothing for any other text.
[[nodiscard]] std::optional<float> parse_float(std::string_view text);

/// @returns the whole number that is the whole of `text`.
[[nodiscard]] std::optional<std::uint32_t> parse_count(std::string_view text);

/// @returns the whole number, decimal or hexadecimal after 0x, that is the whole of `text`.
[[nodiscard]] std::optional<std::uint64_t> parse_address(std::string_view text);

/// @returns the vector of "x,y,z".
[[nodiscard]] std::optional<Vec3> parse_vector(std::string_view text);

/// Two whole numbers around a separator: "640x480", "3,5".
struct CountPair {
  std::uint32_t x = 0, y = 0;
};
[[nodiscard]] std::optional<CountPair> parse_count_pair(std::string_view text, char separator);

}  // namespace gridiron::tool
