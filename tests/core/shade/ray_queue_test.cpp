// Ray queue: a stack, whatever part of it is in main memory, within the region that the depth of recursion requires.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/shade/ray_queue.h>
#include <gridiron/store/local_store.h>

#include "core/dma/test_platform.h"
#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using Store = EffectStore<EffectLayout256K<kAllEffects>>;
using Queue = RayQueue<Store, TestPlatform>;

constexpr std::uint32_t kWaveRays = Store::kWaveRays, kSpillBlockRays = Store::kSpillBlockRays;
constexpr std::uint64_t kSpill = kSpillAlignment;
constexpr std::byte kFill{0x5A};

QueuedRay make_ray(std::uint32_t serial, std::uint32_t depth) {
  QueuedRay ray{};
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = static_cast<float>(serial);
    ray.dir[axis] = static_cast<float>(depth + 1);
    ray.weight[axis] = static_cast<float>(axis);
  }
  ray.pixel = serial % 1024 | depth << 16;
  ray.path = serial;
  ray.own = ~serial;
  return ray;
}

bool same(const QueuedRay& a, const QueuedRay& b) {
  return std::memcmp(&a, &b, sizeof(a)) == 0;
}

// A queue with all that is around it.
struct QueueRig {
  TestPlatform platform;
  WorkCounters work;
  Transfers<TestPlatform> transfers;
  std::unique_ptr<Store> store;
  Queue queue;
  std::vector<QueuedRay> model;
  std::uint32_t serial = 0;

  QueueRig(std::uint32_t queue_depth, Moves moves, std::uint64_t region_bytes)
      : platform(queue_depth, moves, kSpill + region_bytes + 4096),
        transfers(platform, work),
        store(std::make_unique<Store>()),
        queue(*store, transfers, MainAddress{kSpill}) {
    std::memset(static_cast<void*>(store.get()), static_cast<int>(kFill), sizeof(Store));
  }

  Status push(std::uint32_t depth) {
    const QueuedRay ray = make_ray(serial++, depth);
    model.push_back(ray);
    return queue.push(ray);
  }
  // Takes a wave and compares it with the model's.
  Status pop(std::vector<QueuedRay>& wave) {
    const std::size_t wanted = std::min<std::size_t>(model.size(), kWaveRays);
    wave.assign(model.end() - static_cast<std::ptrdiff_t>(wanted), model.end());
    std::uint32_t taken = 0, calls = 0;
    bool equal = true;
    const Status status = queue.pop_wave(taken, [&](std::uint32_t i, const QueuedRay& ray) {
      equal = equal && i == calls && i < wave.size() && same(ray, wave[i]);
      ++calls;
    });
    if (status != Status::kOk) return status;
    EXPECT_TRUE(equal) << "other rays, or another order";
    EXPECT_EQ(taken, wanted);
    EXPECT_EQ(calls, wanted);
    model.resize(model.size() - wanted);
    EXPECT_EQ(queue.empty(), model.empty());
    return status;
  }
  // Bytes of the region that puts have reached.
  [[nodiscard]] std::uint64_t used_bytes() const {
    std::uint64_t end = kSpill;
    for (const Command& command : platform.commands()) {
      if (command.kind == Command::Kind::kPut) {
        EXPECT_GE(command.address, kSpill);
        end = std::max(end, command.address + command.bytes);
      }
      if (command.kind == Command::Kind::kGet) {
        EXPECT_GE(command.address, kSpill);
        EXPECT_LE(command.address + command.bytes, end) << "a get of what was never put";
      }
    }
    return end - kSpill;
  }
  // Nothing outside of the ring has changed.
  [[nodiscard]] bool only_the_ring_is_written() const {
    const auto* const bytes = reinterpret_cast<const std::byte*>(store.get());
    const std::size_t first = offsetof(Store, queue), last = first + sizeof(Store::queue);
    for (std::size_t i = 0; i < sizeof(Store); ++i) {
      if (i >= first && i < last) continue;
      if (bytes[i] != kFill) return false;
    }
    return true;
  }
};

TEST(RayQueue, IsAStackWhateverIsSpilled) {
  std::uint64_t spilled = 0, partial = 0;
  for_each_seed(60, [&](TestRandom& random) {
    const std::uint32_t most = most_waiting_rays(kMaxRecursionDepth);
    QueueRig rig(1 + random.below(16), random.below(2) != 0 ? Moves::kAtOnce : Moves::kAtTheWait,
                 spill_bytes(kMaxRecursionDepth));
    ASSERT_TRUE(rig.queue.empty());
    std::vector<QueuedRay> wave;
    for (std::uint32_t step = 0; step < 60; ++step) {
      if (random.below(5) < 3) {
        // About a block, a ring, or the region's end as often as anything else.
        const std::uint32_t around[] = {1, kSpillBlockRays, Store::kQueueRays, 2 * kWaveRays, most};
        std::uint32_t count = around[random.below(5)] + random.below(3) - 1;
        if (random.below(2) == 0) count = random.below(2 * kWaveRays + 1);
        count = std::min(count, most - static_cast<std::uint32_t>(rig.model.size()));
        for (std::uint32_t i = 0; i < count; ++i) ASSERT_EQ(rig.push(random.below(8)), Status::kOk);
        if (!rig.model.empty()) {
          ASSERT_FALSE(rig.queue.empty());
        }
      } else {
        ASSERT_EQ(rig.pop(wave), Status::kOk);
        partial += !wave.empty() && wave.size() < kWaveRays ? 1u : 0u;
      }
      ASSERT_FALSE(testing::Test::HasFailure()) << "step " << step;
    }
    while (!rig.queue.empty()) ASSERT_EQ(rig.pop(wave), Status::kOk);
    EXPECT_TRUE(rig.model.empty());
    const std::uint64_t used = rig.used_bytes();
    EXPECT_LE(used, spill_bytes(kMaxRecursionDepth));
    spilled += used;
    EXPECT_EQ(rig.platform.violation(), "");
    EXPECT_EQ(rig.platform.pending(), 0u);
    EXPECT_TRUE(rig.only_the_ring_is_written());
  });
  if (testing::Test::HasFailure()) return;
  EXPECT_GT(spilled, 0u);
  EXPECT_GT(partial, 0u);
}

// Grows a tree of rays wave by wave; children_of(ray) says how many each has. @returns most rays that waited.
// Where `some_wait`, a third of a wave has its children after the others, as hits on smooth surfaces have: then the
// queue is not ordered by depth.
template <class ChildrenOf>
std::size_t grow(QueueRig& rig, std::uint32_t recursion_depth, bool some_wait, ChildrenOf&& children_of) {
  std::vector<QueuedRay> wave;
  std::size_t most = 0;
  const auto push_children = [&](const QueuedRay& parent) {
    const std::uint32_t depth = parent.pixel >> 16;
    if (depth >= recursion_depth) return;
    for (std::uint32_t i = children_of(parent); i > 0; --i) ASSERT_EQ(rig.push(depth + 1), Status::kOk);
    most = std::max(most, rig.model.size());
  };
  for (std::uint32_t i = 0; i < kMostEffectTilePixels; ++i) push_children(make_ray(i, 1));
  while (!rig.queue.empty() && !testing::Test::HasFailure()) {
    EXPECT_EQ(rig.pop(wave), Status::kOk);
    for (const bool waited : {false, true}) {
      for (const QueuedRay& ray : wave) {
        if ((some_wait && ray.path % 3 == 0) == waited) push_children(ray);
      }
    }
  }
  return most;
}

TEST(RayQueue, TwoChildrenARayFitTheRegion) {
  for (std::uint32_t depth = 2; depth <= kMaxRecursionDepth; ++depth) {
    QueueRig rig(16, Moves::kAtTheWait, spill_bytes(depth));
    const std::size_t most = grow(rig, depth, false, [](const QueuedRay&) { return 2u; });
    // All of depth 2, and of each depth more twice a wave in the place of one.
    EXPECT_EQ(most, 2 * kMostEffectTilePixels + kWaveRays * (depth - 2)) << "depth " << depth;
    EXPECT_LE(most, most_waiting_rays(depth)) << "depth " << depth;
    EXPECT_LE(rig.used_bytes(), spill_bytes(depth)) << "depth " << depth;
    // The ring is full before a block leaves, and then only whole ones do.
    const std::uint64_t blocks =
        most > Store::kQueueRays ? (most - Store::kQueueRays + kSpillBlockRays - 1) / kSpillBlockRays : 0;
    EXPECT_EQ(rig.used_bytes(), blocks * kSpillBlockRays * sizeof(QueuedRay)) << "depth " << depth;
    EXPECT_EQ(rig.platform.violation(), "") << "depth " << depth;
  }
}

// Any number of children: waves then hold several depths.
TEST(RayQueue, AnyTreeFitsTheRegion) {
  for_each_seed(60, [&](TestRandom& random) {
    const std::uint32_t depth = 2 + random.below(kMaxRecursionDepth - 1);
    const std::uint32_t kind = random.below(3), share = 90 + random.below(60);
    QueueRig rig(1 + random.below(16), Moves::kAtTheWait, spill_bytes(depth));
    const std::size_t most = grow(rig, depth, random.below(2) != 0, [&](const QueuedRay& ray) -> std::uint32_t {
      if (kind == 0) return random.below(3);
      if (kind == 1) return random.below(200) < share ? 2 : 0;
      return ((ray.pixel >> 16) % 2 != 0 || random.below(100) < share - 60) ? 2 : random.below(2);
    });
    EXPECT_LE(most, most_waiting_rays(depth));
    EXPECT_LE(rig.used_bytes(), spill_bytes(depth));
    EXPECT_EQ(rig.platform.violation(), "");
  });
}

TEST(RayQueue, SmallTreesNeedNoMainMemory) {
  QueueRig rig(1, Moves::kAtTheWait, 0);
  for (std::uint32_t i = 0; i < Store::kQueueRays; ++i) ASSERT_EQ(rig.push(2), Status::kOk);
  std::vector<QueuedRay> wave;
  ASSERT_EQ(rig.pop(wave), Status::kOk);
  ASSERT_EQ(rig.pop(wave), Status::kOk);
  EXPECT_EQ(wave.size(), Store::kQueueRays - kWaveRays);
  EXPECT_TRUE(rig.platform.commands().empty());
  std::uint32_t taken = 7;
  EXPECT_EQ(rig.queue.pop_wave(taken, [](std::uint32_t, const QueuedRay&) { ADD_FAILURE(); }), Status::kOk);
  EXPECT_EQ(taken, 0u);
}

// Every command fails once: the call that caused it reports it, and everything before is correct.
TEST(RayQueue, FailingTransfersAreReported) {
  const auto run = [](std::optional<std::size_t> failing, std::size_t& commands) {
    QueueRig rig(2, Moves::kAtTheWait, spill_bytes(4));
    rig.platform.failing_command = failing;
    std::vector<QueuedRay> wave;
    Status status = Status::kOk;
    for (std::uint32_t i = 0; i < 1200 && status == Status::kOk; ++i) status = rig.push(2);
    while (status == Status::kOk && !rig.queue.empty()) status = rig.pop(wave);
    commands = rig.platform.commands().size();
    EXPECT_EQ(rig.platform.violation(), "");
    return status;
  };
  std::size_t commands = 0, stopped_at = 0;
  ASSERT_EQ(run(std::nullopt, commands), Status::kOk);
  ASSERT_GT(commands, 20u);
  for (std::size_t i = 0; i < commands; ++i) {
    EXPECT_EQ(run(i, stopped_at), Status::kTransferFailed) << "command " << i;
    EXPECT_EQ(stopped_at, i + 1) << "goes on after a failure";
  }
}

}  // namespace
}  // namespace gridiron::test
