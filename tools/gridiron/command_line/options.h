// Options: converts words of the command line to values; options that several commands share.
// Memory: what they are added to outlives the parser. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arguments.h"
#include "base/suggestion.h"
#include "offer.h"

namespace gridiron::tool {

/// Completes a parsed command: its request, checked. Errors: Failure.
using Finish = std::function<Command()>;

/// A request while its words are parsed.
template <class Request>
struct Asked {
  Request request;
  std::string machine;  ///< name or file; empty: none
};

/// Adds an option whose text one of our own parsers converts; `expected` completes the error message, which suggests
/// similar words from `words`, which shells offer too. Capitals in these make no difference.
template <class Target, class Parser>
CLI::Option* add_parsed(CLI::App& app, const std::string& name, Target& target, Parser parser,
                        const std::string& expected, const std::string& type, const std::string& help,
                        const std::vector<std::string>& words = {}) {
  const auto set = [&target, parser, name, expected, words](const std::string& text) {
    auto value = parser(text);
    if (!value) {
      if (const auto word = word_in_capitals(text, words)) value = parser(*word);
    }
    if (!value) throw CLI::ValidationError(name, "'" + text + "' is not " + expected + did_you_mean(text, words));
    target = *value;
  };
  CLI::Option* option = app.add_option_function<std::string>(name, set, help)->type_name(type)->expected(1);
  if (!words.empty()) set_offer(*option, {.words = words, .endings = {}});
  return option;
}

/// Words and their values, in the order of the help.
template <class Value>
using Choices = std::vector<std::pair<std::string, Value>>;

/// Adds an option that takes one word of a list.
template <class Target, class Value>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Target& target, const Choices<Value>& choices,
                        const std::string& help) {
  std::string list;
  std::vector<std::string> words;
  for (const auto& [word, value] : choices) {
    list += (list.empty() ? "" : "|") + word;
    words.push_back(word);
  }
  const auto find = [choices](const std::string& text) -> std::optional<Value> {
    const auto found = std::ranges::find(choices, text, &Choices<Value>::value_type::first);
    return found == choices.end() ? std::nullopt : std::optional<Value>(found->second);
  };
  return add_parsed(app, name, target, find, "one of " + list, list, help, words);
}

/// Adds an option that takes a whole number, one from least to most.
template <class Target>
void add_count(CLI::App& app, const std::string& name, Target& target, std::uint32_t least, std::uint32_t most,
               const std::string& help) {
  const auto parse = [least, most](const std::string& text) {
    const std::optional<std::uint32_t> count = parse_count(text);
    return count && *count >= least && *count <= most ? count : std::nullopt;
  };
  add_parsed(app, name, target, parse, "a whole number from " + std::to_string(least) + " to " + std::to_string(most),
             "N", help);
}

[[nodiscard]] std::optional<std::filesystem::path> parse_path(const std::string& text);

/// Endings of files that shells offer first, without the dot.
using Endings = std::vector<std::string>;
inline const Endings kPictureEndings = {"png", "pfm"};
inline const Endings kSceneEndings = {"ply", "nff", "gri", "obj", "stl", "gltf", "glb"};

/// Adds an option that takes the name of an output.
template <class Target>
CLI::Option* add_output(CLI::App& app, const std::string& name, Target& target, const Endings& endings,
                        const std::string& help) {
  CLI::Option* option = add_parsed(app, name, target, parse_path, "a file name", "FILE", help);
  offer_files(*option, endings);
  return option;
}

/// Adds the required option -o for a folder.
void add_output_folder(CLI::App& app, std::filesystem::path& target, const std::string& help);

/// Adds an argument that names an input: `-` is standard input.
void add_input_file(CLI::App& app, const std::string& name, std::filesystem::path& target, const Endings& endings,
                    const std::string& help);

/// Adds an option that names an input: `-` is standard input.
void add_input_option(CLI::App& app, const std::string& name, std::optional<std::filesystem::path>& target,
                      const Endings& endings, const std::string& help);

/// Every command has it, so that scripts can pass it to any of them.
void add_quiet(CLI::App& app, bool& quiet);
void add_size(CLI::App& app, std::optional<CountPair>& size, const std::string& help);
void add_input(CLI::App& app, SceneRequest& scene);
void add_tolerance(CLI::App& app, SceneRequest& scene);
void add_model_options(CLI::App& app, SceneRequest& scene);
void add_grid_options(CLI::App& app, SceneRequest& scene, std::string& machine);
void add_threads(CLI::App& app, std::optional<std::uint32_t>& threads, const std::string& effect);
void add_store(CLI::App& app, std::optional<sim::StoreSize>& store);
void add_packet(CLI::App& app, std::optional<std::uint32_t>& packet_width);

/// @returns the accuracies as words, and in `help` a description of each.
[[nodiscard]] Choices<Accuracy> accuracy_choices(std::string& help);

template <class Target>
void add_accuracy(CLI::App& app, Target& target) {
  std::string help;
  const Choices<Accuracy> choices = accuracy_choices(help);
  add_choice(app, "--accuracy", target, choices, help);
}

/// A file of the command line and its option.
struct NamedFile {
  const char* option;
  std::optional<std::filesystem::path> path;
};

/// The file of a machine; nothing for a built-in one.
[[nodiscard]] NamedFile machine_file(const std::string& name, const char* option = "--machine");

/// Errors: Failure (kUsage) if two inputs are one stream, since each would take bytes from the other.
void require_own_streams(const std::vector<NamedFile>& inputs);

/// Finds the machine of a scene whose only other input may be a camera. Errors: those of require_own_streams() and
/// find_machine().
void complete_scene(SceneRequest& scene, const std::string& machine,
                    const std::optional<std::filesystem::path>& camera = std::nullopt);

/// Adds the options of a view.
void add_view_options(CLI::App& app, std::optional<std::filesystem::path>& camera, ViewRequest& view);

/// Adds the options of a mesh's look.
void add_look_options(CLI::App& app, LookRequest& look);

// Each adds the options of a command that renders, and returns the function that completes its request.
[[nodiscard]] Finish add_render(CLI::App& app);
[[nodiscard]] Finish add_animate(CLI::App& app);
[[nodiscard]] Finish add_job(CLI::App& app);

}  // namespace gridiron::tool
