// Tile bound: the most work and transfers of one tile of a scene, for every camera: what a worst-case analysis asks
// for.
// Source: own; each count is derived where it is made, in tile_bound.cpp.
// Memory: values; reads the image. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/platform/contract.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace gridiron {

/// What of a renderer bounds a tile: its layout's sizes, and lanes.
struct TileLayout {
  std::uint32_t lanes;         ///< 1 or 4
  std::uint32_t tile_width, packet_width;  ///< pixels; packet_width 0: all rays by walks
  std::uint32_t triangles_per_buffer;
  std::uint32_t resident_macro_cells;  ///< macrocells of which the local store holds the whole table
  // Of layouts with effects, else 0.
  std::uint32_t wave_rays, material_slots, light_slots;
};

/// @tparam Layout  of store/local_store.h.
template <class Layout>
[[nodiscard]] constexpr TileLayout tile_layout_of(std::uint32_t lanes) {
  TileLayout layout{lanes, Layout::kTileWidth, Layout::kPacketWidth, Layout::kTrianglesPerBuffer,
                    32 * Layout::kTableEntries, 0, 0, 0};
  if constexpr (Layout::kEffects != 0) {
    layout.wave_rays = Layout::kWaveRays;
    layout.material_slots = Layout::kMaterialSlots;
    layout.light_slots = Layout::kLightSlots;
  }
  return layout;
}

/// What of a frame bounds a tile: neither camera nor size.
struct TileFrame {
  Accuracy accuracy = Accuracy::kStandard;
  Shading shading = Shading::kSimple;
  std::uint32_t techniques = kUseMailbox | kUseCornerCulling | kUseEmptySkip;  ///< TechniqueBits
  std::uint32_t output_depth = 2, macro_depth = 2, triangle_depth = 2, walk_depth = 2;
  bool has_depth = false, has_ids = false;
  std::uint32_t queue_depth = 16;  ///< of the platform
};

/// What of a scene bounds a tile.
struct TileScene {
  std::uint64_t macro_cells;            ///< of the grid
  std::uint64_t occupied_macro_cells;   ///< that hold triangles
  std::uint32_t macro_slices;           ///< macrocells along the longest axis
  std::uint64_t slices, occupied_slices;  ///< slices of all, and of the occupied macrocells, along the axis of most
  std::uint64_t cells, occupied_cells;  ///< of all, and of the occupied macrocells
  std::uint64_t filled_cells;           ///< cells that hold triangles
  std::uint64_t references;             ///< triangles, each once for each cell that holds it
  std::uint64_t runs;                   ///< transfers of at most a buffer of triangles that all cells take
  std::uint64_t run_groups;             ///< SIMD groups of triangles in these
  std::uint32_t most_cell_triangles;    ///< in one cell
  std::uint32_t most_macro_triangles;   ///< in one macrocell
  std::uint32_t cell_block_bytes;
  EffectsRecord effects;                ///< all zero where there are none
  std::uint64_t light_samples;          ///< rays that a point sends to all lights: one for a point light
};

/// Counts what of an image bounds a tile. @param image  that `view` was opened of. Cost: linear in its cells.
[[nodiscard]] TileScene count_tile_scene(std::span<const std::byte> image, const SceneImageView& view,
                                         const TileLayout& layout);

/// Bounds; 2^64 - 1 stands for more than can be told.
struct TileBound {
  std::uint64_t work[kWorkKindCount] = {};  ///< by kind; kGetIssue, kPutIssue and kWait are commands and waits
  std::uint64_t get_bytes = 0, put_bytes = 0;

  [[nodiscard]] constexpr std::uint64_t operator[](Work kind) const { return work[static_cast<std::uint32_t>(kind)]; }
};

/// The most that one tile can take of each kind of work and of transfers, for every camera that make_frame_record takes
/// and wherever image and planes lie. What a core does before its first tile and after its last is not part of it.
///
/// A pass is taken to go through the whole grid and to test every reference: that is what a packet does which sees all
/// of a scene from afar, so that the bound of one packet is reached but for culling and hits. A tile of many packets
/// comes less near it. Of walks each ray is taken to go alone.
[[nodiscard]] TileBound worst_tile(const TileScene& scene, const TileLayout& layout, const TileFrame& frame);

}  // namespace gridiron
