// Options of the commands that render: render, animate, job. SPDX-License-Identifier: Apache-2.0
#include <gridiron/firmware/frame_job.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <string_view>

#include "base/failure.h"
#include "files/input_file.h"
#include "gridiron/scene/camera_path.h"
#include "options.h"

namespace gridiron::tool {
namespace {

using sim::Completion;
using sim::Mode;

std::optional<std::uint64_t> parse_seed(const std::string& text) {
  const bool digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  if (!digits || text.size() > 19) return std::nullopt;  // 19 digits always fit 64 bits
  return std::stoull(text);
}

void add_sweep_options(CLI::App& app, RenderRequest& render) {
  const auto add = [&render](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) render.varied.push_back(parse_varied_key(text));
    return true;
  };
  Offer offer;
  for (const std::string& key : keys_of_replays()) offer.words.push_back(key + "=");
  set_offer(*app.add_option("--vary", add,
                            "replay the rendered frame on machines that differ in this key of machine files, with each "
                            "of the values; up to 3 times, for all combinations, 4096 machines at most; a value is "
                            "what a machine file has there; needs --sweep or --sweep-plot")
                 ->type_name("KEY=VALUE,...")
                 ->expected(1)
                 ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll),
            offer);
  add_output(app, "--sweep", render.outputs.sweep, {"csv"}, "a row for each machine of --vary: its cycles, CSV");
  add_output(app, "--sweep-plot", render.outputs.sweep_plot, {"svg"},
             "frames a second against the first key of --vary, a curve for each combination of the others, SVG");
}

void add_output_options(CLI::App& app, RenderRequest& render) {
  FrameOutputs& outputs = render.outputs;
  add_output(app, "-o,--output", outputs.picture, kPictureEndings,
             "picture, .png or .pfm (default: INPUT's name with .png, in the current folder); - is standard output, "
             "here and for every output");
  add_output(app, "--depth", outputs.depth, {"pfm"}, "distance of every pixel, .pfm, +inf where nothing is hit");
  add_output(app, "--ids", outputs.ids, {"pfm"}, "triangle of every pixel, .pfm, -1 where nothing is hit");
  add_output(app, "--report", outputs.report, {"json"},
             "where cycles and bytes went, JSON; without cycles where none are counted (--mode plain, --lanes other "
             "than 4, --tile)");
  add_output(app, "--timeline", outputs.timeline, {"json"},
             "what each core did when, Chrome trace format; not with --mode plain");
  add_sweep_options(app, render);
  app.add_flag(
      "--bound", render.has_bound,
      "what the tiles of best may take for this camera too, in the report and beside the worst tile; takes about "
      "as long as the frame, much longer where hundreds of triangles meet in one pixel");
  add_count(app, "--repeat", render.repeats, 1, 1000,
            "build and render N times and print the least of the host's times (default 1)");
  add_quiet(app, render.scene.quiet);
}

void add_cores(CLI::App& app, std::optional<std::uint32_t>& cores) {
  constexpr std::uint32_t kMostCores = 1024;
  add_count(app, "--cores", cores, 1, kMostCores, "cores of the machine (default: the profile's)");
}

void add_mode(CLI::App& app, Mode& mode) {
  add_choice(app, "--mode", mode,
             Choices<Mode>{{"checked", Mode::kChecked}, {"plain", Mode::kPlain}, {"instrumented", Mode::kInstrumented}},
             "checked (default): every rule checked, work traced; plain: fast, nothing but the picture; "
             "instrumented: checked, and every load and store of the kernel too");
}

void add_machine_options(CLI::App& app, RenderRequest& render) {
  add_cores(app, render.cores);
  add_threads(app, render.threads, "no result depends on it");
  add_store(app, render.layout.store);
  add_mode(app, render.mode);
  add_choice(
      app, "--completion", render.completion,
      Choices<Completion>{{"early", Completion::kEarly}, {"late", Completion::kLate}, {"random", Completion::kRandom}},
      "when the bytes of a transfer move (default early)");
  add_parsed(app, "--seed", render.seed, parse_seed, "a whole number of at most 19 digits", "N",
             "seed of --completion random (default 0)");
  add_choice(app, "--lanes", render.lanes, Choices<std::uint32_t>{{"1", 1}, {"4", 4}, {"8", 8}, {"16", 16}},
             "rays per SIMD group (default 4; plain: the host's widest); cycles are counted for 4 only; 1: "
             "with best, without effects");
  const auto tile = [](const std::string& text) { return parse_count_pair(text, ','); };
  add_parsed(app, "--tile", render.tile, tile, "X,Y with a column and a row", "X,Y",
             "render this tile alone; the picture is the tile, the frame in main memory is whole");
}

void add_algorithm_options(CLI::App& app, RenderRequest& render) {
  add_choice(app, "--buffering", render.layout.depths,
             Choices<BufferDepths>{{"single", kSingleBuffering}, {"double", kDoubleBuffering}},
             "one or two buffers of each kind, and as many children of a node fetched at once (default: the "
             "configuration's)");
  add_packet(app, render.layout.packet_width);
  add_choice(
      app, "--tile-width", render.layout.tile_width,
      Choices<std::uint32_t>{{"8", 8}, {"16", 16}, {"32", 32}, {"64", 64}},
      "pixels along a tile's edge (default: 64 with best, 32 with --store 128, 16 with --store 64; else 32, 16 with "
      "--store 64; with --shading scene 32, 8 with --store 64)");
  add_accuracy(app, render.accuracy);
  add_choice(app, "--shading", render.shading,
             Choices<Shading>{{"none", Shading::kNone}, {"simple", Shading::kSimple}, {"scene", Shading::kScene}},
             "none: hit or background; simple: facing ratio (default of meshes); scene: lights, materials and effects "
             "of the scene (default where it has any)");
  app.add_flag("--no-mailbox", render.no_mailbox, "test a triangle again in every cell that holds it; not with best");
  app.add_flag("--no-culling", render.no_culling, "do not cull triangles by the corner rays; not with best");
  app.add_flag("--no-subpackets", render.no_subpackets, "do not cull subpackets of a packet; not with best");
  app.add_flag("--no-empty-skip", render.no_empty_skip, "fetch the cell blocks of empty macrocells too; not with best");
}

// Rejects impossible combinations before a file is opened.
void complete_render(RenderRequest& render, const std::string& machine) {
  check_request(render, this_host());
  complete_scene(render.scene, machine, render.camera);
}

void complete_animation(AnimateRequest& animate, const std::string& machine) {
  RenderRequest& render = animate.render;
  if (animate.path && animate.turntable) usage_error("--path and --turntable: both move the camera");
  if (animate.path && render.camera) usage_error("--path and --camera: both are views of the whole frame");
  if (animate.path && render.view.from) usage_error("--path and --from: both say where the eye is");
  if (animate.animation && (animate.path || animate.turntable)) {
    usage_error("--animation: moves the model; --path and --turntable move the camera");
  }
  if (animate.animation && animate.inputs.size() != 1) usage_error("--animation: FRAMES is one model");
  if (animate.animation && is_stream(input_path(animate.inputs.front()))) {
    usage_error("--animation: reads the model once for each frame, which a stream cannot give");
  }
  if (!animate.clip.empty() && !animate.animation) usage_error("--clip: is of --animation");
  if (animate.frames_per_second && !animate.film) usage_error("--fps: is of --film");
  if (render.mode == Mode::kPlain && animate.builder) {
    usage_error("--build: --mode plain counts no builds; --mode checked does");
  }
  if (animate.timeline && render.mode == Mode::kPlain) {
    usage_error("--timeline: --mode plain does not record what cores do when; --mode checked does");
  }
  if (animate.timeline && animate.resume) usage_error("--timeline: is not made again by --resume");
  std::vector<NamedFile> inputs = {{"--camera", render.camera}, {"--path", animate.path}, machine_file(machine)};
  for (std::filesystem::path& input : animate.inputs) {
    if (input.empty()) usage_error("FRAMES: '' is not a file name");
    input = input_path(input);
    inputs.push_back({"FRAMES", input});
  }
  require_own_streams(inputs);
  complete_render(render, machine);
}

// Options of which a picture or a figure depends, as given. Views and the machine are compared by their content.
std::map<std::string, std::string> given_options(const CLI::App& app) {
  constexpr std::string_view kOthers[] = {"FRAMES",    "--output",   "--path",          "--camera",     "--film",
                                          "--fps",     "--resume",   "--quiet",         "--help",       "--machine",
                                          "--threads", "--timeline", "--import-memory", "--import-time"};
  std::map<std::string, std::string> options;
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_single_name();
    const std::string spelled = (option->get_positional() ? "" : "--") + name;
    if (option->count() == 0 || std::ranges::find(kOthers, spelled) != std::end(kOthers)) continue;
    std::string& value = options[spelled];
    for (const std::string& word : option->results()) value += (value.empty() ? "" : " ") + word;
  }
  return options;
}

}  // namespace

void add_view_options(CLI::App& app, std::optional<std::filesystem::path>& camera, ViewRequest& view) {
  const std::string vector = "x,y,z with three finite numbers";
  add_input_option(app, "--camera", camera, {"camera"},
                   "view from a file of its own; --eye, --at, --up and --fov replace parts of it; - is standard input");
  add_parsed(app, "--eye", view.eye, parse_vector, vector, "x,y,z",
             "position of the camera (default: a text scene's own, else the scene is framed)");
  add_parsed(app, "--at", view.at, parse_vector, vector, "x,y,z",
             "point in the middle of the picture (default: a text scene's own, else that of the framed scene)");
  add_parsed(app, "--up", view.up, parse_up, "x, y, z, -x, -y, -z or " + vector, "AXIS|x,y,z",
             "direction that is up (default y, or a text scene's own)", {"x", "y", "z", "-x", "-y", "-z"});
  add_parsed(app, "--from", view.from, parse_view_angles,
             "front, back, left, right, top, bottom, iso or AZIMUTH,ELEVATION in degrees, elevation from -90 to 90",
             "SIDE|AZIMUTH,ELEVATION",
             "side from which the scene is framed: front|back|left|right|top|bottom|iso, or degrees from the front to "
             "the right and upwards (default 30,25); replaces eye and at of --camera or of a text scene",
             {"front", "back", "left", "right", "top", "bottom", "iso"});
  const auto fov = [](const std::string& text) {
    const std::optional<float> value = parse_float(text);
    return value && fov_is_possible(*value) ? value : std::nullopt;
  };
  add_parsed(app, "--fov", view.fov_degrees, fov, "an angle from 0.001 to below 180 degrees", "DEG",
             "angle between the top and the bottom edge (default 45)");
}

Finish add_render(CLI::App& app) {
  const auto asked = std::make_shared<Asked<RenderRequest>>();
  RenderRequest& render = asked->request;
  add_input(app, render.scene);
  add_grid_options(app, render.scene, asked->machine);
  add_output_options(app, render);
  add_size(app, render.size, "picture in pixels (default: a text scene's own, else 1024x1024)");
  add_view_options(app, render.camera, render.view);
  add_look_options(app, render.scene.look);
  add_machine_options(app, render);
  add_algorithm_options(app, render);
  return [asked] {
    complete_render(asked->request, asked->machine);
    return asked->request;
  };
}

Finish add_animate(CLI::App& app) {
  const auto asked = std::make_shared<Asked<AnimateRequest>>();
  AnimateRequest& animate = asked->request;
  RenderRequest& render = animate.render;
  CLI::Option* frames =
      app.add_option("FRAMES", animate.inputs,
                     "meshes or text scenes in the order of their frames; of a folder, by name, all .ply files, "
                     "or all .nff files, or all models; one mesh, text scene or packed scene with --path or "
                     "--turntable; - is standard input")
          ->required()
          ->type_name("");
  set_offer(*frames, {.words = {}, .endings = kSceneEndings, .has_files = true, .has_folders = true});
  add_output_folder(app, animate.output, "folder of the pictures and animation.csv, made where it is not there");
  add_input_option(
      app, "--path", animate.path, {"path"},
      "the camera moves smoothly through the key views of this file; --eye, --at, --up and --fov replace parts of all "
      "views; - is standard input");
  add_count(app, "--turntable", animate.turntable, 1, kMostFrames,
            "the camera goes once around the up axis in so many frames");
  add_count(app, "--animation", animate.animation, 1, kMostFrames,
            "an animation of the one model (glTF and others) in so many frames, the first and the last moment among "
            "them");
  const auto any_text = [](const std::string& text) { return text.empty() ? std::nullopt : std::optional(text); };
  add_parsed(app, "--clip", animate.clip, any_text, "a name or a number", "NAME|NUMBER",
             "which of the model's animations --animation shows (default 1, the first)");
  add_output(app, "--film", animate.film, {"mp4", "webm", "gif"},
             "film of all pictures, .mp4, .webm or .gif; needs ffmpeg");
  const auto rate = [](const std::string& text) {
    const std::optional<float> value = parse_float(text);
    return value && *value >= 0.01f && *value <= 1000.0f ? value : std::nullopt;
  };
  add_parsed(app, "--fps", animate.frames_per_second, rate, "a number from 0.01 to 1000", "NUMBER",
             "frames a second of the film (default 24)");
  add_choice(app, "--build", animate.builder,
             Choices<Builder>{{"cores", Builder::kCores}, {"master", Builder::kMaster}},
             "what builds the tree of each frame: the cores, whose passes are counted (default with best), or the "
             "general core, which also builds all grids");
  app.add_flag("--keep-vertex-order", animate.keeps_vertex_order,
               "the cores read vertices in the order of the file; by default in that of three which takes the fewest "
               "lines of memory: the file's, that of first use, one along a curve through space");
  add_output(app, "--timeline", animate.timeline, {"json"},
             "what each core did when for the first frame: the passes of its build, and the picture; Chrome trace "
             "format; not with --resume");
  app.add_flag("--resume", animate.resume,
               "keep the complete pictures of an earlier command with the same options and inputs");
  add_tolerance(app, render.scene);
  add_model_options(app, render.scene);
  add_grid_options(app, render.scene, asked->machine);
  add_size(app, render.size, "pictures in pixels (default: the text scenes' own, else 1024x1024)");
  add_view_options(app, render.camera, render.view);
  add_look_options(app, render.scene.look);
  add_cores(app, render.cores);
  add_threads(app, render.threads, "no result depends on it");
  add_store(app, render.layout.store);
  add_mode(app, render.mode);
  add_algorithm_options(app, render);
  add_quiet(app, render.scene.quiet);
  return [asked, &app] {
    complete_animation(asked->request, asked->machine);
    asked->request.options = given_options(app);
    return asked->request;
  };
}

Finish add_job(CLI::App& app) {
  const auto asked = std::make_shared<Asked<JobRequest>>();
  JobRequest& job = asked->request;
  RenderRequest& render = job.render;
  add_input(app, render.scene);
  add_output(app, "-o,--output", job.output, {"job"}, "the job; - is standard output")->required();
  const auto base = [](const std::string& text) {
    const std::optional<std::uint64_t> address = parse_address(text);
    return address && *address % 4096 == 0 ? address : std::nullopt;
  };
  add_parsed(app, "--base", job.base_address, base, "a multiple of 4096, decimal or after 0x", "ADDRESS",
             "where the device loads the job")
      ->required();
  add_parsed(app, "--memory", job.memory_bytes, parse_address, "a whole number", "BYTES",
             "memory of the device from there on: a job that needs more is refused");
  add_grid_options(app, render.scene, asked->machine);
  add_size(app, render.size, "picture in pixels (default: a text scene's own, else 1024x1024)");
  add_view_options(app, render.camera, render.view);
  add_look_options(app, render.scene.look);
  app.add_flag("--depth", render.depth_plane, "distances too");
  app.add_flag("--ids", render.ids_plane, "triangle ids too");
  add_count(app, "--cores", render.cores, 1, port::kMostBoardCores,
            "cores of the device that there is memory for rays that wait for (default: the profile's)");
  add_store(app, render.layout.store);
  add_algorithm_options(app, render);
  add_quiet(app, render.scene.quiet);
  return [asked] {
    RenderRequest& request = asked->request.render;
    complete_render(request, asked->machine);
    const sim::MachineProfile& machine = *request.scene.machine;
    if (!request.cores && machine.core_count > port::kMostBoardCores) {
      usage_error("--cores: a job is for " + std::to_string(port::kMostBoardCores) + " cores at most; " +
                  std::string(machine.name) + " has " + std::to_string(machine.core_count));
    }
    return asked->request;
  };
}

}  // namespace gridiron::tool
