// The program as one function, for its mains. Its source also prepares signals and standard descriptors before main.
// Memory: its own. Threads: one; commands start more. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/failure.h"

namespace gridiron::tool {

struct ProgramEnd {
  ExitCode code = ExitCode::kDone;
  std::string words;  ///< for standard error, how a failed command ended; empty: it did not fail
};

/// @returns how a failed command ended, with what became of its files.
[[nodiscard]] ProgramEnd end_of(const Failure& failure);

/// Parses and runs one command. Precondition: a CommandFiles exists until the words are printed. Of another rank than 0
/// only its part in commands that ranks share.
[[nodiscard]] ProgramEnd run_program(int count, const char* const* values);

}  // namespace gridiron::tool
