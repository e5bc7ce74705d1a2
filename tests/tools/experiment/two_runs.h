// Two runs of an experiment, on one thread and on three, and the files that both must leave.
// Memory: strings. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../gridiron/run_program.h"

namespace gridiron::test {

[[nodiscard]] std::set<std::string> names_in(const std::filesystem::path& folder);

/// Runs the program into the folders out1 and out3, which must succeed and print nothing.
/// @param words  of the command line, for an output and a number of threads.
void run_twice(const TemporaryFolder& folder,
               const std::function<Words(std::string output, std::string threads)>& words);

/// Checks that both folders hold the same files, but for what is the host's; that their names were known beforehand,
/// tables have rows and plots are well formed; and that the page names every file and nothing else.
/// @returns the names.
std::set<std::string> expect_same_files(const TemporaryFolder& folder, const std::vector<std::string>& known);

}  // namespace gridiron::test
