// Traces written and read as lists of steps, for tests that look at single ones.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/trace_packing.h>

#include "support/test_headers.h"

namespace gridiron::test {

/// @returns whether two steps say the same.
[[nodiscard]] inline bool is_same_step(const sim::TraceEvent& a, const sim::TraceEvent& b) {
  return a.kind == b.kind && a.tag == b.tag && a.rotating == b.rotating && a.stage == b.stage && a.bytes == b.bytes &&
         a.address == b.address && a.tags == b.tags && a.rotating_tags == b.rotating_tags &&
         std::equal(a.work.begin(), a.work.end(), b.work.begin(), b.work.end());
}

/// The steps of a tile, all at once.
class UnpackedTrace {
 public:
  explicit UnpackedTrace(const sim::TileTrace& trace) : tile_id(trace.tile_id) {
    std::vector<std::size_t> first_work;
    sim::for_each_event(trace, [&](const sim::TraceEvent& event) {
      events.push_back(event);
      first_work.push_back(work_.size());
      work_.insert(work_.end(), event.work.begin(), event.work.end());
    });
    for (std::size_t i = 0; i < events.size(); ++i) {
      events[i].work = std::span(work_).subspan(first_work[i], events[i].work.size());
    }
  }
  UnpackedTrace(const UnpackedTrace&) = delete;
  UnpackedTrace& operator=(const UnpackedTrace&) = delete;

  std::uint32_t tile_id;
  std::vector<sim::TraceEvent> events;

 private:
  std::vector<sim::WorkAmount> work_;
};

[[nodiscard]] inline sim::TileTrace packed_trace(std::uint32_t tile_id, std::span<const sim::TraceEvent> events) {
  sim::TraceWriter writer;
  for (const sim::TraceEvent& event : events) writer.add(event);
  return writer.finish(tile_id);
}

}  // namespace gridiron::test
