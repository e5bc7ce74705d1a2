// Replay cases: machines that cost nothing but what a test sets, and traces written step by step.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/dma/tags.h>
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/replay.h>
#include <gridiron/sim/trace_packing.h>

#include "support/test_headers.h"

namespace gridiron::sim {

inline constexpr std::uint8_t kTriangleTag = kFirstTriangleTag;
inline constexpr std::uint8_t kMacroTag = kFirstMacroTag;
inline constexpr std::size_t kTileLevel = static_cast<std::size_t>(WaitLevel::kTile);
inline constexpr std::size_t kMacroLevel = static_cast<std::size_t>(WaitLevel::kMacroCell);
inline constexpr std::size_t kTriangleLevel = static_cast<std::size_t>(WaitLevel::kTriangle);
inline constexpr std::size_t kSetupLevel = static_cast<std::size_t>(WaitLevel::kSetup);

/// A machine whose only costs are those that a test sets. One unit of work is one cycle, of every kind.
inline MachineProfile free_machine() {
  MachineProfile machine{};
  machine.name = "free";
  machine.core_count = 1;
  machine.clock_hz = 1e9;
  machine.line_bytes = 128;
  machine.queue_depth = 65536;
  machine.lines_in_flight = 65536;
  machine.work_cycles.fill(1);
  return machine;
}

/// What the published blocking-get bandwidths follow from: a latency after a channel of 8 bytes a cycle, no in-flight
/// limit, nothing for issue and wait.
inline MachineProfile blocking_machine(double latency_cycles) {
  MachineProfile machine = free_machine();
  machine.clock_hz = 3.2e9;
  machine.latency_cycles = latency_cycles;
  machine.channel_bytes_per_cycle = 8;
  return machine;
}

/// Writes a TileTrace step by step.
class Steps {
 public:
  explicit Steps(std::uint32_t tile_id = 0) : tile_id_(tile_id) {}

  Steps& work(std::uint32_t amount, WorkId kind = GridWork::kCellStep) {
    return add({.kind = EventKind::kWork}, {kind, amount});
  }
  Steps& get(std::uint32_t bytes, std::uint8_t tag, std::uint64_t address = 4096) {
    return transfer(EventKind::kGet, bytes, tag, false, address);
  }
  Steps& put(std::uint32_t bytes, std::uint8_t tag, bool rotating = false, std::uint64_t address = 8192) {
    return transfer(EventKind::kPut, bytes, tag, rotating, address);
  }
  Steps& wait(std::uint32_t tags, std::uint32_t rotating_tags = 0) {
    return add({.kind = EventKind::kWait, .tags = tags, .rotating_tags = rotating_tags});
  }
  Steps& stage(Stage stage) { return add({.kind = EventKind::kStage, .stage = stage}); }
  operator TileTrace() const {
    TraceWriter writer;
    for (const Step& step : steps_) {
      TraceEvent event = step.event;
      if (event.kind == EventKind::kWork) event.work = {&step.work, 1};
      writer.add(event);
    }
    return writer.finish(tile_id_);
  }

 private:
  struct Step {
    TraceEvent event;
    WorkAmount work;  ///< of kWork
  };
  Steps& add(const TraceEvent& event, WorkAmount work = {}) {
    steps_.push_back({event, work});
    return *this;
  }
  Steps& transfer(EventKind kind, std::uint32_t bytes, std::uint8_t tag, bool rotating, std::uint64_t address) {
    return add({.kind = kind, .tag = tag, .rotating = rotating, .bytes = bytes, .address = address});
  }

  std::uint32_t tile_id_;
  std::vector<Step> steps_;
};

inline std::uint32_t bit(std::uint32_t tag) {
  return 1u << tag;
}

inline FrameTrace frame_of(std::vector<TileTrace> tiles) {
  FrameTrace trace;
  trace.tiles = std::move(tiles);
  return trace;
}

inline FrameTiming replay_on(const FrameTrace& trace, const MachineProfile& machine, std::uint32_t cores = 1) {
  return replay(trace, machine, {.core_count = cores, .timeline = false});
}

/// What all cores together did.
inline CoreTiming sum_of(const std::vector<CoreTiming>& cores) {
  CoreTiming sum;
  for (const CoreTiming& core : cores) {
    sum.tiles += core.tiles;
    sum.init_cycles += core.init_cycles;
    sum.compute_cycles += core.compute_cycles;
    sum.gets += core.gets;
    sum.puts += core.puts;
    sum.bytes_in += core.bytes_in;
    sum.bytes_out += core.bytes_out;
  }
  return sum;
}

inline double accounted_cycles(const CoreTiming& core) {
  double sum = core.init_cycles + core.compute_cycles + core.idle_cycles;
  for (const double wait : core.dma_wait_cycles) sum += wait;
  return sum;
}

}  // namespace gridiron::sim
