// Watertightness: of rays from inside closed meshes none leaves, whatever the mesh's place and size, the build and the
// rules of floating point; and all hit the same triangle at the same distance. SPDX-License-Identifier: Apache-2.0
#include "numeric/watertight/tally.h"
#include "support/scenes.h"

namespace gridiron::test {
namespace {

// Of each kind, from inside each solid.
constexpr std::uint64_t kBaseRays = 2000;
constexpr std::uint64_t kPlacedRays = 600;
constexpr std::size_t kPaperProfile = 4;
static_assert(kProfiles[kPaperProfile].accuracy == Accuracy::kPaper);

void expect_watertight(const Solid& solid, const Placement& placement, std::span<const Machine> machines,
                       std::uint64_t rays, Vertices vertices) {
  const PlacedSolid placed(solid, placement, vertices);
  for (const RayKind kind : kRayKinds) {
    SCOPED_TRACE(solid.name + " " + placement.name + ", " + name_of(kind) +
                 (vertices == Vertices::kOnLattice ? ", on its lattice" : ""));
    const Tally tally = shoot_all(placed, kind, machines, {}, {.rays = rays, .oracle_stride = 8});
    EXPECT_EQ(tally.first_failure, "");
    EXPECT_EQ(tally.lost_packets, 0u);
    EXPECT_GE(tally.rays * 100, rays * 99);
    for (std::size_t i = 0; i < machines.size(); ++i) {
      for (std::size_t p = 0; p < kProfileCount; ++p) {
        if (!kProfiles[p].is_watertight || !machines[i].is_promised) continue;
        EXPECT_EQ(tally.machines[i].misses[p], 0u) << kProfiles[p].name << ", " << machines[i].name;
        EXPECT_EQ(tally.machines[i].differences[p], 0u) << kProfiles[p].name << ", " << machines[i].name;
      }
    }
    for (const std::uint64_t differences : tally.oracle_differences) EXPECT_EQ(differences, 0u);
    // Rays that even the paper's test does not miss would show nothing.
    if (kind == RayKind::kEdge && rays >= kBaseRays) {
      EXPECT_GT(tally.machines[0].misses[kPaperProfile], rays / 200);
    }
  }
}

TEST(Watertight, UnderEveryMachine) {
  for (const Solid& solid : make_solids(Detail::kLow)) {
    ASSERT_EQ(why_not_closed(solid.mesh), "") << solid.name;
    expect_watertight(solid, {}, machines(), kBaseRays, Vertices::kAsPlaced);
    expect_watertight(solid, {}, machines(), kBaseRays / 4, Vertices::kOnLattice);
  }
}

class WatertightPlacementTest : public testing::TestWithParam<Placement> {};

TEST_P(WatertightPlacementTest, Holds) {
  for (const Solid& solid : make_solids(Detail::kLow)) {
    expect_watertight(solid, GetParam(), machines().first(1), kPlacedRays, Vertices::kAsPlaced);
    expect_watertight(solid, GetParam(), machines().first(1), kPlacedRays / 4, Vertices::kOnLattice);
  }
}

INSTANTIATE_TEST_SUITE_P(Placements, WatertightPlacementTest, testing::ValuesIn(all_placements()),
                         [](const auto& tested) { return "P" + std::to_string(tested.index); });

TEST(Watertight, ClosedScans) {
  const SharedFile folder = find_scene("");
  GRIDIRON_SKIP_IF_MISSING(folder);
  int closed = 0;
  for (const ScanSolid& scan : load_scans(folder.path)) {
    if (!scan.left_out.empty()) {
      std::printf("%s is left out: %s\n", scan.solid.name.c_str(), scan.left_out.c_str());
      continue;
    }
    ++closed;
    expect_watertight(scan.solid, {}, machines(), kBaseRays / 4, Vertices::kAsPlaced);
  }
  EXPECT_GT(closed, 0);
}

}  // namespace
}  // namespace gridiron::test
