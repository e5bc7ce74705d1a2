// One simulated core and the runner: traces, rotating tags, work between transfers, failing transfers, tile order.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/core_runner.h>
#include <gridiron/sim/sim_core.h>

#include "determinism/trace_difference.h"
#include "program_bench.h"
#include "support/trace_steps.h"

namespace gridiron::sim {
namespace {

constexpr Tag kTag{1};

/// A program with double-buffered output, as the kernel has it: work grows with the tile's number only.
Status render_like(const ProgramBench& bench, SimCore& core, std::byte* data, std::uint32_t depth) {
  WorkCounters work;
  const auto note = [&] { core.note_work(work.counts, kWorkKindCount); };
  work.add(Work::kGetIssue);
  note();
  GRIDIRON_TRY(core.get(data, bench.input(), 128, kTag));
  note();
  GRIDIRON_TRY(core.wait(TagMask::of(kTag)));
  for (std::uint32_t slot = 0;; slot = (slot + 1) % depth) {
    note();
    const ItemClaim claim = core.claim_item();
    if (claim.kind == ItemClaim::Kind::kAborted) return Status::kAborted;
    if (claim.kind == ItemClaim::Kind::kNone) break;
    const Tag out{static_cast<std::uint8_t>(kFirstRotatingTag + slot)};
    work.add(Work::kTileStart);
    note();
    GRIDIRON_TRY(core.wait(TagMask::of(out)));
    work.add(GridWork::kSliceStep, claim.item * 10 + 1);
    work.add(GridWork::kCellStep, claim.item);
    note();
    GRIDIRON_TRY(core.put(data + 256 + slot * 64, bench.output(claim.item * 64), 64, out));
  }
  GRIDIRON_TRY(core.wait(TagMask{((1u << depth) - 1) << kFirstRotatingTag}));
  return Status::kOk;
}

ChipResult run_like(ProgramBench& bench, std::uint32_t depth) {
  bench.shape.output_depth = depth;
  return bench.run(
      [&](SimCore& core, std::span<std::byte> data) { return render_like(bench, core, data.data(), depth); });
}

TEST(SimCoreTrace, ATileListsItsStepsInOrderWithTheWorkBetweenThem) {
  ProgramBench bench;
  bench.shape.tile_count = 6;
  const ChipResult result = run_like(bench, 2);
  ASSERT_EQ(result.status, Status::kOk) << words(result);
  ASSERT_EQ(result.trace.tiles.size(), 6u);
  for (std::uint32_t id = 0; id < 6; ++id) {
    const test::UnpackedTrace tile(result.trace.tiles[id]);
    EXPECT_EQ(tile.tile_id, id);
    ASSERT_EQ(tile.events.size(), 4u);
    const EventKind kinds[] = {EventKind::kWork, EventKind::kWait, EventKind::kWork, EventKind::kPut};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(tile.events[i].kind, kinds[i]) << "step " << i;
    // Output slots count from the tile's own, whatever tiles the core had before.
    EXPECT_EQ(tile.events[1].tags, 0u);
    EXPECT_EQ(tile.events[1].rotating_tags, 1u);
    EXPECT_TRUE(tile.events[3].rotating);
    EXPECT_EQ(tile.events[3].tag, 0u);
    EXPECT_EQ(tile.events[3].bytes, 64u);
    EXPECT_EQ(tile.events[3].address, bench.output(id * 64).value);
    const TraceEvent& work = tile.events[2];
    ASSERT_EQ(work.work.size(), id == 0 ? 1u : 2u);
    EXPECT_EQ(work.work[0].kind, GridWork::kSliceStep);
    EXPECT_EQ(work.work[0].amount, id * 10 + 1);
  }
  // Prologue: work, get, wait. Epilogue: the wait for both slots.
  const test::UnpackedTrace prologue(result.trace.prologue), epilogue(result.trace.epilogue);
  ASSERT_EQ(prologue.events.size(), 3u);
  EXPECT_EQ(prologue.events[1].kind, EventKind::kGet);
  EXPECT_FALSE(prologue.events[1].rotating);
  EXPECT_EQ(prologue.events[1].tag, 1u);
  EXPECT_EQ(prologue.events[2].tags, 2u);
  ASSERT_EQ(epilogue.events.size(), 1u);
  EXPECT_EQ(epilogue.events[0].rotating_tags, 3u);
  // Totals are those of the tiles: the prologue is done once per core.
  EXPECT_EQ(result.work[static_cast<std::size_t>(Work::kGetIssue)], 0u);
  EXPECT_EQ(result.work[static_cast<std::size_t>(GridWork::kSliceStep)], 6u + 10 * 15);
  EXPECT_EQ(result.transfers, 7u);
}

TEST(SimCoreTrace, OtherSlotsAreToldByTheirDistanceFromTheTiles) {
  // In tile n, waits for the slots of the next two tiles too.
  ProgramBench bench;
  bench.shape.tile_count = 7;
  bench.shape.output_depth = 3;
  const ChipResult result = bench.run([&](SimCore& core, std::span<std::byte>) {
    for (std::uint32_t ordinal = 0; core.claim_item().kind == ItemClaim::Kind::kItem; ++ordinal) {
      for (std::uint32_t ahead = 0; ahead < 3; ++ahead) {
        const Tag tag{static_cast<std::uint8_t>(kFirstRotatingTag + (ordinal + ahead) % 3)};
        GRIDIRON_TRY(core.wait(TagMask::of(tag)));
      }
    }
    return Status::kOk;
  });
  ASSERT_EQ(result.status, Status::kOk);
  for (const TileTrace& packed : result.trace.tiles) {
    const test::UnpackedTrace tile(packed);
    ASSERT_EQ(tile.events.size(), 3u);
    for (std::uint32_t ahead = 0; ahead < 3; ++ahead) EXPECT_EQ(tile.events[ahead].rotating_tags, 1u << ahead);
  }
}

TEST(SimCoreTrace, DoesNotDependOnWhichCoreRenderedATile) {
  ProgramBench alone;
  alone.shape.tile_count = 40;
  const ChipResult reference = run_like(alone, 3);
  for (std::uint32_t threads = 2; threads <= 6; ++threads) {
    ProgramBench bench;
    bench.shape.tile_count = 40;
    bench.options.threads = threads;
    const ChipResult result = run_like(bench, 3);
    ASSERT_EQ(result.status, Status::kOk) << words(result);
    EXPECT_EQ(result.work, reference.work);
    EXPECT_EQ(test::first_difference(result.trace, reference.trace), "") << "threads " << threads;
  }
}

TEST(SimCoreTrace, WorkCountersMayWrap) {
  ProgramBench bench;
  const ChipResult result = bench.run([&](SimCore& core, std::span<std::byte>) {
    WorkCounters work;
    work.counts[0] = 0xFFFFFFF0u;
    core.note_work(work.counts, kWorkKindCount);
    static_cast<void>(core.claim_item());
    work.counts[0] += 0x20;
    core.note_work(work.counts, kWorkKindCount);
    return Status::kOk;
  });
  EXPECT_EQ(result.work[0], 0x20u);
}

TEST(SimCoreOrder, MovesWhatItIsToldTo) {
  ProgramBench bench;
  bench.shape.tile_count = 1;
  bench.options.completion = Completion::kLate;
  const ChipResult result = bench.run([&](SimCore& core, std::span<std::byte> data) {
    while (core.claim_item().kind == ItemClaim::Kind::kItem) {
    }
    const std::byte* const input = bench.memory().bytes_at(bench.input(), 128).data();
    EXPECT_FALSE(core.move_now(1));
    GRIDIRON_TRY(core.get(data.data(), bench.input(), 64, kTag));
    GRIDIRON_TRY(core.get(data.data() + 64, bench.input(64), 64, kTag));
    // The second alone has come, once.
    EXPECT_TRUE(core.move_now(2));
    EXPECT_FALSE(core.move_now(2));
    EXPECT_FALSE(std::equal(input, input + 64, data.data()));
    EXPECT_TRUE(std::equal(input + 64, input + 128, data.data() + 64));
    GRIDIRON_TRY(core.wait(TagMask::of(kTag)));
    EXPECT_TRUE(std::equal(input, input + 128, data.data()));
    EXPECT_FALSE(core.move_now(1));
    // A destination that was written meanwhile is reported at the next call.
    GRIDIRON_TRY(core.get(data.data(), bench.input(), 64, kTag));
    data[5] = std::byte{1};
    EXPECT_TRUE(core.move_now(3));
    return core.wait(TagMask::of(kTag));
  });
  EXPECT_EQ(result.status, Status::kTransferOverlap) << words(result);
}

TEST(SimCoreFailure, TheNthTransferFailsInItsWaitForEveryN) {
  for (const Completion completion : {Completion::kEarly, Completion::kLate, Completion::kRandom}) {
    for (std::uint64_t n = 1; n <= 8; ++n) {
      SCOPED_TRACE("transfer " + std::to_string(n) + ", completion " + std::to_string(static_cast<int>(completion)));
      ProgramBench bench;
      bench.shape.tile_count = 6;
      bench.options.completion = completion;
      bench.options.fail_transfer = n;
      const ChipResult result = run_like(bench, 2);
      EXPECT_TRUE(result.violations.empty()) << words(result);
      if (n == 8) {  // there are seven
        EXPECT_EQ(result.status, Status::kOk);
        continue;
      }
      EXPECT_EQ(result.status, Status::kTransferFailed);
      EXPECT_EQ(result.failed_tile, n == 1 ? kNoTile : static_cast<std::uint32_t>(n - 2));
      // A failed put has written nothing.
      if (n > 1) {
        EXPECT_EQ(bench.output_bytes()[(n - 2) * 64], std::byte{0});
      }
    }
  }
}

TEST(SimCoreFailure, OfSeveralFailingTilesTheLowestIsToldForAnyThreads) {
  for (std::uint32_t threads = 1; threads <= 6; ++threads) {
    for (std::uint32_t round = 0; round < 20; ++round) {
      ProgramBench bench;
      bench.shape.tile_count = 64;
      bench.options.threads = threads;
      const ChipResult result = bench.run([&](SimCore& core, std::span<std::byte> data) {
        return for_each_tile(core, [&](std::uint32_t tile) {
          // Every tile from 20 on is wrong, each in its own way.
          return tile < 20 ? Status::kOk : core.get(data.data(), bench.input(), tile - 20, kTag);
        });
      });
      ASSERT_EQ(result.status, Status::kTransferSize) << words(result);
      ASSERT_EQ(result.failed_tile, 20u) << "threads " << threads << " round " << round;
      ASSERT_EQ(result.violations.size(), 1u) << words(result);
    }
  }
}

TEST(SimCoreFailure, AStatusThatTheProgramDropsIsStillTold) {
  ProgramBench bench;
  const ChipResult result = bench.run([&](SimCore& core, std::span<std::byte> data) {
    static_cast<void>(core.get(data.data(), bench.input(), 8, kTag));
    return Status::kOk;
  });
  EXPECT_EQ(result.status, Status::kTransferSize);
  EXPECT_EQ(result.violations.size(), 1u);
}

TEST(SimCoreFailure, AProgramsOwnErrorIsToldWithItsTile) {
  ProgramBench bench;
  bench.shape.tile_count = 9;
  bench.options.threads = 2;
  const ChipResult result = bench.run([](SimCore& core, std::span<std::byte>) {
    return for_each_tile(core, [](std::uint32_t tile) { return tile == 4 ? Status::kBadImage : Status::kOk; });
  });
  EXPECT_EQ(result.status, Status::kBadImage);
  EXPECT_EQ(result.failed_tile, 4u);
  EXPECT_TRUE(result.violations.empty());
}

TEST(CoreRunner, RefusesShapesAndLimitsThatMakeNoSense) {
  const auto status_of = [](auto change) {
    ProgramBench bench;
    change(bench);
    return bench.run([](SimCore&, std::span<std::byte>) { return Status::kOk; }).status;
  };
  EXPECT_EQ(status_of([](ProgramBench&) {}), Status::kOk);
  EXPECT_EQ(status_of([](ProgramBench& b) { b.options.threads = 0; }), Status::kBadParameter);
  EXPECT_EQ(status_of([](ProgramBench& b) { b.shape.output_depth = 0; }), Status::kBadParameter);
  EXPECT_EQ(status_of([](ProgramBench& b) { b.shape.data_bytes = 0; }), Status::kBadParameter);
  EXPECT_EQ(status_of([](ProgramBench& b) { b.shape.data_bytes = b.shape.arena_bytes + 16; }), Status::kBadParameter);
  static constexpr std::uint32_t kNoSuchTile = 1;
  EXPECT_EQ(status_of([](ProgramBench& b) { b.options.only_tiles = {&kNoSuchTile, 1}; }), Status::kBadParameter);
  EXPECT_EQ(status_of([](ProgramBench& b) { b.options.limits.congruence_bytes = 256; }), Status::kBadParameter);
  EXPECT_EQ(status_of([](ProgramBench& b) { b.options.limits.boundary_bytes = 3000; }), Status::kBadParameter);
}

}  // namespace
}  // namespace gridiron::sim
