// Loop table: core/loop_bounds.csv, with each bound evaluated for a scene, a layout, a frame and a build of its tree.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/passes/build_plan.h>

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "worst_tile.h"

namespace gridiron::tool {

/// A loop on a core without a constant bound.
struct LoopRow {
  std::string_view file;      ///< below core/gridiron/
  std::string_view function;
  std::string_view loop;      ///< its header
  std::string_view kind;      ///< constant, layout, frame, scene, build: the origin of the bound
  std::string_view bound;     ///< as the table has it
  /// Most turns each time it is entered; 0: of no use to the layout. Nothing where what it is made of is not known.
  std::optional<std::uint64_t> value;
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
  // Of building the tree on the cores: of the mesh.
  std::uint64_t build_triangles = 0, build_vertices = 0;
  // Of the plan.
  std::uint64_t build_runs = 0, run_triangles = 0;
  std::uint64_t run_samples = 0, bucket_samples = 0;  ///< codes by which buckets are chosen: of a run, of all
  std::uint64_t sampled_runs = 0;     ///< every so many'th run is sampled
  std::uint64_t build_buckets = 0;    ///< that are sorted
  std::uint64_t build_tops = 0;       ///< nodes above the pieces
  std::uint64_t top_samples = 0;      ///< sorted keys that guide their splits
  std::uint64_t bucket_triangles = 0, bucket_nodes = 0;  ///< of a bucket of pieces
  std::uint64_t image_pieces = 0;     ///< that have a check value each
  std::uint64_t build_items = 0;      ///< of the pass that has the most
  std::uint64_t build_windows = 0;    ///< of an array that is gone through
  // Of the plan and of the layout: keys in the store, at most, of a bucket with its records, of any, of what is sorted.
  std::uint64_t held_keys = 0, stored_keys = 0, sorted_keys = 0;
  // Of the layout.
  std::uint64_t chunk_triangles = 0;  ///< whose corners are asked for at once
  std::uint64_t vertex_lines = 0;     ///< held
  std::uint64_t record_window = 0;    ///< records that are read or written at once
  std::uint64_t digit_bits = 0, few_digit_bits = 0;  ///< of a code, sorted at once; the same for a few keys
  std::uint64_t far_keys = 0;         ///< sorted at once of more than the store holds, at least
  std::uint64_t cut_rows = 0, cut_keys = 0;  ///< buckets and keys at once where buckets are cut
  std::uint64_t sort_runs = 0;        ///< whose cuts are there at once
  std::uint64_t gathered_keys = 0, scanned_keys = 0, sent_samples = 0;  ///< at once
  std::uint64_t top_lines = 0, sampled_keys = 0;  ///< lines of keys held, and samples read at once, by the top pass
  std::uint64_t build_commands = 0;   ///< of the longest transfer

  bool has_tile = false;   ///< what comes from layout, frame and scene is known
  bool has_build = false;  ///< what comes from a build is known

  /// Adds what depends on a build of the tree on the cores. Does nothing where it cannot be planned.
  /// @param input        addresses are not used, but an image has one. @param arena_bytes  of a core.
  void add_build(const BuildInput& input, std::uint32_t arena_bytes);

  /// The table, in the order of the sources.
  [[nodiscard]] std::vector<LoopRow> rows() const;
};

/// All but a build's. @param tiles  of the picture.
[[nodiscard]] LoopFacts loop_facts_of(const WorstTile& worst, std::uint32_t macro_width, std::uint64_t tiles);

}  // namespace gridiron::tool
