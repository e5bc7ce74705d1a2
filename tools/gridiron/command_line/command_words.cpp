// Command words. SPDX-License-Identifier: Apache-2.0
#include "command_words.h"

#include <gridiron/version.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "base/failure.h"
#include "base/suggestion.h"

namespace gridiron::tool {
namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<std::string> names_of(const std::vector<const CLI::App*>& commands) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands) names.push_back(command->get_name());
  return names;
}

// "render, animate or pack"
std::string listed(const std::vector<std::string>& words, const char* last) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i != 0) list += i + 1 == words.size() ? std::string(" ") + last + " " : ", ";
    list += words[i];
  }
  return list;
}

const CLI::App* find_command(const CLI::App& app, const std::string& name) {
  for (const CLI::App* command : commands_of(app)) {
    if (command->get_name() == name) return command;
  }
  return nullptr;
}

// All names of its options, with their dashes: "--output" and "-o".
std::vector<std::string> options_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

std::string names_of_positionals(const CLI::App& app) {
  std::string names;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) names += (names.empty() ? "" : " ") + option->get_name(true);
  }
  return names.empty() ? "no arguments" : names;
}

// "-o (--output)", "--size", "INPUT"
std::string name_of(const CLI::Option& option) {
  if (option.get_positional()) return option.get_name(true);
  if (option.get_lnames().empty()) return "-" + option.get_snames().front();
  const std::string name = "--" + option.get_lnames().front();
  return option.get_snames().empty() ? name : "-" + option.get_snames().front() + " (" + name + ")";
}

// The words of a command: the first unknown option, the first repeated option with a value, and words that are neither
// options nor values.
struct CommandWords {
  std::optional<std::string> unknown;
  const CLI::Option* repeated = nullptr;
  std::vector<std::string> positionals;
};

bool is_option(std::string_view word) {
  constexpr std::string_view kNumber = "0123456789.,";
  return word.size() > 1 && word[0] == '-' && kNumber.find(word[1]) == std::string_view::npos;
}

CommandWords sort_words(const CLI::App& command, std::span<const char* const> words) {
  CommandWords sorted;
  std::set<const CLI::Option*> given;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string word = words[i];
    if (word == "--") {
      sorted.positionals.insert(sorted.positionals.end(), words.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                words.end());
      break;
    }
    if (!is_option(word)) {
      sorted.positionals.push_back(word);
      continue;
    }
    const bool is_long = word[1] == '-';
    const std::string name = is_long ? word.substr(0, word.find('=')) : word.substr(0, 2);
    const CLI::Option* option = command.get_option_no_throw(name);
    if (option == nullptr) {
      if (!sorted.unknown) sorted.unknown = is_long ? name : word;
      continue;
    }
    const bool has_value = option->get_items_expected_max() > 0;
    if (has_value && !given.insert(option).second && sorted.repeated == nullptr) sorted.repeated = option;
    if (has_value && name == word) ++i;
  }
  return sorted;
}

[[noreturn]] void unknown_option(const CLI::App& app, const CLI::App& command, const std::string& name) {
  const bool is_program = &command == &app;
  std::string message = name + " is not an option of " + command.get_name();
  std::vector<std::string> owners;
  for (const CLI::App* each : commands_of(app)) {
    if (each->get_option_no_throw(name) != nullptr) owners.push_back(each->get_name());
  }
  if (owners.empty()) {
    message += did_you_mean(name, options_of(command));
  } else if (is_program) {
    message += "; put it after a command: " + listed(owners, "or") + (owners.size() == 1 ? " has it" : " have it");
  } else {
    message += "; " + listed(owners, "and") + (owners.size() == 1 ? " has it" : " have it");
  }
  usage_error(message + "\nrun 'gridiron" + (is_program ? "" : " help " + command.get_name()) +
              (is_program ? " help" : "") + "' for the options");
}

}  // namespace

std::string overview(const CLI::App& app) {
  std::vector<std::string> others;
  for (const std::string& name : names_of(commands_of(app))) {
    if (name != "render" && name != "info" && name != "machines" && name != "help") others.push_back(name);
  }
  return std::string("gridiron ") + kVersion + ": " + app.get_description() +
         "\n\n"
         "  gridiron render scene.ply -o picture.png   a picture, and what the frame costs on the chip\n"
         "  gridiron info scene.ply                    what a scene holds and what it needs\n"
         "  gridiron machines                          the chips that can be simulated\n"
         "\n"
         "other commands: " +
         listed(others, "and") +
         "\n"
         "gridiron help                              what each command is for\n"
         "gridiron help COMMAND                      every option of a command\n";
}

std::string help_of(const CLI::App& app, const CLI::App& command) {
  // Not CLI::App::help(), which explains the command that was parsed instead.
  const std::string name = app.get_name() + (&command == &app ? "" : " " + command.get_name());
  return command.get_formatter()->make_help(&command, name, CLI::AppFormatMode::Normal);
}

const CLI::App& command_of(const CLI::App& app, const std::string& name) {
  if (const CLI::App* command = find_command(app, name)) return *command;
  const std::vector<std::string> names = names_of(commands_of(app));
  const std::string near = did_you_mean(name, names);
  std::error_code ignored;
  if (near.empty() && std::filesystem::exists(name, ignored)) {
    usage_error("'" + name + "' is a file, not a command; to render it: gridiron render " + name);
  }
  usage_error("'" + name + "' is not a command" + near + "\nexpected " + listed(names, "or"));
}

void require_command(const CLI::App& app, const std::string& first) {
  if (first.empty() || first.front() != '-') (void)command_of(app, first);
}

void explain_mistake(const CLI::App& app, std::span<const char* const> words, const std::string& reason) {
  const bool is_program = words.empty() || words.front()[0] == '-';
  const CLI::App& command = is_program ? app : command_of(app, words.front());
  const CommandWords sorted = sort_words(command, is_program ? words : words.subspan(1));
  if (sorted.unknown) unknown_option(app, command, *sorted.unknown);
  const std::string more = "\nrun 'gridiron help" + (is_program ? "" : " " + command.get_name()) + "' for the options";
  if (sorted.repeated != nullptr) usage_error(name_of(*sorted.repeated) + " is given twice" + more);
  std::size_t most = 0;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) most += static_cast<std::size_t>(option->get_items_expected_max());
  }
  if (!is_program && sorted.positionals.size() > most) {
    usage_error("'" + sorted.positionals[most] + "' is an argument too many; " + command.get_name() + " takes " +
                names_of_positionals(command));
  }
  for (const CLI::Option* option : command.get_options()) {
    if (reason != option->get_name() + " is required") continue;
    const std::string name = name_of(*option);
    const std::string value = option->get_positional() ? "" : " " + option->get_type_name();
    usage_error(name.substr(0, name.find(' ')) + value + " is required" + more);  // -o FILE, --base ADDRESS, RESULT
  }
  usage_error(reason + more);
}

}  // namespace gridiron::tool
