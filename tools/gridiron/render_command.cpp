// render: a scene becomes a picture, and where its cycles and bytes went. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/replay.h>
#include <gridiron/sim/sim_chip.h>
#include <report/report.h>
#include <report/timeline.h>

#include <bit>
#include <cstdio>
#include <limits>
#include <list>
#include <string>
#include <string_view>

#include "atomic_file.h"
#include "chip_frame.h"
#include "commands.h"
#include "effect_names.h"
#include "failure.h"
#include "frame_memory.h"
#include "hither.h"
#include "image_files.h"
#include "interrupt.h"
#include "layout_choice.h"
#include "progress.h"
#include "scene_input.h"
#include "stopwatch.h"
#include "store_facts.h"
#include "untile.h"
#include "words.h"

namespace gridiron::tool {
namespace {

// Fails early: nobody should wait for a picture that cannot be written.
std::vector<std::filesystem::path> outputs_of(const RenderArguments& arguments) {
  std::vector<std::filesystem::path> outputs = {arguments.output};
  for (const auto* path : {&arguments.depth, &arguments.ids, &arguments.report, &arguments.timeline}) {
    if (*path) outputs.push_back(**path);
  }
  return outputs;
}

// A named configuration that the store has too few buffers for is used with those that there are.
void tell_fewer_buffers(const RenderArguments& arguments) {
  if (arguments.depths == arguments.wanted_depths) return;
  const auto blocks = [](const BufferDepths& depths) {
    return words_of_count(depths.macro, "cell block") + " and " + words_of_count(depths.triangle, "triangle buffer");
  };
  std::fprintf(stderr, "%s: configuration %s has %s; a local store of %u KB holds %s for it\n",
               arguments.scene.input.c_str(), std::string(arguments.scene.configuration->name).c_str(),
               blocks(arguments.wanted_depths).c_str(), sim::arena_bytes(arguments.store) >> 10,
               blocks(arguments.depths).c_str());
}

ViewRequest view_of(const SceneView& view) {
  return {.eye = view.from, .at = view.at, .up = view.up, .fov_degrees = view.angle_degrees};
}

// What the command line left to the scene and the host.
RenderArguments complete_arguments(const RenderArguments& asked, const SceneInput& input) {
  RenderArguments arguments = asked;
  if (input.text && !arguments.has_size) {
    arguments.width = input.text->view.width;
    arguments.height = input.text->view.height;
  }
  if (arguments.threads == 0) arguments.threads = host_threads();
  const PackedScene* packed = std::get_if<PackedScene>(&input.content);
  if (!arguments.has_shading && packed != nullptr && packed->view.has_effects) {
    arguments.shading = Shading::kScene;
    settle_layout(arguments);
  }
  return arguments;
}

// Another place to look from has no use for the scene's near plane.
void check_scene_view(const RenderArguments& arguments, const SceneInput& input, const ViewRequest& view) {
  if (!input.text || arguments.camera || arguments.view.eye) return;
  const float no_bounds[3] = {};  // nothing is left to be framed
  check_hither(input, frame_view(view, no_bounds, no_bounds), arguments.width, arguments.height);
}

float depth_of_word(std::uint32_t word) {
  // A chip may have no infinity, so its plane says "largest float" where nothing is hit.
  const float depth = std::bit_cast<float>(word);
  return depth >= kFloatMax ? std::numeric_limits<float>::infinity() : depth;
}

float id_of_word(std::uint32_t word) {
  return word == kNoTriangle ? -1.0f : static_cast<float>(word);
}

// Whether the frame left a trace that a clock can be put to: costs are those of 4 lanes and of whole frames.
bool has_time(const RenderArguments& arguments) {
  return arguments.mode != sim::Mode::kPlain && arguments.lanes == 4 && !arguments.tile;
}

ReportInput collect_report(const RenderArguments& arguments, const SceneInput& input, const FrameMemory& frame,
                           const sim::ChipResult& result, const sim::FrameTiming& timing) {
  ReportInput report;
  report.triangle_count = frame.image.header.triangle_count;
  report.vertex_count = frame.image.header.vertex_count;
  report.dropped_triangle_count = frame.image.header.dropped_triangle_count;
  report.grid = frame.image.grid;
  report.wanted_lambda = frame.wanted_lambda;
  report.grid_bytes = frame.image.header.image_bytes;
  report.machine = *arguments.scene.machine;
  report.timing = timing;
  report.work = result.work;
  for (const std::string_view name : effect_names(frame.image.effects.called_for)) {
    report.effects_called_for.emplace_back(name);
  }
  report.is_scene_shaded = arguments.shading == Shading::kScene;
  const std::uint32_t samples = report.is_scene_shaded ? frame.image.effects.samples_per_pixel : 1;
  report.rays = {{"primary", std::uint64_t{arguments.width} * arguments.height * samples}};
  const StoreFacts store = *find_store_facts(arguments.layout());  // it has rendered
  report.arena_bytes = store.arena_bytes;
  report.regions = store.regions;
  report.code_bytes = store.code_bytes;
  report.stack_bytes = store.stack_bytes;
  report.load_seconds = input.load_seconds;
  report.build_seconds = frame.build_seconds;
  report.host_threads = arguments.threads;
  return report;
}

void print_picture(const RenderArguments& arguments, const Picture<std::uint32_t>& color, std::uint64_t hash) {
  std::printf("%s: %ux%u, hash %s\n", arguments.output.c_str(), color.width, color.height, hash_text(hash).c_str());
}

void print_timing(const RenderArguments& arguments, const sim::FrameTiming& timing) {
  double wait_cycles = 0;
  for (const sim::CoreTiming& core : timing.cores) {
    for (const double cycles : core.dma_wait_cycles) wait_cycles += cycles;
  }
  const double core_cycles = timing.frame_cycles * static_cast<double>(timing.cores.size());
  std::printf("%s, %s: %s cycles, %.2f ms, %.2f frames/s; %.2f %% of the cycles wait for DMA\n",
              std::string(arguments.scene.machine->name).c_str(), words_of_count(timing.cores.size(), "core").c_str(),
              words_of_count(static_cast<std::uint64_t>(timing.frame_cycles)).c_str(), timing.seconds * 1e3,
              timing.seconds > 0 ? 1 / timing.seconds : 0.0, core_cycles > 0 ? 100 * wait_cycles / core_cycles : 0.0);
}

}  // namespace

void run_command(const RenderArguments& asked) {
  for (const std::filesystem::path& output : outputs_of(asked)) check_can_write(output);
  const ViewRequest camera = asked.camera ? read_camera_file(*asked.camera) : ViewRequest{};
  const SceneInput input = read_scene_input(asked.scene.input, asked.scene.tolerance);
  require_other_files(input, outputs_of(asked));
  const RenderArguments arguments = complete_arguments(asked, input);
  const bool has_own_view = input.text && !arguments.camera;
  const ViewRequest view = join_view(arguments.view, has_own_view ? view_of(input.text->view) : camera);
  check_scene_view(arguments, input, view);
  if (!arguments.quiet) tell_notes(input);
  tell_fewer_buffers(arguments);
  FrameMemory frame(frame_memory_bytes(input, arguments));
  prepare_frame(frame, input, arguments, view);

  const Stopwatch render_stopwatch;
  const sim::ChipResult result = [&frame, &arguments] {
    Progress progress(!arguments.quiet);
    return render_on_chip(frame, arguments,
                          [&progress](std::uint32_t done, std::uint32_t total) { progress.update(done, total); });
  }();
  const double render_seconds = render_stopwatch.seconds();

  const auto color =
      untile<std::uint32_t>(frame.record, frame.color.bytes, arguments.tile, [](std::uint32_t word) { return word; });
  const std::uint64_t hash = image_hash(color.pixels);
  sim::FrameTiming timing;
  if (has_time(arguments)) {
    timing = sim::replay(result.trace, *arguments.scene.machine,
                         {.core_count = arguments.cores, .timeline = arguments.timeline.has_value()});
  }

  // Every file is complete under its temporary name before the first one appears.
  std::list<AtomicFile> files;
  const auto add_file = [&files](const std::filesystem::path& path, const auto& content) {
    stop_if_interrupted();
    files.emplace_back(path).write(content);
  };
  add_file(arguments.output, encode_png(color));
  if (arguments.depth) {
    add_file(*arguments.depth,
             encode_pfm(untile<float>(frame.record, frame.depth.bytes, arguments.tile, depth_of_word)));
  }
  if (arguments.ids) {
    add_file(*arguments.ids, encode_pfm(untile<float>(frame.record, frame.ids.bytes, arguments.tile, id_of_word)));
  }
  if (arguments.report) {
    ReportInput report = collect_report(arguments, input, frame, result, timing);
    report.render_seconds = render_seconds;
    report.image_hash = hash;
    add_file(*arguments.report, report_json(report));
  }
  if (arguments.timeline) add_file(*arguments.timeline, timeline_json(timing, *arguments.scene.machine));
  stop_if_interrupted();
  // Devices and pipes first: they may fail where a rename no longer does.
  for (AtomicFile& file : files) {
    if (file.is_special()) file.commit();
  }
  for (AtomicFile& file : files) {
    if (!file.is_special()) file.commit();
  }

  if (arguments.quiet) return;
  print_picture(arguments, color, hash);
  if (has_time(arguments)) print_timing(arguments, timing);
  std::printf("host: %.3f s to load, %.3f s to build, %.3f s to render on %s\n", input.load_seconds,
              frame.build_seconds, render_seconds, words_of_count(arguments.threads, "thread").c_str());
}

}  // namespace gridiron::tool
