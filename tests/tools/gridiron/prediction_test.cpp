// Predictions: sums, ranks, and a profile that is wrong by a factor.
// SPDX-License-Identifier: Apache-2.0
#include "gridiron/job/prediction.h"

#include <gridiron/sim/busy_cycles.h>
#include <gridiron/sim/trace_packing.h>

#include "support/test_headers.h"

namespace gridiron::tool {
namespace {

TEST(Prediction, AFactorIsAnErrorOfTheFrameAndNotOfTheRanks) {
  const std::array counted = {10.0, 40.0, 20.0, 30.0};
  const std::array predicted = {11.0, 44.0, 22.0, 33.0};
  const PredictionQuality quality = quality_of(counted, predicted);
  EXPECT_DOUBLE_EQ(quality.counted, 100);
  EXPECT_NEAR(quality.frame_error(), 0.1, 1e-12);
  EXPECT_NEAR(quality.largest_tile_error, 0.1, 1e-12);
  EXPECT_DOUBLE_EQ(quality.rank_correlation, 1);
}

TEST(Prediction, RanksAreSpearmans) {
  // One exchange of neighbours among five: 1 - 6 * 2 / (5 * 24).
  const std::array counted = {1.0, 2.0, 3.0, 4.0, 5.0};
  const std::array exchanged = {1.0, 3.0, 2.0, 400.0, 500.0};
  EXPECT_NEAR(quality_of(counted, exchanged).rank_correlation, 0.9, 1e-12);
  const std::array reversed = {5.0, 4.0, 3.0, 2.0, 1.0};
  EXPECT_NEAR(quality_of(counted, reversed).rank_correlation, -1, 1e-12);
}

TEST(Prediction, TiesShareTheirRank) {
  const std::array counted = {1.0, 1.0, 2.0};
  const std::array same = {7.0, 7.0, 9.0};
  const std::array other = {7.0, 8.0, 9.0};
  const std::array constant = {4.0, 4.0, 4.0};
  EXPECT_DOUBLE_EQ(quality_of(counted, same).rank_correlation, 1);
  EXPECT_NEAR(quality_of(counted, other).rank_correlation, 0.8660254, 1e-6);
  EXPECT_DOUBLE_EQ(quality_of(counted, constant).rank_correlation, 0);
  EXPECT_DOUBLE_EQ(quality_of(constant, constant).rank_correlation, 1);
}

TEST(Prediction, BusyCyclesAreClaimWorkCommandsAndWaits) {
  sim::MachineProfile machine = *sim::find_machine_profile("fu540");
  machine.claim_cycles = 1;
  machine.issue_cycles = 10;
  machine.wait_cycles = 100;
  machine.work_cycles[static_cast<std::size_t>(GridWork::kCellStep)] = 1000;
  const sim::WorkAmount work[] = {{GridWork::kCellStep, 2}, {GridWork::kCellStep, 3}};
  sim::TraceWriter writer;
  for (const sim::EventKind kind : {sim::EventKind::kGet, sim::EventKind::kPut, sim::EventKind::kGet,
                                    sim::EventKind::kWait, sim::EventKind::kStage, sim::EventKind::kWork}) {
    writer.add({.kind = kind, .work = work});
  }
  EXPECT_DOUBLE_EQ(sim::busy_cycles(writer.finish(0), machine), 1 + 30 + 100 + 5000);
}

}  // namespace
}  // namespace gridiron::tool
