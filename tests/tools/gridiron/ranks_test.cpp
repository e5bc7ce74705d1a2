// How pieces of work are divided among ranks. SPDX-License-Identifier: Apache-2.0
#include "base/ranks.h"

#include "support/test_headers.h"

namespace gridiron::tool {
namespace {

// Each piece once, each rank's rising, and no rank more than one above an even share.
TEST(Ranks, HaveEvenShares) {
  for (const std::uint32_t count : {1u, 2u, 3u, 4u, 7u, 64u}) {
    for (const std::uint64_t pieces : {0u, 1u, 2u, 3u, 5u, 63u, 64u, 65u, 1000u}) {
      SCOPED_TRACE(std::to_string(pieces) + " pieces, " + std::to_string(count) + " ranks");
      std::vector<std::uint32_t> owners(pieces, count);
      for (std::uint32_t rank = 0; rank < count; ++rank) {
        EXPECT_EQ(piece_of_rank(0, rank, count), rank);
        std::uint64_t share = 0;
        for (std::uint64_t k = 0; piece_of_rank(k, rank, count) < pieces; ++k, ++share) {
          const std::uint64_t i = piece_of_rank(k, rank, count);
          EXPECT_LT(i, piece_of_rank(k + 1, rank, count));
          EXPECT_EQ(owners[i], count) << i;
          owners[i] = rank;
          EXPECT_EQ(rank_of_piece(i, count), rank);
        }
        EXPECT_LE(share, pieces / count + (pieces % count != 0 ? 1 : 0));
      }
      EXPECT_EQ(std::ranges::count(owners, count), 0);
    }
  }
}

// Claims of tiles alternate between the upper and the lower half of a picture, and return to a column.
TEST(Ranks, HaveLikePartsOfKindsThatTakeTurns) {
  for (const std::uint32_t count : {2u, 4u, 6u, 16u}) {
    for (const std::uint64_t kinds : {2u, 8u, 24u, 48u}) {
      for (std::uint32_t rank = 0; rank < count; ++rank) {
        std::vector<int> of_kind(kinds);
        for (std::uint64_t k = 0; k < 50 * kinds; ++k) ++of_kind[piece_of_rank(k, rank, count) % kinds];
        for (const int pieces : of_kind) {
          EXPECT_NEAR(pieces, 50, 15) << rank << " of " << count << " ranks, " << kinds << " kinds";
        }
      }
    }
  }
}

}  // namespace
}  // namespace gridiron::tool
