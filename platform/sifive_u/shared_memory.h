// What the master and the workers of this board share: one region, the only main memory that workers can touch.
// Memory: GRIDIRON_SHARED. Threads: as run_control.h says. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/firmware/frame_job.h>

#include <bit>
#include <cstdint>

#include "memory_map.h"
#include "run_control.h"
#include "transfer_desk.h"

namespace gridiron::port {

inline constexpr std::uint32_t kMostTiles = 7000;

struct SharedMemory {
  RunControl control;
  TransferDesk desks[GRIDIRON_WORKERS];  ///< where the master moves the bytes
  std::uint64_t trespass;                ///< of the image that shows what a worker must not do: which of them it does
  std::uint32_t must_build;              ///< of the dynamic image: 1 where worker 0 is woken to build a scene
  std::uint32_t animation_frame;         ///< which
  std::uint32_t build_status;            ///< Status of it, or kNotRun while it goes on
  TileResult tiles[kMostTiles];
};
static_assert(sizeof(SharedMemory) <= GRIDIRON_SHARED_BYTES);
static_assert(GRIDIRON_WORKERS <= kMostBoardCores);

// What start.S opens by PMP; anything else would open more than was meant.
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

/// Sleeps until a software interrupt is pending, or the timer's where `with_timer` (hart 0's alone is ever set).
/// Neither is taken.
inline void sleep_hart(bool with_timer) {
  const std::uint64_t wanted = 1u << 3 | (with_timer ? 1u << 7 : 0u);
  asm volatile("csrw mie, %0\n wfi\n csrw mie, zero" ::"r"(wanted) : "memory");
}

/// Takes a hart's software interrupt back. What is looked at afterwards is as new as the interrupt or newer.
inline void hush_hart(std::uint32_t hart) {
  register_at(GRIDIRON_CLINT + 4 * std::uint64_t{hart}) = 0;
  asm volatile("fence" ::: "memory");
}

/// Sends a software interrupt.
inline void wake_hart(std::uint32_t hart) {
  // What was stored before is seen by the one who wakes.
  asm volatile("fence" ::: "memory");
  register_at(GRIDIRON_CLINT + 4 * std::uint64_t{hart}) = 1;
}

}  // namespace gridiron::port
