// Macrocell table: the block of a macrocell, resident and streamed, is the one that counting finds.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/engine/grid/macro_table.h>

#include "core/engine/grid/table_cases.h"
#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

template <class Window>
std::uint32_t block_in(const Window& window, std::uint32_t cell) {
  return window.is_occupied(cell) ? window.block_of(cell) : 0;
}

TEST(MacroTable, ResidentTableKnowsEveryBlock) {
  using Window = MacroTableWindow<128>;
  for (const std::uint32_t percent : {0u, 3u, 50u, 97u, 100u}) {
    TestRandom random(percent);
    const TableCase table(random, 4096, percent);
    Window window;
    window.forget();
    for (std::uint32_t chunk = 0; chunk < Window::kChunkCount; ++chunk) load_chunk(table, chunk, window);
    for (std::uint32_t cell = 0; cell < 4096; ++cell) {
      ASSERT_TRUE(window.holds(cell)) << cell;
      ASSERT_EQ(block_in(window, cell), table.block_of[cell]) << cell << " of " << percent << " %";
    }
  }
}

TEST(MacroTable, StreamedTableHoldsOnlyWhatWasFetched) {
  for_each_seed(100, [&](TestRandom& random) {
    const std::uint32_t macro_cells = 1 + random.below(20000);
    const TableCase table(random, macro_cells, 40);
    const auto check = [&](auto& window) {
      using Window = std::remove_reference_t<decltype(window)>;
      window.forget();
      for (std::uint32_t cell : {0u, macro_cells - 1, macro_cells / 2}) ASSERT_FALSE(window.holds(cell));
      std::uint32_t fetches = 0;
      for (int i = 0; i < 3000; ++i) {
        const std::uint32_t cell = random.below(macro_cells);
        if (!window.holds(cell)) {
          load_chunk(table, Window::chunk_of(cell), window);
          ++fetches;
        }
        ASSERT_TRUE(window.holds(cell));
        ASSERT_EQ(block_in(window, cell), table.block_of[cell]) << "macrocell " << cell;
      }
      const std::uint32_t chunks = (macro_cells + 511) / 512;
      ASSERT_GE(fetches, chunks <= 2 ? 1u : 3u);
      if (chunks <= Window::kChunkCount) {
        ASSERT_LE(fetches, chunks) << "a table that fits is fetched once";
      }
    };
    MacroTableWindow<16> one_chunk;
    MacroTableWindow<64> four_chunks;
    check(one_chunk);
    check(four_chunks);
  });
}

}  // namespace
}  // namespace gridiron::test
