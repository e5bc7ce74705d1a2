// Build work: counts of a grid small enough to count by hand, and their cycles. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/build_work.h>

#include "support/test_headers.h"

namespace gridiron::sim {
namespace {

/// Half of the unit square, and a triangle of zero area.
struct SmallMesh {
  std::vector<Vec3> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}};
  std::vector<UVec3> triangles{{0, 1, 2}, {3, 3, 3}};
  [[nodiscard]] MeshView view() const { return {vertices, triangles}; }
};

GridNeed need_of(const MeshView& mesh, const GridParameters& parameters) {
  GridNeed need{};
  EXPECT_EQ(count_scene_image(mesh, parameters, need), Status::kOk);
  return need;
}

TEST(BuildWork, GridOfOneTriangleCountedByHand) {
  const SmallMesh mesh;
  GridParameters parameters;
  parameters.lambda = 4.0f;  // 2 x 2 x 1 cells in one macrocell; the triangle stays out of one
  const GridNeed need = need_of(mesh.view(), parameters);
  ASSERT_EQ(need.grid.reference_count, 3u);
  EXPECT_EQ(need.steps.sweep_count, 1u);
  EXPECT_EQ(need.steps.row_count, 2u);
  EXPECT_EQ(need.steps.swept_row_count, 2u);

  const BuildWork work = grid_build_work(4, 2, need);
  EXPECT_EQ(work[BuildStep::kVertexCheck], 4u);
  EXPECT_EQ(work[BuildStep::kTriangleSurvey], 2u);
  EXPECT_EQ(work[BuildStep::kCellBox], 4u);
  EXPECT_EQ(work[BuildStep::kCellRow], 4u);
  EXPECT_EQ(work[BuildStep::kReferenceInsert], 3u);
  EXPECT_EQ(work[BuildStep::kReferenceSort], 3u);
  EXPECT_EQ(work[BuildStep::kTriangleWrite], 3u);
  EXPECT_EQ(work[BuildStep::kProjectionSetup], 0u);
  EXPECT_EQ(work[BuildStep::kCellSum], 216u);
  EXPECT_EQ(work[BuildStep::kMacroWord], 1u);
  EXPECT_EQ(work[BuildStep::kCheckedLine] * kLineBytes, need.image_bytes);
  EXPECT_EQ(work[BuildStep::kBinUpdate] + work[BuildStep::kTriangleMoved] + work[BuildStep::kNodeMade], 0u);

  parameters.format = TriangleFormat::kProjection;
  EXPECT_EQ(grid_build_work(4, 2, need_of(mesh.view(), parameters))[BuildStep::kProjectionSetup], 3u);
}

TEST(BuildWork, SweepsBeyondTheFirstAreCounted) {
  // Two triangles in opposite corners of a grid of 60^3 macrocells, more than a sweep's window of 16,384 holds.
  const std::vector<Vec3> vertices{{0, 0, 0}, {1e-3f, 0, 0}, {0, 1e-3f, 0}, {1, 1, 1}, {0.999f, 1, 1}, {1, 0.999f, 1}};
  const std::vector<UVec3> triangles{{0, 1, 2}, {3, 4, 5}};
  GridParameters parameters;
  parameters.lambda = 108000.0f;
  parameters.macro_width = 1;
  const GridNeed need = need_of({vertices, triangles}, parameters);
  EXPECT_EQ(need.steps.sweep_count, 2u);
  EXPECT_EQ(need.grid.reference_count, 2u);
  EXPECT_EQ(need.steps.row_count, 2u);
  EXPECT_EQ(need.steps.swept_row_count, 3u) << "the second sweep passes over the first triangle";
  EXPECT_EQ(grid_build_work(6, 2, need)[BuildStep::kCellBox], 6u);
  EXPECT_EQ(grid_build_work(6, 2, need)[BuildStep::kCellRow], 5u);
}

TEST(BuildWork, CyclesAreTheSumOverSteps) {
  MasterProfile master{.clock_hz = 1000, .step_cycles = {}};
  BuildWork work;
  double expected = 0;
  for (std::size_t step = 0; step < kBuildStepCount; ++step) {
    master.step_cycles[step] = static_cast<double>(step) + 0.5;
    work.add(static_cast<BuildStep>(step), 10 * step + 1);
    expected += (static_cast<double>(step) + 0.5) * static_cast<double>(10 * step + 1);
  }
  EXPECT_EQ(build_cycles(master, work), expected);
  EXPECT_EQ(build_seconds(master, work), expected / 1000);
  master.clock_hz = 0;
  EXPECT_EQ(build_seconds(master, work), 0);
  EXPECT_EQ(build_cycles(master, BuildWork{}), 0);
}

TEST(BuildWork, EveryBuiltInMachineHasAMaster) {
  for (const MachineProfile& machine : machine_profiles()) {
    EXPECT_GT(machine.master.clock_hz, 0) << machine.name;
    for (const double cycles : machine.master.step_cycles) EXPECT_GT(cycles, 0) << machine.name;
  }
}

}  // namespace
}  // namespace gridiron::sim
