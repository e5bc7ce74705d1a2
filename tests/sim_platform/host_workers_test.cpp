// Host workers: threads that cannot be started, workers that throw, and what a frame makes of both.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/host_workers.h>

#include <atomic>
#include <new>
#include <stdexcept>
#include <system_error>

#include "program_bench.h"
#include "support/no_threads.h"
#include "support/sanitizers.h"

namespace gridiron::sim {
namespace {

constexpr std::uint32_t kWorkers = 5;

/// Starts `limit` threads; after that the host has no more.
StartThread start_at_most(std::uint32_t limit) {
  return [limit, started = 0u](std::function<void()> run) mutable {
    if (started++ >= limit) throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
    return std::thread(std::move(run));
  };
}

void do_nothing() {}

TEST(HostWorkers, EachRunsOnce) {
  for (const std::uint32_t count : {0u, 1u, 2u, kWorkers}) {
    std::vector<std::atomic<int>> runs(count);
    const WorkersEnd end = run_workers(
        count, 0, [&](std::uint32_t i) { ++runs[i]; }, do_nothing);
    EXPECT_EQ(end.started, count);
    EXPECT_EQ(end.error, nullptr);
    for (const std::atomic<int>& run : runs) EXPECT_EQ(run, 1);
  }
}

TEST(HostWorkers, AThreadThatCannotBeStartedIsLeftOutWithThoseAfterIt) {
  for (std::uint32_t limit = 0; limit < kWorkers; ++limit) {
    std::vector<std::atomic<int>> runs(kWorkers);
    const WorkersEnd end = run_workers(
        kWorkers, 1, [&](std::uint32_t i) { ++runs[i]; }, do_nothing, start_at_most(limit));
    EXPECT_EQ(end.started, limit + 1);
    EXPECT_EQ(end.error, nullptr);
    for (std::uint32_t i = 0; i < kWorkers; ++i) EXPECT_EQ(runs[i], i <= limit ? 1 : 0) << i;
  }
}

TEST(HostWorkers, FewerThanMustRunDoNoWork) {
  for (std::uint32_t limit = 0; limit + 1 < kWorkers; ++limit) {
    std::atomic<int> runs = 0;
    const WorkersEnd end = run_workers(
        kWorkers, kWorkers, [&](std::uint32_t) { ++runs; }, do_nothing, start_at_most(limit));
    EXPECT_EQ(end.started, 0u);
    EXPECT_EQ(runs, 0);
  }
}

TEST(HostWorkers, OfExceptionsTheLowestWorkersIsKeptAndEachStops) {
  for (std::uint32_t first = 0; first < kWorkers; ++first) {
    std::atomic<int> stops = 0;
    const WorkersEnd end = run_workers(
        kWorkers, 1,
        [&](std::uint32_t i) {
          if (i >= first) throw std::runtime_error(std::to_string(i));
        },
        [&] { ++stops; });
    EXPECT_EQ(stops, static_cast<int>(kWorkers - first));
    try {
      std::rethrow_exception(end.error);
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), std::to_string(first));
    }
  }
}

// --- Frames -----------------------------------------------------------------------------------------------------

/// Claims tiles until there are none.
Status claim_all(SimCore& core) {
  return for_each_tile(core, [](std::uint32_t) { return Status::kOk; });
}

TEST(HostWorkers, ACoreWithoutMemoryEndsTheFrameWithAStatus) {
  for (std::uint32_t core_without = 0; core_without < kWorkers; ++core_without) {
    ProgramBench bench;
    bench.options.threads = kWorkers;
    std::atomic<std::uint32_t> begun = 0, stopped = 0;
    const ChipResult result = bench.run([&](SimCore& core, std::span<std::byte>) {
      if (begun++ == core_without) throw std::bad_alloc();
      // This ends only if the others are told to stop.
      while (core.claim_item().kind != ItemClaim::Kind::kAborted) std::this_thread::yield();
      ++stopped;
      return Status::kAborted;
    });
    EXPECT_EQ(result.status, Status::kAborted) << words(result);
    EXPECT_EQ(result.host_shortage, HostShortage::kMemory);
    EXPECT_TRUE(result.violations.empty());
    EXPECT_EQ(begun, kWorkers);
    EXPECT_EQ(stopped, kWorkers - 1) << "a thread has not ended";
  }
}

TEST(HostWorkers, OtherExceptionsOfACoreReachTheCaller) {
  for (const std::uint32_t threads : {1u, 3u}) {
    ProgramBench bench;
    bench.options.threads = threads;
    EXPECT_THROW(static_cast<void>(bench.run([](SimCore&, std::span<std::byte>) -> Status {
                   throw std::runtime_error("a defect of the program");
                 })),
                 std::runtime_error);
  }
}

TEST(HostWorkers, WhatAProgressCallThrowsReachesTheCaller) {
  for (const std::uint32_t threads : {1u, 3u}) {
    ProgramBench bench;
    bench.options.threads = threads;
    bench.shape.tile_count = 1'000;
    bench.options.progress = [](std::uint32_t done, std::uint32_t) {
      if (done >= 3) throw std::runtime_error("the line is cut");
    };
    EXPECT_THROW(static_cast<void>(bench.run([](SimCore& core, std::span<std::byte>) { return claim_all(core); })),
                 std::runtime_error);
  }
}

TEST(HostWorkers, AHostWithoutThreadsRendersOnTheCallersAlone) {
  for (const bool cores_meet : {false, true}) {
    ProgramBench bench;
    bench.options.threads = 3;
    bench.shape.tile_count = 7;
    bench.shape.cores_meet = cores_meet;
    const test::NoThreads no_threads;
    EXPECT_THROW(std::thread(do_nothing).join(), std::system_error);
    const ChipResult result = bench.run([](SimCore& core, std::span<std::byte>) { return claim_all(core); });
    EXPECT_EQ(result.status, cores_meet ? Status::kAborted : Status::kOk) << words(result);
    EXPECT_EQ(result.host_shortage, cores_meet ? HostShortage::kThreads : HostShortage::kNone);
    EXPECT_EQ(result.trace.tiles.size(), cores_meet ? 0u : 7u);
  }
}

#if !defined(GRIDIRON_TEST_SANITIZED)  // they end the program where an allocation fails
TEST(HostWorkers, MoreCoresThanTheHostHasMemoryForAreAStatus) {
  ProgramBench bench;
  bench.options.threads = 0x7FFFFFFF;
  bench.shape.arena_bytes = 0x7FFFFFFF;
  const ChipResult result = bench.run([](SimCore& core, std::span<std::byte>) { return claim_all(core); });
  EXPECT_EQ(result.status, Status::kAborted);
  EXPECT_EQ(result.host_shortage, HostShortage::kMemory);
}
#endif

}  // namespace
}  // namespace gridiron::sim
