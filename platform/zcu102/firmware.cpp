// Core 0 is master and worker, cores 1 to 3 are workers. The build defines GRIDIRON_EFFECTS, the set of effects of the
// image (0: frames are rendered by packets, with GRIDIRON_PACKET_WIDTH=0 through the tree); GRIDIRON_FORGETFUL and
// GRIDIRON_TRESPASS make images that are wrong on purpose.
// Memory: arenas in on-chip memory, shared data in main memory. Threads: four cores.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/effect_records.h>
#include <gridiron/base/lanes.h>
#include <gridiron/firmware/frame_job.h>
#include <gridiron/store/local_store.h>

#include <cstddef>
#include <cstdint>

#include "cache.h"
#include "console.h"
#include "core_start.h"
#include "firmware_facts.h"
#include "gdma_board.h"
#include "job_check.h"
#include "master.h"
#include "memory_map.h"
#include "run_control.h"
#include "semihost.h"
#include "template_port.h"
#include "uart.h"
#include "worker.h"

#ifdef GRIDIRON_FORGETFUL
#include "forgetful_port.h"
#endif
#ifdef GRIDIRON_TRESPASS
#include "trespass.h"
#endif

extern "C" {
// address_space.cpp, start.S
std::uint64_t master_root();
std::uint64_t worker_root(std::uint32_t core);
void call_confined(void (*function)(std::uint64_t), std::uint64_t argument, std::uint64_t stack_top,
                   std::uint64_t inner_root, std::uint64_t outer_root);

// Called by start.S.
void master_entry();
void secondary_entry(std::uint32_t core);
}

namespace gridiron::port {
namespace {

#if GRIDIRON_EFFECTS == 0 && defined(GRIDIRON_PACKET_WIDTH) && GRIDIRON_PACKET_WIDTH == 0
using FirmwareLayout = TreeLayout64K;
#elif GRIDIRON_EFFECTS == 0
using FirmwareLayout = StoreLayout64K<8>;
#else
using FirmwareLayout = EffectLayout64K<GRIDIRON_EFFECTS>;
#endif
using FirmwareLanes = Lanes<4>;
using FirmwareStore = LocalStore<FirmwareLayout>;

// Budget of the kernel's stack, and of the board's own functions around it.
constexpr std::uint32_t kBoardStackBytes = 2048;
constexpr std::uint32_t kStackBytes = FirmwareLayout::kStackBudgetBytes + kBoardStackBytes;
constexpr std::uint32_t kMostTiles = 16384;

// A core's local memory. The stack is below the store and grows down: if it is too deep, it leaves the arena and
// faults.
struct alignas(4096) Arena {
  alignas(16) std::byte stack[kStackBytes];
  union {
    FirmwareStore store;  // memory as it comes up: its constructor is not run, and run_worker does not need it
  };

  Arena() {}

  [[nodiscard]] StackArea stack_area() const {
    const std::uintptr_t low = reinterpret_cast<std::uintptr_t>(stack);
    return {low, low + kStackBytes};
  }
};
static_assert(sizeof(Arena) <= kArenaBytes);

[[gnu::section(".arena0")]] Arena arena0;
[[gnu::section(".arena1")]] Arena arena1;
[[gnu::section(".arena2")]] Arena arena2;
[[gnu::section(".arena3")]] Arena arena3;
constexpr Arena* kArenas[kCoreCount] = {&arena0, &arena1, &arena2, &arena3};

RunControl control;
TileResult tiles[kMostTiles];
#ifdef GRIDIRON_TRESPASS
std::uint64_t trespass_kind;
#endif

// Core 0 prints the progress when it claims a tile; the master itself prints when core 0 has none left.
class TellingBoard : public GdmaBoard {
 public:
  TellingBoard(std::uint32_t core, Arena& arena)
      : GdmaBoard(*reinterpret_cast<volatile GdmaRegisters*>(
                      static_cast<std::uintptr_t>(kGdmaAddress + core * kGdmaChannelBytes)),
                  control, reinterpret_cast<std::uintptr_t>(&arena), sizeof arena),
        tells_(core == 0) {}

  [[nodiscard]] std::uint32_t next_tile() {
    const std::uint32_t tile = GdmaBoard::next_tile();
    const std::uint32_t eighth = tile * 8 / tile_count();
    if (tells_ && eighth != told_ && eighth < 8) print("tiles claimed: ", tile, " of ", tile_count(), "\n");
    told_ = eighth;
    return tile;
  }

 private:
  bool tells_;
  std::uint32_t told_ = 0;
};

// Runs on the core's own stack, with its own page tables.
void work(std::uint64_t core) {
  const auto index = static_cast<std::uint32_t>(core);
  Arena& arena = *kArenas[index];
  TellingBoard board(index, arena);
#ifdef GRIDIRON_TRESPASS
  const std::uint64_t kind = index == 1 ? trespass_kind : 0;
  trespass(kind);
#endif
  TemplatePort<TellingBoard> port(board);
#if defined(GRIDIRON_FORGETFUL)
  ForgetfulPort wrong(port);
  run_worker<FirmwareLanes>(arena.store, wrong, control, tiles, index, arena.stack_area());
#elif defined(GRIDIRON_TRESPASS)
  TrespassingPort wrong(port, kind);
  run_worker<FirmwareLanes>(arena.store, wrong, control, tiles, index, arena.stack_area());
#else
  run_worker<FirmwareLanes>(arena.store, port, control, tiles, index, arena.stack_area());
#endif
  asm volatile("sev");
}

class ZynqMaster {
 public:
  explicit ZynqMaster(const FrameJob& job) : job_(job) {}

  void start_core(std::uint32_t core) {
    if (core == 0) {
      // The DMA does not read caches: what a loader left there must be in memory before the first core runs.
      clean_and_invalidate(job_.base_address, job_.loaded_bytes);
      order_all();
    } else if (!port::start_core(core)) {
      print("core ", core, " was not started\n");
      exit_run(static_cast<std::uint32_t>(RunExit::kFrameFailed));
    }
  }
  void take_part() { call_confined(work, 0, arena0.stack_area().top, worker_root(0), master_root()); }
  void pause() { asm volatile("yield"); }
  [[nodiscard]] std::uint64_t milliseconds() {
    std::uint64_t count, frequency;
    asm volatile("isb\nmrs %0, cntvct_el0\nmrs %1, cntfrq_el0" : "=r"(count), "=r"(frequency));
    constexpr std::uint64_t kUsualFrequency = 100'000'000;  // where no loader has told it
    return count / ((frequency != 0 ? frequency : kUsualFrequency) / 1000);
  }
  // The planes came by DMA. This core has stored nothing there, so none of their lines is dirty.
  void take_results() { invalidate(job_.result_address, job_.result_bytes); }

 private:
  const FrameJob& job_;
};
static_assert(MasterBoard<ZynqMaster>);

}  // namespace
}  // namespace gridiron::port

// start.S puts the stacks of the cores here.
extern "C" {
extern const std::byte* const arena_stack_tops[gridiron::port::kCoreCount];
const std::byte* const arena_stack_tops[gridiron::port::kCoreCount] = {
    gridiron::port::arena0.stack + gridiron::port::kStackBytes,
    gridiron::port::arena1.stack + gridiron::port::kStackBytes,
    gridiron::port::arena2.stack + gridiron::port::kStackBytes,
    gridiron::port::arena3.stack + gridiron::port::kStackBytes,
};
}

void master_entry() {
  using namespace gridiron::port;
  begin_uart();
  const auto& job = *reinterpret_cast<const FrameJob*>(static_cast<std::uintptr_t>(kJobAddress));
  const FirmwareFacts facts = firmware_facts<FirmwareLayout, FirmwareLanes>(
      "gridiron zcu102 " GRIDIRON_IMAGE, kCoreCount, kMainMemoryEnd, kMostTiles, kBoardStackBytes);
#ifdef GRIDIRON_TRESPASS
  trespass_kind = wanted_trespass(kTrespassCount);
#endif
  ZynqMaster board(job);
  Master<ZynqMaster> master(board, facts, job, control, tiles);
  exit_run(static_cast<std::uint32_t>(master.run("result.bin")));
}

void secondary_entry(std::uint32_t core) { gridiron::port::work(core); }
