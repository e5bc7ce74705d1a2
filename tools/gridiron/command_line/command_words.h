// Command words: messages for command lines that do not fit the commands and options.
// Memory: std::string. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace CLI {
class App;
}

namespace gridiron::tool {

/// @returns the program in a few lines: the common commands, the others, where to read on.
[[nodiscard]] std::string overview(const CLI::App& app);

/// @returns every option of a command, or all commands of the program.
[[nodiscard]] std::string help_of(const CLI::App& app, const CLI::App& command);

/// @returns the command of that name. Errors: Failure (kUsage) with all commands and the nearest one.
[[nodiscard]] const CLI::App& command_of(const CLI::App& app, const std::string& name);

/// Errors: as command_of(), if the first word is neither an option nor a command.
void require_command(const CLI::App& app, const std::string& first);

/// Throws Failure (kUsage) for words that could not be parsed: an unknown option, with the nearest ones and the
/// commands that have it; an argument too many; else the parser's message.
///
/// @param words  of the command line, without the program's name. @param reason  the parser's.
[[noreturn]] void explain_mistake(const CLI::App& app, std::span<const char* const> words, const std::string& reason);

}  // namespace gridiron::tool
