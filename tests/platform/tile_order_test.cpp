// The order of tiles from the middle outward.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/platform/tile_order.h>

#include "support/test_headers.h"

namespace gridiron {
namespace {

TEST(TileOrder, MiddleOutIsAPermutationThatNeverComesNearer) {
  for (std::uint32_t count = 1; count <= 300; ++count) {
    std::set<std::uint32_t> seen;
    double last = 0;
    for (std::uint32_t claim = 0; claim < count; ++claim) {
      const std::uint32_t tile = middle_out(claim, count);
      ASSERT_LT(tile, count);
      ASSERT_TRUE(seen.insert(tile).second) << tile << " of " << count;
      const double distance = std::abs(tile + 0.5 - 0.5 * count);
      ASSERT_GE(distance, last);
      last = distance;
    }
  }
}

}  // namespace
}  // namespace gridiron
