// Completion for zsh. SPDX-License-Identifier: Apache-2.0
#include "completions.h"

namespace gridiron::tool {
namespace {

constexpr const char* kOpening = R"ZSH( for zsh, written by tools/manual from the options of the program.
# SPDX-License-Identifier: Apache-2.0

# Offers words, and files whose names end in one of the endings; '/': folders.
_gridiron_offer() {
  local words=$1 endings=$2 found=1 suffix=()
  if [[ $words == *= ]]; then suffix=(-S ''); fi  # what follows belongs to the word
  if [[ -n $words ]]; then compadd "${suffix[@]}" -- ${=words} && found=0; fi
  case $endings in
    '') ;;
    /) _files -/ && found=0 ;;
    '*') _files && found=0 ;;
    # (-.): files, and links to them. Without it a group of one ending would be read as qualifiers.
    *) _files -g "*.($endings)(-.)" && found=0 ;;
  esac
  return found
}

)ZSH";

// Text within single quotes and within a specification of _arguments, where brackets and colons have a meaning.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
    } else {
      if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
      out += c;
    }
  }
  return out;
}

// ":FILE: _gridiron_offer "" "png|pfm"", of which the blank keeps _arguments from adding words of its own.
std::string action_of(const OptionFacts& option) {
  const std::string& value = option.type.empty() || option.is_argument() ? option.names.front() : option.type;
  const Offer& offer = option.offer;
  std::string endings = joined(offer.endings, "|");
  if (endings.empty() && offer.has_files) endings = "*";
  if (endings.empty() && offer.has_folders) endings = "/";
  std::string action = ":" + escaped(value) + ":";
  if (!offer.words.empty() || !endings.empty()) {
    action += " _gridiron_offer \"" + joined(offer.words, " ") + "\" \"" + endings + "\"";
  }
  return action;
}

// "'(-o --output)'{-o+,--output=}'[picture]:FILE: ...'"
std::string option_row(const OptionFacts& option, const std::string& indent) {
  std::string row = indent + "'(" + joined(option.names, " ") + ")'";
  std::string names;
  for (const std::string& name : option.names) {
    const bool is_long = name.starts_with("--");
    names += (names.empty() ? "" : ",") + name + (!option.takes_value ? "" : is_long ? "=" : "+");
  }
  row += option.names.size() > 1 ? "{" + names + "}" : "'" + names + "'";
  return row + "'[" + escaped(short_help(option)) + "]" + (option.takes_value ? action_of(option) : "") + "'";
}

std::string command_row(const CommandFacts& command) {
  std::string rows;
  const std::string indent = "            ";
  for (const OptionFacts& option : command.options) rows += " \\\n" + option_row(option, indent);
  std::size_t place = 0;
  for (const OptionFacts& argument : command.arguments) {
    rows += " \\\n" + indent + "'" + (argument.takes_many ? "*" : std::to_string(++place)) + action_of(argument) + "'";
  }
  return "        " + command.name + ")\n          _arguments -S" + rows + " && ret=0\n          ;;\n";
}

}  // namespace

std::string zsh_completion(const ProgramFacts& facts, const std::string& program) {
  std::string script = "#compdef " + program + "\n# Completion of " + program + kOpening +
                       "_gridiron() {\n  local curcontext=$curcontext state line ret=1\n" +
                       "  typeset -A opt_args\n  local -a commands=(\n";
  for (const CommandFacts& command : facts.commands) {
    script += "    '" + command.name + ":" + escaped(command.help) + "'\n";
  }
  script += "  )\n  _arguments -C";
  for (const OptionFacts& option : facts.program.options) script += " \\\n" + option_row(option, "    ");
  script +=
      " \\\n    '1:command:->command' '*::argument:->argument' && ret=0\n"
      "  case $state in\n    command) _describe -t commands command commands && ret=0 ;;\n    argument)\n"
      "      curcontext=${curcontext%:*}-$words[1]:\n      case $words[1] in\n";
  for (const CommandFacts& command : facts.commands) script += command_row(command);
  return script + "      esac\n      ;;\n  esac\n  return ret\n}\n\n_gridiron \"$@\"\n";
}

}  // namespace gridiron::tool
