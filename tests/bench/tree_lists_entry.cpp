// Rays through the wide tree by lists, compiled once per instruction set. The build defines GRIDIRON_ENTRY_NAME (the
// function's) and GRIDIRON_ENTRY_LANES. SPDX-License-Identifier: Apache-2.0
#include <gridiron/engine/tree/ray_lists.h>

#include <cstring>
#include <optional>

#include "bench/tree_lists.h"

namespace gridiron::bench {
namespace {

using L = Lanes<GRIDIRON_ENTRY_LANES>;
using Lists = RayLists<L, kMaxBatchRays>;
static_assert(kGroupRays == kWalkRays);

// Too large for a stack. Made anew for each call, which writes a few words.
std::optional<Lists> lists;
ListRays batch[kMaxBatchRays / kGroupRays];

void load_group(const RayGroup& from, ListRays& to) {
  std::memcpy(to.origin, from.origin, sizeof(to.origin));
  std::memcpy(to.dir, from.dir, sizeof(to.dir));
  std::memcpy(to.t, from.t, sizeof(to.t));
  for (std::uint32_t& id : to.id) id = kNoTriangle;
  set_up_list_rays<L>(to);
}

void store_answers(const ListRays& from, bool any_hit, AnswerGroup& to) {
  if (any_hit) {
    std::uint32_t hits = 0;
    for (std::uint32_t i = 0; i < kGroupRays; ++i) hits |= (from.id[i] != kNoTriangle ? 1u : 0u) << i;
    to.hits = hits;
  } else {
    std::memcpy(to.t, from.t, sizeof(to.t));
    std::memcpy(to.id, from.id, sizeof(to.id));
  }
}

}  // namespace
}  // namespace gridiron::bench

void gridiron::bench::GRIDIRON_ENTRY_NAME(const ListTree& tree, std::span<const RayGroup> rays,
                                          std::span<AnswerGroup> answers, std::uint32_t batch_rays, bool any_hit) {
  WorkCounters work;
  lists.emplace(tree.nodes.data(), tree.records.data(), work);
  const std::size_t batch_groups = batch_rays / kGroupRays;
  for (std::size_t first = 0; first < rays.size(); first += batch_groups) {
    const std::size_t count = rays.size() - first < batch_groups ? rays.size() - first : batch_groups;
    for (std::size_t i = 0; i < count; ++i) load_group(rays[first + i], batch[i]);
    lists->trace(batch, static_cast<std::uint32_t>(count) * kGroupRays, any_hit);
    for (std::size_t i = 0; i < count; ++i) store_answers(batch[i], any_hit, answers[first + i]);
  }
}
