// Reads animation.csv. Memory: strings. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/test_headers.h"

namespace gridiron::test {

using Row = std::map<std::string, std::string>;

/// @returns the rows of a table, by the names of its columns. Fields hold no commas and no quotes.
inline std::vector<Row> read_table(const std::filesystem::path& path) {
  std::ifstream file(path);
  EXPECT_TRUE(file.good()) << path;
  const auto fields = [](const std::string& line) {
    std::vector<std::string> parts;
    std::istringstream stream(line);
    for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
    return parts;
  };
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> names = fields(line);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> values = fields(line);
    EXPECT_EQ(values.size(), names.size()) << line;
    Row row;
    for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) row[names[i]] = values[i];
    rows.push_back(row);
  }
  return rows;
}

}  // namespace gridiron::test
