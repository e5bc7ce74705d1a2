// The contract checks on the board: core 0, its arena, its channel, and main memory in place of a job.
// Memory: arena of core 0, 64 KB of main memory. Threads: core 0. SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>

#include "cache.h"
#include "console.h"
#include "contract_checks.h"
#include "gdma_board.h"
#include "master.h"
#include "memory_map.h"
#include "run_control.h"
#include "semihost.h"
#include "template_port.h"
#include "uart.h"

extern "C" {
void master_entry();
void secondary_entry(std::uint32_t core);
extern const std::byte* const arena_stack_tops[gridiron::port::kCoreCount];
}

namespace gridiron::port {
namespace {

struct alignas(4096) Arena {
  alignas(128) std::byte local[contract::kLocalBytes];
};
[[gnu::section(".arena0")]] Arena arena0;
[[gnu::section(".arena1"), gnu::used]] Arena arena1;
[[gnu::section(".arena2"), gnu::used]] Arena arena2;
[[gnu::section(".arena3"), gnu::used]] Arena arena3;

RunControl control;

std::byte* main_memory(std::uint32_t offset) {
  return reinterpret_cast<std::byte*>(static_cast<std::uintptr_t>(kJobAddress)) + offset;
}

class BoardBench {
 public:
  using PlatformType = TemplatePort<GdmaBoard>;
  static constexpr bool kChecksRules = true;
  static constexpr bool kChecksQueue = true;
  static constexpr bool kChecksOverlap = false;

  BoardBench() {
    control.next_tile = 0;
    control.tile_count = contract::kItemCount;
  }
  PlatformType& platform() { return port_; }
  std::byte* local() { return arena0.local; }
  MainAddress main() { return {kJobAddress}; }
  // The DMA does not read caches.
  void poke(std::uint32_t offset, std::byte value) {
    *main_memory(offset) = value;
    clean_and_invalidate(kJobAddress + offset, 1);
    order_all();
  }
  std::byte peek(std::uint32_t offset) {
    invalidate(kJobAddress + offset, 1);
    return *main_memory(offset);
  }

 private:
  GdmaBoard board_{*reinterpret_cast<volatile GdmaRegisters*>(static_cast<std::uintptr_t>(kGdmaAddress)), control,
                   reinterpret_cast<std::uintptr_t>(&arena0), sizeof arena0};
  PlatformType port_{board_};
};

}  // namespace
}  // namespace gridiron::port

// No other core is started.
const std::byte* const arena_stack_tops[gridiron::port::kCoreCount] = {};
void secondary_entry(std::uint32_t) {}

void master_entry() {
  using namespace gridiron::port;
  begin_uart();
  std::uint32_t checks = 0, failures = 0;
  gridiron::contract::for_each_check<BoardBench>([&](const char* name, auto check, bool) {
    BoardBench bench;
    const char* failure = check(bench);
    ++checks;
    if (failure == nullptr) return;
    ++failures;
    print(name, ": ", failure, "\n");
  });
  print("contract: ", checks, " checks, ", failures, " failures\n");
  const bool passed = failures == 0 && checks == gridiron::contract::check_count<BoardBench>();
  exit_run(static_cast<std::uint32_t>(passed ? RunExit::kDone : RunExit::kFrameFailed));
}
