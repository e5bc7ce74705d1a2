// Replay of tiles that are fixed to cores. SPDX-License-Identifier: Apache-2.0
#include "replay_cases.h"

namespace gridiron::sim {
namespace {

/// Two cores; a claim takes 10 cycles.
MachineProfile claim_machine() {
  MachineProfile machine = free_machine();
  machine.core_count = 2;
  machine.claim_cycles = 10;
  return machine;
}

FrameTrace frame_of_cycles(const std::vector<std::uint32_t>& tile_cycles) {
  std::vector<TileTrace> tiles;
  for (const std::uint32_t cycles : tile_cycles) {
    tiles.push_back(Steps(static_cast<std::uint32_t>(tiles.size())).work(cycles));
  }
  return frame_of(tiles);
}

TEST(FixedTiles, EachCoreRendersItsOwnInOrder) {
  const FrameTrace trace = frame_of_cycles({100, 20, 30, 400, 50});
  const std::vector<std::uint32_t> core_of_tile = {1, 0, 1, 1, 0};
  const FrameTiming frame =
      replay(trace, claim_machine(), {.core_count = 2, .timeline = true, .core_of_tile = core_of_tile});
  ASSERT_EQ(frame.cores.size(), 2u);
  EXPECT_EQ(frame.cores[0].tiles, 2u);
  EXPECT_EQ(frame.cores[1].tiles, 3u);
  EXPECT_EQ(frame.cores[0].compute_cycles, 70);
  EXPECT_EQ(frame.cores[1].compute_cycles, 530);
  EXPECT_EQ(frame.frame_cycles, 530 + 4 * 10);
  std::vector<std::uint32_t> tiles[2];
  for (const TimelineSpan& span : frame.timeline) {
    if (span.kind == TimelineSpan::Kind::kTile) tiles[span.core].push_back(span.tile_id);
  }
  EXPECT_EQ(tiles[0], (std::vector<std::uint32_t>{1, 4}));
  EXPECT_EQ(tiles[1], (std::vector<std::uint32_t>{0, 2, 3}));
}

TEST(FixedTiles, TheOrderOfClaimsIsTheOneWithoutThem) {
  const std::vector<std::uint32_t> cycles = {100, 20, 30, 400, 50, 70, 5, 5, 300};
  const FrameTrace trace = frame_of_cycles(cycles);
  const FrameTiming claimed = replay(trace, claim_machine(), {.timeline = true});
  std::vector<std::uint32_t> core_of_tile(cycles.size());
  for (const TimelineSpan& span : claimed.timeline) core_of_tile[span.tile_id] = span.core;
  const FrameTiming fixed = replay(trace, claim_machine(), {.core_of_tile = core_of_tile});
  EXPECT_EQ(fixed.frame_cycles, claimed.frame_cycles);
  for (std::size_t core = 0; core < 2; ++core) EXPECT_EQ(fixed.cores[core].tiles, claimed.cores[core].tiles);
}

TEST(FixedTiles, TilesOfNobodyAreNotRendered) {
  const FrameTrace trace = frame_of_cycles({100, 20, 30});
  const std::vector<std::uint32_t> core_of_tile = {0, 7};
  const FrameTiming frame = replay(trace, claim_machine(), {.core_of_tile = core_of_tile});
  EXPECT_EQ(frame.cores[0].tiles, 1u);
  EXPECT_EQ(frame.cores[1].tiles, 0u);
  EXPECT_EQ(frame.frame_cycles, 100 + 2 * 10);
}

}  // namespace
}  // namespace gridiron::sim
