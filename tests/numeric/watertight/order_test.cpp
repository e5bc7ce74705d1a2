// The same triangle at the same distance, in whatever order the triangles come, whatever lane a ray is in and whatever
// other rays its packet has. SPDX-License-Identifier: Apache-2.0
#include <numeric>

#include "core/seeds.h"
#include "numeric/watertight/aims.h"
#include "numeric/watertight/machines.h"
#include "numeric/watertight/placed_solid.h"

namespace gridiron::test {
namespace {

using watertight::Hits;
using watertight::kShotRays;
using watertight::Shot;

template <class Element>
void shuffle(std::vector<Element>& elements, TestRandom& random) {
  for (std::size_t i = elements.size(); i > 1; --i) {
    std::swap(elements[i - 1], elements[random.below(static_cast<std::uint32_t>(i))]);
  }
}

// A shot that owns its triangles.
struct OwnedShot {
  Shot shot;
  CandidateRecords records;

  OwnedShot(const PlacedSolid& solid, const Shot& rays) : shot(rays) { solid.add_candidates(shot, records); }
  void shuffle_triangles(TestRandom& random) {
    const std::uint64_t seed = random.next();
    TestRandom same1(seed), same2(seed);
    shuffle(records.vertices, same1);
    if (!records.places.empty()) shuffle(records.places, same2);
  }
};

class OrderTest : public testing::TestWithParam<Accuracy> {};

TEST_P(OrderTest, ChangesNothing) {
  const Accuracy accuracy = GetParam();
  const bool on_lattice = accuracy == Accuracy::kCompact;
  std::uint64_t shots = 0, ties = 0;
  for (const Solid& solid : make_solids(Detail::kLow)) {
    for (const Placement& placement : {Placement{}, Placement{"at 16", 0, Vec3(16.0f)}}) {
      const PlacedSolid placed(solid, placement, on_lattice ? Vertices::kOnLattice : Vertices::kAsPlaced);
      for_each_seed(120, [&](std::uint64_t seed) {
        SCOPED_TRACE(solid.name + " " + placement.name);
        TestRandom random(seed);
        const RayKind kind = kRayKinds[seed % std::size(kRayKinds)];
        Shot rays;
        ASSERT_TRUE(aim(placed, kind, random.next(), rays));
        const OwnedShot plain(placed, rays);
        Hits wanted;
        machines()[0].shoot(plain.shot, static_cast<std::uint32_t>(accuracy), wanted);
        ++shots;
        for (int turn = 0; turn < 12; ++turn) {
          // Lanes change places; every third time some rays make way for others, of any length, or for none.
          std::uint32_t lane_of[kShotRays];
          std::iota(lane_of, lane_of + kShotRays, 0u);
          for (std::uint32_t i = kShotRays; i > 1; --i) std::swap(lane_of[i - 1], lane_of[random.below(i)]);
          Shot moved = rays;
          moved.active = 0;
          for (std::uint32_t ray = 0; ray < kShotRays; ++ray) {
            for (int axis = 0; axis < 3; ++axis) moved.dir[axis][lane_of[ray]] = rays.dir[axis][ray];
            moved.active |= (rays.active >> ray & 1u) << lane_of[ray];
          }
          std::uint32_t replaced = 0;
          if (turn % 3 == 0) {
            replaced = static_cast<std::uint32_t>(random.next()) & 0xFFFFu;
            const bool by_none = random.below(2) != 0;
            for (std::uint32_t lane = 0; lane < kShotRays; ++lane) {
              if ((replaced >> lane & 1u) == 0) continue;
              const int exponent = static_cast<int>(random.below(60)) - 30;
              for (int axis = 0; axis < 3; ++axis) {
                moved.dir[axis][lane] = std::ldexp(random.between(-1, 1), exponent);
              }
            }
            moved.active = by_none ? moved.active & ~replaced : moved.active | replaced;
          }
          if (moved.active == 0) continue;
          OwnedShot other(placed, moved);
          other.shuffle_triangles(random);
          // By turns under every machine that promises it.
          const Machine& machine = machines()[static_cast<std::size_t>(turn) % machines().size()];
          if (!machine.is_promised) continue;
          Hits found;
          {
            const RoundingGuard guard(machine);
            machine.shoot(other.shot, static_cast<std::uint32_t>(accuracy), found);
          }
          for (std::uint32_t ray = 0; ray < kShotRays; ++ray) {
            const std::uint32_t lane = lane_of[ray];
            if ((rays.active >> ray & 1u) == 0 || (replaced >> lane & 1u) != 0) continue;
            ASSERT_EQ(found.id[lane], wanted.id[ray]) << machine.name << ", turn " << turn << ", ray " << ray;
            if (!rays.with_distances) continue;
            ASSERT_EQ(std::bit_cast<std::uint32_t>(found.t[lane]), std::bit_cast<std::uint32_t>(wanted.t[ray]))
                << machine.name << ", turn " << turn << ", ray " << ray;
          }
        }
        for (std::uint32_t ray = 0; ray < kShotRays && seed % 8 == 0; ++ray) {
          if ((rays.active >> ray & 1u) == 0) continue;
          const OracleRay asked{{rays.origin[0], rays.origin[1], rays.origin[2]},
                                {rays.dir[0][ray], rays.dir[1][ray], rays.dir[2][ray]}};
          ties += placed.oracle().nearest(asked).float_ties.size() > 1 ? 1u : 0u;
        }
      });
    }
  }
  if (std::getenv("GRIDIRON_TEST_SEED") != nullptr) return;
  EXPECT_GT(shots, 900u);
  EXPECT_GT(ties, 200u) << "nothing here depends on an order";
}

INSTANTIATE_TEST_SUITE_P(Accuracies, OrderTest,
                         testing::Values(Accuracy::kStandard, Accuracy::kExact, Accuracy::kCompact),
                         [](const auto& tested) {
                           for (const Profile& profile : kProfiles) {
                             if (profile.accuracy == tested.param) return std::string(profile.name);
                           }
                           return std::string("unknown");
                         });

}  // namespace
}  // namespace gridiron::test
