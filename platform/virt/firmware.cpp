// Master and workers of a frame. The build defines GRIDIRON_PACKET_WIDTH and GRIDIRON_EFFECTS, the layout of the image;
// GRIDIRON_MOVING makes the image of frames whose mesh moves, GRIDIRON_FORGETFUL and GRIDIRON_TRESPASS make images that
// are wrong on purpose.
// Memory: shared memory, arenas, the job's memory. Threads: all harts.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "board.h"
#include "engine.h"
#include "firmware_facts.h"
#include "forgetful_port.h"
#include "master.h"
#include "master_board.h"
#include "memory_map.h"
#include "trespass.h"
#include "worker.h"
#include "worker_arena.h"

namespace gridiron::port {

void gridiron_master() {
#ifdef GRIDIRON_MOVING
  constexpr std::uint64_t memory_end = kMovingFrames;
#else
  const std::uint64_t memory_end = address_of(job_end);
#endif
  const FirmwareFacts facts = firmware_facts<FirmwareLayout, FirmwareLanes>("gridiron virt " GRIDIRON_IMAGE,
                                                                            kWorkerCount, memory_end, kMostTiles);
#ifdef GRIDIRON_TRESPASS
  gridiron_shared.trespass = wanted_trespass(kTrespassCount);
#endif
  const auto& job = *reinterpret_cast<const FrameJob*>(job_begin);
  VirtMaster board;
  Master<VirtMaster> master(board, facts, job, gridiron_shared.control, gridiron_shared.tiles);
#ifdef GRIDIRON_MOVING
  exit_run(static_cast<std::uint32_t>(
      render_moving(board, master, facts, job, gridiron_shared.moving, kMovingFrames, address_of(job_end))));
#else
  exit_run(static_cast<std::uint32_t>(master.run("result.bin")));
#endif
}

// A worker's share, once the master has woken it.
static void work(std::uint32_t core) {
  SharedMemory& shared = gridiron_shared;
  WorkerStore& store = arena_of(core).store;
  VirtBoard board(shared.control, address_of(&store), sizeof store);
  TemplatePort<VirtBoard> port(board);
#if defined(GRIDIRON_FORGETFUL)
  ForgetfulPort wrong(port);
  run_worker<FirmwareLanes>(store, wrong, shared.control, shared.tiles, core, stack_of(core));
#elif defined(GRIDIRON_TRESPASS)
  const std::uint64_t kind = core == 1 ? shared.trespass : 0;
  trespass(kind);
  TrespassingPort wrong(port, kind);
  run_worker<FirmwareLanes>(store, wrong, shared.control, shared.tiles, core, stack_of(core));
#elif defined(GRIDIRON_MOVING)
  run_moving_worker<FirmwareLanes>(store, port, shared.control, shared.tiles, core, stack_of(core), shared.moving);
#else
  run_worker<FirmwareLanes>(store, port, shared.control, shared.tiles, core, stack_of(core));
#endif
}

void gridiron_worker(std::uint64_t core_index) {
  for (;;) {
    work(static_cast<std::uint32_t>(core_index));
    finish();
  }
}

}  // namespace gridiron::port
