// Wakes a RISC-V hart, sleeps, and reads the time: the CLINT of SiFive's chips and of the emulator's machine virt.
// Source: SiFive FU540-C000 Manual, chapter 9; RISC-V Privileged Architecture 1.12.
// Memory: registers. Threads: any hart, in machine mode. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron::port {

inline constexpr std::uintptr_t kClint = 0x02000000;

/// Sends a software interrupt.
inline void wake_hart(std::uint32_t hart) {
  // The woken hart must see what was stored before.
  asm volatile("fence" ::: "memory");
  reinterpret_cast<volatile std::uint32_t*>(kClint)[hart] = 1;
}

/// Clears a hart's software interrupt. Loads after this are no older than the interrupt.
inline void hush_hart(std::uint32_t hart) {
  reinterpret_cast<volatile std::uint32_t*>(kClint)[hart] = 0;
  asm volatile("fence" ::: "memory");
}

/// Whether a software interrupt of this hart is pending.
[[nodiscard]] inline bool is_called() {
  std::uint64_t pending = 0;
  asm volatile("csrr %0, mip" : "=r"(pending));
  return (pending & 1u << 3) != 0;
}

/// Sleeps until a software interrupt is pending, or with `with_timer` the timer's. Takes neither. May return early.
inline void sleep_hart(bool with_timer) {
  const std::uint64_t wanted = 1u << 3 | (with_timer ? 1u << 7 : 0u);
  asm volatile("csrw mie, %0\n wfi\n csrw mie, zero" ::"r"(wanted) : "memory");
}

/// Ticks of the board's clock.
[[nodiscard]] inline std::uint64_t clock_ticks() {
  return *reinterpret_cast<const volatile std::uint64_t*>(kClint + 0xBFF8);
}

/// Sets the time at which a hart's timer interrupt becomes pending.
inline void set_alarm(std::uint32_t hart, std::uint64_t ticks) {
  reinterpret_cast<volatile std::uint64_t*>(kClint + 0x4000)[hart] = ticks;
}

}  // namespace gridiron::port
