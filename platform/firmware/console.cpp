// Text on a board's serial line.
// Memory: 20 bytes of stack. Threads: one core at a time. SPDX-License-Identifier: Apache-2.0
#include "console.h"

#include <gridiron/base/effect_names.h>
#include <gridiron/platform/status_name.h>

namespace gridiron::port {

namespace {

void print_number(std::uint64_t number, std::uint32_t base) {
  constexpr std::uint32_t kMostDigits = 20;
  char digits[kMostDigits];
  std::uint32_t count = 0;
  do {
    digits[count++] = "0123456789abcdef"[number % base];
    number /= base;
  } while (number != 0 && count < kMostDigits);
  while (count != 0) put_character(digits[--count]);
}

}  // namespace

void print_piece(const char* text) {
  for (; *text != '\0'; ++text) put_character(*text);
}

void print_piece(std::uint64_t number) { print_number(number, 10); }

void print_piece(std::uint32_t number) { print_number(number, 10); }

void print_piece(Hex number) {
  print_piece("0x");
  print_number(number.value, 16);
}

void print_piece(StatusNumber number) {
  print_piece(number.value);
  const char* name = status_name(number.value);
  if (name != nullptr) print(" (", name, ")");
}

void print_piece(EffectSet set) {
  for (std::uint32_t rest = set.bits; rest != 0; rest &= rest - 1) {
    const std::uint32_t bit = rest & ~(rest - 1);
    const char* name = effect_name(static_cast<EffectBits>(bit)).name;
    name != nullptr ? print(name) : print(Hex{bit});
    if (bit != rest) print(", ");
  }
}

}  // namespace gridiron::port
