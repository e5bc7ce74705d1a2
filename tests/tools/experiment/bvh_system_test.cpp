// BVH system: the grid's picture, its own build and caches, a time that depends on machine and cores alone.
// SPDX-License-Identifier: Apache-2.0
#include "experiment/bvh_system.h"

#include <gridiron/sim/build_work.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "../gridiron/failure_of.h"
#include "files/interrupt.h"

namespace gridiron::test {
namespace {

using namespace experiment;

constexpr FrameRequest kSmall = {.width = 96, .height = 64, .shading = Shading::kSimple};

double wait_of(const sim::FrameTiming& timing) {
  double sum = 0;
  for (const sim::CoreTiming& core : timing.cores) {
    for (const double wait : core.dma_wait_cycles) sum += wait;
  }
  return sum;
}

TEST(BvhSystem, RendersTheGridsPicture) {
  const View knot = make_knot_view(6000);
  const auto grid = GridSystem(grid_variant("reference")).record(knot, kSmall);
  for (const bool hyper_threading : {false, true}) {
    const auto bvh = BvhSystem(hyper_threading).record(knot, kSmall);
    EXPECT_EQ(bvh->facts().picture_hash, grid->facts().picture_hash);
    EXPECT_EQ(bvh->facts().dropped_triangles, grid->facts().dropped_triangles);
    EXPECT_GT(bvh->facts().traversal_steps, 0u);
    EXPECT_GT(bvh->facts().intersection_tests, 0u);
    EXPECT_FALSE(bvh->facts().grid.has_value());
  }
}

TEST(BvhSystem, BuildIsCountedInStepsOfItsOwn) {
  const View knot = make_knot_view(6000);
  const FrameFacts bvh = BvhSystem(true).record(knot, kSmall)->facts();
  const FrameFacts grid = GridSystem(grid_variant("reference")).record(knot, kSmall)->facts();
  EXPECT_EQ(bvh.build[sim::BuildStep::kBvhTriangleSurvey], 6000u);
  EXPECT_EQ(bvh.build[sim::BuildStep::kBvhTriangleWrite], 6000u);
  EXPECT_EQ(grid.build[sim::BuildStep::kTriangleSurvey], 6000u);
  EXPECT_GE(grid.build[sim::BuildStep::kTriangleWrite], 6000u);
  EXPECT_GT(bvh.build[sim::BuildStep::kBinUpdate], 0u);
  EXPECT_GT(bvh.build[sim::BuildStep::kNodeMade], 0u);
  EXPECT_GT(bvh.build[sim::BuildStep::kBinSwept], bvh.build[sim::BuildStep::kNodeMade]);
  EXPECT_EQ(grid.build[sim::BuildStep::kBinUpdate], 0u);
  EXPECT_GT(grid.build[sim::BuildStep::kReferenceSort], 0u);
  // No step belongs to both.
  for (std::size_t i = 0; i < sim::kBuildStepCount; ++i) {
    EXPECT_TRUE(bvh.build.counts[i] == 0 || grid.build.counts[i] == 0) << i;
  }
}

// The time that was kept from the first frame is that of a frame rendered anew.
TEST(BvhSystem, TimeDependsOnMachineAndCoresAlone) {
  const View knot = make_knot_view(6000);
  const auto first = BvhSystem(true).record(knot, kSmall), second = BvhSystem(true).record(knot, kSmall);
  sim::MachineProfile renamed = *home_machine();
  renamed.name = "the same under another name";  // so that it is rendered anew
  EXPECT_EQ(first->time(*home_machine(), 0).timing.frame_cycles, second->time(renamed, 6).timing.frame_cycles);
  EXPECT_EQ(first->time(*home_machine(), 6).timing.frame_cycles, second->time(renamed, 0).timing.frame_cycles);

  const double one = first->time(renamed, 1).timing.frame_cycles;
  EXPECT_EQ(one, first->time(renamed, 1).timing.frame_cycles);
  EXPECT_GT(one, first->time(renamed, 6).timing.frame_cycles);
  renamed.latency_cycles = 2000;
  EXPECT_GT(first->time(renamed, 1).timing.frame_cycles, one);
}

TEST(BvhSystem, HyperThreadingHidesMissesAndIsCounted) {
  const View knot = make_knot_view(6000);
  const TimedFrame single = BvhSystem(false).record(knot, kSmall)->time(*home_machine(), 0);
  const TimedFrame turns = BvhSystem(true).record(knot, kSmall)->time(*home_machine(), 0);
  ASSERT_TRUE(single.caches && turns.caches);
  EXPECT_EQ(single.caches->suspended_packets, 0u);
  EXPECT_GT(turns.caches->suspended_packets, 0u);
  for (const TimedFrame* frame : {&single, &turns}) {
    EXPECT_GT(frame->caches->node_hit_percent, 50);
    EXPECT_LT(frame->caches->node_hit_percent, 100);
    EXPECT_GT(frame->caches->triangle_hit_percent, 0);
    EXPECT_LT(frame->caches->triangle_hit_percent, 100);
  }
  EXPECT_LT(wait_of(turns.timing), wait_of(single.timing));
}

// Renders a frame twice, interrupted after a quarter of it the second time. Ends the process with the failure's code; 1
// where the frame went on for longer than another quarter.
[[noreturn]] void render_interrupted() {
  using Clock = std::chrono::steady_clock;
  const View knot = make_knot_view(6000);
  const FrameRequest large = {.width = 3072, .height = 3072, .shading = Shading::kSimple};
  const Clock::time_point begin = Clock::now();
  (void)BvhSystem(true).record(knot, large);
  const Clock::duration quarter = (Clock::now() - begin) / 4;
  tool::watch_for_interrupt();
  Clock::time_point sent;
  std::thread sender([&] {
    std::this_thread::sleep_for(quarter);
    sent = Clock::now();
    std::raise(SIGINT);
  });
  int code = 0;
  try {
    (void)BvhSystem(true).record(knot, large);
  } catch (const tool::Failure& failure) {
    code = static_cast<int>(failure.code());
  }
  const Clock::time_point end = Clock::now();
  sender.join();
  std::_Exit(end - sent < quarter ? code : 1);
}

TEST(BvhSystemDeathTest, AnInterruptStopsBetweenTiles) {
  EXPECT_EXIT(render_interrupted(), testing::ExitedWithCode(130), "");
}

TEST(BvhSystem, AMachineThatIsTooSmallIsTold) {
  const auto recording = BvhSystem(true).record(make_knot_view(6000), kSmall);
  sim::MachineProfile small = *home_machine();
  small.main_memory_bytes = 100'000;
  (void)failure_of([&] { return recording->time(small, 0); });  // 6,000 triangles in 100 KB
}

}  // namespace
}  // namespace gridiron::test
