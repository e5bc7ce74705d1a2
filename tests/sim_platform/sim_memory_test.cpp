// Simulated main memory: addresses, zeroing, capacity and range queries.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/sim_memory.h>
#include <sys/resource.h>
#include <unistd.h>

#include <new>

#include "support/test_headers.h"

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

// Kilobytes of memory that this process has of the host.
std::uint64_t resident_kilobytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::uint64_t kilobytes = 0;
    if (word == "VmRSS:" && status >> kilobytes) return kilobytes;
  }
  return 0;
}

TEST(SimMemory, TakesOfTheHostWhatIsHandedOut) {
  constexpr std::uint64_t kCapacity = std::uint64_t{1} << 39;  // more than hosts of these tests have
  const std::uint64_t before = resident_kilobytes();
  SimMemory memory(kCapacity);
  ASSERT_TRUE(memory.allocate(1000));
  const auto region = memory.allocate(1'000'000, 1 << 20);
  ASSERT_TRUE(region);
  EXPECT_TRUE(all_zero(region->bytes));
  std::fill(region->bytes.begin(), region->bytes.end(), std::byte{0xEE});
  EXPECT_LT(resident_kilobytes(), before + 64 * 1024);

  // The capacity is what counts for those who ask.
  EXPECT_EQ(memory.capacity_bytes(), kCapacity);
  EXPECT_FALSE(memory.allocate(kCapacity));
  EXPECT_TRUE(memory.bytes_at(region->address, 1'000'001).empty());
  EXPECT_TRUE(memory.bytes_at(MainAddress{kCapacity}, 1).empty());
}

TEST(SimMemory, WhatTheHostCannotGiveIsThrownAndChangesNothing) {
  constexpr std::uint64_t kMuch = std::uint64_t{1} << 60;
  SimMemory memory(kMuch);
  const auto region = memory.allocate(4096);
  ASSERT_TRUE(region);
  EXPECT_THROW(static_cast<void>(memory.allocate(kMuch - (1 << 20))), std::bad_alloc);
  EXPECT_EQ(memory.used_bytes(), 4096u);
  EXPECT_EQ(memory.bytes_at(region->address, 4096).size(), 4096u);
  EXPECT_TRUE(memory.allocate(4096));
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // these take terabytes of addresses themselves
// Ends with 0 if a memory of 256 MB still serves small allocations although the host has fewer addresses left.
[[noreturn]] void use_memory_of_limited_addresses() {
  constexpr std::uint64_t kMegabyte = 1 << 20;
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  rlimit limit{};
  limit.rlim_cur = limit.rlim_max =
      static_cast<rlim_t>(pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) + 200 * kMegabyte);
  if (::setrlimit(RLIMIT_AS, &limit) != 0) ::_exit(1);
  SimMemory memory(256 * kMegabyte);
  const auto region = memory.allocate(50 * kMegabyte);
  if (!region) ::_exit(2);
  std::fill(region->bytes.begin(), region->bytes.end(), std::byte{1});
  try {
    if (memory.allocate(150 * kMegabyte)) ::_exit(3);
  } catch (const std::bad_alloc&) {
    ::_exit(0);
  }
  ::_exit(4);
}

TEST(SimMemory, FewerAddressesThanTheCapacityServeWhatIsSmall) {
  EXPECT_EXIT(use_memory_of_limited_addresses(), testing::ExitedWithCode(0), "");
}
#endif

}  // namespace
}  // namespace gridiron::sim
