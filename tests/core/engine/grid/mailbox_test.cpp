// Mailbox: never claims a triangle that was not tested. SPDX-License-Identifier: Apache-2.0
#include <gridiron/engine/grid/mailbox.h>

#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using SmallMailbox = Mailbox<64>;
constexpr SubpacketSet kAll = ~SubpacketSet{0};

TEST(Mailbox, RemembersWhatNothingPushedOut) {
  SmallMailbox mailbox{};
  mailbox.clear();
  for (std::uint32_t id = 0; id < SmallMailbox::kSlotCount; ++id) EXPECT_EQ(mailbox.untested(id, kAll), kAll) << id;
  for (std::uint32_t id = 0; id < SmallMailbox::kSlotCount; ++id) EXPECT_EQ(mailbox.untested(id, kAll), 0u) << id;
  EXPECT_EQ(mailbox.untested(SmallMailbox::kSlotCount + 3, kAll), kAll);
  EXPECT_EQ(mailbox.untested(3, kAll), kAll) << "its slot holds another triangle";
  EXPECT_EQ(mailbox.untested(4, kAll), 0u);
  mailbox.clear();
  for (std::uint32_t id = 0; id < SmallMailbox::kSlotCount; ++id) EXPECT_EQ(mailbox.untested(id, kAll), kAll) << id;
}

TEST(Mailbox, RemembersSubpackets) {
  SmallMailbox mailbox{};
  mailbox.clear();
  EXPECT_EQ(mailbox.untested(7, 0b0011), 0b0011u);
  EXPECT_EQ(mailbox.untested(7, 0b0110), 0b0100u);
  EXPECT_EQ(mailbox.untested(7, 0b1111), 0b1000u);
  EXPECT_EQ(mailbox.untested(7, 0b1111), 0u);
}

TEST(Mailbox, NeverClaimsATriangleThatWasNotTested) {
  std::uint64_t seen_count = 0;
  for_each_seed(200, [&](TestRandom& random) {
    SmallMailbox mailbox{};
    mailbox.clear();
    std::map<std::uint32_t, SubpacketSet> tested;
    for (int i = 0; i < 2000; ++i) {
      const std::uint32_t id = random.below(4) == 0 ? kNoTriangle - 1 - random.below(100) : random.below(200);
      const SubpacketSet wanted = random.below(2) == 0 ? kAll : SubpacketSet{random.below(16)} << random.below(60);
      const SubpacketSet left_out = wanted & ~mailbox.untested(id, wanted);
      seen_count += left_out != 0 ? 1u : 0u;
      ASSERT_EQ(left_out & ~tested[id], 0u) << "step " << i << ", triangle " << id;
      tested[id] |= wanted;
    }
  });
  EXPECT_GT(seen_count, 1000u);
}

}  // namespace
}  // namespace gridiron::test
