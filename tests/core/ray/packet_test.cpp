// Order of a packet's rays. SPDX-License-Identifier: Apache-2.0
#include <gridiron/ray/packet.h>

#include "support/test_headers.h"

namespace gridiron::test {
namespace {

template <class PacketType>
class PacketOrder : public testing::Test {};
using PacketTypes = testing::Types<Packet<4>, Packet<8>, Packet<16>, Packet<32>>;
struct PacketNames {
  template <class PacketType>
  static std::string GetName(int) {
    return "Width" + std::to_string(PacketType::kWidth);
  }
};
TYPED_TEST_SUITE(PacketOrder, PacketTypes, PacketNames);

// Every `count` consecutive rays cover a rectangle of `width` x count / width pixels.
template <class PacketType>
void expect_compact(std::uint32_t count, std::uint32_t width) {
  for (std::uint32_t first = 0; first < PacketType::kRayCount; first += count) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> pixels;
    std::uint32_t right = 0, bottom = 0, left = PacketType::kWidth, top = PacketType::kWidth;
    for (std::uint32_t ray = first; ray < first + count; ++ray) {
      const std::uint32_t column = PacketType::column_of(ray), row = PacketType::row_of(ray);
      pixels.insert({column, row});
      left = std::min(left, column);
      right = std::max(right, column);
      top = std::min(top, row);
      bottom = std::max(bottom, row);
    }
    ASSERT_EQ(pixels.size(), count);
    ASSERT_EQ(right - left + 1, width) << first;
    ASSERT_EQ(bottom - top + 1, count / width) << first;
  }
}

TYPED_TEST(PacketOrder, GroupsSubpacketsAndSquaresAreCompact) {
  expect_compact<TypeParam>(4, 4);
  expect_compact<TypeParam>(8, 4);
  expect_compact<TypeParam>(16, 4);
  if (TypeParam::kWidth >= 8) expect_compact<TypeParam>(64, 8);
  if (TypeParam::kWidth >= 16) expect_compact<TypeParam>(256, 16);
  expect_compact<TypeParam>(TypeParam::kRayCount, TypeParam::kWidth);
}

TYPED_TEST(PacketOrder, SetsOfSubpackets) {
  std::vector<std::uint32_t> visited;
  const auto visit = [&](std::uint32_t i) { visited.push_back(i); };
  for_each_subpacket<TypeParam::kSubpacketCount>(TypeParam::kAllSubpackets, visit);
  ASSERT_EQ(visited.size(), TypeParam::kSubpacketCount);
  for (std::uint32_t i = 0; i < TypeParam::kSubpacketCount; ++i) EXPECT_EQ(visited[i], i);
  visited.clear();
  for_each_subpacket<TypeParam::kSubpacketCount>(TypeParam::kAllSubpackets & 0b101, visit);
  const std::vector<std::uint32_t> expected = {0, 2};
  EXPECT_EQ(visited, TypeParam::kSubpacketCount == 1 ? std::vector<std::uint32_t>{0} : expected);
}

TYPED_TEST(PacketOrder, FullSetsHoldAllRays) {
  RaySet<TypeParam::kRayCount> rays{};
  rays.fill();
  for (std::uint32_t ray = 0; ray < TypeParam::kRayCount; ++ray) ASSERT_TRUE(rays.contains(ray)) << ray;
  if (TypeParam::kRayCount < 32) {
    EXPECT_EQ(rays.words[0], (1u << (TypeParam::kRayCount % 32)) - 1u);
  }
}

}  // namespace
}  // namespace gridiron::test
