// Mailbox: never claims a triangle that was not tested. SPDX-License-Identifier: Apache-2.0
#include <gridiron/traverse/mailbox.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <set>

#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

TEST(Mailbox, RemembersWhatNothingPushedOut) {
  Mailbox mailbox;
  mailbox.clear();
  for (std::uint32_t id = 0; id < Mailbox::kSlotCount; ++id) EXPECT_FALSE(mailbox.seen(id)) << id;
  for (std::uint32_t id = 0; id < Mailbox::kSlotCount; ++id) EXPECT_TRUE(mailbox.seen(id)) << id;
  EXPECT_FALSE(mailbox.seen(Mailbox::kSlotCount + 3));
  EXPECT_FALSE(mailbox.seen(3)) << "its slot holds another triangle";
  EXPECT_TRUE(mailbox.seen(4));
  mailbox.clear();
  for (std::uint32_t id = 0; id < Mailbox::kSlotCount; ++id) EXPECT_FALSE(mailbox.seen(id)) << id;
}

TEST(Mailbox, NeverClaimsATriangleThatWasNotTested) {
  std::uint64_t seen_count = 0;
  for_each_seed(200, [&](std::uint64_t seed) {
    TestRandom random(seed);
    Mailbox mailbox;
    mailbox.clear();
    std::set<std::uint32_t> tested;
    for (int i = 0; i < 2000; ++i) {
      const std::uint32_t id = random.below(4) == 0 ? kNoTriangle - 1 - random.below(100) : random.below(200);
      const bool seen = mailbox.seen(id);
      seen_count += seen ? 1u : 0u;
      ASSERT_TRUE(!seen || tested.contains(id)) << "seed " << seed << ", step " << i << ", triangle " << id;
      tested.insert(id);
    }
  });
  EXPECT_GT(seen_count, 1000u);
}

}  // namespace
}  // namespace gridiron::test
