// Words: one phrase for every value. SPDX-License-Identifier: Apache-2.0
#include "base/words.h"

#include "support/test_headers.h"

namespace gridiron::test {
namespace {

TEST(Words, EveryStatusHasItsOwn) {
  std::set<std::string> phrases;
  for (int value = 0; value <= static_cast<int>(Status::kBadEffects); ++value) {
    const std::string phrase = tool::words_of(static_cast<Status>(value));
    EXPECT_NE(phrase, "unknown status") << value;
    EXPECT_TRUE(phrases.insert(phrase).second) << phrase;
  }
}

TEST(Words, EveryPlyErrorHasItsOwn) {
  std::set<std::string> phrases;
  for (int value = 1; value <= static_cast<int>(PlyError::kTriangleSpanTooSmall); ++value) {
    const std::string phrase = tool::words_of(static_cast<PlyError>(value));
    EXPECT_FALSE(phrase.empty()) << value;
    EXPECT_TRUE(phrases.insert(phrase).second) << phrase;
  }
}

TEST(Words, CountsAndBytesAreReadable) {
  EXPECT_EQ(tool::words_of_count(0), "0");
  EXPECT_EQ(tool::words_of_count(999), "999");
  EXPECT_EQ(tool::words_of_count(1000), "1,000");
  EXPECT_EQ(tool::words_of_count(1234567), "1,234,567");
  EXPECT_EQ(tool::words_of_count(1, "core"), "1 core");
  EXPECT_EQ(tool::words_of_count(6, "core"), "6 cores");
  EXPECT_EQ(tool::words_of_bytes(1023), "1023 bytes");
  EXPECT_EQ(tool::words_of_bytes(1536), "1.5 KB");
  EXPECT_EQ(tool::words_of_bytes(std::uint64_t{256} << 20), "256.0 MB");
}

}  // namespace
}  // namespace gridiron::test
