// Replay: its invariants and its determinism; closed forms are in replay_model_test.cpp.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <gridiron/dma/tags.h>
#include <gridiron/platform/tile_order.h>
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/replay.h>

#include <algorithm>
#include <ctime>
#include <random>

#include "replay_cases.h"

namespace gridiron::sim {
namespace {

/// A frame that looks like a rendered one: per packet a cell block, then triangle batches fetched ahead, then output.
/// About lines_per_tile lines of transfers per tile.
FrameTrace synthetic_frame(std::uint32_t seed, std::uint32_t tile_count, std::uint32_t packets_per_tile,
                           std::uint32_t output_depth = 2) {
  std::mt19937 random(seed);
  const auto draw = [&random](std::uint32_t least, std::uint32_t most) {
    return least + static_cast<std::uint32_t>(random() % (most - least + 1));
  };
  FrameTrace trace;
  trace.output_depth = output_depth;
  trace.prologue = Steps().get(384, kSetupTag).wait(bit(kSetupTag)).get(8192, kSetupTag).wait(bit(kSetupTag));
  for (std::uint32_t i = 0; i < tile_count; ++i) {
    Steps tile(i);
    tile.work(1, Work::kTileStart).wait(0, 1);
    for (std::uint32_t packet = 0; packet < packets_per_tile; ++packet) {
      tile.work(1, GridWork::kPacketStart).work(16, Work::kRayGenerated);
      tile.get(1792, kMacroTag, draw(0, 100000) * 128).wait(bit(kMacroTag));
      std::uint8_t slot = 0;
      for (std::uint32_t batch = draw(1, 6); batch > 0; --batch) {
        const std::uint32_t bytes = draw(1, 40) * 48;
        const std::uint64_t address = std::uint64_t{draw(0, 1000000)} * 16;
        tile.get(bytes, static_cast<std::uint8_t>(kFirstTriangleTag + slot), address);
        tile.work(draw(0, 40), Work::kCullTest).wait(bit(kFirstTriangleTag + slot));
        tile.work(draw(0, 90), Work::kGroupTestStandard);
        slot ^= 1;
      }
      tile.work(16, Work::kShadedGroup);
    }
    tile.put(4096, 0, true);
    trace.tiles.push_back(tile);
  }
  trace.epilogue = Steps().wait(0, 0xFF);
  return trace;
}

TEST(Replay, NothingToDoCostsNothing) {
  const FrameTiming frame = replay_on({}, free_machine(), 3);
  EXPECT_EQ(frame.frame_cycles, 0);
  ASSERT_EQ(frame.cores.size(), 3u);
  EXPECT_EQ(accounted_cycles(frame.cores[2]), 0);
}

TEST(Replay, WaitIsForItsTagsOnly) {
  const TileTrace tile =
      Steps().get(128, kMacroTag).get(16384, kTriangleTag).wait(bit(kMacroTag)).work(10).wait(bit(kTriangleTag));
  const FrameTiming frame = replay_on(frame_of({tile}), blocking_machine(500));
  EXPECT_EQ(frame.cores[0].dma_wait_cycles[kMacroLevel], 516);
  EXPECT_EQ(frame.cores[0].dma_wait_cycles[kTriangleLevel], 128 * 16 - 10);
  // A tag that nothing was issued under ends at once.
  EXPECT_EQ(replay_on(frame_of({Steps().get(128, kMacroTag).wait(bit(kTriangleTag)).work(7)}), blocking_machine(500))
                .frame_cycles,
            7);
}

TEST(Replay, MixedWaitBelongsToTheLevelThatEndsLast) {
  const TileTrace tile =
      Steps().get(128, kMacroTag).get(128, kTriangleTag).wait(bit(kMacroTag) | bit(kTriangleTag)).work(1);
  const FrameTiming frame = replay_on(frame_of({tile}), blocking_machine(500));
  EXPECT_EQ(frame.cores[0].dma_wait_cycles[kTriangleLevel], 532);
  EXPECT_EQ(frame.cores[0].dma_wait_cycles[kMacroLevel], 0);
}

TEST(Replay, LevelsFollowTheTags) {
  EXPECT_EQ(wait_level_of_tag(kSetupTag), WaitLevel::kSetup);
  for (std::uint32_t tag = 1; tag < 9; ++tag) EXPECT_EQ(wait_level_of_tag(tag), WaitLevel::kMacroCell) << tag;
  for (std::uint32_t tag = 9; tag < 24; ++tag) EXPECT_EQ(wait_level_of_tag(tag), WaitLevel::kTriangle) << tag;
  for (std::uint32_t tag = 24; tag < 32; ++tag) EXPECT_EQ(wait_level_of_tag(tag), WaitLevel::kTile) << tag;
}

TEST(Replay, FractionsOfACycleCount) {
  MachineProfile machine = free_machine();
  machine.latency_cycles = 0.5;
  const TileTrace tile = Steps().get(128, kTriangleTag).wait(bit(kTriangleTag));
  EXPECT_EQ(replay_on(frame_of({tile}), machine).frame_cycles, 0.5);
  machine.latency_cycles = 1 - 0.4 / 1024;  // rounded to the nearest 1/1024
  EXPECT_EQ(replay_on(frame_of({tile}), machine).frame_cycles, 1);
}

TEST(Replay, ClaimComesBeforeALineOfTheSameTime) {
  // Core 1 asks for its second line when core 0 claims its second tile and asks for a line at once: core 0 is served
  // first, as with every tie.
  MachineProfile machine = blocking_machine(0);
  machine.lines_in_flight = 1;  // core 1: lines at 0 and 16
  const TileTrace work = Steps(0).work(16);
  const TileTrace stream = Steps(1).get(256, kTriangleTag, 0).wait(bit(kTriangleTag));
  const TileTrace late = Steps(2).get(128, kTriangleTag, 0).wait(bit(kTriangleTag));
  const FrameTiming frame = replay_on(frame_of({work, stream, late}), machine, 2);
  EXPECT_EQ(frame.cores[0].dma_wait_cycles[kTriangleLevel], 16);
  EXPECT_EQ(frame.cores[1].dma_wait_cycles[kTriangleLevel], 48);
}

TEST(Replay, PutsCountAsBytesOut) {
  const TileTrace tile = Steps().put(64, 0, true, 8192 + 96).wait(0, 1);
  const FrameTiming frame = replay_on(frame_of({tile}), blocking_machine(500));
  EXPECT_EQ(frame.cores[0].puts, 1u);
  EXPECT_EQ(frame.cores[0].gets, 0u);
  EXPECT_EQ(frame.cores[0].bytes_out, 64u);
  EXPECT_EQ(frame.cores[0].line_bytes_out, 256u);
  EXPECT_EQ(frame.cores[0].bytes_in, 0u);
  EXPECT_EQ(frame.cores[0].line_bytes_in, 0u);
}

TEST(Replay, TimelineTellsTilesAndLevelsApart) {
  const TileTrace tile = Steps(5)
                             .get(128, kMacroTag, 0)
                             .get(128, kTriangleTag, 0)
                             .wait(bit(kMacroTag))
                             .wait(bit(kTriangleTag))
                             .work(3)
                             .work(4);
  const FrameTiming frame = replay(frame_of({tile}), blocking_machine(500), {.core_count = 1, .timeline = true});
  ASSERT_EQ(frame.timeline.size(), 4u);
  const auto expect = [&](std::size_t index, TimelineSpan::Kind kind, double begin, double end) {
    EXPECT_EQ(frame.timeline[index].kind, kind) << index;
    EXPECT_EQ(frame.timeline[index].begin_cycles, begin) << index;
    EXPECT_EQ(frame.timeline[index].end_cycles, end) << index;
    EXPECT_EQ(frame.timeline[index].tile_id, 5u) << index;
  };
  expect(0, TimelineSpan::Kind::kTile, 0, 539);
  expect(1, TimelineSpan::Kind::kWait, 0, 516);
  expect(2, TimelineSpan::Kind::kWait, 516, 532);
  expect(3, TimelineSpan::Kind::kCompute, 532, 539);
  EXPECT_EQ(frame.timeline[1].level, WaitLevel::kMacroCell);
  EXPECT_EQ(frame.timeline[2].level, WaitLevel::kTriangle);
}

TEST(Replay, ClaimsAreGrantedInOrderOfTimeTiesByCore) {
  std::vector<TileTrace> tiles;
  for (const std::uint32_t length : {100u, 10u, 10u, 10u, 10u}) {
    tiles.push_back(Steps(static_cast<std::uint32_t>(tiles.size())).work(length));
  }
  MachineProfile machine = free_machine();
  machine.claim_cycles = 3;
  const FrameTiming frame = replay(frame_of(tiles), machine, {.core_count = 2, .timeline = true});
  EXPECT_EQ(frame.cores[0].tiles, 1u);
  EXPECT_EQ(frame.cores[1].tiles, 4u);
  EXPECT_EQ(frame.frame_cycles, 3 + 100 + 3);
  EXPECT_EQ(frame.cores[1].idle_cycles, 5 * 3 + (106 - 4 * 13 - 3));
  std::vector<std::uint32_t> tiles_of_core_1;
  for (const TimelineSpan& span : frame.timeline) {
    if (span.kind == TimelineSpan::Kind::kTile && span.core == 1) tiles_of_core_1.push_back(span.tile_id);
  }
  EXPECT_EQ(tiles_of_core_1, (std::vector<std::uint32_t>{1, 2, 3, 4}));
}

TEST(Replay, ClaimsWaitForEarlierTransfersOfOtherCores) {
  // Core 0 is slow because of a transfer that is only known after core 1 has claimed: core 1 must still come first.
  std::vector<TileTrace> tiles;
  tiles.push_back(Steps(0).get(128, kTriangleTag).wait(bit(kTriangleTag)));
  tiles.push_back(Steps(1).work(515));
  tiles.push_back(Steps(2).work(1));
  tiles.push_back(Steps(3).work(1));
  const FrameTiming frame = replay(frame_of(tiles), blocking_machine(500), {.core_count = 2, .timeline = true});
  std::vector<std::uint32_t> core_of_tile(4);
  for (const TimelineSpan& span : frame.timeline) {
    if (span.kind == TimelineSpan::Kind::kTile) core_of_tile[span.tile_id] = span.core;
  }
  EXPECT_EQ(core_of_tile, (std::vector<std::uint32_t>{0, 1, 1, 0}));  // core 1 asks at 515, both at 516
}

/// Tiles that wait for their output buffer, work, and put. @returns the frame's wait at the tile level.
double output_wait(std::uint32_t output_depth, double put_cycles, std::uint32_t work) {
  FrameTrace trace;
  trace.output_depth = output_depth;
  for (std::uint32_t i = 0; i < 6; ++i) trace.tiles.push_back(Steps(i).work(work).wait(0, 1).put(128, 0, true));
  MachineProfile machine = blocking_machine(put_cycles - 16);
  return replay_on(trace, machine).cores[0].dma_wait_cycles[kTileLevel];
}

TEST(Replay, RotatingTagsLetPutsOverlap) {
  EXPECT_EQ(output_wait(1, 1000, 100), 5 * 900);  // each tile but the first waits out the put before
  // Two buffers wait for the put before last: 200 of its 1,000 cycles pass in work, then one tile goes without a stall.
  EXPECT_EQ(output_wait(2, 1000, 100), 2 * 800);
  EXPECT_EQ(output_wait(2, 1000, 600), 0);
  EXPECT_EQ(output_wait(1, 1000, 600), 5 * 400);
  EXPECT_EQ(output_wait(8, 1000, 1), 0);
}

TEST(Replay, RotatingTagsAreTheCoresOwn) {
  // Two cores take tiles in turn; each has one put pending when it needs a buffer again, of depth two: no wait.
  FrameTrace trace;
  trace.output_depth = 2;
  for (std::uint32_t i = 0; i < 8; ++i) trace.tiles.push_back(Steps(i).work(600).wait(0, 1).put(128, 0, true));
  const FrameTiming frame = replay_on(trace, blocking_machine(984), 2);
  EXPECT_EQ(frame.cores[0].tiles, 4u);
  EXPECT_EQ(frame.cores[0].dma_wait_cycles[kTileLevel], 0);
  EXPECT_EQ(frame.cores[1].dma_wait_cycles[kTileLevel], 0);
  trace.output_depth = 1;
  EXPECT_EQ(replay_on(trace, blocking_machine(984), 2).cores[0].dma_wait_cycles[kTileLevel], 3 * 400);
}

TEST(Replay, EveryCycleIsAccountedFor) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const FrameTrace trace = synthetic_frame(seed, 64, 4, 1 + seed % 3);
    for (const MachineProfile& machine : machine_profiles()) {
      for (std::uint32_t cores = 1; cores <= 16; ++cores) {
        const FrameTiming frame = replay_on(trace, machine, cores);
        ASSERT_EQ(frame.cores.size(), cores);
        for (const CoreTiming& core : frame.cores) {
          ASSERT_EQ(accounted_cycles(core), frame.frame_cycles)
              << "seed " << seed << ", " << machine.name << ", " << cores << " cores";
        }
        ASSERT_EQ(sum_of(frame.cores).tiles, 64u);
      }
    }
  }
}

TEST(Replay, WorkAndTransfersDoNotDependOnTheNumberOfCores) {
  const FrameTrace trace = synthetic_frame(7, 96, 4);
  const MachineProfile& machine = *find_machine_profile("cell-ps3");
  const auto totals = [&](std::uint32_t cores) {
    CoreTiming sum = sum_of(replay_on(trace, machine, cores).cores);
    // The prologue and the epilogue run once per core.
    sum.compute_cycles -= cores * (2 * machine.issue_cycles + 3 * machine.wait_cycles);
    sum.bytes_in -= cores * (384u + 8192u);
    return sum;
  };
  const CoreTiming one = totals(1);
  for (std::uint32_t cores = 2; cores <= 16; ++cores) {
    const CoreTiming many = totals(cores);
    EXPECT_EQ(many.init_cycles, one.init_cycles) << cores;
    EXPECT_EQ(many.compute_cycles, one.compute_cycles) << cores;
    EXPECT_EQ(many.puts, one.puts) << cores;
    EXPECT_EQ(many.bytes_in, one.bytes_in) << cores;
  }
}

TEST(Replay, MoreCoresAreFasterAndNeverBeyondLinear) {
  const FrameTrace trace = synthetic_frame(11, 256, 4);
  const MachineProfile& machine = *find_machine_profile("cell-ps3");
  const double one = replay_on(trace, machine, 1).frame_cycles;
  double last = one;
  for (const std::uint32_t cores : {2u, 4u, 8u, 16u}) {
    const double cycles = replay_on(trace, machine, cores).frame_cycles;
    EXPECT_LT(cycles, last) << cores;
    EXPECT_GE(cycles * cores, one * 0.999) << cores;
    last = cycles;
  }
}

/// Everything of a frame's timing as text, digits complete.
std::string fingerprint(const FrameTiming& frame) {
  std::string text;
  const auto add = [&text](double value) {
    char digits[40];
    std::snprintf(digits, sizeof digits, "%a ", value);
    text += digits;
  };
  add(frame.frame_cycles);
  add(frame.seconds);
  add(frame.channel_busy_cycles);
  for (const CoreTiming& core : frame.cores) {
    add(core.tiles);
    add(core.init_cycles);
    add(core.compute_cycles);
    for (const double wait : core.dma_wait_cycles) add(wait);
    add(core.idle_cycles);
    add(static_cast<double>(core.gets + core.puts));
    add(static_cast<double>(core.line_bytes_in + core.line_bytes_out));
  }
  for (const TimelineSpan& span : frame.timeline) {
    add(span.core);
    add(static_cast<double>(span.kind));
    add(span.tile_id);
    add(span.begin_cycles);
    add(span.end_cycles);
  }
  return text;
}

TEST(Replay, TwiceIsEqualToTheLastDigit) {
  const MachineProfile& machine = *find_machine_profile("cell-ps3");
  FrameTrace trace = synthetic_frame(3, 64, 4);
  const std::string first = fingerprint(replay(trace, machine, {.core_count = 6, .timeline = true}));
  EXPECT_EQ(fingerprint(replay(trace, machine, {.core_count = 6, .timeline = true})), first);

  // The same frame in other memory, with other capacities.
  for (TileTrace& tile : trace.tiles) tile.packed.reserve(tile.packed.size() * 3);
  trace.tiles.reserve(1000);
  const FrameTrace copy = trace;
  EXPECT_EQ(fingerprint(replay(trace, machine, {.core_count = 6, .timeline = true})), first);
  EXPECT_EQ(fingerprint(replay(copy, machine, {.core_count = 6, .timeline = true})), first);
}

// Traces that come one after another, in the order of claims, by falling number, and in a random order.
TEST(Replay, TracesThatComeLaterChangeNothing) {
  std::mt19937 random(5);
  for (const char* name : {"cell-ps3", "cell-ps3-tlb", "fu540"}) {
    for (const bool is_middle_out : {false, true}) {
      for (const bool is_assigned : {false, true}) {
        SCOPED_TRACE(std::string(name) + (is_middle_out ? ", middle out" : "") + (is_assigned ? ", assigned" : ""));
        const MachineProfile& machine = *find_machine_profile(name);
        FrameTrace trace = synthetic_frame(3, 65, 4);
        trace.is_middle_out = is_middle_out;
        std::vector<std::uint32_t> core_of_tile(65);
        for (std::uint32_t& core : core_of_tile) core = static_cast<std::uint32_t>(random() % 5);
        ReplayOptions options = {.core_count = 5, .timeline = true};
        if (is_assigned) options.core_of_tile = core_of_tile;
        const std::string expected = fingerprint(replay(trace, machine, options));
        FrameTrace frame = trace;
        frame.tiles.clear();
        std::vector<std::uint32_t> claims;
        for (std::uint32_t claim = 0; claim < 65; ++claim) {
          claims.push_back(is_middle_out ? middle_out(claim, 65) : claim);
        }
        std::vector<std::uint32_t> falling(claims.rbegin(), claims.rend()), any = claims;
        std::ranges::shuffle(any, random);
        for (const std::vector<std::uint32_t>& order : {claims, falling, any}) {
          FrameClock clock(frame, 65, machine, options);
          std::size_t most_waiting = 0;
          for (const std::uint32_t tile : order) {
            clock.take(trace.tiles[tile]);
            most_waiting = std::max(most_waiting, clock.waiting_count());
          }
          EXPECT_EQ(clock.waiting_count(), 0u);
          if (!is_assigned && order != any) {
            EXPECT_EQ(most_waiting, order == claims ? 0u : 64u) << "a trace whose turn has come is not kept";
          }
          EXPECT_EQ(fingerprint(clock.finish()), expected);
        }
      }
    }
  }
}

TEST(Replay, TimelineCoversEveryCycleThatIsNotIdle) {
  const FrameTrace trace = synthetic_frame(5, 40, 3);
  const FrameTiming frame = replay(trace, *find_machine_profile("cell-ps3"), {.core_count = 6, .timeline = true});
  std::vector<double> covered(6, 0), end(6, 0);
  std::vector<double> init(6, 0), triangle_wait(6, 0);
  std::set<std::uint32_t> tiles;
  for (const TimelineSpan& span : frame.timeline) {
    ASSERT_LE(span.begin_cycles, span.end_cycles);
    if (span.kind == TimelineSpan::Kind::kTile) {
      EXPECT_TRUE(tiles.insert(span.tile_id).second) << span.tile_id;
      continue;
    }
    ASSERT_GE(span.begin_cycles, end[span.core]) << "spans of core " << span.core << " overlap";
    end[span.core] = span.end_cycles;
    const double cycles = span.end_cycles - span.begin_cycles;
    covered[span.core] += cycles;
    if (span.kind == TimelineSpan::Kind::kInit) init[span.core] += cycles;
    if (span.kind == TimelineSpan::Kind::kWait && span.level == WaitLevel::kTriangle) {
      triangle_wait[span.core] += cycles;
    }
  }
  EXPECT_EQ(tiles.size(), 40u);
  for (std::size_t core = 0; core < 6; ++core) {
    EXPECT_EQ(covered[core] + frame.cores[core].idle_cycles, frame.frame_cycles) << core;
    EXPECT_EQ(init[core], frame.cores[core].init_cycles) << core;
    EXPECT_EQ(triangle_wait[core], frame.cores[core].dma_wait_cycles[kTriangleLevel]) << core;
  }
  EXPECT_TRUE(replay_on(trace, *find_machine_profile("cell-ps3"), 6).timeline.empty());
}

TEST(Replay, SenselessProfileValuesAreTakenAsDocumented) {
  MachineProfile machine = free_machine();
  machine.queue_depth = 0;
  machine.lines_in_flight = 0;
  machine.line_bytes = 0;
  machine.core_count = 0;
  machine.latency_cycles = -5;
  machine.claim_cycles = std::numeric_limits<double>::quiet_NaN();
  machine.channel_bytes_per_cycle = 0;
  FrameTrace trace = frame_of({Steps().get(256, kTriangleTag).wait(bit(kTriangleTag)).work(9)});
  trace.output_depth = 0;
  const FrameTiming frame = replay(trace, machine, {});
  EXPECT_EQ(frame.cores.size(), 1u);
  EXPECT_EQ(frame.frame_cycles, 9);
}

// How long it takes is told, not judged: tests/bench has the comparison.
TEST(Replay, BunnySizedFrameIsReplayed) {
  const FrameTrace trace = synthetic_frame(1, 1024, 20);
  const MachineProfile& machine = *find_machine_profile("cell-ps3");
  const std::clock_t begin = std::clock();  // processor time: other load on the host does not count
  const FrameTiming frame = replay_on(trace, machine, 6);
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  std::uint64_t line_bytes = 0;
  for (const CoreTiming& core : frame.cores) line_bytes += core.line_bytes_in + core.line_bytes_out;
  RecordProperty("lines", std::to_string(line_bytes / 128));
  RecordProperty("seconds", std::to_string(seconds));
  EXPECT_GT(line_bytes / 128, 900000u);
}

}  // namespace
}  // namespace gridiron::sim
