// Replay: gives a frame's trace a time on a machine. Single-threaded, deterministic to the last digit.
// Memory: std::vector. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/trace.h>

#include <cstdint>
#include <string>
#include <vector>

namespace gridiron::sim {

/// Levels at which a core waits for transfers (paper, Fig. 4), and the frame's own set-up.
enum class WaitLevel : std::uint8_t { kTile, kMacroCell, kTriangle, kSetup, kCount };
inline constexpr std::size_t kWaitLevelCount = static_cast<std::size_t>(WaitLevel::kCount);

/// Where one core's cycles went: init + compute + sum of waits + idle = frame cycles.
struct CoreTiming {
  std::uint32_t tiles = 0;
  double init_cycles = 0;
  double compute_cycles = 0;
  double dma_wait_cycles[kWaitLevelCount] = {};
  double idle_cycles = 0;                ///< claim latency and the time after the last tile
  std::uint64_t gets = 0, puts = 0;
  std::uint64_t bytes_in = 0, bytes_out = 0;           ///< as requested
  std::uint64_t line_bytes_in = 0, line_bytes_out = 0; ///< in whole lines
};

/// One bar of the timeline.
struct TimelineSpan {
  enum class Kind : std::uint8_t { kInit, kCompute, kWait, kTile };
  std::uint32_t core;
  Kind kind;
  WaitLevel level;        ///< kWait only
  std::uint32_t tile_id;
  double begin_cycles, end_cycles;
};

struct FrameTiming {
  double frame_cycles = 0;
  double seconds = 0;
  std::vector<CoreTiming> cores;
  std::vector<TimelineSpan> timeline;    ///< filled only when asked for
};

struct ReplayOptions {
  std::uint32_t core_count = 0;          ///< 0: the profile's
  bool timeline = false;
};

[[nodiscard]] FrameTiming replay(const FrameTrace& trace, const MachineProfile& machine, const ReplayOptions& options);

}  // namespace gridiron::sim
