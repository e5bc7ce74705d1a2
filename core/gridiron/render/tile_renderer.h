// The entry point of a core: claim a tile, trace its packets, put the pixels, until no tile is left.
// Source: Cho, Kim, Han 2012, sections 2, 4 and 5. Memory: the local store the caller places; nothing else.
// Threads: one core; cores share nothing but the frame in main memory. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/accuracies.h>
#include <gridiron/base/records.h>
#include <gridiron/dma/transfers.h>
#include <gridiron/engine/grid/frustum.h>
#include <gridiron/engine/grid/packet_driver.h>
#include <gridiron/platform/contract.h>
#include <gridiron/ray/camera.h>
#include <gridiron/shade/effect_renderer.h>
#include <gridiron/shade/shading.h>
#include <gridiron/store/local_store.h>

#include <cstdint>
#include <initializer_list>
#include <type_traits>

namespace gridiron {

/// Renders tiles of one frame on one core.
///
/// @tparam L       lane type, Lanes<4>, Lanes<8> or Lanes<16>, without packets Lanes<1> too; changes no pixel.
/// @tparam Layout  sizes of the local store.
template <class L, class Layout, Platform P>
class TileRenderer {
 public:
  /// Borrows store and platform for as long as it lives.
  TileRenderer(LocalStore<Layout>& store, P& platform, SpillRegion spill)
      : store_(store), transfers_(platform, store.work), effects_(make_effects(spill)) {}

  /// Renders every tile this core can claim of the frame whose FrameRecord lies at `frame`.
  ///
  /// Errors: kBadFrame, kUnsupportedFrame, kUnsupportedImage, kMissingEffect, kSpillTooSmall before the first
  /// claim; kAborted, kDeadline between tiles; whatever the platform's transfers report. All transfers have been waited
  /// for when kOk is returned.
  [[nodiscard]] Status run(MainAddress frame) {
    // 1. What every core needs: the frame, and the macrocell table where it fits.
    store_.work = WorkCounters{};
    GRIDIRON_TRY(transfers_.get(&store_.frame, frame, sizeof(FrameRecord), kSetupTag));
    GRIDIRON_TRY(transfers_.wait(kSetupTag));
    GRIDIRON_TRY(check_frame());
    GRIDIRON_TRY(load_table());
    if constexpr (kHasEffects) {
      if (is_scene_shaded()) GRIDIRON_TRY(effects_.begin_frame());
    }
    share_queue();
    // 2. Tiles.
    for (TileClaim claim = transfers_.claim_tile();; claim = transfers_.claim_tile()) {
      if (claim.kind == TileClaim::Kind::kAborted) return finish(Status::kAborted);
      if (claim.kind == TileClaim::Kind::kDeadline) return finish(Status::kDeadline);
      if (claim.kind == TileClaim::Kind::kNone) return finish(Status::kOk);
      GRIDIRON_TRY(render_tile(claim.tile_id));
    }
  }

 private:
  using Store = LocalStore<Layout>;
  using StorePacket = typename LocalStore<Layout>::StorePacket;
  using Table = MacroTableWindow<Layout::kTableEntries>;
  using TileOutput = typename Store::TileOutput;
  static constexpr std::uint32_t kPlaneBytes = Store::kTilePixels * sizeof(std::uint32_t);

  // Traces and shades one tile; its pixels are on their way when this returns.
  [[nodiscard]] Status render_tile(std::uint32_t tile_id) {
    const FrameRecord& frame = store_.frame;
    if (tile_id >= frame.tiles_x * frame.tiles_y) return Status::kBadFrame;
    store_.work.add(Work::kTileStart);
    if (!table_resident_) store_.table.forget();
    const std::uint32_t left = tile_id % frame.tiles_x * Layout::kTileWidth;
    const std::uint32_t top = tile_id / frame.tiles_x * Layout::kTileWidth;

    // The output buffer's last tile must have left.
    const std::uint32_t slot = output_slot_;
    const std::uint8_t tag = output_tag(slot);
    output_slot_ = output_slot_ + 1 == frame.output_depth ? 0 : output_slot_ + 1;
    GRIDIRON_TRY(transfers_.wait(tag));

    if (is_scene_shaded()) {
      if constexpr (kHasEffects) GRIDIRON_TRY(render_effects(left, top, store_.output[slot]));
    } else if constexpr (kHasPackets<Layout>) {
      GRIDIRON_TRY(trace_tile(left, top, {}, [&](std::uint32_t x, std::uint32_t y) {
        shade_packet<L>(frame, store_.packet, x, y, store_.output[slot], store_.work);
      }));
    }
    store_.work.charge_to(Work::kTileStart);
    GRIDIRON_TRY(put_tile(tile_id, slot, tag));
    return waits_for_output_ ? transfers_.wait(tag) : Status::kOk;
  }

  // Traces the packets of a tile; done(x, y) is told each, by its first pixel in the tile.
  template <class Done>
  [[nodiscard]] Status trace_tile(std::uint32_t left, std::uint32_t top, PixelOffset offset, Done&& done) {
    const FrameRecord& frame = store_.frame;
    for (std::uint32_t y = 0; y < Layout::kTileWidth && top + y < frame.height; y += Layout::kPacketWidth) {
      for (std::uint32_t x = 0; x < Layout::kTileWidth && left + x < frame.width; x += Layout::kPacketWidth) {
        GRIDIRON_TRY(trace_packet(left + x, top + y, offset));
        done(x, y);
      }
    }
    return Status::kOk;
  }

  // A tile as the scene shades it: eye rays and what becomes of them, sample by sample. Depth and ids are those of the
  // first.
  [[nodiscard]] Status render_effects(std::uint32_t left, std::uint32_t top, TileOutput& output) {
    effects_.begin_tile(left, top);
    const std::uint32_t sample_count = effects_.samples_per_pixel();
    for (std::uint32_t sample = 0; sample < sample_count; ++sample) {
      store_.work.charge_to(Work::kColorGroup);
      if constexpr (kHasPackets<Layout>) {
        GRIDIRON_TRY(trace_tile(left, top, pixel_offset(sample_count, sample), [&](std::uint32_t x, std::uint32_t y) {
          if (sample == 0) shade_packet<L>(store_.frame, store_.packet, x, y, output, store_.work);
          keep_hits(store_.packet, x, y, Layout::kTileWidth, store_.effects.hit_ids, store_.work);
        }));
      }
      GRIDIRON_TRY(effects_.shade_sample(sample));
      if constexpr (!kHasPackets<Layout>) {
        if (sample == 0) copy_words(store_.effects.hit_ids, output.id);
      }
    }
    effects_.finish_tile(output.color);
    return Status::kOk;
  }

  // What is waited for during a tile must not depend on the tiles before it: either those have places of their own in
  // the queue, or, where it is too short for that, a tile has left before the next one begins.
  void share_queue() {
    const FrameRecord& frame = store_.frame;
    std::uint32_t commands = 0;
    for (const std::uint64_t plane : {frame.color_address, frame.depth_address, frame.id_address}) {
      constexpr std::uint32_t kPieces = (kPlaneBytes + kPortableBoundaryBytes - 1) / kPortableBoundaryBytes;
      if (plane != 0) commands += kPieces + (plane % kPortableBoundaryBytes != 0 ? 1 : 0);
    }
    commands *= frame.output_depth;
    waits_for_output_ = frame.output_depth == 1 || commands + kLeastInputCommands > transfers_.queue_depth();
    if (!waits_for_output_) transfers_.reserve_for_output(commands);
  }

  // Generates a packet and traces it. Distances that nobody asks for are estimated; rays for which that leaves open
  // what they hit are traced again, with exact ones. Where ties are to be broken, a ray of which one still is open goes
  // alone: then its nearest triangle stays at hand.
  [[nodiscard]] Status trace_packet(std::uint32_t left, std::uint32_t top, PixelOffset offset) {
    RaySet<StorePacket::kRayCount> waiting;
    generate_packet<L>(store_.frame, left, top, store_.packet, waiting, store_.work, offset.dx, offset.dy);
    store_.work.charge_to(Work::kPacketStart);
    GRIDIRON_TRY(trace_rays(waiting));
    if (!take_unsure_rays(store_.packet, store_.frame.t_far, waiting)) [[likely]]
      return Status::kOk;
    GRIDIRON_TRY(trace_rays(waiting));
    if (!store_.packet.breaks_ties) return Status::kOk;
    RaySet<StorePacket::kRayCount> open;
    if (!take_unsure_rays(store_.packet, store_.frame.t_far, open)) return Status::kOk;
    for (std::uint32_t ray = 0; ray < StorePacket::kRayCount; ++ray) {
      if (!open.contains(ray)) continue;
      waiting.clear();
      waiting.insert(ray);
      GRIDIRON_TRY(trace_rays(waiting));
    }
    return Status::kOk;
  }

  // Takes rays through the grid, once per march axis and sign that they have.
  [[nodiscard]] GRIDIRON_OUTLINE Status trace_rays(RaySet<StorePacket::kRayCount>& waiting) {
    store_.mailbox.clear();
    Frustum frustum;
    while (take_pass<L>(store_.frame.grid, waiting, store_.packet, frustum, store_.work)) {
      PacketDriver<L, LocalStore<Layout>, P> driver(store_, transfers_, frustum);
      GRIDIRON_TRY(driver.run());
      store_.work.charge_to(Work::kPacketStart);
      // The next pass has other rays: what this one has seen says nothing about them.
      store_.mailbox.clear();
    }
    return Status::kOk;
  }

  [[nodiscard]] Status put_tile(std::uint32_t tile_id, std::uint32_t slot, std::uint8_t tag) {
    const FrameRecord& frame = store_.frame;
    const TileOutput& output = store_.output[slot];
    const std::uint64_t offset = std::uint64_t{tile_id} * kPlaneBytes;
    GRIDIRON_TRY(transfers_.put(output.color, MainAddress{frame.color_address + offset}, kPlaneBytes, tag));
    if (frame.depth_address != 0) {
      GRIDIRON_TRY(transfers_.put(output.depth, MainAddress{frame.depth_address + offset}, kPlaneBytes, tag));
    }
    if (frame.id_address != 0) {
      GRIDIRON_TRY(transfers_.put(output.id, MainAddress{frame.id_address + offset}, kPlaneBytes, tag));
    }
    return Status::kOk;
  }

  // The scene image was validated when it was loaded; here the frame is held against what this store can do.
  [[nodiscard]] Status check_frame() const {
    const FrameRecord& frame = store_.frame;
    if (frame.magic != kFrameMagic || frame.version != kFrameVersion) return Status::kBadFrame;
    if (frame.width == 0 || frame.height == 0 || frame.width > kMaxPictureWidth || frame.height > kMaxPictureWidth) {
      return Status::kBadFrame;
    }
    if (frame.tile_width != Layout::kTileWidth) return Status::kUnsupportedFrame;
    if (frame.tiles_x != (frame.width + Layout::kTileWidth - 1) / Layout::kTileWidth ||
        frame.tiles_y != (frame.height + Layout::kTileWidth - 1) / Layout::kTileWidth) {
      return Status::kBadFrame;
    }
    const auto in_range = [](std::uint32_t depth, std::uint32_t most) { return depth >= 1 && depth <= most; };
    if (!in_range(frame.output_depth, Layout::kMaxOutputDepth) ||
        !in_range(frame.macro_depth, Layout::kMaxMacroDepth) ||
        !in_range(frame.triangle_depth, Layout::kMaxTriangleDepth)) {
      return Status::kUnsupportedFrame;
    }
    if (!(frame.t_far > 0.0f) || frame.color_address == 0) return Status::kBadFrame;
    if (frame.accuracy >= kAccuracyCount || frame.shading > static_cast<std::uint32_t>(Shading::kScene)) {
      return Status::kUnsupportedFrame;
    }
    if (is_scene_shaded() && !kHasEffects) return Status::kMissingEffect;
    // Without packets there is no other shading, and no exact distance of eye rays.
    if (!kHasPackets<Layout> && (!is_scene_shaded() || frame.depth_address != 0)) return Status::kUnsupportedFrame;
    const GridRecord& grid = frame.grid;
    if (!reads_format(frame.accuracy, grid.triangle_format)) return Status::kUnsupportedImage;
    if (grid.macro_width == 0 || grid.macro_width > Layout::kMaxMacroWidth ||
        grid.cell_block_bytes > Store::kCellBlockBytes) {
      return Status::kUnsupportedImage;
    }
    return Status::kOk;
  }

  [[nodiscard]] Status load_table() {
    const GridRecord& grid = store_.frame.grid;
    const std::uint64_t macro_cells =
        std::uint64_t{grid.macro_cell_count[0]} * grid.macro_cell_count[1] * grid.macro_cell_count[2];
    const std::uint64_t chunks = (macro_cells + 32 * Table::kChunkEntries - 1) / (32 * Table::kChunkEntries);
    store_.table.forget();
    table_resident_ = chunks <= Table::kChunkCount;
    if (!table_resident_) return Status::kOk;
    const std::uint32_t count = static_cast<std::uint32_t>(chunks);
    GRIDIRON_TRY(transfers_.get(store_.table.entries, MainAddress{store_.frame.macro_table_address}, count * kLineBytes,
                                kSetupTag));
    for (std::uint32_t chunk = 0; chunk < count; ++chunk) store_.table.chunk_of_slot[chunk] = chunk;
    return transfers_.wait(kSetupTag);
  }

  // Waits for the tiles still on their way, the oldest first: the order does not tell how many tiles this core had.
  [[nodiscard]] Status finish(Status outcome) {
    for (std::uint32_t i = 0; i < store_.frame.output_depth; ++i) {
      GRIDIRON_TRY(transfers_.wait(output_tag(output_slot_)));
      output_slot_ = output_slot_ + 1 == store_.frame.output_depth ? 0 : output_slot_ + 1;
    }
    return outcome;
  }

  static constexpr bool kHasEffects = Layout::kEffects != 0;
  struct NoEffects {};
  using Effects = std::conditional_t<kHasEffects, EffectRenderer<L, LocalStore<Layout>, P>, NoEffects>;

  [[nodiscard]] Effects make_effects([[maybe_unused]] SpillRegion spill) {
    if constexpr (kHasEffects) {
      return Effects(store_, transfers_, spill);
    } else {
      return Effects{};
    }
  }
  [[nodiscard]] bool is_scene_shaded() const {
    return store_.frame.shading == static_cast<std::uint32_t>(Shading::kScene);
  }

  Store& store_;
  Transfers<P> transfers_;
  [[no_unique_address]] Effects effects_;
  std::uint32_t output_slot_ = 0;
  bool table_resident_ = false;
  bool waits_for_output_ = true;
};

/// Renders tiles of the frame at `frame` on the calling core until none is left. See TileRenderer.
///
/// @param spill  main memory of this core alone, for a frame with effects.
template <class L, class Layout, Platform P>
[[nodiscard]] Status render_tiles(LocalStore<Layout>& store, P& platform, MainAddress frame,
                                  SpillRegion spill = {}) {
  TileRenderer<L, Layout, P> renderer(store, platform, spill);
  return renderer.run(frame);
}

/// @returns the EffectBits that a renderer lacks. Precondition: render_tiles has returned kMissingEffect for `store`.
/// Built for no effect at all, it has not read the scene's and knows of kSceneShading alone.
template <class Layout>
[[nodiscard]] std::uint32_t missing_effects(const LocalStore<Layout>& store) {
  if constexpr (Layout::kEffects != 0) {
    return store.effects.scene.called_for & ~Layout::kEffects;
  } else {
    return kSceneShading;
  }
}

}  // namespace gridiron
