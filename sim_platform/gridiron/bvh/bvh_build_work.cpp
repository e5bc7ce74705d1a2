// Build work of the cached BVH: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/bvh/bvh_build_work.h>

namespace gridiron::bvh {

sim::BuildWork bvh_build_work(std::uint64_t vertex_count, std::uint64_t triangle_count, const BuildCounts& counts,
                              const sim::MeshLines& lines) {
  using sim::BuildStep;
  sim::BuildWork work;
  work.add(BuildStep::kBvhOnce, 1);
  work.add(BuildStep::kBvhVertexCheck, vertex_count);
  work.add(BuildStep::kBvhTriangleSurvey, triangle_count);
  work.add(BuildStep::kBinUpdate, counts.bin_updates);
  work.add(BuildStep::kBinSwept, counts.bins_swept);
  work.add(BuildStep::kTriangleMoved, counts.triangles_moved);
  work.add(BuildStep::kTriangleHalved, counts.halving_steps);
  work.add(BuildStep::kBoxBound, counts.boxes_bounded);
  work.add(BuildStep::kNodeMade, counts.binary_nodes);
  work.add(BuildStep::kNodeMerged, counts.wide_nodes);
  work.add(BuildStep::kNodePlaced, counts.wide_nodes);
  work.add(BuildStep::kNodeWritten, counts.wide_nodes);
  work.add(BuildStep::kBvhTriangleWrite, counts.records_written);
  // The survey meets vertices as the mesh has them, writing meets all by their place in space. So do, with boxes, the
  // two passes over the triangles of a node that is neither small enough for the cache nor so large that its boxes
  // still lie one behind the other.
  constexpr std::uint64_t kPasses = 2;  // bins, sides
  const std::uint64_t far_boxes =
      triangle_count == 0 ? 0 : kPasses * counts.far_triangles * lines.boxes_in_space / triangle_count;
  work.add(BuildStep::kBvhFarLine,
           lines.vertices_in_order + lines.triangles_in_space + lines.vertices_in_space + far_boxes);
  return work;
}

}  // namespace gridiron::bvh
