// Arguments. SPDX-License-Identifier: Apache-2.0
#include "arguments.h"

#include <gridiron/version.h>

#include <cstdlib>
#include <memory>
#include <span>
#include <string_view>

#include "base/failure.h"
#include "base/words.h"
#include "command_table.h"
#include "command_words.h"
#include "files/input_file.h"
#include "gridiron/device/accuracies.h"
#include "gridiron/device/machine_keys.h"

namespace gridiron::tool {
namespace {

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

Finish add_info(CLI::App& app) {
  const auto asked = std::make_shared<Asked<InfoRequest>>();
  InfoRequest& info = asked->request;
  add_input(app, info.scene);
  add_grid_options(app, info.scene, asked->machine);
  add_choice(app, "--format", info.format, kFormats, "how triangles are stored; " + format_help());
  add_size(app, info.size, "picture whose memory is counted (default: a text scene's own, else 1024x1024)");
  add_store(app, info.layout.store);
  add_packet(app, info.layout.packet_width);
  add_accuracy(app, info.accuracy);
  app.add_flag("--depth", info.has_depth, "distances too");
  add_input_option(app, "--camera", info.camera, {"camera"},
                   "with best: what tiles take at most with this camera; - is standard input");
  add_choice(app, "--shading", info.shading, Choices<Shading>{{"none", Shading::kNone}, {"simple", Shading::kSimple}},
             "of these tiles (default simple)");
  app.add_flag("--json", info.json, "as JSON");
  add_quiet(app, info.scene.quiet);
  return [asked] {
    complete_scene(asked->request.scene, asked->machine, asked->request.camera);
    return asked->request;
  };
}

Finish add_pack(CLI::App& app) {
  const auto asked = std::make_shared<Asked<PackRequest>>();
  PackRequest& pack = asked->request;
  add_input(app, pack.scene);
  add_grid_options(app, pack.scene, asked->machine);
  add_output(app, "-o,--output", pack.output, {"gri"}, "scene image; - is standard output")->required();
  add_choice(app, "--format", pack.format, kFormats, format_help());
  add_look_options(app, pack.scene.look);
  add_view_options(app, pack.camera, pack.view);
  add_quiet(app, pack.scene.quiet);
  return [asked] {
    PackRequest& request = asked->request;
    const ViewRequest& view = request.view;
    const bool has_view = request.camera || view.eye || view.at || view.up || view.from || view.fov_degrees;
    if (has_view && !request.scene.look.is_given()) {
      usage_error("--camera, --eye, --at, --up, --from, --fov: place the lights of a look; a packed scene has no view");
    }
    if (view.from && view.eye) usage_error("--from and --eye: both say where the eye is");
    complete_scene(request.scene, asked->machine, request.camera);
    return request;
  };
}

Finish add_result(CLI::App& app) {
  const auto asked = std::make_shared<Asked<ResultRequest>>();
  ResultRequest& result = asked->request;
  add_input_file(app, "JOB", result.job, {"job"}, "the device's input, made by job; - is standard input");
  add_input_file(app, "RESULT", result.result, {"result"},
                 "the device's output: the bytes from result_address on; - is standard input");
  add_output(app, "-o,--output", result.outputs.picture, kPictureEndings,
             "picture, .png or .pfm; - is standard output, here and for every output");
  add_output(app, "--depth", result.outputs.depth, {"pfm"},
             "distance of every pixel, .pfm, +inf where nothing is hit; of a job with distances");
  add_output(app, "--ids", result.outputs.ids, {"pfm"},
             "triangle of every pixel, .pfm, -1 where nothing is hit; of a job with ids");
  add_output(app, "--report", result.outputs.report, {"json"}, "hashes, work and tiles of each core, JSON");
  app.add_flag("--compare", result.compare,
               "render the job on the simulated chip and compare planes, work and transfers; exit code 3 where they "
               "differ; all outputs are written even then");
  offer_machines(*app.add_option("--predict", asked->machine,
                                 "with --compare: compare what each tile takes on this machine with the instructions "
                                 "that the device counted")
                      ->type_name("MACHINE"));
  add_threads(app, result.threads, "of --compare; no result depends on it");
  add_quiet(app, result.quiet);
  return [asked] {
    ResultRequest& request = asked->request;
    const NamedFile predict = machine_file(asked->machine, "--predict");
    require_own_streams({{"JOB", request.job}, {"RESULT", request.result}, predict});
    if (asked->machine.empty()) return request;
    if (!request.compare) usage_error("--predict needs --compare");
    request.predict = find_machine(asked->machine);
    return request;
  };
}

Finish add_machines(CLI::App& app) {
  const auto asked = std::make_shared<Asked<MachinesRequest>>();
  offer_machines(*app.add_option("MACHINE", asked->machine,
                                 "built-in name or machine file: printed in full, to be copied and edited")
                      ->type_name(""));
  app.footer(machine_format_help());
  app.add_flag("--json", asked->request.json, "as JSON");
  add_quiet(app, asked->request.quiet);
  return [asked, &app] {
    if (app.count("MACHINE") > 0) asked->request.machine = find_machine(asked->machine);
    return asked->request;
  };
}

Finish add_experiment(CLI::App& app) {
  const auto asked = std::make_shared<ExperimentRequest>();
  ExperimentRequest& experiment = *asked;
  add_choice(app, "NAME", experiment.name,
             Choices<ExperimentName>{{"paper", ExperimentName::kPaper},
                                     {"accuracy", ExperimentName::kAccuracy},
                                     {"effects", ExperimentName::kEffects},
                                     {"dynamic", ExperimentName::kDynamic}},
             "paper: Tables 1-4, Figs. 5-7 and sweeps; some eight minutes of processor time with the scans. accuracy: "
             "what each accuracy profile costs and what is wrong with its answers; some three minutes. effects: what "
             "each effect costs, and that one that is off costs nothing; some half a minute, no scans. dynamic: what "
             "building anew for each frame costs, by the general core and by the cores; some minutes. All leave CSV, "
             "SVG and index.html; without a terminal nothing is printed before the end")
      ->required();
  add_output_folder(app, experiment.output, "folder, made where it is not there");
  offer_folders(*add_parsed(
      app, "--scenes", experiment.scenes, [](const std::string& text) { return std::optional(text); }, "a folder",
      "DIR",
      "folder of the scans (default: the environment's GRIDIRON_SCENES); scans that are not there are left "
      "out, and without any a teapot and a torus knot are made; effects makes its own scenes"));
  add_threads(app, experiment.threads, "no file but host_*.csv, which measures this host, depends on it");
  add_size(app, experiment.size,
           "pictures in pixels (default 1024x1024; dynamic: 512x512; effects: 96x96, at least 16x16)");
  add_count(app, "--largest", experiment.largest_knot, 6'000, 10'000'000,
            "triangles of the largest mesh of Table 1 of paper (default 1000000), at most of the largest knot of "
            "dynamic");
  add_quiet(app, experiment.quiet);
  return [asked] {
    ExperimentRequest& request = *asked;
    if (request.largest_knot && request.name != ExperimentName::kPaper && request.name != ExperimentName::kDynamic) {
      usage_error("--largest: is of experiments paper and dynamic alone");
    }
    if (request.name == ExperimentName::kEffects) {
      if (request.scenes) usage_error("--scenes: experiment effects makes its own");
      constexpr std::uint32_t kLeastSize = 16;  // smaller ones have too few waits for the experiment's own checks
      if (request.size && std::min(request.size->x, request.size->y) < kLeastSize) {
        usage_error("--size: experiment effects needs pictures of at least 16x16 pixels");
      }
    } else if (const char* scenes = std::getenv("GRIDIRON_SCENES");
               scenes != nullptr && request.scenes.value_or("").empty()) {
      request.scenes = scenes;
    }
    return request;
  };
}

// A command, and the function that adds its options.
struct NamedCommand {
  const char* name;
  const char* help;
  Finish (*add)(CLI::App& app);
};

constexpr NamedCommand kCommands[] = {
    {"render", "renders a scene and reports what the frame costs on the chip", add_render},
    {"animate", "renders a frame for each mesh or scene, or for each view of a moving camera; reports what they cost",
     add_animate},
    {"info", "prints the contents and needs of a scene", add_info},
    {"pack", "makes a scene image (.gri) that render and firmware read as it is", add_pack},
    {"job", "makes the file of a frame that a device is given", add_job},
    {"result", "reads what a device made of a job", add_result},
    {"machines", "lists the machine profiles, or prints one as --machine reads it", add_machines},
    {"experiment", "runs an experiment: tables, plots and a page in a folder", add_experiment},
};

}  // namespace

CommandTable::CommandTable()
    : app("ray traces on a simulated chip whose cores have a small local store and move data by DMA.", "gridiron") {
  app.set_version_flag("--version", std::string("gridiron ") + kVersion);
  app.require_subcommand(1);
  Offer commands;
  for (const NamedCommand& command : kCommands) {
    CLI::App& options = *app.add_subcommand(command.name, command.help);
    finishes[&options] = command.add(options);
    commands.words.emplace_back(command.name);
  }
  help = app.add_subcommand("help", "explains a command");
  CLI::Option* option = help->add_option("COMMAND", topic, "the command (default: what commands there are)");
  set_offer(*option->type_name(""), commands);
  app.footer("gridiron help COMMAND explains every option of a command.");  // not theirs
}

Command parse_arguments(int count, const char* const* values) {
  CommandTable table;
  CLI::App& app = table.app;
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
  if (*table.help) return TextRequest{help_of(app, table.topic.empty() ? app : command_of(app, table.topic))};
  return table.finishes.at(app.get_subcommands().front())();
}

}  // namespace gridiron::tool
