// The committed table of work costs is the one that the kernel's operations come to today.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/bvh/bvh_engine_work.h>
#include <gridiron/sim/instruction_costs.h>
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/work_costs.h>
#include <work_table.h>

#include "support/test_headers.h"

namespace gridiron::calibrate {
namespace {

// What is counted is the same with every compiler: it is compared to the last digit of the table. The schedule depends
// a little on the order in which a compiler evaluates operands: up to 1 % between GCC and clang were seen.
void expect_same(const sim::WorkCost& cost, const KindTotals& counted) {
  constexpr double kLastDigit = 0.00501;
  constexpr double kScheduleTolerance = 0.02;
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

// count_frames() and count_bvh_frames() throw where the counted twin renders another picture or does other work.
TEST(WorkTable, CommittedTableIsThatOfTodaysKernel) {
  const Totals totals = count_frames();
  for (std::size_t kind = 0; kind < sim::kWorkCosts.size(); ++kind) {
    if (sim::kWorkCosts[kind].cycles == 0) continue;  // commands and waits
    SCOPED_TRACE("kind " + std::to_string(kind) +
                 ": if the kernel's operations changed, write the table anew with\n  build/host/bin/gridiron_calibrate "
                 "sim_platform/gridiron/sim/work_costs.h");
    expect_same(sim::kWorkCosts[kind], totals[kind]);
  }
}

TEST(WorkTable, CommittedTableOfTheBvhIsThatOfToday) {
  const Totals totals = count_bvh_frames();
  for (std::uint32_t i = 0; i < bvh::kBvhCosts.size(); ++i) {
    const WorkId kind = bvh::kind_of_cost(i);
    SCOPED_TRACE(std::string(sim::work_kind(kind, bvh::kBvhEngine).name) +
                 ": if the cached BVH's operations changed, or the kernel's that it calls, write the table anew with\n"
                 "  build/host/bin/gridiron_calibrate --bvh sim_platform/gridiron/bvh/bvh_costs.h");
    expect_same(bvh::kBvhCosts[i], totals[kind.number()]);
  }
}

TEST(WorkTable, BvhChargesItsTableAndTheKernelsForAllElse) {
  const sim::MachineProfile& machine = *sim::find_machine_profile("cell-ps3");
  std::array<double, kWorkKindCount> expected = machine.work_cycles;
  for (std::uint32_t i = 0; i < bvh::kBvhCosts.size(); ++i) {
    const WorkId kind = bvh::kind_of_cost(i);
    expected[kind.number()] = bvh::kBvhCosts[i].cycles;
    EXPECT_LE(bvh::kBvhCosts[i].cycles, bvh::kBvhCosts[i].most_cycles) << sim::work_kind(kind, bvh::kBvhEngine).name;
  }
  EXPECT_EQ(sim::work_prices(machine.work_cycles, bvh::kBvhEngine), expected);
  EXPECT_EQ(expected[static_cast<std::size_t>(Work::kTileStart)], bvh::kBvhCosts[0].cycles);
  EXPECT_EQ(expected[static_cast<std::size_t>(bvh::BvhWork::kReach)], bvh::kBvhCosts.back().cycles);
}

TEST(WorkTable, ProfileChargesTheTable) {
  const sim::MachineProfile& machine = *sim::find_machine_profile("cell-ps3");
  for (std::size_t kind = 0; kind < sim::kWorkCosts.size(); ++kind) {
    EXPECT_EQ(machine.work_cycles[kind], sim::kWorkCosts[kind].cycles) << "kind " << kind;
    EXPECT_LE(sim::kWorkCosts[kind].cycles, sim::kWorkCosts[kind].most_cycles) << "kind " << kind;
  }
}

// What it counts comes from tools/calibrate/second_opinion/run; that needs a cross compiler. Here: no kind is left out,
// none is there twice, and none was moved by a kind that was put before it.
TEST(WorkTable, ProfileOfInstructionsChargesItsTable) {
  const sim::MachineProfile& machine = *sim::find_machine_profile("fu540");
  std::array<double, kWorkKindCount> expected{};
  for (const sim::InstructionCost& cost : sim::kInstructionCosts) {
    const std::size_t kind = cost.kind.number();
    SCOPED_TRACE(std::string(sim::work_kind(cost.kind).name) +
                 ": write the table anew with\n  tools/calibrate/second_opinion/run build/host riscv64 --header > "
                 "sim_platform/gridiron/sim/instruction_costs.h");
    EXPECT_EQ(expected[kind], 0.0);
    EXPECT_GT(cost.instructions, 0.0);
    EXPECT_GT(sim::kWorkCosts[kind].cycles, 0.0);
    expected[kind] = cost.instructions;
  }
  EXPECT_EQ(machine.work_cycles, expected);
  for (std::size_t kind = 0; kind < sim::kWorkCosts.size(); ++kind) {
    EXPECT_EQ(expected[kind] > 0, sim::kWorkCosts[kind].cycles > 0) << "kind " << kind;
  }
  EXPECT_EQ(machine.issue_cycles, sim::kCommandInstructions);
  EXPECT_EQ(machine.wait_cycles, sim::kWaitInstructions);
  EXPECT_EQ(machine.claim_cycles, sim::kClaimInstructions);
}

}  // namespace
}  // namespace gridiron::calibrate
