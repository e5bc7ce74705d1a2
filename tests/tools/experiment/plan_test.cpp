// Plan: each frame once, each run once, no result from the number of threads. SPDX-License-Identifier: Apache-2.0
#include "experiment/plan.h"

#include <atomic>

#include "base/failure.h"
#include "support/test_headers.h"

namespace gridiron::test {
namespace {

using namespace experiment;

// Cycles that identify their run: clock and cores of the machine.
class FakeRecording : public Recording {
 public:
  FakeRecording() { facts_.build.add(sim::BuildStep::kNodeMade, 16); }
  [[nodiscard]] const FrameFacts& facts() const override { return facts_; }
  [[nodiscard]] TimedFrame time(const sim::MachineProfile& machine, std::uint32_t core_count) const override {
    sim::FrameTiming timing;
    timing.frame_cycles = 1000.0 / core_count;
    timing.seconds = timing.frame_cycles / machine.clock_hz;
    timing.cores.resize(core_count);
    return {timing, CacheFacts{.node_hit_percent = 90, .triangle_hit_percent = 80, .suspended_packets = core_count}};
  }

 private:
  FrameFacts facts_;
};

class FakeSystem : public System {
 public:
  FakeSystem(std::string key, std::atomic<int>& frames) : key_(std::move(key)), frames_(frames) {}
  [[nodiscard]] std::string key() const override { return key_; }
  [[nodiscard]] std::unique_ptr<Recording> record(const View& view, const FrameRequest&) const override {
    ++frames_;
    if (view.key == "too_big") throw tool::Failure(tool::ExitCode::kBadInput, "does not fit");
    if (view.key == "broken") throw tool::Failure(tool::ExitCode::kCheckFailed, "a rule is broken");
    return std::make_unique<FakeRecording>();
  }

 private:
  std::string key_;
  std::atomic<int>& frames_;
};

View view_named(const std::string& key) {
  return {key, key, nullptr, {}};
}

const auto kNoProgress = [](std::uint32_t, std::uint32_t) {};

TEST(Plan, FramesAreRenderedOnceAndRunsAreShared) {
  std::atomic<int> frames = 0;
  const auto system = std::make_shared<FakeSystem>("a", frames), same = std::make_shared<FakeSystem>("a", frames);
  const View view = view_named("v");
  const Machine machine = built_in_machine("cell-ps3");
  Plan plan(8, 8);
  const auto one = plan.add(view, system, Shading::kNone, machine, 1);
  const auto six = plan.add(view, system, Shading::kNone, machine, 6);
  EXPECT_EQ(plan.add(view, same, Shading::kNone, machine, 6), six);
  const auto shaded = plan.add(view, system, Shading::kSimple, machine, 6);
  EXPECT_NE(shaded, six);
  EXPECT_EQ(plan.frame_count(), 2u);
  EXPECT_EQ(plan.run_count(), 3u);
  std::vector<std::uint32_t> steps;
  plan.execute(1, [&steps](std::uint32_t done, std::uint32_t total) {
    steps.push_back(done);
    EXPECT_EQ(total, 3u);
  });
  EXPECT_EQ(frames, 2);
  EXPECT_EQ(steps, (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_EQ(plan.result(one).timing.frame_cycles, 1000);
  EXPECT_EQ(plan.result(six).timing.cores.size(), 6u);
}

// What is rendered anew for each machine counts once a run, what is replayed once.
class ReplayedRecording : public FakeRecording {
 public:
  [[nodiscard]] TimedFrame time(const sim::MachineProfile& machine, std::uint32_t core_count) const override {
    return {FakeRecording::time(machine, core_count).timing, std::nullopt};
  }
};

class ReplayedSystem : public System {
 public:
  [[nodiscard]] std::string key() const override { return "replayed"; }
  [[nodiscard]] std::unique_ptr<Recording> record(const View&, const FrameRequest&) const override {
    return std::make_unique<ReplayedRecording>();
  }
};

TEST(Plan, RenderedFramesAreCounted) {
  std::atomic<int> frames = 0;
  const auto anew = std::make_shared<FakeSystem>("anew", frames);
  const auto replayed = std::make_shared<ReplayedSystem>();
  const View view = view_named("v"), too_big = view_named("too_big");
  const Machine machine = built_in_machine("cell-ps3");
  Plan plan(8, 8);
  for (const std::uint32_t cores : {1u, 2u, 3u}) {
    (void)plan.add(view, anew, Shading::kNone, machine, cores);
    (void)plan.add(view, replayed, Shading::kNone, machine, cores);
  }
  (void)plan.add(too_big, anew, Shading::kNone, machine, 1);
  plan.execute(1, kNoProgress);
  EXPECT_EQ(plan.rendered_count(), 3u + 1u) << "three by the system with caches, one replayed, none that failed";
}

// The build has its price on the master of the run's machine, and caches are those of the run.
TEST(Plan, BuildAndCachesBelongToTheRun) {
  std::atomic<int> frames = 0;
  const auto system = std::make_shared<FakeSystem>("a", frames);
  const View view = view_named("v");
  Machine slow = built_in_machine("cell-ps3");
  slow.key = "slow";
  slow.profile.master.clock_hz /= 2;
  Plan plan(8, 8);
  const auto fast_run = plan.add(view, system, Shading::kNone, built_in_machine("cell-ps3"), 1);
  const auto slow_run = plan.add(view, system, Shading::kNone, slow, 2);
  plan.execute(1, kNoProgress);
  const RunResult& fast = plan.result(fast_run);
  const double step = slow.profile.master.step_cycles[static_cast<std::size_t>(sim::BuildStep::kNodeMade)];
  EXPECT_EQ(fast.build_cycles, 16 * step);
  EXPECT_EQ(plan.result(slow_run).build_cycles, fast.build_cycles);
  EXPECT_DOUBLE_EQ(plan.result(slow_run).build_seconds, 2 * fast.build_seconds);
  EXPECT_DOUBLE_EQ(fast.fps_with_build(), 1 / (1 / fast.fps() + fast.build_seconds));
  EXPECT_EQ(fast.caches->suspended_packets, 1u);
  EXPECT_EQ(plan.result(slow_run).caches->suspended_packets, 2u);
}

TEST(Plan, AFrameThatCannotBeIsAFailedRun) {
  std::atomic<int> frames = 0;
  const auto system = std::make_shared<FakeSystem>("a", frames);
  const View good = view_named("good"), bad = view_named("too_big");
  Plan plan(8, 8);
  const auto failed = plan.add(bad, system, Shading::kNone, built_in_machine("cell-ps3"), 1);
  const auto fine = plan.add(good, system, Shading::kNone, built_in_machine("cell-ps3"), 1);
  plan.execute(2, kNoProgress);
  EXPECT_EQ(plan.result(failed).failure, "does not fit");
  EXPECT_TRUE(std::isnan(plan.result(failed).fps()));
  EXPECT_FALSE(plan.result(fine).failed());
}

TEST(Plan, ABrokenRuleEndsTheExperiment) {
  std::atomic<int> frames = 0;
  const auto system = std::make_shared<FakeSystem>("a", frames);
  const View broken = view_named("broken");
  for (const std::uint32_t threads : {1u, 3u}) {
    Plan plan(8, 8);
    (void)plan.add(broken, system, Shading::kNone, built_in_machine("cell-ps3"), 1);
    EXPECT_THROW(plan.execute(threads, kNoProgress), tool::Failure);
  }
}

// A frame of the real system is what the replay makes of it, for any number of threads.
TEST(Plan, RealFramesDoNotDependOnThreads) {
  const View knot = make_knot_view(600);
  const Machine machine = built_in_machine("cell-ps3");
  std::vector<double> cycles[2];
  std::uint64_t hashes[2] = {};
  for (const std::uint32_t threads : {1u, 3u}) {
    Plan plan(64, 48);
    std::vector<Plan::RunId> runs;
    for (const Contender& contender : make_contenders()) {
      for (const std::uint32_t cores : {1u, 6u}) {
        runs.push_back(plan.add(knot, contender.unhidden, Shading::kSimple, machine, cores));
        runs.push_back(plan.add(knot, contender.system, Shading::kSimple, machine, cores));
      }
    }
    plan.execute(threads, kNoProgress);
    for (const Plan::RunId run : runs) cycles[threads > 1].push_back(plan.result(run).timing.frame_cycles);
    hashes[threads > 1] = plan.result(runs.back()).facts.picture_hash;
    EXPECT_LT(plan.result(runs[1]).wait_cycles(), plan.result(runs[0]).wait_cycles()) << "double buffering hides";
    EXPECT_EQ(plan.result(runs[0]).facts.picture_hash, plan.result(runs.back()).facts.picture_hash);
  }
  EXPECT_EQ(cycles[0], cycles[1]);
  EXPECT_EQ(hashes[0], hashes[1]);
}

}  // namespace
}  // namespace gridiron::test
