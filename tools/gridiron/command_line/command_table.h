// CommandTable: all commands with their options, as the parser, the help, the man pages and the shells' completions
// read them. Memory: owns what is parsed into. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

#include "options.h"

namespace gridiron::tool {

struct CommandTable {
  CommandTable();
  CommandTable(const CommandTable&) = delete;  // options refer to its members
  CommandTable& operator=(const CommandTable&) = delete;

  CLI::App app;                                ///< the program; its subcommands are the commands
  std::map<const CLI::App*, Finish> finishes;  ///< of all commands but help
  CLI::App* help = nullptr;                    ///< the command of that name
  std::string topic;                           ///< of help; empty: none
};

}  // namespace gridiron::tool
