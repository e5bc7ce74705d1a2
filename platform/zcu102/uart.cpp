// The console of the firmware: UART0.
// Source: Zynq UltraScale+ register reference (UG1087), module UART.
// Memory: registers. Threads: one core at a time. SPDX-License-Identifier: Apache-2.0
#include "uart.h"

#include <cstdint>

#include "console.h"
#include "memory_map.h"

namespace gridiron::port {
namespace {

constexpr std::uint64_t kControl = 0x00;
constexpr std::uint32_t kTransmitAndReceive = 1u << 4 | 1u << 2;
constexpr std::uint64_t kStatus = 0x2C;
constexpr std::uint32_t kTransmitFull = 1u << 4;
constexpr std::uint64_t kFifo = 0x30;
constexpr std::uint32_t kPollBound = 1u << 20;

std::uint32_t speaker = 0;  // core + 1 of the only one that may print; 0: all may

std::uint32_t this_core() {
  std::uint64_t affinity = 0;
  asm("mrs %0, mpidr_el1" : "=r"(affinity));
  return static_cast<std::uint32_t>(affinity & 0xFF);
}

volatile std::uint32_t& uart_word(std::uint64_t offset) {
  return *reinterpret_cast<volatile std::uint32_t*>(static_cast<std::uintptr_t>(kUartAddress + offset));
}

}  // namespace

void begin_uart() { uart_word(kControl) = kTransmitAndReceive; }

bool take_uart() {
  std::uint32_t nobody = 0;
  if (!__atomic_compare_exchange_n(&speaker, &nobody, this_core() + 1, false, __ATOMIC_ACQ_REL, __ATOMIC_ACQUIRE)) {
    return false;
  }
  // Other cores may be between their check of the speaker and their character.
  for (std::uint32_t i = 0; i < kPollBound / 16; ++i) asm volatile("yield");
  return true;
}

void put_character(char character) {
  const std::uint32_t heard = __atomic_load_n(&speaker, __ATOMIC_ACQUIRE);
  if (heard != 0 && heard != this_core() + 1) return;
  for (std::uint32_t i = 0; i < kPollBound && (uart_word(kStatus) & kTransmitFull) != 0; ++i) {
  }
  uart_word(kFifo) = static_cast<unsigned char>(character);
}

}  // namespace gridiron::port
