// Build work of the cached BVH: the steps of building a hierarchy, priced by the same table as the grid's.
// Memory: plain values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/bvh/bvh.h>
#include <gridiron/sim/build_work.h>

#include <cstdint>

namespace gridiron::bvh {

/// Steps of build_bvh.
///
/// @param vertex_count, triangle_count  of the mesh, dropped triangles included.
/// @param lines                         of the mesh.
[[nodiscard]] sim::BuildWork bvh_build_work(std::uint64_t vertex_count, std::uint64_t triangle_count,
                                            const BuildCounts& counts, const sim::MeshLines& lines);

}  // namespace gridiron::bvh
