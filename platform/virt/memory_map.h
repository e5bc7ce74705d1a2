// Addresses of the board: main memory, the arenas that serve as local memory, shared memory, registers.
// Memory: virt.ld places the objects named here. Threads: none. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/firmware/frame_job.h>

#include <cstddef>
#include <cstdint>

#include "moving_frame.h"
#include "run_control.h"

namespace gridiron::port {

/// Hart 0 is the master, hart 1 + i is worker i.
inline constexpr std::uint32_t kWorkerCount = 6;

inline constexpr std::uintptr_t kFinisher = 0x00100000;  ///< ends the emulator; this firmware does so by semihosting
inline constexpr std::uintptr_t kUart = 0x10000000;

/// A worker's local memory: a power of two, and a multiple of it, for PMP.
inline constexpr std::size_t kArenaBytes = 0x40000;
struct alignas(kArenaBytes) Arena {
  std::byte bytes[kArenaBytes];
};

/// Where frames that move have memory of their own, to the end of the job's: their image's jobs end here.
inline constexpr std::uintptr_t kMovingFrames = 0x88000000;

/// Results of the contract checks on a worker.
struct ContractReport {
  std::uint32_t checks;
  std::uint32_t failures;
  const char* name;     ///< of the first that failed
  const char* failure;  ///< what did not hold there
};

/// Memory of master and workers: all that a worker may write besides its arena.
inline constexpr std::size_t kSharedBytes = 0x20000;
inline constexpr std::uint32_t kMostTiles = 7000;
struct alignas(kSharedBytes) SharedMemory {
  RunControl control;
  std::uint64_t trespass;                ///< which forbidden access the image for such accesses makes
  ContractReport reports[kWorkerCount];  ///< of the image of the contract checks
  MovingFrame moving;                    ///< of the image of frames that move
  TileResult tiles[kMostTiles];
};
static_assert(sizeof(SharedMemory) == kSharedBytes);

extern "C" {
extern Arena gridiron_arenas[kWorkerCount];
extern SharedMemory gridiron_shared;

// Symbols of virt.ld: where the code's region and the job's memory begin and end.
extern const std::byte code_begin[], code_end[], job_begin[], job_end[];
}

[[nodiscard]] inline std::uint64_t address_of(const void* place) {
  return reinterpret_cast<std::uintptr_t>(place);
}

}  // namespace gridiron::port
