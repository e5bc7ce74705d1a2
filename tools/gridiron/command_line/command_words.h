// Command words: what is said where the words of a command line do not fit the commands and options that there are.
// Memory: std::string. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace CLI {
class App;
}

namespace gridiron::tool {

/// @returns the program in a few lines: what most people want of it, the other commands, where to read on.
[[nodiscard]] std::string overview(const CLI::App& app);

/// @returns every option of a command, or all commands of the program.
[[nodiscard]] std::string help_of(const CLI::App& app, const CLI::App& command);

/// @returns the command of that name. Errors: Failure (kUsage) with the commands that there are and the nearest one.
[[nodiscard]] const CLI::App& command_of(const CLI::App& app, const std::string& name);

/// Errors: as command_of(), where the first word is no option and no command.
void require_command(const CLI::App& app, const std::string& first);

/// Throws Failure (kUsage) for words that could not be parsed: an option that the command does not have, with the
/// nearest ones and the commands that have it; an argument too many; else what the parser said.
///
/// @param words  of the command line, without the program's name. @param reason  the parser's.
[[noreturn]] void explain_mistake(const CLI::App& app, std::span<const char* const> words, const std::string& reason);

}  // namespace gridiron::tool
