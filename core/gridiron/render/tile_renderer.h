// The entry point of a core: claim a tile, have its rays traced, shade, put the pixels, until no tile is left.
// Source: Cho, Kim, Han 2012, section 2. Memory: the local store that the caller places, and this core's spill region.
// Threads: one core; cores share frame, scene and picture in main memory. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/frame_rules.h>
#include <gridiron/base/records.h>
#include <gridiron/dma/transfers.h>
#include <gridiron/engine/engine.h>
#include <gridiron/platform/contract.h>
#include <gridiron/ray/hits.h>
#include <gridiron/shade/effect_renderer.h>
#include <gridiron/shade/shading.h>
#include <gridiron/store/local_store.h>

#include <cstdint>
#include <initializer_list>
#include <type_traits>

namespace gridiron {

/// Renders tiles of one frame on one core.
///
/// @tparam L       Lanes<4>, Lanes<8> or Lanes<16>, in layouts without packets Lanes<1> too; it changes no pixel.
/// @tparam Layout  sizes of the local store.
template <class L, class Layout, Platform P>
class TileRenderer {
 public:
  /// Borrows store and platform for as long as it lives.
  TileRenderer(LocalStore<Layout>& store, P& platform, SpillRegion spill)
      : store_(store), transfers_(platform, store.work), engine_(store, transfers_), effects_(make_effects(spill)) {}

  /// Renders every tile that this core can claim of the frame whose record lies at `frame`. Called once.
  ///
  /// Errors: kBadFrame, kUnsupportedFrame, kUnsupportedImage, kMissingEffect, kSpillTooSmall before the first claim;
  /// kAborted, kDeadline between tiles; at any time those of transfers, and kBadFrame if a claimed tile is not of the
  /// frame. After kOk, kAborted and kDeadline no transfer is pending; after other errors some may be.
  [[nodiscard]] Status run(MainAddress frame) {
    // 1. What every core needs: the frame, and what the engine keeps for all tiles.
    store_.work = WorkCounters{};
    GRIDIRON_TRY(transfers_.get(&store_.frame, frame, sizeof store_.frame, kSetupTag));
    GRIDIRON_TRY(transfers_.wait(kSetupTag));
    GRIDIRON_TRY(check_frame());
    GRIDIRON_TRY(engine_.begin());
    if constexpr (kHasEffects) {
      if (is_scene_shaded()) GRIDIRON_TRY(effects_.begin_frame());
    }
    share_queue();
    // 2. Tiles: an item is a tile of the picture, row-major, 0 = top left.
    for (;;) {
      const ItemClaim claim = transfers_.claim_item();
      if (claim.kind == ItemClaim::Kind::kAborted) return finish(Status::kAborted);
      if (claim.kind == ItemClaim::Kind::kDeadline) return finish(Status::kDeadline);
      if (claim.kind == ItemClaim::Kind::kNone) return finish(Status::kOk);
      GRIDIRON_TRY(render_tile(claim.item));
    }
  }

 private:
  using Store = LocalStore<Layout>;
  using Core = typename Layout::Engine::template Core<L, Store, P>;
  static_assert(EngineCore<Core>);
  using TileOutput = typename Store::TileOutput;
  static constexpr std::uint32_t kPlaneBytes = Store::kTilePixels * sizeof(std::uint32_t);

  // Traces and shades one tile; its pixels are on their way when this returns.
  [[nodiscard]] Status render_tile(std::uint32_t tile_id) {
    const FrameHead& frame = store_.frame;
    if (tile_id >= frame.tiles_x * frame.tiles_y) return Status::kBadFrame;
    store_.work.add(Work::kTileStart);
    engine_.begin_tile();
    const std::uint32_t left = tile_id % frame.tiles_x * Layout::kTileWidth;
    const std::uint32_t top = tile_id / frame.tiles_x * Layout::kTileWidth;

    // The tile that was in this buffer before must have arrived in main memory.
    const std::uint32_t slot = output_slot_;
    const std::uint8_t tag = output_tag(slot);
    output_slot_ = output_slot_ + 1 == frame.output_depth ? std::uint32_t{0} : output_slot_ + 1;
    GRIDIRON_TRY(transfers_.wait(tag));

    TileOutput& output = store_.output[slot];
    if (is_scene_shaded()) {
      if constexpr (kHasEffects) GRIDIRON_TRY(render_effects(left, top, output));
    } else if constexpr (kTracesEyes<Layout>) {
      GRIDIRON_TRY(render_hits(left, top, output));
    }
    store_.work.charge_to(Work::kTileStart);  // for tools/calibrate; nothing on a core
    GRIDIRON_TRY(put_tile(tile_id, slot, tag));
    return waits_for_output_ ? transfers_.wait(tag) : Status::kOk;
  }

  // Renders a tile without effects. Distances and ids are planes of the output already; the engine writes facing where
  // colours go, and shading turns each word into a colour.
  [[nodiscard]] Status render_hits(std::uint32_t left, std::uint32_t top, TileOutput& output) {
    const FrameHead& frame = store_.frame;
    Hits hits{output.id, frame.depth_address != 0 ? output.depth : nullptr, nullptr};
    if (frame.shading == static_cast<std::uint32_t>(Shading::kSimple)) {
      hits.facing = reinterpret_cast<float*>(output.color);
    }
    if (is_at_edge(left, top)) {
      clear_plane(output.id, kNoTriangle);
      if (hits.distance != nullptr) clear_plane(output.depth, kFloatMax);
      if (hits.facing != nullptr) clear_plane(output.color, std::uint32_t{0});
    }
    GRIDIRON_TRY(engine_.trace_eyes({left, top, 0.0f, 0.0f}, hits));
    shade_hits<L>(frame, hits, Store::kTilePixels, output.color, store_.work);
    return Status::kOk;
  }

  // Renders a tile as the scene shades it: eye rays and their secondary rays, sample by sample. Depth and ids are those
  // of the first sample.
  [[nodiscard]] Status render_effects(std::uint32_t left, std::uint32_t top, TileOutput& output) {
    const FrameHead& frame = store_.frame;
    effects_.begin_tile(left, top);
    if (is_at_edge(left, top)) {
      clear_plane(output.id, kNoTriangle);
      if (frame.depth_address != 0) clear_plane(output.depth, kFloatMax);
    }
    const std::uint32_t sample_count = effects_.samples_per_pixel();
    // Without code for eye rays shade_sample() traces them too.
    for (std::uint32_t sample = 0; sample < sample_count; ++sample) {
      store_.work.charge_to(Work::kColorGroup);
      std::uint32_t* const ids = sample == 0 ? output.id : store_.effects.hit_ids;
      if constexpr (kTracesEyes<Layout>) {
        const PixelOffset offset = pixel_offset(sample_count, sample);
        const bool has_depth = sample == 0 && frame.depth_address != 0;
        GRIDIRON_TRY(
            engine_.trace_eyes({left, top, offset.dx, offset.dy}, {ids, has_depth ? output.depth : nullptr, nullptr}));
      }
      GRIDIRON_TRY(effects_.shade_sample(sample, ids));
    }
    effects_.finish_tile(output.color);
    return Status::kOk;
  }

  // Pixels of a tile outside of the picture have no rays, but their words are put with the tile.
  [[nodiscard]] bool is_at_edge(std::uint32_t left, std::uint32_t top) const {
    return left + Layout::kTileWidth > store_.frame.width || top + Layout::kTileWidth > store_.frame.height;
  }
  template <class Word, class Value>
  void clear_plane(Word (&plane)[Store::kTilePixels], Value value) {
    store_.work.add(Work::kIdGroup, Store::kTilePixels / 4);
    store_.work.charge_to(Work::kIdGroup);
    fill_words(plane, Word{value});
  }

  // So that cycles repeat, the waits during a tile must not depend on the tiles before it. So either puts of tiles have
  // places of their own in the queue, or, if it is too short for that, a tile has left before the next one begins.
  void share_queue() {
    const FrameHead& frame = store_.frame;
    std::uint32_t commands = 0;
    for (const std::uint64_t plane : {frame.color_address, frame.depth_address, frame.id_address}) {
      static constexpr std::uint32_t kPieces = (kPlaneBytes + kPortableBoundaryBytes - 1) / kPortableBoundaryBytes;
      if (plane != 0) commands += kPieces + (plane % kPortableBoundaryBytes != 0 ? 1 : 0);
    }
    commands *= frame.output_depth;
    waits_for_output_ = frame.output_depth == 1 || commands + kLeastInputCommands > transfers_.queue_depth();
    if (!waits_for_output_) transfers_.reserve_for_output(commands);
  }

  [[nodiscard]] Status put_tile(std::uint32_t tile_id, std::uint32_t slot, std::uint8_t tag) {
    const FrameHead& frame = store_.frame;
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

  [[nodiscard]] static constexpr std::uint32_t most_fetch_depth() {
    if constexpr (kHasEffects) {
      return Layout::RayEngine::template kMaxDepth<Layout>;
    } else {
      return 0;
    }
  }
  // Limits of this store.
  struct Limits : Layout {
    static constexpr std::uint32_t kLeastTileWidth = Layout::kTileWidth;
    static constexpr std::uint32_t kMostTileWidth = Layout::kTileWidth;
    static constexpr std::uint32_t kMaxFetchDepth = most_fetch_depth();
    static constexpr Status kBeyond = Status::kUnsupportedFrame;
  };

  // The scene image was validated when it was loaded; here the frame is checked against the store's limits.
  [[nodiscard]] GRIDIRON_OUTLINE Status check_frame() const {
    const FrameHead& frame = store_.frame;
    GRIDIRON_TRY(find_picture_fault<Limits>(frame).status);
    if (frame.engine_id != Layout::Engine::kId) return Status::kUnsupportedFrame;
    if (is_scene_shaded() && !kHasEffects) return Status::kMissingEffect;
    // Without code for eye rays only Shading::kScene is possible, and no plane of distances.
    if (!kTracesEyes<Layout> && (!is_scene_shaded() || frame.depth_address != 0)) return Status::kUnsupportedFrame;
    if (!kHasEffects) return Status::kOk;
    return find_scene_fault<Limits>(frame).status;
  }

  // Waits for all output slots, the oldest first; that order does not depend on the number of tiles this core had.
  [[nodiscard]] Status finish(Status outcome) {
    for (std::uint32_t i = 0; i < store_.frame.output_depth; ++i) {
      GRIDIRON_TRY(transfers_.wait(output_tag(output_slot_)));
      output_slot_ = output_slot_ + 1 == store_.frame.output_depth ? std::uint32_t{0} : output_slot_ + 1;
    }
    return outcome;
  }

  static constexpr bool kHasEffects = Layout::kEffects != 0;
  struct NoEffects {};
  using Effects = std::conditional_t<kHasEffects, EffectRenderer<L, Store, P>, NoEffects>;

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
  Core engine_;
  [[no_unique_address]] Effects effects_;
  std::uint32_t output_slot_ = 0;
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

/// @returns the EffectBits that a renderer lacks. Precondition: render_tiles has returned kMissingEffect for `store`. A
/// renderer built without effects does not read the scene's, and reports kSceneShading alone.
template <class Layout>
[[nodiscard]] std::uint32_t missing_effects(const LocalStore<Layout>& store) {
  if constexpr (Layout::kEffects != 0) {
    return store.effects.scene.called_for & ~Layout::kEffects;
  } else {
    return kSceneShading;
  }
}

}  // namespace gridiron
