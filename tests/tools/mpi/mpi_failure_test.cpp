// A rank that fails ends the job with one message, and leaves no file behind. SPDX-License-Identifier: Apache-2.0
#include "mpi_run.h"

namespace gridiron::test {
namespace {

class MpiFailure : public MpiFull {
 protected:
  // mpirun adds words of its own, on standard error too.
  void expect_failure_of(const std::string& line, int exit_code, const std::string& words) {
    SCOPED_TRACE(line);
    const Words before = folder_.names();
    const ProgramResult result = run_shell(folder_.folder(), line);
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_EQ(result.out, "");
    const std::size_t place = result.err.find(words);
    ASSERT_NE(place, std::string::npos) << result.err << "\nlacks: " << words;
    EXPECT_EQ(result.err.find(words, place + 1), std::string::npos) << "said more than once: " << result.err;
    EXPECT_EQ(folder_.names(), before) << "a file was left behind or lost";
  }

  const TemporaryFolder folder_{"a.ply", make_sphere(8, 10, 1.0f)};
};

TEST_F(MpiFailure, OfAllRanksIsSaidOnce) {
  expect_failure_of(ranks_line(3) + " render no.ply -o a.png", 1, "no.ply: ");
  expect_failure_of(ranks_line(3) + " render a.ply --size 5", 2, "WxH");
  expect_failure_of(ranks_line(3) + " animate no.ply -o out", 1, "no.ply: ");
}

TEST_F(MpiFailure, OfADiskIsSaidOnce) {
  expect_failure_of(ranks_line(3) + " render a.ply --size 40x40 -o /dev/full", 1, "cannot write: No space left");
}

// Rank 1 alone reads the second frame. The first may be complete by then.
TEST_F(MpiFailure, OfOneRankNamesIt) {
  folder_.write("b.ply", "ply\nformat ascii 1.0\nelement vertex x\n");
  const ProgramResult result = run_ranks(
      folder_, 3, {"animate", "a.ply", "b.ply", "-o", "out", "--size", "40x40", "--eye", "0,0,5", "--at", "0,0,0"});
  EXPECT_EQ(result.exit_code, 1);
  const std::size_t place = result.err.find("rank 1 on ");
  ASSERT_NE(place, std::string::npos) << result.err;
  EXPECT_NE(result.err.find(": b.ply:3: ", place), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("b.ply", result.err.find("b.ply") + 1), std::string::npos) << "said twice: " << result.err;
  for (const std::string& name : folder_.names()) EXPECT_FALSE(name.starts_with(".gridiron.")) << name;
}

TEST_F(MpiFailure, OfRanksThatAreNotAlike) {
  const std::string arguments = " render a.ply --size 16x16 -o a.png";
  expect_failure_of(ranks_line(1) + arguments + " : " + other_line(2) + arguments, 2,
                    "runs version 0.0.9 of this program");
  const std::string front = ranks_line(1);
  const std::string second = front.substr(front.find("-n 1"));
  expect_failure_of(front + arguments + " : " + second + " render a.ply --size 8x8 -o a.png", 2,
                    "was given other arguments than rank 0 on ");
}

// As by srun without pmix: each process would render everything.
TEST_F(MpiFailure, OfALauncherOfAnotherMpi) {
  const std::string line = ranks_line(1), program = line.substr(line.rfind(" '"));
  for (const char* name : {"PMI_SIZE", "SLURM_STEP_NUM_TASKS"}) {
    const std::string start = std::string("env -u OMPI_COMM_WORLD_SIZE ") + name + "=3 " + program;
    expect_failure_of(start + " render a.ply --size 16x16 -o a.png", 2, std::string("started 3 processes (") + name);
  }
}

TEST_F(MpiFailure, OfAStreamThatRanksCannotShare) {
  expect_failure_of(ranks_line(2) + " animate - -o out < a.ply", 2,
                    "each process reads the frames that it renders, so they must be files");
}

}  // namespace
}  // namespace gridiron::test
