// A worker's arena: its stack at the bottom, so that one that is too deep leaves the arena and traps, then its store.
// The build defines GRIDIRON_PACKET_WIDTH and GRIDIRON_EFFECTS, GRIDIRON_CONTRACT for the contract checks, and
// GRIDIRON_MOVING for frames of a mesh that moves.
// Memory: gridiron_arenas. Threads: each worker its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "layout_256k.h"
#include "memory_map.h"
#include "stack_paint.h"
#ifdef GRIDIRON_MOVING
#include "moving_frames.h"
#endif

namespace gridiron::port {

/// Main memory that a worker may also touch directly, from the job's address on, one window after the other: only in
/// the image of the contract checks, which inspect the result of transfers.
inline constexpr std::uint64_t kWindowBytes = 0x10000;
#ifdef GRIDIRON_CONTRACT
inline constexpr bool kHasWindow = true;
#else
inline constexpr bool kHasWindow = false;
#endif

/// The layout's budget, which includes run_worker and the port.
inline constexpr std::size_t kWorkerStackBytes = FirmwareLayout::kStackBudgetBytes;
static_assert(kWorkerStackBytes % 128 == 0, "the store begins on 128 bytes");

#ifdef GRIDIRON_MOVING
using WorkerStore = MovingStore<FirmwareLayout>;
#else
using WorkerStore = FirmwareStore;
#endif

struct WorkerArena {
  std::byte stack[kWorkerStackBytes];
  WorkerStore store;
};
static_assert(sizeof(WorkerArena) <= kArenaBytes);

[[nodiscard]] inline WorkerArena& arena_of(std::uint32_t core) {
  return *reinterpret_cast<WorkerArena*>(&gridiron_arenas[core]);
}

[[nodiscard]] inline StackArea stack_of(std::uint32_t core) {
  const auto low = reinterpret_cast<std::uintptr_t>(&gridiron_arenas[core]);
  return {low, low + kWorkerStackBytes};
}

}  // namespace gridiron::port
