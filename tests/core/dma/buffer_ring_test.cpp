// Buffer ring: buffers go out and come back in order, and none is handed out twice.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/dma/buffer_ring.h>

#include <deque>

#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

TEST(BufferRing, DepthOneIsSingleBuffering) {
  BufferRing ring(1);
  for (int round = 0; round < 3; ++round) {
    EXPECT_TRUE(ring.empty());
    EXPECT_FALSE(ring.full());
    EXPECT_EQ(ring.push(), 0u);
    EXPECT_TRUE(ring.full());
    EXPECT_EQ(ring.front(), 0u);
    ring.pop();
  }
}

TEST(BufferRing, HandsOutInOrderAndNoneTwice) {
  for_each_seed(200, [&](TestRandom& random) {
    const std::uint32_t depth = 1 + random.below(15);
    BufferRing ring(depth);
    std::deque<std::uint32_t> out;
    for (int step = 0; step < 500; ++step) {
      ASSERT_EQ(ring.empty(), out.empty());
      ASSERT_EQ(ring.full(), out.size() == depth);
      if (!out.empty()) {
        ASSERT_EQ(ring.front(), out.front());
      }
      if (!out.empty() && (ring.full() || random.below(2) != 0)) {
        ring.pop();
        out.pop_front();
      } else {
        const std::uint32_t slot = ring.push();
        ASSERT_LT(slot, depth);
        ASSERT_EQ(std::set<std::uint32_t>(out.begin(), out.end()).count(slot), 0u);
        out.push_back(slot);
      }
    }
  });
}

}  // namespace
}  // namespace gridiron::test
