// CSV rows. SPDX-License-Identifier: Apache-2.0
#include "csv_rows.h"

#include "../gridiron/temporary_folder.h"

namespace gridiron::test {

std::vector<std::vector<std::string>> csv_rows(const std::filesystem::path& path) {
  std::vector<std::vector<std::string>> rows = {{""}};
  bool quoted = false;
  for (const char letter : read_file(path)) {
    if (letter == '"') {
      quoted = !quoted;
    } else if (letter == ',' && !quoted) {
      rows.back().emplace_back();
    } else if (letter == '\n') {
      rows.push_back({""});
    } else {
      rows.back().back() += letter;
    }
  }
  rows.pop_back();  // behind the last end of line
  return rows;
}

std::string text_under(const std::vector<std::vector<std::string>>& rows, std::size_t row, const std::string& key) {
  const auto found = std::ranges::find(rows.at(0), key);
  if (found == rows.at(0).end()) {
    ADD_FAILURE() << "no column " << key;
    return "";
  }
  return rows.at(row).at(static_cast<std::size_t>(found - rows.at(0).begin()));
}

double number_under(const std::vector<std::vector<std::string>>& rows, std::size_t row, const std::string& key) {
  const std::string text = text_under(rows, row, key);
  EXPECT_FALSE(text.empty()) << key << " in row " << row;
  return text.empty() ? 0 : std::stod(text);
}

}  // namespace gridiron::test
