// The pipeline model against schedules by hand. SPDX-License-Identifier: Apache-2.0
#include <gridiron/engine/grid/grid_work.h>
#include <gtest/gtest.h>
#include <pipe_model.h>

#include <utility>
#include <vector>

namespace gridiron::calibrate {
namespace {

constexpr Site kSite = 1;

// One usual branch, taken.
Branches taken_branch() {
  Branches branches;
  branches[kSite][1] = 1;
  return branches;
}

class PipeModelTest : public testing::Test {
 protected:
  Branches branches_ = taken_branch();
  PipeModel model_{&branches_, {.superblock_branches = 1}};

  void SetUp() override { model_.add_units(GridWork::kCellStep, 1); }
  KindTotals finish() { return model_.finish().totals[static_cast<std::size_t>(GridWork::kCellStep)]; }
};

TEST_F(PipeModelTest, ChainWaitsForEachResult) {
  const Node a = model_.emit(OpClass::kFloat, 1);
  const Node b = model_.emit(OpClass::kFloat, 2, a);
  (void)model_.emit(OpClass::kFixed, 3, b);
  const KindTotals totals = finish();
  EXPECT_EQ(totals.cycles(), 1 + 6 + 6);  // issued in cycles 1, 7 and 13
  EXPECT_EQ(totals.pairs, 0u);
}

TEST_F(PipeModelTest, ResultIsWaitedForBehindItsSuperblockToo) {
  const Node a = model_.emit(OpClass::kFloat, 1);
  model_.branch(kSite, true, 0);
  (void)model_.emit(OpClass::kFixed, 2, a);
  EXPECT_EQ(finish().cycles(), 1 + 6);  // the branch leaves with the float, in cycle 1
}

TEST_F(PipeModelTest, EvenAndOddPair) {
  for (std::uint64_t i = 0; i < 5; ++i) {
    (void)model_.emit(OpClass::kFloat, i);
    (void)model_.emit(OpClass::kLoad, i);
  }
  const KindTotals totals = finish();
  EXPECT_EQ(totals.cycles(), 5);
  EXPECT_EQ(totals.single_issue_cycles(), 10);
  EXPECT_EQ(totals.resource_cycles(), 5);
}

TEST_F(PipeModelTest, TwoOfAPipeDoNotPair) {
  (void)model_.emit(OpClass::kFloat, 1);
  (void)model_.emit(OpClass::kFixed, 2);
  EXPECT_EQ(finish().cycles(), 2);
}

TEST_F(PipeModelTest, DoubleHoldsEverything) {
  (void)model_.emit(OpClass::kDouble, 1);
  (void)model_.emit(OpClass::kDouble, 2);
  (void)model_.emit(OpClass::kLoad, 3);
  EXPECT_EQ(finish().cycles(), 7 + 7);  // the load goes with one of them
}

TEST_F(PipeModelTest, LongestChainGoesFirst) {
  (void)model_.emit(OpClass::kFixed, 1);
  (void)model_.emit(OpClass::kFixed, 2);
  const Node a = model_.emit(OpClass::kFloat, 3);
  (void)model_.emit(OpClass::kFixed, 4, a);
  EXPECT_EQ(finish().cycles(), 7);  // the chain in cycles 1 and 7, the others between
}

TEST_F(PipeModelTest, BranchWaitsForItsConditionAndUnusualOneMisses) {
  const Node condition = model_.emit(OpClass::kFloat, 1);
  model_.branch(kSite, true, condition);
  EXPECT_EQ(finish().cycles(), 7);
  const Node again = model_.emit(OpClass::kFixed, 1);
  model_.branch(kSite, true, again);
  model_.branch(kSite, false, 0);
  const KindTotals totals = finish();
  EXPECT_EQ(totals.cycles(), 7 + 3 + 1 + kBranchMissCycles);
  EXPECT_EQ(totals.misses, 1u);
}

TEST(PipeModel, SuperblockMovesWorkAboveUsualBranchesButNoStores) {
  for (const bool stores : {false, true}) {
    Branches branches = taken_branch();
    PipeModel model(&branches, {.superblock_branches = 4});
    model.add_units(GridWork::kCellStep, 1);
    const Node condition = model.emit(OpClass::kFloat, 1);
    model.branch(kSite, true, condition);
    for (std::uint64_t i = 0; i < 5; ++i) (void)model.emit(stores ? OpClass::kStore : OpClass::kFixed, i);
    const Totals totals = model.finish().totals;
    EXPECT_EQ(totals[static_cast<std::size_t>(GridWork::kCellStep)].cycles(), stores ? 7 + 5 : 7);
  }
}

// The refill delays what comes next, unless that is a command or a wait, which have no price.
TEST(PipeModel, MissIsChargedToTheWorkBehindIt) {
  const Branches branches = taken_branch();
  const auto misses_of = [&](WorkId next) {
    PipeModel model(&branches);
    model.add_units(GridWork::kCellStep, 1);
    model.branch(kSite, false, 0);
    model.add_units(next, 1);
    (void)model.emit(OpClass::kFixed, 1);
    const Totals totals = model.finish().totals;
    return std::pair(totals[WorkId(GridWork::kCellStep).number()].misses, totals[next.number()].misses);
  };
  EXPECT_EQ(misses_of(GridWork::kCellVisit), std::pair(std::uint64_t{0}, std::uint64_t{1}));
  EXPECT_EQ(misses_of(Work::kWait), std::pair(std::uint64_t{1}, std::uint64_t{0}));
}

// A unit without operations of its own takes the miss before it, or its successor would.
TEST(PipeModel, MissIsChargedToAUnitThatIsOnlyABranch) {
  const Branches branches = taken_branch();
  PipeModel model(&branches);
  model.add_units(GridWork::kCellStep, 1);
  model.branch(kSite, false, 0);
  model.add_units(GridWork::kCellVisit, 1);
  model.add_units(GridWork::kMacroRow, 1);
  (void)model.emit(OpClass::kFixed, 1);
  const Totals totals = model.finish().totals;
  EXPECT_EQ(totals[WorkId(GridWork::kCellVisit).number()].misses, 1u);
  EXPECT_EQ(totals[WorkId(GridWork::kMacroRow).number()].misses, 0u);
}

double cycles_under(const PipeRules& rules, const auto& run) {
  const Branches branches = taken_branch();
  PipeModel model(&branches, rules);
  model.add_units(GridWork::kCellStep, 1);
  run(model);
  return model.finish().totals[WorkId(GridWork::kCellStep).number()].cycles();
}

TEST(PipeModel, HintStandsElevenCyclesBeforeATakenBranch) {
  const auto branch = [](PipeModel& model) { model.branch(kSite, true, 0); };
  EXPECT_EQ(cycles_under({}, branch), 1);
  EXPECT_EQ(cycles_under({.has_hints = true}, branch), 1 + 11);
  // One that is usually not taken needs none.
  const auto other = [](PipeModel& model) { model.branch(kSite + 1, false, 0); };
  EXPECT_EQ(cycles_under({.has_hints = true}, other), 1);
}

TEST(PipeModel, ProductOfOneSumIsPartOfIt) {
  const auto sum = [](PipeModel& model) {
    const Node a = model.emit(OpClass::kLoad, 1), b = model.emit(OpClass::kLoad, 2);
    (void)model.emit(OpClass::kFloat, 4, model.emit_product(3, a, b), a);
  };
  EXPECT_EQ(cycles_under({}, sum), 1 + 1 + 6 + 6);
  EXPECT_EQ(cycles_under({.fuses = true}, sum), 1 + 1 + 6);
  const auto two_sums = [](PipeModel& model) {
    const Node product = model.emit_product(1, 0, 0);
    (void)model.emit(OpClass::kFloat, 2, product);
    (void)model.emit(OpClass::kFloat, 3, product);
  };
  EXPECT_EQ(cycles_under({.fuses = true}, two_sums), cycles_under({}, two_sums));
}

TEST(PipeModel, ValuesBeyondTheRegistersAreSpilled) {
  const auto run = [](std::uint32_t values) {
    return [values](PipeModel& model) {
      std::vector<Node> nodes;
      Node sum = 0;
      for (std::uint32_t i = 0; i + 1 < values; ++i) {
        nodes.push_back(model.emit(OpClass::kFixed, i));
        sum = model.emit(OpClass::kFixed, i, sum, nodes.back());
      }
      // All are needed again, with what they come to.
      for (const Node node : nodes) (void)model.emit(OpClass::kShuffle, node, node, sum);
    };
  };
  EXPECT_EQ(cycles_under({.has_spills = true}, run(kRegisters)), cycles_under({}, run(kRegisters)));
  EXPECT_EQ(cycles_under({.has_spills = true}, run(kRegisters + 3)), cycles_under({}, run(kRegisters + 3)) + 2 * 3);
}

TEST_F(PipeModelTest, MemoryIsLoadedOnceAndForgotten) {
  alignas(16) static float words[8];
  static float constant;
  model_.set_store(words, sizeof(words));
  EXPECT_EQ(model_.scalar_at(&constant, 0), 0u);
  const Node first = model_.scalar_at(words, 0);
  EXPECT_EQ(model_.scalar_at(words, 0), first);
  EXPECT_NE(model_.scalar_at(words + 1, 0), first) << "a scalar beside the first word is moved";
  model_.forget(words, sizeof(words));
  EXPECT_NE(model_.scalar_at(words, 0), first);
  for (std::uint32_t i = 0; i <= kRegisterBlocks; ++i) model_.branch(kSite, true, 0);
  const Node again = model_.scalar_at(words, 0);
  EXPECT_NE(again, first) << "registers hold a value for a few blocks only";
  const KindTotals totals = finish();
  EXPECT_EQ(totals.operations[static_cast<std::size_t>(OpClass::kLoad)], 3u);
  EXPECT_EQ(totals.operations[static_cast<std::size_t>(OpClass::kShuffle)], 1u);
}

}  // namespace
}  // namespace gridiron::calibrate
