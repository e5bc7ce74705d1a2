// Text on a board's serial line: pieces of a line, numbers in decimal or hexadecimal, without a buffer.
// Memory: none. Threads: one core at a time. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron::port {

/// Sends one character; the board defines it. May wait for the line, within a bound of its own.
void put_character(char character);

/// A number to write in hexadecimal, with 0x.
struct Hex {
  std::uint64_t value;
};

/// A Status as a number, such as one that another core stored.
struct StatusNumber {
  std::uint32_t value;
};

/// Effects by name.
struct EffectSet {
  std::uint32_t bits;
};

void print_piece(const char* text);
void print_piece(std::uint64_t number);
void print_piece(std::uint32_t number);
void print_piece(Hex number);
void print_piece(StatusNumber number);  ///< "14 (kBadImage)"
void print_piece(EffectSet set);        ///< "reflection, refraction"

/// Writes the pieces one after the other: texts, unsigned numbers, Hex, StatusNumber, EffectSet.
template <class... Pieces>
void print(const Pieces&... pieces) {
  (print_piece(pieces), ...);
}

}  // namespace gridiron::port
