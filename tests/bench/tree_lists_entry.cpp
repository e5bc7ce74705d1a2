// Rays through the wide tree by lists, compiled once per instruction set. The build defines GRIDIRON_ENTRY_NAME (the
// function's) and GRIDIRON_ENTRY_LANES. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/one_lane.h>
#include <gridiron/engine/tree/ray_lists.h>

#include <cstddef>
#include <cstring>

#include "bench/tree_lists.h"

namespace gridiron::bench {
namespace {

using L = Lanes<GRIDIRON_ENTRY_LANES>;
using Memory = ListMemory<kMaxBatchRays, kMaxBatchRays, true, (L::kCount > 4)>;

// Too large for a stack.
Memory memory;

// Nodes and records where they lie.
struct Source {
  const ListTree& tree;

  [[nodiscard]] static std::uint32_t window() { return 2; }
  [[nodiscard]] Status ahead(TreeChild child) const {
    const auto* const bytes = child.is_leaf() ? reinterpret_cast<const std::byte*>(&tree.records[child.first()])
                                              : reinterpret_cast<const std::byte*>(&tree.nodes[child.node_index()]);
    const std::uint32_t count = child.is_leaf() ? child.count() * sizeof(VertexTriangle) : sizeof(TreeNode);
    for (std::uint32_t line = 0; line < count; line += 64) __builtin_prefetch(bytes + line);
    return Status::kOk;
  }
  [[nodiscard]] Status node(std::uint32_t index, const TreeNode*& node) const {
    node = &tree.nodes[index];
    return Status::kOk;
  }
  [[nodiscard]] Status leaf(TreeChild child, const VertexTriangle*& records) const {
    records = &tree.records[child.first()];
    return Status::kOk;
  }
  // Only Accuracy::kExact asks for it.
  [[nodiscard]] static Status triangle_of(MainAddress, std::uint32_t, VertexTriangle&) { return Status::kBadParameter; }
};

void load_ray(const MemoryRay& from, BatchRay& to) {
  // Two quads of words in both.
  static_assert(offsetof(MemoryRay, dir) == 16 && offsetof(BatchRay, id) == offsetof(BatchRay, dir) + 12);
  std::memcpy(to.origin, from.origin, 16);
  std::memcpy(to.dir, from.dir, 16);
}

void store_answers(const BatchRay* rays, bool any_hit, AnswerGroup& to) {
  if (any_hit) {
    std::uint32_t hits = 0;
    for (std::uint32_t i = 0; i < kGroupRays; ++i) hits |= (rays[i].id != kNoTriangle ? 1u : 0u) << i;
    to.hits = hits;
    return;
  }
  for (std::uint32_t i = 0; i < kGroupRays; ++i) {
    to.t[i] = rays[i].t;
    to.id[i] = rays[i].id;
  }
}

}  // namespace
}  // namespace gridiron::bench

void gridiron::bench::GRIDIRON_ENTRY_NAME(const ListTree& tree, std::span<const MemoryRay> rays,
                                          std::span<AnswerGroup> answers, std::uint32_t batch_rays, bool any_hit,
                                          bool are_neighbors) {
  WorkCounters work;
  Source source{tree};
  for (std::size_t first = 0; first < rays.size(); first += batch_rays) {
    const std::size_t rest = rays.size() - first;
    const auto count = static_cast<std::uint32_t>(rest < batch_rays ? rest : batch_rays);
    for (std::uint32_t i = 0; i < count; ++i) load_ray(rays[first + i], memory.rays[i]);
    RayLists<L, Memory, Source> lists(memory, source, work);
    // A source in memory has no transfers that fail.
    (void)lists.trace(RayQuestion{any_hit, are_neighbors, false, false, {}}, count, tree.largest);
    for (std::uint32_t i = 0; i < count; i += kGroupRays) {
      store_answers(memory.rays + i, any_hit, answers[(first + i) / kGroupRays]);
    }
  }
}
