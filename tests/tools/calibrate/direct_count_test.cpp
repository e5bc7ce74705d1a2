// Prices hold where they were not made: against direct counts of windows of the experiment's views.
// SPDX-License-Identifier: Apache-2.0
#include <build_count.h>
#include <direct_count.h>

#include <cmath>
#include <thread>

#include "support/scenes.h"
#include "support/test_headers.h"

namespace gridiron::calibrate {
namespace {

TEST(DirectCount, PricesAreWithinFivePercentOfWhatViewsTake) {
  const test::SharedFile scenes = test::find_scene("");
  GRIDIRON_SKIP_IF_MISSING(scenes);
  const std::vector<DirectCount> counts =
      count_windows(scenes.path, std::max(1u, std::thread::hardware_concurrency()), [](std::size_t, std::size_t) {});
  ASSERT_FALSE(counts.empty());
  double sum = 0;
  for (const DirectCount& one : counts) {
    EXPECT_LT(std::abs(one.error()), 0.05) << one.view << ", " << one.configuration;
    EXPECT_GT(one.counted, 1e6) << one.view << ", " << one.configuration;
    sum += std::abs(one.error());
  }
  EXPECT_LT(sum / static_cast<double>(counts.size()), 0.03);
  std::ifstream readme(GRIDIRON_SOURCE_DIR "/tools/calibrate/README.md");
  const std::string text{std::istreambuf_iterator<char>(readme), {}};
  EXPECT_NE(text.find(direct_count_table(counts)), std::string::npos)
      << "the table of the README is another one: write it anew with gridiron_calibrate --check";
}

TEST(DirectCount, PricesAreWithinFivePercentOfWhatBuildsTake) {
  const test::SharedFile scenes = test::find_scene("");
  GRIDIRON_SKIP_IF_MISSING(scenes);
  const std::vector<BuildCount> counts = count_scans(scenes.path);
  ASSERT_FALSE(counts.empty());
  for (const BuildCount& one : counts) EXPECT_LT(std::abs(one.error()), 0.05) << one.scan;
}

}  // namespace
}  // namespace gridiron::calibrate
