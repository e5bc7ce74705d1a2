// Options. SPDX-License-Identifier: Apache-2.0
#include "options.h"

#include "base/failure.h"
#include "files/input_file.h"
#include "gridiron/device/accuracies.h"

namespace gridiron::tool {
namespace {

using sim::StoreSize;

std::optional<CountPair> parse_picture_size(const std::string& text) {
  std::optional<CountPair> size = parse_count_pair(text, 'x');
  if (!size) size = parse_count_pair(text, 'X');
  const auto fits = [](std::uint32_t pixels) { return pixels >= 1 && pixels <= kMaxPictureWidth; };
  return size && fits(size->x) && fits(size->y) ? size : std::nullopt;
}

}  // namespace

std::optional<std::filesystem::path> parse_path(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional<std::filesystem::path>(text);
}

void add_output_folder(CLI::App& app, std::filesystem::path& target, const std::string& help) {
  CLI::Option* option = add_parsed(app, "-o,--output", target, parse_path, "the name of a folder", "DIR", help);
  offer_folders(*option->required());
}

void add_input_option(CLI::App& app, const std::string& name, std::optional<std::filesystem::path>& target,
                      const Endings& endings, const std::string& help) {
  const auto parse = [](const std::string& text) { return std::optional(input_path(text)); };
  offer_files(*add_parsed(app, name, target, parse, "a file name", "FILE", help), endings);
}

void add_input_file(CLI::App& app, const std::string& name, std::filesystem::path& target, const Endings& endings,
                    const std::string& help) {
  const auto parse = [](const std::string& text) {
    return text.empty() ? std::nullopt : std::optional(input_path(text));
  };
  offer_files(*add_parsed(app, name, target, parse, "a file name", "", help)->required(), endings);
}

void add_quiet(CLI::App& app, bool& quiet) {
  app.add_flag("--quiet", quiet, "print nothing but the result and errors: no notes, figures or bars");
}

void add_size(CLI::App& app, std::optional<CountPair>& size, const std::string& help) {
  add_parsed(app, "--size", size, parse_picture_size, "WxH with both from 1 to " + std::to_string(kMaxPictureWidth),
             "WxH", help);
}

void add_input(CLI::App& app, SceneRequest& scene) {
  add_input_file(app, "INPUT", scene.input, kSceneEndings,
                 "scene: a mesh (PLY, OBJ, STL, glTF and others), a text scene (NFF) or a packed scene; - is standard "
                 "input");
  add_tolerance(app, scene);
  add_model_options(app, scene);
}

void add_model_options(CLI::App& app, SceneRequest& scene) {
  constexpr std::uint32_t kMostSeconds = 86400;
  const auto megabytes = [](const std::string& text) {
    const std::optional<std::uint32_t> count = parse_count(text);
    return count && *count >= 1 ? std::optional(std::uint64_t{*count} << 20) : std::nullopt;
  };
  add_parsed(app, "--import-memory", scene.model.memory_bytes, megabytes, "a whole number above 0", "MB",
             "OBJ, STL, glTF and others: memory that reading one may take (default: half of the host's "
             "memory, at least 1024)");
  add_count(app, "--import-time", scene.model.most_seconds, 1, kMostSeconds,
            "OBJ, STL, glTF and others: seconds that reading one may take (default: 300)");
}

void add_tolerance(CLI::App& app, SceneRequest& scene) {
  const auto tolerance = [](const std::string& text) {
    const std::optional<float> value = parse_float(text);
    return value && *value > 0 ? value : std::nullopt;
  };
  add_parsed(app, "--tolerance", scene.tolerance, tolerance, "a number above 0", "NUMBER",
             "text scenes: largest distance of a facet from its sphere or cone, world units (default: 1e-4 of the "
             "scene's diagonal; where that makes more than 262144 triangles, a larger one for objects far from the "
             "eye)");
}

void add_grid_options(CLI::App& app, SceneRequest& scene, std::string& machine) {
  Choices<const Configuration*> sets;
  for (const Configuration& configuration : configurations()) sets.emplace_back(configuration.name, &configuration);
  machine = sim::machine_profiles().front().name;
  std::string built_in;
  for (const sim::MachineProfile& profile : sim::machine_profiles()) built_in += std::string(profile.name) + "|";
  const auto any_name = [](const std::string& text) { return text.empty() ? std::nullopt : std::optional(text); };
  offer_machines(*add_parsed(
      app, "--machine", machine, any_name, "a machine's name or file", built_in + "FILE",
      "machine profile, built in or a text file as 'gridiron machines NAME' prints, - for standard input (default " +
          machine + ")"));
  add_choice(
      app, "--configuration", scene.configuration, sets,
      "named set of parameters (default best; reference with --accuracy paper; grid where best cannot render, as "
      "tools/README.md lists)");
  const auto lambda = [](const std::string& text) {
    const std::optional<float> value = parse_float(text);
    return value && *value >= 1e-6f && *value <= 1e6f ? value : std::nullopt;
  };
  add_parsed(app, "--lambda", scene.lambda, lambda, "a number from 1e-6 to 1e6", "NUMBER",
             "grid cells per triangle; given, it is never reduced to fit the machine's memory; not with best");
  add_count(app, "--macro-width", scene.macro_width, 1, kMaxMacroWidth,
            "cells along a macrocell's edge; not with best");
}

void add_threads(CLI::App& app, std::optional<std::uint32_t>& threads, const std::string& effect) {
  constexpr std::uint32_t kMostThreads = 256;
  add_count(app, "--threads", threads, 1, kMostThreads, "host threads (default: the host's); " + effect);
}

void add_store(CLI::App& app, std::optional<StoreSize>& store) {
  add_choice(
      app, "--store", store,
      Choices<StoreSize>{{"16", StoreSize::k16KB},
                         {"64", StoreSize::k64KB},
                         {"128", StoreSize::k128KB},
                         {"256", StoreSize::k256KB},
                         {"512", StoreSize::k512KB}},
      "local store in KB (default: the largest that fits the machine)");
}

void add_packet(CLI::App& app, std::optional<std::uint32_t>& packet_width) {
  add_choice(app, "--packet", packet_width, Choices<std::uint32_t>{{"4", 4}, {"8", 8}, {"16", 16}, {"32", 32}},
             "rays along a packet's edge (default: the configuration's); not with best");
}

Choices<Accuracy> accuracy_choices(std::string& help) {
  Choices<Accuracy> choices;
  for (const NamedAccuracy& named : accuracies()) {
    const bool is_default = named.accuracy == Accuracy::kStandard;
    help += (help.empty() ? "" : "; ") + std::string(named.name) + (is_default ? " (default): " : ": ") +
            std::string(named.description);
    choices.emplace_back(named.name, named.accuracy);
  }
  return choices;
}

NamedFile machine_file(const std::string& name, const char* option) {
  if (name.empty() || sim::find_machine_profile(name) != nullptr) return {option, std::nullopt};
  return {option, input_path(name)};
}

void require_own_streams(const std::vector<NamedFile>& inputs) {
  for (auto one = inputs.begin(); one != inputs.end(); ++one) {
    for (auto other = one + 1; other != inputs.end(); ++other) {
      if (!one->path || !other->path || !share_a_stream(*one->path, *other->path)) continue;
      usage_error(std::string(one->option) + " and " + other->option + " both read " + one->path->string() +
                  ", which can be read only once");
    }
  }
}

void complete_scene(SceneRequest& scene, const std::string& machine,
                    const std::optional<std::filesystem::path>& camera) {
  require_own_streams({{"INPUT", scene.input}, {"--camera", camera}, machine_file(machine)});
  scene.machine = find_machine(machine);
}

}  // namespace gridiron::tool
