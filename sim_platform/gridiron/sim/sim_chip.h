// The simulated chip: renders a frame with core's real code on host threads, checked or plain.
// Memory: owns local stores, borrows SimMemory. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/platform/contract.h>
#include <gridiron/sim/sim_memory.h>
#include <gridiron/sim/trace.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace gridiron::sim {

/// When a transfer's bytes move.
enum class Completion : std::uint8_t {
  kEarly,   ///< at the call
  kLate,    ///< at the wait
  kRandom,  ///< at a seeded random call in between
};

/// Which of the compiled store layouts the cores have.
enum class StoreSize : std::uint8_t { k64KB, k256KB };

enum class Mode : std::uint8_t {
  kChecked,  ///< every rule checked, destinations poisoned until the wait, work traced
  kPlain,    ///< plain copies: fast host rendering, no trace
};

struct ChipOptions {
  Mode mode = Mode::kChecked;
  std::uint32_t threads = 1;       ///< host threads, each one simulated core's worth of claims
  std::uint32_t lanes = 4;         ///< 4, 8, 16 (8 and 16 where the host has them, else kUnsupportedFrame)
  StoreSize store = StoreSize::k256KB;
  std::uint32_t packet_width = 8;  ///< 4, 8, 16
  Completion completion = Completion::kEarly;
  std::uint64_t seed = 0;          ///< of Completion::kRandom
  PlatformLimits limits;           ///< of the simulated platform
  std::uint64_t fail_transfer = 0; ///< n > 0: the n-th transfer (over one thread) fails
  const std::atomic<bool>* abort = nullptr;             ///< stop between tiles when it becomes true
  std::function<void(std::uint32_t done, std::uint32_t total)> progress;  ///< called from any thread, serialised
};

/// A broken rule, found by the checks.
struct Violation {
  Status rule;
  std::uint32_t core;
  std::uint32_t tile_id;
  std::string detail;   ///< addresses and sizes, for people
};

struct ChipResult {
  Status status = Status::kOk;
  std::uint32_t failed_core = 0, failed_tile = 0;  ///< meaningful when status is not kOk
  std::vector<Violation> violations;
  WorkTotals work{};                 ///< over all tiles; the same for any number of threads
  FrameTrace trace;                  ///< Mode::kChecked only
  std::uint64_t transfers = 0;       ///< gets + puts issued
};

/// Renders the frame whose FrameRecord lies at `frame` in `memory`. The output lies in `memory` afterwards.
[[nodiscard]] ChipResult render_frame(SimMemory& memory, MainAddress frame, const ChipOptions& options);

/// @returns the widest lane count this host can run: 4, 8 or 16.
[[nodiscard]] std::uint32_t widest_lanes();

}  // namespace gridiron::sim
