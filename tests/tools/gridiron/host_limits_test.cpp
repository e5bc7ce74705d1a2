// The program on a host that has too few threads or too little memory. SPDX-License-Identifier: Apache-2.0
#include <sys/resource.h>

#include "run_program.h"
#include "support/sanitizers.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

/// While one lives, programs that are started get a lower limit.
class LowerLimit {
 public:
  LowerLimit(decltype(RLIMIT_AS) resource, rlim_t value) : resource_(resource) {
    EXPECT_EQ(::getrlimit(resource_, &usual_), 0);
    const rlimit lower = {std::min(value, usual_.rlim_max), usual_.rlim_max};
    EXPECT_EQ(::setrlimit(resource_, &lower), 0);
  }
  ~LowerLimit() { EXPECT_EQ(::setrlimit(resource_, &usual_), 0); }
  LowerLimit(const LowerLimit&) = delete;
  LowerLimit& operator=(const LowerLimit&) = delete;

 private:
  decltype(RLIMIT_AS) resource_;
  rlimit usual_{};
};

// A stack as large as the address space: no thread can be started.
constexpr rlim_t kHugeStackBytes = rlim_t{1} << 47;

TEST(HostLimits, AHostWithoutThreadsRendersTheSamePicture) {
  const TemporaryFolder folder("a.ply", make_sphere(8, 12, 1.0f));
  for (const char* mode : {"checked", "plain"}) {
    const Words render = {"render", "a.ply", "--size", "64x64", "--mode", mode, "--threads"};
    run(folder, render + Words{"1", "-o", "one.png"});
    const LowerLimit limit(RLIMIT_STACK, kHugeStackBytes);
    const ProgramResult result = run(folder, render + Words{"3", "-o", "three.png"});
    EXPECT_EQ(read_file(folder.path("one.png")), read_file(folder.path("three.png")));
  }
}

TEST(HostLimits, AMachineMayHaveMoreMemoryThanTheHost) {
  const TemporaryFolder folder("a.ply", make_sphere(8, 12, 1.0f));
  folder.write("large.machine", "based_on cell-ps3\nmain_memory_bytes 1099511627776\n");
  const Words scene = {"render", "a.ply", "--size", "64x64", "-o"};
  run(folder, scene + Words{"a.png"});
  const ProgramResult result = run(folder, scene + Words{"b.png", "--machine", "large.machine"});
  EXPECT_EQ(read_file(folder.path("a.png")), read_file(folder.path("b.png")));
}

#if !defined(GRIDIRON_TEST_SANITIZED)  // these take terabytes of addresses themselves
TEST(HostLimits, WhateverMemoryThereIsAFrameEndsWellOrSaysWhatIsShort) {
  const TemporaryFolder folder("a.ply", make_sphere(8, 12, 1.0f));
  bool has_failed = false, has_ended_well = false;
  for (rlim_t megabytes = 320; megabytes >= 24; megabytes = megabytes * 4 / 5) {
    const LowerLimit limit(RLIMIT_AS, megabytes << 20);
    const ProgramResult result = run_program(
        folder.folder(), {"render", "a.ply", "--size", "1024x1024", "-o", "a.png", "--threads", "3", "--quiet"});
    constexpr int kNotLoaded = 127;
    if (result.exit_code == kNotLoaded) break;  // the program itself does not fit
    SCOPED_TRACE(std::to_string(megabytes) + " MB: exit code " + std::to_string(result.exit_code) + ", " + result.err);
    if (result.exit_code == 0) {
      has_ended_well = true;
      std::filesystem::remove(folder.path("a.png"));
    } else {
      has_failed = true;
      EXPECT_EQ(result.exit_code, 1);
      EXPECT_NE(result.err.find("not enough memory"), std::string::npos);
      EXPECT_NE(result.err.find("a.ply"), std::string::npos) << "which file, is said";
    }
    EXPECT_EQ(folder.names(), Words{"a.ply"});
  }
  EXPECT_TRUE(has_failed);
  EXPECT_TRUE(has_ended_well);
}

TEST(HostLimits, NoMoreThreadsThanTilesAreStarted) {
  const TemporaryFolder folder("a.ply", make_sphere(8, 12, 1.0f));
  for (const char* mode : {"checked", "plain"}) {
    // Addresses for some threads' stacks, but not for all the requested ones.
    const LowerLimit limit(RLIMIT_AS, rlim_t{700} << 20);
    const ProgramResult result = run_program(
        folder.folder(), {"render", "a.ply", "--size", "128x128", "--mode", mode, "-o", "a.png", "--threads", "256"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find(" on 4 threads"), std::string::npos) << result.out;
  }
}
#endif

}  // namespace
}  // namespace gridiron::test
