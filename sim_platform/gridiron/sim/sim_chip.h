// The simulated chip: renders a frame with core's real code on host threads, checked or plain.
// Memory: owns local stores, borrows SimMemory. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/records.h>
#include <gridiron/platform/contract.h>
#include <gridiron/sim/sim_memory.h>
#include <gridiron/sim/trace.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace gridiron::sim {

/// When a transfer's bytes move.
enum class Completion : std::uint8_t {
  kEarly,   ///< at the call
  kLate,    ///< at the wait
  kRandom,  ///< at a seeded random call in between
};

/// The size of the cores' local stores.
enum class StoreSize : std::uint8_t {
  k16KB,   ///< 16,384 bytes of data; code has a memory of its own. Eye rays through the tree alone
  k64KB,   ///< 65,536 bytes
  k128KB,  ///< 131,072 bytes
  k256KB,  ///< 262,144 bytes
  k512KB,  ///< 524,288 bytes
};
/// Those of the experiments, which hold a grid too, the smallest first.
inline constexpr StoreSize kStoreSizes[] = {StoreSize::k64KB, StoreSize::k128KB, StoreSize::k256KB, StoreSize::k512KB};
/// All of them, the smallest first.
inline constexpr StoreSize kEveryStoreSize[] = {StoreSize::k16KB, StoreSize::k64KB, StoreSize::k128KB,
                                                StoreSize::k256KB, StoreSize::k512KB};

/// @returns bytes of a local store.
[[nodiscard]] constexpr std::uint32_t arena_bytes(StoreSize store) {
  if (store == StoreSize::k16KB) return 16u << 10;
  return (64u << 10) << (static_cast<std::uint32_t>(store) - static_cast<std::uint32_t>(StoreSize::k64KB));
}
/// Pixels along a tile's edge by default.
[[nodiscard]] constexpr std::uint32_t usual_tile_width(StoreSize store) {
  return store == StoreSize::k16KB ? 8 : store == StoreSize::k64KB ? 16 : 32;
}

/// The layout that a build of the kernel is for.
struct LayoutChoice {
  StoreSize store = StoreSize::k256KB;  ///< local memory
  std::uint32_t tile_width = 32;   ///< pixels along a tile's edge
  std::uint32_t packet_width = 8;  ///< rays along a packet's edge; 0: no packets, eye rays go through the tree
  bool has_effects = false;        ///< renders Shading::kScene
};

/// What is checked and traced while a frame is rendered.
enum class Mode : std::uint8_t {
  kChecked,       ///< every rule checked, destinations poisoned until the wait, work traced
  kPlain,         ///< plain copies: fast host rendering, no trace, no work totals
  kInstrumented,  ///< kChecked, and every load and store of the kernel checked too; 4 lanes, see has_instrumented_mode
};

/// Main memory in which cores store rays that wait (SpillRegion), a slice for each: core i's begins at address + i *
/// slice_bytes(). Only that core transfers bytes there, and a tile gets only what it has put.
struct SpillMemory {
  MainAddress address{};             ///< a multiple of kSpillAlignment
  std::uint64_t bytes_per_core = 0;  ///< at least spill_bytes() of the frame's scene; 0: there is none

  /// From one core's slice to the next: bytes_per_core in whole kSpillAlignment.
  [[nodiscard]] constexpr std::uint64_t slice_bytes() const {
    return (bytes_per_core / kSpillAlignment + (bytes_per_core % kSpillAlignment != 0 ? 1 : 0)) * kSpillAlignment;
  }
};

/// Options of a render. None of them changes a pixel.
struct ChipOptions {
  Mode mode = Mode::kChecked;  ///< what is checked
  std::uint32_t threads = 1;  ///< host threads, each one simulated core's worth of claims; fewer if the host has
                              ///< fewer, or the frame fewer tiles
  std::uint32_t lanes = 4;    ///< 1, 4, 8, 16 (8 and 16 where the host has them, else kUnsupportedFrame)
  StoreSize store = StoreSize::k256KB;  ///< local memory of each core
  std::uint32_t packet_width = 8;  ///< rays along a packet's edge, 0: none; the frame brings its tile width
  Completion completion = Completion::kEarly;  ///< of transfers
  std::uint64_t seed = 0;           ///< of Completion::kRandom
  PlatformLimits limits{};          ///< of the simulated platform
  SpillMemory spill{};              ///< one slice a thread; looked at for frames with effects only
  std::uint64_t fail_transfer = 0;  ///< n > 0: the n-th transfer started (over all threads) fails; checked modes only
  std::span<const std::uint32_t> only_tiles{};  ///< render these tiles alone: rising, borrowed; empty: all
  const std::atomic<bool>* abort = nullptr;                               ///< stop between tiles when it becomes true
  std::function<void(std::uint32_t done, std::uint32_t total)> progress{};  ///< called from any thread, serialised
};

/// A broken rule that the checks found.
struct Violation {
  Status rule;            ///< that names it
  std::uint32_t core;     ///< that broke it
  std::uint32_t tile_id;  ///< kNoTile before the first and after the last tile of a core
  std::string detail;     ///< addresses and sizes, for people
};

/// The host's shortage, if it could not finish a frame. The simulated machine has no part in it.
enum class HostShortage : std::uint8_t {
  kNone,
  kMemory,   ///< no memory for the checks, the trace or a local store
  kThreads,  ///< a thread could not be started, and the cores wait for one another
};

/// The result of a frame.
struct ChipResult {
  Status status = Status::kOk;  ///< of the frame
  HostShortage host_shortage = HostShortage::kNone;  ///< if any, status is kAborted and nothing else is reported
  std::uint32_t failed_core = 0, failed_tile = 0;  ///< meaningful when status is not kOk; lowest tile that failed
  std::vector<Violation> violations;  ///< of the failed tile
  WorkTotals work{};            ///< over all tiles; the same for any number of threads
  FrameTrace trace;             ///< Mode::kChecked only; of options.only_tiles, in their order
  std::uint64_t transfers = 0;  ///< gets + puts issued
};

/// Renders the frame whose FrameRecord lies at `frame` in `memory`. The output lies in `memory` afterwards.
///
/// Errors: kBadFrame (the record, or a part of memory that it names, does not exist), kUnsupportedFrame (is_built
/// rejects store, tile width, packet width, shading, mode and lanes, or this host cannot run it), kBadParameter (limits
/// of no possible platform, tiles outside of the frame or not rising, no threads, spill memory that is misaligned, not
/// allocated or part of the picture), kAborted (by the options, or by a shortage of the host, which the result names),
/// and the errors of the kernel or of a broken rule. If several tiles fail, the lowest is reported with its violations,
/// for any number of threads. An exception of options.progress leaves this call once all threads have ended.
[[nodiscard]] ChipResult render_frame(SimMemory& memory, MainAddress frame, const ChipOptions& options);

/// @returns the result of a frame that a shortage of the host has ended.
[[nodiscard]] ChipResult ended_by(HostShortage shortage);

/// @returns whether the kernel was built for a layout, a mode and a lane count, whatever this host can run. Stores of
/// 64 KB with tiles of 16 and of 256 KB with tiles of 32 pixels are built in every mode, the others in Mode::kChecked
/// with 4 lanes. With effects: 256 KB, tiles of 32 pixels, packets of 8 and 32 rays, and 64 KB; Mode::kPlain with every
/// lane count, other modes with 4 lanes. One lane: eye rays through the tree, not Mode::kInstrumented; their layout of
/// 64 KB has 1 and 4 lanes only.
[[nodiscard]] bool is_built(const LayoutChoice& layout, Mode mode, std::uint32_t lanes);

/// @returns the widest lane count this host can run: 4, 8 or 16.
[[nodiscard]] std::uint32_t widest_lanes();

/// @returns whether Mode::kInstrumented was built (GCC, no sanitizer of its own in the build).
[[nodiscard]] bool has_instrumented_mode();

}  // namespace gridiron::sim
