// Suggestions: what is near to a mistyped word. SPDX-License-Identifier: Apache-2.0
#include "base/suggestion.h"

#include <gtest/gtest.h>

namespace gridiron::tool {
namespace {

using Words = std::vector<std::string>;

TEST(Suggestion, DistanceCountsLetters) {
  EXPECT_EQ(word_distance("", ""), 0u);
  EXPECT_EQ(word_distance("size", "size"), 0u);
  EXPECT_EQ(word_distance("size", "SIZE"), 0u);
  EXPECT_EQ(word_distance("szie", "size"), 1u) << "neighbours exchanged";
  EXPECT_EQ(word_distance("sze", "size"), 1u);
  EXPECT_EQ(word_distance("sizee", "size"), 1u);
  EXPECT_EQ(word_distance("sixe", "size"), 1u);
  EXPECT_EQ(word_distance("", "size"), 4u);
  EXPECT_EQ(word_distance("render", "reader"), 1u);
  EXPECT_EQ(word_distance("kitten", "sitting"), 3u);
}

TEST(Suggestion, TheNearestAreNamed) {
  const Words options = {"--help", "--size", "--macro-width", "--tile-width", "--lambda", "-o"};
  EXPECT_EQ(near_words("--szie", options), Words{"--size"});
  EXPECT_EQ(near_words("-size", options), Words{"--size"}) << "one dash too few";
  EXPECT_EQ(near_words("--Lambda", options), Words{"--lambda"});
  EXPECT_EQ(near_words("--width", options), (Words{"--macro-width", "--tile-width"})) << "part of both";
  EXPECT_EQ(near_words("--colour", options), Words{});
  EXPECT_EQ(near_words("", options), Words{});
  EXPECT_EQ(near_words(std::string(100'000, 'x'), options), Words{});
}

TEST(Suggestion, CapitalsMakeNoDifference) {
  const Words words = {"z", "-z", "left"};
  EXPECT_EQ(word_in_capitals("Z", words), "z");
  EXPECT_EQ(word_in_capitals("-Z", words), "-z");
  EXPECT_EQ(word_in_capitals("LeFt", words), "left");
  for (const char* other : {"", "lef", "lefts", "y"}) EXPECT_FALSE(word_in_capitals(other, words)) << other;
}

TEST(Suggestion, SentencesEndInAQuestion) {
  const Words words = {"early", "late", "random"};
  EXPECT_EQ(did_you_mean("erly", words), "; did you mean early?");
  EXPECT_EQ(did_you_mean("never", words), "");
  EXPECT_EQ(did_you_mean("width", Words{"tile-width", "macro-width"}), "; did you mean tile-width or macro-width?");
  EXPECT_EQ(did_you_mean("aaab", Words{"aaac", "aaad", "aaae", "aaaf"}), "; did you mean aaac, aaad or aaae?");
}

}  // namespace
}  // namespace gridiron::tool
