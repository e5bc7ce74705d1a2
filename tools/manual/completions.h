// Completions: scripts that let a shell complete commands, options, choices, names of machines and names of files.
// Memory: std::string. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "command_facts.h"

namespace gridiron::tool {

// `program` is gridiron, or another program that has its commands. The functions in the scripts are the same for all.

/// @returns a script for bash 4.3 and later, with or without the package bash-completion.
[[nodiscard]] std::string bash_completion(const ProgramFacts& facts, const std::string& program);

/// @returns a function for zsh, to be installed by the program's name with _ before it.
[[nodiscard]] std::string zsh_completion(const ProgramFacts& facts, const std::string& program);

/// @returns a script for fish 3 and later.
[[nodiscard]] std::string fish_completion(const ProgramFacts& facts, const std::string& program);

/// @returns what an option is for, in a few words: the first part of its help, or its choices where that explains them.
[[nodiscard]] std::string short_help(const OptionFacts& option);

/// @returns the words with `separator` between two.
[[nodiscard]] std::string joined(const std::vector<std::string>& words, const std::string& separator);

}  // namespace gridiron::tool
