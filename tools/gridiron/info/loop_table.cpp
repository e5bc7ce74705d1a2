// Loop table. SPDX-License-Identifier: Apache-2.0
#include "loop_table.h"

#include <gridiron/base/exact_sum.h>
#include <gridiron/engine/tree/list_memory.h>
#include <gridiron/engine/tree/tile_memory.h>
#include <gridiron/ray/packet.h>
#include <gridiron/ray/ray_batch.h>

#include <algorithm>

namespace gridiron::tool {
namespace {

// Functions for the table's expressions.
std::uint64_t smaller(std::uint64_t a, std::uint64_t b) {
  return std::min(a, b);
}
std::uint64_t parts(std::uint64_t count, std::uint64_t each) {
  return each == 0 ? 0 : (count + each - 1) / each;
}

}  // namespace

std::vector<LoopRow> LoopFacts::rows() const {
  return {
#include "loop_bounds.inc"
  };
}

LoopFacts loop_facts_of(const WorstTile& worst, std::uint32_t macro_width, std::uint64_t tiles) {
  const TileLayout& layout = worst.layout;
  const EffectsRecord& effects = worst.scene.effects;
  LoopFacts facts;
  facts.lanes = layout.lanes;
  facts.tile_pixels = std::uint64_t{layout.tile_width} * layout.tile_width;
  facts.packet_rays = std::uint64_t{layout.packet_width} * layout.packet_width;
  facts.squares = layout.packet_width == 0 ? 0 : std::max(facts.packet_rays / kSubpacketRays / 4, std::uint64_t{1});
  facts.triangles_per_buffer = layout.triangles_per_buffer;
  facts.table_lines = layout.resident_macro_cells / 32 * sizeof(MacroTableEntry) / kLineBytes;
  facts.batch_rays = layout.batch_rays;
  facts.tree_slots = layout.tree_slots;
  facts.wave_rays = layout.wave_rays;
  facts.material_slots = layout.material_slots;
  facts.light_slots = layout.light_slots;
  // The table, a plane of a tile, a cell block, triangles, rays that wait, lights, materials; one more for its offset.
  const std::uint64_t longest =
      std::max({facts.table_lines * kLineBytes, facts.tile_pixels * 4, std::uint64_t{worst.scene.cell_block_bytes},
                facts.triangles_per_buffer * kTriangleRecordBytes, facts.wave_rays / 2 * sizeof(QueuedRay),
                facts.light_slots * sizeof(LightRecord), facts.material_slots * sizeof(MaterialRecord)});
  facts.most_pieces = parts(longest, kPortableBoundaryBytes) + 1;
  facts.tiles = tiles;
  facts.output_depth = worst.frame.output_depth;
  facts.macro_depth = worst.frame.macro_depth;
  facts.triangle_depth = worst.frame.triangle_depth;
  facts.macro_width = macro_width;
  facts.macro_slices = worst.scene.macro_slices;
  facts.macro_cells = worst.scene.macro_cells;
  facts.filled_cells = worst.scene.filled_cells;
  facts.runs = worst.scene.runs;
  if (worst.frame.shading != Shading::kScene) return facts;
  facts.fetch_depth = worst.frame.fetch_depth;
  facts.material_count = effects.material_count;
  facts.light_count = effects.light_count;
  facts.samples = effects.samples_per_pixel;
  facts.occlusion_samples = effects.occlusion_samples;
  facts.light_rays = worst.scene.light_samples;
  facts.nodes = worst.scene.nodes;
  facts.leaves = worst.scene.leaves;
  facts.queued_rays = worst.bound[Work::kQueuedRay];
  facts.job_rays = facts.wave_rays * std::max({facts.light_rays, facts.occlusion_samples, std::uint64_t{1}});
  return facts;
}

}  // namespace gridiron::tool
