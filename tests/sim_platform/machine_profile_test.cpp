// Machine profiles: complete, found by name, with the published figures.
// Memory: std::set. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/engine_work.h>
#include <gridiron/sim/machine_profile.h>

#include "support/test_headers.h"

namespace gridiron::sim {
namespace {

TEST(MachineProfile, BuiltInProfilesAreComplete) {
  ASSERT_FALSE(machine_profiles().empty());
  EXPECT_EQ(machine_profiles()[0].name, "cell-ps3");
  std::set<std::string> names;
  for (const MachineProfile& machine : machine_profiles()) {
    EXPECT_TRUE(names.insert(std::string(machine.name)).second) << machine.name;
    EXPECT_EQ(find_machine_profile(machine.name), &machine);
    EXPECT_FALSE(machine.description.empty());
    EXPECT_GT(machine.latency_cycles.mean(), 0);
    EXPECT_GT(machine.channel_bytes_per_cycle, 0);
    EXPECT_GT(machine.pass_start_cycles, 0);
    EXPECT_GT(machine.pass_barrier_cycles, 0);
    for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) {
      const bool has_none = is_charged_as_event(WorkId(kind)) || kind >= kGridEngine.kind_count();
      EXPECT_EQ(machine.work_cycles[kind] == 0, has_none) << machine.name << ", kind " << kind;
    }
    for (std::uint32_t kind = 0; kind < kTileWorkCount; ++kind) {  // instructions of tiles are not known
      EXPECT_EQ(machine.tile_work_cycles[kind] == 0, counts_instructions(machine)) << machine.name << ", kind " << kind;
    }
  }
  EXPECT_EQ(find_machine_profile("cell"), nullptr);
}

TEST(MachineProfile, FiguresAreThePublishedOnes) {
  const MachineProfile& ps3 = *find_machine_profile("cell-ps3");
  EXPECT_EQ(ps3.core_count, 6u);
  EXPECT_EQ(ps3.clock_hz, 3.2e9);
  EXPECT_EQ(ps3.main_memory_bytes, 256u << 20);
  EXPECT_EQ(ps3.local_store_bytes, 262144u);
  EXPECT_EQ(ps3.queue_depth, 16u);
  EXPECT_EQ(ps3.line_bytes, 128u);
  EXPECT_EQ(ps3.latency_cycles.mean(), 500);
  EXPECT_DOUBLE_EQ(ps3.channel_bytes_per_cycle, 0.9 * 25.6e9 / 3.2e9);
  EXPECT_EQ(ps3.core_line_interval_cycles, 128 / 8);
  // One core alone takes lines_in_flight lines in a latency: over 10 GB/s, as measured, and below a channel.
  const double lines_a_second = ps3.lines_in_flight * ps3.clock_hz / (ps3.latency_cycles.mean() + 18);
  EXPECT_GT(lines_a_second * 128, 10e9);
  EXPECT_LT(lines_a_second * 128, 16e9);
  // Six channel writes; a mask written and a status read; a mailbox there and back.
  EXPECT_EQ(ps3.issue_cycles, 24);
  EXPECT_EQ(ps3.wait_cycles, 14);
  EXPECT_EQ(ps3.claim_cycles, 300);
  // The count is read, so a start takes a latency at least. The last core's mailbox is half of a claim.
  EXPECT_EQ(ps3.pass_start_cycles, 500);
  EXPECT_EQ(ps3.pass_barrier_cycles, 700);
  const MachineProfile& blade = *find_machine_profile("cell-2006");
  EXPECT_EQ(blade.core_count, 8u);
  EXPECT_EQ(blade.clock_hz, 2.4e9);
  // The same memory: as many bytes a second, as many nanoseconds.
  EXPECT_DOUBLE_EQ(blade.channel_bytes_per_cycle * blade.clock_hz, ps3.channel_bytes_per_cycle * ps3.clock_hz);
  EXPECT_DOUBLE_EQ(blade.latency_cycles.mean() / blade.clock_hz, ps3.latency_cycles.mean() / ps3.clock_hz);
  EXPECT_DOUBLE_EQ(blade.claim_cycles / blade.clock_hz, ps3.claim_cycles / ps3.clock_hz);
  EXPECT_DOUBLE_EQ(blade.pass_start_cycles / blade.clock_hz, ps3.pass_start_cycles / ps3.clock_hz);
  EXPECT_DOUBLE_EQ(blade.pass_barrier_cycles / blade.clock_hz, ps3.pass_barrier_cycles / ps3.clock_hz);
  EXPECT_EQ(blade.main_memory_bytes, 512u << 20);
  // The same mean, spread.
  for (const char* name : {"cell-ps3-dram", "cell-ps3-tlb"}) {
    MachineProfile spread = *find_machine_profile(name);
    EXPECT_DOUBLE_EQ(spread.latency_cycles.mean(), ps3.latency_cycles.mean()) << name;
    EXPECT_EQ(spread.work_cycles, ps3.work_cycles) << name;
  }
  MachineProfile large = *find_machine_profile("cell-ps3-2gb");
  EXPECT_EQ(large.main_memory_bytes, 2048ull << 20);
  EXPECT_EQ(large.work_cycles, ps3.work_cycles);
}

}  // namespace
}  // namespace gridiron::sim
