// A macrocell table of random macrocells, and a naive one to compare it with.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>

#include "support/test_mesh.h"

namespace gridiron::test {

/// The table as it lies in main memory, a whole number of lines, and the block of every macrocell counted one by one.
struct TableCase {
  std::vector<MacroTableEntry> entries;
  std::vector<std::uint32_t> block_of;  ///< 0: empty
  std::uint32_t block_count = 1;        ///< block 0 is the empty one

  TableCase(TestRandom& random, std::uint32_t macro_cells, std::uint32_t percent_occupied) {
    constexpr std::uint32_t kEntriesPerLine = kLineBytes / sizeof(MacroTableEntry);
    const std::uint32_t entry_count = (macro_cells + 31) / 32;
    entries.resize((entry_count + kEntriesPerLine - 1) / kEntriesPerLine * kEntriesPerLine);
    for (std::uint32_t cell = 0; cell < macro_cells; ++cell) {
      MacroTableEntry& entry = entries[cell / 32];
      if (cell % 32 == 0) entry.first_block = block_count;
      const bool occupied = random.below(100) < percent_occupied;
      if (occupied) entry.occupied |= 1u << (cell % 32);
      block_of.push_back(occupied ? block_count++ : 0);
    }
  }
};

/// Copies a chunk of the table into its place in a window.
template <class Window>
void load_chunk(const TableCase& table, std::uint32_t chunk, Window& window) {
  const std::uint32_t slot = Window::slot_of(chunk);
  for (std::uint32_t i = 0; i < Window::kChunkEntries; ++i) {
    window.entries[slot * Window::kChunkEntries + i] = table.entries[chunk * Window::kChunkEntries + i];
  }
  window.chunk_of_slot[slot] = chunk;
}

}  // namespace gridiron::test
