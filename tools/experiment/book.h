// Book: collects the files of an experiment: CSV tables, SVG plots and the page that shows them.
// Memory: owns all text until it is written. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "experiment/table.h"

namespace gridiron::experiment {

struct BookFile {
  std::string name;  ///< no folders
  std::string content;
};

/// A picture of a row: NAME.png.
struct BookPicture {
  std::string name;  ///< without extension
  std::string png;   ///< bytes of the file
  std::string words;
};

/// Text is passed as plain words and escaped for HTML here.
class Book {
 public:
  /// @param title, lead  heading of the page and the paragraph below it.
  Book(std::string_view title, std::string_view lead);

  /// Opens a section of the page, named in its list of contents. @param id  a word, unique.
  void section(std::string_view id, std::string_view title);
  void paragraph(std::string_view text);

  /// Adds NAME.csv; `caption` stands above the table on the page.
  void table(const Table& table, std::string_view caption);
  /// Adds NAME.csv and a link to it, for tables that are too long to read or differ between runs.
  void linked_table(const Table& table, std::string_view caption);
  /// Shows a table that is a view of others and has no file of its own.
  void shown_table(const Table& table, std::string_view caption);
  /// Adds NAME.svg.
  void figure(std::string_view name, std::string svg, std::string_view caption);
  /// Adds a PNG file for each picture; they are shown side by side, with their words below.
  void pictures(std::vector<BookPicture> row);
  /// Adds a file of plain text under its whole name, and a link to it.
  void text(std::string_view name, std::string content, std::string_view caption);

  /// @returns every file, index.html last. The last call to the book.
  [[nodiscard]] std::vector<BookFile> finish();

 private:
  void add_rows(const Table& table, std::string_view caption);

  std::string title_, lead_;
  std::string contents_, body_;
  std::vector<BookFile> files_;
};

/// Writes all files into `folder`, which exists: each under a hidden name first, then all under their own. Errors:
/// tool::Failure, after which no new file is left.
void write_files(const std::filesystem::path& folder, const std::vector<BookFile>& files);

}  // namespace gridiron::experiment
