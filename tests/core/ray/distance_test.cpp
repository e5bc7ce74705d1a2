// Whole subpackets that take a hit at once, against the same hits merged group by group.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/ray/distance.h>

#include "core/lane_types.h"
#include "core/ray/packet_cases.h"
#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using SmallPacket = Packet<8>;
constexpr std::uint32_t kOldId = 77;

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
    const Vec3 origin = vec_of(packet.origin);
    const bool is_behind = random.below(8) == 0;
    const auto corner = [&](float x, float y) {
      const float z = (is_behind ? 4.0f : -4.0f) + random.between(-1, 1);
      return origin + scale * Vec3(x, y, z);
    };
    const Vec3 a = corner(-40, -40), b = corner(40, -40), c = corner(0, 60);
    const bool over = random.below(2) != 0;
    triangle = vertex_triangle(a, over ? c : b, over ? b : c, random.below(1000) + 1000 * random.below(2) + 100);
    for (std::uint32_t ray = 0; ray < SmallPacket::kRayCount; ++ray) {
      distance[ray] = true_distance(packet, ray, triangle);
    }
    reset_hits(packet);
    // The rays' earlier hits: far behind; for some, one after the other, at or before the new hit or too close to
    // decide.
    const std::uint32_t kind = random.below(4);
    if (kind == 0) return;
    constexpr float kLimit = 1.0f / kSurelyNearer;
    const float close[] = {0.5f,
                           1.0f,
                           1.0f + 0x1p-23f,
                           1.0f + kEstimateError,
                           kLimit - 0.5f * kEstimateError,
                           kLimit + 2.5f * kEstimateError,
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
  for_each_seed(800, [&](TestRandom& random) {
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
      ASSERT_EQ(taken, all_new && group_work[Work::kHitHalf] == 0) << "subpacket " << subpacket;
      ASSERT_EQ(work[Work::kHitSubpacket], 1u);
      ASSERT_EQ(work[Work::kHitHalf], 0u);
      taken_count += taken ? 1u : 0u;
      refused_count += taken ? 0u : 1u;
      exact_count += !taken && all_new ? 1u : 0u;
      const SmallPacket& expected = taken ? by_groups : shown.packet;
      for (std::uint32_t ray = 0; ray < SmallPacket::kRayCount; ++ray) {
        ASSERT_EQ(at_once.id[ray], expected.id[ray]) << "ray " << ray;
        ASSERT_TRUE(same_bits(at_once.t[ray], expected.t[ray])) << "ray " << ray;
        ASSERT_TRUE(same_bits(at_once.facing[ray], expected.facing[ray])) << "ray " << ray;
        ASSERT_FALSE(at_once.unsure.contains(ray)) << "ray " << ray;
        if (!taken || !is_own(ray)) {
          ASSERT_EQ(at_once.id[ray], shown.packet.id[ray]) << "ray " << ray;
          continue;
        }
        ASSERT_EQ(at_once.id[ray], shown.triangle.triangle_id) << "ray " << ray;
        ASSERT_LT(shown.distance[ray], shown.packet.t[ray]) << "not nearer, ray " << ray;
        ASSERT_GT(shown.distance[ray], 0.0f) << "behind, ray " << ray;
        ASSERT_LE(std::fabs(double{at_once.t[ray]} - double{shown.distance[ray]}),
                  double{kEstimateError} * double{shown.distance[ray]})
            << "ray " << ray;
        ASSERT_EQ(at_once.facing[ray] >= 0.0f, kWantFacing) << "ray " << ray;
      }
    }
  });
  if (!all_seeds_run()) return;
  EXPECT_GT(taken_count, 1000u);
  EXPECT_GT(refused_count, 500u);
  EXPECT_GT(exact_count, 50u);
}

TYPED_TEST(DistanceTest, ASubpacketTakesWhatItsGroupsTake) {
  expect_subpackets_as_groups<TypeParam, true>();
  expect_subpackets_as_groups<TypeParam, false>();
}

TYPED_TEST(DistanceTest, WithExactDistancesNoSubpacketTakesAnything) {
  for_each_seed(200, [&](TestRandom& random) {
    HitCase shown(random);
    shown.packet.ask_for_distances(true);
    std::ranges::fill(shown.packet.t, kFloatMax);
    HitSetups<TypeParam> setups;
    WorkCounters work;
    ASSERT_FALSE((take_subpacket<TypeParam, true>(shown.packet, 0, shown.triangle, setups, work)));
    ASSERT_TRUE(std::ranges::all_of(shown.packet.t, [](float t) { return t == kFloatMax; }));
  });
}

}  // namespace
}  // namespace gridiron::test
