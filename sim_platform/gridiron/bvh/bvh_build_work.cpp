// Build work of the cached BVH: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/bvh/bvh_build_work.h>

namespace gridiron::bvh {

sim::BuildWork bvh_build_work(std::uint64_t vertex_count, std::uint64_t triangle_count, const BuildCounts& counts) {
  using sim::BuildStep;
  sim::BuildWork work;
  work.add(BuildStep::kVertexCheck, vertex_count);
  work.add(BuildStep::kTriangleSurvey, triangle_count);
  work.add(BuildStep::kTriangleWrite, counts.records_written);
  work.add(BuildStep::kBinUpdate, counts.bin_updates);
  work.add(BuildStep::kTriangleMoved, counts.triangles_moved);
  work.add(BuildStep::kBinSwept, counts.bins_swept);
  work.add(BuildStep::kNodeMade, counts.binary_nodes);
  return work;
}

}  // namespace gridiron::bvh
