// Costs of the rival's work. SPDX-License-Identifier: Apache-2.0
#include <gridiron/rival/rival_costs.h>
#include <gridiron/rival/rival_work.h>

#include <cstddef>

namespace gridiron::rival {

std::string_view name_of(RivalWork kind) {
  constexpr std::array<std::string_view, kRivalWorkCount> kNames = {
      "tile_start",   "packet_start", "mixed_start", "node_step",  "mixed_node_step", "children", "stack_pop",
      "cache_lookup", "miss",         "switch",      "leaf_visit", "leaf_triangle",   "reach"};
  return kNames[static_cast<std::size_t>(kind)];
}

double cycles_of(RivalWork kind) {
  return kRivalCosts[static_cast<std::size_t>(kind)].cycles;
}

sim::MachineProfile with_rival_costs(sim::MachineProfile machine) {
  for (std::uint32_t i = 0; i < kRivalWorkCount; ++i) {
    const auto kind = static_cast<RivalWork>(i);
    machine.work_cycles[static_cast<std::size_t>(carrier_of(kind))] = cycles_of(kind);
  }
  return machine;
}

}  // namespace gridiron::rival
