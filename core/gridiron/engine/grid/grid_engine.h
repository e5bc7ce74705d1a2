// The grid as an engine: packets of eye rays through slices of macrocells.
// Source: Cho, Kim, Han 2012, sections 4 and 5. Memory: its parts of the local store. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/frame_rules.h>
#include <gridiron/base/records.h>
#include <gridiron/dma/transfers.h>
#include <gridiron/engine/grid/frustum.h>
#include <gridiron/engine/grid/grid_store.h>
#include <gridiron/engine/grid/grid_work.h>
#include <gridiron/engine/grid/packet_driver.h>
#include <gridiron/platform/contract.h>
#include <gridiron/ray/camera.h>
#include <gridiron/ray/hits.h>
#include <gridiron/ray/packet_hits.h>

#include <cstdint>
#include <type_traits>

namespace gridiron {

/// The grid on one core; see engine/engine.h for what each function promises.
template <class L, class Store, Platform P>
class GridCore {
 public:
  using Layout = typename Store::Layout;

  GridCore(Store& store, Transfers<P>& transfers) : store_(store), transfers_(transfers) {}

  /// Checks the frame's grid against this store, and fetches the macrocell table where it fits.
  [[nodiscard]] Status begin() {
    GRIDIRON_TRY(find_grid_fault<Limits>(store_.frame).status);
    return load_table();
  }

  void begin_tile() {
    if (!table_resident_) store_.engine.table.forget();
  }

  [[nodiscard]] Status trace_eyes(const TileView& view, const Hits& hits) {
    const FrameHead& frame = store_.frame;
    for (std::uint32_t y = 0; y < Layout::kTileWidth && view.top + y < frame.height; y += Layout::kPacketWidth) {
      for (std::uint32_t x = 0; x < Layout::kTileWidth && view.left + x < frame.width; x += Layout::kPacketWidth) {
        GRIDIRON_TRY(trace_packet(view, x, y));
        store_hits<L>(store_.packet, x, y, Layout::kTileWidth, hits, store_.work);
      }
    }
    return Status::kOk;
  }

 private:
  using StorePacket = typename Store::EyeStore;
  using Table = MacroTableWindow<Layout::kTableEntries>;

  // Generates a packet and traces it. If the frame does not need distances, they are estimated; rays whose hit the
  // estimates leave open are traced again with exact distances. If ties must be broken too, a ray with an open tie is
  // traced alone, since its nearest triangle is then still in the local store.
  [[nodiscard]] Status trace_packet(const TileView& view, std::uint32_t x, std::uint32_t y) {
    RaySet<StorePacket::kRayCount> waiting;
    generate_packet<L>(store_.frame, view.left + x, view.top + y, store_.packet, waiting, store_.work, view.dx,
                       view.dy);
    GRIDIRON_TRY(trace_rays(waiting));
    if (!take_unsure_rays(store_.packet, store_.frame.t_far, waiting, store_.work)) [[likely]]
      return Status::kOk;
    GRIDIRON_TRY(trace_rays(waiting));
    if (!store_.packet.breaks_ties) return Status::kOk;
    RaySet<StorePacket::kRayCount> open;
    if (!take_unsure_rays(store_.packet, store_.frame.t_far, open, store_.work)) return Status::kOk;
    for (std::uint32_t ray = 0; ray < StorePacket::kRayCount; ++ray) {
      if (!open.contains(ray)) continue;
      waiting.clear();
      waiting.insert(ray);
      GRIDIRON_TRY(trace_rays(waiting));
    }
    return Status::kOk;
  }

  // Traces rays through the grid, one pass for each march axis and sign that they have.
  [[nodiscard]] GRIDIRON_OUTLINE Status trace_rays(RaySet<StorePacket::kRayCount>& waiting) {
    clear_mailbox();
    Frustum frustum;
    while (take_pass<L>(store_.frame.engine.grid, waiting, store_.packet, frustum, store_.work)) {
      PacketDriver<L, Store, P> driver(store_, transfers_, frustum);
      GRIDIRON_TRY(driver.run());
      // The next pass has other rays: what this one tested does not count for them.
      clear_mailbox();
    }
    return Status::kOk;
  }
  void clear_mailbox() {
    store_.work.add(GridWork::kMailboxGroup, Layout::kMailboxSlots / 4);
    store_.packet.mailbox.clear();
  }

  // Limits of this store.
  struct Limits : Layout {
    static constexpr std::uint32_t kMaxCellBlockBytes = Store::EyeStore::kCellBlockBytes;
    static constexpr Status kBeyond = Status::kUnsupportedFrame;
  };

  [[nodiscard]] Status load_table() {
    const GridRecord& grid = store_.frame.engine.grid;
    const std::uint64_t macro_cells =
        std::uint64_t{grid.macro_cell_count[0]} * grid.macro_cell_count[1] * grid.macro_cell_count[2];
    const std::uint64_t chunks = (macro_cells + 32 * Table::kChunkEntries - 1) / (32 * Table::kChunkEntries);
    Table& table = store_.engine.table;
    table.forget();
    table_resident_ = chunks <= Table::kChunkCount;
    if (!table_resident_) return Status::kOk;
    const std::uint32_t count = static_cast<std::uint32_t>(chunks);
    GRIDIRON_TRY(transfers_.get(table.entries, MainAddress{store_.frame.engine.macro_table_address}, count * kLineBytes,
                                kSetupTag));
    for (std::uint32_t chunk = 0; chunk < count; ++chunk) table.chunk_of_slot[chunk] = chunk;
    return transfers_.wait(kSetupTag);
  }

  Store& store_;
  Transfers<P>& transfers_;
  bool table_resident_ = false;
};

/// Without packets there is no code for eye rays, and no memory.
struct NoGridCore {
  /// @cond
  template <class Store, class Moves>
  NoGridCore(Store&, Moves&) {}
  [[nodiscard]] Status begin() { return Status::kOk; }
  void begin_tile() {}
  [[nodiscard]] Status trace_eyes(const TileView&, const Hits&) { return Status::kBadFrame; }
  /// @endcond
};

/// @cond
template <class Layout, bool kHas = kHasPackets<Layout>>
struct GridEyeStoreOf {
  using Type = GridEyeStore<Layout>;
};
template <class Layout>
struct GridEyeStoreOf<Layout, false> {
  using Type = NoGridStore;
};
template <class L, class Store, Platform P, bool kHas>
struct GridCoreOf {
  using Type = GridCore<L, Store, P>;
};
template <class L, class Store, Platform P>
struct GridCoreOf<L, Store, P, false> {
  using Type = NoGridCore;
};
/// @endcond

/// The grid as a layout names it.
struct GridEngine {
  static constexpr std::uint32_t kId = static_cast<std::uint32_t>(EngineId::kGrid);
  using Record = GridFrame;
  template <class Layout>
  using Store = std::conditional_t<kHasPackets<Layout>, GridStore<Layout>, NoGridStore>;
  template <class Layout>
  using EyeStore = typename GridEyeStoreOf<Layout>::Type;
  template <class Layout>
  static constexpr bool kTracesEyes = kHasPackets<Layout>;
  template <class L, class Store, Platform P>
  using Core = typename GridCoreOf<L, Store, P, kHasPackets<typename Store::Layout>>::Type;
};

}  // namespace gridiron
