// Record gather: every item gets its own record, neighbours that want the same one share a transfer, at any depth.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/dma/record_gather.h>

#include "core/dma/test_platform.h"
#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

constexpr std::uint64_t kMemoryBytes = 1 << 17;
constexpr std::uint32_t kDepths = 8;
constexpr std::uint32_t kBufferBytes = 1024;

// What gather_records needs of a local store.
struct GatherStore {
  struct {
    std::uint32_t fetch_depth;
  } frame;
  struct alignas(128) Buffer {
    std::byte bytes[kBufferBytes];
  };
  struct {
    struct {
      Buffer buffers[kDepths + 1];  // the last is nobody's
      std::uint32_t lent;
      void lend(std::uint32_t count) { lent = count; }
      [[nodiscard]] std::byte* idle_buffer(std::uint32_t slot) {
        EXPECT_LT(slot, lent) << "not lent";
        return buffers[slot].bytes;
      }
    } rays;
  } wave;
};

struct Rig {
  TestPlatform platform;
  WorkCounters work;
  Transfers<TestPlatform> transfers;
  std::unique_ptr<GatherStore> store;

  Rig(std::uint32_t fetch_depth, std::uint32_t queue_depth, Moves moves)
      : platform(queue_depth, moves, kMemoryBytes), transfers(platform, work), store(std::make_unique<GatherStore>()) {
    std::memset(static_cast<void*>(store.get()), 0x3C, sizeof(GatherStore));
    store->frame.fetch_depth = fetch_depth;
    store->wave.rays.lent = 0;
    TestRandom random(1);
    for (std::uint64_t i = 0; i < kMemoryBytes; i += 8) {
      const std::uint64_t word = random.next();
      std::memcpy(platform.at(i), &word, 8);
    }
  }

  // Gathers, and compares every record with main memory. `used` becomes the items in the order of their calls.
  Status gather(const std::vector<std::uint64_t>& list, std::uint32_t bytes, std::vector<std::uint32_t>& used,
                std::optional<std::uint32_t> failing_use = std::nullopt) {
    used.clear();
    return gather_records(
        *store, transfers, static_cast<std::uint32_t>(list.size()), bytes,
        [&](std::uint32_t i) {
          EXPECT_LT(i, list.size());
          return list[i];
        },
        [&](std::uint32_t i, const std::byte* record) {
          EXPECT_EQ(std::memcmp(record, platform.at(list[i]), bytes), 0) << "item " << i;
          used.push_back(i);
          return failing_use && *failing_use == i ? Status::kBadFrame : Status::kOk;
        });
  }
  [[nodiscard]] bool others_are_untouched() const {
    for (std::uint32_t slot = store->frame.fetch_depth; slot <= kDepths; ++slot) {
      for (const std::byte value : store->wave.rays.buffers[slot].bytes) {
        if (value != std::byte{0x3C}) return false;
      }
    }
    return true;
  }
};

std::uint32_t gets_of(const TestPlatform& platform) {
  std::uint32_t count = 0;
  for (const Command& command : platform.commands()) count += command.kind == Command::Kind::kGet ? 1u : 0u;
  return count;
}

// Runs of the same record in a list, those that want none left out.
std::uint32_t runs_of(const std::vector<std::uint64_t>& list) {
  std::uint32_t count = 0;
  std::uint64_t last = 0;
  for (const std::uint64_t address : list) {
    if (address == 0 || address == last) continue;
    last = address;
    ++count;
  }
  return count;
}

// Records lie at multiples of their size, as they do in an image; none across a boundary that would cut its transfer.
std::uint64_t random_address(TestRandom& random, std::uint32_t bytes, std::uint32_t kinds) {
  for (;;) {
    const std::uint64_t address = 4096 + std::uint64_t{random.below(kinds)} * bytes;
    if (address / kPortableBoundaryBytes == (address + bytes - 1) / kPortableBoundaryBytes) return address;
  }
}

class RecordGather : public testing::TestWithParam<std::uint32_t> {};

TEST_P(RecordGather, EveryItemGetsItsRecord) {
  for_each_seed(120, [&](TestRandom& random) {
    constexpr std::uint32_t kSizes[] = {48, 768, 16, 1008};  // surfaces and normals, environment, least, most
    const std::uint32_t bytes = kSizes[random.below(4)];
    const std::uint32_t kinds = random.below(2) != 0 ? 3 : 100;
    const std::uint32_t skipped = random.below(4), shared = random.below(4);
    std::vector<std::uint64_t> list(random.below(5) == 0 ? random.below(4) : random.below(257));
    for (std::size_t i = 0; i < list.size(); ++i) {
      list[i] = random_address(random, bytes, kinds);
      if (i > 0 && random.below(4) < shared) list[i] = list[i - 1];
      if (random.below(4) < skipped) list[i] = 0;
    }
    Rig rig(GetParam(), 1 + random.below(16), random.below(3) != 0 ? Moves::kAtTheWait : Moves::kAtOnce);
    std::vector<std::uint32_t> used, wanted;
    ASSERT_EQ(rig.gather(list, bytes, used), Status::kOk);
    for (std::uint32_t i = 0; i < list.size(); ++i) {
      if (list[i] != 0) wanted.push_back(i);
    }
    EXPECT_EQ(used, wanted);
    EXPECT_EQ(gets_of(rig.platform), runs_of(list));
    EXPECT_EQ(rig.platform.pending(), 0u);
    EXPECT_EQ(rig.platform.violation(), "");
    EXPECT_LE(rig.platform.most_pending(), GetParam());
    EXPECT_TRUE(rig.others_are_untouched());
  });
}

TEST_P(RecordGather, KeepsAsManyUnderWayAsItMay) {
  std::vector<std::uint64_t> list;
  for (std::uint32_t i = 0; i < 40; ++i) list.push_back(4096 + 48 * i);
  Rig rig(GetParam(), 16, Moves::kAtTheWait);
  std::vector<std::uint32_t> used;
  ASSERT_EQ(rig.gather(list, 48, used), Status::kOk);
  EXPECT_EQ(rig.platform.most_pending(), GetParam());
  EXPECT_EQ(rig.work[Work::kWait], list.size()) << "one wait a record";
}

TEST_P(RecordGather, SkippedItemsDoNotPartNeighbours) {
  const std::vector<std::uint64_t> list = {0, 4096, 0, 0, 4096, 8192, 0, 8192, 8192, 4096, 0};
  Rig rig(GetParam(), 16, Moves::kAtTheWait);
  std::vector<std::uint32_t> used;
  ASSERT_EQ(rig.gather(list, 48, used), Status::kOk);
  EXPECT_EQ(gets_of(rig.platform), 3u);
  EXPECT_EQ(used, (std::vector<std::uint32_t>{1, 4, 5, 7, 8, 9}));
  rig.platform.forget_commands();
  ASSERT_EQ(rig.gather({0, 0, 0}, 48, used), Status::kOk);
  ASSERT_EQ(rig.gather({}, 48, used), Status::kOk);
  EXPECT_TRUE(rig.platform.commands().empty());
}

TEST_P(RecordGather, FailuresAreReported) {
  std::vector<std::uint64_t> list;
  for (std::uint32_t i = 0; i < 20; ++i) list.push_back(4096 + 48 * (i / 2));
  std::vector<std::uint32_t> used;
  std::size_t commands = 0;
  {
    Rig rig(GetParam(), 3, Moves::kAtTheWait);
    ASSERT_EQ(rig.gather(list, 48, used), Status::kOk);
    commands = rig.platform.commands().size();
  }
  for (std::size_t i = 0; i < commands; ++i) {
    Rig rig(GetParam(), 3, Moves::kAtTheWait);
    rig.platform.failing_command = i;
    EXPECT_EQ(rig.gather(list, 48, used), Status::kTransferFailed) << "command " << i;
    EXPECT_EQ(rig.platform.commands().size(), i + 1) << "goes on after a failure";
  }
  for (std::uint32_t item = 0; item < list.size(); ++item) {
    Rig rig(GetParam(), 3, Moves::kAtTheWait);
    EXPECT_EQ(rig.gather(list, 48, used, item), Status::kBadFrame);
    EXPECT_EQ(used.size(), item + 1u);
  }
}

INSTANTIATE_TEST_SUITE_P(Depths, RecordGather, testing::Range(1u, kDepths + 1),
                         [](const auto& tested) { return "Depth" + std::to_string(tested.param); });

}  // namespace
}  // namespace gridiron::test
