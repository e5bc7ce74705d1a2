// Book. SPDX-License-Identifier: Apache-2.0
#include "experiment/book.h"

#include <utility>

#include "files/atomic_file.h"
#include "report/svg_plot.h"

namespace gridiron::experiment {
using namespace plot;
namespace {

constexpr std::string_view kStyle = R"(
:root { color-scheme: light; }
body { font: 16px/1.55 system-ui, -apple-system, "Segoe UI", sans-serif; color: #222; background: #fff;
  max-width: 62rem; margin: 2rem auto 5rem; padding: 0 1.2rem; }
h1 { font-size: 1.9rem; line-height: 1.25; margin-bottom: 0.6rem; }
h2 { font-size: 1.35rem; margin-top: 3rem; padding-top: 0.8rem; border-top: 1px solid #ddd; }
p { max-width: 48rem; }
nav ul { columns: 2; padding-left: 1.2rem; }
a { color: #0057a3; }
figure { margin: 1.4rem 0 2rem; }
figure img { width: 100%; max-width: 45rem; height: auto; display: block; }
.strip { display: flex; flex-wrap: wrap; gap: 0.8rem; }
.strip figure { margin: 0; width: 9.5rem; }
.strip img { image-rendering: pixelated; }
figcaption, caption { color: #555; font-size: 0.92rem; text-align: left; max-width: 48rem; padding: 0.3rem 0; }
.scroll { overflow-x: auto; margin: 1.2rem 0; }
table { border-collapse: collapse; font-size: 0.9rem; font-variant-numeric: tabular-nums; }
th, td { padding: 0.25rem 0.7rem; border-bottom: 1px solid #e4e4e4; text-align: left; vertical-align: bottom; }
th { border-bottom: 2px solid #999; font-weight: 600; }
td.number, th.number { text-align: right; }
tbody tr:hover { background: #f5f8fb; }
)";

}  // namespace

Book::Book(std::string_view title, std::string_view lead) : title_(escape_markup(title)), lead_(escape_markup(lead)) {}

void Book::section(std::string_view id, std::string_view title) {
  const std::string name(id), words = escape_markup(title);
  contents_ += "<li><a href=\"#" + name + "\">" + words + "</a></li>\n";
  body_ += "<h2 id=\"" + name + "\">" + words + "</h2>\n";
}

void Book::paragraph(std::string_view text) {
  body_ += "<p>" + escape_markup(text) + "</p>\n";
}

void Book::table(const Table& table, std::string_view caption) {
  const std::string file = table.name + ".csv";
  files_.push_back({file, csv_text(table)});
  add_rows(table, escape_markup(caption) + " <a href=\"" + file + "\">" + file + "</a>");
}

void Book::linked_table(const Table& table, std::string_view caption) {
  const std::string file = table.name + ".csv";
  files_.push_back({file, csv_text(table)});
  body_ += "<p><a href=\"" + file + "\">" + file + "</a>: " + escape_markup(caption) + "</p>\n";
}

void Book::shown_table(const Table& table, std::string_view caption) {
  add_rows(table, escape_markup(caption));
}

void Book::add_rows(const Table& table, std::string_view caption) {
  std::vector<std::string> cells_begin;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    cells_begin.emplace_back(is_number_column(table, i) ? " class=\"number\">" : ">");
  }
  body_ += "<div class=\"scroll\"><table>\n<caption>" + std::string(caption) + "</caption>\n<thead><tr>";
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    body_ += "<th scope=\"col\"" + cells_begin[i] + escape_markup(table.columns[i].title) + "</th>";
  }
  body_ += "</tr></thead>\n<tbody>\n";
  for (const std::vector<Cell>& row : table.rows) {
    body_ += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      body_ += "<td" + cells_begin[i] + escape_markup(shown_text(row[i], table.columns[i].decimals)) + "</td>";
    }
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
}

void Book::figure(std::string_view name, std::string svg, std::string_view caption) {
  const std::string file = std::string(name) + ".svg";
  body_ += "<figure><img src=\"" + file + "\" alt=\"" + escape_markup(caption) + "\"/><figcaption>" +
           escape_markup(caption) + "</figcaption></figure>\n";
  files_.push_back({file, std::move(svg)});
}

void Book::pictures(std::vector<BookPicture> row) {
  body_ += "<div class=\"strip\">\n";
  for (BookPicture& picture : row) {
    const std::string file = picture.name + ".png", words = escape_markup(picture.words);
    body_ +=
        "<figure><img src=\"" + file + "\" alt=\"" + words + "\"/><figcaption>" + words + "</figcaption></figure>\n";
    files_.push_back({file, std::move(picture.png)});
  }
  body_ += "</div>\n";
}

void Book::text(std::string_view name, std::string content, std::string_view caption) {
  body_ +=
      "<p><a href=\"" + std::string(name) + "\">" + std::string(name) + "</a>: " + escape_markup(caption) + "</p>\n";
  files_.push_back({std::string(name), std::move(content)});
}

std::vector<BookFile> Book::finish() {
  std::string page = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n";
  page += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n";
  page += "<title>" + title_ + "</title>\n<style>" + std::string(kStyle) + "</style>\n</head>\n<body>\n";
  page += "<h1>" + title_ + "</h1>\n<p>" + lead_ + "</p>\n<nav><ul>\n" + contents_ + "</ul></nav>\n";
  page += body_ + "</body>\n</html>\n";
  files_.push_back({"index.html", std::move(page)});
  return std::move(files_);
}

void write_files(const std::filesystem::path& folder, const std::vector<BookFile>& files) {
  tool::AtomicFiles open;
  for (const BookFile& file : files) open.add(folder / file.name, file.content);
  open.commit();
}

}  // namespace gridiron::experiment
