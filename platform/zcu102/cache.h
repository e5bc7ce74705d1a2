// Maintenance of the data cache by address, to the point of coherency, and the barrier that goes with it.
// Source: Arm Architecture Reference Manual for A-profile (DDI 0487), D7.5.9.
// Memory: none. Threads: any; the lines' owner calls. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "memory_map.h"

namespace gridiron::port {

/// All earlier accesses, including cache operations and registers, end before any later one.
inline void order_all() { asm volatile("dsb sy" : : : "memory"); }

template <class Visit>
inline void for_each_line(std::uint64_t address, std::uint64_t bytes, Visit&& visit) {
  for (std::uint64_t line = address & ~std::uint64_t{kCacheLineBytes - 1}; line < address + bytes;
       line += kCacheLineBytes) {
    visit(line);
  }
}

/// Writes dirty lines to memory and removes all from the cache; not ordered before what follows.
inline void clean_and_invalidate(std::uint64_t address, std::uint64_t bytes) {
  for_each_line(address, bytes, [](std::uint64_t line) { asm volatile("dc civac, %0" : : "r"(line) : "memory"); });
}

/// Discards lines, dirty or not, including whole lines at the ends; ordered before what follows.
inline void invalidate(std::uint64_t address, std::uint64_t bytes) {
  for_each_line(address, bytes, [](std::uint64_t line) { asm volatile("dc ivac, %0" : : "r"(line) : "memory"); });
  order_all();
}

}  // namespace gridiron::port
