// Time left: near the truth, and without jumps; stages: seen on a terminal only. SPDX-License-Identifier: Apache-2.0
#include "base/progress.h"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "support/test_headers.h"

namespace gridiron::tool {
namespace {

TEST(TimeLeft, NothingIsToldBeforeThereIsEnoughToGoBy) {
  TimeLeft left;
  left.update(0.5, 0.4);
  EXPECT_FALSE(left.seconds());
  left.update(2, 0.005);
  EXPECT_FALSE(left.seconds());
}

TEST(TimeLeft, AnEvenRateIsToldExactly) {
  TimeLeft left;
  for (int tenth = 1; tenth <= 900; ++tenth) {
    left.update(0.1 * tenth, tenth / 1000.0);
    if (tenth < 10) continue;
    ASSERT_TRUE(left.seconds()) << tenth;
    EXPECT_NEAR(*left.seconds(), 0.1 * (1000 - tenth), 1.0) << tenth;
  }
}

// Parts that take 20 times as long as others, by turns.
TEST(TimeLeft, UnevenPartsMakeItDriftAndNotJump) {
  TimeLeft left;
  double seconds = 0, before = 0;
  for (int part = 1; part <= 500; ++part) {
    seconds += part / 10 % 2 == 0 ? 0.05 : 1.0;
    const bool was_told = left.seconds().has_value();
    before = left.seconds().value_or(0);
    const double last = seconds - (part / 10 % 2 == 0 ? 0.05 : 1.0);
    left.update(seconds, part / 500.0);
    if (!was_told || part < 50) continue;
    EXPECT_LT(std::fabs(*left.seconds() - std::max(0.0, before - (seconds - last))), 0.35 * before + 5) << part;
  }
  EXPECT_LT(*left.seconds(), 5) << "at the end";
}

TEST(TimeLeft, ASlowerHalfIsNoticed) {
  TimeLeft left;
  for (int part = 1; part <= 50; ++part) left.update(0.2 * part, part / 100.0);
  const double told = *left.seconds();
  EXPECT_NEAR(told, 10, 1);
  for (int part = 51; part <= 80; ++part) left.update(10 + 2.0 * (part - 50), part / 100.0);
  EXPECT_GT(*left.seconds(), 20) << "40 seconds are left; 17 by the mean of all";
}

TEST(TimeLeft, WordsAreOfUnits) {
  EXPECT_EQ(words_of_seconds(0), "0 s");
  EXPECT_EQ(words_of_seconds(4.2), "5 s");
  EXPECT_EQ(words_of_seconds(59.5), "1 min 0 s");
  EXPECT_EQ(words_of_seconds(80), "1 min 20 s");
  EXPECT_EQ(words_of_seconds(7500), "2 h 5 min");
  EXPECT_EQ(words_of_seconds(-3), "0 s");
}

// What a terminal is sent while a stage of more than a second lives.
std::string words_of_stage(bool wanted) {
  const int screen = ::posix_openpt(O_RDWR | O_NOCTTY);
  EXPECT_EQ(::grantpt(screen) + ::unlockpt(screen), 0);
  const int terminal = ::open(::ptsname(screen), O_RDWR | O_NOCTTY), usual = ::dup(STDERR_FILENO);
  ::dup2(terminal, STDERR_FILENO);
  {
    const StageLines lines(wanted);
    {
      const Stage stage("a.ply", "reading");
      std::this_thread::sleep_for(std::chrono::milliseconds(1600));
    }
    const Stage brief("b.ply", "reading");
  }
  ::dup2(usual, STDERR_FILENO);
  // What was written arrives piece by piece, some time later.
  std::string words;
  for (pollfd ready{screen, POLLIN, 0}; ::poll(&ready, 1, 500) > 0;) {
    char text[1024];
    words.append(text, static_cast<std::size_t>(std::max<ssize_t>(::read(screen, text, sizeof text), 0)));
  }
  for (const int each : {screen, terminal, usual}) ::close(each);
  return words;
}

TEST(Stage, IsDrawnOnceItTakesASecondAndWipedAtItsEnd) {
  EXPECT_EQ(words_of_stage(false), "");
  const std::string words = words_of_stage(true);
  EXPECT_EQ(words.find("\ra.ply: reading, "), 0u) << words;
  EXPECT_TRUE(words.ends_with("\033[K\r\033[K")) << words;
  EXPECT_EQ(words.find("b.ply"), std::string::npos) << words;
}

}  // namespace
}  // namespace gridiron::tool
