// gridiron_calibrate as a program: what it refuses before it counts. SPDX-License-Identifier: Apache-2.0
#include <chrono>

#include "../gridiron/run_program.h"
#include "../gridiron/temporary_folder.h"

namespace gridiron::test {
namespace {

// Counting takes seconds: a program that is still running then has begun it.
constexpr std::chrono::milliseconds kBeforeItCounts{1000};

TEST(CalibrateProgram, ATableThatCannotBeWrittenIsToldFirst) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path("folder"));
  const struct {
    const char* target;
    const char* words;
  } cases[] = {
      {"no/such/work_costs.h", "no/such/work_costs.h: cannot write: folder no/such does not exist\n"},
      {"folder", "folder: cannot write: it is a folder\n"},
  };
  for (const auto& mistake : cases) {
    for (const bool of_bvh : {false, true}) {
      std::vector<std::string> arguments = {mistake.target};
      if (of_bvh) arguments.insert(arguments.begin(), "--bvh");
      RunningProgram program(folder.folder(), arguments);
      const ProgramResult result = program.wait(kBeforeItCounts);
      EXPECT_EQ(result.exit_code, 1) << mistake.target;
      EXPECT_EQ(result.err, mistake.words);
      EXPECT_EQ(folder.names(), std::vector<std::string>{"folder"});
    }
  }
}

}  // namespace
}  // namespace gridiron::test
