// Numbers in text. SPDX-License-Identifier: Apache-2.0
#include "numbers.h"

#include <cmath>

namespace gridiron::tool {
namespace {

template <class Number>
std::optional<Number> parse_whole(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

std::optional<float> parse_float(std::string_view text) {
  const std::optional<float> number = parse_whole<float>(text);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<std::uint32_t> parse_count(std::string_view text) {
  return parse_whole<std::uint32_t>(text);
}

std::optional<std::uint64_t> parse_address(std::string_view text) {
  if (!text.starts_with("0x") && !text.starts_with("0X")) return parse_whole<std::uint64_t>(text);
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data() + 2, text.data() + text.size(), number, 16);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::optional<Vec3> parse_vector(std::string_view text) {
  Vec3 vector{};
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t comma = axis < 2 ? text.find(',') : text.size();
    if (comma == std::string_view::npos) return std::nullopt;
    const std::optional<float> number = parse_float(text.substr(0, comma));
    if (!number) return std::nullopt;
    vector[axis] = *number;
    text.remove_prefix(axis < 2 ? comma + 1 : comma);
  }
  return vector;
}

std::optional<CountPair> parse_count_pair(std::string_view text, char separator) {
  const std::size_t middle = text.find(separator);
  if (middle == std::string_view::npos) return std::nullopt;
  const std::optional<std::uint32_t> x = parse_count(text.substr(0, middle));
  const std::optional<std::uint32_t> y = parse_count(text.substr(middle + 1));
  if (!x || !y) return std::nullopt;
  return CountPair{*x, *y};
}

}  // namespace gridiron::tool
