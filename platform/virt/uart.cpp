// The serial line: an NS16550 that the loader or the emulator has set up.
// Memory: registers. Threads: the master. SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "console.h"
#include "memory_map.h"

namespace gridiron::port {

void put_character(char character) {
  constexpr std::uint8_t kTransmitterEmpty = 1u << 5;
  constexpr std::uint32_t kMostPolls = 1u << 20;
  auto* const registers = reinterpret_cast<volatile std::uint8_t*>(kUart);
  for (std::uint32_t poll = 0; poll < kMostPolls && (registers[5] & kTransmitterEmpty) == 0; ++poll) {
  }
  registers[0] = static_cast<std::uint8_t>(character);
}

}  // namespace gridiron::port
