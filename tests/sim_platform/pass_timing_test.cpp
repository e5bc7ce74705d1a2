// The time of passes against closed forms: begin, end, claims and what binds, on one core and several.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/pass_timing.h>

#include "replay_cases.h"

namespace gridiron::sim {
namespace {

PassRun run_of(std::string_view name, std::vector<TileTrace> items) {
  PassRun run;
  run.name = name;
  run.items = static_cast<std::uint32_t>(items.size());
  run.result.trace = frame_of(std::move(items));
  return run;
}

PassRun equal_items(std::string_view name, std::uint32_t items, std::uint32_t work) {
  std::vector<TileTrace> traces;
  for (std::uint32_t i = 0; i < items; ++i) traces.push_back(Steps(i).work(work));
  return run_of(name, std::move(traces));
}

MachineProfile machine_with_passes() {
  MachineProfile machine = free_machine();
  machine.claim_cycles = 10;
  machine.pass_start_cycles = 500;
  machine.pass_barrier_cycles = 700;
  return machine;
}

double limit_of(const PassTiming& pass, PassLimit limit) {
  return pass.limits[static_cast<std::size_t>(limit)];
}

/// The cycles of each core are those of the pass.
void expect_accounted(const PassesTiming& timing) {
  double begin = 0;
  for (const PassTiming& pass : timing.passes) {
    EXPECT_EQ(pass.begin_cycles, begin);
    EXPECT_EQ(pass.cycles, pass.start_cycles + pass.run.frame_cycles + pass.barrier_cycles);
    begin += pass.cycles;
    for (const CoreTiming& core : pass.run.cores) {
      EXPECT_EQ(pass.start_cycles + accounted_cycles(core) + pass.barrier_cycles, pass.cycles);
      EXPECT_LE(core.end_idle_cycles, core.idle_cycles);
    }
    for (const double limit : pass.limits) EXPECT_LE(limit, pass.cycles);
  }
  EXPECT_EQ(timing.cycles, begin);
}

TEST(PassTiming, TwoPassesOfKnownWork) {
  // Four items of 1,000 cycles, then one of 600.
  const PassRun runs[] = {equal_items("many", 4, 1000), equal_items("one", 1, 600)};
  for (const std::uint32_t cores : {1u, 2u, 3u, 4u, 7u}) {
    const PassesTiming timing = replay_passes(runs, machine_with_passes(), cores);
    expect_accounted(timing);
    // A core claims each of its items, and once more in vain.
    const std::uint32_t rounds = (4 + cores - 1) / cores;
    const double many = 500 + rounds * (10 + 1000) + 10 + 700, one = 500 + 10 + 600 + 10 + 700;
    EXPECT_EQ(timing.passes[0].cycles, many) << cores;
    EXPECT_EQ(timing.passes[1].cycles, one) << cores;
    EXPECT_EQ(timing.cycles, many + one) << cores;
    EXPECT_EQ(timing.one_item_cycles, one) << cores;
    EXPECT_EQ(timing.seconds, (many + one) / 1e9);
    EXPECT_EQ(timing.passes[0].name, "many");
    EXPECT_EQ(timing.passes[0].items, 4u);
    EXPECT_EQ(timing.passes[1].items, 1u);

    // What the cores wait for at the end: all of them but those that have as many items as any.
    const CoreTiming& last = timing.passes[0].run.cores.back();
    const std::uint32_t fewest = 4 / cores;
    EXPECT_EQ(last.tiles, fewest);
    EXPECT_EQ(last.end_idle_cycles, (rounds - fewest) * 1010.0);
    EXPECT_EQ(last.idle_cycles - last.end_idle_cycles, (fewest + 1) * 10.0);
    EXPECT_EQ(timing.passes[1].run.cores[0].end_idle_cycles, 0);
    if (cores > 1) {
      EXPECT_EQ(timing.passes[1].run.cores[1].end_idle_cycles, 610);
    }
  }
}

TEST(PassTiming, LimitsOfKnownWork) {
  const PassRun runs[] = {equal_items("many", 4, 1000), equal_items("one", 1, 600), equal_items("small", 2, 5)};
  const PassesTiming timing = replay_passes(runs, machine_with_passes(), 3);
  const PassTiming &many = timing.passes[0], &one = timing.passes[1], &small = timing.passes[2];
  // Claims: one for each item, one of each core in vain.
  EXPECT_EQ(limit_of(many, PassLimit::kCompute), (4 * 1000 + 7 * 10) / 3.0);
  EXPECT_EQ(limit_of(many, PassLimit::kOneItem), 1000);
  EXPECT_EQ(limit_of(many, PassLimit::kBarrier), 1200 + 2 * 1010 / 3.0);
  EXPECT_EQ(limit_of(many, PassLimit::kChannel), 0);
  EXPECT_EQ(limit_of(many, PassLimit::kWaiting), 0);
  EXPECT_EQ(limit_of(one, PassLimit::kOneItem), 600);
  EXPECT_EQ(limit_of(one, PassLimit::kBarrier), 1200 + 2 * 610 / 3.0);
  EXPECT_EQ(limit_of(one, PassLimit::kCompute), (600 + 4 * 10) / 3.0);
  EXPECT_EQ(small.binding, PassLimit::kBarrier);
  EXPECT_EQ(limit_of(small, PassLimit::kBarrier), 1200 + 15 / 3.0);
}

TEST(PassTiming, EachLimitBindsWhereItIsTheGreatest) {
  MachineProfile machine = machine_with_passes();
  machine.latency_cycles = 1000;
  machine.channel_bytes_per_cycle = 8;
  const auto binding = [&](std::vector<TileTrace> items, std::uint32_t cores) {
    const PassRun run = run_of("pass", std::move(items));
    const PassesTiming timing = replay_passes({&run, 1}, machine, cores);
    expect_accounted(timing);
    return timing.passes[0].binding;
  };
  // Work on every core; one long item; a long stream of bytes; many short gets one after another; next to nothing.
  const TileTrace work = Steps().work(50'000);
  EXPECT_EQ(binding(std::vector(8, work), 4), PassLimit::kCompute);
  EXPECT_EQ(binding({work}, 4), PassLimit::kOneItem);
  EXPECT_EQ(binding({work, Steps(1).work(10), Steps(2).work(10)}, 2), PassLimit::kOneItem);
  Steps stream, blocking;
  for (int i = 0; i < 40; ++i) stream.get(16384, kTriangleTag);
  for (int i = 0; i < 40; ++i) blocking.get(128, kTriangleTag).wait(bit(kTriangleTag));
  EXPECT_EQ(binding(std::vector<TileTrace>(8, stream.wait(bit(kTriangleTag))), 4), PassLimit::kChannel);
  EXPECT_EQ(binding(std::vector<TileTrace>(8, blocking), 4), PassLimit::kWaiting);
  EXPECT_EQ(binding({Steps().work(5)}, 2), PassLimit::kBarrier);
  for (std::size_t i = 0; i < kPassLimitCount; ++i) {
    const auto limit = static_cast<PassLimit>(i);
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(name_of(limit), name_of(static_cast<PassLimit>(j)));
    EXPECT_FALSE(name_of(limit).empty());
  }
}

TEST(PassTiming, BytesAndTransfersOfAPass) {
  MachineProfile machine = machine_with_passes();
  machine.channel_bytes_per_cycle = 8;  // 16 cycles a line
  machine.latency_cycles = 100;
  machine.issue_cycles = 3;
  machine.wait_cycles = 2;
  std::vector<TileTrace> items;
  for (std::uint32_t i = 0; i < 2; ++i) {
    items.push_back(Steps(i).get(256, kTriangleTag, 0).wait(bit(kTriangleTag)).work(50).put(128, kMacroTag, false, 0));
  }
  PassRun run = run_of("copy", std::move(items));
  run.result.trace.epilogue = Steps(kNoTile).wait(bit(kMacroTag));
  const PassesTiming timing = replay_passes({&run, 1}, machine, 1);
  expect_accounted(timing);
  const PassTiming& pass = timing.passes[0];
  EXPECT_EQ(pass.bytes_in, 2u * 256);
  EXPECT_EQ(pass.bytes_out, 2u * 128);
  EXPECT_EQ(limit_of(pass, PassLimit::kChannel), 2 * 3 * 16);
  // An item: a command, two lines and a latency, the end of the wait, work, a command. The first line of the second one
  // finds the channel taken by the put before it: for 16 cycles, of which claim and command take 13. A refused claim
  // follows the last put.
  const double item = 3 + 2 * 16 + 100 + 2 + 50 + 3;
  EXPECT_EQ(limit_of(pass, PassLimit::kOneItem), item + 3);
  EXPECT_EQ(pass.run.frame_cycles, 2 * (10 + item) + 3 + 16 + 100 + 2);
  EXPECT_EQ(limit_of(pass, PassLimit::kWaiting), 2 * (2 * 16 + 100) + 3 + 16 + 100 - 10);
}

TEST(PassTiming, APassWithoutItemsTakesItsStart) {
  const PassRun runs[] = {run_of("none", {}), equal_items("one", 1, 600), run_of("none", {})};
  const PassesTiming timing = replay_passes(runs, machine_with_passes(), 2);
  expect_accounted(timing);
  EXPECT_EQ(timing.passes[0].cycles, 500);
  EXPECT_EQ(timing.passes[2].cycles, 500);
  EXPECT_EQ(timing.passes[0].run.cores.size(), 2u);
  EXPECT_EQ(timing.cycles, 1820 + 1000);
  EXPECT_EQ(timing.one_item_cycles, 1820);
  EXPECT_EQ(timing.passes[0].binding, PassLimit::kBarrier);
  EXPECT_EQ(replay_passes({}, machine_with_passes()).cycles, 0);
}

TEST(PassTiming, StartAndBarrierAreRoundedAsAllTimes) {
  MachineProfile machine = machine_with_passes();
  machine.pass_start_cycles = 0.3;
  machine.pass_barrier_cycles = -5;
  const PassRun run = equal_items("one", 1, 600);
  const PassesTiming timing = replay_passes({&run, 1}, machine, 1);
  EXPECT_EQ(timing.passes[0].start_cycles, 307 / 1024.0);
  EXPECT_EQ(timing.passes[0].barrier_cycles, 0);
  machine.pass_start_cycles = 1e9;
  EXPECT_EQ(replay_passes({&run, 1}, machine, 1).passes[0].start_cycles, 1 << 20);
}

TEST(PassTiming, ARunIsTheReplayOfItsTraceWithASeedOfItsOwn) {
  MachineProfile machine = *find_machine_profile("cell-ps3-dram");
  std::vector<TileTrace> items;
  for (std::uint32_t i = 0; i < 20; ++i) {
    items.push_back(Steps(i).get(384, kTriangleTag, i * 4096).wait(bit(kTriangleTag)).work(500 + i));
  }
  const PassRun runs[] = {run_of("first", items), run_of("second", items)};
  const PassesTiming timing = replay_passes(runs, machine);
  expect_accounted(timing);
  EXPECT_EQ(timing.passes[0].run.cores.size(), machine.core_count);
  EXPECT_EQ(timing.passes[0].run.frame_cycles, replay(runs[0].result.trace, machine, {}).frame_cycles);
  EXPECT_NE(timing.passes[1].run.frame_cycles, timing.passes[0].run.frame_cycles);
  ++machine.latency_seed;
  EXPECT_EQ(timing.passes[1].run.frame_cycles, replay(runs[1].result.trace, machine, {}).frame_cycles);
}

TEST(PassTiming, AFrameThatIsOnlyRenderedPaysForNoPass) {
  const FrameTrace trace = frame_of({Steps(0).work(1000), Steps(1).work(1000)});
  MachineProfile free = machine_with_passes();
  free.pass_start_cycles = free.pass_barrier_cycles = 0;
  EXPECT_EQ(replay_on(trace, machine_with_passes(), 2).frame_cycles, 1020);
  EXPECT_EQ(replay_on(trace, free, 2).frame_cycles, 1020);
}

TEST(Replay, TheLongestTileAndTheIdleEndOfACore) {
  const FrameTrace trace = frame_of({Steps(0).work(300), Steps(1).work(100), Steps(2).work(500)});
  const FrameTiming frame = replay_on(trace, machine_with_passes(), 2);
  // Core 0: 10 + 300 + a refused claim. Core 1: 10 + 100 + 10 + 500 + 10.
  EXPECT_EQ(frame.cores[0].longest_tile_cycles, 300);
  EXPECT_EQ(frame.cores[1].longest_tile_cycles, 500);
  EXPECT_EQ(frame.cores[0].end_idle_cycles, 630 - 320);
  EXPECT_EQ(frame.cores[0].idle_cycles, 20 + 310);
  EXPECT_EQ(frame.cores[1].end_idle_cycles, 0);
}

}  // namespace
}  // namespace gridiron::sim
