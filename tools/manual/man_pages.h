// Man pages: the program, each of its commands, and gridiron_mpi, as roff with the macros of man(7).
// Memory: std::string. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "command_facts.h"

namespace gridiron::tool {

/// @returns the page of the program: its commands, exit codes and examples.
[[nodiscard]] std::string program_page(const ProgramFacts& facts);

/// @returns the page of gridiron_mpi: how it is started and what differs from gridiron.
[[nodiscard]] std::string mpi_page(const ProgramFacts& facts);

/// @returns the page of a command: every argument and option.
[[nodiscard]] std::string command_page(const ProgramFacts& facts, const CommandFacts& command);

/// @returns the name of a command's page, which man finds by two words too: "gridiron-render".
[[nodiscard]] std::string page_name(const CommandFacts& command);

}  // namespace gridiron::tool
