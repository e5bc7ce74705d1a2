// Replay thread: a replay of one frame beside the threads that render it.
// Memory: traces that wait, up to twice kMostWaitingBytes and one more, as some are replayed meanwhile.
// Threads: one caller; starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/replay.h>

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace gridiron::tool {

/// As sim::FrameClock, on a thread of its own where that is asked for and the host has one more, else on the caller's.
class ReplayThread {
 public:
  ReplayThread(sim::FrameTrace frame, std::uint32_t tile_count, const sim::MachineProfile& machine,
               const sim::ReplayOptions& options, bool is_asked_for);
  ~ReplayThread();
  ReplayThread(const ReplayThread&) = delete;
  ReplayThread& operator=(const ReplayThread&) = delete;

  /// Waits while too much waits.
  void take(sim::TileTrace trace);
  /// Waits for the end of the replay. Called once. Errors: those of the replay.
  [[nodiscard]] sim::FrameTiming finish();

  static constexpr std::uint64_t kMostWaitingBytes = std::uint64_t{64} << 20;

 private:
  void run();
  void end();

  sim::FrameClock clock_;
  std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  std::vector<sim::TileTrace> waiting_;
  std::uint64_t waiting_bytes_ = 0;
  bool has_ended_ = false;
  std::exception_ptr error_;
  std::thread thread_;
};

}  // namespace gridiron::tool
