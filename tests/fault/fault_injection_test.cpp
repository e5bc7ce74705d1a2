// The fault-injecting decorator itself, over the simulated core.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/platform/fault_injection.h>

#include "sim_platform/program_bench.h"

namespace gridiron::sim {
namespace {

constexpr Tag kTag{1}, kOtherTag{2};

/// Gets two blocks under two tags and waits for each; what each call said.
struct Answers {
  Status start[2], wait[2];
  std::byte first_byte[2];
};

Answers run_with(const FaultPlan& plan, Completion completion = Completion::kEarly) {
  Answers answers{};
  ProgramBench bench;
  bench.options.completion = completion;
  static_cast<void>(bench.run([&](SimCore& core, std::span<std::byte> data) {
    FaultInjection<SimCore> faulty(core, plan);
    static_assert(Platform<FaultInjection<SimCore>> && WorkObserver<FaultInjection<SimCore>>);
    data[0] = data[64] = std::byte{0x11};
    answers.start[0] = faulty.get(&data[0], bench.input(64), 64, kTag);
    answers.start[1] = faulty.get(&data[64], bench.input(128), 64, kOtherTag);
    answers.wait[0] = faulty.wait(TagMask::of(kTag));
    answers.wait[1] = faulty.wait(TagMask::of(kOtherTag));
    answers.first_byte[0] = data[0];
    answers.first_byte[1] = data[64];
    return Status::kOk;
  }));
  return answers;
}

TEST(FaultInjection, WithoutAPlanNothingGoesWrong) {
  const Answers answers = run_with({});
  for (std::uint32_t i = 0; i < 2; ++i) {
    EXPECT_EQ(answers.start[i], Status::kOk);
    EXPECT_EQ(answers.wait[i], Status::kOk);
    EXPECT_EQ(answers.first_byte[i], ProgramBench::input_byte(64 + i * 64));
  }
}

TEST(FaultInjection, ARefusedTransferIsToldAtTheCallAndStartsNothing) {
  const Answers answers =
      run_with({.transfer = 2, .kind = FaultPlan::Kind::kRefuse, .status = Status::kTransferQueueFull});
  EXPECT_EQ(answers.start[0], Status::kOk);
  EXPECT_EQ(answers.start[1], Status::kTransferQueueFull);
  EXPECT_EQ(answers.wait[1], Status::kOk);
  EXPECT_EQ(answers.first_byte[1], std::byte{0x11});
}

TEST(FaultInjection, AFailedOrTimedOutTransferIsToldByTheWaitForItsTagOnly) {
  for (const Status status : {Status::kTransferFailed, Status::kTransferTimedOut}) {
    const Answers answers = run_with({.transfer = 2, .kind = FaultPlan::Kind::kReport, .status = status});
    EXPECT_EQ(answers.start[1], Status::kOk);
    EXPECT_EQ(answers.wait[0], Status::kOk);
    EXPECT_EQ(answers.wait[1], status);
    EXPECT_EQ(answers.first_byte[0], ProgramBench::input_byte(64));
    EXPECT_EQ(answers.first_byte[1], std::byte{0x11});
  }
}

TEST(FaultInjection, ADelayedTransferMovesNothingBeforeItsWait) {
  ProgramBench bench;
  const ChipResult result = bench.run([&](SimCore& core, std::span<std::byte> data) {
    FaultInjection<SimCore> faulty(core, {.transfer = 1, .kind = FaultPlan::Kind::kDelay});
    data[0] = std::byte{0x11};
    GRIDIRON_TRY(faulty.get(&data[0], bench.input(64), 64, kTag));
    EXPECT_EQ(data[0], std::byte{0x11});
    GRIDIRON_TRY(faulty.wait(TagMask::of(kOtherTag)));
    EXPECT_EQ(data[0], std::byte{0x11});
    GRIDIRON_TRY(faulty.wait(TagMask::of(kTag)));
    EXPECT_EQ(data[0], ProgramBench::input_byte(64));
    return Status::kOk;
  });
  EXPECT_EQ(result.status, Status::kOk) << words(result);
}

TEST(FaultInjection, ClaimsCanBeAnsweredWithAnEnd) {
  for (const ItemClaim::Kind kind : {ItemClaim::Kind::kAborted, ItemClaim::Kind::kDeadline}) {
    ProgramBench bench;
    bench.shape.tile_count = 5;
    const ChipResult result = bench.run([&](SimCore& core, std::span<std::byte>) {
      FaultInjection<SimCore> faulty(core, {.claim = 3, .claim_answer = kind});
      EXPECT_EQ(faulty.claim_item().kind, ItemClaim::Kind::kItem);
      EXPECT_EQ(faulty.claim_item().kind, ItemClaim::Kind::kItem);
      EXPECT_EQ(faulty.claim_item().kind, kind);
      EXPECT_EQ(faulty.claim_item().kind, kind);
      return Status::kOk;
    });
    EXPECT_EQ(result.status, Status::kOk) << words(result);
  }
}

}  // namespace
}  // namespace gridiron::sim
