// The general core's model against schedules by hand, and the decoder against instructions by hand.
// SPDX-License-Identifier: Apache-2.0
#include <general_core/core_model.h>
#include <general_core/riscv_decoder.h>

#include "support/test_headers.h"

namespace gridiron::general_core {
namespace {

constexpr std::uint64_t kLine = 128;

class CoreModelTest : public testing::Test {
 protected:
  /// @returns cycles from the one that left before.
  Cycle run(const Instruction& instruction, const Event& event = {}) {
    const Cycle before = model_->now();
    model_->execute(instruction, event);
    return model_->now() - before;
  }
  /// A load whose result is used at once. @returns what the user waits.
  Cycle load(std::uint64_t address) {
    run({Kind::kLoad, 1, {}}, {address, 8});
    return run({Kind::kFixed, 2, {1}});
  }
  /// Lets everything that is on its way arrive.
  void rest() {
    for (int i = 0; i < 100; ++i) {
      run({Kind::kFixedDivide, 3, {3}});
      run({Kind::kFixed, 3, {3}});
    }
  }

  std::unique_ptr<CoreModel> model_ = std::make_unique<CoreModel>();
};

TEST_F(CoreModelTest, TwoLeaveTogetherOnDifferentUnits) {
  rest();
  run({Kind::kFixed, 1, {}});
  const Cycle start = model_->now();
  EXPECT_EQ(run({Kind::kFloat, 40, {}}), 0u);
  EXPECT_EQ(run({Kind::kBranch, 0, {}}), 1u) << "three do not";
  EXPECT_EQ(run({Kind::kFixed, 1, {}}), 0u);
  EXPECT_EQ(run({Kind::kFixed, 2, {}}), 1u) << "two of one unit do not";
  EXPECT_EQ(model_->now(), start + 2);
}

TEST_F(CoreModelTest, ResultsAreWaitedFor) {
  rest();
  run({Kind::kFixed, 1, {}});
  EXPECT_EQ(run({Kind::kFixed, 2, {1}}), kFixedCycles);
  run({Kind::kFloat, 40, {}});
  EXPECT_EQ(run({Kind::kFloat, 41, {40}}), kFloatCycles);
  EXPECT_EQ(run({Kind::kConvert, 4, {41}}), kFloatCycles);
  EXPECT_EQ(run({Kind::kFixed, 5, {4}}), kStoreToLoadCycles + kFloatCycles);
}

TEST_F(CoreModelTest, VectorsShareTheUnitOfFloats) {
  rest();
  run({Kind::kVector, 70, {}});
  EXPECT_EQ(run({Kind::kVector, 71, {70}}), kVectorCycles);
  run({Kind::kVector, 72, {}});
  EXPECT_EQ(run({Kind::kFloat, 40, {}}), 1u);
}

TEST_F(CoreModelTest, DivisionHoldsItsUnitAlone) {
  rest();
  run({Kind::kDivide, 40, {}});
  EXPECT_LE(run({Kind::kFixed, 1, {}}), 1u);
  EXPECT_GE(run({Kind::kFloat, 41, {}}), kDivideCycles - 1);
}

TEST_F(CoreModelTest, WideningIsFree) {
  rest();
  run({Kind::kFloat, 40, {}});
  EXPECT_EQ(run({Kind::kWiden, 41, {40}}), 0u);
  EXPECT_EQ(run({Kind::kFloat, 42, {41}}), kFloatCycles);
}

TEST_F(CoreModelTest, CachesAnswerInTheirTimes) {
  constexpr std::uint64_t kPlace = 1000 * kLine;
  EXPECT_EQ(load(kPlace), kMemoryCycles + kSecondCacheCycles);
  EXPECT_EQ(load(kPlace + 8), kLoadCycles);
  // Four other lines of its set push it out of the first cache, not out of the second.
  constexpr std::uint64_t kSets = kFirstCacheLines / kFirstCacheWays;
  for (std::uint64_t i = 1; i <= kFirstCacheWays; ++i) load(kPlace + i * kSets * kLine);
  EXPECT_EQ(load(kPlace), kSecondCacheCycles);
}

TEST_F(CoreModelTest, LoadsGoOnBehindAMiss) {
  for (std::uint64_t i = 0; i < 4; ++i) {
    EXPECT_LE(run({Kind::kLoad, static_cast<std::uint8_t>(10 + i), {}}, {i * 1000 * kLine, 8}), 1u);
  }
  EXPECT_GT(run({Kind::kFixed, 1, {10}}), kMemoryCycles);
  EXPECT_LT(run({Kind::kFixed, 1, {13}}), 5u) << "they were under way together";
}

TEST_F(CoreModelTest, StreamsCostALineEachEightOfTheLatency) {
  constexpr std::uint64_t kLines = 400;
  const auto sweep = [&](std::uint64_t stride) {
    model_ = std::make_unique<CoreModel>();
    for (std::uint64_t i = 0; i < kLines; ++i) load(i * stride);
    return static_cast<double>(model_->now()) / kLines;
  };
  EXPECT_NEAR(sweep(kLine), static_cast<double>(kMemoryCycles) / kFetches, 10);
  EXPECT_GT(model_->counts().lines_streamed, kLines * 9 / 10);
  EXPECT_NEAR(sweep(37 * kLine), kMemoryCycles + kSecondCacheCycles, 1) << "no line follows another";
  EXPECT_EQ(model_->counts().lines_streamed, 0u);
  EXPECT_EQ(model_->counts().lines_waited, kLines);
}

TEST_F(CoreModelTest, StoresWaitOnlyInAFullQueue) {
  const Instruction store{Kind::kStore, 0, {}};
  Cycle cycles = 0;
  for (std::uint64_t i = 0; i < kStoreQueue; ++i) cycles += run(store, {i * 37 * kLine, 8});
  EXPECT_LE(cycles, kStoreQueue);
  EXPECT_GT(run(store, {1000 * kLine, 8}), kMemoryCycles / 2);
}

TEST_F(CoreModelTest, LoadOfWhatWasJustStoredWaits) {
  load(0);
  rest();
  run({Kind::kStore, 0, {}}, {16, 8});
  EXPECT_GE(load(20), kStoreToLoadCycles - 1);
  rest();
  run({Kind::kStore, 0, {}}, {16, 8});
  EXPECT_LE(load(24), kLoadCycles + 1) << "other bytes";
}

TEST_F(CoreModelTest, BranchesAreLearned) {
  const Instruction branch{Kind::kBranch, 0, {}, 0x1000};
  for (int i = 0; i < 40; ++i) run(branch, {.taken = true});
  const std::uint64_t misses = model_->counts().branch_misses;
  EXPECT_EQ(run(branch, {.taken = true}), 1u);
  EXPECT_EQ(model_->counts().branch_misses, misses);
  EXPECT_EQ(run(branch, {.taken = false}), 1 + kBranchMissCycles);
  EXPECT_EQ(model_->counts().branch_misses, misses + 1);
}

TEST_F(CoreModelTest, CyclesOfStepsAddUpToTheClock) {
  for (std::uint64_t i = 0; i < 50; ++i) load(i * 5 * kLine);
  EXPECT_EQ(model_->counts().cycles, model_->now());
  EXPECT_EQ(model_->counts().instructions, 100u);
}

void expect_decoded(std::uint32_t code, Kind kind, std::uint8_t result, std::array<std::uint8_t, 3> operands) {
  const Instruction got = decode(code, 64);
  EXPECT_EQ(got.kind, kind) << std::hex << code;
  EXPECT_EQ(got.result, result) << std::hex << code;
  EXPECT_EQ(got.operands, operands) << std::hex << code;
  EXPECT_EQ(got.address, 64u);
}

TEST(RiscvDecoder, LongInstructions) {
  expect_decoded(0x00C58533, Kind::kFixed, 10, {11, 12, 0});         // add a0, a1, a2
  expect_decoded(0x02C58533, Kind::kWideMultiply, 10, {11, 12, 0});  // mul
  expect_decoded(0x02C5853B, Kind::kMultiply, 10, {11, 12, 0});      // mulw
  expect_decoded(0x02C5D533, Kind::kFixedDivide, 10, {11, 12, 0});   // divu
  expect_decoded(0x0085B503, Kind::kLoad, 10, {11, 0, 0});           // ld a0, 8(a1)
  expect_decoded(0x00A5B423, Kind::kStore, 0, {11, 10, 0});          // sd a0, 8(a1)
  expect_decoded(0x0005A507, Kind::kLoad, 42, {11, 0, 0});           // flw fa0, 0(a1)
  expect_decoded(0x02C5F553, Kind::kFloat, 42, {43, 44, 0});         // fadd.d fa0, fa1, fa2
  expect_decoded(0x1AC5F553, Kind::kDivide, 42, {43, 44, 0});        // fdiv.d
  expect_decoded(0x42058553, Kind::kWiden, 42, {43, 0, 0});          // fcvt.d.s fa0, fa1
  expect_decoded(0xC2059553, Kind::kConvert, 10, {43, 0, 0});        // fcvt.w.d a0, fa1, rtz
  expect_decoded(0xE0058553, Kind::kThroughMemory, 10, {43, 0, 0});  // fmv.x.w a0, fa1
  expect_decoded(0xA2C59553, Kind::kFloat, 10, {43, 44, 0});         // flt.d a0, fa1, fa2
  expect_decoded(0x00B50463, Kind::kBranch, 0, {10, 11, 0});         // beq a0, a1
  expect_decoded(0x00008067, Kind::kJump, 0, {1, 0, 0});             // ret
  expect_decoded(0x00050067, Kind::kFarJump, 0, {10, 0, 0});         // jr a0
}

TEST(RiscvDecoder, ShortInstructions) {
  expect_decoded(0x852E, Kind::kFixed, 10, {0, 11, 0});   // c.mv a0, a1
  expect_decoded(0x952E, Kind::kFixed, 10, {10, 11, 0});  // c.add a0, a1
  expect_decoded(0x6588, Kind::kLoad, 10, {11, 0, 0});    // c.ld a0, 8(a1)
  expect_decoded(0xE588, Kind::kStore, 0, {11, 10, 0});   // c.sd a0, 8(a1)
  expect_decoded(0x8082, Kind::kJump, 0, {1, 0, 0});      // c.jr ra
  expect_decoded(0xC501, Kind::kBranch, 0, {10, 0, 0});   // c.beqz a0
}

TEST(RiscvDecoder, VectorsHaveRegistersOfTheirOwn) {
  expect_decoded(0x02946457, Kind::kVector, 72, {0, 73, 0});         // vadd-like: vand.vx v8, v9, s0
  expect_decoded(0x02941457, Kind::kFloat, 72, {72, 73, 0});         // vfadd.vv v8, v9, v8
  expect_decoded(0x82941457, Kind::kDivide, 72, {72, 73, 0});        // vfdiv.vv
  expect_decoded(0x0205E407, Kind::kLoad, 72, {11, 0, 0});           // vle32.v v8, (a1)
  expect_decoded(0x0205E427, Kind::kStore, 0, {11, 72, 0});          // vse32.v v8, (a1)
  expect_decoded(0x42802557, Kind::kThroughMemory, 10, {72, 0, 0});  // vmv.x.s a0, v8
  expect_decoded(0x42055457, Kind::kThroughMemory, 72, {42, 0, 0});  // vfmv.s.f v8, fa0
  expect_decoded(0x5E054457, Kind::kThroughMemory, 72, {10, 0, 0});  // vmv.v.x v8, a0
  expect_decoded(0xCD027057, Kind::kWiden, 0, {0, 0, 0});            // vsetivli: lanes are what they are
}

TEST(RiscvDecoder, MarksAreInstructionsThatDoNothing) {
  EXPECT_EQ(mark_of(0x02013 | 130u << 20), 130u);
  EXPECT_EQ(mark_of(0x02093 | 130u << 20), std::nullopt) << "slti ra, zero, 130";
}

}  // namespace
}  // namespace gridiron::general_core
