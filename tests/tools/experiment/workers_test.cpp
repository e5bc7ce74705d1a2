// Workers: every piece once, the first error. SPDX-License-Identifier: Apache-2.0
#include "experiment/workers.h"

#include <atomic>
#include <stdexcept>

#include "support/test_headers.h"

namespace gridiron::test {
namespace {

using experiment::share_work;

TEST(Workers, EveryPieceIsDoneOnce) {
  for (const std::uint32_t threads : {1u, 2u, 7u}) {
    std::vector<std::atomic<int>> done(100);
    share_work(threads, done.size(), [&done](std::size_t i) { ++done[i]; });
    for (const std::atomic<int>& count : done) EXPECT_EQ(count, 1);
  }
  share_work(3, 0, [](std::size_t) { FAIL(); });
}

TEST(Workers, TheLowestErrorIsThrownAndNothingBeginsAfterIt) {
  for (const std::uint32_t threads : {1u, 4u}) {
    std::atomic<int> begun = 0;
    try {
      share_work(threads, 1'000'000, [&begun](std::size_t i) {
        ++begun;
        if (i >= 3) throw std::runtime_error(std::to_string(i));
      });
      ADD_FAILURE() << "no error";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "3") << "pieces begin in order, so piece 3 always does";
    }
    EXPECT_LT(begun, 1'000);
  }
}

}  // namespace
}  // namespace gridiron::test
