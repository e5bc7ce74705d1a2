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
    for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) {
      const bool has_none = is_charged_as_event(WorkId(kind)) || kind >= kGridEngine.kind_count();
      EXPECT_EQ(machine.work_cycles[kind] == 0, has_none) << machine.name << ", kind " << kind;
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
  const MachineProfile& blade = *find_machine_profile("cell-2006");
  EXPECT_EQ(blade.core_count, 8u);
  EXPECT_EQ(blade.clock_hz, 2.4e9);
  // The same memory: as many bytes a second, as many nanoseconds.
  EXPECT_DOUBLE_EQ(blade.channel_bytes_per_cycle * blade.clock_hz, ps3.channel_bytes_per_cycle * ps3.clock_hz);
  EXPECT_DOUBLE_EQ(blade.latency_cycles.mean() / blade.clock_hz, ps3.latency_cycles.mean() / ps3.clock_hz);
  MachineProfile large = *find_machine_profile("cell-ps3-2gb");
  EXPECT_EQ(large.main_memory_bytes, 2048ull << 20);
  EXPECT_EQ(large.work_cycles, ps3.work_cycles);
}

}  // namespace
}  // namespace gridiron::sim
