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

/// What of a renderer bounds a tile: its layout's sizes, and lanes. tile_layout_of() fills it.
struct TileLayout {
  std::uint32_t lanes;                 ///< rays of a group, 1 or 4: what a count of groups counts
  std::uint32_t tile_width;            ///< pixels along a tile's edge
  std::uint32_t packet_width;          ///< rays along a packet's edge; 0: all rays by walks
  std::uint32_t triangles_per_buffer;  ///< most of one transfer
  std::uint32_t resident_macro_cells;  ///< macrocells of which the local store holds the whole table
  std::uint32_t wave_rays;             ///< of layouts with effects, as what follows, else 0: rays worked on together
  std::uint32_t material_slots;        ///< materials at hand
  std::uint32_t light_slots;           ///< lights at hand
};

/// @tparam Layout  of store/local_store.h.
/// @param lanes    1 or 4.
/// @returns        the sizes of the layout.
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

/// What of a frame bounds a tile: neither camera nor size. Members of the same names as in FrameSettings mean the same.
struct TileFrame {
  Accuracy accuracy = Accuracy::kStandard;  ///< one that the image stores triangles for
  Shading shading = Shading::kSimple;       ///< kScene: of layouts and scenes with effects
  std::uint32_t techniques = kUseMailbox | kUseCornerCulling | kUseEmptySkip;  ///< TechniqueBits
  std::uint32_t output_depth = 2;    ///< tile buffers in rotation
  std::uint32_t macro_depth = 2;     ///< cell blocks in rotation
  std::uint32_t triangle_depth = 2;  ///< triangle buffers in rotation
  std::uint32_t walk_depth = 2;      ///< walks of secondary rays under way at once
  bool has_depth = false;            ///< whether the plane of distances is wanted
  bool has_ids = false;              ///< whether the plane of triangle ids is wanted
  std::uint32_t queue_depth = 16;    ///< commands that the platform's queue holds
};

/// What of a scene bounds a tile. count_tile_scene() fills it.
struct TileScene {
  std::uint64_t macro_cells;            ///< of the grid
  std::uint64_t occupied_macro_cells;   ///< that hold triangles
  std::uint32_t macro_slices;           ///< macrocells along the longest axis
  std::uint64_t slices;                 ///< slices of cells of all macrocells, along the axis of most
  std::uint64_t occupied_slices;        ///< of these, those of the occupied macrocells
  std::uint64_t cells;                  ///< of all macrocells
  std::uint64_t occupied_cells;         ///< of the occupied macrocells
  std::uint64_t filled_cells;           ///< cells that hold triangles
  std::uint64_t references;             ///< triangles, each once for each cell that holds it
  std::uint64_t runs;                   ///< transfers of at most a buffer of triangles that all cells take
  std::uint64_t run_groups;             ///< SIMD groups of triangles in these
  std::uint32_t most_cell_triangles;    ///< in one cell
  std::uint32_t most_macro_triangles;   ///< in one macrocell
  std::uint32_t cell_block_bytes;       ///< of a macrocell's cells
  EffectsRecord effects;                ///< all zero where there are none
  std::uint64_t light_samples;          ///< rays that a point sends to all lights: one for a point light
};

/// Counts what of an image bounds a tile.
///
/// @param image   that `view` was opened of.
/// @param view    as open_scene_image() opened it.
/// @param layout  that runs of triangles are cut for.
/// Errors: none; the image was checked when it was opened. Cost: linear in its cells.
[[nodiscard]] TileScene count_tile_scene(std::span<const std::byte> image, const SceneImageView& view,
                                         const TileLayout& layout);

/// Bounds; 2^64 - 1 stands for more than can be told.
struct TileBound {
  std::uint64_t work[kWorkKindCount] = {};  ///< by kind; kGetIssue, kPutIssue and kWait are commands and waits
  std::uint64_t get_bytes = 0;              ///< requested by gets
  std::uint64_t put_bytes = 0;              ///< requested by puts

  /// The most of one kind of work.
  [[nodiscard]] constexpr std::uint64_t operator[](WorkId kind) const { return work[kind.number()]; }
};

/// The most that one tile can take of each kind of work and of transfers, for every camera that make_frame_record takes
/// and wherever image and planes lie. What a core does before its first tile and after its last is not part of it.
///
/// A pass is taken to go through the whole grid and to test every reference: that is what a packet does which sees all
/// of a scene from afar, so that the bound of one packet is reached but for culling and hits. A tile of many packets
/// comes less near it. Of walks each ray is taken to go alone.
///
/// @param scene   counted for the same layout.
/// @param layout  of a renderer that takes the frame.
/// @param frame   settings; accuracy and shading of such as the scene's image has triangles and effects for.
/// Errors: none; sums that 64 bits do not hold are 2^64 - 1.
[[nodiscard]] TileBound worst_tile(const TileScene& scene, const TileLayout& layout, const TileFrame& frame);

}  // namespace gridiron
