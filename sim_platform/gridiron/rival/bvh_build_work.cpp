// Build work of the rival: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/rival/bvh_build_work.h>

namespace gridiron::rival {

sim::BuildWork bvh_build_work(std::uint64_t vertex_count, std::uint64_t triangle_count, const BuildCounts& counts) {
  using sim::BuildStep;
  // A kNodeMade is priced for 3 axes * 16 bins, there and back, of 18 cycles each, and 272 for the rest of the node.
  constexpr std::uint64_t kBin = 18, kRest = 272, kNode = std::uint64_t{3} * 16 * 2 * kBin + kRest;
  sim::BuildWork work;
  work.add(BuildStep::kVertexCheck, vertex_count);
  work.add(BuildStep::kTriangleSurvey, triangle_count);
  work.add(BuildStep::kTriangleWrite, counts.records_written);
  work.add(BuildStep::kBinUpdate, counts.bin_updates);
  work.add(BuildStep::kTriangleMoved, counts.triangles_moved);
  work.add(BuildStep::kNodeMade, (counts.bins_swept * kBin + counts.binary_nodes * kRest + kNode - 1) / kNode);
  return work;
}

}  // namespace gridiron::rival
