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

  const BuildWork work = grid_build_work(4, 2, need, {});
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
  EXPECT_EQ(work[BuildStep::kSquareTest], 2u);
  EXPECT_EQ(work[BuildStep::kOutline] + work[BuildStep::kSlabCut] + work[BuildStep::kPolygonCut], 0u);
  EXPECT_EQ(work[BuildStep::kCheckedLine], 2u) << "three records of 48 bytes";
  EXPECT_EQ((work[BuildStep::kCheckedLine] + work[BuildStep::kClearedLine]) * kLineBytes, need.image_bytes);
  EXPECT_EQ(work[BuildStep::kFarLine], 0u);
  EXPECT_EQ(work[BuildStep::kBinUpdate] + work[BuildStep::kTriangleMoved] + work[BuildStep::kNodeMade], 0u);

  parameters.format = TriangleFormat::kProjection;
  EXPECT_EQ(grid_build_work(4, 2, need_of(mesh.view(), parameters), {})[BuildStep::kProjectionSetup], 3u);

  parameters.format = TriangleFormat::kLattice;
  const BuildWork lattice = grid_build_work(4, 2, need_of(mesh.view(), parameters), {});
  EXPECT_EQ(lattice[BuildStep::kLatticeSurvey], 2u);
  EXPECT_EQ(lattice[BuildStep::kLatticeBox], 6u) << "surveyed, swept and listed";
  EXPECT_EQ(lattice[BuildStep::kLatticeSort], lattice[BuildStep::kLatticeWrite]);
  EXPECT_EQ(lattice[BuildStep::kReferenceSort] + lattice[BuildStep::kTriangleWrite] + lattice[BuildStep::kCellBox], 0u);
}

TEST(BuildWork, FarLinesFollowFromTheMeshesLines) {
  const SmallMesh mesh;
  const GridNeed need = need_of(mesh.view(), {});
  const MeshLines lines{.vertices_in_order = 100, .vertices_in_space = 10, .triangles_in_space = 1};
  EXPECT_EQ(grid_build_work(4, 2, need, lines)[BuildStep::kFarLine], 311u) << "surveyed, swept, listed; written";
}

TEST(MeshLines, OrderDecides) {
  // A strip of some 60,000 triangles, more than the cache holds.
  std::vector<Vec3> vertices;
  std::vector<UVec3> triangles;
  for (std::uint32_t i = 0; i < 60'000; ++i) {
    vertices.emplace_back(static_cast<float>(i), static_cast<float>(i % 2), 0.0f);
    if (i >= 2) triangles.emplace_back(i - 2, i - 1, i);
  }
  const MeshLines ordered = count_mesh_lines({vertices, triangles});
  EXPECT_LT(ordered.vertices_in_order, 10u);
  EXPECT_LT(ordered.triangles_in_space, 10u + triangles.size() / 20);
  std::vector<UVec3> scattered;
  for (std::size_t i = 0; i < triangles.size(); ++i) scattered.push_back(triangles[i * 7919 % triangles.size()]);
  const MeshLines far = count_mesh_lines({vertices, scattered});
  EXPECT_GT(far.vertices_in_order, triangles.size() / 4);
  EXPECT_GT(far.triangles_in_space, triangles.size() / 4);
  EXPECT_GT(far.boxes_in_space, far.triangles_in_space);
  EXPECT_EQ(count_mesh_lines({std::span(vertices).first(4), std::span(triangles).first(2)}).vertices_in_order, 0u);
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
  EXPECT_EQ(grid_build_work(6, 2, need, {})[BuildStep::kCellBox], 6u);
  EXPECT_EQ(grid_build_work(6, 2, need, {})[BuildStep::kCellRow], 5u);
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
