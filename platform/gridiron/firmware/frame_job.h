// The input and output of a device that renders a frame: plain records in main memory, the same bytes on the host and
// on every board. `gridiron job` writes the input, a board's firmware the output.
// Memory: main memory; all addresses are absolute there. Threads: none. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/status.h>

#include <cstddef>
#include <cstdint>

namespace gridiron::port {

inline constexpr std::uint32_t kFrameJobMagic = 0x424F4A47;     // "GJOB"
inline constexpr std::uint32_t kFrameResultMagic = 0x53455247;  // "GRES"
inline constexpr std::uint32_t kFrameJobVersion = 2;

/// The most cores of a board that take part in a frame.
inline constexpr std::uint32_t kMostBoardCores = 16;
/// The most kinds of work that a result can hold; checked against core's kWorkKindCount where both are known.
inline constexpr std::uint32_t kMostWorkKinds = 104;

/// The job begins its file, which is loaded at base_address. Frame record and scene image follow in the file; the
/// memory for the result and for rays that wait comes after it. Memory that is not loaded need not be zero.
struct FrameJob {
  std::uint32_t magic;
  std::uint32_t version;
  std::uint64_t base_address;    ///< of this record; a multiple of 4,096
  std::uint64_t loaded_bytes;    ///< of the file, a multiple of 64
  std::uint64_t memory_bytes;    ///< from base_address on: the file, the result, rays that wait
  std::uint64_t frame_address;   ///< FrameRecord (core/gridiron/base/records.h), its addresses those of this job
  std::uint64_t image_address;   ///< the scene image
  std::uint64_t image_bytes;
  std::uint64_t result_address;  ///< FrameResult, then tile_count TileResults, then the planes
  std::uint64_t result_bytes;    ///< of all three; the device writes them out when the frame is done
  std::uint64_t color_address;   ///< planes, tile-major whole tiles, on kLineBytes; depth and ids 0 if not requested
  std::uint64_t depth_address;
  std::uint64_t ids_address;
  std::uint64_t plane_bytes;     ///< of each
  std::uint64_t spill_address;   ///< memory for rays that wait, 0: none (FrameControl); a multiple of 4,096
  std::uint64_t spill_bytes;     ///< of each core, one after the other; a multiple of 4,096
  std::uint32_t spill_cores;     ///< cores that there is such memory for
  std::uint32_t tile_count;
  std::uint32_t width, height;   ///< pixels
  std::uint32_t tile_width;      ///< pixels: a firmware with another tile width refuses the job
  std::uint32_t effects;         ///< EffectBits that the scene calls for, 0: no scene shading
  std::uint32_t packet_width;    ///< rays along a packet's edge that the buffers were chosen for, 0: none; work depends
                                 ///< on it, the picture does not
  std::uint32_t store_bytes;     ///< the arena that they were chosen for: 16, 64, 128, 256 or 512 KB
  std::uint64_t check_value;     ///< of the loaded bytes with this field taken as 0 (core/gridiron/base/check_value.h)
  std::uint32_t reserved[24];    ///< 0
};
static_assert(sizeof(FrameJob) == 256);

/// The work of one core.
struct CoreResult {
  std::uint32_t status;           ///< Status of render_tiles; kNotRun where the core never came back
  std::uint32_t tiles;            ///< claimed
  std::uint32_t stack_bytes;      ///< deepest stack by painting; 0: not measured
  std::uint32_t transfers;        ///< gets and puts; 0: not counted
  std::uint64_t instructions;     ///< of the frame, where the board counts them, else 0
  std::uint64_t transfer_bytes;   ///< 0: not counted
  std::uint32_t work[kMostWorkKinds];  ///< WorkCounters after the frame; 0 where there are fewer kinds
  std::uint32_t missing_effects;       ///< EffectBits, where the status is kMissingEffect; else 0
};
static_assert(sizeof(CoreResult) == 456);
inline constexpr std::uint32_t kNotRun = 0xFFFFFFFFu;

/// The work of one tile; results are in the order of tile ids.
struct TileResult {
  std::uint32_t core;          ///< that claimed it; kNotRun if none did
  std::uint32_t transfers;     ///< between this claim and the next; 0: not counted
  std::uint64_t instructions;  ///< from this claim to the next, where the board counts them, else 0
};
static_assert(sizeof(TileResult) == 16);

/// Written completely by the device, before the result_bytes from its address on are taken off the board.
struct FrameResult {
  std::uint32_t magic;
  std::uint32_t version;
  std::uint32_t core_count;  ///< cores that took part
  std::uint32_t status;      ///< of the frame: the first that is not kOk, cores in order
  std::uint32_t work_kinds;  ///< kWorkKindCount of the firmware's core
  std::uint32_t lane_count;  ///< rays of a group, as in the firmware's Lanes; 0 stands for 4
  std::uint32_t queue_depth; ///< of the port's limits; 0 stands for the default, 16
  std::uint32_t reserved[9];
  CoreResult cores[kMostBoardCores];  ///< all zero from core_count on
};
static_assert(sizeof(FrameResult) == 64 + kMostBoardCores * sizeof(CoreResult));

}  // namespace gridiron::port
