// Build work of the cached BVH: the builder's counts in the steps that price both structures.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/bvh/bvh_build_work.h>
#include <gridiron/sim/machine_profile.h>

#include "support/test_mesh.h"

namespace gridiron::bvh {
namespace {

using sim::BuildStep;

TEST(BvhBuildWork, EachCountIsAStep) {
  BuildCounts counts;
  counts.bin_updates = 700;
  counts.bins_swept = 480;
  counts.binary_nodes = 5;
  counts.triangles_moved = 30;
  counts.records_written = 11;
  counts.halving_steps = 7;
  counts.boxes_bounded = 50;
  counts.wide_nodes = 4;
  counts.far_triangles = 24;
  const sim::BuildWork work = bvh_build_work(
      20, 12, counts, {.vertices_in_order = 5, .vertices_in_space = 3, .triangles_in_space = 2, .boxes_in_space = 6});
  EXPECT_EQ(work[BuildStep::kBvhOnce], 1u);
  EXPECT_EQ(work[BuildStep::kBvhVertexCheck], 20u);
  EXPECT_EQ(work[BuildStep::kBvhTriangleSurvey], 12u);
  EXPECT_EQ(work[BuildStep::kBvhTriangleWrite], 11u);
  EXPECT_EQ(work[BuildStep::kBinUpdate], 700u);
  EXPECT_EQ(work[BuildStep::kTriangleMoved], 30u);
  EXPECT_EQ(work[BuildStep::kTriangleHalved], 7u);
  EXPECT_EQ(work[BuildStep::kBoxBound], 50u);
  EXPECT_EQ(work[BuildStep::kNodeMerged], 4u);
  EXPECT_EQ(work[BuildStep::kNodePlaced], 4u);
  EXPECT_EQ(work[BuildStep::kNodeWritten], 4u);
  EXPECT_EQ(work[BuildStep::kBvhFarLine], 5u + 3u + 2u + 2 * 24 * 6 / 12);
  EXPECT_EQ(work[BuildStep::kBinSwept], 480u);
  EXPECT_EQ(work[BuildStep::kNodeMade], 5u);
  EXPECT_EQ(work[BuildStep::kCellBox] + work[BuildStep::kReferenceSort] + work[BuildStep::kCheckedLine], 0u);
}

// Nodes are those of the tree of pairs; every node that is no leaf was swept, over three axes, there and back at most.
TEST(BvhBuildWork, SweepsOfARealTree) {
  const test::TestMesh mesh = test::make_torus(80, 40, 1.0f, 0.35f);
  const auto work_of = [&mesh](std::uint32_t bin_count, Bvh& bvh) {
    EXPECT_EQ(build_bvh(mesh.view(), {.bin_count = bin_count}, bvh), Status::kOk);
    return bvh_build_work(mesh.view().vertices.size(), mesh.view().triangles.size(), bvh.counts, {});
  };
  Bvh bvh, coarse;
  const sim::BuildWork work = work_of(16, bvh);
  EXPECT_EQ(work[BuildStep::kBvhTriangleWrite], mesh.view().triangles.size());
  EXPECT_EQ(work[BuildStep::kNodeMade], bvh.counts.binary_nodes);
  EXPECT_GE(work[BuildStep::kNodeMade], 2 * (work[BuildStep::kBvhTriangleWrite] / bvh.parameters.leaf_triangles) - 1);
  EXPECT_GE(work[BuildStep::kBinSwept], (bvh.counts.binary_nodes - bvh.counts.leaves) * 16);
  EXPECT_LE(work[BuildStep::kBinSwept], bvh.counts.binary_nodes * 3 * 2 * 16);
  EXPECT_LT(work_of(6, coarse)[BuildStep::kBinSwept], work[BuildStep::kBinSwept] / 2);
  const sim::MasterProfile& master = sim::find_machine_profile("cell-ps3")->master;
  const double bins = master.step_cycles[static_cast<std::size_t>(BuildStep::kBinUpdate)] *
                      static_cast<double>(work[BuildStep::kBinUpdate]);
  EXPECT_GT(sim::build_cycles(master, work), bins);
}

}  // namespace
}  // namespace gridiron::bvh
