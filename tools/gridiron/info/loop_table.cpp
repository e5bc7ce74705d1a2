// Loop table. SPDX-License-Identifier: Apache-2.0
#include "loop_table.h"

#include <gridiron/base/exact_sum.h>
#include <gridiron/build/passes/build_passes.h>
#include <gridiron/engine/tree/list_memory.h>
#include <gridiron/engine/tree/tile_memory.h>
#include <gridiron/ray/packet.h>
#include <gridiron/ray/ray_batch.h>

#include <algorithm>
#include <bit>

namespace gridiron::tool {
namespace {

// Functions for the table's expressions.
std::uint64_t smaller(std::uint64_t a, std::uint64_t b) {
  return std::min(a, b);
}
std::uint64_t larger(std::uint64_t a, std::uint64_t b) {
  return std::max(a, b);
}
std::uint64_t parts(std::uint64_t count, std::uint64_t each) {
  return each == 0 ? 0 : (count + each - 1) / each;
}
// Turns of a search that halves what is left.
std::uint64_t halvings(std::uint64_t count) {
  return static_cast<std::uint64_t>(std::bit_width(count));
}

template <class Layout>
void add_layout(const BuildPlan& plan, LoopFacts& facts) {
  const std::uint64_t triangles = plan.input.triangle_count;
  static_assert(Layout::kBucketKeys <= Layout::kLoneKeys && Layout::kFarKeys <= Layout::kLoneKeys);
  static_assert(Layout::kFewDigitBits <= Layout::kDigitBits);
  facts.bucket_triangles = smaller(triangles, Layout::kPieceKeys);
  facts.bucket_nodes = raw_node_place(facts.bucket_triangles, plan.input.leaf_triangles) + 1;
  facts.held_keys = Layout::kSortsRecords ? smaller(triangles, Layout::kBucketKeys) : 0;
  facts.stored_keys = smaller(triangles, Layout::kLoneKeys);
  facts.sorted_keys = std::max({facts.stored_keys, facts.run_triangles, facts.bucket_samples});
  facts.chunk_triangles = Layout::kChunkTriangles;
  facts.vertex_lines = Layout::kCacheLines;
  facts.record_window = Layout::kRecordWindow;
  facts.digit_bits = Layout::kDigitBits;
  facts.few_digit_bits = Layout::kFewDigitBits;
  facts.far_keys = Layout::kFarKeys;
  facts.cut_rows = CutsStore<Layout>::kSplitters;
  facts.cut_keys = CutsStore<Layout>::kKeys;
  facts.sort_runs = SortStore<Layout>::kRuns;
  facts.gathered_keys = LoneBucket<Layout>::kPieceKeys;
  facts.scanned_keys = LoneBucket<Layout>::kScannedKeys;
  facts.sent_samples = SortStore<Layout>::kSamples;
  facts.top_lines = TopStore<Layout>::kLines;
  facts.sampled_keys = TopStore<Layout>::kSampledKeys;
  facts.build_windows = std::max(
      {parts(kVertexItem, kVertexWindow), parts(plan.vertex_items, CodesStore<Layout>::kPartWindow),
       parts(facts.build_runs, 8), parts(facts.bucket_samples, 256), parts(facts.run_triangles, facts.cut_keys),
       parts(triangles, facts.record_window), parts(facts.top_samples, facts.sampled_keys), parts(kBucketPieces, 16),
       parts(plan.subtree_room, JoinStore::kWindow), parts(facts.build_tops, JoinStore::kWindow),
       parts(ImageCheckValue::kPieceBytes, CheckStore::kWindow * kLineBytes)});
  // Keys of a bucket, of pieces or of a run, and a run's records; one more for its offset. Windows are shorter.
  const std::uint64_t longest =
      std::max({Layout::kLoneKeys * sizeof(SortedKey), Layout::kPieceKeys * sizeof(SortedKey),
                Layout::kRunTriangles * (Layout::kSortsRecords ? sizeof(VertexTriangle) : sizeof(TreeKey))});
  facts.build_commands = parts(longest, kPortableBoundaryBytes) + 1;
}

}  // namespace

std::vector<LoopRow> LoopFacts::rows() const {
  std::vector<LoopRow> rows = {
#include "loop_bounds.inc"
  };
  for (LoopRow& row : rows) {
    const bool is_known = row.kind == "constant" || (row.kind == "build" ? has_build : has_tile);
    if (!is_known) row.value.reset();
  }
  return rows;
}

void LoopFacts::add_build(const BuildInput& input, std::uint32_t arena_bytes) {
  const bool is_large = arena_bytes >= BuildLayout256K::kArenaBytes;
  BuildPlan plan{};
  const Status status = is_large ? plan_build<BuildLayout256K>(input, plan) : plan_build<BuildLayout64K>(input, plan);
  if (status != Status::kOk) return;
  has_build = true;
  build_triangles = input.triangle_count;
  build_vertices = input.vertex_count;
  build_runs = plan.run_count;
  run_triangles = plan.run_triangles;
  run_samples = plan.run_samples;
  sampled_runs = plan.sampled_runs;
  bucket_samples = parts(build_runs, sampled_runs) * run_samples;
  build_buckets = plan.bucket_room;
  build_tops = (plan.top_results.value - plan.tops.value) / sizeof(TopNode);
  top_samples = input.triangle_count / plan.sample_step + 1;
  image_pieces = plan.item_counts[static_cast<std::uint32_t>(BuildPass::kCheck)];
  build_items = *std::ranges::max_element(plan.item_counts);
  is_large ? add_layout<BuildLayout256K>(plan, *this) : add_layout<BuildLayout64K>(plan, *this);
}

LoopFacts loop_facts_of(const WorstTile& worst, std::uint32_t macro_width, std::uint64_t tiles) {
  const TileLayout& layout = worst.layout;
  const EffectsRecord& effects = worst.scene.effects;
  LoopFacts facts;
  facts.has_tile = true;
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
