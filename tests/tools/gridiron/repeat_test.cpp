// Repeated frames: planes that differ are no success. SPDX-License-Identifier: Apache-2.0
#include "base/failure.h"
#include "base/stopwatch.h"
#include "gridiron/frame/frame_pictures.h"
#include "support/test_headers.h"

namespace gridiron::tool {
namespace {

TEST(Repeat, OtherPlanesFailWithBothHashes) {
  const PlaneHashes first{1, 2, 3};
  require_same_planes(first, first, 2);
  const struct {
    PlaneHashes again;
    std::string words;
  } cases[] = {{{9, 2, 3}, "render 4 made another picture than the first: hash 0000000000000009, not 0000000000000001"},
               {{1, 9, 3}, "another plane of distances"},
               {{1, 2, 9}, "another plane of triangle ids"}};
  for (const auto& each : cases) {
    try {
      require_same_planes(first, each.again, 4);
      ADD_FAILURE() << each.words;
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::kCheckFailed);
      EXPECT_NE(std::string(failure.what()).find(each.words), std::string::npos) << failure.what();
    }
  }
}

TEST(Repeat, TheLeastOfBothTimesIsKept) {
  const HostSeconds least = HostSeconds{2, 5}.least({3, 4});
  EXPECT_EQ(least.wall, 2);
  EXPECT_EQ(least.processor, 4);
}

}  // namespace
}  // namespace gridiron::tool
