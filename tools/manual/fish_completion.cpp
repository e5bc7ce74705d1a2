// Completion for fish. SPDX-License-Identifier: Apache-2.0
#include "completions.h"

namespace gridiron::tool {
namespace {

constexpr const char* kOpening =
    R"FISH( for fish, written by tools/manual from the options of the program.
# SPDX-License-Identifier: Apache-2.0

# Whether the command of the line is this one; without one: whether there is none yet.
function __gridiron_command_is
    set -l words (commandline -opc)
    if test (count $argv) -eq 0
        test (count $words) -eq 1
    else
        test (count $words) -ge 2; and test $words[2] = $argv[1]
    end
end

# Files whose names end in one of the endings, and folders; all files where there are none.
function __gridiron_files
    set -l token (string replace -r '^--[^=]*=' '' -- (commandline -ct))
    set -l names (complete -C "'' $token" | string replace -r '\t.*' '')
    set -l ending '\.(?:'(string join '|' $argv)')$'
    if string match -qri -- $ending $names
        string match -rie -- "$ending|/\$" $names
    else
        string join \n $names
    end
end

)FISH";

// Within single quotes fish knows \' and \\ alone.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c;
  }
  return out + "'";
}

// " -a 'x y'" for words, files and folders.
std::string values_of(const Offer& offer) {
  std::string values = joined(offer.words, " ");
  const auto add = [&values](const std::string& value) { values += (values.empty() ? "" : " ") + value; };
  if (!offer.endings.empty()) {
    add("(__gridiron_files " + joined(offer.endings, " ") + ")");
  } else if (offer.has_files) {
    add("(__fish_complete_path (commandline -ct))");
  } else if (offer.has_folders) {
    add("(__fish_complete_directories (commandline -ct))");
  }
  return values.empty() ? "" : " -a " + quoted(values);
}

std::string condition_of(const CommandFacts& command) {
  return command.name.empty() ? "__gridiron_command_is" : quoted("__gridiron_command_is " + command.name);
}

std::string rows_of(const CommandFacts& command, const std::string& program) {
  const std::string start = "complete -c " + program + " -n " + condition_of(command);
  std::string rows;
  for (const OptionFacts& argument : command.arguments) {
    rows += start + values_of(argument.offer) + " -d " + quoted(short_help(argument)) + "\n";
  }
  for (const OptionFacts& option : command.options) {
    rows += start;
    for (const std::string& name : option.names) {
      rows += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    }
    if (option.takes_value) rows += " -x" + values_of(option.offer);
    rows += " -d " + quoted(short_help(option)) + "\n";
  }
  return rows;
}

}  // namespace

std::string fish_completion(const ProgramFacts& facts, const std::string& program) {
  const std::string start = "complete -c " + program;
  std::string script = "# Completion of " + program + kOpening + start + " -f\n" + rows_of(facts.program, program);
  for (const CommandFacts& command : facts.commands) {
    script += start + " -n __gridiron_command_is -a " + command.name + " -d " + quoted(command.help) + "\n";
  }
  for (const CommandFacts& command : facts.commands) script += rows_of(command, program);
  return script;
}

}  // namespace gridiron::tool
