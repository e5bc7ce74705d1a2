// The macrocell table as a core sees it: which macrocells hold triangles, and where their cell blocks are.
// Memory: a window inside the local store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>

#include <cstdint>

namespace gridiron {

/// A window of EntryCount table entries, direct-mapped in chunks of one line. A table that fits is loaded whole, once
/// per core; a longer one is fetched chunk by chunk and forgotten at every tile, so that no tile depends on another.
template <std::uint32_t EntryCount>
struct alignas(128) MacroTableWindow {
  static constexpr std::uint32_t kEntryCount = EntryCount;
  static constexpr std::uint32_t kChunkEntries = kLineBytes / sizeof(MacroTableEntry);
  static constexpr std::uint32_t kChunkCount = EntryCount / kChunkEntries;
  static constexpr std::uint32_t kNoChunk = 0xFFFFFFFFu;
  static_assert(EntryCount % kChunkEntries == 0 && kChunkCount > 0);

  alignas(128) MacroTableEntry entries[EntryCount];
  std::uint32_t chunk_of_slot[kChunkCount];

  void forget() {
    for (std::uint32_t& chunk : chunk_of_slot) chunk = kNoChunk;
  }
  [[nodiscard]] static GRIDIRON_INLINE std::uint32_t chunk_of(std::uint32_t macro_cell) {
    return macro_cell / 32 / kChunkEntries;
  }
  [[nodiscard]] static GRIDIRON_INLINE std::uint32_t slot_of(std::uint32_t chunk) { return chunk % kChunkCount; }
  [[nodiscard]] GRIDIRON_INLINE bool holds(std::uint32_t macro_cell) const {
    const std::uint32_t chunk = chunk_of(macro_cell);
    return chunk_of_slot[slot_of(chunk)] == chunk;
  }
  /// @returns whether a macrocell holds triangles. Precondition: holds().
  [[nodiscard]] GRIDIRON_INLINE bool is_occupied(std::uint32_t macro_cell) const {
    return ((entries[macro_cell / 32 % EntryCount].occupied >> (macro_cell % 32)) & 1u) != 0;
  }
  /// @returns the cell block of a macrocell. Precondition: is_occupied().
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t block_of(std::uint32_t macro_cell) const {
    const MacroTableEntry& entry = entries[macro_cell / 32 % EntryCount];
    return entry.first_block + count_bits(entry.occupied & ((1u << (macro_cell % 32)) - 1u));
  }
};

}  // namespace gridiron
