// Loop table: core/loop_bounds.csv, with each bound evaluated for a scene, a layout and a frame.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "worst_tile.h"

namespace gridiron::tool {

/// A loop on a core without a constant bound.
struct LoopRow {
  std::string_view file;      ///< below core/gridiron/
  std::string_view function;
  std::string_view loop;      ///< its header
  std::string_view kind;      ///< constant, layout, frame, scene: the origin of the bound
  std::string_view bound;     ///< as the table has it
  std::uint64_t value;        ///< most turns each time it is entered; 0: of no use to the layout
};

/// The variables of the bounds' expressions.
struct LoopFacts {
  // Of the layout; 0 for parts that it does not have.
  std::uint64_t lanes = 0, tile_pixels = 0, packet_rays = 0;
  std::uint64_t squares = 0;  ///< of a packet
  std::uint64_t triangles_per_buffer = 0;
  std::uint64_t table_lines = 0;  ///< of 128 bytes
  std::uint64_t batch_rays = 0, tree_slots = 0;  ///< of lists
  std::uint64_t wave_rays = 0, material_slots = 0, light_slots = 0;
  std::uint64_t most_pieces = 0;  ///< commands of the longest transfer
  // Of the frame.
  std::uint64_t tiles = 0, output_depth = 0, macro_depth = 0, triangle_depth = 0, fetch_depth = 0;
  // Of the scene.
  std::uint64_t macro_width = 0, macro_slices = 0, macro_cells = 0, filled_cells = 0, runs = 0;
  std::uint64_t material_count = 0, light_count = 0, samples = 1, occlusion_samples = 0;
  std::uint64_t light_rays = 0;   ///< of a point, to the lights
  std::uint64_t queued_rays = 0;  ///< that a tile's rays cast
  std::uint64_t nodes = 0, leaves = 0;  ///< of the tree
  std::uint64_t job_rays = 0;     ///< traced between two waves' steps

  /// The table, in the order of the sources.
  [[nodiscard]] std::vector<LoopRow> rows() const;
};

/// @param tiles  of the picture.
[[nodiscard]] LoopFacts loop_facts_of(const WorstTile& worst, std::uint32_t macro_width, std::uint64_t tiles);

}  // namespace gridiron::tool
