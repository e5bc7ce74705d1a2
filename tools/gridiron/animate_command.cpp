// animate: one frame for each mesh, with a new scene image each, and its cost. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/build_work.h>
#include <gridiron/sim/replay.h>
#include <report/report.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/failure.h"
#include "base/numbers.h"
#include "base/progress.h"
#include "base/words.h"
#include "commands.h"
#include "files/atomic_file.h"
#include "files/command_files.h"
#include "files/image_files.h"
#include "files/interrupt.h"
#include "files/output_folder.h"
#include "gridiron/frame/chip_frame.h"
#include "gridiron/frame/frame_memory.h"
#include "gridiron/frame/frame_pictures.h"
#include "gridiron/frame/unseen_scene.h"
#include "gridiron/scene/scene_input.h"
#include "gridiron/scene/scene_points.h"

namespace gridiron::tool {
namespace {

constexpr const char* kTableName = "animation.csv";

struct AnimationFrame {
  std::filesystem::path input;
  std::string picture{};             ///< file name
  std::optional<SceneInput> mesh{};  ///< of a stream, which is read once
  std::uint64_t triangles = 0;
  float lambda = 0;
  bool has_grid = true;
  bool is_build_counted = true;                  ///< false: through the tree, of whose build nothing is counted yet
  double build_cycles = 0, build_seconds = 0;    ///< of the machine's general core; 0 where it is not counted
  double render_cycles = 0, render_seconds = 0;  ///< of its cores
  std::uint64_t hash = 0;

  [[nodiscard]] double seconds() const { return build_seconds + render_seconds; }
  [[nodiscard]] double fps() const { return seconds() > 0 ? 1 / seconds() : 0; }
};

constexpr const char* kExpectedMeshes = "animate takes PLY meshes and folders of .ply files";

void require_mesh(const std::filesystem::path& path, SceneKind kind) {
  if (kind != SceneKind::kText && kind != SceneKind::kPacked) return;
  input_error(path,
              std::string("is a ") + (kind == SceneKind::kText ? "text" : "packed") + " scene; " + kExpectedMeshes);
}

SceneInput read_mesh(const std::filesystem::path& path) {
  SceneInput input = read_scene_input(path, std::nullopt, std::nullopt, kExpectedMeshes);
  const bool is_packed = std::holds_alternative<PackedScene>(input.content);
  require_mesh(path, input.text ? SceneKind::kText : is_packed ? SceneKind::kPacked : SceneKind::kMesh);
  return input;
}

// Folders contribute their .ply files by name. Pictures are named after the meshes; those of streams by their number.
std::vector<AnimationFrame> collect_frames(const AnimateRequest& request) {
  std::vector<AnimationFrame> frames;
  for (const std::filesystem::path& input : request.inputs) {
    std::error_code error;
    if (!std::filesystem::is_directory(input, error)) {
      require_mesh(input, foreseen_kind(input));
      frames.push_back({.input = input});
      continue;
    }
    std::vector<std::filesystem::path> files;
    for (std::filesystem::directory_iterator entry(input, error), end; !error && entry != end; entry.increment(error)) {
      if (scene_kind_by_ending(entry->path()) == SceneKind::kMesh) files.push_back(entry->path());
    }
    if (error) input_error(input, "cannot be read: " + error.message());
    if (files.empty()) input_error(input, std::string("holds no file that ends with .ply; ") + kExpectedMeshes);
    std::ranges::sort(files);
    for (const std::filesystem::path& file : files) frames.push_back({.input = file});
  }
  std::set<std::string> pictures;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    AnimationFrame& frame = frames[i];
    frame.picture = (is_descriptor(frame.input) ? "frame" + std::to_string(i) : frame.input.stem().string()) + ".png";
    if (!pictures.insert(frame.picture).second) {
      usage_error("two frames would be called " + frame.picture);
    }
  }
  return frames;
}

// One camera for all frames; parts that are not given frame all of them together.
ViewRequest common_view(std::vector<AnimationFrame>& frames, const RenderRequest& request, const RenderPlan& plan) {
  ViewRequest view = join_view(request.view, request.camera ? read_camera_file(*request.camera) : ViewRequest{});
  if (view.eye && view.at) return view;
  const PointSource points = [&frames](const PointVisitor& visitor) {
    for (AnimationFrame& frame : frames) {
      stop_if_interrupted();
      SceneInput input = frame.mesh ? *std::exchange(frame.mesh, std::nullopt) : read_mesh(frame.input);
      const MeshView mesh = std::get<Mesh>(input.content).view();
      GridNeed need{};
      const Status status = count_scene_image(mesh, {.lambda = 1e-6f}, need);  // rejects meshes that cannot be rendered
      if (status != Status::kOk) input_error(frame.input, words_of(status));
      visit_points(mesh, visitor);
      if (is_stream(frame.input)) frame.mesh = std::move(input);
    }
  };
  const Camera camera = complete_view(view, static_cast<double>(plan.width) / plan.height, points);
  view.eye = camera.eye;
  view.at = camera.at;
  view.up = camera.up;
  return view;
}

void render(AnimationFrame& frame, RenderPlan plan, const ViewRequest& view, const std::filesystem::path& folder) {
  plan.scene.input = frame.input;
  const SceneInput input = frame.mesh ? *std::exchange(frame.mesh, std::nullopt) : read_mesh(frame.input);
  const Mesh& mesh = std::get<Mesh>(input.content);
  FrameMemory memory(frame_memory_bytes(input, plan));
  prepare_frame(memory, input, plan, view);
  const sim::ChipResult result = render_on_chip(memory, plan, {});

  const sim::MachineProfile& machine = *plan.scene.machine;
  const sim::FrameTiming timing = sim::replay(result.trace, machine, {.core_count = plan.cores});
  frame.triangles = mesh.triangles.size();
  frame.lambda = memory.image.grid.lambda;
  frame.has_grid = memory.image.has_grid;
  frame.is_build_counted = plan.scene.configuration->has_grid();
  if (frame.is_build_counted) {
    const sim::BuildWork build = sim::grid_build_work(mesh.vertices.size(), mesh.triangles.size(), memory.need,
                                                      sim::count_mesh_lines(mesh.view()));
    frame.build_cycles = sim::build_cycles(machine.master, build);
    frame.build_seconds = sim::build_seconds(machine.master, build);
  }
  frame.render_cycles = timing.frame_cycles;
  frame.render_seconds = timing.seconds;

  const auto color = words_of_plane(memory.record, memory.color.bytes);
  frame.hash = image_hash(color.pixels);
  AtomicFiles file;
  file.add(folder / frame.picture, encode_png(color));
  file.commit();
  if (!plan.scene.quiet) tell_note(frame.input, unseen_note(memory, result, plan.mode));
}

// Fields of a build that is not counted are empty.
std::string table_of(const std::vector<AnimationFrame>& frames, const sim::MachineProfile& machine) {
  std::string table =
      "frame,mesh,triangles,lambda,build_cycles,render_cycles,total_cycles,build_seconds,render_seconds,seconds,fps,"
      "hash\n";
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const AnimationFrame& frame = frames[i];
    // The general core may have another clock; the total is in cycles of the cores.
    const double total_cycles = frame.build_seconds * machine.clock_hz + frame.render_cycles;
    const auto of_build = [&frame](double value) { return frame.is_build_counted ? shortest_text(value) : ""; };
    for (const std::string& field :
         {shortest_text(i), in_csv(frame.input.filename().string()), shortest_text(frame.triangles),
          frame.has_grid ? shortest_text(frame.lambda) : std::string(), of_build(frame.build_cycles),
          shortest_text(frame.render_cycles), shortest_text(total_cycles), of_build(frame.build_seconds),
          shortest_text(frame.render_seconds), shortest_text(frame.seconds()), shortest_text(frame.fps())}) {
      table += field + ",";
    }
    table += hash_text(frame.hash) + "\n";
  }
  return table;
}

void print_frames(const std::vector<AnimationFrame>& frames, const RenderPlan& plan) {
  const auto cycles = [](double count) { return words_of_count(static_cast<std::uint64_t>(count)); };
  std::printf("%-24s %14s %14s %9s\n", "frame", "build cycles", "render cycles", "frames/s");
  double seconds = 0;
  for (const AnimationFrame& frame : frames) {
    std::printf("%-24s %14s %14s %9.2f\n", frame.picture.c_str(),
                frame.is_build_counted ? cycles(frame.build_cycles).c_str() : "not counted",
                cycles(frame.render_cycles).c_str(), frame.fps());
    seconds += frame.seconds();
  }
  const char* builds = plan.scene.configuration->has_grid()
                           ? "with their builds"
                           : "without their builds; --configuration grid counts these too";
  std::printf("%s, %s: %s in %.2f ms, %.2f frames/s %s\n", std::string(plan.scene.machine->name).c_str(),
              words_of_count(plan.cores, "core").c_str(), words_of_count(frames.size(), "frame").c_str(), seconds * 1e3,
              seconds > 0 ? static_cast<double>(frames.size()) / seconds : 0.0, builds);
}

}  // namespace

void run_command(const AnimateRequest& request) {
  const RenderPlan plan = resolve(request.render, {.kind = SceneKind::kMesh}, this_host());
  const bool quiet = plan.scene.quiet;
  std::vector<AnimationFrame> frames = collect_frames(request);
  std::vector<std::string> names = {kTableName};
  for (const AnimationFrame& frame : frames) names.push_back(frame.picture);
  OutputFolder folder(request.output, names);
  // Noted before any picture is written, because a picture must not overwrite a later frame's mesh.
  for (const AnimationFrame& frame : frames) note_input(frame.input);
  const ViewRequest view = [&] {
    const StageLines stages(!quiet);
    return common_view(frames, request.render, plan);
  }();
  {
    Progress progress(!quiet, "frames");
    const auto total = static_cast<std::uint32_t>(frames.size());
    for (std::uint32_t i = 0; i < total; ++i) {
      progress.update(i, total);
      render(frames[i], plan, view, request.output);
    }
  }
  AtomicFiles table;
  table.add(request.output / kTableName, table_of(frames, *plan.scene.machine));
  table.commit_at_end();
  folder.keep();
  if (!quiet) print_frames(frames, plan);
}

}  // namespace gridiron::tool
