// Tile bound: the most work and transfers of one tile of a scene, for every camera; the input of a worst-case analysis.
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

/// The sizes of a renderer that bound a tile. tile_layout_of() fills it.
struct TileLayout {
  std::uint32_t lanes;                 ///< rays of a group, 1 or 4, the unit of counts of groups
  std::uint32_t tile_width;            ///< pixels along a tile's edge
  std::uint32_t packet_width;          ///< rays along a packet's edge; 0: all rays by lists
  std::uint32_t triangles_per_buffer;  ///< most of one transfer of a cell's; of packets, like those to recent_triangles
  std::uint32_t resident_macro_cells;  ///< the greatest table of macrocells that the local store holds whole
  std::uint32_t mailbox_slots;         ///< places
  std::uint32_t recent_triangles;      ///< of which estimated distances can be made exact
  std::uint32_t batch_rays;            ///< secondary rays traced at once; from here on 0 in layouts without effects
  std::uint32_t tree_slots;            ///< nodes and leaves at hand
  std::uint32_t has_beams;             ///< 0, 1: lists have beams, and code for rays of one origin
  std::uint32_t wave_rays;             ///< rays worked on together
  std::uint32_t material_slots;        ///< materials at hand
  std::uint32_t light_slots;           ///< lights at hand
};

/// @tparam Layout  of store/local_store.h.
/// @param lanes    1 or 4.
/// @returns        the sizes of the layout.
template <class Layout>
[[nodiscard]] constexpr TileLayout tile_layout_of(std::uint32_t lanes) {
  TileLayout layout{};
  layout.lanes = lanes;
  layout.tile_width = Layout::kTileWidth;
  layout.packet_width = Layout::kPacketWidth;
  if constexpr (Layout::kPacketWidth != 0) {
    layout.triangles_per_buffer = Layout::kTrianglesPerBuffer;
    layout.resident_macro_cells = 32 * Layout::kTableEntries;
    layout.mailbox_slots = Layout::kMailboxSlots;
    layout.recent_triangles = Layout::kRecentTriangles;
  }
  if constexpr (Layout::kEffects != 0) {
    layout.batch_rays = Layout::kBatchRays;
    layout.tree_slots = Layout::kTreeSlots;
    layout.has_beams = Layout::kHasBeams ? 1 : 0;
    layout.wave_rays = Layout::kWaveRays;
    layout.material_slots = Layout::kMaterialSlots;
    layout.light_slots = Layout::kLightSlots;
  }
  return layout;
}

/// The settings of a frame that bound a tile: neither camera nor size. Names as in FrameSettings.
struct TileFrame {
  Accuracy accuracy = Accuracy::kStandard;  ///< one that the image stores triangles for
  Shading shading = Shading::kSimple;       ///< kScene: of layouts and scenes with effects
  std::uint32_t techniques = kUseMailbox | kUseCornerCulling | kUseEmptySkip;  ///< TechniqueBits
  std::uint32_t output_depth = 2;                                              ///< tile buffers in rotation
  std::uint32_t macro_depth = 2;                                               ///< cell blocks in rotation
  std::uint32_t triangle_depth = 2;                                            ///< triangle buffers in rotation
  std::uint32_t fetch_depth = 2;   ///< as FrameHead's
  bool has_depth = false;          ///< whether distances are requested
  bool has_ids = false;            ///< whether triangle ids are requested
  std::uint32_t queue_depth = 16;  ///< commands that fit the platform's queue
};

/// The counts of a scene that bound a tile. count_tile_scene() fills it.
struct TileScene {
  std::uint64_t macro_cells;           ///< of the grid
  std::uint64_t occupied_macro_cells;  ///< that hold triangles
  std::uint32_t macro_slices;          ///< macrocells along the longest axis
  std::uint64_t slices;                ///< slices of cells of all macrocells, along the axis of most
  std::uint64_t occupied_slices;       ///< the same over the occupied macrocells
  std::uint64_t cells;                 ///< of all macrocells
  std::uint64_t occupied_cells;        ///< of the occupied macrocells
  std::uint64_t filled_cells;          ///< cells that hold triangles
  std::uint64_t references;            ///< triangles, one for each cell that holds it
  std::uint64_t runs;                  ///< transfers of at most a buffer of triangles that all cells need
  std::uint64_t run_groups;            ///< SIMD groups of triangles in these
  std::uint32_t most_cell_triangles;   ///< in one cell
  std::uint32_t most_macro_triangles;  ///< in one macrocell
  std::uint32_t cell_block_bytes;      ///< of a macrocell's cells
  EffectsRecord effects;               ///< all zero without effects, like what follows
  std::uint64_t nodes;                 ///< of the tree
  std::uint64_t leaves;                ///< of the tree
  std::uint64_t leaf_groups;           ///< SIMD groups of triangles in these
  std::uint64_t tree_triangles;        ///< in these
  std::uint32_t leaf_triangles;        ///< of a leaf, at most
  std::uint64_t light_samples;         ///< rays that a point sends to all lights: one for a point light
};

/// Counts the parts of an image that bound a tile.
///
/// @param image   the image that `view` was opened from.
/// @param view    as open_scene_image() opened it.
/// @param layout  decides how runs of triangles are split.
/// Errors: none; the image was checked when it was opened. Cost: linear in its cells.
[[nodiscard]] TileScene count_tile_scene(std::span<const std::byte> image, const SceneImageView& view,
                                         const TileLayout& layout);

/// Bounds; 2^64 - 1 stands for any greater number.
struct TileBound {
  std::uint64_t work[kWorkKindCount] = {};  ///< by kind; kGetIssue, kPutIssue and kWait are commands and waits
  std::uint64_t get_bytes = 0;              ///< requested by gets
  std::uint64_t put_bytes = 0;              ///< requested by puts

  /// The most of one kind of work.
  [[nodiscard]] constexpr std::uint64_t operator[](WorkId kind) const { return work[kind.number()]; }
};

/// The most work of each kind and the most transfers of one tile, for every camera that make_frame_record accepts and
/// for any place of image and planes. What a core does before its first tile and after its last is not included.
///
/// Assumes that each pass of packets crosses the whole grid and tests every reference. A packet that sees all of a
/// scene from afar does so; its bound is reached but for culling and hits. A tile of many packets stays farther below.
/// Other rays are assumed to enter every node and leaf, each alone, and to find nothing of it at hand.
///
/// @param scene   counted for the same layout.
/// @param layout  of a renderer that takes the frame.
/// @param frame   settings; the scene's image must have the triangles and effects that accuracy and shading require.
/// Errors: none; sums that 64 bits do not hold are 2^64 - 1.
[[nodiscard]] TileBound worst_tile(const TileScene& scene, const TileLayout& layout, const TileFrame& frame);

}  // namespace gridiron
