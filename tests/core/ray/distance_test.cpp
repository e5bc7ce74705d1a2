// Whole subpackets that take a hit at once, against the same hits merged group by group.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/ray/distance.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "core/lane_types.h"
#include "core/ray/packet_cases.h"
#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using SmallPacket = Packet<8>;
constexpr std::uint32_t kOldId = 77;

bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

// A triangle across all rays of a packet, and what these had hit before: nothing, or `kOldId` at distances of all
// kinds.
struct HitCase {
  SmallPacket packet{};
  VertexTriangle triangle{};
  float distance[SmallPacket::kRayCount];  // of the triangle's hits; not above 0 where they lie behind

  explicit HitCase(TestRandom& random) {
    const float scale = random.below(4) == 0 ? std::ldexp(1.0f, static_cast<int>(random.below(60)) - 30) : 1.0f;
    for (std::uint32_t ray = 0; ray < SmallPacket::kRayCount; ++ray) {
      packet.dir[0][ray] = random.between(-0.5f, 0.5f);
      packet.dir[1][ray] = random.between(-0.5f, 0.5f);
      packet.dir[2][ray] = -1.0f;
    }
    set_direction_bounds(packet);
    packet.ask_for_distances(random.below(8) == 0);
    for (float& coordinate : packet.origin) coordinate = scale * random.between(-1, 1);
    const Vec3 origin(packet.origin[0], packet.origin[1], packet.origin[2]);
    const bool is_behind = random.below(8) == 0;
    const auto corner = [&](float x, float y) {
      const float z = (is_behind ? 4.0f : -4.0f) + random.between(-1, 1);
      return origin + scale * Vec3(x, y, z);
    };
    const Vec3 a = corner(-40, -40), b = corner(40, -40), c = corner(0, 60);
    const bool over = random.below(2) != 0;
    set_triangle(triangle, a, over ? c : b, over ? b : c, random.below(1000) + 1000 * random.below(2) + 100);
    for (std::uint32_t ray = 0; ray < SmallPacket::kRayCount; ++ray) {
      const float direction[3] = {packet.dir[0][ray], packet.dir[1][ray], packet.dir[2][ray]};
      distance[ray] = true_distance(packet.origin, direction, triangle);
      packet.t[ray] = kFloatMax;
      packet.id[ray] = kNoTriangle;
      packet.facing[ray] = -1.0f;
    }
    // The rays' earlier hits: far behind; for some, one after the other, at or before the new hit or too close to
    // decide.
    const std::uint32_t kind = random.below(4);
    if (kind == 0) return;
    const float close[] = {0.5f,
                           1.0f,
                           1.0f + 0x1p-23f,
                           1.0f + kEstimateError,
                           1.0f / kSurelyNearer - 0.5f * kEstimateError,
                           1.0f / kSurelyNearer + 2.5f * kEstimateError,
                           1.5f};
    const std::uint32_t special = random.below(SmallPacket::kRayCount);
    for (std::uint32_t ray = 0; ray < SmallPacket::kRayCount; ++ray) {
      const float factor = kind == 1 || ray != special ? (kind == 3 ? 1.01f : 2.0f) : close[random.below(7)];
      packet.t[ray] = std::fabs(distance[ray]) * factor;
      packet.id[ray] = kOldId;
    }
  }
};

template <class L>
class DistanceTest : public testing::Test {};
TYPED_TEST_SUITE(DistanceTest, LaneTypes, LaneNames);

template <class L, bool kWantFacing>
void expect_subpackets_as_groups() {
  std::uint64_t taken_count = 0, refused_count = 0, exact_count = 0;
  for_each_seed(800, [&](std::uint64_t seed) {
    TestRandom random(seed);
    const HitCase shown(random);
    for (std::uint32_t subpacket = 0; subpacket < SmallPacket::kSubpacketCount; ++subpacket) {
      const std::uint32_t first = subpacket * kSubpacketRays;
      const auto is_own = [first](std::uint32_t ray) { return ray >= first && ray < first + kSubpacketRays; };
      SmallPacket at_once = shown.packet, by_groups = shown.packet;
      WorkCounters work, group_work;
      HitSetups<L> setups, group_setups;
      const bool taken = take_subpacket<L, kWantFacing>(at_once, first, shown.triangle, setups, work);
      for (std::uint32_t base = first; base < first + kSubpacketRays; base += L::kCount) {
        (void)merge_hits<L, kWantFacing>(by_groups, base, L::kAllBits, shown.triangle, group_setups, group_work);
      }
      bool all_new = true;
      for (std::uint32_t ray = first; ray < first + kSubpacketRays; ++ray) {
        all_new = all_new && by_groups.id[ray] == shown.triangle.triangle_id;
      }
      // Taken where groups take all of them, too, and need no exact distance for it.
      ASSERT_EQ(taken, all_new && group_work[Work::kHitHalf] == 0) << "seed " << seed << ", subpacket " << subpacket;
      ASSERT_EQ(work[Work::kHitSubpacket], 1u);
      ASSERT_EQ(work[Work::kHitHalf], 0u);
      taken_count += taken ? 1u : 0u;
      refused_count += taken ? 0u : 1u;
      exact_count += !taken && all_new ? 1u : 0u;
      const SmallPacket& expected = taken ? by_groups : shown.packet;
      for (std::uint32_t ray = 0; ray < SmallPacket::kRayCount; ++ray) {
        ASSERT_EQ(at_once.id[ray], expected.id[ray]) << "seed " << seed << ", ray " << ray;
        ASSERT_TRUE(same_bits(at_once.t[ray], expected.t[ray])) << "seed " << seed << ", ray " << ray;
        ASSERT_TRUE(same_bits(at_once.facing[ray], expected.facing[ray])) << "seed " << seed << ", ray " << ray;
        ASSERT_FALSE(at_once.unsure.contains(ray)) << "seed " << seed << ", ray " << ray;
        if (!taken || !is_own(ray)) {
          ASSERT_EQ(at_once.id[ray], shown.packet.id[ray]) << "seed " << seed << ", ray " << ray;
          continue;
        }
        ASSERT_EQ(at_once.id[ray], shown.triangle.triangle_id) << "seed " << seed << ", ray " << ray;
        ASSERT_LT(shown.distance[ray], shown.packet.t[ray]) << "not nearer, seed " << seed << ", ray " << ray;
        ASSERT_GT(shown.distance[ray], 0.0f) << "behind, seed " << seed << ", ray " << ray;
        ASSERT_LE(std::fabs(double{at_once.t[ray]} - double{shown.distance[ray]}),
                  double{kEstimateError} * double{shown.distance[ray]})
            << "seed " << seed << ", ray " << ray;
        ASSERT_EQ(at_once.facing[ray] >= 0.0f, kWantFacing) << "seed " << seed << ", ray " << ray;
      }
    }
  });
  if (std::getenv("GRIDIRON_TEST_SEED") == nullptr) {
    EXPECT_GT(taken_count, 1000u);
    EXPECT_GT(refused_count, 500u);
    EXPECT_GT(exact_count, 50u);
  }
}

TYPED_TEST(DistanceTest, ASubpacketTakesWhatItsGroupsTake) {
  expect_subpackets_as_groups<TypeParam, true>();
  expect_subpackets_as_groups<TypeParam, false>();
}

TYPED_TEST(DistanceTest, WithExactDistancesNoSubpacketTakesAnything) {
  for_each_seed(200, [&](std::uint64_t seed) {
    TestRandom random(seed);
    HitCase shown(random);
    shown.packet.ask_for_distances(true);
    std::ranges::fill(shown.packet.t, kFloatMax);
    HitSetups<TypeParam> setups;
    WorkCounters work;
    ASSERT_FALSE((take_subpacket<TypeParam, true>(shown.packet, 0, shown.triangle, setups, work))) << "seed " << seed;
    ASSERT_TRUE(std::ranges::all_of(shown.packet.t, [](float t) { return t == kFloatMax; })) << "seed " << seed;
  });
}

}  // namespace
}  // namespace gridiron::test
