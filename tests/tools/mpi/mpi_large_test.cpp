// Large pictures, many frames and machines by 1, 2 and 4 ranks, and messages of more bytes than an int counts.
// Of the ctest label `full`. SPDX-License-Identifier: Apache-2.0
#include "mpi_run.h"

namespace gridiron::test {
namespace {

class MpiLarge : public MpiFull {
 protected:
  static Words rank_lines() { return {ranks_line(1), ranks_line(2), ranks_line(4), two_nodes_line(4)}; }
  const TemporaryFolder folder_{"a.ply", make_torus(240, 150, 1.0f, 0.4f)};
};

TEST_F(MpiLarge, APictureOfSixtySevenMillionPixels) {
  expect_same_files(folder_, {"render", "a.ply", "--size", "8192x8192", "--machine", "cell-ps3-2gb", "-o", "OUT/a.png",
                              "--report", "OUT/r.json"}, rank_lines());
}

TEST_F(MpiLarge, FortyEightFrames) {
  expect_same_files(folder_, {"animate", "a.ply", "-o", "OUT", "--turntable", "48", "--size", "256x256"}, rank_lines());
}

TEST_F(MpiLarge, MessagesOfMoreThanTwoGigabytes) {
  const ProgramResult result = run_shell(folder_.folder(), large_messages_line());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "exchanged\n");
}

}  // namespace
}  // namespace gridiron::test
