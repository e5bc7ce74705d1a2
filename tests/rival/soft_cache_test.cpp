// The software cache against a list per set. SPDX-License-Identifier: Apache-2.0
#include <gridiron/rival/soft_cache.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <list>
#include <memory>
#include <vector>

#include "support/test_mesh.h"

namespace gridiron::rival {
namespace {

using Cache = SoftCache<64>;
using Answer = Cache::Answer;

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
  for (const std::uint32_t line_count : {4u, 8u, 20u, 64u}) {
    const auto cache = std::make_unique<Cache>();
    cache->reset(line_count);
    ListModel model(line_count);
    test::TestRandom random(line_count);
    std::vector<std::uint32_t> line_of_slot(line_count, 0xFFFFFFFFu);
    std::uint64_t hits = 0;
    for (int i = 0; i < 20000; ++i) {
      // Near lines often, far ones now and then.
      const std::uint32_t line = random.below(4) == 0 ? random.below(1000) : random.below(line_count + 8);
      const auto found = cache->find(line);
      const bool expected = model.find(line);
      ASSERT_EQ(found.answer, expected ? Answer::kHit : Answer::kMiss) << "step " << i << ", line " << line;
      ASSERT_LT(found.slot, line_count);
      if (expected) {
        ASSERT_EQ(line_of_slot[found.slot], line) << "step " << i;
      }
      line_of_slot[found.slot] = line;
      hits += expected ? 1 : 0;
    }
    EXPECT_EQ(cache->counts().lookups, 20000u);
    EXPECT_EQ(cache->counts().hits, hits);
    EXPECT_EQ(cache->counts().misses, 20000u - hits);
    EXPECT_GT(hits, 2000u);
    EXPECT_LT(hits, 19000u);
  }
}

TEST(SoftCache, LineOnItsWayIsAPendingHit) {
  const auto cache = std::make_unique<Cache>();
  cache->reset(8);
  const auto first = cache->find(3);
  ASSERT_EQ(first.answer, Answer::kMiss);
  cache->pin(first.slot);
  cache->begin_fill(first.slot, 7);
  const auto second = cache->find(3);
  EXPECT_EQ(second.answer, Answer::kPending);
  EXPECT_EQ(second.slot, first.slot);
  EXPECT_EQ(cache->tag_of(second.slot), 7);
  cache->end_fill(first.slot);
  EXPECT_FALSE(cache->is_pending(first.slot));
  EXPECT_EQ(cache->find(3).answer, Answer::kHit);
  EXPECT_EQ(cache->counts().pending_hits, 1u);
}

TEST(SoftCache, PinnedLineStaysAndASetOfThemRefuses) {
  const auto cache = std::make_unique<Cache>();
  cache->reset(4);
  std::vector<std::uint32_t> slots;
  for (std::uint32_t line = 0; line < 3; ++line) {
    slots.push_back(cache->find(line).slot);
    cache->pin(slots.back());
  }
  // One way is free: lines 3..9 take it in turn.
  for (std::uint32_t line = 3; line < 10; ++line) {
    const auto found = cache->find(line);
    EXPECT_EQ(found.answer, Answer::kMiss);
    EXPECT_EQ(std::count(slots.begin(), slots.end(), found.slot), 0) << line;
  }
  cache->pin(cache->find(9).slot);
  EXPECT_EQ(cache->find(10).answer, Answer::kFull);
  EXPECT_EQ(cache->counts().refusals, 1u);
  cache->unpin(slots[1]);
  const auto found = cache->find(10);
  EXPECT_EQ(found.answer, Answer::kMiss);
  EXPECT_EQ(found.slot, slots[1]);
}

TEST(SoftCache, HitRateCountsFetches) {
  EXPECT_EQ(CacheCounts{}.hit_rate(), 1.0);
  const CacheCounts counts{.lookups = 12, .hits = 5, .pending_hits = 1, .misses = 2, .refusals = 4};
  EXPECT_EQ(counts.hit_rate(), 0.75);
}

}  // namespace
}  // namespace gridiron::rival
