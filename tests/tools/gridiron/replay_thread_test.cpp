// A replay on a thread of its own is the replay. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/trace_packing.h>

#include "gridiron/frame/replay_thread.h"
#include "support/test_headers.h"

namespace gridiron::tool {
namespace {

sim::FrameTrace make_frame(std::uint32_t tiles) {
  sim::FrameTrace frame;
  sim::TraceWriter writer;
  for (std::uint32_t tile = 0; tile < tiles; ++tile) {
    const sim::WorkAmount work{WorkId(0), 1 + tile * 7 % 50};
    for (int i = 0; i < 20; ++i) {
      writer.add({.kind = sim::EventKind::kGet, .tag = 3, .bytes = 256, .address = tile * 4096});
      writer.add({.kind = sim::EventKind::kWork, .work = {&work, 1}});
      writer.add({.kind = sim::EventKind::kWait, .tags = 1u << 3});
    }
    frame.tiles.push_back(writer.finish(tile));
  }
  return frame;
}

TEST(ReplayThread, GivesTheTimeOfTheReplay) {
  const sim::FrameTrace frame = make_frame(200);
  const sim::MachineProfile& machine = *sim::find_machine_profile("cell-ps3");
  const double expected = sim::replay(frame, machine, {.core_count = 3}).frame_cycles;
  for (const bool is_asked_for : {false, true}) {
    ReplayThread replay({}, 200, machine, {.core_count = 3}, is_asked_for);
    for (std::uint32_t i = 0; i < 200; ++i) replay.take(frame.tiles[(i + 5) % 200]);
    EXPECT_EQ(replay.finish().frame_cycles, expected) << is_asked_for;
  }
}

// As where rendering has failed: most traces never come.
TEST(ReplayThread, EndsWithoutTheOtherTraces) {
  const sim::FrameTrace frame = make_frame(10);
  for (const bool is_asked_for : {false, true}) {
    ReplayThread replay({}, 1000, *sim::find_machine_profile("cell-ps3"), {.core_count = 3}, is_asked_for);
    for (const sim::TileTrace& trace : frame.tiles) replay.take(trace);
  }
}

}  // namespace
}  // namespace gridiron::tool
