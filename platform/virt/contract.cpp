// The contract checks on the board: on all workers at the same time, each with its arena and 64 KB of main memory in
// place of a job. In this image alone PMP lets a worker read them directly.
// Memory: arenas, 384 KB of main memory. Threads: all harts. SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "board.h"
#include "contract_checks.h"
#include "engine.h"
#include "master_board.h"
#include "memory_map.h"
#include "worker_arena.h"

namespace gridiron::port {

namespace {

static_assert(kWindowBytes == contract::kMainBytes);

/// Memory above a worker's stack.
struct ContractArena {
  std::byte stack[kWorkerStackBytes];
  alignas(128) std::byte local[contract::kLocalBytes];
  RunControl control;
};
static_assert(sizeof(ContractArena) <= kArenaBytes);

class BoardBench {
 public:
  using PlatformType = TemplatePort<VirtBoard>;
  static constexpr bool kChecksRules = true;
  static constexpr bool kChecksQueue = true;
  static constexpr bool kChecksOverlap = false;

  explicit BoardBench(std::uint32_t core)
      : arena_(*reinterpret_cast<ContractArena*>(&gridiron_arenas[core])),
        main_(address_of(job_begin) + core * kWindowBytes),
        board_(arena_.control, address_of(arena_.local), sizeof arena_.local),
        port_(board_) {
    arena_.control.next_tile = 0;
    arena_.control.tile_count = contract::kItemCount;
    arena_.control.stop = 0;
  }
  PlatformType& platform() { return port_; }
  std::byte* local() { return arena_.local; }
  MainAddress main() { return {main_}; }
  void poke(std::uint32_t offset, std::byte value) { *main_memory(offset) = value; }
  std::byte peek(std::uint32_t offset) { return *main_memory(offset); }

 private:
  [[nodiscard]] volatile std::byte* main_memory(std::uint32_t offset) const {
    return reinterpret_cast<volatile std::byte*>(static_cast<std::uintptr_t>(main_)) + offset;
  }

  ContractArena& arena_;
  std::uint64_t main_;
  VirtBoard board_;
  PlatformType port_;
};

}  // namespace

void gridiron_master() {
  VirtMaster board;
  SharedMemory& shared = gridiron_shared;
  std::memset(&shared, 0, sizeof shared);
  for (std::uint32_t core = 0; core < kWorkerCount; ++core) board.start_core(core);

  constexpr std::uint64_t kMostMilliseconds = 120'000;
  const std::uint64_t begin = board.milliseconds();
  std::uint32_t checks = 0, failures = 0;
  for (std::uint32_t core = 0; core < kWorkerCount; ++core) {
    CoreSlot& slot = shared.control.cores[core];
    while (state_of(slot) != CoreState::kFinished) {
      if (state_of(slot) == CoreState::kTrapped || board.milliseconds() - begin > kMostMilliseconds) {
        print("contract: core ", core, " stopped, cause ", Hex{slot.trap.cause}, " address ", Hex{slot.trap.address},
              " pc ", Hex{slot.trap.pc}, "\n");
        exit_run(static_cast<std::uint32_t>(RunExit::kTrapped));
      }
      board.pause();
    }
    const ContractReport& report = shared.reports[core];
    if (report.failures != 0) print("core ", core, ", ", report.name, ": ", report.failure, "\n");
    checks += report.checks;
    failures += report.failures;
  }
  print("contract: ", checks, " checks, ", failures, " failures\n");
  const bool passed = failures == 0 && checks == contract::check_count<BoardBench>() * kWorkerCount;
  exit_run(static_cast<std::uint32_t>(passed ? RunExit::kDone : RunExit::kFrameFailed));
}

void gridiron_worker(std::uint64_t core_index) {
  const auto core = static_cast<std::uint32_t>(core_index);
  ContractReport& report = gridiron_shared.reports[core];
  contract::for_each_check<BoardBench>([&](const char* name, auto check, bool) {
    BoardBench bench(core);
    const char* failure = check(bench);
    ++report.checks;
    if (failure == nullptr) return;
    if (report.failures++ == 0) {
      report.name = name;
      report.failure = failure;
    }
  });
  set_state(gridiron_shared.control.cores[core], CoreState::kFinished);
  for (;;) finish();
}

}  // namespace gridiron::port
