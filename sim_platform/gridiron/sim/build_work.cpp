// Build work: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/passes/build_plan.h>
#include <gridiron/sim/build_work.h>

#include <iterator>

namespace gridiron::sim {
namespace {

/// Of `lines` lines touched all over so many bytes, those that the cache does not hold.
std::uint64_t missed(std::uint64_t lines, std::uint64_t bytes) {
  return bytes > kCachedBytes ? lines - lines * kCachedBytes / bytes : 0;
}

/// Lines that building the grid waits for. Each pass over the mesh meets its vertices; writing meets triangles and
/// vertices by their place in space. Sorting goes by the mesh's order through cells, which lie in the order of space,
/// then through cells and sorted ids: a triangle that is far from the one before it has its rows of cells far away.
std::uint64_t far_lines(std::uint64_t triangle_count, const GridNeed& need, std::uint64_t passes,
                        const MeshLines& lines) {
  if (triangle_count == 0) return 0;
  const std::uint64_t cell_bytes = std::uint64_t{need.grid.cell_block_count} * need.grid.cell_block_bytes;
  const std::uint64_t id_bytes = std::uint64_t{need.grid.reference_count} * sizeof(std::uint32_t);
  const std::uint64_t far_rows = need.steps.row_count * lines.triangles_in_space / triangle_count;
  return passes * lines.vertices_in_order + lines.triangles_in_space + lines.vertices_in_space +
         missed(far_rows, cell_bytes) + 2 * missed(far_rows, cell_bytes + id_bytes);
}

}  // namespace

BuildWork grid_build_work(std::uint64_t vertex_count, std::uint64_t triangle_count, const GridNeed& need,
                          const MeshLines& lines) {
  const GridRecord& grid = need.grid;
  const std::uint64_t references = grid.reference_count;
  const std::uint64_t width = grid.macro_width;
  const std::uint64_t macro_cells =
      std::uint64_t{grid.macro_cell_count[0]} * grid.macro_cell_count[1] * grid.macro_cell_count[2];
  const bool projection = grid.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kProjection);
  const bool lattice = grid.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kLattice);
  BuildWork work;
  work.add(BuildStep::kBuildOnce, 1);
  work.add(BuildStep::kVertexCheck, vertex_count);
  work.add(BuildStep::kTriangleSurvey, triangle_count);
  const std::uint64_t sweeps = std::uint64_t{need.steps.sweep_count} + 1;
  if (lattice) {
    work.add(BuildStep::kLatticeSurvey, triangle_count);
    work.add(BuildStep::kLatticeBox, triangle_count * (sweeps + 1));
  } else {
    work.add(BuildStep::kCellBox, triangle_count * sweeps);
  }
  for (const CellCuts& cuts : {need.steps.swept_cuts, need.steps.cuts}) {
    work.add(BuildStep::kSquareTest, cuts.square_count);
    work.add(BuildStep::kOutline, cuts.outline_count);
    work.add(BuildStep::kSlabCut, cuts.slab_count);
    work.add(BuildStep::kPolygonCut, cuts.polygon_count);
    work.add(BuildStep::kPolygonRow, cuts.polygon_row_count);
  }
  work.add(BuildStep::kCellRow, need.steps.swept_row_count + need.steps.row_count);
  work.add(BuildStep::kReferenceInsert, references);
  work.add(lattice ? BuildStep::kLatticeSort : BuildStep::kReferenceSort, references);
  work.add(lattice ? BuildStep::kLatticeWrite : BuildStep::kTriangleWrite, references);
  if (projection) work.add(BuildStep::kProjectionSetup, references);
  work.add(lattice ? BuildStep::kLatticeCellSum : BuildStep::kCellSum,
           (grid.cell_block_count - 1) * width * width * width);
  work.add(BuildStep::kMacroWord, (macro_cells + 31) / 32);
  const std::uint64_t triangle_lines = (references * grid.triangle_bytes + kLineBytes - 1) / kLineBytes;
  work.add(BuildStep::kClearedLine, need.image_bytes / kLineBytes - triangle_lines);
  work.add(BuildStep::kCheckedLine, triangle_lines);
  work.add(BuildStep::kFarLine, far_lines(triangle_count, need, sweeps + (lattice ? 3 : 1), lines));
  return work;
}

BuildWork image_check_work(std::uint64_t piece_count) {
  const std::uint64_t lines = (piece_count * sizeof(PieceCheck) + kLineBytes - 1) / kLineBytes;
  BuildWork work;
  work.add(BuildStep::kCheckedLine, lines);
  work.add(BuildStep::kFarLine, lines + 1);  // and the image's header
  return work;
}

// clang-format off
std::string_view name_of(BuildStep step) {
  using enum BuildStep;
  struct Name {
    BuildStep step;
    std::string_view name;
  };
  static constexpr Name kNames[] = {
      {kBuildOnce, "build_once"}, {kVertexCheck, "vertex_check"}, {kTriangleSurvey, "triangle_survey"},
      {kCellBox, "cell_box"}, {kCellRow, "cell_row"}, {kSquareTest, "square_test"}, {kOutline, "outline"},
      {kSlabCut, "slab_cut"}, {kPolygonCut, "polygon_cut"}, {kPolygonRow, "polygon_row"},
      {kReferenceInsert, "reference_insert"}, {kReferenceSort, "reference_sort"}, {kTriangleWrite, "triangle_write"},
      {kProjectionSetup, "projection_setup"}, {kCellSum, "cell_sum"}, {kMacroWord, "macro_word"},
      {kClearedLine, "cleared_line"}, {kCheckedLine, "checked_line"}, {kLatticeSurvey, "lattice_survey"},
      {kLatticeBox, "lattice_box"}, {kLatticeSort, "lattice_sort"}, {kLatticeWrite, "lattice_write"},
      {kLatticeCellSum, "lattice_cell_sum"},
      {kTreeOnce, "tree_once"}, {kTreeVertexBound, "tree_vertex_bound"}, {kTreeTriangleSurvey, "tree_triangle_survey"},
      {kTreeTriangleCode, "tree_triangle_code"}, {kTreeDigitValue, "tree_digit_value"},
      {kTreeKeySorted, "tree_key_sorted"}, {kTreeKeyScattered, "tree_key_scattered"},
      {kTreeLeafSplit, "tree_leaf_split"}, {kTreeNodeSplit, "tree_node_split"}, {kTreeCrowd, "tree_crowd"},
      {kTreeCrowdKey, "tree_crowd_key"}, {kTreeTriangleWrite, "tree_triangle_write"},
      {kTreeTriangleArea, "tree_triangle_area"}, {kTreeNodeWrite, "tree_node_write"},
      {kTreeNodeOrder, "tree_node_order"},
      {kTreeCheckedLine, "tree_checked_line"},
      {kFarLine, "far_line"}, {kTreeSurveyFarLine, "tree_survey_far_line"},
      {kTreeFarLine, "tree_far_line"}, {kBvhOnce, "bvh_once"},
      {kBvhVertexCheck, "bvh_vertex_check"}, {kBvhTriangleSurvey, "bvh_triangle_survey"},
      {kBinUpdate, "bin_update"}, {kBinSwept, "bin_swept"},
      {kTriangleMoved, "triangle_moved"}, {kTriangleHalved, "triangle_halved"}, {kBoxBound, "box_bound"},
      {kNodeMade, "node_made"}, {kNodeMerged, "node_merged"}, {kNodePlaced, "node_placed"},
      {kNodeWritten, "node_written"}, {kBvhTriangleWrite, "bvh_triangle_write"}, {kBvhFarLine, "bvh_far_line"}};
  static_assert(std::size(kNames) == kBuildStepCount);
  static_assert([] {
    for (std::size_t i = 0; i < kBuildStepCount; ++i) {
      if (kNames[i].step != static_cast<BuildStep>(i)) return false;
    }
    return true;
  }(), "in the order of BuildStep");
  return kNames[static_cast<std::size_t>(step)].name;
}
// clang-format on

double build_cycles(const MasterProfile& master, const BuildWork& work) {
  double cycles = 0;
  for (std::size_t step = 0; step < kBuildStepCount; ++step) {
    cycles += master.step_cycles[step] * static_cast<double>(work.counts[step]);
  }
  return cycles;
}

double build_seconds(const MasterProfile& master, const BuildWork& work) {
  return master.clock_hz > 0 ? build_cycles(master, work) / master.clock_hz : 0;
}

}  // namespace gridiron::sim
