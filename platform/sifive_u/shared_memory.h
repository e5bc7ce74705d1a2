// Memory that the master and the workers of this board share: one region, the only main memory that workers can touch.
// Memory: GRIDIRON_SHARED. Threads: as run_control.h says. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/firmware/frame_job.h>

#include <bit>
#include <cstdint>

#include "clint.h"
#include "memory_map.h"
#include "moving_frame.h"
#include "run_control.h"
#include "transfer_desk.h"

namespace gridiron::port {

inline constexpr std::uint32_t kMostTiles = 7000;

struct SharedMemory {
  RunControl control;
  TransferDesk desks[GRIDIRON_WORKERS];  ///< where the master moves the bytes
  std::uint64_t trespass;                ///< which forbidden access the image for such accesses makes
  std::uint32_t must_build;              ///< of the dynamic image: 1 where worker 0 is woken to build a scene
  std::uint32_t animation_frame;         ///< which
  std::uint32_t build_status;            ///< Status of the build, or kNotRun while it runs
  MovingFrame moving;                    ///< of the moving image
  TileResult tiles[kMostTiles];
};
static_assert(sizeof(SharedMemory) <= GRIDIRON_SHARED_BYTES);
static_assert(GRIDIRON_WORKERS <= kMostBoardCores);
static_assert(GRIDIRON_CLINT == kClint);

// start.S opens such regions by PMP; any other region would open more than intended.
constexpr bool is_pmp_region(std::uint64_t address, std::uint64_t bytes) {
  return std::has_single_bit(bytes) && address % bytes == 0;
}
static_assert(is_pmp_region(GRIDIRON_LIM, GRIDIRON_ARENA_BYTES) && is_pmp_region(GRIDIRON_CODE, GRIDIRON_CODE_BYTES) &&
              is_pmp_region(GRIDIRON_SHARED, GRIDIRON_SHARED_BYTES) &&
              is_pmp_region(GRIDIRON_WORKSHOP, GRIDIRON_WORKSHOP_BYTES));

extern SharedMemory shared_memory;

/// A register of the chip.
inline volatile std::uint32_t& register_at(std::uint64_t address) {
  return *reinterpret_cast<volatile std::uint32_t*>(static_cast<std::uintptr_t>(address));
}
inline volatile std::uint64_t& wide_register_at(std::uint64_t address) {
  return *reinterpret_cast<volatile std::uint64_t*>(static_cast<std::uintptr_t>(address));
}

}  // namespace gridiron::port
