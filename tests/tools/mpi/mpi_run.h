// Runs gridiron_mpi under mpirun.
// Memory: strings. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "../gridiron/run_program.h"

namespace gridiron::test {

/// Skips a test where there is no MPI, or mpirun starts nothing.
class Mpi : public ::testing::Test {
 protected:
  void SetUp() override;
};

/// Of the label `full`: ranks that end too early, after which mpirun itself may hang.
class MpiFull : public Mpi {
 protected:
  void SetUp() override;
};

/// @returns the part of a command line before the arguments: mpirun, so many ranks, the program.
[[nodiscard]] std::string ranks_line(int ranks);
/// @returns the same with the program of another version, after " : ".
[[nodiscard]] std::string other_line(int ranks);
/// @returns as ranks_line(), with a program that takes every two ranks for a node.
[[nodiscard]] std::string two_nodes_line(int ranks);
/// @returns the line that runs large_messages by two ranks.
[[nodiscard]] std::string large_messages_line();

/// Runs so many ranks to the end.
ProgramResult run_ranks(const TemporaryFolder& folder, int ranks, const Words& arguments);

/// @returns the files of a folder by name, hidden ones too.
[[nodiscard]] std::map<std::string, std::string> files_of(const std::filesystem::path& folder);

/// Runs a command by one process into folder `alone` and by others into `ranks`, where the word OUT of the arguments
/// is the folder's name, and compares all files. @param lines  that start the ranks, one run after another.
void expect_same_files(const TemporaryFolder& folder, const Words& arguments,
                       const Words& lines = {ranks_line(3)});

}  // namespace gridiron::test
