// What both kinds of animations do. SPDX-License-Identifier: Apache-2.0
#include "frame_maker.h"

#include <gridiron/sim/replay.h>
#include <report/report.h>
#include <report/timeline.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>

#include "base/content_hash.h"
#include "base/failure.h"
#include "base/words.h"
#include "files/image_files.h"
#include "gridiron/frame/chip_frame.h"
#include "gridiron/frame/frame_pictures.h"
#include "gridiron/frame/unseen_scene.h"

namespace gridiron::tool {
namespace {

bool is_ply(const std::filesystem::path& path) {
  return path.extension() == ".ply" || path.extension() == ".PLY";
}

// The meshes of a folder, or its text scenes, by name.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> meshes, models, scenes;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const SceneKind kind = scene_kind_by_ending(entry->path());
    if (kind == SceneKind::kMesh) (is_ply(entry->path()) ? meshes : models).push_back(entry->path());
    if (kind == SceneKind::kText) scenes.push_back(entry->path());
  }
  if (error) input_error(folder, "cannot be read: " + error.message());
  if (meshes.empty()) meshes = std::move(models);  // else those it was converted from, perhaps
  if (meshes.empty() && scenes.empty()) input_error(folder, "holds no mesh, no model and no text scene");
  if (!meshes.empty() && !scenes.empty()) {
    input_error(folder, "holds files that end with .ply and with .nff; name the ones that are frames");
  }
  std::vector<std::filesystem::path>& files = meshes.empty() ? scenes : meshes;
  std::ranges::sort(files);
  return std::move(files);
}

// Build and picture, one behind the other.
std::string timeline_of(const CoresBuild& build, const RenderPlan& plan, const sim::FrameTiming& picture) {
  const sim::MachineProfile& machine = *plan.scene.machine;
  if (build.passes.empty()) return timeline_json(picture, machine);
  sim::PassesTiming timing = sim::replay_passes(build.passes, machine, plan.cores, /*timeline=*/true);
  sim::PassTiming& master = timing.passes.emplace_back();
  master.name = kMasterPass;
  master.run.frame_cycles = cycles_of_master(build, machine);
  master.cycles = master.run.frame_cycles;
  timing.passes.push_back(sim::timing_of_pass("picture", picture, machine));
  return passes_timeline_json(timing.passes, machine);
}

}  // namespace

std::string numbered_picture(std::size_t i, std::size_t count) {
  const std::size_t digits = std::max<std::size_t>(4, std::to_string(count - 1).size());
  const std::string number = std::to_string(i);
  return "frame" + std::string(digits - number.size(), '0') + number + ".png";
}

std::unique_ptr<FrameMaker> make_frame_maker(const AnimateRequest& request) {
  std::vector<std::filesystem::path> inputs;
  for (const std::filesystem::path& input : request.inputs) {
    std::error_code error;
    if (!std::filesystem::is_directory(input, error)) {
      inputs.push_back(input);
      continue;
    }
    for (std::filesystem::path& file : files_of(input)) inputs.push_back(std::move(file));
  }
  if (!request.has_moving_camera()) return make_series(request, std::move(inputs));
  if (inputs.size() != 1) {
    usage_error(std::string(request.path ? "--path" : "--turntable") +
                ": moves the camera around one mesh or scene; these are " + words_of_count(inputs.size()));
  }
  return make_camera_move(request, inputs.front());
}

void check_foreseen(const AnimateRequest& request, const std::filesystem::path& input) {
  RenderRequest frame = request.render;
  frame.scene.input = input;
  const KnownScene scene = foreseen_scene(frame.scene);
  if (scene.kind == SceneKind::kUnknown) return;
  RenderPlan plan = resolve(frame, scene, this_host());
  if (scene.kind != SceneKind::kPacked) choose_builder(request, plan);
}

void choose_builder(const AnimateRequest& request, RenderPlan& plan) {
  if (request.builder == Builder::kMaster || plan.mode == sim::Mode::kPlain) return;
  if (cores_can_build(plan)) {
    plan.builder = Builder::kCores;
  } else if (request.builder == Builder::kCores) {
    usage_error(plan.engine == EngineId::kTree
                    ? "--build cores: builds trees of vertices as they are, not of --accuracy compact"
                    : "--build cores: builds trees; configuration " + std::string(plan.scene.configuration->name) +
                          " reads a grid, which the general core builds");
  }
}

std::uint64_t hash_of_view(const Camera& camera, std::uint32_t width, std::uint32_t height) {
  const float floats[] = {camera.eye.x, camera.eye.y, camera.eye.z, camera.at.x, camera.at.y,
                          camera.at.z,  camera.up.x,  camera.up.y,  camera.up.z, camera.tan_half_fov};
  const std::uint64_t values[] = {content_hash(std::as_bytes(std::span(floats))), width, height};
  return content_hash(std::as_bytes(std::span(values)));
}

Camera camera_of(const ViewRequest& view, std::uint32_t width, std::uint32_t height) {
  const PointSource no_points = [](const PointVisitor&) {};  // nothing is left to be framed
  return complete_view(view, static_cast<double>(width) / height, no_points);
}

MadeFrame render_frame(FrameMemory& memory, const RenderPlan& plan, std::uint64_t content,
                       const std::optional<BuildCost>& build, bool has_timeline, const FrameProgress& progress) {
  const auto of_tiles = [&progress](std::uint32_t done, std::uint32_t total) {
    progress(static_cast<double>(done) / total);
  };
  const sim::ChipResult result = render_on_chip(memory, plan, of_tiles);
  MadeFrame made;
  made.source = {content, hash_of_view(memory.settings.camera, plan.width, plan.height)};
  made.figures.triangles = memory.image.header.triangle_count;
  if (memory.image.has_grid) made.figures.lambda = memory.image.grid.lambda;
  made.figures.is_timed = plan.mode != sim::Mode::kPlain;
  if (made.figures.is_timed) {
    const sim::FrameTiming timing =
        sim::replay(result.trace, *plan.scene.machine, {.core_count = plan.cores, .timeline = has_timeline});
    made.figures.build = build;
    if (build && build->builder == Builder::kCores) add_picture(timing, *plan.scene.machine, *made.figures.build);
    made.figures.render_cycles = timing.frame_cycles;
    made.figures.render_seconds = timing.seconds;
    if (has_timeline) made.timeline = timeline_of(memory.cores_build, plan, timing);
  }
  const Picture<std::uint32_t> color = words_of_plane(memory.record, memory.color.bytes);
  made.figures.hash = image_hash(color.pixels);
  made.png = encode_png(color, plan.threads);
  if (!plan.scene.quiet) made.note = unseen_note(memory, result, plan.mode);
  return made;
}

}  // namespace gridiron::tool
