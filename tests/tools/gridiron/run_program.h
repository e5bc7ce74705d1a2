// Runs the gridiron program as a process of its own.
// Memory: strings. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>

#include "temporary_folder.h"

namespace gridiron::test {

using Words = std::vector<std::string>;

[[nodiscard]] Words operator+(Words words, const Words& more);

/// @returns the words with `--configuration reference`, unless they name a configuration: for tests of the grid.
[[nodiscard]] Words with_reference(Words words);

struct ProgramResult {
  int exit_code = -1;  ///< -signal where a signal ended it
  std::string out, err;
};

/// A running program, in `folder`, its output in files next to the folder.
class RunningProgram {
 public:
  RunningProgram(const std::filesystem::path& folder, const Words& arguments);
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  void send(int signal) const;
  /// Until the program catches a signal, a minute at most: before that the signal would end it.
  void wait_until_caught(int signal) const;
  /// Waits for its first child, a minute at most, and stops that (SIGSTOP). @returns its process; -1 without one.
  [[nodiscard]] pid_t stop_child() const;
  [[nodiscard]] ProgramResult wait();
  /// Waits so long at most, then kills it: exit_code is -SIGKILL.
  [[nodiscard]] ProgramResult wait(std::chrono::milliseconds most);

 private:
  pid_t process_ = -1;
  int out_ = -1, err_ = -1;
};

/// Runs a line of bash in `folder`; $GRIDIRON is the program. The exit code is the line's.
ProgramResult run_shell(const std::filesystem::path& folder, const std::string& line);

/// Runs to the end.
ProgramResult run_program(const std::filesystem::path& folder, const Words& arguments);

/// The same of a command that must succeed.
ProgramResult run(const TemporaryFolder& folder, const Words& arguments);

/// Runs a command that must end so, with these words on standard error, and leave the folder as it was.
void expect_failure(const TemporaryFolder& folder, const Words& arguments, int exit_code, const std::string& words);

}  // namespace gridiron::test
