// Simulated main memory: addresses, zeroing, capacity and range queries.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/sim_memory.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace gridiron::sim {
namespace {

bool all_zero(std::span<const std::byte> bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](std::byte b) { return b == std::byte{0}; });
}

TEST(SimMemory, HandsOutAlignedZeroedDisjointRegionsAboveTheHole) {
  SimMemory memory(1 << 20);
  const auto first = memory.allocate(100);
  const auto second = memory.allocate(4096, 4096);
  const auto third = memory.allocate(1, 128);
  ASSERT_TRUE(first && second && third);
  EXPECT_GE(first->address.value, SimMemory::kFirstAddress);
  EXPECT_EQ(first->address.value % 128, 0u);
  EXPECT_EQ(second->address.value % 4096, 0u);
  EXPECT_GE(second->address.value, first->address.value + 100);
  EXPECT_GE(third->address.value, second->address.value + 4096);
  EXPECT_TRUE(all_zero(first->bytes) && all_zero(second->bytes) && all_zero(third->bytes));
}

TEST(SimMemory, HostBytesOfAnAddressAreAtBasePlusAddress) {
  SimMemory memory(1 << 16);
  const auto region = memory.allocate(256);
  ASSERT_TRUE(region);
  region->bytes[7] = std::byte{42};
  EXPECT_EQ(memory.base()[region->address.value + 7], std::byte{42});
  EXPECT_EQ(memory.bytes_at(region->address.offset_by(7), 1)[0], std::byte{42});
}

TEST(SimMemory, CapacityIsExact) {
  SimMemory memory(1024);
  EXPECT_TRUE(memory.allocate(1000, 1));
  EXPECT_FALSE(memory.allocate(25, 1));
  EXPECT_TRUE(memory.allocate(24, 1));
  EXPECT_FALSE(memory.allocate(1, 1));
  EXPECT_EQ(memory.used_bytes(), memory.capacity_bytes());
}

TEST(SimMemory, RefusesSizesThatWrapAndAlignmentsThatAreNoPowerOfTwo) {
  SimMemory memory(1 << 16);
  EXPECT_TRUE(memory.allocate(128));
  EXPECT_FALSE(memory.allocate(std::numeric_limits<std::uint64_t>::max()));
  EXPECT_FALSE(memory.allocate(std::numeric_limits<std::uint64_t>::max() - 127));
  EXPECT_FALSE(memory.allocate(128, 96));
  EXPECT_FALSE(memory.allocate(128, 0));
  EXPECT_FALSE(memory.allocate(1, std::uint64_t{1} << 63));
}

TEST(SimMemory, ReleasedBytesComeBackZeroed) {
  SimMemory memory(1 << 16);
  ASSERT_TRUE(memory.allocate(256));
  const std::uint64_t mark = memory.used_bytes();
  const auto region = memory.allocate(512);
  ASSERT_TRUE(region);
  std::fill(region->bytes.begin(), region->bytes.end(), std::byte{0xEE});
  memory.release_to(mark);
  EXPECT_EQ(memory.used_bytes(), mark);
  const auto again = memory.allocate(1024);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->address, region->address);
  EXPECT_TRUE(all_zero(again->bytes));
}

TEST(SimMemory, RangeQueriesStopAtWhatWasAllocated) {
  SimMemory memory(1 << 16);
  const auto region = memory.allocate(256);
  ASSERT_TRUE(region);
  EXPECT_EQ(memory.bytes_at(region->address, 256).size(), 256u);
  EXPECT_TRUE(memory.bytes_at(region->address, 257).empty());
  EXPECT_TRUE(memory.bytes_at(region->address.offset_by(250), 7).empty());
  EXPECT_TRUE(memory.bytes_at(MainAddress{0}, 1).empty());
  EXPECT_TRUE(memory.bytes_at(MainAddress{SimMemory::kFirstAddress - 1}, 2).empty());
  EXPECT_TRUE(memory.bytes_at(region->address, std::numeric_limits<std::uint64_t>::max()).empty());
  EXPECT_TRUE(memory.bytes_at(MainAddress{std::numeric_limits<std::uint64_t>::max()}, 2).empty());
}

}  // namespace
}  // namespace gridiron::sim
