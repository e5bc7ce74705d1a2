// Book: the page lists its contents, and text is escaped. SPDX-License-Identifier: Apache-2.0
#include "experiment/book.h"

#include "../gridiron/temporary_folder.h"
#include "base/failure.h"
#include "markup.h"

namespace gridiron::test {
namespace {

using experiment::Book;
using experiment::BookFile;
using experiment::Table;

std::vector<BookFile> small_book() {
  Book book("A & B", "lead <b>");
  book.section("one", "Section 1 < 2");
  book.paragraph("5 < 6 & \"quoted\"");
  Table table{"numbers", {{"name", "name & title"}, {"value", "value", 1}, {"whole", "whole", 0}}, {}};
  table.add({"<tag>", 1234.56, 1234567.8});
  table.add({"missing", experiment::Cell{}, experiment::Cell{}});
  book.table(table, "a caption");
  table.name = "long";
  book.linked_table(table, "a link");
  table.name = "";
  book.shown_table(table, "only shown");
  book.figure("plot", "<svg/>", "what it shows");
  book.pictures({{"left", "png", "one & all"}, {"right", "png", "the other"}});
  return book.finish();
}

TEST(Book, EveryFileIsNamedOnThePageAndTheOtherWayRound) {
  const std::vector<BookFile> files = small_book();
  std::vector<std::string> names, linked;
  for (const BookFile& file : files) names.push_back(file.name);
  EXPECT_EQ(names, (std::vector<std::string>{"numbers.csv", "long.csv", "plot.svg", "left.png", "right.png",
                                             "index.html"}));
  for (const MarkupElement& element : parse_markup(files.back().content)) {
    for (const char* key : {"href", "src"}) {
      const auto found = element.attributes.find(key);
      if (found != element.attributes.end() && found->second.front() != '#') linked.push_back(found->second);
    }
  }
  EXPECT_EQ(linked, (std::vector<std::string>{"numbers.csv", "long.csv", "plot.svg", "left.png", "right.png"}));
}

TEST(Book, WordsStayWordsAndNumbersAreRounded) {
  const auto elements = parse_markup(small_book().back().content);
  EXPECT_EQ(elements_named(elements, "h1").at(0).text, "A & B");
  EXPECT_EQ(elements_named(elements, "h2").at(0).text, "Section 1 < 2");
  const auto cells = elements_named(elements, "td");
  EXPECT_EQ(cells.at(0).text, "<tag>");
  EXPECT_EQ(cells.at(1).text, "1234.6");
  EXPECT_EQ(cells.at(1).attributes.at("class"), "number");
  EXPECT_EQ(cells.at(2).text, "1,234,568");
  EXPECT_EQ(cells.at(4).text, "");
}

TEST(Book, ThePageUsesNothingFromOutside) {
  const std::string page = small_book().back().content;
  for (const char* word : {"http:", "https:", "url(", "@import", "<script"}) {
    EXPECT_EQ(page.find(word), std::string::npos) << word;
  }
}

TEST(Book, FilesAppearTogetherOrNotAtAll) {
  const TemporaryFolder folder;
  const std::vector<BookFile> files = small_book();
  experiment::write_files(folder.folder(), files);
  for (const BookFile& file : files) EXPECT_EQ(read_file(folder.path(file.name)), file.content);

  const TemporaryFolder other;
  std::vector<BookFile> broken = files;
  broken.push_back({"no/such/folder.csv", "x"});
  EXPECT_THROW(experiment::write_files(other.folder(), broken), tool::Failure);
  EXPECT_EQ(other.names(), std::vector<std::string>{});
}

}  // namespace
}  // namespace gridiron::test
