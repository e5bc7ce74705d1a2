// First pass of a build: bounds runs of vertices and checks their coordinates.
// Memory: the pass's store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/passes/build_plan.h>
#include <gridiron/build/passes/pass_tools.h>
#include <gridiron/build/tree/tree_box.h>

namespace gridiron {

struct BoundsStore {
  alignas(128) std::byte vertices[2 * window_bytes<Vec3>(kVertexWindow)];
  CornerBox part;
};

/// Writes vertex_parts. Items: vertex_items. Errors: kBadVertex.
template <class P>
[[nodiscard]] Status run_bounds_pass(BuildTransfers<P>& transfers, BoundsStore& store, const BuildPlan& plan) {
  const auto bound = [&](std::uint32_t item) -> Status {
    const std::uint64_t first = std::uint64_t{item} * kVertexItem;
    const std::uint64_t rest = plan.input.vertex_count - first;
    const CornerQuad limit(kCoordinateLimit);
    QuadBox box;
    Lanes<4>::Mask inside = limit <= limit;
    GRIDIRON_TRY((for_each_window<Vec3, kVertexWindow>(transfers, store.vertices, plan.input.vertices, first,
                                                       first + (rest < kVertexItem ? rest : std::uint64_t{kVertexItem}),
                                                       kFirstMacroTag,
                                                       [&](const Vec3* vertices, std::uint64_t, std::uint32_t count) {
                                                         // Behind the last one are other bytes of the buffer.
                                                         const std::span<const Vec3> points(vertices, count);
                                                         transfers.add_work(BuildWork::kVertex, count);
                                                         for (std::uint32_t i = 0; i < count; ++i) {
                                                           const CornerQuad point = inner_quad(points, i);
                                                           box.add(point);
                                                           inside = inside & (Lanes<4>::abs(point) <= limit);
                                                         }
                                                         return Status::kOk;
                                                       })));
    if ((inside.bits() & 7u) != 7u) return Status::kBadVertex;
    store.part.low = box.low;
    store.part.high = box.high;
    GRIDIRON_TRY(transfers.put(&store.part, plan.vertex_parts.offset_by(sizeof(CornerBox) * std::uint64_t{item}),
                               sizeof(CornerBox), kFirstOutputTag));
    return transfers.wait(kFirstOutputTag);
  };
  return for_each_item(transfers, plan.vertex_items, bound);
}

}  // namespace gridiron
