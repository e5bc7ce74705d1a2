// Runs one program on every core of a simulated chip, checked or plain: a pass. render_frame does so with the kernel.
// Memory: owns local stores, borrows SimMemory. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/plain_core.h>
#include <gridiron/sim/sim_chip.h>
#include <gridiron/sim/sim_core.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace gridiron::sim {

/// The parts of a frame, or of another pass, that do not depend on what the cores run. Its items are called tiles here.
struct FrameShape {
  /// @param of  the engine whose code the program is; it outlives what run_cores() returns.
  explicit FrameShape(const EngineWork& of) : engine(&of) {}

  const EngineWork* engine;
  std::uint32_t tile_count = 0;
  std::uint32_t output_depth = 1;
  std::uint32_t arena_bytes = 256 * 1024;  ///< local memory of a core
  std::uint32_t data_bytes = 256 * 1024;   ///< its first bytes, where data lies; the rest is code and stack
  std::vector<MainRange> writable;         ///< where puts may go; sorted, disjoint
  bool is_picture = false;                 ///< writable holds equal parts of all tiles; each must be claimed and put
  bool claims_all = false;                 ///< each tile must be claimed, or the frame is incomplete
  bool cores_meet = false;                 ///< cores wait for one another, so each needs a host thread of its own
};

/// The program of a core: from its first claim to its last wait. `data` is zeroed and kLineBytes-aligned.
using CoreProgram = std::function<Status(SimCore& core, std::span<std::byte> data)>;
/// The same for plain cores.
using PlainProgram = std::function<Status(PlainCore& core, std::span<std::byte> data)>;

/// Runs `program` on options.threads cores (options.mode, lanes, store and packet_width are ignored). The bytes around
/// a core's data carry a pattern that is checked at the end.
///
/// Errors: kBadParameter and kAborted as of render_frame; the program's, and those of the rules that it broke. A
/// program that throws std::bad_alloc ends the frame with HostShortage::kMemory; any other exception leaves this call
/// once all threads have ended.
///
/// Puts before a core's first tile or after its last belong to no tile. If two cores make such puts and overlap, this
/// is reported, but it depends on the caller whether there are two such cores.
[[nodiscard]] ChipResult run_cores(SimMemory& memory, const FrameShape& shape, const ChipOptions& options,
                                   const CoreProgram& program);

/// Runs `program` on options.threads plain cores: unchecked, without a trace or violations. Of the options it takes
/// threads, limits, spill, only_tiles, abort and progress, which the caller has checked.
///
/// Errors: the program's, of the lowest tile that failed; kAborted; kIncompleteFrame as shape.claims_all says; throws
/// shortages of the host, and what the program throws, once all threads have ended.
[[nodiscard]] ChipResult run_plain_cores(SimMemory& memory, const FrameShape& shape, const ChipOptions& options,
                                         const PlainProgram& program);

/// @returns whether there is no spill memory, or `cores` slices of it are aligned, allocated and apart from `writable`.
[[nodiscard]] bool is_spill_valid(SimMemory& memory, const SpillMemory& spill, std::uint32_t cores,
                                  std::span<const MainRange> writable);

/// @returns whether ChipOptions::only_tiles are rising, and of a frame with so many tiles.
[[nodiscard]] bool are_tiles_valid(std::span<const std::uint32_t> only_tiles, std::uint32_t tile_count);

/// @returns whether `limits` describe a possible platform: powers of two, and counts above zero.
[[nodiscard]] bool are_limits_valid(const PlatformLimits& limits);

}  // namespace gridiron::sim
