// Table: named columns and rows of cells; one table becomes a CSV file and a table of the page.
// Memory: owns strings. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace gridiron::experiment {

/// Nothing (an empty field), words, a count or a measure.
using Cell = std::variant<std::monostate, std::string, std::uint64_t, double>;

struct Column {
  Column(const char* name);  ///< as key, and its words as title
  Column(std::string name, std::string words, int digits = 2);

  std::string key;    ///< snake_case with the unit as its suffix: the header of the CSV file
  std::string title;  ///< for people
  int decimals = 2;   ///< of measures on the page, below 0: digits of 1.2e-07; the CSV file holds all digits
};

struct Table {
  std::string name;  ///< of the CSV file, without extension
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;  ///< each as long as `columns`

  /// Appends a row. Precondition: as many cells as columns.
  void add(std::vector<Cell> row) { rows.push_back(std::move(row)); }
};

/// @returns a table without rows. @param columns  each a Column, or the key of one.
template <class... Columns>
[[nodiscard]] Table make_table(std::string name, const Columns&... columns) {
  return {std::move(name), {columns...}, {}};
}

/// @returns the shortest decimal text that reads back as the same number (std::to_chars), "" for infinity and NaN.
[[nodiscard]] std::string number_text(double number);
/// The same for a float: as short as a float needs.
[[nodiscard]] std::string number_text(float number);

/// @returns the number with exactly `decimals` digits behind the point.
[[nodiscard]] std::string fixed_text(double number, int decimals);

/// @returns the number with exactly `digits` digits as 1.2e-07. Precondition: digits > 0.
[[nodiscard]] std::string scientific_text(double number, int digits);

/// @returns the table as CSV (RFC 4180 with plain line feeds): a header of keys, then the rows. A field with a comma, a
/// quote or a line break is quoted, and quotes inside it are doubled.
[[nodiscard]] std::string csv_text(const Table& table);

/// @returns a cell's text for the page: measures with the column's digits, counts with separators.
[[nodiscard]] std::string shown_text(const Cell& cell, int decimals);

/// @returns whether a column is aligned like numbers, decided by its first non-empty cell.
[[nodiscard]] bool is_number_column(const Table& table, std::size_t column);

/// @returns the table in columns of plain text, titles first, two spaces between columns, numbers to the right.
[[nodiscard]] std::string aligned_text(const Table& table);

}  // namespace gridiron::experiment
