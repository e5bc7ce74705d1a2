// Whether a firmware can do a job that it was given, said in words on the console.
// Memory: reads the job. Threads: the master. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/firmware/frame_job.h>

#include <cstdint>

namespace gridiron::port {

/// What a firmware is, and what its board has.
struct FirmwareFacts {
  const char* name;             ///< of board and image, for the console
  std::uint64_t memory_end;     ///< first address behind main memory
  std::uint32_t core_count;     ///< workers
  std::uint32_t tile_width;     ///< of the layout
  std::uint32_t effects;        ///< EffectBits built
  std::uint32_t packet_width;   ///< of the layout, 0: no packets
  std::uint32_t store_bytes;    ///< of a worker's arena
  std::uint32_t stack_bytes;    ///< that a worker's stack may take
  std::uint32_t lane_count;
  std::uint32_t queue_depth;    ///< of the port's limits
  std::uint32_t work_kinds;     ///< kWorkKindCount
  std::uint32_t most_tiles;     ///< that the board has room for results of; never more than that in a frame
};

/// Holds a job against the firmware: magic, version, place, size, check value, tiles, effects, arena, every range
/// inside its memory.
/// @returns whether it may run; if not, a line on the console says why. A job for packets of another width runs, and is
/// remarked on: the work is not that of the job's own layout.
[[nodiscard]] bool check_job(const FrameJob& job, const FirmwareFacts& facts);

/// TileResults of a job, behind its FrameResult.
[[nodiscard]] inline TileResult* tile_results(const FrameJob& job) {
  return reinterpret_cast<TileResult*>(static_cast<std::uintptr_t>(job.result_address) + sizeof(FrameResult));
}

}  // namespace gridiron::port
