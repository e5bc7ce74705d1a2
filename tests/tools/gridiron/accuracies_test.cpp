// Accuracies: every profile of core has one name. SPDX-License-Identifier: Apache-2.0
#include "gridiron/device/accuracies.h"

#include "support/test_headers.h"

namespace gridiron::test {
namespace {

TEST(Accuracies, EachHasOneName) {
  std::set<std::string_view> names;
  for (const tool::NamedAccuracy& named : tool::accuracies()) {
    EXPECT_TRUE(names.insert(named.name).second) << named.name;
    EXPECT_EQ(tool::accuracy_name(named.accuracy), named.name);
    EXPECT_FALSE(named.description.empty()) << named.name;
  }
  EXPECT_EQ(names.size(), kAccuracyCount);
}

}  // namespace
}  // namespace gridiron::test
