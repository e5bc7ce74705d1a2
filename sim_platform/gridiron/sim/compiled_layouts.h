// Compiled layouts: the local stores that the simulated chip has a kernel for, and the choice of one at run time.
// Memory: types alone. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/sim_chip.h>
#include <gridiron/store/local_store.h>

#include <cstdint>
#include <type_traits>

namespace gridiron::sim {

template <class... Layouts>
struct LayoutList {};

/// In every mode and for every lane count from 4 on, up to most_lanes().
using CommonLayouts =
    LayoutList<StoreLayout64K<4>, StoreLayout64K<8>, StoreLayout64K<16>, StoreLayout256K<4>, StoreLayout256K<8>,
               StoreLayout256K<16>, StoreLayout256K<32>, TreeLayout16K, TreeLayout64K, TreeLayout256K<64>>;

/// Of these, with one lane too, in Mode::kChecked and Mode::kPlain: what cores without vectors run.
using OneLaneLayouts = LayoutList<TreeLayout16K, TreeLayout64K, TreeLayout256K<64>>;

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

/// What wide lanes render with in Mode::kPlain in place of a layout of 256 KB for effects: batches as large as pay on a
/// host, with memory for groups and terms of rays. No chip has it.
template <class Layout>
struct HostLayout : Layout {
  /// @cond
  static constexpr std::uint32_t kArenaBytes = 1024 * 1024;
  static constexpr std::uint32_t kBatchRays = 2048;
  static constexpr std::uint32_t kSpareListWords = 2048;
  static constexpr bool kHasGroups = true;
  /// @endcond
};

/// @returns a std::type_identity of what a layout is rendered with.
/// @tparam IsPlain  in Mode::kPlain. @tparam Lanes  how many there are.
template <class Layout, bool IsPlain, std::uint32_t Lanes>
[[nodiscard]] constexpr auto used_layout() {
  if constexpr (IsPlain && Lanes > 4 && requires { requires Layout::kHasBeams; }) {
    return std::type_identity<HostLayout<Layout>>{};
  } else {
    return std::type_identity<Layout>{};
  }
}

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
