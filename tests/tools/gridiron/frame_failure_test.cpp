// Frame failures: exit codes and words. SPDX-License-Identifier: Apache-2.0
#include "gridiron/frame/frame_failure.h"

#include <gridiron/sim/sim_core.h>

#include "support/test_headers.h"

namespace gridiron::test {
namespace {

using tool::ExitCode;

TEST(FrameFailure, AGoodFrameHasNone) {
  EXPECT_FALSE(tool::frame_failure({}));
}

TEST(FrameFailure, ViolationsAreListedAndFailTheCheck) {
  sim::ChipResult result;
  result.violations = {{Status::kTransferOverlap, 2, 7, "get of 64 bytes at 0x80"},
                       {Status::kTransferPending, 3, sim::kNoTile, "tag 5"}};
  const auto failure = tool::frame_failure(result);
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->code(), ExitCode::kCheckFailed);
  const std::string words = failure->what();
  EXPECT_NE(words.find("core 2, tile 7: transfer that overlaps"), std::string::npos) << words;
  EXPECT_NE(words.find("get of 64 bytes at 0x80"), std::string::npos) << words;
  EXPECT_NE(words.find("core 3, outside tiles: transfer that was never waited for: tag 5"), std::string::npos) << words;
  EXPECT_NE(words.find("rules of the machine broken: 2"), std::string::npos) << words;
}

TEST(FrameFailure, AFailedTransferNamesCoreAndTile) {
  sim::ChipResult result;
  result.status = Status::kTransferFailed;
  result.failed_core = 1;
  result.failed_tile = 42;
  const auto failure = tool::frame_failure(result);
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->code(), ExitCode::kCheckFailed);
  EXPECT_STREQ(failure->what(), "the frame failed on core 1, tile 42: transfer that failed");
}

TEST(FrameFailure, ManyViolationsAreCutShort) {
  sim::ChipResult result;
  result.violations.resize(1025, {Status::kBadAccess, 0, 0, "x"});
  const auto failure = tool::frame_failure(result);
  ASSERT_TRUE(failure);
  const std::string words = failure->what();
  EXPECT_EQ(std::ranges::count(words, '\n'), 21);
  EXPECT_NE(words.find("... and 1,005 more"), std::string::npos) << words;
}

TEST(FrameFailure, WhatTheHostHasNotIsNoFailedCheck) {
  sim::ChipResult result = sim::ended_by(sim::HostShortage::kMemory);
  EXPECT_EQ(tool::frame_failure(result)->code(), ExitCode::kBadInput);
  EXPECT_STREQ(tool::frame_failure(result, "a.ply")->what(),
               "a.ply: this host has not enough memory to render the frame; fewer --threads need less");
  result = sim::ended_by(sim::HostShortage::kThreads);
  EXPECT_EQ(tool::frame_failure(result)->code(), ExitCode::kBadInput);
  EXPECT_STREQ(tool::frame_failure(result)->what(), "this host cannot start a thread for each core of the machine");
}

TEST(FrameFailure, WhatTheBuildCannotDoIsUsage) {
  sim::ChipResult result;
  result.status = Status::kUnsupportedFrame;
  EXPECT_EQ(tool::frame_failure(result)->code(), ExitCode::kUsage);
  result.status = Status::kUnsupportedImage;
  EXPECT_EQ(tool::frame_failure(result)->code(), ExitCode::kBadInput);
}

}  // namespace
}  // namespace gridiron::test
