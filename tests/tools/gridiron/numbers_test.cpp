// Numbers in text: strict. SPDX-License-Identifier: Apache-2.0
#include "base/numbers.h"

#include <gtest/gtest.h>

namespace gridiron::test {
namespace {

TEST(Numbers, FloatsAreTheWholeTextOrNothing) {
  EXPECT_EQ(tool::parse_float("-73"), -73.0f);
  EXPECT_EQ(tool::parse_float("1.5e2"), 150.0f);
  EXPECT_EQ(tool::parse_float("0.1"), 0.1f);
  for (const char* text : {"", " 1", "1 ", "1x", "nan", "inf", "-inf", "1e99", "--1", "1,5", "0x10"}) {
    EXPECT_FALSE(tool::parse_float(text)) << "'" << text << "'";
  }
}

TEST(Numbers, CountsAreDigits) {
  EXPECT_EQ(tool::parse_count("4294967295"), 4294967295u);
  for (const char* text : {"", "-1", "+1", "1.0", "4294967296", "1 "}) {
    EXPECT_FALSE(tool::parse_count(text)) << "'" << text << "'";
  }
}

TEST(Numbers, AddressesAreDecimalOrHexadecimal) {
  EXPECT_EQ(tool::parse_address("4096"), 4096u);
  EXPECT_EQ(tool::parse_address("0x80200000"), 0x80200000u);
  EXPECT_EQ(tool::parse_address("0XffffFFFFffffffff"), 0xFFFFFFFFFFFFFFFFu);
  for (const char* text : {"", "0x", "x10", "80200000h", "-1", "0x-1", "0x10000000000000000", "1 ", "0x1 "}) {
    EXPECT_FALSE(tool::parse_address(text)) << "'" << text << "'";
  }
}

TEST(Numbers, VectorsHaveThreeParts) {
  EXPECT_EQ(tool::parse_vector("1,-2,3.5"), Vec3(1, -2, 3.5f));
  for (const char* text : {"", "1,2", "1,2,", ",1,2", "1,2,3,4", "1;2;3", "1, 2,3", "1,2,nan"}) {
    EXPECT_FALSE(tool::parse_vector(text)) << "'" << text << "'";
  }
}

TEST(Numbers, PairsHaveOneSeparator) {
  const auto size = tool::parse_count_pair("640x480", 'x');
  ASSERT_TRUE(size);
  EXPECT_EQ(size->x, 640u);
  EXPECT_EQ(size->y, 480u);
  for (const char* text : {"", "640", "640x", "x480", "640x480x3", "640X480", "-1x2"}) {
    EXPECT_FALSE(tool::parse_count_pair(text, 'x')) << "'" << text << "'";
  }
}

}  // namespace
}  // namespace gridiron::test
