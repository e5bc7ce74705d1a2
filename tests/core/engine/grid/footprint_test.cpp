// Footprints: a subpacket that is left out has no ray that exact arithmetic says touches the cell.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/engine/grid/footprint.h>

#include "core/engine/grid/frustum_cases.h"
#include "core/lane_types.h"
#include "core/ray/exact_ray.h"
#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

template <class L>
class Footprint : public testing::Test {};
TYPED_TEST_SUITE(Footprint, LaneTypes, LaneNames);

TYPED_TEST(Footprint, SquaresBecomeTheirFourSubpackets) {
  for (std::uint32_t square = 0; square < 16; ++square) {
    EXPECT_EQ(subpackets_of_squares(std::uint64_t{1} << square), SubpacketSet{0xF} << (4 * square));
  }
  EXPECT_EQ(subpackets_of_squares(0xFFFF), ~SubpacketSet{0});
  EXPECT_EQ(subpackets_of_squares(0), 0u);
}

template <class L, class PacketType>
void expect_no_touch_left_out(std::uint64_t seed_count, std::uint32_t ray_stride) {
  std::uint64_t touches = 0;
  std::uint64_t left_out = 0;
  for_each_seed(seed_count, [&](std::uint64_t seed) {
    TestRandom random(seed);
    const GridRecord grid = random_grid(random, 2048, 1);
    PacketType packet{};
    random_packet(random, grid, packet);
    if (seed % 2 == 0) {  // squares of one direction: nothing but the pads lies between ray and bound
      constexpr std::uint32_t kSquareRays = PacketType::kRayCount / PacketType::kSquareCount;
      for (auto& component : packet.dir) {
        for (std::uint32_t ray = 0; ray < PacketType::kRayCount; ++ray) {
          component[ray] = component[ray / kSquareRays * kSquareRays];
        }
      }
    }
    RaySet<PacketType::kRayCount> waiting;
    waiting.fill();
    Frustum frustum;
    WorkCounters work;
    while (take_pass<L>(grid, waiting, packet, frustum, work)) {
      for (int slice = 0; slice < 6; ++slice) {
        const auto k = static_cast<std::int32_t>(random.below(static_cast<std::uint32_t>(frustum.cells_k)));
        const Slab slab = frustum.slab_of(k, k);
        for (std::uint32_t ray = random.below(ray_stride); ray < PacketType::kRayCount; ray += ray_stride) {
          if (!packet.active.contains(ray)) continue;
          const auto box = ExactRay(grid, packet, ray).box_between(frustum.axis_k, k, k);
          if (!box) continue;
          for (const std::int32_t u : {box->u.first, box->u.last}) {
            for (const std::int32_t v : {box->v.first, box->v.last}) {
              constexpr std::uint32_t kAllSquares = (1u << PacketType::kSquareCount) - 1u;
              const std::uint32_t squares = squares_touching<L>(packet, frustum, slab, u, v, kAllSquares, work);
              const std::uint32_t wanted = random.below(kAllSquares + 1);
              ASSERT_EQ(squares_touching<L>(packet, frustum, slab, u, v, wanted, work), squares & wanted)
                  << "wanted " << wanted;
              const SubpacketSet touching = subpackets_of_squares(squares) & PacketType::kAllSubpackets;
              ++touches;
              left_out += PacketType::kSubpacketCount - static_cast<std::uint32_t>(std::popcount(touching));
              ASSERT_EQ(squares >> PacketType::kSquareCount, 0u);
              ASSERT_NE(touching >> (ray / kSubpacketRays) & 1u, 0u)
                  << "ray " << ray << ", cell k " << k << " u " << u << " v " << v;
            }
          }
        }
      }
    }
  });
  if (!all_seeds_run()) return;
  EXPECT_GT(touches, 10000u);
  if (PacketType::kSquareCount >= 4) {
    EXPECT_GT(left_out, touches / 4);
  }
}

TYPED_TEST(Footprint, NoSubpacketThatTouchesACellIsLeftOut) {
  expect_no_touch_left_out<TypeParam, Packet<8>>(800, 3);
  expect_no_touch_left_out<TypeParam, Packet<16>>(800, 7);
  expect_no_touch_left_out<TypeParam, Packet<32>>(400, 7);
}

}  // namespace
}  // namespace gridiron::test
