// Transfers: portable pieces, a queue that is never exceeded, and waits for the oldest tag.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/dma/tags.h>
#include <gridiron/dma/transfers.h>

#include "core/dma/test_platform.h"
#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

constexpr std::uint64_t kMemoryBytes = 1 << 18;

struct alignas(128) Line {
  std::byte bytes[128];
};

/// A platform, transfers on it and local memory.
struct Rig {
  TestPlatform platform;
  WorkCounters work;
  Transfers<TestPlatform> transfers;
  std::vector<Line> store;

  explicit Rig(std::uint32_t queue_depth, std::size_t lines = 32)
      : platform(queue_depth, Moves::kAtTheWait, kMemoryBytes), transfers(platform, work), store(lines) {}
};

TEST(NextPiece, EndsAtTheBoundaryTheLimitOrTheRest) {
  EXPECT_EQ(next_piece_bytes({0}, 16), 16u);
  EXPECT_EQ(next_piece_bytes({0}, 4096), 4096u);
  EXPECT_EQ(next_piece_bytes({0}, 100000), 4096u);
  EXPECT_EQ(next_piece_bytes({4080}, 100000), 16u);
  EXPECT_EQ(next_piece_bytes({4096 + 1024}, 3072), 3072u);
  EXPECT_EQ(next_piece_bytes({4096 + 1024}, 3088), 3072u);
  EXPECT_EQ(next_piece_bytes({(std::uint64_t{1} << 40) + 4064}, 64), 32u);
}

class TransfersTest : public testing::TestWithParam<std::uint32_t> {};

TEST_P(TransfersTest, PiecesCoverEverythingOnceWithinTheRules) {
  for_each_seed(300, [&](TestRandom& random) {
    TestPlatform platform(GetParam(), random.below(2) != 0 ? Moves::kAtOnce : Moves::kAtTheWait, kMemoryBytes);
    WorkCounters work;
    Transfers<TestPlatform> transfers(platform, work);
    for (std::uint64_t i = 0; i < kMemoryBytes; ++i) platform.at(0)[i] = static_cast<std::byte>(random.next());
    const std::uint32_t bytes = 16 * (1 + random.below(2500));
    const std::uint64_t address = 16 * std::uint64_t{random.below(6000)};
    const std::uint64_t target = 65536 + 32768 + address % 32 + 32 * std::uint64_t{random.below(100)};
    std::vector<Line> store((bytes + 32) / sizeof(Line) + 1);
    std::byte* const local = store[0].bytes + address % 32;
    const std::byte before_local = store[0].bytes[0];
    ASSERT_EQ(transfers.get(local, {address}, bytes, 3), Status::kOk);
    ASSERT_EQ(transfers.wait(3), Status::kOk);
    ASSERT_EQ(std::memcmp(local, platform.at(address), bytes), 0);
    if (address % 32 != 0) {
      ASSERT_EQ(store[0].bytes[0], before_local);
    }
    const std::byte before = *(platform.at(target) - 1);
    const std::byte behind = *platform.at(target + bytes);
    ASSERT_EQ(transfers.put(local, {target}, bytes, 5), Status::kOk);
    ASSERT_EQ(transfers.wait(5), Status::kOk);
    ASSERT_EQ(std::memcmp(local, platform.at(target), bytes), 0);
    ASSERT_EQ(*(platform.at(target) - 1), before);
    ASSERT_EQ(*platform.at(target + bytes), behind);
    ASSERT_EQ(platform.violation(), "");
    ASSERT_LE(platform.most_pending(), GetParam());
    ASSERT_EQ(platform.pending(), 0u);
    // The pieces follow each other without gap or overlap, and each is counted.
    std::uint32_t gets = 0, puts = 0;
    std::uint64_t next_get = address, next_put = target;
    for (const Command& command : platform.commands()) {
      if (command.kind == Command::Kind::kGet) {
        ASSERT_EQ(command.address, next_get);
        next_get += command.bytes;
        ++gets;
      } else if (command.kind == Command::Kind::kPut) {
        ASSERT_EQ(command.address, next_put);
        next_put += command.bytes;
        ++puts;
      }
    }
    ASSERT_EQ(next_get, address + bytes);
    ASSERT_EQ(next_put, target + bytes);
    ASSERT_EQ(work[Work::kGetIssue], gets);
    ASSERT_EQ(work[Work::kPutIssue], puts);
  });
}

TEST_P(TransfersTest, RandomTrafficNeverExceedsTheQueue) {
  for_each_seed(200, [&](TestRandom& random) {
    TestPlatform platform(GetParam(), Moves::kAtTheWait, kMemoryBytes);
    WorkCounters work;
    Transfers<TestPlatform> transfers(platform, work);
    constexpr std::uint32_t kSlotBytes = 6144;
    std::vector<Line> store(32 * kSlotBytes / sizeof(Line));
    for (int step = 0; step < 200; ++step) {
      const auto tag = static_cast<std::uint8_t>(random.below(32));
      if (random.below(3) == 0) {
        ASSERT_EQ(transfers.wait(tag), Status::kOk);
        continue;
      }
      ASSERT_EQ(transfers.wait(tag), Status::kOk);  // each tag has one buffer
      std::byte* const local = reinterpret_cast<std::byte*>(store.data()) + tag * kSlotBytes;
      const std::uint32_t bytes = 16 * (1 + random.below(kSlotBytes / 16));
      const MainAddress address{32 * std::uint64_t{random.below(6000)}};
      const Status status =
          random.below(2) != 0 ? transfers.get(local, address, bytes, tag) : transfers.put(local, address, bytes, tag);
      ASSERT_EQ(status, Status::kOk) << platform.violation();
      ASSERT_LE(platform.pending(), GetParam());
    }
    ASSERT_EQ(platform.violation(), "");
    ASSERT_LE(platform.most_pending(), GetParam());
    std::uint32_t waits = 0;
    for (const Command& command : platform.commands()) waits += command.kind == Command::Kind::kWait ? 1u : 0u;
    ASSERT_EQ(work[Work::kWait], waits) << "a forced wait is a wait too";
  });
}

INSTANTIATE_TEST_SUITE_P(QueueDepths, TransfersTest, testing::Values(1u, 2u, 3u, 16u));

// Starts one small get of each tag in turn and returns the tags that were waited for.
std::vector<std::uint32_t> forced_waits(Rig& rig, std::initializer_list<std::uint8_t> tags) {
  for (const std::uint8_t tag : tags) {
    EXPECT_EQ(rig.transfers.get(rig.store[tag].bytes, {128 * std::uint64_t{tag}}, 128, tag), Status::kOk);
  }
  std::vector<std::uint32_t> waited;
  for (const Command& command : rig.platform.commands()) {
    if (command.kind == Command::Kind::kWait) waited.push_back(command.tags);
  }
  return waited;
}

TEST(Transfers, FullQueueWaitsForTheOldestTag) {
  Rig rig(3);
  const std::vector<std::uint32_t> waited = forced_waits(rig, {7, 2, 9, 4, 1});
  EXPECT_EQ(waited, (std::vector<std::uint32_t>{1u << 7, 1u << 2}));
  EXPECT_EQ(rig.platform.pending(), 3u);
  EXPECT_EQ(rig.platform.violation(), "");
}

TEST(Transfers, ATagIsAsOldAsItsFirstTransferSinceItsWait) {
  Rig rig(3);
  EXPECT_EQ(rig.transfers.get(rig.store[7].bytes, {0}, 128, 7), Status::kOk);
  EXPECT_EQ(rig.transfers.get(rig.store[2].bytes, {128}, 128, 2), Status::kOk);
  EXPECT_EQ(rig.transfers.wait(7), Status::kOk);
  EXPECT_EQ(rig.transfers.get(rig.store[7].bytes, {0}, 128, 7), Status::kOk);  // now younger than 2
  rig.platform.forget_commands();
  const std::vector<std::uint32_t> waited = forced_waits(rig, {9, 4});
  EXPECT_EQ(waited, (std::vector<std::uint32_t>{1u << 2}));
}

TEST(Transfers, ASecondTransferMakesATagNoYounger) {
  Rig rig(3);
  EXPECT_EQ(rig.transfers.get(rig.store[7].bytes, {0}, 128, 7), Status::kOk);
  EXPECT_EQ(rig.transfers.get(rig.store[2].bytes, {128}, 128, 2), Status::kOk);
  EXPECT_EQ(rig.transfers.get(rig.store[8].bytes, {256}, 128, 7), Status::kOk);
  EXPECT_EQ(forced_waits(rig, {9}), (std::vector<std::uint32_t>{1u << 7}));
}

TEST(Transfers, OutputHasItsOwnShareOfTheQueue) {
  Rig rig(6);
  rig.transfers.reserve_for_output(2);
  // Two tiles on their way take nothing from the four places of the rest, and four gets do not push them out.
  EXPECT_EQ(rig.transfers.put(rig.store[24].bytes, {8192}, 128, kFirstOutputTag), Status::kOk);
  EXPECT_EQ(rig.transfers.put(rig.store[25].bytes, {8320}, 128, kFirstOutputTag + 1), Status::kOk);
  std::vector<std::uint32_t> waited = forced_waits(rig, {1, 2, 3, 4});
  EXPECT_EQ(waited.size(), 0u);
  EXPECT_EQ(rig.platform.pending(), 6u);
  waited = forced_waits(rig, {5});
  EXPECT_EQ(waited, (std::vector<std::uint32_t>{1u << 1}));
  EXPECT_EQ(rig.platform.violation(), "");
  EXPECT_EQ(rig.platform.most_pending(), 6u);
}

TEST(Transfers, FailuresComeBackFromTheCallThatMetThem) {
  for (const Status failure : {Status::kTransferFailed, Status::kTransferTimedOut, Status::kTransferQueueFull}) {
    for (std::size_t failing = 0; failing < 7; ++failing) {
      Rig rig(2, 128);
      rig.platform.failing_command = failing;
      rig.platform.failure = failure;
      // 0, 1: pieces of the get; 2: its wait; 3, 4: pieces of the put; 5: forced wait; 6: the get behind it.
      const Status get = rig.transfers.get(rig.store[0].bytes, {0}, 8192, 1);
      if (failing < 2) {
        EXPECT_EQ(get, failure);
        continue;
      }
      ASSERT_EQ(get, Status::kOk);
      const Status wait = rig.transfers.wait(1);
      if (failing == 2) {
        EXPECT_EQ(wait, failure);
        continue;
      }
      ASSERT_EQ(wait, Status::kOk);
      const Status put = rig.transfers.put(rig.store[0].bytes, {16384}, 8192, 2);
      if (failing < 5) {
        EXPECT_EQ(put, failure);
        continue;
      }
      ASSERT_EQ(put, Status::kOk);
      EXPECT_EQ(rig.transfers.get(rig.store[100].bytes, {0}, 128, 3), failure) << failing;
    }
  }
}

// A platform that looks at the work done between its calls.
struct Observer : TestPlatform {
  using TestPlatform::TestPlatform;
  void note_work(const std::uint32_t* counts, std::uint32_t count) {
    EXPECT_EQ(count, kWorkKindCount);
    seen.push_back(counts[static_cast<std::uint32_t>(Work::kGetIssue)]);
  }
  std::vector<std::uint32_t> seen;
};
static_assert(WorkObserver<Observer> && !WorkObserver<TestPlatform>);

TEST(Transfers, WorkIsNotedBeforeEveryCall) {
  Observer platform(16, Moves::kAtOnce, kMemoryBytes);
  WorkCounters work;
  Transfers<Observer> transfers(platform, work);
  std::vector<Line> store(128);
  EXPECT_EQ(transfers.get(store[0].bytes, {0}, 8192, 1), Status::kOk);
  EXPECT_EQ(transfers.wait(1), Status::kOk);
  EXPECT_EQ(transfers.claim_item().kind, ItemClaim::Kind::kNone);
  EXPECT_EQ(platform.seen, (std::vector<std::uint32_t>{1, 2, 2, 2}));
  EXPECT_EQ(platform.commands().size(), platform.seen.size());
}

}  // namespace
}  // namespace gridiron::test
