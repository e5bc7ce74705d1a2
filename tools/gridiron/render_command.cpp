// render: a scene becomes a picture, and where its cycles and bytes went. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/replay.h>
#include <gridiron/sim/sim_chip.h>
#include <report/report.h>
#include <report/timeline.h>

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

#include "atomic_file.h"
#include "chip_frame.h"
#include "command_files.h"
#include "commands.h"
#include "effect_names.h"
#include "frame_memory.h"
#include "frame_pictures.h"
#include "image_files.h"
#include "progress.h"
#include "requested_frame.h"
#include "scene_input.h"
#include "stopwatch.h"
#include "store_facts.h"
#include "unseen_scene.h"
#include "words.h"

namespace gridiron::tool {
namespace {

std::vector<Output> outputs_of(const RenderArguments& arguments) {
  std::vector<Output> outputs = {{"-o", arguments.output, OutputKind::kPicture}};
  if (arguments.depth) outputs.push_back({"--depth", *arguments.depth, OutputKind::kFloats});
  if (arguments.ids) outputs.push_back({"--ids", *arguments.ids, OutputKind::kFloats});
  if (arguments.report) outputs.push_back({"--report", *arguments.report, OutputKind::kText});
  if (arguments.timeline) outputs.push_back({"--timeline", *arguments.timeline, OutputKind::kText});
  return outputs;
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
  const RequestedFrame request = read_requested_frame(asked, outputs_of(asked));
  const SceneInput& input = request.input;
  const RenderArguments& arguments = request.arguments;
  FrameMemory frame(frame_memory_bytes(input, arguments));
  prepare_frame(frame, input, arguments, request.view);

  const Stopwatch render_stopwatch;
  const sim::ChipResult result = [&frame, &arguments] {
    Progress progress(!arguments.quiet);
    return render_on_chip(frame, arguments,
                          [&progress](std::uint32_t done, std::uint32_t total) { progress.update(done, total); });
  }();
  const double render_seconds = render_stopwatch.seconds();

  const auto plane_words = [&frame, &arguments](const sim::MemoryRegion& plane) {
    return words_of_plane(frame.record, plane.bytes, arguments.tile);
  };
  const Picture<std::uint32_t> color = plane_words(frame.color);
  const std::uint64_t hash = image_hash(color.pixels);
  sim::FrameTiming timing;
  if (has_time(arguments)) {
    timing = sim::replay(result.trace, *arguments.scene.machine,
                         {.core_count = arguments.cores, .timeline = arguments.timeline.has_value()});
  }

  AtomicFiles files;
  files.add(arguments.output, encode_picture(color, arguments.output));
  std::optional<std::uint64_t> depth_hash, ids_hash;
  if (arguments.depth) {
    const Picture<std::uint32_t> words = plane_words(frame.depth);
    depth_hash = image_hash(words.pixels);
    files.add(*arguments.depth, encode_pfm(depth_picture(words)));
  }
  if (arguments.ids) {
    const Picture<std::uint32_t> words = plane_words(frame.ids);
    ids_hash = image_hash(words.pixels);
    files.add(*arguments.ids, encode_pfm(id_picture(words)));
  }
  if (arguments.report) {
    ReportInput report = collect_report(arguments, input, frame, result, timing);
    report.render_seconds = render_seconds;
    report.image_hash = hash;
    report.depth_hash = depth_hash;
    report.ids_hash = ids_hash;
    files.add(*arguments.report, report_json(report));
  }
  if (arguments.timeline) files.add(*arguments.timeline, timeline_json(timing, *arguments.scene.machine));
  files.commit();

  if (arguments.quiet) return;
  if (!arguments.tile) tell_note(input.path, unseen_note(frame, result, arguments.mode));
  print_picture(arguments, color, hash);
  if (has_time(arguments)) print_timing(arguments, timing);
  std::printf("host: %.3f s to load, %.3f s to build, %.3f s to render on %s\n", input.load_seconds,
              frame.build_seconds, render_seconds, words_of_count(arguments.threads, "thread").c_str());
}

}  // namespace gridiron::tool
