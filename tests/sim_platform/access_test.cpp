// The instrumented build: a forbidden access of a core is reported at the access itself, in any completion mode.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/core_runner.h>

#include <new>

#include "access_programs.h"
#include "program_bench.h"

namespace gridiron::sim {
namespace {

constexpr std::uint32_t kEnvBytes = 128;  // the environment lies in front of the program's data

struct AccessCase {
  const char* name;
  access::Which which;
  const char* words;  ///< how the violation's detail begins; null where there must be none
  const char* reason;

  friend std::ostream& operator<<(std::ostream& stream, const AccessCase& c) { return stream << c.name; }
};

constexpr const char* kOutside = "outside the arena";
constexpr const char* kGet = "destination of a get";
constexpr const char* kPut = "source of a put";

const AccessCase kCases[] = {
    {"right", access::Which::kRight, nullptr, nullptr},
    {"load_before_wait", access::Which::kLoadBeforeWait, "load of 4 bytes at arena+0xbc", kGet},
    {"store_to_destination", access::Which::kStoreToDestinationBeforeWait, "store of 4 bytes at arena+0x80", kGet},
    {"store_to_source", access::Which::kStoreToSourceBeforeWait, "store of 4 bytes at arena+0x90", kPut},
    {"load_behind_data", access::Which::kLoadBehindData, "load of 4 bytes at arena+0x8000", kOutside},
    {"load_across_the_end", access::Which::kLoadAcrossTheEnd, "load of 4 bytes at arena+0x7ffe", kOutside},
    {"store_before_data", access::Which::kStoreBeforeData, "store of 4 bytes at arena-0x4", kOutside},
    {"load_from_heap", access::Which::kLoadFromHeap, "load of 4 bytes at ", kOutside},
    {"store_to_global", access::Which::kStoreToGlobal, "store of 4 bytes at ", kOutside},
    {"load_from_global", access::Which::kLoadFromGlobal, "load of 4 bytes at ", kOutside},
    {"load_from_main_memory", access::Which::kLoadFromMainMemory, "load of 4 bytes at ", kOutside},
    {"block_copy_behind_data", access::Which::kBlockCopyBehindData, "load of 128 bytes at arena+0x7fc0", kOutside},
};

/// Runs a program in tile 3 of 5, checked access by access.
ChipResult run_case(access::Which which, Completion completion, std::uint32_t threads) {
  ProgramBench bench;
  bench.shape.tile_count = 5;
  bench.options.completion = completion;
  bench.options.threads = threads;
  const std::vector<std::uint32_t> heap(16, 7);
  return bench.run([&](SimCore& core, std::span<std::byte> data) {
    // A program reads its environment from its own data.
    access::Env& env = *::new (data.data()) access::Env;
    static_assert(sizeof(access::Env) <= kEnvBytes);
    env.input = bench.input();
    env.output = bench.output();
    env.data_bytes = static_cast<std::uint32_t>(data.size()) - kEnvBytes;
    env.heap = heap.data();
    env.host_of_input = bench.memory().bytes_at(bench.input(), 64).data();
    std::memcpy(&env.same_as_input, env.host_of_input, sizeof env.same_as_input);
    for (;;) {
      const ItemClaim claim = core.claim_item();
      if (claim.kind == ItemClaim::Kind::kAborted) return Status::kAborted;
      if (claim.kind == ItemClaim::Kind::kNone) return Status::kOk;
      if (claim.item != 3) continue;
      const SimCore::AccessScope scope(core, __builtin_frame_address(0));
      GRIDIRON_TRY(access::run(which, env, core, data.data() + kEnvBytes));
    }
  });
}

class Access : public testing::TestWithParam<AccessCase> {};

TEST_P(Access, IsCaughtAtTheInstruction) {
  const AccessCase& c = GetParam();
  for (const Completion completion : {Completion::kEarly, Completion::kLate, Completion::kRandom}) {
    for (const std::uint32_t threads : {1u, 3u}) {
      SCOPED_TRACE(testing::Message() << "completion " << static_cast<int>(completion) << ", threads " << threads);
      const ChipResult result = run_case(c.which, completion, threads);
      if (c.words == nullptr) {
        EXPECT_EQ(result.status, Status::kOk) << words(result);
        EXPECT_TRUE(result.violations.empty()) << words(result);
        continue;
      }
      EXPECT_EQ(result.status, Status::kBadAccess) << words(result);
      EXPECT_EQ(result.failed_tile, 3u);
      // A late transfer may notice the same mistake again.
      ASSERT_GE(result.violations.size(), 1u) << words(result);
      EXPECT_LE(result.violations.size(), 2u) << words(result);
      const Violation& violation = result.violations[0];
      EXPECT_EQ(violation.rule, Status::kBadAccess);
      EXPECT_EQ(violation.tile_id, 3u);
      EXPECT_EQ(violation.detail.rfind(c.words, 0), 0u) << violation.detail;
      EXPECT_NE(violation.detail.find(c.reason), std::string::npos) << violation.detail;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Case, Access, testing::ValuesIn(kCases),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(AccessScope, EndsWithItsScope) {
  ProgramBench bench;
  const ChipResult result = bench.run([&](SimCore& core, std::span<std::byte>) {
    { const SimCore::AccessScope scope(core, __builtin_frame_address(0)); }
    SimCore::check_access(0, 4, true, 0);
    return Status::kOk;
  });
  EXPECT_EQ(result.status, Status::kOk) << words(result);
}

}  // namespace
}  // namespace gridiron::sim
