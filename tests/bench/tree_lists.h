// Rays through the wide tree by lists, for the benchmark of rays: one function for each build of the same source. All
// that the benchmark knows of the engine is here and in tree_lists_entry.cpp.
// Memory: caller's; buffers of a batch are static. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/tree_records.h>

#include <cstdint>
#include <span>

namespace gridiron::bench {

inline constexpr std::uint32_t kGroupRays = 16;
inline constexpr std::uint32_t kMaxBatchRays = 2048;

/// A tree in memory; borrowed.
struct ListTree {
  std::span<const TreeNode> nodes;
  std::span<const VertexTriangle> records;
  float largest;  ///< |coordinate| of the triangles
};

/// A ray as it lies in memory: what defines it, nothing derived.
struct alignas(32) MemoryRay {
  float origin[3], t, dir[3];
  std::uint32_t id;  ///< kNoTriangle: as BatchRay has it before anything was hit
};

/// Answers of 16 rays. Of any hit `hits` alone is written.
struct AnswerGroup {
  alignas(64) float t[kGroupRays];  ///< of the nearest hit
  std::uint32_t id[kGroupRays];     ///< its triangle, kNoTriangle without one
  std::uint32_t hits;               ///< bit i: ray i hits something
};

/// Answers rays[i] in answers[i / kGroupRays].
/// @param batch_rays     traced together: a multiple of kGroupRays, at most kMaxBatchRays.
/// @param are_neighbors  as in RayQuestion.
using TraceLists = void(const ListTree& tree, std::span<const MemoryRay> rays, std::span<AnswerGroup> answers,
                        std::uint32_t batch_rays, bool any_hit, bool are_neighbors);

extern "C" {
TraceLists gridiron_bench_trace_lanes4;
TraceLists gridiron_bench_trace_lanes8;
TraceLists gridiron_bench_trace_lanes16;
}

}  // namespace gridiron::bench
