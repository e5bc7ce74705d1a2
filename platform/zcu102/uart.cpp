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

volatile std::uint32_t& uart_word(std::uint64_t offset) {
  return *reinterpret_cast<volatile std::uint32_t*>(static_cast<std::uintptr_t>(kUartAddress + offset));
}

}  // namespace

void begin_uart() { uart_word(kControl) = kTransmitAndReceive; }

void put_character(char character) {
  for (std::uint32_t i = 0; i < kPollBound && (uart_word(kStatus) & kTransmitFull) != 0; ++i) {
  }
  uart_word(kFifo) = static_cast<unsigned char>(character);
}

}  // namespace gridiron::port
