// The committed table of work costs is the one that the kernel's operations come to today.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/work_costs.h>
#include <gtest/gtest.h>
#include <work_table.h>

#include <cstddef>
#include <string>

namespace gridiron::calibrate {
namespace {

// What is counted is the same with every compiler: it is compared to the last digit of the table. The schedule depends
// a little on the order in which a compiler evaluates operands: up to 1 % between GCC and clang were seen.
// count_frames() itself throws where the counted kernel renders another picture or does other work than the kernel.
TEST(WorkTable, CommittedTableIsThatOfTodaysKernel) {
  constexpr double kLastDigit = 0.00501;
  constexpr double kScheduleTolerance = 0.02;
  const Totals totals = count_frames();
  for (std::size_t kind = 0; kind < kWorkKindCount; ++kind) {
    const sim::WorkCost& cost = sim::kWorkCosts[kind];
    const KindTotals& counted = totals[kind];
    if (cost.cycles == 0) continue;  // commands and waits
    SCOPED_TRACE("kind " + std::to_string(kind) +
                 ": if the kernel's operations changed, write the table anew with\n  build/host/bin/gridiron_calibrate "
                 "sim_platform/gridiron/sim/work_costs.h");
    ASSERT_GT(counted.units, 0u);
    const auto per_unit = [&](auto value) { return static_cast<double>(value) / static_cast<double>(counted.units); };
    const auto count_of = [&](OpClass op) { return per_unit(counted.operations[static_cast<std::size_t>(op)]); };
    EXPECT_NEAR(per_unit(counted.even()), cost.even, kLastDigit);
    EXPECT_NEAR(count_of(OpClass::kDouble), cost.doubles, kLastDigit);
    EXPECT_NEAR(per_unit(counted.odd()), cost.odd, kLastDigit);
    EXPECT_NEAR(count_of(OpClass::kBranch), cost.branches, kLastDigit);
    EXPECT_NEAR(per_unit(counted.misses), cost.misses, kLastDigit);
    EXPECT_NEAR(per_unit(counted.cycles()), cost.cycles, kScheduleTolerance * cost.cycles);
    EXPECT_NEAR(per_unit(counted.resource_cycles()), cost.least_cycles, 0.0501);
  }
}

TEST(WorkTable, ProfileChargesTheTable) {
  const sim::MachineProfile& machine = *sim::find_machine_profile("cell-ps3");
  for (std::size_t kind = 0; kind < kWorkKindCount; ++kind) {
    EXPECT_EQ(machine.work_cycles[kind], sim::kWorkCosts[kind].cycles) << "kind " << kind;
    EXPECT_LE(sim::kWorkCosts[kind].cycles, sim::kWorkCosts[kind].most_cycles) << "kind " << kind;
  }
}

}  // namespace
}  // namespace gridiron::calibrate
