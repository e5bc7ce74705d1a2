// Watertightness through the grid: of frames from inside closed meshes no pixel is left without a hit, whatever the
// mesh's place and size, the rounding, the packets and lanes. SPDX-License-Identifier: Apache-2.0
#include "numeric/watertight/grid_shots.h"
#include "numeric/watertight/tally.h"

namespace gridiron::test {
namespace {

constexpr std::uint64_t kRays = 24 * 1024;  // from inside each solid

void expect_watertight_grid(const Solid& solid, const Placement& placement, Vertices vertices,
                            std::span<const Machine> machines, std::uint64_t rays) {
  SCOPED_TRACE(solid.name + " " + placement.name + ", through the grid" +
               (vertices == Vertices::kOnLattice ? ", on its lattice" : ""));
  const PlacedSolid placed(solid, placement, vertices);
  const Tally tally = shoot_through_grid(placed, machines, {}, sim::Mode::kChecked, {.rays = rays});
  EXPECT_EQ(tally.first_failure, "");
  EXPECT_EQ(tally.lost_packets, 0u);
  for (std::size_t p = 0; p < kProfileCount; ++p) {
    if (!kProfiles[p].is_watertight) continue;
    EXPECT_EQ(tally.oracle_differences[p], 0u) << kProfiles[p].name;
    for (std::size_t i = 0; i < machines.size(); ++i) {
      EXPECT_EQ(tally.machines[i].misses[p], 0u) << kProfiles[p].name << ", " << machines[i].name;
      EXPECT_EQ(tally.machines[i].differences[p], 0u) << kProfiles[p].name << ", " << machines[i].name;
    }
  }
}

TEST(WatertightGrid, UnderEveryRounding) {
  const std::vector<Machine> machines = grid_machines();
  EXPECT_EQ(machines.size(), 4u);
  for (const Solid& solid : make_solids(Detail::kLow)) {
    expect_watertight_grid(solid, {}, Vertices::kAsPlaced, machines, kRays);
    expect_watertight_grid(solid, {}, Vertices::kOnLattice, machines, kRays);
  }
}

class WatertightGridTest : public testing::TestWithParam<Placement> {};

TEST_P(WatertightGridTest, Holds) {
  for (const Solid& solid : make_solids(Detail::kLow)) {
    expect_watertight_grid(solid, GetParam(), Vertices::kAsPlaced, machines().first(1), kRays);
    expect_watertight_grid(solid, GetParam(), Vertices::kOnLattice, machines().first(1), kRays);
  }
}

INSTANTIATE_TEST_SUITE_P(Placements, WatertightGridTest, testing::ValuesIn(all_placements()),
                         [](const auto& tested) { return "P" + std::to_string(tested.index); });

}  // namespace
}  // namespace gridiron::test
