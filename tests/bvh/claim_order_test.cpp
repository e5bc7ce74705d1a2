// Clocks without contention against the replay, and the turns they decide. SPDX-License-Identifier: Apache-2.0
#include <gridiron/bvh/claim_order.h>
#include <gridiron/dma/tags.h>
#include <gridiron/sim/replay.h>

#include <thread>

#include "support/test_mesh.h"
#include "support/trace_steps.h"

namespace gridiron::bvh {
namespace {

// How a tile ends: it puts its pixels and waits for those of the tile before.
const sim::TraceEvent kPut{.kind = sim::EventKind::kPut, .rotating = true, .bytes = 4096, .address = 65536};
const sim::TraceEvent kWait{.kind = sim::EventKind::kWait, .rotating_tags = 2};

sim::TileTrace random_tile(std::uint32_t tile_id, test::TestRandom& random) {
  sim::TraceWriter writer;
  std::uint32_t pending = 0;
  for (std::uint32_t step = 0; step < 60; ++step) {
    sim::TraceEvent event{};
    sim::WorkAmount work[2];
    switch (random.below(4)) {
      case 0:
        event.kind = sim::EventKind::kWork;
        work[0] = {GridWork::kCellStep, random.below(40)};
        work[1] = {Work::kRayGenerated, random.below(20)};
        event.work = work;
        break;
      case 1:
      case 2: {
        const std::uint32_t tag = kFirstMacroTag + random.below(20);
        event.kind = sim::EventKind::kGet;
        event.tag = static_cast<std::uint8_t>(tag);
        event.bytes = 16 * (1 + random.below(200));
        event.address = 4096 + 16 * random.below(1000);
        pending |= 1u << tag;
        break;
      }
      default:
        event.kind = sim::EventKind::kWait;
        event.tags = pending & static_cast<std::uint32_t>(random.next());
        break;
    }
    writer.add(event);
  }
  writer.add(kPut);
  writer.add(kWait);
  return writer.finish(tile_id);
}

TEST(CoreClock, IsTheReplayOfOneCore) {
  for (const sim::MachineProfile& profile : sim::machine_profiles()) {
    for (const std::uint32_t queue_depth : {1u, 3u, 16u}) {
      sim::MachineProfile machine = profile;
      machine.queue_depth = queue_depth;
      machine.lines_in_flight = 5 * queue_depth;
      test::TestRandom random(queue_depth);
      sim::FrameTrace trace;
      trace.output_depth = 2;
      for (std::uint32_t tile = 0; tile < 12; ++tile) trace.tiles.push_back(random_tile(tile, random));
      CoreClock clock(machine, sim::kGridEngine, 2);
      clock.take_claim();
      for (std::uint32_t tile = 0; tile < 12; ++tile) {
        clock.take(trace.tiles[tile], tile);
        clock.take_claim();
      }
      const double cycles = static_cast<double>(clock.now()) / CoreClock::kTicksPerCycle;
      EXPECT_EQ(cycles, sim::replay(trace, machine, {.core_count = 1}).frame_cycles) << machine.name << queue_depth;
    }
  }
}

// Tiles of a put and a wait alone: nothing but the window of lines and the put two tiles ago holds the core.
TEST(CoreClock, WindowOfLinesAndRotatingTagsHoldTheCore) {
  for (const std::uint32_t lines_in_flight : {1u, 2u, 7u, 40u}) {
    sim::MachineProfile machine = *sim::find_machine_profile("cell-ps3");
    machine.lines_in_flight = lines_in_flight;
    machine.latency_cycles = 20000;
    sim::FrameTrace trace;
    trace.output_depth = 2;
    CoreClock clock(machine, sim::kGridEngine, 2);
    clock.take_claim();
    for (std::uint32_t tile = 0; tile < 6; ++tile) {
      const sim::TileTrace steps = test::packed_trace(tile, std::array{kPut, kWait});
      trace.tiles.push_back(steps);
      clock.take(steps, tile);
      clock.take_claim();
    }
    const double cycles = static_cast<double>(clock.now()) / CoreClock::kTicksPerCycle;
    EXPECT_EQ(cycles, sim::replay(trace, machine, {.core_count = 1}).frame_cycles) << lines_in_flight;
  }
}

TEST(ClaimOrder, TheLeastClockGoesFirstWhateverTheThreadsDo) {
  constexpr std::uint32_t kCores = 5;
  std::vector<std::uint32_t> expected;
  for (int round = 0; round < 20; ++round) {
    ClaimOrder order(kCores);
    std::vector<std::uint32_t> granted;
    std::vector<std::thread> threads;
    for (std::uint32_t core = 0; core < kCores; ++core) {
      threads.emplace_back([&, core] {
        // Core c takes 7 + 3 c of time for a tile; the order protects the list.
        CoreClock::Ticks now = 0;
        for (int tile = 0; tile < 8; ++tile, now += 7 + 3 * core) {
          order.wait_for_turn(core, now);
          granted.push_back(core);
        }
        order.leave(core);
      });
    }
    for (std::thread& thread : threads) thread.join();
    if (expected.empty()) {
      // By hand: the pairs (time, core) in rising order.
      std::vector<std::pair<CoreClock::Ticks, std::uint32_t>> claims;
      for (std::uint32_t core = 0; core < kCores; ++core) {
        for (std::uint32_t tile = 0; tile < 8; ++tile) claims.emplace_back(tile * (7 + 3 * core), core);
      }
      std::sort(claims.begin(), claims.end());
      for (const auto& claim : claims) expected.push_back(claim.second);
    }
    ASSERT_EQ(granted, expected) << "round " << round;
  }
}

}  // namespace
}  // namespace gridiron::bvh
