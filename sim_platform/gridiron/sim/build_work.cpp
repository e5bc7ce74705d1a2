// Build work: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/build_work.h>

namespace gridiron::sim {

BuildWork grid_build_work(std::uint64_t vertex_count, std::uint64_t triangle_count, const GridNeed& need) {
  const GridRecord& grid = need.grid;
  const std::uint64_t references = grid.reference_count;
  const std::uint64_t width = grid.macro_width;
  const std::uint64_t macro_cells =
      std::uint64_t{grid.macro_cell_count[0]} * grid.macro_cell_count[1] * grid.macro_cell_count[2];
  const bool projection = grid.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kProjection);
  BuildWork work;
  work.add(BuildStep::kVertexCheck, vertex_count);
  work.add(BuildStep::kTriangleSurvey, triangle_count);
  work.add(BuildStep::kCellBox, triangle_count * (std::uint64_t{need.steps.sweep_count} + 1));
  work.add(BuildStep::kCellRow, need.steps.swept_row_count + need.steps.row_count);
  work.add(BuildStep::kReferenceInsert, references);
  work.add(BuildStep::kReferenceSort, references);
  work.add(BuildStep::kTriangleWrite, references);
  if (projection) work.add(BuildStep::kProjectionSetup, references);
  work.add(BuildStep::kCellSum, (grid.cell_block_count - 1) * width * width * width);
  work.add(BuildStep::kMacroWord, (macro_cells + 31) / 32);
  work.add(BuildStep::kCheckedLine, need.image_bytes / kLineBytes);
  return work;
}

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
