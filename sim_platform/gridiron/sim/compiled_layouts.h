// Compiled layouts: the local stores that the simulated chip has a kernel for, and the choice of one at run time.
// Memory: types alone. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/sim_chip.h>
#include <gridiron/store/local_store.h>

#include <cstdint>

namespace gridiron::sim {

template <class... Layouts>
struct LayoutList {};

/// In every mode and for every lane count from 4 on, up to most_lanes().
using CommonLayouts =
    LayoutList<StoreLayout64K<4>, StoreLayout64K<8>, StoreLayout64K<16>, StoreLayout256K<4>, StoreLayout256K<8>,
               StoreLayout256K<16>, StoreLayout256K<32>, TreeLayout64K, TreeLayout256K<64>>;

/// Of these, with one lane too, in Mode::kChecked and Mode::kPlain: what cores without vectors run.
using OneLaneLayouts = LayoutList<TreeLayout64K, TreeLayout256K<64>>;

/// Eye rays through the tree in 128 KB: one tile at a time, and fewer nodes and leaves at hand. Budgets for code and
/// stack are those of 256 KB.
struct TreeLayout128K : TreeLayout256K<32> {
  static constexpr std::uint32_t kArenaBytes = 128 * 1024;
  static constexpr std::uint32_t kEyeTurns = 1;
  static constexpr std::uint32_t kEyeSlots = 8;
  static constexpr std::uint32_t kEyeTopNodes = 0;
};

/// The same in 512 KB, with no more at hand than 256 KB have. 273 nodes that stay for the frame, the root, its children
/// and theirs, take longer to fetch than they save.
struct TreeLayout512K : TreeLayout256K<64> {
  static constexpr std::uint32_t kArenaBytes = 512 * 1024;
};

/// In Mode::kChecked with 4 lanes only, for sweeps of the store's and the tile's size.
using SweepLayouts =
    LayoutList<StoreLayout128K<8>, StoreLayout128K<32>, StoreLayout512K<8>, StoreLayout512K<32>, StoreLayout512K<8, 64>,
               StoreLayout512K<32, 64>, StoreLayout256K<8, 8>, StoreLayout256K<8, 16>, StoreLayout256K<16, 16>,
               StoreLayout256K<8, 64>, StoreLayout256K<32, 64>, TreeLayout128K, TreeLayout256K<32>, TreeLayout512K>;

/// For frames with effects: in Mode::kPlain for every lane count, in the others with 4 lanes.
using EffectLayouts = LayoutList<EffectLayout256K<kAllEffects, 0>, EffectLayout256K<kAllEffects, 8>,
                                 EffectLayout256K<kAllEffects, 32>, EffectLayout64K<kAllEffects>>;

/// @returns the most lanes that the layout has memory for.
template <class Layout>
[[nodiscard]] constexpr std::uint32_t most_lanes() {
  if constexpr (requires { Layout::kMostLanes; }) return Layout::kMostLanes;
  return 16;
}

template <class Layout>
[[nodiscard]] constexpr bool is_layout(const LayoutChoice& choice) {
  return Layout::kArenaBytes == arena_bytes(choice.store) && Layout::kTileWidth == choice.tile_width &&
         Layout::kPacketWidth == choice.packet_width && (Layout::kEffects != 0) == choice.has_effects;
}

/// Calls visit.operator()<Layout>() for the chosen layout. @returns false if the list does not contain it.
template <class... Layouts, class Visit>
constexpr bool visit_layout(LayoutList<Layouts...>, const LayoutChoice& choice, Visit&& visit) {
  return ((is_layout<Layouts>(choice) && (visit.template operator()<Layouts>(), true)) || ...);
}

}  // namespace gridiron::sim
