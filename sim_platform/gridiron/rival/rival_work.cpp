// Costs of the rival's work. SPDX-License-Identifier: Apache-2.0
#include <gridiron/rival/rival_work.h>

#include <cstddef>

namespace gridiron::rival {

namespace {

struct KindFacts {
  std::string_view name;
  double cycles;
};

/// ESTIMATES, counted by hand: even instructions, plus the odd ones that find no even partner,
/// plus half a branch miss (9) where a branch goes either way, plus latency that nothing covers.
constexpr std::array<KindFacts, kRivalWorkCount> kFacts = {{
    // Set by multiply and mask 4, load of four tags 6, compare and gather 5, way by table 6, ages 6, slot address 3.
    {"cache_lookup", 30},
    // Largest age of four by compare and select 8, tag and state stored 4, slot and main address 8; the branch to it 9.
    // The command itself is the profile's issue_cycles.
    {"refill", 29},
    // Stack pointer, reference and slot stored 6, the next packet's loaded 10, its planes and axes into registers 22
    // loads, is its line there 4, indirect branch 18.
    {"switch", 60},
    // Four planes * (3 multiply-adds, compare) 16, merging 3, three axes * (2 multiply-adds, maximum, minimum) 12,
    // compare, masks 4: 35 even; 18 loads of bounds, 4 of and for results: 22 odd, of which 9 pair; the first load and
    // the chain of a plane, half hidden 12; no child is met or some 9.
    {"node_step", 69},
    // Lane to scalar 4, compare with those before and move 8, store of the entry 3, half a miss 9.
    {"child_push", 24},
    // Load of the entry 6, compare with the reach 2, goes either way 9, stack pointer 1, leaf or node 2.
    {"stack_pop", 20},
    // Three axes * (estimate, Newton step 3): 12 even; 3 loads, 3 stores, 3 estimates: 9 odd, of which 4 pair.
    {"reciprocal_group", 17},
    // Six differences to the origin in two vectors 4; six splats and loads 12 odd, of which 4 pair.
    {"box_setup", 12},
    // Six multiplications, 3 maxima, 3 minima, 2 multiply-adds, minimum with t, compare: 16 even; 4 loads, gather, mask
    // of active rays 3: 8 odd, of which 3 pair; ends the loop or not 5.
    {"box_group", 26},
    // First record's address, bounds of the loop over triangles, subpackets to look at.
    {"leaf_visit", 20},
}};

}  // namespace

std::string_view name_of(RivalWork kind) {
  return kFacts[static_cast<std::size_t>(kind)].name;
}

double cycles_of(RivalWork kind) {
  return kFacts[static_cast<std::size_t>(kind)].cycles;
}

sim::MachineProfile with_rival_costs(sim::MachineProfile machine) {
  for (std::uint32_t i = 0; i < kRivalWorkCount; ++i) {
    const auto kind = static_cast<RivalWork>(i);
    machine.work_cycles[static_cast<std::size_t>(carrier_of(kind))] = cycles_of(kind);
  }
  return machine;
}

}  // namespace gridiron::rival
