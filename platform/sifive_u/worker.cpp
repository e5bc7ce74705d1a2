// Harts 1 to 4: each renders its share of a frame, in its arena, through its channel.
// Memory: the arena and shared memory; PMP blocks everything else. Threads: one hart each.
// SPDX-License-Identifier: Apache-2.0
#include "worker.h"

#include <cstddef>
#include <cstdint>

#include "desk_port.h"
#include "layout_256k.h"
#include "memory_map.h"
#include "pdma_board.h"
#include "shared_memory.h"
#include "wrong_ports.h"
#ifdef GRIDIRON_DYNAMIC
#include "build_scene.h"
#endif
#ifdef GRIDIRON_MOVING
#include "moving_frames.h"
#endif

namespace gridiron::port {

#ifdef GRIDIRON_COUNTED
/// Adds the number of instructions that the core has executed.
class CountedPort : public TemplatePort<PdmaBoard> {
 public:
  using TemplatePort<PdmaBoard>::TemplatePort;

  [[nodiscard]] std::uint64_t instructions() const {
    std::uint64_t count = 0;
    asm volatile("csrr %0, minstret" : "=r"(count));
    return count;
  }
};
static_assert(InstructionCounter<CountedPort>);
#endif

static_assert(FirmwareLayout::kArenaBytes == GRIDIRON_ARENA_BYTES);

#ifdef GRIDIRON_MOVING
using WorkerStore = MovingStore<FirmwareLayout>;
#else
using WorkerStore = FirmwareStore;
#endif

// The linker script adds these up.
alignas(128) [[gnu::section(".bss.arena_store"), gnu::used]] std::byte arena_store[sizeof(WorkerStore)];
[[gnu::section(".bss.arena_stack"), gnu::used]] std::byte arena_stack[FirmwareLayout::kStackBudgetBytes];

extern "C" {

void gridiron_worker(std::uint64_t core, std::uintptr_t arena);

/// Harts 1 to 4, from start.S, when they have been woken: by the master, or late for a transfer that they no longer
/// waited for.
void gridiron_worker(std::uint64_t core, std::uintptr_t arena) {
  const auto core_index = static_cast<std::uint32_t>(core);
  SharedMemory& shared = shared_memory;
  auto& store = *reinterpret_cast<WorkerStore*>(arena);
  const StackArea stack{arena + sizeof store, arena + GRIDIRON_ARENA_BYTES};
#ifdef GRIDIRON_DYNAMIC
  if (shared.must_build != 0) {
    paint_stack(stack);
    const Status built = build_wave_scene(scene_workshop(), shared.animation_frame);
    shared.control.cores[core_index].result.stack_bytes = used_stack_bytes(stack);
    __atomic_store_n(&shared.build_status, static_cast<std::uint32_t>(built), __ATOMIC_RELEASE);
    wake_hart(0);
    return;
  }
#endif
  if (state_of(shared.control.cores[core_index]) != CoreState::kStarted) return;
#ifdef GRIDIRON_TRESPASS
  trespass(core_index, arena);
#endif
#ifdef GRIDIRON_ASYNC
  DeskPort port(shared.control, shared.desks[core_index], core_index, &store, sizeof store);
#else
  PdmaBoard board(shared.control, core_index, &store, sizeof store);
#ifdef GRIDIRON_COUNTED
  CountedPort port(board);
#else
  TemplatePort<PdmaBoard> port(board);
#endif
#endif
#if defined(GRIDIRON_FORGETFUL)
  ForgetfulPort wrong(port);
  run_worker<FirmwareLanes>(store, wrong, shared.control, shared.tiles, core_index, stack);
#elif defined(GRIDIRON_MOVING)
  run_moving_worker<FirmwareLanes>(store, port, shared.control, shared.tiles, core_index, stack, shared.moving);
#else
  run_worker<FirmwareLanes>(store, port, shared.control, shared.tiles, core_index, stack);
#endif
  wake_hart(0);
}

}  // extern "C"

}  // namespace gridiron::port
