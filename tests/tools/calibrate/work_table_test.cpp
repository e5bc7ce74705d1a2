// The committed table of work costs is the one that the kernel's operations come to today.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/work_costs.h>
#include <gtest/gtest.h>
#include <work_table.h>

#include <fstream>
#include <sstream>
#include <string>

namespace gridiron::calibrate {
namespace {

// count_frames() itself throws where the counted kernel renders another picture or does other work than the kernel.
TEST(WorkTable, CommittedTableIsThatOfTodaysKernel) {
  std::ifstream file(GRIDIRON_WORK_COSTS, std::ios::binary);
  std::ostringstream committed;
  committed << file.rdbuf();
  EXPECT_EQ(table_text(count_frames()), committed.str())
      << "The kernel's operations changed: write the table anew with\n  build/host/bin/gridiron_calibrate "
         "sim_platform/gridiron/sim/work_costs.h";
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
