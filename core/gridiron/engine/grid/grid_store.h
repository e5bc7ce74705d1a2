// The grid engine's part of a local store: its table for the whole frame, a packet and buffers while eye rays are
// traced.
// Memory: is the memory. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/dma/tags.h>
#include <gridiron/dma/transfers.h>
#include <gridiron/engine/engine.h>
#include <gridiron/engine/grid/macro_table.h>
#include <gridiron/engine/grid/mailbox.h>
#include <gridiron/platform/contract.h>
#include <gridiron/ray/packet.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace gridiron {

/// Whether a layout has packets, for eye rays; else its engine of other rays traces them too.
template <class Layout>
inline constexpr bool kHasPackets = Layout::kPacketWidth != 0;

/// @cond
template <class Layout>
struct GridPacketParts {
  static_assert(Layout::kTileWidth % Layout::kPacketWidth == 0);
  using StorePacket = Packet<Layout::kPacketWidth, Layout::kRecentTriangles>;
  using StoreMailbox = Mailbox<Layout::kMailboxSlots>;
};
/// @endcond

/// Memory for the whole frame.
template <class Layout>
struct alignas(128) GridStore {
  MacroTableWindow<Layout::kTableEntries> table;

  /// Calls visit(name, offset_bytes, bytes) for every region, in address order.
  template <class Visit>
  static constexpr void for_each_region(Visit&& visit) {
    visit("macro_table", offsetof(GridStore, table), sizeof(GridStore::table));
  }
};
/// Without packets no ray goes through the grid.
struct NoGridStore {
  /// @cond
  template <class Visit>
  static constexpr void for_each_region(Visit&&) {}
  /// @endcond
};

/// Memory while eye rays are traced: the packet, and what is fetched for it. Cell blocks start on lines in main memory
/// and here. Triangle runs start anywhere on 16 bytes, so their buffers are 32 bytes longer.
template <class Layout>
struct alignas(128) GridEyeStore : GridPacketParts<Layout>::StorePacket {
  /// @cond
  static constexpr std::uint32_t kMacroCells = Layout::kMaxMacroWidth * Layout::kMaxMacroWidth * Layout::kMaxMacroWidth;
  static constexpr std::uint32_t kCellBlockBytes =
      (kMacroCells * static_cast<std::uint32_t>(sizeof(CellRecord)) + kLineBytes - 1) / kLineBytes * kLineBytes;
  static constexpr std::uint32_t kTriangleBufferBytes =
      (Layout::kTrianglesPerBuffer * kTriangleRecordBytes + 32 + kLineBytes - 1) / kLineBytes * kLineBytes;
  static_assert(Layout::kMaxMacroDepth <= kMacroTagCount);
  static_assert(Layout::kMaxTriangleDepth <= kTriangleTagCount);

  struct alignas(128) CellBlock {
    std::byte bytes[kCellBlockBytes];
  };
  struct alignas(128) TriangleBuffer {
    std::byte bytes[kTriangleBufferBytes];
  };
  /// @endcond

  CellBlock cell_blocks[Layout::kMaxMacroDepth];
  TriangleBuffer triangles[Layout::kMaxTriangleDepth];
  typename GridPacketParts<Layout>::StoreMailbox mailbox;

  // A packet has a base. Compilers warn of offsetof on such a type, but support it.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Winvalid-offsetof"
  /// Calls visit(name, offset_bytes, bytes) for every region, in address order.
  template <class Visit>
  static constexpr void for_each_region(Visit&& visit) {
    visit("packet", 0, sizeof(typename GridPacketParts<Layout>::StorePacket));
    visit("cell_blocks", offsetof(GridEyeStore, cell_blocks), sizeof(GridEyeStore::cell_blocks));
    visit("triangles", offsetof(GridEyeStore, triangles), sizeof(GridEyeStore::triangles));
    visit("mailbox", offsetof(GridEyeStore, mailbox), sizeof(GridEyeStore::mailbox));
  }
#pragma GCC diagnostic pop
};

/// Fetches a chunk of the macrocell table into its slot.
template <class Store, Platform P>
[[nodiscard]] Status fetch_chunk(Store& store, Transfers<P>& transfers, std::uint32_t chunk) {
  auto& table = store.engine.table;
  using Table = std::remove_reference_t<decltype(table)>;
  const std::uint32_t slot = Table::slot_of(chunk);
  const MainAddress address{store.frame.engine.macro_table_address + std::uint64_t{chunk} * kLineBytes};
  GRIDIRON_TRY(transfers.get(table.entries + slot * Table::kChunkEntries, address, kLineBytes, kSetupTag));
  GRIDIRON_TRY(transfers.wait(kSetupTag));
  table.chunk_of_slot[slot] = chunk;
  return Status::kOk;
}

}  // namespace gridiron
