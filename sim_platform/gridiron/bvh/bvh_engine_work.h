// The record of the cached BVH's kinds of work: names, prices, wait levels.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/bvh/bvh_costs.h>
#include <gridiron/bvh/bvh_work.h>
#include <gridiron/sim/engine_work.h>

#include <array>
#include <cstdint>

namespace gridiron::bvh {

// clang-format off
inline constexpr sim::WorkKind kBvhWorkKinds[] = {
    {BvhWork::kPacketStart, "packet_start", true}, {BvhWork::kMixedStart, "mixed_start", true},
    {BvhWork::kNodeStep, "node_step"}, {BvhWork::kMixedNodeStep, "mixed_node_step"}, {BvhWork::kChildren, "children"},
    {BvhWork::kStackPop, "stack_pop"}, {BvhWork::kCacheLookup, "cache_lookup"}, {BvhWork::kMiss, "miss"},
    {BvhWork::kSwitch, "switch"}, {BvhWork::kLeafVisit, "leaf_visit"}, {BvhWork::kLeafTriangle, "leaf_triangle"},
    {BvhWork::kReach, "reach"}};
// clang-format on

/// The kinds of kBvhCosts in its order: core's kTileStart, then the BVH's own.
[[nodiscard]] constexpr WorkId kind_of_cost(std::uint32_t row) {
  return row == 0 ? WorkId(Work::kTileStart) : WorkId(kSharedWorkCount + row - 1);
}

inline constexpr auto kBvhPrices = [] {
  std::array<sim::WorkPrice, kBvhCosts.size()> prices{};
  for (std::uint32_t i = 0; i < prices.size(); ++i) prices[i] = {kind_of_cost(i), kBvhCosts[i].cycles};
  return prices;
}();

/// The cached BVH. Its prices are those of a core of two pipes whatever the machine.
inline constexpr sim::EngineWork kBvhEngine =
    sim::EngineWork::make(BvhWork::kEnd, {.id = kFirstOtherEngine,  // bvh_core.h's kId
                                          .name = "bvh",
                                          .kinds = kBvhWorkKinds,
                                          .prices = kBvhPrices,
                                          .wait_levels = {"tile", "macrocell", "triangle", "setup"}});

}  // namespace gridiron::bvh
