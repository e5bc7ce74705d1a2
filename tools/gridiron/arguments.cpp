// Arguments. SPDX-License-Identifier: Apache-2.0
#include "arguments.h"

#include <gridiron/firmware/frame_job.h>
#include <gridiron/version.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <functional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "accuracies.h"
#include "command_words.h"
#include "failure.h"
#include "layout_choice.h"
#include "machine_keys.h"
#include "scene_input.h"
#include "store_facts.h"
#include "suggestion.h"
#include "words.h"

namespace gridiron::tool {
namespace {

using sim::Completion;
using sim::Mode;
using sim::StoreSize;

// Options as they stand on the command line, before those that depend on one another are joined.
struct RawRender {
  RenderArguments arguments;
  std::optional<std::filesystem::path> output;
  std::string machine_name;
  bool no_mailbox = false, no_culling = false, no_subpackets = false, no_empty_skip = false;
};

constexpr BufferDepths kSingleBuffering = {.output = 1, .macro = 1, .triangle = 1, .walks = 1};
constexpr BufferDepths kDoubleBuffering = {.output = 2, .macro = 2, .triangle = 2, .walks = 2};

constexpr std::string_view kMachineFormat = R"(A machine file holds one 'key value' per line; # opens a comment.
Units are in the keys: _hz, _bytes, _cycles (of the core clock; under master. of the general core's own).
'based_on NAME' as the first key takes what the file leaves out from a built-in machine:

  based_on       cell-ps3
  name           my-chip
  core_count     4
  latency_cycles 250

)";

// The format of machine files, and a line for each key.
std::string machine_format_help() {
  std::string help(kMachineFormat);
  for (const MachineKeyHelp& row : machine_key_help()) {
    help.append(row.key).append(": ").append(row.range).append("; ").append(row.meaning).append("\n");
  }
  return help + "The kinds and steps, and more of each key: tools/README.md, \"Machines\".";
}

// Adds an option whose text one of our own parsers turns into a value; `expected` completes the error message, which
// names those of `words` that the text may have been meant for.
template <class Target, class Parser>
CLI::Option* add_parsed(CLI::App& app, const std::string& name, Target& target, Parser parser,
                        const std::string& expected, const std::string& type, const std::string& help,
                        const std::vector<std::string>& words = {}) {
  const auto set = [&target, parser, name, expected, words](const std::string& text) {
    auto value = parser(text);
    if (!value) throw CLI::ValidationError(name, "'" + text + "' is not " + expected + did_you_mean(text, words));
    target = *value;
  };
  return app.add_option_function<std::string>(name, set, help)->type_name(type)->expected(1);
}

// Words and what they stand for, in the order in which people are told them.
template <class Value>
using Choices = std::vector<std::pair<std::string, Value>>;

// Adds an option that takes one word of a list.
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

// Every command has it: what runs them need not know which of them has more to say than its result.
void add_quiet(CLI::App& app, bool& quiet) {
  app.add_flag("--quiet", quiet, "print nothing but the result and errors: no notes, figures or bars");
}

std::function<std::optional<std::uint32_t>(const std::string&)> count_between(std::uint32_t least, std::uint32_t most) {
  return [least, most](const std::string& text) {
    const std::optional<std::uint32_t> count = parse_count(text);
    return count && *count >= least && *count <= most ? count : std::nullopt;
  };
}

std::optional<std::uint64_t> parse_seed(const std::string& text) {
  const bool digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  if (!digits || text.size() > 19) return std::nullopt;  // 19 digits always fit 64 bits
  return std::stoull(text);
}

std::optional<std::filesystem::path> parse_path(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional<std::filesystem::path>(text);
}

std::optional<CountPair> parse_picture_size(const std::string& text) {
  const std::optional<CountPair> size = parse_count_pair(text, 'x');
  const auto fits = [](std::uint32_t pixels) { return pixels >= 1 && pixels <= kMaxPictureWidth; };
  return size && fits(size->x) && fits(size->y) ? size : std::nullopt;
}

void add_size(CLI::App& app, std::uint32_t& width, std::uint32_t& height, const std::string& help) {
  const auto set = [&width, &height](const std::string& text) {
    const std::optional<CountPair> size = parse_picture_size(text);
    if (!size) {
      throw CLI::ValidationError("--size",
                                 "'" + text + "' is not WxH with both from 1 to " + std::to_string(kMaxPictureWidth));
    }
    width = size->x;
    height = size->y;
  };
  app.add_option_function<std::string>("--size", set, help)->type_name("WxH")->expected(1);
}

void add_input(CLI::App& app, SceneArguments& scene) {
  add_parsed(app, "INPUT", scene.input, parse_path, "a file name", "",
             "scene: a PLY mesh, a text scene (NFF) or what pack made, whatever its name; - is standard input")
      ->required();
  const auto tolerance = [](const std::string& text) {
    const std::optional<float> value = parse_float(text);
    return value && *value > 0 ? value : std::nullopt;
  };
  add_parsed(app, "--tolerance", scene.tolerance, tolerance, "a number above 0", "NUMBER",
             "text scenes: largest distance of a facet from its sphere or cone, world units (default: 1e-4 of the "
             "scene's diagonal; where that makes more than 262144 triangles, a larger one for objects far from the "
             "eye)");
}

void add_grid_options(CLI::App& app, SceneArguments& scene, std::string& machine_name) {
  Choices<const Configuration*> sets;
  for (const Configuration& configuration : configurations()) sets.emplace_back(configuration.name, &configuration);
  machine_name = sim::machine_profiles().front().name;
  scene.configuration = &configurations().front();
  std::string built_in;
  for (const sim::MachineProfile& machine : sim::machine_profiles()) built_in += std::string(machine.name) + "|";
  const auto any_name = [](const std::string& text) { return text.empty() ? std::nullopt : std::optional(text); };
  add_parsed(
      app, "--machine", machine_name, any_name, "a machine's name or file", built_in + "FILE",
      "machine profile, built in or a text file as 'gridiron machines NAME' prints, - for standard input (default " +
          machine_name + ")");
  add_choice(app, "--configuration", scene.configuration, sets,
             "named set of parameters (default " + std::string(scene.configuration->name) + ")");
  const auto lambda = [](const std::string& text) {
    const std::optional<float> value = parse_float(text);
    return value && *value >= 1e-6f && *value <= 1e6f ? value : std::nullopt;
  };
  add_parsed(app, "--lambda", scene.lambda, lambda, "a number from 1e-6 to 1e6", "NUMBER",
             "grid cells per triangle; given, it is never reduced to fit the machine's memory");
  add_parsed(app, "--macro-width", scene.macro_width, count_between(1, kMaxMacroWidth), "a whole number from 1 to 8",
             "N", "cells along a macrocell's edge");
}

const Choices<TriangleFormat> kFormats = {{"vertices", TriangleFormat::kVertices},
                                          {"projection", TriangleFormat::kProjection},
                                          {"lattice", TriangleFormat::kLattice}};

// "vertices (default): for --accuracy standard, exact; projection: ..."
std::string format_help() {
  std::string help;
  for (const auto& [name, format] : kFormats) {
    std::string readers;
    for (const NamedAccuracy& named : accuracies()) {
      if (format_of(named.accuracy) == format) readers += (readers.empty() ? " " : ", ") + std::string(named.name);
    }
    help += (help.empty() ? "" : "; ") + name + (help.empty() ? " (default)" : "") + ": for --accuracy" + readers;
  }
  return help;
}

void add_view_options(CLI::App& app, RenderArguments& render) {
  const std::string vector = "x,y,z with three finite numbers";
  add_parsed(
      app, "--camera", render.camera, [](const std::string& text) { return std::optional(input_path(text)); },
      "a file name", "FILE",
      "view from a file of its own; --eye, --at, --up and --fov replace parts of it; - is standard input");
  add_parsed(app, "--eye", render.view.eye, parse_vector, vector, "x,y,z",
             "position of the camera (default: a text scene's own, else the scene is framed)");
  add_parsed(app, "--at", render.view.at, parse_vector, vector, "x,y,z",
             "point in the middle of the picture (default: a text scene's own, else that of the framed scene)");
  add_parsed(app, "--up", render.view.up, parse_up, "x, y, z, -x, -y, -z or " + vector, "AXIS|x,y,z",
             "direction that is up (default y, or a text scene's own)", {"x", "y", "z", "-x", "-y", "-z"});
  add_parsed(app, "--from", render.view.from, parse_view_angles,
             "front, back, left, right, top, bottom, iso or AZIMUTH,ELEVATION in degrees, elevation from -90 to 90",
             "SIDE|AZIMUTH,ELEVATION",
             "side from which the scene is framed: front|back|left|right|top|bottom|iso, or degrees from the front to "
             "the right and upwards (default 30,25); replaces eye and at of --camera or of a text scene",
             {"front", "back", "left", "right", "top", "bottom", "iso"});
  const auto fov = [](const std::string& text) {
    const std::optional<float> value = parse_float(text);
    return value && fov_is_possible(*value) ? value : std::nullopt;
  };
  add_parsed(app, "--fov", render.view.fov_degrees, fov, "an angle from 0.001 to below 180 degrees", "DEG",
             "angle between the top and the bottom edge (default 45)");
}

void add_output_options(CLI::App& app, RawRender& raw) {
  RenderArguments& render = raw.arguments;
  const std::string name = "a file name";
  add_parsed(app, "-o,--output", raw.output, parse_path, name, "FILE",
             "picture, .png or .pfm (default: INPUT's name with .png, in the current folder); - is standard output, "
             "here and for every output");
  add_parsed(app, "--depth", render.depth, parse_path, name, "FILE",
             "distance of every pixel, .pfm, +inf where nothing is hit");
  add_parsed(app, "--ids", render.ids, parse_path, name, "FILE",
             "triangle of every pixel, .pfm, -1 where nothing is hit");
  add_parsed(app, "--report", render.report, parse_path, name, "FILE",
             "where cycles and bytes went, JSON; without cycles where none are counted (--mode plain, --lanes other "
             "than 4, --tile)");
  add_parsed(app, "--timeline", render.timeline, parse_path, name, "FILE",
             "what each core did when, Chrome trace format; not with --mode plain");
  add_parsed(app, "--repeat", render.repeats, count_between(1, 1000), "a whole number from 1 to 1000", "N",
             "build and render N times and print the least of the host's times (default 1)");
  add_quiet(app, render.quiet);
}

void add_threads(CLI::App& app, std::uint32_t& threads, const std::string& effect) {
  constexpr std::uint32_t kMostThreads = 256;
  add_parsed(app, "--threads", threads, count_between(1, kMostThreads), "a whole number from 1 to 256", "N",
             "host threads (default: the host's); " + effect);
}

void add_cores(CLI::App& app, std::uint32_t& cores) {
  constexpr std::uint32_t kMostCores = 1024;
  add_parsed(app, "--cores", cores, count_between(1, kMostCores), "a whole number from 1 to 1024", "N",
             "cores of the machine (default: the profile's)");
}

const Choices<StoreSize> kStores = {
    {"64", StoreSize::k64KB}, {"128", StoreSize::k128KB}, {"256", StoreSize::k256KB}, {"512", StoreSize::k512KB}};
constexpr const char* kStoreHelp = "local store in KB (default: the largest that the machine has room for)";

void add_machine_options(CLI::App& app, RawRender& raw) {
  RenderArguments& render = raw.arguments;
  add_cores(app, render.cores);
  add_threads(app, render.threads, "no result depends on it");
  add_choice(app, "--store", render.asked.store, kStores, kStoreHelp);
  add_choice(app, "--mode", render.mode,
             Choices<Mode>{{"checked", Mode::kChecked}, {"plain", Mode::kPlain}, {"instrumented", Mode::kInstrumented}},
             "checked (default): every rule checked, work traced; plain: fast, nothing but the picture; "
             "instrumented: checked, and every load and store of the kernel too");
  add_choice(
      app, "--completion", render.completion,
      Choices<Completion>{{"early", Completion::kEarly}, {"late", Completion::kLate}, {"random", Completion::kRandom}},
      "when the bytes of a transfer move (default early)");
  add_parsed(app, "--seed", render.seed, parse_seed, "a whole number of at most 19 digits", "N",
             "seed of --completion random (default 0)");
  add_choice(app, "--lanes", render.lanes, Choices<std::uint32_t>{{"4", 4}, {"8", 8}, {"16", 16}, {"32", 32}},
             "rays per SIMD group (default 4; plain: the host's widest); cycles are counted for 4 only");
  const auto tile = [](const std::string& text) { return parse_count_pair(text, ','); };
  add_parsed(app, "--tile", render.tile, tile, "X,Y with a column and a row", "X,Y",
             "render this tile alone; the picture is the tile, the frame in main memory is whole");
}

void add_packet(CLI::App& app, std::uint32_t& packet_width) {
  add_choice(app, "--packet", packet_width, Choices<std::uint32_t>{{"4", 4}, {"8", 8}, {"16", 16}, {"32", 32}},
             "rays along a packet's edge (default: the configuration's)");
}

template <class Target>
void add_accuracy(CLI::App& app, Target& target) {
  Choices<Accuracy> choices;
  std::string help;
  for (const NamedAccuracy& named : accuracies()) {
    const bool is_default = named.accuracy == Accuracy::kStandard;
    help += (help.empty() ? "" : "; ") + std::string(named.name) + (is_default ? " (default): " : ": ") +
            std::string(named.description);
    choices.emplace_back(named.name, named.accuracy);
  }
  add_choice(app, "--accuracy", target, choices, help);
}

void add_algorithm_options(CLI::App& app, RawRender& raw) {
  RenderArguments& render = raw.arguments;
  add_choice(app, "--buffering", render.asked.depths,
             Choices<BufferDepths>{{"single", kSingleBuffering}, {"double", kDoubleBuffering}},
             "buffers of all three levels (default: the configuration's)");
  add_packet(app, render.asked.packet_width);
  add_choice(app, "--tile-width", render.asked.tile_width,
             Choices<std::uint32_t>{{"8", 8}, {"16", 16}, {"32", 32}, {"64", 64}},
             "pixels along a tile's edge (default: 16 with --store 64, 8 there with --shading scene, else 32)");
  add_accuracy(app, render.accuracy);
  add_choice(app, "--shading", render.shading,
             Choices<Shading>{{"none", Shading::kNone}, {"simple", Shading::kSimple}, {"scene", Shading::kScene}},
             "none: hit or background; simple: facing ratio (default of meshes); scene: lights, materials and effects "
             "of the scene (default where it has any)");
  app.add_flag("--no-mailbox", raw.no_mailbox, "test a triangle again in every cell that holds it");
  app.add_flag("--no-culling", raw.no_culling, "do not cull triangles by the corner rays");
  app.add_flag("--no-subpackets", raw.no_subpackets, "do not cull subpackets of a packet");
  app.add_flag("--no-empty-skip", raw.no_empty_skip, "fetch the cell blocks of empty macrocells too");
}

// A file of the command line and the option that names it.
struct NamedFile {
  const char* option;
  std::optional<std::filesystem::path> path;
};

// The file of --machine, nothing where a built-in machine is named.
NamedFile machine_file(const std::string& name) {
  if (name.empty() || sim::find_machine_profile(name) != nullptr) return {"--machine", std::nullopt};
  return {"--machine", input_path(name)};
}

// What one input takes out of a pipe the other one would miss.
void require_own_streams(const std::vector<NamedFile>& inputs) {
  for (auto one = inputs.begin(); one != inputs.end(); ++one) {
    for (auto other = one + 1; other != inputs.end(); ++other) {
      if (!one->path || !other->path || !share_a_stream(*one->path, *other->path)) continue;
      usage_error(std::string(one->option) + " and " + other->option + " both read " + one->path->string() +
                  ", which can be read only once");
    }
  }
}

// The name of a picture that was not asked for.
std::filesystem::path picture_of(const std::filesystem::path& input) {
  return is_descriptor(input) ? "picture.png" : input.stem().concat(".png");
}

// Defaults that depend on other options, and combinations that make no sense.
RenderArguments complete_render(const RawRender& raw, const CLI::App& app) {
  const auto is_given = [&app](const char* name) {
    return app.get_option_no_throw(name) != nullptr && app.count(name) > 0;
  };
  RenderArguments render = raw.arguments;
  render.scene.quiet = render.quiet;
  render.has_size = is_given("--size");
  if (is_given("--from") && is_given("--eye")) usage_error("--from and --eye: both say where the eye is");
  render.has_shading = is_given("--shading");
  render.scene.input = input_path(render.scene.input);
  require_own_streams({{"INPUT", render.scene.input}, {"--camera", render.camera}, machine_file(raw.machine_name)});
  const SceneKind kind = foreseen_kind(render.scene.input);
  if (!render.has_shading && kind == SceneKind::kText) render.shading = Shading::kScene;
  if (kind != SceneKind::kUnknown) require_tolerance(render.scene.tolerance, kind);
  if (render.shading == Shading::kScene && kind == SceneKind::kMesh) {
    usage_error("--shading scene: a mesh has no lights and materials; text scenes (NFF) have");
  }
  const Configuration& configuration = *render.scene.configuration;
  render.scene.machine = find_machine(raw.machine_name);
  render.output = raw.output.value_or(picture_of(render.scene.input));
  render.techniques = configuration.techniques;
  if (raw.no_mailbox) render.techniques &= ~std::uint32_t{kUseMailbox};
  if (raw.no_culling) render.techniques &= ~std::uint32_t{kUseCornerCulling};
  if (raw.no_subpackets) render.techniques &= ~std::uint32_t{kUseSubpackets};
  if (raw.no_empty_skip) render.techniques &= ~std::uint32_t{kUseEmptySkip};

  const bool plain = render.mode == Mode::kPlain;
  if (render.lanes == 0) render.lanes = plain ? sim::widest_lanes() : 4;
  if (render.mode == Mode::kInstrumented && render.lanes != 4) usage_error("--mode instrumented: has 4 lanes only");
  if (render.mode == Mode::kInstrumented && !sim::has_instrumented_mode()) {
    usage_error("--mode instrumented: this build has no instrumented kernel");
  }
  if (render.timeline && plain) {
    usage_error("--timeline: --mode plain does not record what cores do when; --mode checked does");
  }
  if (render.timeline && render.lanes != 4) usage_error("--timeline: cycles are counted for --lanes 4 only");
  if (render.timeline && render.tile) usage_error("--timeline: cycles are not counted for one tile alone (--tile)");
  if (render.lanes > sim::widest_lanes()) {
    usage_error("--lanes: this host has at most " + std::to_string(sim::widest_lanes()) + " lanes");
  }
  if (is_given("--seed") && render.completion != Completion::kRandom) usage_error("--seed: needs --completion random");

  if (kind != SceneKind::kUnknown || render.scene.input.empty()) settle_layout(render);
  return render;
}

InfoArguments complete_info(InfoArguments info, const std::string& machine, const CLI::App& app) {
  info.has_size = app.count("--size") > 0;
  info.scene.input = input_path(info.scene.input);
  require_own_streams({{"INPUT", info.scene.input}, machine_file(machine)});
  info.scene.machine = find_machine(machine);
  const SceneKind kind = foreseen_kind(info.scene.input);
  if (kind != SceneKind::kUnknown) require_tolerance(info.scene.tolerance, kind);
  if (info.accuracy) {
    const TriangleFormat format = format_of(*info.accuracy);
    if (app.count("--format") > 0 && info.format != format) {
      usage_error("--accuracy " + std::string(accuracy_name(*info.accuracy)) + ": reads --format " + word_of(format));
    }
    info.format = format;
  }
  if (kind != SceneKind::kUnknown) settle_layout(info, kind == SceneKind::kText);
  return info;
}

void add_animate_options(CLI::App& app, AnimateArguments& animate, RawRender& raw) {
  app.add_option("FRAMES", animate.inputs,
                 "PLY meshes in the order of their frames; of a folder all .ply files, by name; - is standard input")
      ->required()
      ->type_name("");
  add_parsed(app, "-o,--output", animate.output, parse_path, "the name of a folder", "DIR",
             "folder of the pictures and animation.csv, made where it is not there")
      ->required();
  add_grid_options(app, raw.arguments.scene, raw.machine_name);
  add_size(app, raw.arguments.width, raw.arguments.height, "pictures in pixels (default 1024x1024)");
  add_view_options(app, raw.arguments);
  add_cores(app, raw.arguments.cores);
  add_threads(app, raw.arguments.threads, "no result depends on it");
  add_choice(app, "--store", raw.arguments.asked.store, kStores, kStoreHelp);
  add_algorithm_options(app, raw);
  add_quiet(app, raw.arguments.quiet);
}

AnimateArguments complete_animate(AnimateArguments animate, const RawRender& raw, const CLI::App& app) {
  if (raw.arguments.shading == Shading::kScene) {
    usage_error("--shading scene: a mesh has no lights and materials; text scenes (NFF) have");
  }
  std::vector<NamedFile> inputs = {{"--camera", raw.arguments.camera}, machine_file(raw.machine_name)};
  for (std::filesystem::path& input : animate.inputs) {
    if (input.empty()) usage_error("FRAMES: '' is not a file name");
    input = input_path(input);
    inputs.push_back({"FRAMES", input});
  }
  require_own_streams(inputs);
  animate.render = complete_render(raw, app);
  return animate;
}

void add_job_options(CLI::App& app, JobArguments& job, RawRender& raw) {
  RenderArguments& render = raw.arguments;
  add_input(app, render.scene);
  add_parsed(app, "-o,--output", raw.output, parse_path, "a file name", "FILE", "the job; - is standard output")
      ->required();
  const auto base = [](const std::string& text) {
    const std::optional<std::uint64_t> address = parse_address(text);
    return address && *address % 4096 == 0 ? address : std::nullopt;
  };
  add_parsed(app, "--base", job.base_address, base, "a multiple of 4096, decimal or after 0x", "ADDRESS",
             "where the device loads the job")
      ->required();
  add_parsed(app, "--memory", job.memory_bytes, parse_address, "a whole number", "BYTES",
             "memory of the device from there on: a job that needs more is refused");
  add_grid_options(app, render.scene, raw.machine_name);
  add_size(app, render.width, render.height, "picture in pixels (default: a text scene's own, else 1024x1024)");
  add_view_options(app, render);
  app.add_flag("--depth", render.depth_plane, "distances too");
  app.add_flag("--ids", render.ids_plane, "triangle ids too");
  add_parsed(app, "--cores", render.cores, count_between(1, port::kMostBoardCores), "a whole number from 1 to 16", "N",
             "cores of the device that there is memory for rays that wait for (default: the profile's)");
  add_choice(app, "--store", render.asked.store, kStores, kStoreHelp);
  add_algorithm_options(app, raw);
  add_quiet(app, render.quiet);
}

JobArguments complete_job(JobArguments job, const RawRender& raw, const CLI::App& app) {
  job.render = complete_render(raw, app);
  RenderArguments& render = job.render;
  if (render.cores == 0) render.cores = render.scene.machine->core_count;
  if (render.cores > port::kMostBoardCores) {
    usage_error("--cores: a job is for " + std::to_string(port::kMostBoardCores) + " cores at most; " +
                std::string(render.scene.machine->name) + " has " + std::to_string(render.cores));
  }
  render.threads = render.cores;  // as many of the frame's slices of memory
  return job;
}

void add_result_options(CLI::App& app, ResultArguments& result, std::string& machine) {
  const std::string name = "a file name";
  add_parsed(app, "JOB", result.job, parse_path, name, "",
             "what the device was given, made by job; - is standard input")
      ->required();
  add_parsed(app, "RESULT", result.result, parse_path, name, "",
             "what it wrote: the bytes from result_address on; - is standard input")
      ->required();
  add_parsed(app, "-o,--output", result.output, parse_path, name, "FILE",
             "picture, .png or .pfm; - is standard output, here and for every output");
  add_parsed(app, "--depth", result.depth, parse_path, name, "FILE",
             "distance of every pixel, .pfm, +inf where nothing is hit; of a job with distances");
  add_parsed(app, "--ids", result.ids, parse_path, name, "FILE",
             "triangle of every pixel, .pfm, -1 where nothing is hit; of a job with ids");
  add_parsed(app, "--report", result.report, parse_path, name, "FILE", "hashes, work and tiles of each core, JSON");
  app.add_flag("--compare", result.compare,
               "render the job on the simulated chip and compare planes, work and transfers; exit code 3 where they "
               "differ; all outputs are written even then");
  app.add_option("--predict", machine,
                 "with --compare: compare what each tile takes on this machine with the instructions that the device "
                 "counted")
      ->type_name("MACHINE");
  add_threads(app, result.threads, "of --compare; no result depends on it");
  add_quiet(app, result.quiet);
}

ResultArguments complete_result(ResultArguments result, const std::string& machine) {
  result.job = input_path(result.job);
  result.result = input_path(result.result);
  require_own_streams({{"JOB", result.job}, {"RESULT", result.result}, {"--predict", machine_file(machine).path}});
  if (!machine.empty()) {
    if (!result.compare) usage_error("--predict needs --compare");
    result.predict = find_machine(machine);
  }
  return result;
}

void add_experiment_options(CLI::App& app, ExperimentArguments& experiment) {
  add_choice(app, "NAME", experiment.name,
             Choices<ExperimentName>{{"paper", ExperimentName::kPaper},
                                     {"accuracy", ExperimentName::kAccuracy},
                                     {"effects", ExperimentName::kEffects}},
             "paper: Tables 1-4, Figs. 5-7 and sweeps; some eight minutes of processor time with the scans. accuracy: "
             "what each accuracy profile costs and what is wrong with its answers; some two minutes. effects: what "
             "each effect costs, and that one that is off costs nothing; some half a minute, no scans. All leave CSV, "
             "SVG and index.html; without a terminal nothing is printed before the end")
      ->required();
  add_parsed(app, "-o,--output", experiment.output, parse_path, "the name of a folder", "DIR",
             "folder, made where it is not there")
      ->required();
  app.add_option("--scenes", experiment.scenes,
                 "folder of the scans (default: the environment's GRIDIRON_SCENES); scans that are not there are left "
                 "out, and without any a teapot and a torus knot are made; effects makes its own scenes")
      ->type_name("DIR");
  add_threads(app, experiment.threads, "no file but host_*.csv, which measures this host, depends on it");
  add_size(app, experiment.width, experiment.height,
           "pictures in pixels (default 1024x1024; effects: 96x96, at least 16x16)");
  add_parsed(app, "--largest", experiment.largest_knot, count_between(6'000, 10'000'000),
             "a whole number from 6000 to 10000000", "N",
             "paper: triangles of the largest mesh of Table 1 (default 1000000)");
  add_quiet(app, experiment.quiet);
}

ExperimentArguments complete_experiment(ExperimentArguments experiment, const CLI::App& app) {
  if (app.count("--largest") > 0 && experiment.name != ExperimentName::kPaper) {
    usage_error("--largest: is of experiment paper alone");
  }
  if (experiment.name == ExperimentName::kEffects) {
    if (app.count("--scenes") > 0) usage_error("--scenes: experiment effects makes its own");
    if (app.count("--size") == 0) experiment.width = experiment.height = 96;
    constexpr std::uint32_t kLeastSize = 16;  // smaller ones have too few waits for the experiment's own checks
    if (std::min(experiment.width, experiment.height) < kLeastSize) {
      usage_error("--size: experiment effects needs pictures of at least 16x16 pixels");
    }
    return experiment;
  }
  if (experiment.scenes.empty()) {
    const char* scenes = std::getenv("GRIDIRON_SCENES");
    if (scenes != nullptr) experiment.scenes = scenes;
  }
  return experiment;
}

}  // namespace

Command parse_arguments(int count, const char* const* values) {
  CLI::App app("ray traces on a simulated chip whose cores have a small local store and move data by DMA.", "gridiron");
  app.set_version_flag("--version", std::string("gridiron ") + kVersion);
  app.require_subcommand(1);

  RawRender raw;
  CLI::App* render = app.add_subcommand("render", "renders a scene and tells what the frame costs on the chip");
  add_input(*render, raw.arguments.scene);
  add_grid_options(*render, raw.arguments.scene, raw.machine_name);
  add_output_options(*render, raw);
  add_size(*render, raw.arguments.width, raw.arguments.height,
           "picture in pixels (default: a text scene's own, else 1024x1024)");
  add_view_options(*render, raw.arguments);
  add_machine_options(*render, raw);
  add_algorithm_options(*render, raw);

  RawRender animate_raw;
  AnimateArguments animate_arguments;
  CLI::App* animate =
      app.add_subcommand("animate", "renders a mesh a frame, its grid built anew, and tells what the frames cost");
  add_animate_options(*animate, animate_arguments, animate_raw);

  InfoArguments info_arguments;
  std::string info_machine;
  CLI::App* info = app.add_subcommand("info", "tells what a scene holds and what it needs");
  add_input(*info, info_arguments.scene);
  add_grid_options(*info, info_arguments.scene, info_machine);
  add_choice(*info, "--format", info_arguments.format, kFormats, "how triangles are stored; " + format_help());
  add_size(*info, info_arguments.width, info_arguments.height,
           "picture whose memory is counted (default: a text scene's own, else 1024x1024)");
  add_choice(*info, "--store", info_arguments.asked_store, kStores, kStoreHelp);
  add_packet(*info, info_arguments.packet_width);
  add_accuracy(*info, info_arguments.accuracy);
  info->add_flag("--depth", info_arguments.has_depth, "distances too");
  info->add_flag("--json", info_arguments.json, "as JSON");
  add_quiet(*info, info_arguments.scene.quiet);

  PackArguments pack_arguments;
  std::string pack_machine;
  CLI::App* pack = app.add_subcommand("pack", "makes a scene image (.gri) that render and firmware read as it is");
  add_input(*pack, pack_arguments.scene);
  add_grid_options(*pack, pack_arguments.scene, pack_machine);
  add_parsed(*pack, "-o,--output", pack_arguments.output, parse_path, "a file name", "FILE",
             "scene image; - is standard output")
      ->required();
  add_choice(*pack, "--format", pack_arguments.format, kFormats, format_help());
  add_quiet(*pack, pack_arguments.scene.quiet);

  RawRender job_raw;
  JobArguments job_arguments;
  CLI::App* job = app.add_subcommand("job", "makes the file of a frame that a device is given");
  add_job_options(*job, job_arguments, job_raw);

  ResultArguments result_arguments;
  CLI::App* result = app.add_subcommand("result", "reads what a device made of a job");
  std::string result_machine;
  add_result_options(*result, result_arguments, result_machine);

  MachinesArguments machines_arguments;
  std::string machine;
  CLI::App* machines =
      app.add_subcommand("machines", "lists the machine profiles, or prints one as --machine reads it");
  machines->add_option("MACHINE", machine, "built-in name or machine file: printed in full, to be copied and edited")
      ->type_name("");
  machines->footer(machine_format_help());
  machines->add_flag("--json", machines_arguments.json, "as JSON");
  add_quiet(*machines, machines_arguments.quiet);

  ExperimentArguments experiment_arguments;
  CLI::App* experiment = app.add_subcommand("experiment", "runs an experiment: tables, plots and a page in a folder");
  add_experiment_options(*experiment, experiment_arguments);

  std::string topic;
  CLI::App* help = app.add_subcommand("help", "explains a command");
  help->add_option("COMMAND", topic, "the command (default: what commands there are)")->type_name("");

  app.footer("gridiron help COMMAND explains every option of a command.");  // not theirs
  if (count <= 1) return TextRequest{overview(app)};
  require_command(app, values[1]);
  try {
    app.parse(count, values);
  } catch (const CLI::CallForHelp&) {
    const auto chosen = app.get_subcommands();
    return TextRequest{help_of(app, chosen.empty() ? app : *chosen.front())};
  } catch (const CLI::CallForVersion& version) {
    return TextRequest{std::string(version.what()) + "\n"};
  } catch (const CLI::ParseError& error) {
    explain_mistake(app, std::span(values, static_cast<std::size_t>(count)).subspan(1), error.what());
  }
  if (*help) return TextRequest{help_of(app, topic.empty() ? app : command_of(app, topic))};
  if (*render) return complete_render(raw, *render);
  if (*animate) return complete_animate(std::move(animate_arguments), animate_raw, *animate);
  if (*info) {
    return complete_info(std::move(info_arguments), info_machine, *info);
  }
  if (*pack) {
    std::filesystem::path& input = pack_arguments.scene.input;
    input = input_path(input);
    require_own_streams({{"INPUT", input}, machine_file(pack_machine)});
    pack_arguments.scene.machine = find_machine(pack_machine);
    const SceneKind kind = foreseen_kind(input);
    if (kind != SceneKind::kUnknown) require_tolerance(pack_arguments.scene.tolerance, kind);
    return pack_arguments;
  }
  if (*job) return complete_job(std::move(job_arguments), job_raw, *job);
  if (*result) return complete_result(result_arguments, result_machine);
  if (*experiment) return complete_experiment(experiment_arguments, *experiment);
  if (machines->count("MACHINE") > 0) machines_arguments.machine = find_machine(machine);
  return machines_arguments;
}

}  // namespace gridiron::tool
