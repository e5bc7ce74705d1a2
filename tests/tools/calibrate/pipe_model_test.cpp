// The pipeline model against schedules by hand. SPDX-License-Identifier: Apache-2.0
#include <gridiron/engine/grid/grid_work.h>
#include <gtest/gtest.h>
#include <pipe_model.h>

namespace gridiron::calibrate {
namespace {

constexpr Site kSite = 1;

// One usual branch, taken.
Branches taken_branch() {
  Branches branches;
  branches[kSite].by_kind[0][1] = 1;
  return branches;
}

class PipeModelTest : public testing::Test {
 protected:
  Branches branches_ = taken_branch();
  PipeModel model_{&branches_, 1};

  void SetUp() override { model_.add_units(GridWork::kCellStep, 1); }
  KindTotals finish() { return model_.finish()[static_cast<std::size_t>(GridWork::kCellStep)]; }
};

TEST_F(PipeModelTest, ChainWaitsForEachResult) {
  const Node a = model_.emit(OpClass::kFloat, 1);
  const Node b = model_.emit(OpClass::kFloat, 2, a);
  (void)model_.emit(OpClass::kFixed, 3, b);
  const KindTotals totals = finish();
  EXPECT_EQ(totals.cycles(), 1 + 6 + 6);  // issued in cycles 1, 7 and 13
  EXPECT_EQ(totals.pairs, 0u);
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
    PipeModel model(&branches, 4);
    model.add_units(GridWork::kCellStep, 1);
    const Node condition = model.emit(OpClass::kFloat, 1);
    model.branch(kSite, true, condition);
    for (std::uint64_t i = 0; i < 5; ++i) (void)model.emit(stores ? OpClass::kStore : OpClass::kFixed, i);
    const Totals totals = model.finish();
    EXPECT_EQ(totals[static_cast<std::size_t>(GridWork::kCellStep)].cycles(), stores ? 7 + 5 : 7);
  }
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
