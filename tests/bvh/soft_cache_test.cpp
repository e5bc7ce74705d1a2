// The software cache against a list per set. SPDX-License-Identifier: Apache-2.0
#include <gridiron/bvh/soft_cache.h>

#include <list>

#include "support/test_mesh.h"

namespace gridiron::bvh {
namespace {

using Cache = SoftCache<64>;
using Arrival = Cache::Arrival;

/// Four-way sets as lists, most recently used first.
class ListModel {
 public:
  explicit ListModel(std::uint32_t line_count) : sets_(line_count / 4) {}

  /// @returns whether the line was there.
  bool find(std::uint32_t line) {
    std::list<std::uint32_t>& set = sets_[line % sets_.size()];
    const auto place = std::find(set.begin(), set.end(), line);
    const bool found = place != set.end();
    if (found) set.erase(place);
    set.push_front(line);
    if (set.size() > 4) set.pop_back();
    return found;
  }

 private:
  std::vector<std::list<std::uint32_t>> sets_;
};

TEST(SoftCache, ReplacesTheLeastRecentlyUsedOfASet) {
  for (const std::uint32_t line_count : {4u, 8u, 32u, 64u}) {
    const auto cache = std::make_unique<Cache>();
    cache->reset(line_count);
    ListModel model(line_count);
    test::TestRandom random(line_count);
    std::vector<std::uint32_t> line_of_slot(line_count, kNoSlot);
    std::uint64_t hits = 0;
    for (std::uint32_t i = 1; i <= 20000; ++i) {
      // Near lines often, far ones now and then.
      const std::uint32_t line = random.below(4) == 0 ? random.below(1000) : random.below(line_count + 8);
      std::uint32_t slot = cache->find(line, i);
      const bool expected = model.find(line);
      ASSERT_EQ(slot != kNoSlot, expected) << "step " << i << ", line " << line;
      if (expected) {
        ASSERT_EQ(line_of_slot[slot], line) << "step " << i;
        ++hits;
      } else {
        const auto claim = cache->claim(line, i, 0);
        ASSERT_FALSE(claim.is_on_its_way) << "step " << i;
        slot = claim.slot;
        cache->end_fill(slot);
      }
      ASSERT_LT(slot, line_count);
      line_of_slot[slot] = line;
    }
    EXPECT_EQ(cache->counts().lookups, 20000u);
    EXPECT_EQ(cache->counts().hits, hits);
    EXPECT_EQ(cache->counts().misses, 20000u - hits);
    EXPECT_GT(hits, 2000u);
    EXPECT_LT(hits, 19000u);
  }
}

TEST(SoftCache, LineOnItsWayIsNoHitAndNotFetchedAgain) {
  const auto cache = std::make_unique<Cache>();
  cache->reset(8);
  ASSERT_EQ(cache->find(3, 1), kNoSlot);
  const auto first = cache->claim(3, 1, 2);
  ASSERT_FALSE(first.is_on_its_way);
  EXPECT_EQ(cache->filler_of(first.slot), 2u);
  EXPECT_EQ(cache->arrival(first.slot, 3), Arrival::kOnItsWay);
  EXPECT_EQ(cache->find(3, 2), kNoSlot);
  const auto second = cache->claim(3, 2, 1);
  EXPECT_TRUE(second.is_on_its_way);
  EXPECT_EQ(second.slot, first.slot);
  EXPECT_EQ(cache->filler_of(first.slot), 2u);
  cache->end_fill(first.slot);
  EXPECT_EQ(cache->arrival(first.slot, 3), Arrival::kThere);
  EXPECT_EQ(cache->find(3, 3), first.slot);
  EXPECT_EQ(cache->counts().pending_hits, 1u);
  EXPECT_EQ(cache->counts().misses, 1u);
}

// The most there can be: three fetches of a set are under way while a fourth packet fetches line after line.
TEST(SoftCache, LinesOnTheirWayStay) {
  const auto cache = std::make_unique<Cache>();
  cache->reset(4);
  std::vector<std::uint32_t> slots;
  for (std::uint32_t line = 0; line < 3; ++line) slots.push_back(cache->claim(line, line + 1, line).slot);
  std::uint32_t now = 10;
  for (std::uint32_t line = 3; line < 10; ++line) {
    const auto claim = cache->claim(line, ++now, 3);
    EXPECT_EQ(std::count(slots.begin(), slots.end(), claim.slot), 0) << line;
    cache->end_fill(claim.slot);
  }
  for (std::uint32_t line = 0; line < 3; ++line) {
    EXPECT_EQ(cache->arrival(slots[line], line), Arrival::kOnItsWay) << line;
    EXPECT_EQ(cache->filler_of(slots[line]), line);
  }
  // One that has come is the oldest, and goes.
  cache->end_fill(slots[1]);
  EXPECT_EQ(cache->claim(10, ++now, 1).slot, slots[1]);
  EXPECT_EQ(cache->arrival(slots[1], 1), Arrival::kReplaced);
}

TEST(SoftCache, HitRateCountsFetches) {
  EXPECT_EQ(CacheCounts{}.hit_rate(), 1.0);
  const CacheCounts counts{.lookups = 8, .hits = 5, .pending_hits = 1, .misses = 2};
  EXPECT_EQ(counts.hit_rate(), 0.75);
}

}  // namespace
}  // namespace gridiron::bvh
