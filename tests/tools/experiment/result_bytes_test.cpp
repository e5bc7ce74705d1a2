// Results as bytes: what another rank receives is what was sent. SPDX-License-Identifier: Apache-2.0
#include "experiment/result_bytes.h"

#include <gtest/gtest.h>

namespace gridiron::experiment {
namespace {

TEST(ResultBytes, FramesArriveWhole) {
  EffectFrame sent;
  sent.called_for = 5;
  sent.has_shadows = false;
  sent.work[3] = 7;
  sent.cycles = 1;
  sent.seconds = 2;
  sent.core_cycles = 3;
  sent.scene_bytes = 4;
  sent.picture.width = 2;
  sent.picture.height = 1;
  sent.picture.pixels = {8, 9};
  EffectFrame got;
  take_frame(bytes_of_frame(sent), got);
  EXPECT_EQ(got.called_for, 5u);
  EXPECT_FALSE(got.has_shadows);
  EXPECT_EQ(got.work[3], 7u);
  EXPECT_EQ(got.cycles, 1);
  EXPECT_EQ(got.seconds, 2);
  EXPECT_EQ(got.core_cycles, 3);
  EXPECT_EQ(got.scene_bytes, 4u);
  EXPECT_EQ(got.picture.width, 2u);
  EXPECT_EQ(got.picture.height, 1u);
  EXPECT_EQ(got.picture.pixels, sent.picture.pixels);
}

TEST(ResultBytes, RunsArriveWhole) {
  RunResult sent;
  sent.failure = "too small";
  sent.timing.engine = sim::core_engine(static_cast<std::uint32_t>(EngineId::kGrid));
  ASSERT_NE(sent.timing.engine, nullptr);
  sent.timing.frame_cycles = 1;
  sent.timing.seconds = 2;
  sent.timing.channel_busy_cycles = 3;
  sent.timing.cores.resize(2);
  sent.build_cycles = 4;
  sent.build_seconds = 5;
  tool::ByteWriter writer;
  add_run(writer, sent);
  const tool::Bytes bytes = writer.take();
  tool::ByteReader reader(bytes);
  RunResult got;
  take_run(reader, got);
  EXPECT_TRUE(reader.is_empty());
  EXPECT_EQ(got.failure, "too small");
  EXPECT_EQ(got.timing.engine, sent.timing.engine);
  EXPECT_EQ(got.timing.frame_cycles, 1);
  EXPECT_EQ(got.timing.seconds, 2);
  EXPECT_EQ(got.timing.channel_busy_cycles, 3);
  EXPECT_EQ(got.timing.cores.size(), 2u);
  EXPECT_EQ(got.build_cycles, 4);
  EXPECT_EQ(got.build_seconds, 5);
}

}  // namespace
}  // namespace gridiron::experiment
