// Borrowed regions: the pages of a shared mapping in place of a region's own. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/borrowed_region.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <vector>

namespace gridiron::sim {
namespace {

// A mapping whose bytes are numbered; `flags` as of mmap.
class Mapping {
 public:
  Mapping(std::size_t bytes, int flags)
      : bytes_(bytes),
        memory_(static_cast<std::byte*>(
            ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, flags | MAP_ANONYMOUS, -1, 0))) {
    for (std::size_t i = 0; i < bytes; ++i) memory_[i] = static_cast<std::byte>(i * 7 >> 3);
  }
  ~Mapping() { ::munmap(memory_, bytes_); }
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;

  [[nodiscard]] std::span<std::byte> bytes() const { return {memory_, bytes_}; }

 private:
  std::size_t bytes_;
  std::byte* memory_;
};

const auto kPage = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));

void expect_equal(const MemoryRegion& region, const std::vector<std::byte>& expected) {
  ASSERT_EQ(region.bytes.size(), expected.size());
  EXPECT_EQ(std::memcmp(region.bytes.data(), expected.data(), expected.size()), 0);
}

// The region begins and ends within a page, like an image behind others and before a picture.
TEST(BorrowedRegion, HasThePagesOfASharedMapping) {
  SimMemory memory(64 * kPage);
  const MemoryRegion before = *memory.allocate(384), region = *memory.allocate(5 * kPage + 256);
  const MemoryRegion after = *memory.allocate(1024);
  std::memset(before.bytes.data(), 1, before.bytes.size());
  std::memset(region.bytes.data(), 2, region.bytes.size());
  std::memset(after.bytes.data(), 3, after.bytes.size());
  const std::size_t place = region.address.value % kPage;
  std::vector<std::byte> expected;
  {
    const Mapping shared(8 * kPage, MAP_SHARED);
    const std::span<std::byte> bytes = shared.bytes().subspan(place, region.bytes.size());
    expected.assign(bytes.begin(), bytes.end());
    EXPECT_TRUE(borrow_bytes(region, bytes));
    expect_equal(region, expected);
    // What is changed there is seen here: these are the same pages.
    const std::size_t middle = 2 * kPage;
    bytes[middle] ^= std::byte{0xFF};
    expected[middle] ^= std::byte{0xFF};
    expect_equal(region, expected);
  }
  expect_equal(region, expected);  // the mapping is gone, its pages stay
  for (const std::byte byte : before.bytes) ASSERT_EQ(byte, std::byte{1});
  for (const std::byte byte : after.bytes) ASSERT_EQ(byte, std::byte{3});
  after.bytes.front() = std::byte{4};  // neighbours can be written
  EXPECT_DEATH(region.bytes[2 * kPage] = std::byte{}, "");
}

TEST(BorrowedRegion, CopiesWhatCannotBeShared) {
  SimMemory memory(64 * kPage);
  for (const int flags : {MAP_SHARED, MAP_PRIVATE}) {
    // Of a private mapping; and at another place in a page.
    const MemoryRegion region = *memory.allocate(3 * kPage);
    const Mapping mapping(8 * kPage, flags);
    const std::size_t place = region.address.value % kPage + (flags == MAP_SHARED ? 64 : 0);
    const std::span<std::byte> bytes = mapping.bytes().subspan(place, region.bytes.size());
    EXPECT_FALSE(borrow_bytes(region, bytes));
    expect_equal(region, {bytes.begin(), bytes.end()});
    region.bytes.front() = std::byte{9};
  }
  const MemoryRegion small = *memory.allocate(256);
  const Mapping shared(kPage, MAP_SHARED);
  EXPECT_FALSE(borrow_bytes(small, shared.bytes().first(256)));
  expect_equal(small, {shared.bytes().begin(), shared.bytes().begin() + 256});
}

}  // namespace
}  // namespace gridiron::sim
