// Measures how deep a stack went: painted before the frame, inspected afterwards.
// Memory: the stack's own. Threads: the core whose stack it is. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron::port {

/// A stack that grows down from top; low is its last word. Both multiples of 8.
struct StackArea {
  std::uintptr_t low;
  std::uintptr_t top;
};

inline constexpr std::uint64_t kStackPaint = 0x5AA5C33C0FF0A55A;

/// Paints the stack below the caller's frame, except for the nearest bytes, which count as used from then on.
[[gnu::noinline]] inline void paint_stack(StackArea stack) {
  constexpr std::uintptr_t kNearest = 512;
  const auto here = reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0));
  for (std::uintptr_t place = stack.low; place + kNearest < here; place += sizeof kStackPaint) {
    *reinterpret_cast<volatile std::uint64_t*>(place) = kStackPaint;
  }
}

/// Bytes of the stack from its top to the deepest that is no longer painted.
[[nodiscard]] inline std::uint32_t used_stack_bytes(StackArea stack) {
  std::uintptr_t place = stack.low;
  while (place < stack.top && *reinterpret_cast<const volatile std::uint64_t*>(place) == kStackPaint) {
    place += sizeof kStackPaint;
  }
  return static_cast<std::uint32_t>(stack.top - place);
}

}  // namespace gridiron::port
