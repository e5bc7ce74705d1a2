// Table. SPDX-License-Identifier: Apache-2.0
#include "experiment/table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "base/numbers.h"
#include "base/words.h"

namespace gridiron::experiment {
namespace {

std::string field_of(const Cell& cell) {
  if (const auto* words = std::get_if<std::string>(&cell)) return tool::in_csv(*words);
  if (const auto* count = std::get_if<std::uint64_t>(&cell)) return std::to_string(*count);
  if (const auto* measure = std::get_if<double>(&cell)) return number_text(*measure);
  return "";
}

std::string text_of(double number, std::chars_format format, int precision) {
  if (!std::isfinite(number)) return "";
  std::array<char, 400> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), number, format, precision);
  return error == std::errc{} ? std::string(text.data(), end) : "";
}

}  // namespace

Column::Column(const char* name) : key(name), title(name) {
  std::ranges::replace(title, '_', ' ');
}

Column::Column(std::string name, std::string words, int digits)
    : key(std::move(name)), title(std::move(words)), decimals(digits) {}

std::string number_text(double number) {
  return std::isfinite(number) ? tool::shortest_text(number) : "";
}

std::string number_text(float number) {
  return std::isfinite(number) ? tool::shortest_text(number) : "";
}

std::string fixed_text(double number, int decimals) {
  std::string fixed = text_of(number, std::chars_format::fixed, decimals);
  // No sign for a rounded zero.
  if (!fixed.empty() && fixed.front() == '-' && fixed.find_first_not_of("-0.") == std::string::npos) fixed.erase(0, 1);
  return fixed;
}

std::string scientific_text(double number, int digits) {
  return text_of(number, std::chars_format::scientific, digits - 1);
}

std::string csv_text(const Table& table) {
  std::string text;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (i > 0) text += ',';
    text += tool::in_csv(table.columns[i].key);
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

std::string shown_text(const Cell& cell, int decimals) {
  if (const auto* words = std::get_if<std::string>(&cell)) return *words;
  if (const auto* count = std::get_if<std::uint64_t>(&cell)) return tool::words_of_count(*count);
  if (const auto* measure = std::get_if<double>(&cell)) {
    if (decimals < 0) return *measure == 0 ? "0" : scientific_text(*measure, -decimals);
    constexpr double kMostWhole = 1e15;
    const bool groups = decimals == 0 && *measure >= 0 && *measure < kMostWhole;
    return groups ? tool::words_of_count(static_cast<std::uint64_t>(*measure + 0.5)) : fixed_text(*measure, decimals);
  }
  return "";
}

bool is_number_column(const Table& table, std::size_t column) {
  for (const std::vector<Cell>& row : table.rows) {
    if (std::holds_alternative<std::monostate>(row[column])) continue;
    return !std::holds_alternative<std::string>(row[column]);
  }
  return false;
}

std::string aligned_text(const Table& table) {
  const std::size_t count = table.columns.size();
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < count; ++i) {
    widths.push_back(table.columns[i].title.size());
    for (const std::vector<Cell>& row : table.rows) {
      widths[i] = std::max(widths[i], shown_text(row[i], table.columns[i].decimals).size());
    }
  }
  std::string text;
  const auto add_line = [&](auto cell_of) {
    std::string line;
    for (std::size_t i = 0; i < count; ++i) {
      const std::string cell = cell_of(i);
      const std::string padding(widths[i] - cell.size(), ' ');
      line += (i == 0 ? "" : "  ") + (is_number_column(table, i) ? padding + cell : cell + padding);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  };
  add_line([&](std::size_t i) { return table.columns[i].title; });
  for (const std::vector<Cell>& row : table.rows) {
    add_line([&](std::size_t i) { return shown_text(row[i], table.columns[i].decimals); });
  }
  return text;
}

}  // namespace gridiron::experiment
