// Accuracies: every profile of core has one name. SPDX-License-Identifier: Apache-2.0
#include "gridiron/device/accuracies.h"

#include <gtest/gtest.h>

#include <set>
#include <string_view>

#include "gridiron/frame/render_plan.h"

namespace gridiron::test {
namespace {

TEST(Accuracies, EachHasOneName) {
  std::set<std::string_view> names;
  std::set<Accuracy> values;
  for (const tool::NamedAccuracy& named : tool::accuracies()) {
    EXPECT_TRUE(names.insert(named.name).second) << named.name;
    EXPECT_TRUE(values.insert(named.accuracy).second) << named.name;
    EXPECT_FALSE(named.description.empty()) << named.name;
  }
  EXPECT_EQ(values, (std::set<Accuracy>{Accuracy::kStandard, Accuracy::kPaper, Accuracy::kExact, Accuracy::kFast,
                                        Accuracy::kCompact}));
  EXPECT_EQ(values.count(tool::RenderRequest{}.accuracy), 1u);
}

}  // namespace
}  // namespace gridiron::test
