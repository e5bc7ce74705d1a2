// render: a scene becomes a picture, and where its cycles and bytes went. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/replay.h>
#include <gridiron/sim/sim_chip.h>
#include <report/report.h>
#include <report/timeline.h>

#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "base/ranks.h"
#include "base/value_bytes.h"
#include "base/words.h"
#include "commands.h"
#include "files/atomic_file.h"
#include "files/command_files.h"
#include "files/image_files.h"
#include "files/input_file.h"
#include "gridiron/device/store_facts.h"
#include "gridiron/frame/divided_frame.h"
#include "gridiron/frame/divided_picture.h"
#include "gridiron/frame/frame_memory.h"
#include "gridiron/frame/frame_pictures.h"
#include "gridiron/frame/requested_frame.h"
#include "gridiron/frame/shared_frame.h"
#include "gridiron/frame/unseen_scene.h"
#include "gridiron/info/worst_of_view.h"
#include "gridiron/scene/effect_names.h"
#include "gridiron/scene/scene_input.h"
#include "gridiron/sweep/sweep_files.h"

namespace gridiron::tool {
namespace {

// Whether the frame left a trace that can be timed: costs are for 4 lanes and whole frames.
bool has_time(const RenderPlan& plan) {
  return plan.mode != sim::Mode::kPlain && plan.lanes == 4 && !plan.tile;
}

const char* word_of(sim::Mode mode) {
  if (mode == sim::Mode::kPlain) return "plain";
  return mode == sim::Mode::kInstrumented ? "instrumented" : "checked";
}

HostTime time_of(const HostSeconds& seconds) {
  return {seconds.wall, seconds.processor};
}

// A frame that was rendered one or more times, always with the same pictures.
struct Repeated {
  DividedFrame frame;
  PlaneHashes hashes;
  HostSeconds build, render;  // the least of all
};

ReportInput collect_report(const RenderPlan& plan, const SceneInput& input, const FrameMemory& frame,
                           const Repeated& repeated, const sim::FrameTiming& timing) {
  const sim::ChipResult& result = repeated.frame.chip;
  ReportInput report;
  report.mode = word_of(plan.mode);
  report.configuration = plan.scene.configuration->name;
  report.is_timed = has_time(plan);
  if (input.text && !input.text->roundness.groups.empty()) {
    report.least_tolerance = input.text->roundness.least_tolerance;
    report.most_tolerance = input.text->roundness.most_tolerance;
  }
  report.triangle_count = frame.image.header.triangle_count;
  report.vertex_count = frame.image.header.vertex_count;
  report.dropped_triangle_count = frame.image.header.dropped_triangle_count;
  report.has_grid = frame.image.has_grid;
  report.grid = frame.image.grid;
  report.wanted_lambda = frame.wanted_lambda;
  report.image_bytes = frame.image.header.image_bytes;
  report.machine = *plan.scene.machine;
  report.timing = timing;
  report.work = result.work;
  for (const std::string_view name : effect_names(frame.image.effects.called_for)) {
    report.effects_called_for.emplace_back(name);
  }
  report.is_scene_shaded = plan.shading == Shading::kScene;
  const std::uint32_t samples = report.is_scene_shaded ? frame.image.effects.samples_per_pixel : 1;
  report.rays = {{"primary", std::uint64_t{plan.width} * plan.height * samples}};
  const StoreFacts store = *find_store_facts(plan.layout);  // it has rendered
  report.arena_bytes = store.arena_bytes;
  report.regions = store.regions;
  report.code_bytes = store.code_bytes;
  report.stack_bytes = store.stack_bytes;
  report.load = time_of(input.load_seconds);
  report.build = time_of(repeated.build);
  report.render = time_of(repeated.render);
  report.host_threads = plan.threads;
  report.lanes = plan.lanes;
  report.repeats = plan.repeats;
  report.trace_bytes = repeated.frame.trace_bytes;
  report.image_hash = repeated.hashes.color;
  if (plan.outputs.depth) report.depth_hash = repeated.hashes.depth;
  if (plan.outputs.ids) report.ids_hash = repeated.hashes.ids;
  return report;
}

// What the worst tile took, and what any may take with this camera.
WorstTiles collect_worst_tiles(const RenderPlan& plan, FrameMemory& frame, const sim::FrameTrace& trace,
                               const sim::FrameTiming& timing) {
  const WorstMeasured measured = find_worst_measured(trace, timing);
  const std::span<const std::byte> image = frame.memory.bytes_at(frame.image_address, frame.image.header.image_bytes);
  sim::MachineProfile machine = *plan.scene.machine;
  machine.core_count = plan.cores;  // that share the channel
  const WorstOfView bound = find_worst_of_view({frame.record, image, plan.layout.store}, machine);
  WorstTiles worst;
  worst.tile[0] = measured.tile % frame.record.tiles_x;
  worst.tile[1] = measured.tile / frame.record.tiles_x;
  worst.bound_tile[0] = bound.tile % frame.record.tiles_x;
  worst.bound_tile[1] = bound.tile / frame.record.tiles_x;
  worst.cycles = measured.cycles;
  worst.bound_cycles = bound.cycles.total();
  worst.gets = measured.gets;
  worst.bound_gets = bound.most_gets;
  worst.get_bytes = measured.get_bytes;
  worst.bound_get_bytes = bound.most_get_bytes;
  worst.time = time_of(bound.seconds);
  return worst;
}

void print_worst_tiles(const WorstTiles& worst) {
  const auto words = [](double cycles) { return words_of_count(static_cast<std::uint64_t>(cycles)); };
  std::printf("worst tile: %s cycles, at most %s with this camera; %s gets of %s bytes, at most %s of %s\n",
              words(worst.cycles).c_str(), words(worst.bound_cycles).c_str(), words_of_count(worst.gets).c_str(),
              words_of_count(worst.get_bytes).c_str(), words_of_count(worst.bound_gets).c_str(),
              words_of_count(worst.bound_get_bytes).c_str());
}

void print_picture(const RenderPlan& plan, const Picture<std::uint32_t>& color, std::uint64_t hash) {
  std::printf("%s: %ux%u, hash %s\n", target_of(*plan.outputs.picture).name.c_str(), color.width, color.height,
              hash_text(hash).c_str());
}

void print_timing(const RenderPlan& plan, const sim::FrameTiming& timing) {
  if (sim::counts_instructions(*plan.scene.machine)) {
    std::printf("%s, %s: %s\n", std::string(plan.scene.machine->name).c_str(),
                words_of_count(timing.cores.size(), "core").c_str(),
                words_of_count(static_cast<std::uint64_t>(timing.frame_cycles), "instruction").c_str());
    return;
  }
  std::printf("%s, %s: %s cycles, %.2f ms, %.2f frames/s; %.2f %% of the cycles wait for DMA\n",
              std::string(plan.scene.machine->name).c_str(), words_of_count(timing.cores.size(), "core").c_str(),
              words_of_count(static_cast<std::uint64_t>(timing.frame_cycles)).c_str(), timing.seconds * 1e3,
              timing.seconds > 0 ? 1 / timing.seconds : 0.0, wait_percent_of(timing));
}

// Shares of the cores' cycles, for scenes with effects. Every eye ray of a pixel has its part in each.
void print_stages(const sim::FrameTiming& timing, std::uint32_t samples) {
  const struct {
    gridiron::Stage stage;
    const char* words;
  } parts[] = {{gridiron::Stage::kPrimary, "eye rays"},          {gridiron::Stage::kSurface, "surfaces"},
               {gridiron::Stage::kShadow, "lights and shadows"}, {gridiron::Stage::kOcclusion, "ambient occlusion"},
               {gridiron::Stage::kBounce, "mirrors and glass"},  {gridiron::Stage::kEnvironment, "environment"}};
  const auto sums = stage_sums(timing.cores);
  const auto cycles_of = [](const sim::StageTiming& stage) { return stage.compute_cycles + stage.wait_cycles; };
  double total = 0;
  for (const sim::StageTiming& stage : sums) total += cycles_of(stage);
  if (!(total > 0)) return;
  std::string line;
  for (const auto& part : parts) {
    const double cycles = cycles_of(sums[static_cast<std::size_t>(part.stage)]);
    if (cycles == 0) continue;
    char words[64];
    std::snprintf(words, sizeof words, "%s%s %.0f %%", line.empty() ? "" : ", ", part.words, 100 * cycles / total);
    line += words;
  }
  std::printf("of these cycles: %s; %s a pixel\n", line.c_str(), words_of_count(samples, "sample").c_str());
}

Picture<std::uint32_t> plane_words(const FrameMemory& frame, const RenderPlan& plan, const sim::MemoryRegion& plane) {
  return words_of_plane(frame.record, plane.bytes, plan.tile);
}

PlaneHashes hashes_of(const FrameMemory& frame, const RenderPlan& plan) {
  const auto hash = [&](const sim::MemoryRegion& plane) {
    return plane.bytes.empty() ? 0 : image_hash(plane_words(frame, plan, plane).pixels);
  };
  return {hash(frame.color), hash(frame.depth), hash(frame.ids)};
}

// Builds and renders as often as requested. A packed scene is not built: it moves into main memory and stays there.
// `replay` is that of render_divided().
Repeated render_repeatedly(std::optional<FrameMemory>& frame, RequestedFrame& requested,
                           const sim::ReplayOptions* replay) {
  const RenderPlan& plan = requested.plan;
  const bool is_packed = std::holds_alternative<PackedScene>(requested.input.content);
  std::optional<Progress> progress;  // begins once the first image is built: the time left is that of tiles
  Repeated repeated;
  for (std::uint32_t repeat = 0; repeat < plan.repeats; ++repeat) {
    if (repeat == 0 || !is_packed) {
      frame.reset();  // before there is another one
      frame.emplace(frame_memory_bytes(requested.input, plan));
      if (is_packed) {
        prepare_frame(*frame, std::move(requested.input), plan, requested.view);
      } else {
        prepare_frame(*frame, requested.input, plan, requested.view);
      }
      share_frame(frame);
    }
    if (!progress) progress.emplace(!plan.scene.quiet, "tiles");
    const Stopwatch stopwatch;
    const auto report = [&](std::uint32_t done, std::uint32_t total) {
      progress->update(std::uint64_t{repeat} * total + done, std::uint64_t{plan.repeats} * total);
    };
    repeated.frame = render_divided(*frame, plan, replay, report);
    const HostSeconds render = stopwatch.both();
    const PlaneHashes hashes = hashes_of(*frame, plan);
    repeated.build = repeat == 0 ? frame->build_seconds : repeated.build.least(frame->build_seconds);
    repeated.render = repeat == 0 ? render : repeated.render.least(render);
    if (repeat == 0) repeated.hashes = hashes;
    require_same_planes(repeated.hashes, hashes, repeat + 1);
  }
  return repeated;
}

// All ranks call it. @param trace  of rank 0.
std::vector<SweepFigures> sweep(const RenderRequest& request, const RenderPlan& plan, sim::FrameTrace& trace) {
  if (request.varied.empty()) return {};
  sim::MachineProfile base = *request.scene.machine;
  base.core_count = plan.cores;
  return replay_sweep(trace, base, request.varied, request.threads.value_or(this_host().threads), request.scene.quiet);
}

void give_plan(const RequestedFrame& requested) {
  if (ranks().count() == 1) return;
  ByteWriter writer;
  add_plan(writer, requested.plan);
  writer.add(std::holds_alternative<PackedScene>(requested.input.content));
  Bytes bytes = writer.take();
  ranks().broadcast(bytes);
}

// The part of another rank than 0, step by step as render_repeatedly() and what follows it.
void render_for_first(const RenderRequest& request) {
  Bytes bytes;
  ranks().broadcast(bytes);
  ByteReader reader(bytes);
  const RenderPlan plan = take_plan(reader, request);
  const bool is_packed = reader.take<bool>();
  std::optional<FrameMemory> frame;
  for (std::uint32_t repeat = 0; repeat < plan.repeats; ++repeat) {
    if (repeat == 0 || !is_packed) share_frame(frame);
    (void)render_divided(*frame, plan, nullptr, [](std::uint32_t, std::uint32_t) {});
  }
  frame.reset();
  sim::FrameTrace trace;
  (void)sweep(request, plan, trace);
  encode_for_first(plan.threads);
}

}  // namespace

void run_command(const RenderRequest& request) {
  if (!ranks().is_first()) return render_for_first(request);
  const StageLines stages(!request.scene.quiet);
  RequestedFrame requested = read_requested_frame(request, request.named_outputs().declared());
  const SceneInput& input = requested.input;
  const RenderPlan& plan = requested.plan;
  const FrameOutputs& outputs = plan.outputs;
  give_plan(requested);
  std::optional<FrameMemory> memory;
  const sim::ReplayOptions replay = {.core_count = plan.cores,
                                     .timeline = outputs.timeline.has_value() || plan.has_bound};
  // A bound is compared with the traces, and a sweep replays them again.
  const bool keeps_traces = plan.has_bound || !plan.varied.empty();
  Repeated repeated = render_repeatedly(memory, requested, has_time(plan) && !keeps_traces ? &replay : nullptr);
  const FrameMemory& frame = *memory;
  const Picture<std::uint32_t> color = plane_words(frame, plan, frame.color);
  sim::FrameTiming timing;
  std::optional<WorstTiles> worst;
  if (has_time(plan)) {
    const sim::FrameTrace& trace = repeated.frame.chip.trace;
    timing =
        repeated.frame.timing ? std::move(*repeated.frame.timing) : sim::replay(trace, *plan.scene.machine, replay);
    if (plan.has_bound) worst = collect_worst_tiles(plan, *memory, trace, timing);
  }

  const std::vector<SweepFigures> swept = sweep(request, plan, repeated.frame.chip.trace);

  AtomicFiles files;
  files.add(*outputs.picture, name_in_shortage(plan.scene.input, "encode its picture",
                                               [&] { return encode_divided(color, *outputs.picture, plan.threads); }));
  if (outputs.depth) {
    files.add(*outputs.depth, encode_pfm(depth_picture(plane_words(frame, plan, frame.depth))));
  }
  if (outputs.ids) files.add(*outputs.ids, encode_pfm(id_picture(plane_words(frame, plan, frame.ids))));
  if (outputs.report) {
    ReportInput report = collect_report(plan, input, frame, repeated, timing);
    report.worst_tiles = worst;
    files.add(*outputs.report, report_json(report));
  }
  if (outputs.timeline) files.add(*outputs.timeline, timeline_json(timing, *plan.scene.machine));
  if (outputs.sweep) files.add(*outputs.sweep, sweep_csv(plan.varied, swept));
  if (outputs.sweep_plot) {
    const std::string title = input.path.filename().string() + ", " + std::to_string(plan.width) + "x" +
                              std::to_string(plan.height) + ", " + std::string(plan.scene.configuration->name) + ", " +
                              std::string(plan.scene.machine->name);
    files.add(*outputs.sweep_plot, sweep_svg(plan.varied, swept, title));
  }
  files.commit_at_end();

  if (plan.scene.quiet) return;
  if (!plan.tile) tell_note(input.path, unseen_note(*memory, repeated.frame.chip, plan.mode));
  print_picture(plan, color, repeated.hashes.color);
  if (has_time(plan)) print_timing(plan, timing);
  if (has_time(plan) && plan.shading == Shading::kScene) print_stages(timing, frame.image.effects.samples_per_pixel);
  if (worst) print_worst_tiles(*worst);
  const std::string least = plan.repeats > 1 ? ", the least of " + std::to_string(plan.repeats) : "";
  std::printf("host: %.3f s to load, %.3f s to build, %.3f s to render on %s (%.3f s of processor time)%s\n",
              input.load_seconds.wall, repeated.build.wall, repeated.render.wall,
              words_of_count(plan.threads, "thread").c_str(), repeated.render.processor, least.c_str());
  if (!swept.empty()) {
    const OutputTarget target = target_of(outputs.sweep ? *outputs.sweep : *outputs.sweep_plot);
    std::printf("%s: %s\n", target.name.c_str(), words_of_sweep(swept).c_str());
  }
}

}  // namespace gridiron::tool
