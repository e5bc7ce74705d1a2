// What the tables of counted work have in common: which kinds they price, and formatted words.
// Memory: std::string. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/engine_work.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

namespace gridiron::calibrate {

/// Whether a kind of work has a price of its own.
[[nodiscard]] inline bool is_charged(std::size_t kind) {
  return !sim::is_charged_as_event(WorkId(static_cast<std::uint32_t>(kind)));
}

/// @returns the pattern with its values, at most 399 characters.
template <class... Values>
[[nodiscard]] std::string format(const char* pattern, Values... values) {
  char text[400];
  const int length = std::snprintf(text, sizeof(text), pattern, values...);
  return std::string(text, static_cast<std::size_t>(length));
}

}  // namespace gridiron::calibrate
