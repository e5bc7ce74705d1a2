// Replay against closed forms: what transfers cost one core, and what cores take from one another.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/replay.h>

#include "replay_cases.h"

namespace gridiron::sim {
namespace {

// Blocking gets: start, wait, start the next. The lines of one leave at once and pass the channel one behind another,
// bytes / 8 cycles at 8 bytes a cycle; the last one is there a latency later. With nothing for issue and wait and no
// limit to lines under way, a get takes latency + bytes / 8, its bandwidth is clock * bytes / (latency + bytes / 8).
struct BlockingGet {
  std::uint32_t bytes;
  double gigabytes_per_second[3];  ///< at 300, 500 and 1,000 cycles, rounded as printed
  double rounding;
};
constexpr double kLatencies[3] = {300, 500, 1000};
constexpr BlockingGet kBlockingGets[] = {{128, {1.30, 0.79, 0.40}, 0.005},
                                         {512, {4.50, 2.90, 1.54}, 0.005},
                                         {2048, {11.79, 8.67, 5.22}, 0.005},
                                         {4096, {16.1, 13.0, 8.7}, 0.05},
                                         {16384, {22.3, 20.6, 17.2}, 0.05}};

TEST(ReplayModel, BlockingGetBandwidthIsTheClosedForm) {
  for (const BlockingGet& get : kBlockingGets) {
    for (std::size_t i = 0; i < 3; ++i) {
      constexpr std::uint32_t kGets = 10;
      Steps tile;
      for (std::uint32_t n = 0; n < kGets; ++n) tile.get(get.bytes, kTriangleTag).wait(bit(kTriangleTag));
      const FrameTiming frame = replay_on(frame_of({tile}), blocking_machine(kLatencies[i]));
      EXPECT_EQ(frame.frame_cycles, kGets * (kLatencies[i] + get.bytes / 8.0)) << get.bytes << " bytes";
      EXPECT_NEAR(kGets * get.bytes / frame.seconds / 1e9, get.gigabytes_per_second[i], get.rounding)
          << get.bytes << " bytes at latency " << kLatencies[i];
    }
  }
}

/// Cycles between two lines on the channel, as the replay rounds them: to 1/1024.
double line_cycles(const MachineProfile& machine) {
  return std::round(machine.line_bytes / machine.channel_bytes_per_cycle * 1024) / 1024;
}

TEST(ReplayModel, BlockingGetsOnTheProfileItself) {
  // What the table above leaves out: issue, wait, 90 % of the channel, and 16 lines under way. Line n + 16 leaves when
  // line n is there, a turn and a latency after it left: as many rounds as 16 goes into the lines before the last.
  const MachineProfile& machine = *find_machine_profile("cell-ps3");
  const double turn = line_cycles(machine);
  for (const std::uint32_t lines : {1u, 2u, 15u, 16u, 17u, 32u, 33u, 128u}) {
    const std::uint32_t rounds = (lines - 1) / 16;
    const std::uint32_t rest = (lines - 1) % 16 + 1;
    const TileTrace tile = Steps().get(lines * 128, kTriangleTag).wait(bit(kTriangleTag));
    const FrameTiming frame = replay_on(frame_of({tile}), machine);
    EXPECT_EQ(frame.cores[0].dma_wait_cycles[kTriangleLevel], rounds * (500 + turn) + rest * turn + 500) << lines;
    EXPECT_EQ(frame.cores[0].compute_cycles, 24 + 14);
    EXPECT_EQ(frame.cores[0].idle_cycles, 2 * 300);
  }
}

TEST(ReplayModel, SixteenCommandsFillTheQueueOfTheProfile) {
  const MachineProfile& machine = *find_machine_profile("cell-ps3");
  Steps tile;
  for (int i = 0; i < 16; ++i) tile.get(128, kTriangleTag, 0);
  EXPECT_EQ(replay_on(frame_of({tile}), machine).cores[0].dma_wait_cycles[kTriangleLevel], 0);
  // The first is issued at 24 and there a turn and a latency later; the sixteenth is issued at 16 * 24.
  tile.get(128, kTriangleTag, 0);
  EXPECT_EQ(replay_on(frame_of({tile}), machine).cores[0].dma_wait_cycles[kTriangleLevel],
            24 + line_cycles(machine) + 500 - 16 * 24);
}

TEST(ReplayModel, OneCoreWithoutContentionIsTheSumByHand) {
  MachineProfile machine = free_machine();
  machine.issue_cycles = 24;
  machine.wait_cycles = 14;
  machine.latency_cycles = 500;
  machine.channel_bytes_per_cycle = 8;  // 16 cycles a line
  machine.claim_cycles = 300;
  machine.work_cycles[static_cast<std::size_t>(GridWork::kPacketStart)] = 500;

  FrameTrace trace;
  trace.prologue = Steps().get(384, kSetupTag, 0).wait(bit(kSetupTag));
  const TileTrace tile = Steps()
                             .work(2, GridWork::kPacketStart)
                             .get(1792, kMacroTag, 0)
                             .wait(bit(kMacroTag))
                             .get(256, kTriangleTag, 0)
                             .work(100)
                             .wait(bit(kTriangleTag))
                             .work(50)
                             .put(4096, 0, true);
  trace.tiles = {tile};
  trace.epilogue = Steps().wait(bit(kFirstOutputTag));

  const FrameTiming frame = replay_on(trace, machine);
  const CoreTiming& core = frame.cores[0];
  EXPECT_EQ(core.init_cycles, 2 * 500);
  EXPECT_EQ(core.compute_cycles, 4 * 24 + 4 * 14 + 100 + 50);
  EXPECT_EQ(core.dma_wait_cycles[kSetupLevel], 3 * 16 + 500);
  EXPECT_EQ(core.dma_wait_cycles[kMacroLevel], 14 * 16 + 500);
  EXPECT_EQ(core.dma_wait_cycles[kTriangleLevel], 2 * 16 + 500 - 100);
  // Between the put and its wait lies the refused claim.
  EXPECT_EQ(core.dma_wait_cycles[kTileLevel], 32 * 16 + 500 - 300);
  EXPECT_EQ(core.idle_cycles, 2 * 300);
  EXPECT_EQ(frame.frame_cycles, accounted_cycles(core));
  EXPECT_EQ(frame.seconds, frame.frame_cycles / 1e9);
  EXPECT_EQ(core.tiles, 1u);
  EXPECT_EQ(core.gets, 3u);
  EXPECT_EQ(core.puts, 1u);
  EXPECT_EQ(core.bytes_in, 384u + 1792 + 256);
  EXPECT_EQ(core.bytes_out, 4096u);
  EXPECT_EQ(frame.channel_busy_cycles, (3 + 14 + 2 + 32) * 16);
}

TEST(ReplayModel, TransfersCostWholeLinesTouched) {
  const struct {
    std::uint64_t address;
    std::uint32_t bytes;
    std::uint32_t lines;
  } cases[] = {{0, 16, 1}, {0, 128, 1}, {112, 16, 1}, {112, 32, 2}, {64, 128, 2}, {0, 144, 2}, {120, 272, 4}};
  for (const auto& c : cases) {
    const TileTrace tile = Steps().get(c.bytes, kTriangleTag, c.address).wait(bit(kTriangleTag));
    const FrameTiming frame = replay_on(frame_of({tile}), blocking_machine(500));
    EXPECT_EQ(frame.cores[0].line_bytes_in, c.lines * 128u) << c.address << " + " << c.bytes;
    EXPECT_EQ(frame.cores[0].bytes_in, c.bytes);
    EXPECT_EQ(frame.frame_cycles, 500 + 16.0 * c.lines) << c.address << " + " << c.bytes;
  }
}

TEST(ReplayModel, InFlightLimitBoundsOneCore) {
  MachineProfile machine = blocking_machine(500);
  machine.lines_in_flight = 16;
  const TileTrace tile = Steps().get(16384, kTriangleTag).wait(bit(kTriangleTag));
  // Line n + 16 leaves when line n has arrived: 16 lines every 516 cycles; the last of 8 rounds ends 15 turns later.
  EXPECT_EQ(replay_on(frame_of({tile}), machine).frame_cycles, 8 * 516 + 15 * 16);
}

TEST(ReplayModel, LineIntervalBoundsOneCore) {
  MachineProfile machine = blocking_machine(500);
  machine.core_line_interval_cycles = 40;
  const TileTrace tile = Steps().get(1280, kTriangleTag, 0).wait(bit(kTriangleTag));
  EXPECT_EQ(replay_on(frame_of({tile}), machine).frame_cycles, 9 * 40 + 516);
}

TEST(ReplayModel, FullQueueStallsTheIssue) {
  MachineProfile machine = blocking_machine(500);
  machine.queue_depth = 2;
  machine.issue_cycles = 10;
  Steps tile;
  for (int i = 0; i < 3; ++i) tile.get(128, kTriangleTag, 0);
  tile.work(5);
  const FrameTiming frame = replay_on(frame_of({tile}), machine);
  // The third get waits for the first, which left at 10 and is there at 526.
  EXPECT_EQ(frame.cores[0].dma_wait_cycles[kTriangleLevel], 526 - 20);
  EXPECT_EQ(frame.cores[0].compute_cycles, 3 * 10 + 5);
  EXPECT_EQ(frame.frame_cycles, 526 + 10 + 5);

  machine.queue_depth = 3;
  EXPECT_EQ(replay_on(frame_of({tile}), machine).frame_cycles, 3 * 10 + 5);

  machine.queue_depth = 1;  // every get but the first waits for the one before
  EXPECT_EQ(replay_on(frame_of({tile}), machine).frame_cycles, 526 + 526 + 10 + 5);
}

TEST(ReplayModel, FullQueueStallHasTheLevelOfTheNewCommand) {
  MachineProfile machine = blocking_machine(500);
  machine.queue_depth = 1;
  const TileTrace tile = Steps().get(128, kMacroTag).put(128, 0, true).work(1);
  const FrameTiming frame = replay_on(frame_of({tile}), machine);
  EXPECT_EQ(frame.cores[0].dma_wait_cycles[kTileLevel], 516);
  EXPECT_EQ(frame.cores[0].dma_wait_cycles[kMacroLevel], 0);
}

TEST(ReplayModel, CommandThatLeftTheQueueIsNotWaitedForAgain) {
  // The queue holds one command. When the second tile waits for the first get, that get's place is taken by the second
  // one, which has had its turn on the channel and is still under way.
  MachineProfile machine = blocking_machine(500);
  machine.queue_depth = 1;
  machine.claim_cycles = 100;
  const TileTrace first = Steps(0).get(128, kMacroTag).get(128, kTriangleTag).work(10);
  const TileTrace second = Steps(1).wait(bit(kMacroTag)).work(1);
  const FrameTiming frame = replay_on(frame_of({first, second}), machine);
  EXPECT_EQ(frame.cores[0].dma_wait_cycles[kMacroLevel], 0);
  EXPECT_EQ(frame.frame_cycles, 100 + 516 + 10 + 100 + 1 + 100);
}

TEST(ReplayModel, ChannelServesCoresInOrderOfRequest) {
  // Both ask at the same times; core 0 first. Lines alternate, so the last lines are one turn apart.
  const TileTrace tile = Steps().get(1280, kTriangleTag, 0).wait(bit(kTriangleTag));
  MachineProfile machine = blocking_machine(500);
  machine.core_line_interval_cycles = 16;
  const FrameTiming frame = replay_on(frame_of({tile, tile}), machine, 2);
  EXPECT_EQ(frame.cores[0].dma_wait_cycles[kTriangleLevel], 19 * 16 + 500);
  EXPECT_EQ(frame.cores[1].dma_wait_cycles[kTriangleLevel], 20 * 16 + 500);
}

TEST(ReplayModel, GetsAndPutsShareTheChannel) {
  MachineProfile machine = blocking_machine(0);
  const TileTrace in = Steps().get(8192, kTriangleTag, 0).wait(bit(kTriangleTag));
  const TileTrace out = Steps().put(8192, 0, true).wait(0, 1);
  EXPECT_EQ(replay_on(frame_of({in}), machine, 1).frame_cycles, 1024);
  EXPECT_EQ(replay_on(frame_of({in, out}), machine, 2).frame_cycles, 2048);
}

/// Streams 512 KB per core in gets of 16 KB, four in flight. @returns GB/s over all cores.
double streaming_bandwidth(const MachineProfile& machine, std::uint32_t cores) {
  Steps tile;
  constexpr std::uint32_t kGets = 32;
  for (std::uint32_t i = 0; i < kGets; ++i) {
    const auto tag = static_cast<std::uint8_t>(kFirstTriangleTag + i % 4);
    tile.wait(bit(tag)).get(16384, tag, 0);
  }
  for (std::uint8_t i = 0; i < 4; ++i) tile.wait(bit(kFirstTriangleTag + i));
  const FrameTiming frame = replay_on(frame_of(std::vector<TileTrace>(cores, tile)), machine, cores);
  EXPECT_LE(frame.channel_busy_cycles, frame.frame_cycles);
  return cores * kGets * 16384.0 / frame.seconds / 1e9;
}

TEST(ReplayModel, TwoOrMoreCoresSaturateTheChannel) {
  // One core: 16 lines of 128 bytes under way, each back a turn (128 / 7.2) and a latency (500) after it left: 3.96
  // bytes a cycle, 12.7 GB/s. Two ask for 25.3 GB/s, the channel carries 7.2 bytes a cycle, 23.04 GB/s.
  const MachineProfile& machine = *find_machine_profile("cell-ps3");
  const double one = streaming_bandwidth(machine, 1);
  EXPECT_NEAR(one, 16 * 128 / 517.8 * 3.2, 0.15);
  EXPECT_GE(one, 10);
  EXPECT_LE(one, 13);
  for (const std::uint32_t cores : {2u, 3u, 6u, 16u}) {
    const double many = streaming_bandwidth(machine, cores);
    EXPECT_NEAR(many, 7.2 * 3.2, 0.4) << cores << " cores";
    EXPECT_GE(many, 20) << cores << " cores";
    EXPECT_LE(many, 23.04) << cores << " cores";
  }
}

TEST(ReplayModel, SaturationFollowsFromWindowAndChannel) {
  MachineProfile machine = *find_machine_profile("cell-ps3");
  for (const std::uint32_t window : {2u, 4u, 8u, 16u}) {
    for (const double channel : {1.8, 3.6, 7.2}) {
      machine.lines_in_flight = window;
      machine.channel_bytes_per_cycle = channel;
      const double one_core = window * 128 / (500 + line_cycles(machine));
      for (const std::uint32_t cores : {1u, 2u, 3u, 6u}) {
        const double expected = std::min(cores * one_core, channel) * 3.2;
        EXPECT_NEAR(streaming_bandwidth(machine, cores), expected, 0.03 * expected)
            << window << " lines, " << channel << " bytes a cycle, " << cores << " cores";
      }
    }
  }
}

TEST(ReplayModel, StreamsOfTheSameKindShareEqually) {
  // While the channel is full, every core has had as many lines as every other, one more or less: all end within a turn
  // for each core.
  const MachineProfile& machine = *find_machine_profile("cell-ps3");
  Steps tile;
  for (std::uint32_t i = 0; i < 16; ++i) tile.get(16384, kTriangleTag, 0);
  tile.wait(bit(kTriangleTag));
  for (const std::uint32_t cores : {2u, 3u, 6u}) {
    const FrameTiming frame = replay_on(frame_of(std::vector<TileTrace>(cores, tile)), machine, cores);
    double least = frame.frame_cycles, most = 0;
    for (const CoreTiming& core : frame.cores) {
      least = std::min(least, core.dma_wait_cycles[kTriangleLevel]);
      most = std::max(most, core.dma_wait_cycles[kTriangleLevel]);
    }
    EXPECT_LE(most - least, cores * line_cycles(machine)) << cores << " cores";
  }
}

TEST(ReplayModel, AStreamHoldsUpASingleLineByItsWindow) {
  // First come, first served: a line waits for those that left before it, at most lines_in_flight of each other core.
  // The stream's lines take turns of 16 cycles from 0 on. At 100, its seventh is being served and window - 1 wait.
  for (const std::uint32_t window : {1u, 2u, 4u, 16u}) {
    MachineProfile machine = blocking_machine(0);
    machine.lines_in_flight = window;
    const TileTrace stream = Steps().get(16384, kTriangleTag, 0).wait(bit(kTriangleTag));
    const TileTrace single = Steps().work(100).get(128, kMacroTag, 0).wait(bit(kMacroTag));
    for (const bool stream_first : {true, false}) {
      const std::vector<TileTrace> tiles =
          stream_first ? std::vector<TileTrace>{stream, single} : std::vector<TileTrace>{single, stream};
      const FrameTiming frame = replay_on(frame_of(tiles), machine, 2);
      EXPECT_EQ(frame.cores[stream_first ? 1 : 0].dma_wait_cycles[kMacroLevel], (6 + window + 1) * 16 - 100)
          << window << " lines, core " << (stream_first ? 1 : 0);
      EXPECT_EQ(frame.cores[stream_first ? 0 : 1].dma_wait_cycles[kTriangleLevel], 129 * 16) << "one turn given up";
    }
  }
}

TEST(ReplayModel, NoCoreStarves) {
  // Five streams and a core that gets single lines: each of its gets is there within the window of the five and its own
  // turn and latency.
  const MachineProfile& machine = *find_machine_profile("cell-ps3");
  constexpr std::uint32_t kGets = 100;
  Steps stream;
  for (std::uint32_t i = 0; i < 64; ++i) stream.get(16384, kTriangleTag, 0);
  stream.wait(bit(kTriangleTag));
  Steps light;
  for (std::uint32_t i = 0; i < kGets; ++i) light.get(128, kMacroTag, 0).wait(bit(kMacroTag));
  const FrameTiming frame = replay_on(frame_of({stream, stream, stream, stream, stream, light}), machine, 6);
  const double wait = frame.cores[5].dma_wait_cycles[kMacroLevel];
  const double turn = line_cycles(machine);
  EXPECT_LE(wait, kGets * (500 + (5 * 16 + 1) * turn));
  EXPECT_GT(wait, kGets * (500 + turn)) << "the streams are felt";
}

}  // namespace
}  // namespace gridiron::sim
