// Checks whether a firmware can run a job, and prints the reason on the console if not.
// Memory: reads the job. Threads: the master. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/firmware/frame_job.h>

#include <cstdint>

namespace gridiron::port {

/// The properties of a firmware and its board.
struct FirmwareFacts {
  const char* name;             ///< of board and image, for the console
  std::uint64_t memory_end;     ///< first address behind main memory
  std::uint32_t core_count;     ///< workers
  std::uint32_t tile_width;     ///< of the layout
  std::uint32_t effects;        ///< EffectBits built
  std::uint32_t packet_width;   ///< of the layout, 0: no packets
  std::uint32_t engine;         ///< EngineId: what traces eye rays
  std::uint32_t store_bytes;    ///< of a worker's arena
  std::uint32_t stack_bytes;    ///< the most that a worker's stack may take
  std::uint32_t lane_count;
  std::uint32_t queue_depth;    ///< of the port's limits
  std::uint32_t work_kinds;     ///< kWorkKindCount
  std::uint32_t most_tiles;     ///< the most tiles whose results fit the board's memory; a frame never has more
};

/// Checks a job against the firmware: magic, version, place, size, check value, tiles, effects, engine, arena, and that
/// every range lies inside its memory.
/// @returns whether it may run; if not, a line on the console gives the reason. A job for packets of another width may
/// run, with a note, since its work differs from that of the job's own layout.
[[nodiscard]] bool check_job(const FrameJob& job, const FirmwareFacts& facts);

/// TileResults of a job, after its FrameResult.
[[nodiscard]] inline TileResult* tile_results(const FrameJob& job) {
  return reinterpret_cast<TileResult*>(static_cast<std::uintptr_t>(job.result_address) + sizeof(FrameResult));
}

}  // namespace gridiron::port
