// Table: numbers as text, CSV. SPDX-License-Identifier: Apache-2.0
#include "experiment/table.h"

#include <charconv>

#include "support/test_headers.h"

namespace gridiron::test {
namespace {

using experiment::csv_text;
using experiment::fixed_text;
using experiment::number_text;
using experiment::Table;

TEST(Table, NumbersAreShortestAndReadBackTheSame) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(1.0 / 3.0), "0.3333333333333333");
  EXPECT_EQ(number_text(100.0), "100");
  EXPECT_EQ(number_text(-2.5), "-2.5");
  EXPECT_EQ(number_text(0.4f), "0.4") << "as a float, not as the double that it is";
  EXPECT_EQ(number_text(5e-324), "5e-324");
  EXPECT_EQ(number_text(std::nan("")), "");
  EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "");
  std::mt19937_64 random(3);
  for (int i = 0; i < 10'000; ++i) {
    const double number = std::bit_cast<double>(random());
    if (!std::isfinite(number)) continue;
    const std::string text = number_text(number);
    double back = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), back);
    ASSERT_TRUE(error == std::errc{} && end == text.data() + text.size()) << text;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(back), std::bit_cast<std::uint64_t>(number)) << text;
  }
}

TEST(Table, FixedNumbersAreRoundedAndZeroHasNoSign) {
  EXPECT_EQ(fixed_text(1.005, 1), "1.0");
  EXPECT_EQ(fixed_text(12.36, 1), "12.4");
  EXPECT_EQ(fixed_text(1e6, 0), "1000000");
  EXPECT_EQ(fixed_text(-0.04, 1), "0.0");
  EXPECT_EQ(fixed_text(-0.06, 1), "-0.1");
  EXPECT_EQ(fixed_text(std::nan(""), 2), "");
}

TEST(Table, SmallNumbersHaveDigitsNotZeroes) {
  EXPECT_EQ(experiment::scientific_text(1.26e-7, 2), "1.3e-07");
  EXPECT_EQ(experiment::scientific_text(1.0, 3), "1.00e+00");
  EXPECT_EQ(experiment::scientific_text(std::nan(""), 3), "");
  EXPECT_EQ(experiment::shown_text(1.26e-7, -2), "1.3e-07");
  EXPECT_EQ(experiment::shown_text(0.0, -2), "0");
  EXPECT_EQ(experiment::shown_text(0.0, 2), "0.00");
  EXPECT_EQ(experiment::shown_text(12345.6, 0), "12,346");
  EXPECT_EQ(experiment::shown_text(std::uint64_t{12345}, 2), "12,345");
  EXPECT_EQ(experiment::shown_text(std::string("a<b"), 2), "a<b");
  EXPECT_EQ(experiment::shown_text(experiment::Cell{}, 2), "");
}

TEST(Table, PlainTextStandsInColumns) {
  Table table{"", {{"", "name"}, {"", "cost", 1}, {"", "whole"}, {"", "last"}}, {}};
  table.add({"a", 1.25, std::uint64_t{7}, experiment::Cell{}});
  table.add({"longer", 100.0, experiment::Cell{}, experiment::Cell{}});
  EXPECT_EQ(experiment::aligned_text(table),
            "name     cost  whole  last\n"
            "a         1.2      7\n"
            "longer  100.0\n");
}

TEST(Table, FieldsAreQuotedWhereTheyMustBe) {
  Table table{"t", {{"a", "A"}, {"b,c", "B"}}, {}};
  table.add({"plain", 1.5});
  table.add({"with, comma", std::uint64_t{7}});
  table.add({"say \"hi\"", experiment::Cell{}});
  table.add({"two\nlines", std::nan("")});
  table.add({"semicolon; space", -0.25});
  EXPECT_EQ(csv_text(table),
            "a,\"b,c\"\n"
            "plain,1.5\n"
            "\"with, comma\",7\n"
            "\"say \"\"hi\"\"\",\n"
            "\"two\nlines\",\n"
            "semicolon; space,-0.25\n");
}

}  // namespace
}  // namespace gridiron::test
