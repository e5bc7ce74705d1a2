// Worst of a view. SPDX-License-Identifier: Apache-2.0
#include "worst_of_view.h"

#include <gridiron/sim/trace_packing.h>

#include <algorithm>

namespace gridiron::tool {

WorstOfView find_worst_of_view(const sim::ViewFrame& frame, const sim::MachineProfile& machine) {
  const Stopwatch stopwatch;
  WorstOfView worst;
  worst.tiles_x = frame.head.tiles_x;
  worst.tile_width = frame.head.tile_width;
  sim::ViewBound view(frame);
  const std::uint32_t count = frame.head.tiles_x * frame.head.tiles_y;
  worst.tile_cycles.reserve(count);
  for (std::uint32_t tile = 0; tile < count; ++tile) {
    const TileBound bound = view.of(tile);
    const sim::TileCycles cycles = sim::view_tile_cycles(bound, machine, frame.head.output_depth);
    worst.tile_cycles.push_back(cycles.total());
    worst.most_gets = std::max(worst.most_gets, bound[Work::kGetIssue]);
    worst.most_get_bytes = std::max(worst.most_get_bytes, bound.get_bytes);
    if (tile != 0 && cycles.total() <= worst.cycles.total()) continue;
    worst.tile = tile;
    worst.bound = bound;
    worst.cycles = cycles;
  }
  worst.seconds = stopwatch.both();
  return worst;
}

WorstMeasured find_worst_measured(const sim::FrameTrace& trace, const sim::FrameTiming& timing) {
  WorstMeasured worst;
  for (const sim::TimelineSpan& span : timing.timeline) {
    const double cycles = span.end_cycles - span.begin_cycles;
    if (span.kind != sim::TimelineSpan::Kind::kTile || cycles <= worst.cycles) continue;
    worst.cycles = cycles;
    worst.tile = span.tile_id;
  }
  for (const sim::TileTrace& tile : trace.tiles) {
    std::uint64_t gets = 0, bytes = 0;
    sim::for_each_event(tile, [&](const sim::TraceEvent& event) {
      if (event.kind != sim::EventKind::kGet) return;
      ++gets;
      bytes += event.bytes;
    });
    worst.gets = std::max(worst.gets, gets);
    worst.get_bytes = std::max(worst.get_bytes, bytes);
  }
  return worst;
}

}  // namespace gridiron::tool
