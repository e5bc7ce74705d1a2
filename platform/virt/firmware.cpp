// Master and workers of a frame. The build defines GRIDIRON_PACKET_WIDTH and GRIDIRON_EFFECTS, the layout of the image;
// GRIDIRON_FORGETFUL and GRIDIRON_TRESPASS make images that are wrong on purpose.
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
  const FirmwareFacts facts = firmware_facts<FirmwareLayout, FirmwareLanes>(
      "gridiron virt " GRIDIRON_IMAGE, kWorkerCount, address_of(job_end), kMostTiles);
#ifdef GRIDIRON_TRESPASS
  gridiron_shared.trespass = wanted_trespass(kTrespassCount);
#endif
  const auto& job = *reinterpret_cast<const FrameJob*>(job_begin);
  VirtMaster board;
  Master<VirtMaster> master(board, facts, job, gridiron_shared.control, gridiron_shared.tiles);
  exit_run(static_cast<std::uint32_t>(master.run("result.bin")));
}

void gridiron_worker(std::uint64_t core_index) {
  const auto core = static_cast<std::uint32_t>(core_index);
  SharedMemory& shared = gridiron_shared;
  FirmwareStore& store = arena_of(core).store;
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
#else
  run_worker<FirmwareLanes>(store, port, shared.control, shared.tiles, core, stack_of(core));
#endif
  finish();
}

}  // namespace gridiron::port
