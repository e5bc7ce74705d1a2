// Table. SPDX-License-Identifier: Apache-2.0
#include "experiment/table.h"

#include <array>
#include <charconv>
#include <cmath>

namespace gridiron::experiment {
namespace {

std::string quoted(std::string_view field) {
  if (field.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(field);
  std::string text = "\"";
  for (const char letter : field) {
    if (letter == '"') text += '"';
    text += letter;
  }
  return text + "\"";
}

std::string field_of(const Cell& cell) {
  if (const auto* words = std::get_if<std::string>(&cell)) return quoted(*words);
  if (const auto* count = std::get_if<std::uint64_t>(&cell)) return std::to_string(*count);
  if (const auto* measure = std::get_if<double>(&cell)) return number_text(*measure);
  return "";
}

template <class Number>
std::string shortest_text(Number number) {
  if (!std::isfinite(number)) return "";
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} ? std::string(text.data(), end) : "";
}

}  // namespace

std::string number_text(double number) {
  return shortest_text(number);
}

std::string number_text(float number) {
  return shortest_text(number);
}

std::string fixed_text(double number, int decimals) {
  if (!std::isfinite(number)) return "";
  std::array<char, 400> text{};
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), number, std::chars_format::fixed, decimals);
  std::string fixed = error == std::errc{} ? std::string(text.data(), end) : "";
  // A rounded zero has no sign.
  if (!fixed.empty() && fixed.front() == '-' && fixed.find_first_not_of("-0.") == std::string::npos) fixed.erase(0, 1);
  return fixed;
}

std::string csv_text(const Table& table) {
  std::string text;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (i > 0) text += ',';
    text += quoted(table.columns[i].key);
  }
  text += '\n';
  for (const std::vector<Cell>& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) text += ',';
      text += field_of(row[i]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace gridiron::experiment
