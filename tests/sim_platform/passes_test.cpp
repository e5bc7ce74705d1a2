// Passes on the simulated chip: one after another on shared memory, with every rule checked, and every way to end.
// Memory: pass_kernels.h. Threads: starts some. SPDX-License-Identifier: Apache-2.0
#include <gridiron/platform/fault_injection.h>
#include <gridiron/sim/pass_timing.h>
#include <gridiron/sim/passes.h>

#include <atomic>

#include "determinism/trace_difference.h"
#include "pass_kernels.h"

namespace gridiron::sim {
namespace {

constexpr Completion kCompletions[] = {Completion::kEarly, Completion::kLate, Completion::kRandom};
constexpr Mode kModes[] = {Mode::kChecked, Mode::kPlain};

std::string words(const PassesResult& result) {
  std::string text = "status " + std::to_string(static_cast<int>(result.status)) + " after " +
                     std::to_string(result.passes.size()) + " passes";
  if (result.passes.empty()) return text;
  for (const Violation& v : result.passes.back().result.violations) {
    text += "\n  rule " + std::to_string(static_cast<int>(v.rule)) + " item " + std::to_string(v.tile_id) + ": ";
    text += v.detail;
  }
  return text;
}

/// A kernel that calls act(core, item) for each of its items.
template <class Act>
auto items_kernel(Act act) {
  return [act](auto& core, std::span<std::byte> data) {
    for (;;) {
      const ItemClaim claim = core.claim_item();
      if (claim.kind == ItemClaim::Kind::kAborted) return Status::kAborted;
      if (claim.kind != ItemClaim::Kind::kItem) return Status::kOk;
      GRIDIRON_TRY(act(core, data, claim.item));
    }
  };
}

TEST(Passes, ShareMainMemoryOneAfterAnother) {
  for (const Mode mode : kModes) {
    for (const Completion completion : kCompletions) {
      for (const std::uint32_t threads : {1u, 2u, 3u, 40u}) {
        NumberPasses bench(37);
        ChipOptions options;
        options.mode = mode;
        options.completion = completion;
        options.threads = threads;
        options.seed = threads;
        const std::vector<Pass> passes = bench.passes();
        const PassesResult result = run_passes(bench.memory(), passes, options);
        ASSERT_EQ(result.status, Status::kOk) << words(result);
        ASSERT_EQ(result.passes.size(), 3u);
        std::uint64_t transfers = 0;
        for (std::size_t i = 0; i < 3; ++i) {
          EXPECT_EQ(result.passes[i].name, passes[i].name);
          EXPECT_EQ(result.passes[i].items, bench.items()[i]);
          transfers += result.passes[i].result.transfers;
        }
        EXPECT_EQ(result.transfers, transfers);
        bench.expect_done(3, std::to_string(threads) + " threads");
      }
    }
  }
}

TEST(Passes, LeaveTheSameTracesForAnyThreadsAndCompletion) {
  NumberPasses bench(37);
  ChipOptions options;
  const PassesResult first = run_passes(bench.memory(), bench.passes(), options);
  ASSERT_EQ(first.status, Status::kOk) << words(first);
  EXPECT_EQ(first.passes[0].result.work[WorkId(Work::kRayGenerated).number()], 37u * 10 + 37 * 36 / 2);
  EXPECT_EQ(first.passes[1].result.work[WorkId(Work::kCullTest).number()], 37u * 64);
  EXPECT_EQ(first.passes[1].result.work[WorkId(Work::kRayGenerated).number()], 0u);
  const MachineProfile& machine = *find_machine_profile("cell-ps3-dram");
  const PassesTiming timing = replay_passes(first.passes, machine, 3);
  for (const Completion completion : kCompletions) {
    for (const std::uint32_t threads : {2u, 3u, 5u}) {
      bench.clear_results();
      options.completion = completion;
      options.threads = threads;
      options.seed = threads;
      const PassesResult other = run_passes(bench.memory(), bench.passes(), options);
      ASSERT_EQ(other.status, Status::kOk) << words(other);
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(test::first_difference(first.passes[i].result.trace, other.passes[i].result.trace), "") << i;
        EXPECT_EQ(first.passes[i].result.work, other.passes[i].result.work);
      }
      const PassesTiming again = replay_passes(other.passes, machine, 3);
      EXPECT_EQ(again.cycles, timing.cycles);
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(again.passes[i].limits, timing.passes[i].limits);
        EXPECT_EQ(again.passes[i].bytes_in, timing.passes[i].bytes_in);
      }
    }
  }
}

TEST(Passes, ACountOfItemsIsReadWhenThePassBeforeHasEnded) {
  // The passes before have put it into memory. Here nothing does: no items, then one too many, then no memory at all.
  for (const Mode mode : kModes) {
    NumberPasses bench(5);
    ChipOptions options;
    options.mode = mode;
    const auto run = [&](std::uint32_t things, ItemCount items) {
      std::memcpy(bench.head().bytes.data(), &things, sizeof things);
      std::vector<Pass> passes = bench.passes();
      passes = {passes[2], passes[0]};
      passes[0].items = items;
      return run_passes(bench.memory(), passes, options);
    };
    const MainAddress head = bench.head().address;
    const PassesResult none = run(0, {3, head, 64});
    EXPECT_EQ(none.status, Status::kOk);
    EXPECT_EQ(none.passes.size(), 2u) << "the next pass runs";
    EXPECT_EQ(none.passes[0].items, 0u);
    EXPECT_TRUE(bench.is_clear(2));
    EXPECT_FALSE(bench.is_clear(0));
    for (const std::uint32_t things : {1u, 64u, 65u, 128u, 129u, 192u}) {
      const PassesResult some = run(things, {3, head, 64});
      EXPECT_EQ(some.status, Status::kOk) << words(some);
      EXPECT_EQ(some.passes[0].items, (things + 63) / 64);
    }
    bench.clear_results();
    const MainAddress outside = MainAddress{bench.memory().used_bytes() + 4096};
    using Case = std::pair<std::uint32_t, ItemCount>;
    for (const auto& [things, items] : {Case{193, {3, head, 64}}, Case{~0u, {3, head, 1}}, Case{1, {3, head, 0}},
                                        Case{1, {3, outside, 1}}}) {
      const PassesResult wrong = run(things, items);
      EXPECT_EQ(wrong.status, Status::kBadParameter) << things;
      ASSERT_EQ(wrong.passes.size(), 1u);
      EXPECT_EQ(wrong.passes[0].name, "square");
      EXPECT_EQ(wrong.transfers, 0u);
      EXPECT_TRUE(bench.is_clear(0) && bench.is_clear(2));
    }
  }
}

TEST(Passes, EachPassHasItsOwnMemoryToWrite) {
  // What the pass before has written may be read by all items, and not be written any more.
  NumberPasses bench(4);
  std::vector<Pass> passes = bench.passes();
  passes[2].writable = passes[0].writable;
  const PassesResult result = run_passes(bench.memory(), passes, {});
  EXPECT_EQ(result.status, Status::kTransferMainRange);
  ASSERT_EQ(result.passes.size(), 3u);
  EXPECT_EQ(result.passes[2].result.failed_tile, 0u);
  ASSERT_FALSE(result.passes[2].result.violations.empty());
  EXPECT_EQ(result.passes[2].result.violations[0].tile_id, 0u);
}

TEST(Passes, ItemsOfAPassDoNotPutWhatOthersUse) {
  NumberPasses bench(4);
  const MainAddress shared = bench.doubled().address;
  // Items 1 and 3 put the same bytes, or item 3 gets what item 1 puts.
  for (const bool puts_both : {true, false}) {
    const auto act = [=](auto& core, std::span<std::byte> data, std::uint32_t item) -> Status {
      if (item % 2 == 0) return Status::kOk;
      const Status started = item == 1 || puts_both ? core.put(data.data(), shared, 64, Tag{1})
                                                    : core.get(data.data(), shared, 64, Tag{1});
      GRIDIRON_TRY(started);
      return core.wait(TagMask::of(Tag{1}));
    };
    const Pass pass = {.name = "clash",
                       .items = {4},
                       .data_bytes = 256,
                       .writable = {NumberPasses::range(bench.doubled())},
                       .kernel = items_kernel(act)};
    const PassesResult result = run_passes(bench.memory(), std::span(&pass, 1), {});
    EXPECT_EQ(result.status, Status::kTransferOverlap) << words(result);
    // In two passes the same is legal.
    const Pass first_half = {.name = "first",
                             .items = {2},
                             .data_bytes = 256,
                             .writable = pass.writable,
                             .kernel = items_kernel(act)};
    const Pass both[] = {first_half, first_half};
    const PassesResult halves = run_passes(bench.memory(), both, {});
    EXPECT_EQ(halves.status, Status::kOk) << words(halves);
  }
}

TEST(Passes, WritableMemoryMayComeInAnyOrderAndInPieces) {
  NumberPasses bench(4);
  std::vector<Pass> passes = bench.passes();
  const MainRange whole = passes[0].writable[0];
  const std::uint64_t middle = whole.begin + 300;  // within a transfer
  passes[0].writable = {{middle, whole.end}, {whole.end, whole.end}, {whole.begin, middle + 16}};
  const PassesResult result = run_passes(bench.memory(), passes, {});
  EXPECT_EQ(result.status, Status::kOk) << words(result);
  bench.expect_done(3, "pieces");
}

TEST(Passes, ItemsThatNoCoreClaimsEndTheList) {
  for (const Mode mode : kModes) {
    NumberPasses bench(4);
    std::vector<Pass> passes = bench.passes();
    passes[0].kernel = [](auto& core, std::span<std::byte>) {
      static_cast<void>(core.claim_item());
      return Status::kOk;
    };
    ChipOptions options;
    options.mode = mode;
    options.threads = 2;
    const PassesResult result = run_passes(bench.memory(), passes, options);
    EXPECT_EQ(result.status, Status::kIncompleteFrame);
    ASSERT_EQ(result.passes.size(), 1u);
    EXPECT_EQ(result.passes[0].result.failed_tile, 2u);
  }
}

TEST(Passes, LocalStoresDoNotOutliveTheirPass) {
  for (const Mode mode : kModes) {
    NumberPasses bench(4);
    const Pass pass = {.name = "remember",
                       .items = {3},
                       .data_bytes = 256,
                       .writable = {},
                       .kernel = [](auto& core, std::span<std::byte> data) {
                         if (data.size() != 256 || data[200] != std::byte{0}) return Status::kBadFrame;
                         data[200] = std::byte{1};
                         while (core.claim_item().kind == ItemClaim::Kind::kItem) {
                         }
                         return Status::kOk;
                       }};
    const Pass twice[] = {pass, pass};
    ChipOptions options;
    options.mode = mode;
    const PassesResult result = run_passes(bench.memory(), twice, options);
    EXPECT_EQ(result.status, Status::kOk) << words(result);
  }
}

TEST(Passes, EveryFailedTransferEndsTheListWithItsPass) {
  for (const Completion completion : kCompletions) {
    for (const std::uint32_t threads : {1u, 3u}) {
      NumberPasses bench(3);
      ChipOptions options;
      options.completion = completion;
      options.threads = threads;
      const PassesResult whole = run_passes(bench.memory(), bench.passes(), options);
      ASSERT_EQ(whole.status, Status::kOk) << words(whole);
      for (std::uint64_t transfer = 1; transfer <= whole.transfers + 1; ++transfer) {
        std::size_t failing = 0;
        for (std::uint64_t before = 0; failing < 3; ++failing) {
          before += whole.passes[failing].result.transfers;
          if (transfer <= before) break;
        }
        bench.clear_results();
        options.fail_transfer = transfer;
        const PassesResult result = run_passes(bench.memory(), bench.passes(), options);
        if (failing == 3) {
          EXPECT_EQ(result.status, Status::kOk) << "one after the last";
          bench.expect_done(3, "after all");
          continue;
        }
        EXPECT_EQ(result.status, Status::kTransferFailed) << transfer << ": " << words(result);
        ASSERT_EQ(result.passes.size(), failing + 1) << transfer;
        EXPECT_EQ(result.passes.back().result.status, Status::kTransferFailed);
        for (std::size_t later = failing + 1; later < 3; ++later) EXPECT_TRUE(bench.is_clear(later)) << transfer;
      }
    }
  }
}

/// Runs with a plan for one of the passes. @returns the result; `transfers` of that pass on core 0.
PassesResult run_with(NumberPasses& bench, Mode mode, std::uint32_t faulty_pass, const FaultPlan& plan,
                      std::uint64_t& transfers) {
  bench.clear_results();
  ChipOptions options;
  options.mode = mode;
  const auto wrap = [&](std::uint32_t pass, auto& core, auto kernel) {
    FaultInjection faulty(core, pass == faulty_pass ? plan : FaultPlan{});
    const Status status = kernel(faulty);
    if (pass == faulty_pass) transfers = faulty.transfers();
    return status;
  };
  return run_passes(bench.memory(), bench.passes(wrap), options);
}

TEST(Passes, EveryFaultOfEveryTransferIsTheStatusOfItsPass) {
  for (const Mode mode : kModes) {
    NumberPasses bench(3);
    for (std::uint32_t pass = 0; pass < 3; ++pass) {
      std::uint64_t count = 0, now = 0;
      ASSERT_EQ(run_with(bench, mode, pass, {}, count).status, Status::kOk);
      ASSERT_GT(count, 0u);
      for (std::uint64_t transfer = 1; transfer <= count; ++transfer) {
        for (const FaultPlan::Kind kind : {FaultPlan::Kind::kRefuse, FaultPlan::Kind::kReport}) {
          const FaultPlan plan = {.transfer = transfer, .kind = kind, .status = Status::kTransferTimedOut};
          const PassesResult result = run_with(bench, mode, pass, plan, now);
          EXPECT_EQ(result.status, Status::kTransferTimedOut);
          ASSERT_EQ(result.passes.size(), pass + 1);
          for (std::size_t later = pass + 1; later < 3; ++later) EXPECT_TRUE(bench.is_clear(later));
        }
        const FaultPlan delay = {.transfer = transfer, .kind = FaultPlan::Kind::kDelay};
        EXPECT_EQ(run_with(bench, mode, pass, delay, now).status, Status::kOk);
        bench.expect_done(3, "late");
      }
    }
  }
}

TEST(Passes, AbortAndDeadlineEndTheListBetweenItems) {
  for (const Mode mode : kModes) {
    NumberPasses bench(3);
    for (std::uint32_t pass = 0; pass < 3; ++pass) {
      for (const auto& [kind, status] : {std::pair(ItemClaim::Kind::kAborted, Status::kAborted),
                                         std::pair(ItemClaim::Kind::kDeadline, Status::kDeadline)}) {
        for (std::uint64_t claim = 1; claim <= bench.items()[pass] + 1; ++claim) {
          std::uint64_t now = 0;
          const PassesResult result = run_with(bench, mode, pass, {.claim = claim, .claim_answer = kind}, now);
          EXPECT_EQ(result.status, status);
          ASSERT_EQ(result.passes.size(), pass + 1);
        }
      }
      std::uint64_t now = 0;
      const FaultPlan never = {.claim = bench.items()[pass] + 2, .claim_answer = ItemClaim::Kind::kAborted};
      EXPECT_EQ(run_with(bench, mode, pass, never, now).status, Status::kOk);
    }
  }
}

TEST(Passes, TheCallersAbortEndsTheListInAnItemOrBetweenPasses) {
  for (const Mode mode : kModes) {
    for (const std::uint32_t threads : {1u, 2u}) {
      for (const std::uint32_t last : {0u, 1u, 5u}) {
        NumberPasses bench(6);
        std::atomic<bool> abort{false};
        std::atomic<std::uint32_t> done{0};
        const Pass pass = {
            .name = "stops",
            .items = {6},
            .data_bytes = 256,
            .writable = {},
            .kernel = items_kernel([&](auto&, std::span<std::byte>, std::uint32_t item) {
              ++done;
              if (item == last) abort = true;
              return Status::kOk;
            })};
        const Pass empty = {
            .name = "empty", .items = {0}, .data_bytes = 256, .writable = {}, .kernel = pass.kernel};
        const Pass list[] = {pass, empty, pass};
        ChipOptions options;
        options.mode = mode;
        options.threads = threads;
        options.abort = &abort;
        const PassesResult result = run_passes(bench.memory(), list, options);
        EXPECT_EQ(result.status, Status::kAborted);
        // All items may have been claimed before: but then the pass is not known to be done, or the next one sees it.
        EXPECT_LE(result.passes.size(), 2u);
        if (threads == 1) {
          EXPECT_EQ(done, last + 1);
        }
      }
    }
  }
}

TEST(Passes, AnAbortBetweenPassesIsSeenByTheMaster) {
  for (const Mode mode : kModes) {
    NumberPasses bench(3);
    std::vector<Pass> passes = bench.passes();
    passes[0].items = {0};  // no core that could claim
    const std::atomic<bool> abort{true};
    ChipOptions options;
    options.mode = mode;
    options.abort = &abort;
    const PassesResult result = run_passes(bench.memory(), passes, options);
    EXPECT_EQ(result.status, Status::kAborted);
    EXPECT_EQ(result.passes.size(), 1u);
  }
}

TEST(Passes, AShortageOfTheHostIsTold) {
  for (const Mode mode : kModes) {
    NumberPasses bench(3);
    std::vector<Pass> passes = bench.passes();
    passes[1].kernel = [](auto&, std::span<std::byte>) -> Status { throw std::bad_alloc(); };
    ChipOptions options;
    options.mode = mode;
    const PassesResult result = run_passes(bench.memory(), passes, options);
    EXPECT_EQ(result.status, Status::kAborted);
    EXPECT_EQ(result.host_shortage, HostShortage::kMemory);
    EXPECT_EQ(result.passes.size(), 2u);
  }
}

TEST(Passes, OptionsOfNoPossibleChipAreRefused) {
  for (const Mode mode : kModes) {
    NumberPasses bench(3);
    const std::vector<Pass> good = bench.passes();
    const auto expect_refused = [&](const std::vector<Pass>& passes, ChipOptions options) {
      options.mode = mode;
      const PassesResult result = run_passes(bench.memory(), passes, options);
      EXPECT_EQ(result.status, Status::kBadParameter);
      EXPECT_EQ(result.passes.size(), 1u);
      EXPECT_EQ(result.transfers, 0u);
    };
    ChipOptions options;
    options.threads = 0;
    expect_refused(good, options);
    options = {};
    const std::uint32_t first = 0;
    options.only_tiles = {&first, 1};
    expect_refused(good, options);
    options = {};
    options.limits.queue_depth = 0;
    expect_refused(good, options);
    options = {};
    options.spill = {bench.head().address.offset_by(16), 64};
    expect_refused(good, options);
    std::vector<Pass> wrong = good;
    wrong[0].data_bytes = 0;
    expect_refused(wrong, {});
    wrong[0].data_bytes = 256 * 1024 + 1;
    expect_refused(wrong, {});
    wrong = good;
    wrong[0].output_depth = 0;
    expect_refused(wrong, {});
  }
  NumberPasses bench(3);
  EXPECT_EQ(run_passes(bench.memory(), {}, {}).status, Status::kOk);
}

TEST(Passes, RandomCompletionDiffersFromPassToPass) {
  // Items of two passes with equal numbers would otherwise have their bytes moved at the same moments.
  NumberPasses bench(3);
  std::vector<std::string> moments(2);
  std::atomic<std::uint32_t> index{0};
  const MainAddress from = bench.doubled().address;
  const Pass pass = {.name = "random",
                     .items = {1},
                     .data_bytes = 8192,
                     .writable = {},
                     .kernel = items_kernel([&](auto& core, std::span<std::byte> data, std::uint32_t) -> Status {
                       std::string& seen = moments[index++];
                       for (std::uint32_t i = 0; i < 15; ++i) {
                         GRIDIRON_TRY(core.get(&data[i * 64], from, 64, Tag{1}));
                         for (std::uint32_t j = 0; j <= i; ++j) seen += data[j * 64] == std::byte{0} ? '1' : '0';
                       }
                       return core.wait(TagMask::of(Tag{1}));
                     })};
  const Pass twice[] = {pass, pass};
  ChipOptions options;
  options.completion = Completion::kRandom;
  const PassesResult result = run_passes(bench.memory(), twice, options);
  EXPECT_EQ(result.status, Status::kOk) << words(result);
  EXPECT_NE(moments[0], moments[1]);
}

}  // namespace
}  // namespace gridiron::sim
