// Reaches of subpackets. SPDX-License-Identifier: Apache-2.0
#include <gridiron/engine/grid/footprint.h>
#include <gridiron/engine/grid/reach.h>

#include "core/lane_types.h"
#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

template <class L>
class Reach : public testing::Test {};
TYPED_TEST_SUITE(Reach, LaneTypes, LaneNames);

template <class L, class PacketType>
void expect_reaches() {
  using Reaches = SubpacketReach<PacketType>;
  std::uint64_t closed = 0;
  for_each_seed(50, [&](TestRandom& random) {
    PacketType packet{};
    Frustum frustum{};
    frustum.pad_k = 0x1p-18f;
    for (std::uint32_t ray = 0; ray < PacketType::kRayCount; ++ray) {
      packet.t[ray] = random.between(1, 50);
      if (random.below(4) != 0) packet.active.insert(ray);
    }
    for (float& march : packet.march_high) march = random.between(0.5f, 4.0f);
    Reaches reaches{};
    WorkCounters work;
    (void)reaches.template update<L>(packet, PacketType::kAllSubpackets, work);
    const SubpacketSet changed = random.below(0xFFFF) & PacketType::kAllSubpackets;
    for (std::uint32_t ray = 0; ray < PacketType::kRayCount; ++ray) {
      if ((changed >> (ray / kSubpacketRays) & 1u) != 0) packet.t[ray] *= random.between(0.1f, 1.0f);
    }
    const float largest = reaches.template update<L>(packet, changed, work);
    float expected_largest = 0.0f;
    for (std::uint32_t subpacket = 0; subpacket < PacketType::kSubpacketCount; ++subpacket) {
      float expected = 0.0f;
      for (std::uint32_t i = 0; i < kSubpacketRays; ++i) {
        const std::uint32_t ray = subpacket * kSubpacketRays + i;
        if (!packet.active.contains(ray)) continue;
        expected = std::max(expected, packet.t[ray]);
      }
      const std::uint32_t square = PacketType::kSubpacketCount < 4 ? 0 : subpacket / 4;
      expected *= packet.march_high[square] * (1.0f + 2.0f * kEstimateError);
      ASSERT_EQ(reaches.reach[subpacket], expected) << "subpacket " << subpacket;
      expected_largest = std::max(expected_largest, expected);
    }
    ASSERT_EQ(largest, expected_largest);

    for (int i = 0; i < 20; ++i) {
      const std::uint32_t edge = random.below(PacketType::kSubpacketCount);
      const float entry = i % 2 == 0 ? random.between(0, 120) : reaches.reach[edge];
      const SubpacketSet open = reaches.template open<L>(frustum, entry, work);
      const SubpacketSet open_squares = subpackets_of_squares(reaches.open_squares(frustum, entry, work));
      for (std::uint32_t subpacket = 0; subpacket < PacketType::kSubpacketCount; ++subpacket) {
        const bool is_open = (open >> subpacket & 1u) != 0;
        closed += is_open ? 0u : 1u;
        if (frustum.beyond(Slab{entry, entry}, reaches.reach[subpacket])) continue;
        ASSERT_TRUE(is_open) << "subpacket " << subpacket;
      }
      ASSERT_EQ(open & ~PacketType::kAllSubpackets, 0u);
      if (PacketType::kSubpacketCount < L::kCount) continue;
      // A square is open where one of its subpackets is.
      for (std::uint32_t square = 0; square < PacketType::kSquareCount; ++square) {
        const bool any = PacketType::kSubpacketCount < 4 || (open >> (4 * square) & 0xFu) != 0;
        ASSERT_TRUE(!any || (open_squares >> (4 * square) & 1u) != 0) << "square " << square;
        if (PacketType::kSquareCount >= 4) {
          ASSERT_EQ(any, (open_squares >> (4 * square) & 1u) != 0) << "square " << square;
        }
      }
    }
  });
  if (all_seeds_run() && PacketType::kSubpacketCount >= L::kCount) {
    EXPECT_GT(closed, 100u);
  }
}

TYPED_TEST(Reach, IsTheFarthestNearestHitAndClosesSubpackets) {
  expect_reaches<TypeParam, Packet<4>>();
  expect_reaches<TypeParam, Packet<8>>();
  expect_reaches<TypeParam, Packet<16>>();
  expect_reaches<TypeParam, Packet<32>>();
}

}  // namespace
}  // namespace gridiron::test
