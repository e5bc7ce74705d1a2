// CommandFacts: commands and options of the program as its man pages and completions need them, read from the tables of
// the command line itself. Memory: std::string. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gridiron/command_line/offer.h"

namespace gridiron::tool {

/// An option, or an argument, which is known by its place.
struct OptionFacts {
  std::vector<std::string> names;  ///< "-o", "--output": short ones first; of an argument its only name
  std::string type;                ///< of its value, as the help prints it: "FILE", "single|double"; may be empty
  std::string help;
  bool takes_value = false;
  bool is_required = false;
  bool takes_many = false;  ///< any number of values
  Offer offer;

  [[nodiscard]] bool is_argument() const { return names.front().front() != '-'; }
};

struct CommandFacts {
  std::string name;  ///< of the program's own: empty
  std::string help;
  std::string footer;
  std::vector<OptionFacts> arguments;  ///< in their order
  std::vector<OptionFacts> options;
};

struct ProgramFacts {
  std::string version;
  CommandFacts program;  ///< its own options
  std::vector<CommandFacts> commands;
};

[[nodiscard]] ProgramFacts program_facts();

}  // namespace gridiron::tool
