// Costs of the cached BVH's work. SPDX-License-Identifier: Apache-2.0
#include <gridiron/bvh/bvh_costs.h>
#include <gridiron/bvh/bvh_work.h>

#include <cstddef>

namespace gridiron::bvh {

std::string_view name_of(BvhWork kind) {
  constexpr std::array<std::string_view, kBvhWorkCount> kNames = {
      "tile_start",   "packet_start", "mixed_start", "node_step",  "mixed_node_step", "children", "stack_pop",
      "cache_lookup", "miss",         "switch",      "leaf_visit", "leaf_triangle",   "reach"};
  return kNames[static_cast<std::size_t>(kind)];
}

double cycles_of(BvhWork kind) {
  return kBvhCosts[static_cast<std::size_t>(kind)].cycles;
}

sim::MachineProfile with_bvh_costs(sim::MachineProfile machine) {
  for (std::uint32_t i = 0; i < kBvhWorkCount; ++i) {
    const auto kind = static_cast<BvhWork>(i);
    machine.work_cycles[static_cast<std::size_t>(carrier_of(kind))] = cycles_of(kind);
  }
  return machine;
}

}  // namespace gridiron::bvh
