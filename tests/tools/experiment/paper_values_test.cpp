// Paper values: derived values follow from printed ones. SPDX-License-Identifier: Apache-2.0
#include "experiment/paper_values.h"

#include <gtest/gtest.h>

namespace gridiron::test {
namespace {

using namespace experiment;

// Worked out by hand from Table 4, to one digit behind the point: single- and double-buffered, 1 core and 6 cores.
TEST(PaperValues, WaitSharesFollowFromTable4) {
  struct Row {
    const char* key;
    double single[2], twice[2];
  };
  const Row rows[] = {{"bunny", {18.6, 19.0}, {6.1, 6.3}},
                      {"horse", {16.4, 17.4}, {4.6, 5.2}},
                      {"armadillo_standin", {12.3, 12.7}, {3.3, 3.5}},
                      {"conference_1", {22.1, 22.8}, {7.5, 10.1}},
                      {"conference_2", {24.4, 26.0}, {7.9, 12.3}}};
  ASSERT_EQ(paper_views().size(), std::size(rows));
  for (const Row& row : rows) {
    const PaperView* view = find_paper_view(row.key);
    ASSERT_NE(view, nullptr) << row.key;
    for (const std::size_t i : {0u, 1u}) {
      EXPECT_NEAR(derived_single_wait_percent(*view, i), row.single[i], 0.06) << row.key;
      EXPECT_NEAR(derived_double_wait_percent(*view, i), row.twice[i], 0.06) << row.key;
    }
  }
  EXPECT_EQ(find_paper_view("teapot"), nullptr);
}

// Double buffering takes h w out of a frame of 1: the rest makes the printed gain.
TEST(PaperValues, DerivationsAreConsistent) {
  for (const PaperView& view : paper_views()) {
    for (const std::size_t i : {0u, 1u}) {
      const double single = derived_single_wait_percent(view, i) / 100, hidden = view.hidden[i] / 100;
      const double frame = 1 - single * hidden;
      EXPECT_NEAR(100 * (1 / frame - 1), view.fps_gain[i], 1e-9);
      EXPECT_NEAR(100 * single * (1 - hidden) / frame, derived_double_wait_percent(view, i), 1e-9);
    }
  }
}

}  // namespace
}  // namespace gridiron::test
