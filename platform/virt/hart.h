// A hart's own registers, and those of the CLINT that wake it and tell the time.
// Source: RISC-V Privileged Architecture 1.12; QEMU's machine virt. Memory: registers. Threads: any hart.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "memory_map.h"

namespace gridiron::port {

inline constexpr std::uint64_t kTicksPerMillisecond = 10'000;

[[nodiscard]] inline std::uint32_t this_hart() {
  std::uint64_t hart;
  asm volatile("csrr %0, mhartid" : "=r"(hart));
  return static_cast<std::uint32_t>(hart);
}

[[nodiscard]] inline volatile std::uint32_t& software_interrupt(std::uint32_t hart) {
  return *reinterpret_cast<volatile std::uint32_t*>(kClint + 4 * hart);
}

[[nodiscard]] inline std::uint64_t ticks() { return *reinterpret_cast<const volatile std::uint64_t*>(kClint + 0xBFF8); }

/// Wakes a hart; it sees what was stored before.
inline void wake(std::uint32_t hart) {
  __atomic_thread_fence(__ATOMIC_SEQ_CST);
  asm volatile("fence rw, o" ::: "memory");
  software_interrupt(hart) = 1;
}

/// Sleeps until this hart is woken or, at the latest, the time has come. Interrupts are looked at, not taken.
inline void sleep_until(std::uint64_t wake_ticks) {
  constexpr std::uint64_t kSoftware = 1u << 3, kTimer = 1u << 7;
  const std::uint32_t hart = this_hart();
  *reinterpret_cast<volatile std::uint64_t*>(kClint + 0x4000 + 8 * hart) = wake_ticks;
  asm volatile("csrw mie, %0" ::"r"(kSoftware | kTimer));
  std::uint64_t pending;
  do {
    asm volatile("wfi\n csrr %0, mip" : "=r"(pending)::"memory");
  } while ((pending & (kSoftware | kTimer)) == 0);
  asm volatile("csrw mie, zero");
  software_interrupt(hart) = 0;
  asm volatile("fence o, rw" ::: "memory");
  __atomic_thread_fence(__ATOMIC_SEQ_CST);
}

}  // namespace gridiron::port
