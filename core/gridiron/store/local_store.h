// The local store: all memory that a core works in, as one struct in address order.
// Memory: is the memory. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/dma/tags.h>
#include <gridiron/engine/engine.h>
#include <gridiron/engine/grid/grid_engine.h>
#include <gridiron/engine/tree/tile_engine.h>
#include <gridiron/engine/tree/tree_engine.h>
#include <gridiron/platform/contract.h>
#include <gridiron/shade/effect_store.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace gridiron {

// A layout is a set of sizes; none changes a pixel, except in `paper` and `fast`. The tile's width is a template
// parameter; kFitsArena checks which widths a core can hold. The reference documents the members of one layout; the
// others have the same.

/// Sizes of a 256 KB core (Cho, Kim, Han 2012, section 6).
/// @tparam PacketWidthV  rays along a packet's edge: 4, 8, 16, 32, at most the tile's width.
/// @tparam TileWidthV    pixels along a tile's edge: 8, 16, 32, 64.
template <std::uint32_t PacketWidthV = 8, std::uint32_t TileWidthV = 32>
struct StoreLayout256K {
  using Engine = GridEngine;                                    ///< what traces its rays
  static constexpr std::uint32_t kEffects = 0;                  ///< EffectBits it is built for
  static constexpr std::uint32_t kArenaBytes = 256 * 1024;      ///< local memory of a core
  static constexpr std::uint32_t kCodeBudgetBytes = 54 * 1024;  ///< of it for code: check_budgets proves it
  static constexpr std::uint32_t kStackBudgetBytes = 8960;      ///< of it for the stack
  static constexpr std::uint32_t kTileWidth = TileWidthV;       ///< pixels along a tile's edge
  static constexpr std::uint32_t kPacketWidth = PacketWidthV;   ///< rays along a packet's edge; 0: no packets
  /// Triangles that a packet remembers having tested.
  static constexpr std::uint32_t kMailboxSlots = PacketWidthV < 16                        ? 64
                                                 : PacketWidthV == 32 && TileWidthV != 64 ? 1024
                                                                                          : 256;
  /// Recently hit triangles that a packet keeps.
  static constexpr std::uint32_t kRecentTriangles = PacketWidthV == 32 && TileWidthV != 64 ? 256 : 32;
  static constexpr std::uint32_t kTableEntries = TileWidthV == 64 ? 4000 : 4096;  ///< 32 macrocells each
  static constexpr std::uint32_t kMaxMacroWidth = 8;        ///< cells along a macrocell's edge, at most
  static constexpr std::uint32_t kMaxMacroDepth = 4;        ///< buffers of cell blocks
  static constexpr std::uint32_t kTrianglesPerBuffer = 64;  ///< records
  static constexpr std::uint32_t kMaxTriangleDepth = TileWidthV == 64 ? 6 : 12;  ///< two tiles of 64 take 96 KB
  static constexpr std::uint32_t kMaxOutputDepth = 2;  ///< tiles that are made or on their way out
};

/// Sizes of a 64 KB core: smaller tiles and buffers. The code budget is for a core with vectors. Without vectors the
/// code of packets is too long for 64 KB, and a core requires EffectLayout64K.
template <std::uint32_t PacketWidthV = 8, std::uint32_t TileWidthV = 16>
struct StoreLayout64K {
  /// @cond
  using Engine = GridEngine;
  static constexpr std::uint32_t kEffects = 0;  ///< EffectBits it is built for
  static constexpr std::uint32_t kArenaBytes = 64 * 1024;
  static constexpr std::uint32_t kCodeBudgetBytes = PacketWidthV >= 16 ? 36 * 1024 + 256 : 32 * 1024 + 512;
  static constexpr std::uint32_t kStackBudgetBytes = PacketWidthV >= 16 ? 6 * 1024 - 128 : 6 * 1024;
  static constexpr std::uint32_t kTileWidth = TileWidthV;
  static constexpr std::uint32_t kPacketWidth = PacketWidthV;
  static constexpr std::uint32_t kMailboxSlots = PacketWidthV >= 16 ? 128 : 64;
  static constexpr std::uint32_t kRecentTriangles = PacketWidthV >= 16 ? 4 : 16;
  static constexpr std::uint32_t kTableEntries = PacketWidthV >= 16 ? 144 : 512;  ///< 32 macrocells each
  static constexpr std::uint32_t kMaxMacroWidth = 6;
  static constexpr std::uint32_t kMaxMacroDepth = 2;
  static constexpr std::uint32_t kTrianglesPerBuffer = PacketWidthV >= 16 ? 8 : 16;
  static constexpr std::uint32_t kMaxTriangleDepth = 4;
  static constexpr std::uint32_t kMaxOutputDepth = 2;
  /// @endcond
};

/// Sizes of a 128 KB core: tiles and packets of the 256 KB one, more but shorter buffers than that of 64 KB.
template <std::uint32_t PacketWidthV = 8, std::uint32_t TileWidthV = 32>
struct StoreLayout128K {
  /// @cond
  using Engine = GridEngine;
  static constexpr std::uint32_t kEffects = 0;  ///< EffectBits it is built for
  static constexpr std::uint32_t kArenaBytes = 128 * 1024;
  static constexpr std::uint32_t kCodeBudgetBytes = 53 * 1024;
  static constexpr std::uint32_t kStackBudgetBytes = 8 * 1024;
  static constexpr std::uint32_t kTileWidth = TileWidthV;
  static constexpr std::uint32_t kPacketWidth = PacketWidthV;
  static constexpr std::uint32_t kMailboxSlots = PacketWidthV >= 16 ? 256 : 64;
  static constexpr std::uint32_t kRecentTriangles = PacketWidthV >= 16 ? 4 : 32;
  static constexpr std::uint32_t kTableEntries = 512;  ///< 16,384 macrocells resident
  static constexpr std::uint32_t kMaxMacroWidth = 6;
  static constexpr std::uint32_t kMaxMacroDepth = 3;
  static constexpr std::uint32_t kTrianglesPerBuffer = 15;  ///< with room to start 16 bytes later, six lines
  static constexpr std::uint32_t kMaxTriangleDepth = 6;
  static constexpr std::uint32_t kMaxOutputDepth = 2;
  /// @endcond
};

/// Sizes of a 512 KB core: a longer table, more and longer buffers, a larger mailbox.
template <std::uint32_t PacketWidthV = 8, std::uint32_t TileWidthV = 32>
struct StoreLayout512K {
  /// @cond
  using Engine = GridEngine;
  static constexpr std::uint32_t kEffects = 0;  ///< EffectBits it is built for
  static constexpr std::uint32_t kArenaBytes = 512 * 1024;
  static constexpr std::uint32_t kCodeBudgetBytes = 54 * 1024;
  static constexpr std::uint32_t kStackBudgetBytes = 10 * 1024 + 512;
  static constexpr std::uint32_t kTileWidth = TileWidthV;
  static constexpr std::uint32_t kPacketWidth = PacketWidthV;
  static constexpr std::uint32_t kMailboxSlots = PacketWidthV >= 16 ? 1024 : 64;
  static constexpr std::uint32_t kRecentTriangles = PacketWidthV >= 16 ? 256 : 32;
  static constexpr std::uint32_t kTableEntries = 16384;  ///< 524,288 macrocells resident
  static constexpr std::uint32_t kMaxMacroWidth = 8;
  static constexpr std::uint32_t kMaxMacroDepth = 8;
  static constexpr std::uint32_t kTrianglesPerBuffer = 128;
  static constexpr std::uint32_t kMaxTriangleDepth = 15;
  static constexpr std::uint32_t kMaxOutputDepth = 2;
  /// @endcond
};

/// Sizes of a 256 KB core that traces eye rays through the tree: no packets.
/// @tparam TileWidthV  pixels along a tile's edge: 32, 64.
template <std::uint32_t TileWidthV = 64>
struct TreeLayout256K {
  /// @cond
  using Engine = TileEngine;
  static constexpr std::uint32_t kEffects = 0;
  static constexpr std::uint32_t kArenaBytes = 256 * 1024;
  static constexpr std::uint32_t kCodeBudgetBytes = 48 * 1024;
  static constexpr std::uint32_t kStackBudgetBytes = 10 * 1024 + 512;
  static constexpr std::uint32_t kTileWidth = TileWidthV;
  static constexpr std::uint32_t kPacketWidth = 0;
  static constexpr std::uint32_t kMaxOutputDepth = 2;
  /// @endcond
  static constexpr std::uint32_t kEyeTileWidth = 32;   ///< pixels along the edge of what is traced at once
  static constexpr std::uint32_t kEyeTurns = 2;        ///< of these, how many take turns
  static constexpr std::uint32_t kEyeSlots = 32;       ///< nodes and leaves at hand
  static constexpr std::uint32_t kEyeTopNodes = 17;    ///< of these nodes, the first, which stay for the frame
  static constexpr std::uint32_t kLeafTriangles = 16;  ///< of a leaf, at most
  static constexpr std::uint32_t kMostLanes = 16;      ///< that its memory is for
};

/// The same of a 64 KB core: smaller tiles, no turns, memory for four lanes. A core without vectors requires Lanes<1>
/// (base/one_lane.h).
struct TreeLayout64K {
  /// @cond
  using Engine = TileEngine;
  static constexpr std::uint32_t kEffects = 0;
  static constexpr std::uint32_t kArenaBytes = 64 * 1024;
  static constexpr std::uint32_t kCodeBudgetBytes = 35 * 1024 + 544;
  static constexpr std::uint32_t kStackBudgetBytes = 7 * 1024 + 480;
  static constexpr std::uint32_t kTileWidth = 16;
  static constexpr std::uint32_t kPacketWidth = 0;
  static constexpr std::uint32_t kMaxOutputDepth = 2;
  static constexpr std::uint32_t kEyeTileWidth = 16;
  static constexpr std::uint32_t kEyeTurns = 1;
  static constexpr std::uint32_t kEyeSlots = 8;
  static constexpr std::uint32_t kEyeTopNodes = 0;
  static constexpr std::uint32_t kLeafTriangles = 8;
  static constexpr std::uint32_t kMostLanes = 4;
  /// @endcond
};

/// The same of a microcontroller that has a memory for code, 32 KB, and one of 16 KB for stack and store: the smallest
/// tiles, and four nodes or leaves at hand. The budgets are those of a Cortex-M7 (platform/mps2/README.md).
struct TreeLayout16K {
  /// @cond
  using Engine = TileEngine;
  static constexpr std::uint32_t kEffects = 0;
  static constexpr std::uint32_t kArenaBytes = 16 * 1024;
  static constexpr std::uint32_t kCodeMemoryBytes = 32 * 1024;
  static constexpr std::uint32_t kCodeBudgetBytes = 28 * 1024;
  static constexpr std::uint32_t kStackBudgetBytes = 5 * 1024;
  static constexpr std::uint32_t kTileWidth = 8;
  static constexpr std::uint32_t kPacketWidth = 0;
  static constexpr std::uint32_t kMaxOutputDepth = 2;
  static constexpr std::uint32_t kEyeTileWidth = 8;
  static constexpr std::uint32_t kEyeTurns = 1;
  static constexpr std::uint32_t kEyeSlots = 4;
  static constexpr std::uint32_t kEyeTopNodes = 0;
  static constexpr std::uint32_t kLeafTriangles = 8;
  static constexpr std::uint32_t kMostLanes = 4;
  /// @endcond
};

/// Sizes of a 256 KB core that renders effects.
/// @tparam BuiltV        EffectBits: what it is built for, kSceneShading among them.
/// @tparam PacketWidthV  0: eye rays go through the tree.
template <std::uint32_t BuiltV, std::uint32_t PacketWidthV = 32>
struct EffectLayout256K {
  /// @cond
  using Engine = std::conditional_t<PacketWidthV == 0, TileEngine, GridEngine>;
  static constexpr std::uint32_t kEyeTileWidth = 32;
  static constexpr std::uint32_t kEyeTurns = 1;
  static constexpr std::uint32_t kEyeSlots = 32;
  static constexpr std::uint32_t kEyeTopNodes = 0;
  static constexpr std::uint32_t kMostLanes = 16;
  static constexpr std::uint32_t kEffects = BuiltV;
  static constexpr std::uint32_t kArenaBytes = 256 * 1024;
  static constexpr std::uint32_t kCodeBudgetBytes = PacketWidthV >= 16 ? 88 * 1024 : 94 * 1024;
  static constexpr std::uint32_t kStackBudgetBytes = 256 * (PacketWidthV >= 16 ? 36 : PacketWidthV != 0 ? 31 : 51);
  static constexpr std::uint32_t kTileWidth = 32;
  static constexpr std::uint32_t kPacketWidth = PacketWidthV;
  static constexpr std::uint32_t kMailboxSlots = PacketWidthV < 16 ? 64 : 256;
  static constexpr std::uint32_t kRecentTriangles = 32;
  static constexpr std::uint32_t kTableEntries = 1024;  ///< 32,768 macrocells resident
  static constexpr std::uint32_t kMaxMacroWidth = 6;
  static constexpr std::uint32_t kMaxMacroDepth = 8;
  static constexpr std::uint32_t kTrianglesPerBuffer = 40;
  static constexpr std::uint32_t kMaxTriangleDepth = 8;
  static constexpr std::uint32_t kMaxOutputDepth = 2;
  /// @endcond
  using RayEngine = TreeEngine;                          ///< what traces all rays but eye rays
  static constexpr std::uint32_t kBatchRays = 512;       ///< rays that its lists take at once
  static constexpr std::uint32_t kSpareListWords = 288;  ///< of its lists, beyond the least
  static constexpr bool kHasBeams = true;                ///< lists have beams, and code for rays of one origin
  static constexpr std::uint32_t kTreeSlots = 32;        ///< nodes and leaves at hand
  static constexpr std::uint32_t kLeafTriangles = 8;     ///< of a leaf, at most
  static constexpr std::uint32_t kWaveRays = 256;        ///< rays worked on together
  static constexpr std::uint32_t kMaterialSlots = 32;    ///< materials at hand
  static constexpr std::uint32_t kLightSlots = 16;       ///< lights at hand
  static_assert((BuiltV & kSceneShading) != 0);
};

/// Sizes of a 64 KB core that renders effects: no packets, all rays by lists. All effects fit,
/// as tools/checks/memory_table --effects measures; on a core without vectors only with Lanes<1> (base/one_lane.h).
/// @tparam BuiltV     as above.
/// @tparam WaveRaysV  rays of a wave: 32, 64; a longer one takes memory that a smaller set of effects leaves free.
template <std::uint32_t BuiltV, std::uint32_t WaveRaysV = 32>
struct EffectLayout64K {
  /// @cond
  using Engine = GridEngine;
  static constexpr std::uint32_t kEffects = BuiltV;
  static constexpr std::uint32_t kArenaBytes = 64 * 1024;
  static constexpr std::uint32_t kCodeBudgetBytes = 40 * 1024 + 288;
  static constexpr std::uint32_t kStackBudgetBytes = 4 * 1024 - 32;
  static constexpr std::uint32_t kTileWidth = 8;
  static constexpr std::uint32_t kPacketWidth = 0;
  static constexpr std::uint32_t kMaxOutputDepth = 2;
  using RayEngine = TreeEngine;
  static constexpr std::uint32_t kBatchRays = 32;
  static constexpr std::uint32_t kSpareListWords = 0;
  static constexpr bool kHasBeams = false;
  static constexpr std::uint32_t kTreeSlots = 8;
  static constexpr std::uint32_t kLeafTriangles = 8;
  static constexpr std::uint32_t kWaveRays = WaveRaysV;
  static constexpr std::uint32_t kMaterialSlots = 8;
  static constexpr std::uint32_t kLightSlots = 4;
  static_assert((BuiltV & kSceneShading) != 0);
  /// @endcond
};

/// @cond
/// Parts of a local store that depend on the layout's effects.
template <class Layout, bool kHas = Layout::kEffects != 0>
struct EffectParts {
  using RayStore = NoWave;
  using StoreWave = NoWave;
  using Effects = NoEffectStore;
  using Rays = NoRayStore;
};
template <class Layout>
struct EffectParts<Layout, true> {
  using RayStore = typename Layout::RayEngine::template RayStore<Layout>;
  using StoreWave = Wave<RayStore, Layout::kWaveRays>;
  using Effects = EffectStore<Layout>;
  using Rays = typename Layout::RayEngine::Store;
  static_assert(RayEngine<typename Layout::RayEngine, Layout>);
};
/// @endcond

/// Memory of one core. Buffers for transfers are congruent with main memory modulo kPortableCongruenceBytes.
template <class LayoutType>
struct alignas(128) LocalStore {
  using Layout = LayoutType;  ///< its sizes
  /// @cond
  using Engine = typename Layout::Engine;
  using EngineStore = typename Engine::template Store<Layout>;
  using EyeStore = typename Engine::template EyeStore<Layout>;
  using RayStore = typename EffectParts<Layout>::RayStore;
  using StoreWave = typename EffectParts<Layout>::StoreWave;
  using Rays = typename EffectParts<Layout>::Rays;
  using Effects = typename EffectParts<Layout>::Effects;
  static constexpr std::uint32_t kTilePixels = Layout::kTileWidth * Layout::kTileWidth;
  /// @endcond
  /// One finished or growing tile, row-major.
  struct alignas(128) TileOutput {
    std::uint32_t color[kTilePixels];  ///< RGBA8
    float depth[kTilePixels];          ///< as FrameHead's plane
    std::uint32_t id[kTilePixels];     ///< triangle_id or kNoTriangle
  };

  alignas(128) Frame<typename Engine::Record> frame;  ///< a copy of the frame's
  alignas(128) WorkCounters work;            ///< work of the current frame, or of the last one until the next begins
  [[no_unique_address]] EngineStore engine;  ///< the memory of the engine of eye rays for the whole frame
  /// @cond
  [[no_unique_address]] Rays rays;  ///< that of the engine of other rays
  union {
    EyeStore packet;  ///< the engine's memory while eye rays are traced
    StoreWave wave;   ///< used while their hits are shaded
  };
  /// @endcond
  TileOutput output[Layout::kMaxOutputDepth];  ///< in rotation
  /// @cond
  [[no_unique_address]] Effects effects;
  /// @endcond

  static_assert(gridiron::Engine<Engine, Layout>);
  static_assert(Layout::kMaxOutputDepth <= kOutputTagCount);
};

/// Bytes of a memory of its own for code, which a layout may state as kCodeMemoryBytes; its arena then holds stack and
/// data alone. 0: code, stack and data share the arena.
template <class Layout>
inline constexpr std::uint32_t kCodeMemoryBytes = 0;
/// @cond
template <class Layout>
requires requires {
  Layout::kCodeMemoryBytes;
}
inline constexpr std::uint32_t kCodeMemoryBytes<Layout> = Layout::kCodeMemoryBytes;
/// @endcond

/// Bytes that a layout leaves for data.
template <class Layout>
inline constexpr std::uint32_t kDataRoomBytes = Layout::kArenaBytes - Layout::kStackBudgetBytes -
                                                (kCodeMemoryBytes<Layout> != 0 ? std::uint32_t{0}
                                                                               : Layout::kCodeBudgetBytes);

/// Whether store, stack and code fit the layout's memories. The build fails if one of the layouts below does not.
template <class Layout>
inline constexpr bool kFitsArena = sizeof(LocalStore<Layout>) <= kDataRoomBytes<Layout> &&
                                   (kCodeMemoryBytes<Layout> == 0 ||
                                    Layout::kCodeBudgetBytes <= kCodeMemoryBytes<Layout>);

static_assert(kFitsArena<StoreLayout256K<4>> && kFitsArena<StoreLayout256K<8>> && kFitsArena<StoreLayout256K<16>> &&
              kFitsArena<StoreLayout256K<32>>);
static_assert(kFitsArena<StoreLayout256K<8, 8>> && kFitsArena<StoreLayout256K<16, 16>> &&
              kFitsArena<StoreLayout256K<8, 64>> && kFitsArena<StoreLayout256K<32, 64>>);
static_assert(kFitsArena<StoreLayout64K<4>> && kFitsArena<StoreLayout64K<8>> && kFitsArena<StoreLayout64K<16>>);
static_assert(kFitsArena<StoreLayout128K<8>> && kFitsArena<StoreLayout128K<32>>);
static_assert(kFitsArena<EffectLayout256K<kAllEffects, 0>> && kFitsArena<EffectLayout256K<kAllEffects, 8>> &&
              kFitsArena<EffectLayout256K<kAllEffects, 32>> && kFitsArena<EffectLayout64K<kAllEffects>>);
static_assert(kFitsArena<TreeLayout16K> && kFitsArena<TreeLayout64K> && kFitsArena<TreeLayout256K<32>> &&
              kFitsArena<TreeLayout256K<64>>);
static_assert(kFitsArena<StoreLayout512K<8>> && kFitsArena<StoreLayout512K<32>> && kFitsArena<StoreLayout512K<8, 64>> &&
              kFitsArena<StoreLayout512K<32, 64>>);

// A frame's record and a packet have bases. Compilers warn of offsetof on such a type, but support it.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Winvalid-offsetof"
/// Calls visit(name, offset_bytes, bytes) for every region of the store, in address order.
template <class Layout, class Visit>
constexpr void for_each_region(Visit&& visit) {
  using Store = LocalStore<Layout>;
  visit("frame", offsetof(Store, frame), sizeof(Store::frame));
  visit("work", offsetof(Store, work), sizeof(Store::work));
  Store::EngineStore::for_each_region([&](const char* name, std::size_t offset, std::size_t bytes) {
    visit(name, offsetof(Store, engine) + offset, bytes);
  });
  if constexpr (Layout::kEffects == 0) {
    constexpr auto visit_part = [](const char*, std::size_t, std::size_t) {};
    if constexpr (requires { Store::EyeStore::for_each_region(visit_part); }) {
      Store::EyeStore::for_each_region([&](const char* name, std::size_t offset, std::size_t bytes) {
        visit(name, offsetof(Store, packet) + offset, bytes);
      });
    } else {
      visit("packet", offsetof(Store, packet), sizeof(Store::packet));
    }
  } else {
    visit("rays", offsetof(Store, rays), sizeof(Store::rays));
    constexpr bool kWaveIsLarger =
        !kTracesEyes<Layout> || sizeof(typename Store::StoreWave) > sizeof(typename Store::EyeStore);
    visit(kTracesEyes<Layout> ? "packet_or_wave" : "wave", offsetof(Store, packet),
          kWaveIsLarger ? sizeof(typename Store::StoreWave) : sizeof(typename Store::EyeStore));
  }
  visit("output", offsetof(Store, output), sizeof(Store::output));
  if constexpr (Layout::kEffects != 0) visit("effects", offsetof(Store, effects), sizeof(Store::effects));
}
#pragma GCC diagnostic pop

}  // namespace gridiron
