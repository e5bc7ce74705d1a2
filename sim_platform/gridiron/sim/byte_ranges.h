// What the sources of SimCore share: ranges of bytes, and how messages write an address.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cinttypes>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

namespace gridiron::sim {

inline constexpr std::uint32_t kGranuleBytes = 16;

/// A stray loop makes millions of bad accesses; the first few are enough.
inline constexpr std::size_t kMaxViolations = 16;

[[nodiscard]] inline bool overlap(std::uint64_t a, std::uint64_t a_bytes, std::uint64_t b, std::uint64_t b_bytes) {
  return a < b + b_bytes && b < a + a_bytes;
}

[[nodiscard]] inline std::uint64_t address_of(const std::byte* local) {
  return reinterpret_cast<std::uintptr_t>(local);
}

[[nodiscard]] inline std::string hex(std::uint64_t value) {
  char text[24];
  std::snprintf(text, sizeof text, "0x%" PRIx64, value);
  return text;
}

}  // namespace gridiron::sim
