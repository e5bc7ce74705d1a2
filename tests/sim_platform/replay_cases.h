// Replay cases: machines that cost nothing but what a test sets, and traces written step by step.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/replay.h>
#include <gridiron/store/dma_tags.h>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace gridiron::sim {

inline constexpr std::uint8_t kTriangleTag = kFirstTriangleTag;
inline constexpr std::uint8_t kMacroTag = kFirstMacroTag;
inline constexpr std::size_t kTileLevel = static_cast<std::size_t>(WaitLevel::kTile);
inline constexpr std::size_t kMacroLevel = static_cast<std::size_t>(WaitLevel::kMacroCell);
inline constexpr std::size_t kTriangleLevel = static_cast<std::size_t>(WaitLevel::kTriangle);
inline constexpr std::size_t kSetupLevel = static_cast<std::size_t>(WaitLevel::kSetup);

/// A machine that costs nothing but what a test sets. One unit of work is one cycle, whatever the kind.
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
  explicit Steps(std::uint32_t tile_id = 0) { tile_.tile_id = tile_id; }

  Steps& work(std::uint32_t amount, Work kind = Work::kCellStep) {
    TraceEvent event = blank(EventKind::kWork);
    event.first_work = static_cast<std::uint32_t>(tile_.work.size());
    event.work_count = 1;
    tile_.work.push_back({kind, amount});
    tile_.events.push_back(event);
    return *this;
  }
  Steps& get(std::uint32_t bytes, std::uint8_t tag, std::uint64_t address = 4096) {
    return transfer(EventKind::kGet, bytes, tag, false, address);
  }
  Steps& put(std::uint32_t bytes, std::uint8_t tag, bool rotating = false) {
    return transfer(EventKind::kPut, bytes, tag, rotating, 8192);
  }
  Steps& wait(std::uint32_t tags, std::uint32_t rotating_tags = 0) {
    TraceEvent event = blank(EventKind::kWait);
    event.tags = tags;
    event.rotating_tags = rotating_tags;
    event.rotating = rotating_tags != 0;
    tile_.events.push_back(event);
    return *this;
  }
  Steps& stage(Stage stage) {
    TraceEvent event = blank(EventKind::kStage);
    event.stage = stage;
    tile_.events.push_back(event);
    return *this;
  }
  operator TileTrace() const { return tile_; }

 private:
  static TraceEvent blank(EventKind kind) {
    return {.kind = kind,
            .tag = 0,
            .rotating = false,
            .bytes = 0,
            .address = 0,
            .tags = 0,
            .rotating_tags = 0,
            .first_work = 0,
            .work_count = 0};
  }
  Steps& transfer(EventKind kind, std::uint32_t bytes, std::uint8_t tag, bool rotating, std::uint64_t address) {
    TraceEvent event = blank(kind);
    event.bytes = bytes;
    event.tag = tag;
    event.rotating = rotating;
    event.address = address;
    tile_.events.push_back(event);
    return *this;
  }
  TileTrace tile_;
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

inline double accounted_cycles(const CoreTiming& core) {
  double sum = core.init_cycles + core.compute_cycles + core.idle_cycles;
  for (const double wait : core.dma_wait_cycles) sum += wait;
  return sum;
}

}  // namespace gridiron::sim
