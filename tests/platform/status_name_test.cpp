// Every Status has a name of its own, the enumerator's, and no other number has one.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/platform/status_name.h>

#include "support/test_headers.h"

namespace gridiron {
namespace {

// Constants, so that a table of them costs a program nothing but the texts it uses.
static_assert(status_name(Status::kOk)[0] == 'k' && status_name(Status::kOk)[1] == 'O');
static_assert(status_name(0x100u) == nullptr);

TEST(StatusName, IsTheEnumerators) {
  EXPECT_STREQ(status_name(Status::kOk), "kOk");
  EXPECT_STREQ(status_name(Status::kTransferSize), "kTransferSize");
  EXPECT_STREQ(status_name(Status::kBadEffects), "kBadEffects");
  EXPECT_STREQ(status_name(16u), "kUnsupportedFrame");
}

TEST(StatusName, OfNumbersEndsWithTheLastStatus) {
  std::set<std::string> names;
  std::uint32_t count = 0;
  for (; status_name(count) != nullptr; ++count) names.insert(status_name(count));
  EXPECT_EQ(names.size(), count) << "two have one name";
  EXPECT_EQ(count, static_cast<std::uint32_t>(Status::kBadEffects) + 1);
  for (std::uint32_t number = count; number < 0x10000; ++number) ASSERT_EQ(status_name(number), nullptr) << number;
}

}  // namespace
}  // namespace gridiron
