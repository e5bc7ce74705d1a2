// Store facts. SPDX-License-Identifier: Apache-2.0
#include "store_facts.h"

#include <gridiron/sim/compiled_layouts.h>
#include <gridiron/store/local_store.h>

#include <algorithm>

namespace gridiron::tool {
namespace {

template <class Layout>
StoreFacts facts_of() {
  StoreFacts facts;
  facts.arena_bytes = Layout::kArenaBytes;
  facts.code_bytes = Layout::kCodeBudgetBytes;
  facts.code_memory_bytes = kCodeMemoryBytes<Layout>;
  facts.stack_bytes = Layout::kStackBudgetBytes;
  facts.tile_width = Layout::kTileWidth;
  facts.packet_width = Layout::kPacketWidth;
  facts.engine = static_cast<EngineId>(Layout::Engine::kId);
  facts.most_depths.output = Layout::kMaxOutputDepth;
  if constexpr (requires { Layout::kLeafTriangles; }) facts.leaf_triangles = Layout::kLeafTriangles;
  if constexpr (Layout::kEffects != 0) {
    facts.most_depths.fetch = Layout::RayEngine::template kMaxDepth<Layout>;
  } else if constexpr (Layout::Engine::kId == TileEngine::kId) {
    facts.most_depths.fetch = Layout::Engine::template kMaxDepth<Layout>;
  }
  if constexpr (kHasPackets<Layout>) {
    facts.max_macro_width = Layout::kMaxMacroWidth;
    facts.most_depths.macro = Layout::kMaxMacroDepth;
    facts.most_depths.triangle = Layout::kMaxTriangleDepth;
    facts.triangles_per_buffer = Layout::kTrianglesPerBuffer;
    facts.mailbox_slots = Layout::kMailboxSlots;
    facts.resident_macro_cells = 32 * Layout::kTableEntries;
  } else {
    // Nothing reads the grid.
    facts.max_macro_width = kMaxMacroWidth;
    facts.most_depths.macro = 1;
    facts.most_depths.triangle = 1;
  }
  for_each_region<Layout>([&facts](const char* name, std::size_t offset_bytes, std::size_t bytes) {
    facts.regions.push_back({name, offset_bytes, bytes});
  });
  return facts;
}

template <class Layout>
void add_fit(std::vector<LayoutFit>& fits, sim::StoreSize store) {
  fits.push_back({.layout = {store, Layout::kTileWidth, Layout::kPacketWidth},
                  .data_bytes = sizeof(LocalStore<Layout>),
                  .room_bytes = kDataRoomBytes<Layout>,
                  .fits = kFitsArena<Layout>});
}

template <class... Layouts>
void add_choices(std::vector<sim::LayoutChoice>& choices, sim::LayoutList<Layouts...>) {
  for (const sim::StoreSize store : sim::kEveryStoreSize) {
    const auto add_if = [&choices, store](std::uint32_t arena_bytes, std::uint32_t tile_width,
                                          std::uint32_t packet_width, bool has_effects) {
      if (arena_bytes == sim::arena_bytes(store)) choices.push_back({store, tile_width, packet_width, has_effects});
    };
    (add_if(Layouts::kArenaBytes, Layouts::kTileWidth, Layouts::kPacketWidth, Layouts::kEffects != 0), ...);
  }
}

// Packets of 8x8 rays, and packets as wide as the tile if possible, for each width of tiles.
template <template <std::uint32_t, std::uint32_t> class Layout>
void add_fits(std::vector<LayoutFit>& fits, sim::StoreSize store) {
  add_fit<Layout<8, 8>>(fits, store);
  add_fit<Layout<8, 16>>(fits, store);
  add_fit<Layout<16, 16>>(fits, store);
  add_fit<Layout<8, 32>>(fits, store);
  add_fit<Layout<32, 32>>(fits, store);
  add_fit<Layout<8, 64>>(fits, store);
  add_fit<Layout<32, 64>>(fits, store);
}

}  // namespace

std::uint64_t StoreFacts::data_bytes() const {
  return regions.empty() ? 0 : regions.back().offset_bytes + regions.back().bytes;
}

std::optional<StoreFacts> find_store_facts(const sim::LayoutChoice& layout) {
  std::optional<StoreFacts> facts;
  const auto take = [&facts]<class Layout>() { facts = facts_of<Layout>(); };
  if (layout.has_effects) {
    sim::visit_layout(sim::EffectLayouts{}, layout, take);
  } else if (!sim::visit_layout(sim::CommonLayouts{}, layout, take)) {
    sim::visit_layout(sim::SweepLayouts{}, layout, take);
  }
  return facts;
}

std::vector<sim::LayoutChoice> built_layouts() {
  std::vector<sim::LayoutChoice> choices;
  add_choices(choices, sim::CommonLayouts{});
  add_choices(choices, sim::SweepLayouts{});
  add_choices(choices, sim::EffectLayouts{});
  return choices;
}

StoreFacts effect_store_facts(sim::StoreSize store, std::uint32_t packet_width) {
  if (store == sim::StoreSize::k64KB) return *find_store_facts({store, 8, 0, true});
  return *find_store_facts({sim::StoreSize::k256KB, 32, packet_width, true});
}

StoreFacts usual_store_facts(sim::StoreSize store, std::uint32_t packet_width) {
  if (packet_width == 0) return *find_store_facts({store, tree_tile_width(store), 0});
  if (store == sim::StoreSize::k16KB) store = sim::StoreSize::k64KB;  // holds no grid
  const std::uint32_t tile_width = sim::usual_tile_width(store);
  return *find_store_facts({store, tile_width, std::min(packet_width, tile_width)});
}

std::vector<LayoutFit> layout_fits() {
  std::vector<LayoutFit> fits;
  add_fits<StoreLayout64K>(fits, sim::StoreSize::k64KB);
  add_fits<StoreLayout128K>(fits, sim::StoreSize::k128KB);
  add_fits<StoreLayout256K>(fits, sim::StoreSize::k256KB);
  add_fits<StoreLayout512K>(fits, sim::StoreSize::k512KB);
  return fits;
}

}  // namespace gridiron::tool
