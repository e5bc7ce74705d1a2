// render: a scene becomes a picture, and where its cycles and bytes went. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/replay.h>
#include <gridiron/sim/sim_chip.h>
#include <report/report.h>
#include <report/timeline.h>

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/progress.h"
#include "base/stopwatch.h"
#include "base/words.h"
#include "commands.h"
#include "files/atomic_file.h"
#include "files/command_files.h"
#include "files/image_files.h"
#include "gridiron/device/store_facts.h"
#include "gridiron/frame/chip_frame.h"
#include "gridiron/frame/frame_memory.h"
#include "gridiron/frame/frame_pictures.h"
#include "gridiron/frame/requested_frame.h"
#include "gridiron/frame/unseen_scene.h"
#include "gridiron/scene/effect_names.h"
#include "gridiron/scene/scene_input.h"

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

const char* word_of(sim::Mode mode) {
  switch (mode) {
    case sim::Mode::kChecked:
      return "checked";
    case sim::Mode::kPlain:
      return "plain";
    case sim::Mode::kInstrumented:
      return "instrumented";
  }
  return "unknown";
}

HostTime time_of(const HostSeconds& seconds) {
  return {seconds.wall, seconds.processor};
}

// A frame that was rendered once or several times, always to the same pictures.
struct Repeated {
  sim::ChipResult result;
  PlaneHashes hashes;
  HostSeconds build, render;  // the least of all
};

ReportInput collect_report(const RenderArguments& arguments, const SceneInput& input, const FrameMemory& frame,
                           const Repeated& repeated, const sim::FrameTiming& timing) {
  const sim::ChipResult& result = repeated.result;
  ReportInput report;
  report.mode = word_of(arguments.mode);
  report.is_timed = has_time(arguments);
  if (input.text && !input.text->roundness.groups.empty()) {
    report.least_tolerance = input.text->roundness.least_tolerance;
    report.most_tolerance = input.text->roundness.most_tolerance;
  }
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
  report.load = time_of(input.load_seconds);
  report.build = time_of(repeated.build);
  report.render = time_of(repeated.render);
  report.host_threads = arguments.threads;
  report.lanes = arguments.lanes;
  report.repeats = arguments.repeats;
  report.trace_bytes = result.trace.packed_bytes();
  report.image_hash = repeated.hashes.color;
  if (arguments.depth) report.depth_hash = repeated.hashes.depth;
  if (arguments.ids) report.ids_hash = repeated.hashes.ids;
  return report;
}

void print_picture(const RenderArguments& arguments, const Picture<std::uint32_t>& color, std::uint64_t hash) {
  std::printf("%s: %ux%u, hash %s\n", target_of(arguments.output).name.c_str(), color.width, color.height,
              hash_text(hash).c_str());
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

Picture<std::uint32_t> plane_words(const FrameMemory& frame, const RenderArguments& arguments,
                                   const sim::MemoryRegion& plane) {
  return words_of_plane(frame.record, plane.bytes, arguments.tile);
}

PlaneHashes hashes_of(const FrameMemory& frame, const RenderArguments& arguments) {
  const auto hash = [&](const sim::MemoryRegion& plane) {
    return plane.bytes.empty() ? 0 : image_hash(plane_words(frame, arguments, plane).pixels);
  };
  return {hash(frame.color), hash(frame.depth), hash(frame.ids)};
}

// Builds and renders as often as asked for. What was packed is not built: it moves into main memory and stays there.
Repeated render_repeatedly(std::optional<FrameMemory>& frame, RequestedFrame& request) {
  const RenderArguments& arguments = request.arguments;
  const bool is_packed = std::holds_alternative<PackedScene>(request.input.content);
  std::optional<Progress> progress;  // begins once the first image is built: the time left is that of tiles
  Repeated repeated;
  for (std::uint32_t repeat = 0; repeat < arguments.repeats; ++repeat) {
    if (repeat == 0 || !is_packed) {
      frame.reset();  // before there is another one
      frame.emplace(frame_memory_bytes(request.input, arguments));
      if (is_packed) {
        prepare_frame(*frame, std::move(request.input), arguments, request.view);
      } else {
        prepare_frame(*frame, request.input, arguments, request.view);
      }
    }
    if (!progress) progress.emplace(!arguments.quiet, "tiles");
    const Stopwatch stopwatch;
    const auto report = [&](std::uint32_t done, std::uint32_t total) {
      progress->update(std::uint64_t{repeat} * total + done, std::uint64_t{arguments.repeats} * total);
    };
    repeated.result = render_on_chip(*frame, arguments, report);
    const HostSeconds render = stopwatch.both();
    const PlaneHashes hashes = hashes_of(*frame, arguments);
    repeated.build = repeat == 0 ? frame->build_seconds : repeated.build.least(frame->build_seconds);
    repeated.render = repeat == 0 ? render : repeated.render.least(render);
    if (repeat == 0) repeated.hashes = hashes;
    require_same_planes(repeated.hashes, hashes, repeat + 1);
  }
  return repeated;
}

}  // namespace

void run_command(const RenderArguments& asked) {
  const StageLines stages(!asked.quiet);
  RequestedFrame request = read_requested_frame(asked, outputs_of(asked));
  limit_threads(request.arguments);
  const SceneInput& input = request.input;
  const RenderArguments& arguments = request.arguments;
  std::optional<FrameMemory> memory;
  const Repeated repeated = render_repeatedly(memory, request);
  const FrameMemory& frame = *memory;
  const Picture<std::uint32_t> color = plane_words(frame, arguments, frame.color);
  sim::FrameTiming timing;
  if (has_time(arguments)) {
    timing = sim::replay(repeated.result.trace, *arguments.scene.machine,
                         {.core_count = arguments.cores, .timeline = arguments.timeline.has_value()});
  }

  AtomicFiles files;
  files.add(arguments.output, encode_picture(color, arguments.output));
  if (arguments.depth) {
    files.add(*arguments.depth, encode_pfm(depth_picture(plane_words(frame, arguments, frame.depth))));
  }
  if (arguments.ids) files.add(*arguments.ids, encode_pfm(id_picture(plane_words(frame, arguments, frame.ids))));
  if (arguments.report) {
    files.add(*arguments.report, report_json(collect_report(arguments, input, frame, repeated, timing)));
  }
  if (arguments.timeline) files.add(*arguments.timeline, timeline_json(timing, *arguments.scene.machine));
  files.commit_at_end();

  if (arguments.quiet) return;
  if (!arguments.tile) tell_note(input.path, unseen_note(*memory, repeated.result, arguments.mode));
  print_picture(arguments, color, repeated.hashes.color);
  if (has_time(arguments)) print_timing(arguments, timing);
  const std::string least = arguments.repeats > 1 ? ", the least of " + std::to_string(arguments.repeats) : "";
  std::printf("host: %.3f s to load, %.3f s to build, %.3f s to render on %s (%.3f s of processor time)%s\n",
              input.load_seconds.wall, repeated.build.wall, repeated.render.wall,
              words_of_count(arguments.threads, "thread").c_str(), repeated.render.processor, least.c_str());
}

}  // namespace gridiron::tool
