// Machine mode of a worker's hart: its start, its copies, its traps.
// Memory: arenas and the job's memory. Threads: each hart serves its own worker. SPDX-License-Identifier: Apache-2.0
#include "engine.h"

#include <cstdint>
#include <cstring>

#include "clint.h"
#include "console.h"
#include "master.h"
#include "memory_map.h"
#include "semihost.h"
#include "worker_arena.h"

namespace gridiron::port {

extern "C" {
[[noreturn]] void gridiron_boot_worker(std::uint64_t hart);
std::uint64_t gridiron_serve(std::uint64_t target, std::uint64_t source, std::uint64_t bytes, Call call);
[[noreturn]] void gridiron_trapped(std::uint64_t cause, std::uint64_t address, std::uint64_t pc);
}

// virt.ld places each of these.
[[gnu::section(".shared")]] SharedMemory gridiron_shared;
[[gnu::section(".arenas")]] Arena gridiron_arenas[kWorkerCount];

namespace {

[[nodiscard]] std::uint32_t this_hart() {
  std::uint64_t hart = 0;
  asm volatile("csrr %0, mhartid" : "=r"(hart));
  return static_cast<std::uint32_t>(hart);
}

bool is_within(std::uint64_t address, std::uint64_t bytes, std::uint64_t begin, std::uint64_t length) {
  const std::uint64_t offset = address - begin;
  return offset <= length && bytes <= length - offset;
}

bool is_in_main(std::uint64_t address, std::uint64_t bytes) {
  return is_within(address, bytes, address_of(job_begin), address_of(job_end) - address_of(job_begin));
}

bool is_in_arena(std::uint64_t address, std::uint64_t bytes) {
  return is_within(address, bytes, address_of(&gridiron_arenas[this_hart() - 1]), kArenaBytes);
}

[[noreturn]] void sleep_for_ever() {
  for (;;) asm volatile("wfi");
}

void sleep_until_called(std::uint32_t hart) {
  while (!is_called()) sleep_hart(false);
  hush_hart(hart);
}

// pmpaddr of a region whose size is a power of two and whose address a multiple of it.
constexpr std::uint64_t region(std::uint64_t address, std::uint64_t bytes) {
  return (address | (bytes / 2 - 1)) >> 2;
}

// Opens the memory that user mode may touch on this hart; without an entry it may not.
void open_memory(std::uint32_t core) {
  constexpr std::uint64_t kRead = 1, kWrite = 2, kExecute = 4, kPowerOfTwo = 3 << 3;
  constexpr std::uint64_t kData = kRead | kWrite | kPowerOfTwo, kCode = kRead | kExecute | kPowerOfTwo;
  const std::uint64_t code_bytes = address_of(code_end) - address_of(code_begin);
  asm volatile("csrw pmpaddr0, %0" ::"r"(region(address_of(&gridiron_arenas[core]), kArenaBytes)));
  asm volatile("csrw pmpaddr1, %0" ::"r"(region(address_of(code_begin), code_bytes)));
  asm volatile("csrw pmpaddr2, %0" ::"r"(region(address_of(&gridiron_shared), kSharedBytes)));
  std::uint64_t entries = kData | kCode << 8 | kData << 16;
  if constexpr (kHasWindow) {
    asm volatile("csrw pmpaddr3, %0" ::"r"(region(address_of(job_begin) + core * kWindowBytes, kWindowBytes)));
    entries |= kData << 24;
  }
  asm volatile("csrw pmpcfg0, %0\n sfence.vma" ::"r"(entries) : "memory");
}

}  // namespace

void gridiron_boot_worker(std::uint64_t hart) {
  const auto core = static_cast<std::uint32_t>(hart - 1);
  open_memory(core);
  sleep_until_called(static_cast<std::uint32_t>(hart));
  gridiron_enter_worker(core, stack_of(core).top);
}

std::uint64_t gridiron_serve(std::uint64_t target, std::uint64_t source, std::uint64_t bytes, Call call) {
  if (call == Call::kFinished) {
    wake_hart(0);
    sleep_until_called(this_hart());
    return 0;
  }
  if (call != Call::kCopy) return 0;
  const bool is_get = is_in_arena(target, bytes) && is_in_main(source, bytes);
  const bool is_put = is_in_main(target, bytes) && is_in_arena(source, bytes);
  if (!is_get && !is_put) return 0;
  std::memcpy(reinterpret_cast<void*>(static_cast<std::uintptr_t>(target)),
              reinterpret_cast<const void*>(static_cast<std::uintptr_t>(source)), bytes);
  return 1;
}

void gridiron_trapped(std::uint64_t cause, std::uint64_t address, std::uint64_t pc) {
  const std::uint32_t hart = this_hart();
  if (hart == 0) {
    print("trap: master, cause ", Hex{cause}, " address ", Hex{address}, " pc ", Hex{pc}, "\n");
    exit_run(static_cast<std::uint32_t>(RunExit::kTrapped));
  }
  CoreSlot& slot = gridiron_shared.control.cores[hart - 1];
  slot.trap = {cause, address, pc};
  set_state(slot, CoreState::kTrapped);
  wake_hart(0);
  sleep_for_ever();
}

}  // namespace gridiron::port
