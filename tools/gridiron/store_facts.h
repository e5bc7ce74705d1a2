// Store facts: what the compiled local-store layouts hold, as values.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/sim_chip.h>
#include <report/report.h>

#include <cstdint>
#include <vector>

namespace gridiron::tool {

/// One layout of the local store.
struct StoreFacts {
  std::uint32_t arena_bytes = 0;
  std::uint32_t code_bytes = 0, stack_bytes = 0;  ///< committed budgets
  std::uint32_t tile_width = 0;
  std::uint32_t max_macro_width = 0;
  std::uint32_t max_output_depth = 0, max_macro_depth = 0, max_triangle_depth = 0;
  std::uint32_t triangles_per_buffer = 0;
  std::vector<LocalStoreRegion> regions;  ///< in address order

  [[nodiscard]] std::uint64_t data_bytes() const;
};

/// @param packet_width  4, 8, 16 or 32; 32 is 16 in the 64 KB store, whose tiles are no wider.
[[nodiscard]] StoreFacts store_facts(sim::StoreSize size, std::uint32_t packet_width);

}  // namespace gridiron::tool
