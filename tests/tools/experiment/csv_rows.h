// Reads CSV files that the program wrote.
// Memory: strings. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace gridiron::test {

/// @returns the rows of a CSV file, quoted fields without their quotes; the first row holds the keys.
std::vector<std::vector<std::string>> csv_rows(const std::filesystem::path& path);

/// @returns a row's value under a key; a test failure if there is no such column.
std::string text_under(const std::vector<std::vector<std::string>>& rows, std::size_t row, const std::string& key);

/// @returns the number in a row under a key; a test failure if there is none.
double number_under(const std::vector<std::vector<std::string>>& rows, std::size_t row, const std::string& key);

}  // namespace gridiron::test
