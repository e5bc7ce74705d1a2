// The grid engine's part of a local store: buffers for the whole frame, a packet while eye rays are traced, walks while
// other rays are.
// Memory: is the memory. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/records.h>
#include <gridiron/dma/tags.h>
#include <gridiron/dma/transfers.h>
#include <gridiron/engine/engine.h>
#include <gridiron/engine/grid/macro_table.h>
#include <gridiron/engine/grid/mailbox.h>
#include <gridiron/engine/grid/walk.h>
#include <gridiron/platform/contract.h>
#include <gridiron/ray/packet.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace gridiron {

/// @cond
/// Takes the packet's place in a layout without packets, which traces eye rays by walks, like all others.
struct NoPacket {
  static constexpr std::uint32_t kRayCount = 32;
};
struct NoMailbox {};

template <class Layout, bool kHas = kHasPackets<Layout>>
struct GridPacketParts {
  using StorePacket = NoPacket;
  using StoreMailbox = NoMailbox;
};
template <class Layout>
struct GridPacketParts<Layout, true> {
  static_assert(Layout::kTileWidth % Layout::kPacketWidth == 0);
  using StorePacket = Packet<Layout::kPacketWidth, Layout::kRecentTriangles>;
  using StoreMailbox = Mailbox<Layout::kMailboxSlots>;
};
/// @endcond

/// Memory for the whole frame. Cell blocks start on lines in main memory and here. Triangle runs start anywhere on 16
/// bytes, so their buffers are 16 bytes longer.
template <class Layout>
struct alignas(128) GridStore {
  /// @cond
  static constexpr std::uint32_t kMacroCells = Layout::kMaxMacroWidth * Layout::kMaxMacroWidth * Layout::kMaxMacroWidth;
  static constexpr std::uint32_t kCellBlockBytes =
      (kMacroCells * static_cast<std::uint32_t>(sizeof(CellRecord)) + kLineBytes - 1) / kLineBytes * kLineBytes;
  static constexpr std::uint32_t kTriangleBufferBytes =
      (Layout::kTrianglesPerBuffer * kTriangleRecordBytes + 32 + kLineBytes - 1) / kLineBytes * kLineBytes;
  static_assert(Layout::kEffects == 0 || kTriangleBufferBytes >= kIdleBufferBytes);
  static_assert(Layout::kMaxMacroDepth <= kMacroTagCount);
  static_assert(Layout::kMaxTriangleDepth <= kTriangleTagCount);

  struct alignas(128) CellBlock {
    std::byte bytes[kCellBlockBytes];
  };
  struct alignas(128) TriangleBuffer {
    std::byte bytes[kTriangleBufferBytes];
  };
  using StoreMailbox = typename GridPacketParts<Layout>::StoreMailbox;
  /// @endcond

  MacroTableWindow<Layout::kTableEntries> table;
  CellBlock cell_blocks[Layout::kMaxMacroDepth];
  TriangleBuffer triangles[Layout::kMaxTriangleDepth];
  [[no_unique_address]] StoreMailbox mailbox;

  /// A buffer to gather records in while no ray is traced. @param slot  below Layout::kMaxTriangleDepth.
  [[nodiscard]] std::byte* idle_buffer(std::uint32_t slot) { return triangles[slot].bytes; }

  /// Calls visit(name, offset_bytes, bytes) for every region, in address order.
  template <class Visit>
  static constexpr void for_each_region(Visit&& visit) {
    visit("macro_table", offsetof(GridStore, table), sizeof(GridStore::table));
    visit("cell_blocks", offsetof(GridStore, cell_blocks), sizeof(GridStore::cell_blocks));
    visit("triangles", offsetof(GridStore, triangles), sizeof(GridStore::triangles));
    if constexpr (kHasPackets<Layout>) visit("mailbox", offsetof(GridStore, mailbox), sizeof(GridStore::mailbox));
  }
};

/// Memory while rays other than eye rays are traced.
template <class Layout>
struct alignas(128) GridRayStore {
  Walk walks[kWalkCount<Layout>];
  alignas(32) std::byte surface_bytes[sizeof(SurfaceRecord) + 16];  ///< a surface that a tie is settled with
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
