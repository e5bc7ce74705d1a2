// Store facts: the sizes of the compiled local-store layouts, as values.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/sim_chip.h>
#include <report/report.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "configurations.h"

namespace gridiron::tool {

/// One layout of the local store.
struct StoreFacts {
  std::uint32_t arena_bytes = 0;
  std::uint32_t code_bytes = 0, stack_bytes = 0;  ///< committed budgets
  std::uint32_t code_memory_bytes = 0;  ///< of a memory of its own for code, outside of the arena; 0: there is none
  std::uint32_t tile_width = 0, packet_width = 0;
  EngineId engine = EngineId::kGrid;  ///< of eye rays
  std::uint32_t max_macro_width = 0;
  BufferDepths most_depths{};  ///< fetch: of layouts with effects or the tree alone
  std::uint32_t triangles_per_buffer = 0;
  std::uint32_t mailbox_slots = 0;         ///< 0: no packets
  std::uint32_t leaf_triangles = 8;        ///< of a leaf of the tree that images for it have, at most
  std::uint32_t resident_macro_cells = 0;  ///< size of the table that is fetched only once
  std::vector<LocalStoreRegion> regions;   ///< in address order

  [[nodiscard]] std::uint64_t data_bytes() const;
};

/// @returns nothing if no kernel is built for the layout in any mode. With effects: the map of the build with all
/// effects.
[[nodiscard]] std::optional<StoreFacts> find_store_facts(const sim::LayoutChoice& layout);

/// Every layout that a kernel is built for in any mode, the common ones first.
[[nodiscard]] std::vector<sim::LayoutChoice> built_layouts();

/// Pixels along the edge of a tile whose eye rays go through the tree.
[[nodiscard]] constexpr std::uint32_t tree_tile_width(sim::StoreSize store) {
  if (store == sim::StoreSize::k16KB) return 8;
  return store == sim::StoreSize::k64KB ? 16 : store == sim::StoreSize::k128KB ? 32 : 64;
}

/// The layout with the store's usual tiles. @param packet_width  8 or 32; 32 becomes 16 if tiles are no wider; in a
/// store of 16 KB, which holds no grid, that of 64 KB. 0: the one whose eye rays go through the tree.
[[nodiscard]] StoreFacts usual_store_facts(sim::StoreSize store, std::uint32_t packet_width);

/// The layout that renders effects. @param store  64 KB, else that of 256 KB is returned. @param packet_width  0, 8 or
/// 32; unused with 64 KB.
[[nodiscard]] StoreFacts effect_store_facts(sim::StoreSize store, std::uint32_t packet_width);

/// Whether a layout fits a core, built or not.
struct LayoutFit {
  sim::LayoutChoice layout;
  std::uint64_t data_bytes = 0;  ///< what it takes
  std::uint32_t room_bytes = 0;  ///< what code and stack leave
  bool fits = false;
};

/// All sizes of store, with tiles of 8 to 64 pixels, and packets of 8x8 rays and as wide as the tile, 32 at most.
[[nodiscard]] std::vector<LayoutFit> layout_fits();

}  // namespace gridiron::tool
