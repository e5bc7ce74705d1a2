// Stages: what a core says it is busy with stands in its trace, and the replay gives every cycle, byte and command to
// one. SPDX-License-Identifier: Apache-2.0
#include <gridiron/platform/fault_injection.h>
#include <gridiron/sim/core_runner.h>
#include <gridiron/sim/plain_core.h>
#include <gridiron/sim/replay.h>

#include <numeric>

#include "program_bench.h"
#include "replay_cases.h"
#include "support/trace_steps.h"

namespace gridiron::sim {
namespace {

constexpr Tag kTag{kFirstTriangleTag};

std::uint8_t number_of(Stage stage) {
  return static_cast<std::uint8_t>(stage);
}
std::size_t index_of(Stage stage) {
  return static_cast<std::size_t>(stage);
}

/// Gets in two stages, works in a third, says some stages twice; ends in a stage that is not the first where asked.
template <class Core>
Status render_in_stages(const ProgramBench& bench, Core& core, std::byte* data, bool ends_elsewhere) {
  WorkCounters work;
  const auto go_to = [&](Stage stage) {
    core.note_work(work.counts, kWorkKindCount);
    core.note_stage(number_of(stage));
  };
  for (;;) {
    core.note_work(work.counts, kWorkKindCount);
    const ItemClaim claim = core.claim_item();
    if (claim.kind != ItemClaim::Kind::kItem) break;
    go_to(Stage::kPrimary);
    work.add(Work::kRayGenerated, 3);
    go_to(Stage::kShadow);
    go_to(Stage::kShadow);
    work.add(Work::kShadowRay, 10 + claim.item);
    core.note_work(work.counts, kWorkKindCount);
    GRIDIRON_TRY(core.get(data, bench.input(), 256, kTag));
    GRIDIRON_TRY(core.wait(TagMask::of(kTag)));
    go_to(Stage::kOutput);
    work.add(Work::kColorGroup, 5);
    core.note_work(work.counts, kWorkKindCount);
    GRIDIRON_TRY(core.put(data, bench.output(claim.item * 64), 64, kTag));
    GRIDIRON_TRY(core.wait(TagMask::of(kTag)));
    if (!ends_elsewhere) go_to(Stage::kPrimary);
  }
  return Status::kOk;
}

ChipResult run_in_stages(ProgramBench& bench, std::uint32_t threads, bool ends_elsewhere = false) {
  bench.shape.tile_count = 6;
  bench.options.threads = threads;
  return bench.run([&](SimCore& core, std::span<std::byte> data) {
    return render_in_stages(bench, core, data.data(), ends_elsewhere);
  });
}

TEST(Stages, StandInTheTraceWhereTheyChange) {
  for (const std::uint32_t threads : {1u, 3u}) {
    for (const bool ends_elsewhere : {false, true}) {
      ProgramBench bench;
      const ChipResult result = run_in_stages(bench, threads, ends_elsewhere);
      ASSERT_EQ(result.status, Status::kOk) << words(result);
      std::vector<EventKind> expected = {EventKind::kWork, EventKind::kStage, EventKind::kWork,
                                         EventKind::kGet,  EventKind::kWait,  EventKind::kStage,
                                         EventKind::kWork, EventKind::kPut,   EventKind::kWait};
      if (!ends_elsewhere) expected.push_back(EventKind::kStage);
      for (const TileTrace& tile : result.trace.tiles) {
        std::vector<EventKind> kinds;
        std::vector<Stage> stages;
        for_each_event(tile, [&](const TraceEvent& event) {
          kinds.push_back(event.kind);
          if (event.kind == EventKind::kStage) stages.push_back(event.stage);
        });
        EXPECT_EQ(kinds, expected) << tile.tile_id;
        EXPECT_EQ(stages[0], Stage::kShadow);
        EXPECT_EQ(stages[1], Stage::kOutput);
      }
    }
  }
}

TEST(Stages, GoThroughTheDecoratorThatInjectsFaults) {
  static_assert(StageObserver<SimCore> && StageObserver<FaultInjection<SimCore>>);
  static_assert(!StageObserver<FaultInjection<PlainCore>>);
  ProgramBench bench;
  const ChipResult expected = run_in_stages(bench, 1);
  const ChipResult result = bench.run([&](SimCore& core, std::span<std::byte> data) {
    FaultInjection<SimCore> faulty(core, {});
    return render_in_stages(bench, faulty, data.data(), false);
  });
  ASSERT_EQ(result.trace.tiles.size(), expected.trace.tiles.size());
  EXPECT_EQ(test::UnpackedTrace(result.trace.tiles[3]).events.size(),
            test::UnpackedTrace(expected.trace.tiles[3]).events.size());
}

TEST(Stages, ThatThereAreNotAreToldWithTheTile) {
  ProgramBench bench;
  const ChipResult result = bench.run([&](SimCore& core, std::span<std::byte> data) -> Status {
    static_cast<void>(core.claim_item());
    core.note_stage(kStageCount);
    return core.get(data.data(), bench.input(), 64, kTag);
  });
  EXPECT_EQ(result.status, Status::kBadParameter);
  EXPECT_EQ(result.failed_tile, 0u);
  EXPECT_NE(words(result).find("no stage 7"), std::string::npos) << words(result);
}

TEST(Stages, TheReplayChargesCyclesToTheStageTheCoreIsIn) {
  ProgramBench bench;
  bench.options.threads = 2;
  const ChipResult result = run_in_stages(bench, 2, true);
  MachineProfile machine = blocking_machine(500);
  machine.issue_cycles = 7;
  machine.wait_cycles = 2;
  const CoreTiming core = replay_on(result.trace, machine).cores[0];
  const StageTiming& primary = core.stages[index_of(Stage::kPrimary)];
  const StageTiming& shadow = core.stages[index_of(Stage::kShadow)];
  const StageTiming& output = core.stages[index_of(Stage::kOutput)];
  EXPECT_EQ(primary.compute_cycles, 6 * 3) << "a tile begins in the first stage wherever the one before ended";
  EXPECT_EQ(primary.wait_cycles, 0);
  EXPECT_EQ(shadow.compute_cycles, 6 * 10 + 15 + 6 * (7 + 2));
  EXPECT_EQ(shadow.wait_cycles, 6 * (2 * 16 + 500));
  EXPECT_EQ(shadow.gets, 6u);
  EXPECT_EQ(shadow.puts, 0u);
  EXPECT_EQ(shadow.bytes_in, 6 * 256u);
  EXPECT_EQ(output.compute_cycles, 6 * (5 + 7 + 2));
  EXPECT_EQ(output.wait_cycles, 6 * (16 + 500));
  EXPECT_EQ(output.puts, 6u);
  EXPECT_EQ(output.bytes_out, 6 * 64u);
  EXPECT_EQ(core.stages[index_of(Stage::kBounce)].compute_cycles, 0);
}

TEST(Stages, AFullQueueIsWaitedForInTheStageThatIssues) {
  MachineProfile machine = blocking_machine(500);
  machine.queue_depth = 1;
  const TileTrace tile =
      Steps().get(128, kTriangleTag).stage(Stage::kBounce).get(128, kTriangleTag).stage(Stage::kSurface).work(9);
  const CoreTiming core = replay_on(frame_of({tile}), machine).cores[0];
  EXPECT_EQ(core.stages[index_of(Stage::kBounce)].wait_cycles, 516);
  EXPECT_EQ(core.stages[index_of(Stage::kBounce)].gets, 1u);
  EXPECT_EQ(core.stages[index_of(Stage::kPrimary)].wait_cycles, 0);
  EXPECT_EQ(core.stages[index_of(Stage::kSurface)].compute_cycles, 9);
}

TEST(Stages, SumsAreTheTotalsWithoutRounding) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    FrameTrace trace;
    trace.prologue = Steps().get(384, kSetupTag).wait(bit(kSetupTag));
    for (std::uint32_t id = 0; id < 12; ++id) {
      Steps tile(id);
      for (std::uint32_t step = 0; step < 60; ++step) {
        const auto tag = static_cast<std::uint8_t>(kMacroTag + random() % 12);
        switch (random() % 6) {
          case 0:
            tile.stage(static_cast<Stage>(random() % kStageCount));
            break;
          case 1:
            tile.work(static_cast<std::uint32_t>(random() % 90),
                      random() % 2 != 0 ? Work::kTileStart : Work::kShadowRay);
            break;
          case 2:
            tile.put(static_cast<std::uint32_t>(16 + random() % 64 * 16), tag);
            break;
          case 3:
            tile.wait(bit(tag) | bit(kMacroTag));
            break;
          default:
            tile.get(static_cast<std::uint32_t>(16 + random() % 128 * 16), tag, random() % 4096 * 16);
            break;
        }
      }
      trace.tiles.push_back(tile);
    }
    trace.epilogue = Steps().wait(~0u);
    MachineProfile machine = *find_machine_profile("cell-ps3");
    machine.queue_depth = 4;
    machine.work_cycles.fill(1.0 / 3);
    machine.latency_cycles = 333.37;
    for (const std::uint32_t cores : {1u, 5u}) {
      for (const CoreTiming& core : replay_on(trace, machine, cores).cores) {
        StageTiming sum;
        for (const StageTiming& stage : core.stages) {
          sum.compute_cycles += stage.compute_cycles;
          sum.wait_cycles += stage.wait_cycles;
          sum.gets += stage.gets;
          sum.puts += stage.puts;
          sum.bytes_in += stage.bytes_in;
          sum.bytes_out += stage.bytes_out;
        }
        EXPECT_EQ(sum.compute_cycles, core.init_cycles + core.compute_cycles) << "seed " << seed;
        EXPECT_EQ(sum.wait_cycles,
                  std::accumulate(std::begin(core.dma_wait_cycles), std::end(core.dma_wait_cycles), 0.0))
            << "seed " << seed;
        EXPECT_EQ(sum.gets, core.gets);
        EXPECT_EQ(sum.puts, core.puts);
        EXPECT_EQ(sum.bytes_in, core.bytes_in);
        EXPECT_EQ(sum.bytes_out, core.bytes_out);
        EXPECT_GT(sum.wait_cycles, 0);
      }
    }
  }
}

}  // namespace
}  // namespace gridiron::sim
