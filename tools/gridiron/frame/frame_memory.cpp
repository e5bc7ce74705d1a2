// Frame memory. SPDX-License-Identifier: Apache-2.0
#include "frame_memory.h"

#include <gridiron/build/tree/tree_builder.h>
#include <gridiron/sim/host_team.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <new>

#include "base/failure.h"
#include "base/words.h"
#include "frame_pictures.h"
#include "gridiron/device/store_facts.h"
#include "gridiron/scene/scene_points.h"
#include "view_bounds.h"

namespace gridiron::tool {
namespace {

// Allocates from the machine's main memory. @param input  the scene, for messages.
sim::MemoryRegion allocate(sim::SimMemory& memory, const std::filesystem::path& input, std::uint64_t bytes,
                           std::uint64_t alignment = kLineBytes) {
  try {
    const std::optional<sim::MemoryRegion> region = memory.allocate(bytes, alignment);
    if (region) return *region;
  } catch (const std::bad_alloc&) {
    input_error(input, "this host has not enough memory: the machine's main memory needs " + words_of_bytes(bytes) +
                           " more for the frame");
  }
  input_error(input, "the main memory of " + words_of_bytes(memory.capacity_bytes()) + " is full");
}

// Depth of recursion of waiting rays, 1 without any.
std::uint32_t waiting_depth(const SceneInput& input, const RenderPlan& plan) {
  return plan.shading == Shading::kScene ? recursion_depth(input) : 1;
}

// Puts the scene image into main memory. @param movable  the packed scene's bytes if they may move; else null. @returns
// its address.
MainAddress place_image(FrameMemory& frame, const SceneInput& input, const RenderPlan& plan, std::uint64_t budget_bytes,
                        InputFile* movable) {
  const ImageLimits limits = {format_of(plan.accuracy), budget_bytes, plan.most_macro_width, plan.engine,
                              find_store_facts(plan.layout)->leaf_triangles};
  if (const PackedScene* packed = std::get_if<PackedScene>(&input.content)) {
    check_packed(input, *packed, plan.scene, limits);
    const std::uint64_t image_bytes = packed->view.header.image_bytes;
    const sim::MemoryRegion region = allocate(frame.memory, input.path, image_bytes);
    if (movable != nullptr) {
      move_bytes(movable->bytes.first(image_bytes), region.bytes.data());
      *movable = {};
    } else {
      std::memcpy(region.bytes.data(), packed->file.bytes.data(), image_bytes);
    }
    frame.image = packed->view;
    frame.wanted_lambda = packed->view.grid.lambda;
    return region.address;
  }
  const Stopwatch stopwatch;
  frame.ground_begin = input.ground_begin;
  const Mesh& mesh = std::get<Mesh>(input.content);
  EffectsView view;
  const EffectsView* effects = nullptr;
  if (plan.shading == Shading::kScene) {
    view = input.effects->view();
    effects = &view;
  }
  sim::HostTeam team(mesh.triangles.size() < kManyTreeTriangles ? 1 : plan.threads);
  const WorkSharing sharing = team.sharing();
  const GridChoice choice = choose_grid(input, mesh, plan.scene, limits, effects, sharing);
  require_fit(choice, plan.scene, input);
  const sim::MemoryRegion region = allocate(frame.memory, input.path, choice.need.image_bytes);
  frame.image = plan.builder == Builder::kCores ? build_on_cores(frame.memory, input, mesh, plan, choice, region,
                                                                 frame.vertex_order, effects, frame.cores_build)
                                                : build_image(input, mesh, choice, region.bytes, effects, sharing);
  frame.need = choice.need;
  frame.wanted_lambda = choice.wanted_lambda;
  frame.build_seconds = stopwatch.both();
  return region.address;
}

// A sweep replays the trace of one image. Where its machines have other numbers of cores, the rays that wait leave more
// or less of the main memory to the image.
void require_same_image(const FrameMemory& frame, const RenderPlan& plan, std::uint64_t budget_bytes,
                        const std::function<std::uint64_t(std::uint32_t cores)>& budget_of) {
  // A packed scene needs what it has; one that is built may need more than it has in the end.
  const std::uint64_t image_bytes = std::max(frame.need.image_bytes, frame.image.header.image_bytes);
  const bool is_reduced = frame.image.has_grid && frame.image.grid.lambda != frame.wanted_lambda;
  for (const std::uint32_t cores : varied_core_counts(plan.varied)) {
    const std::uint64_t budget = budget_of(cores);
    if (image_bytes <= budget && (!is_reduced || budget == budget_bytes)) continue;
    usage_error("--vary: with 'core_count' " + std::to_string(cores) + " the rays that wait leave " +
                words_of_bytes(budget) + " of main memory to the scene, whose image of " + words_of_bytes(image_bytes) +
                " would not fit or would be another: render it for each value, with --machine");
  }
}

// Makes the frame record from the settings. @param source  the scene, for messages.
void make_record(FrameMemory& frame, const std::filesystem::path& source) {
  const Status status = make_frame_record(frame.settings, frame.image, frame.image_address, frame.record);
  if (status == Status::kBadFrame) {
    usage_error("view: no camera can be made of it for " + source.string() +
                "; eye, at, up, fov or the scene's bounds are extreme");
  }
  if (status != Status::kOk) input_error(source, words_of(status));
}

// Without bounds `best` decides every pixel exactly, which seems to hang.
void tell_if_unbounded(const FrameMemory& frame, const RenderPlan& plan, const std::filesystem::path& source) {
  if (plan.engine != EngineId::kTree || plan.scene.quiet) return;
  if (has_bounds(frame.record, frame.image.tree, plan)) return;
  std::fprintf(stderr,
               "%s: pixels too small or a scene too large or small for the bounds of configuration best: it decides "
               "every pixel exactly, which takes up to 100,000 times as long; --configuration grid does not\n",
               source.c_str());
}

void store_record(FrameMemory& frame) {
  const std::span<std::byte> bytes = frame.memory.bytes_at(frame.record_address, sizeof(FrameRecord));
  std::memcpy(bytes.data(), &frame.record, sizeof(FrameRecord));
}

}  // namespace

PointSource points_of(FrameMemory& frame) {
  return [&frame](const PointVisitor& visitor) {
    visit_points(frame.image, frame.memory.bytes_at(frame.image_address, frame.image.header.image_bytes), visitor,
                 frame.ground_begin);
  };
}

namespace {

void prepare(FrameMemory& frame, const SceneInput& input, const RenderPlan& plan, const ViewRequest& view,
             InputFile* movable) {
  const std::uint32_t depth = waiting_depth(input, plan);
  const std::uint32_t planes = 1u + (plan.has_depth ? 1u : 0u) + (plan.has_ids ? 1u : 0u);
  const auto budget_of = [&](std::uint32_t cores) {
    return image_budget_bytes(*plan.scene.machine, plan.width, plan.height, planes, plan.layout.tile_width,
                              spill_bytes_of(cores, depth));
  };
  const std::uint64_t budget_bytes = budget_of(plan.cores);
  frame.image_address = place_image(frame, input, plan, budget_bytes, movable);
  require_same_image(frame, plan, budget_bytes, budget_of);

  // A PFM file stores ids as floats.
  if (plan.outputs.ids) require_exact_ids(input.path, frame.image.header.triangle_count);

  FrameSettings& settings = frame.settings;
  // An image of unchanged vertices has the points of its mesh, which has each of them once.
  const Mesh* mesh = std::get_if<Mesh>(&input.content);
  const bool is_exact = format_of(plan.accuracy) == TriangleFormat::kVertices;
  const PointSource points = mesh != nullptr && is_exact
                                 ? [mesh](const PointVisitor& visitor) { visit_points(mesh->view(), visitor); }
                                 : points_of(frame);
  settings.camera = complete_view(view, static_cast<double>(plan.width) / plan.height, points);
  settings.width = plan.width;
  settings.height = plan.height;
  settings.tile_width = plan.layout.tile_width;
  settings.accuracy = plan.accuracy;
  settings.shading = plan.shading;
  settings.engine = plan.engine;
  settings.techniques = plan.techniques;
  settings.output_depth = plan.depths.output;
  settings.macro_depth = plan.depths.macro;
  settings.triangle_depth = plan.depths.triangle;
  settings.fetch_depth = plan.depths.fetch;

  const std::uint64_t plane_bytes = output_plane_bytes(settings.width, settings.height, settings.tile_width);
  frame.color = allocate(frame.memory, input.path, plane_bytes);
  if (plan.has_depth) frame.depth = allocate(frame.memory, input.path, plane_bytes);
  if (plan.has_ids) frame.ids = allocate(frame.memory, input.path, plane_bytes);
  settings.color = frame.color.address;
  settings.depth = frame.depth.address;
  settings.ids = frame.ids.address;

  frame.spill_bytes_per_core = spill_bytes(depth);
  if (frame.spill_bytes_per_core != 0) {
    const std::uint32_t threads = std::max(plan.threads, 1u);
    frame.spill = allocate(frame.memory, input.path, threads * frame.spill_bytes_per_core, kSpillAlignment);
  }

  make_record(frame, input.path);
  tell_if_unbounded(frame, plan, input.path);
  frame.record_address = allocate(frame.memory, input.path, sizeof(FrameRecord)).address;
  store_record(frame);
}

}  // namespace

std::uint64_t frame_memory_bytes(const SceneInput& input, const RenderPlan& plan) {
  const std::uint32_t more = plan.threads > plan.cores ? plan.threads - plan.cores : 0;
  return plan.scene.machine->main_memory_bytes + more * spill_bytes(waiting_depth(input, plan));
}

void prepare_frame(FrameMemory& frame, const SceneInput& input, const RenderPlan& plan, const ViewRequest& view) {
  prepare(frame, input, plan, view, nullptr);
}

void prepare_frame(FrameMemory& frame, SceneInput&& input, const RenderPlan& plan, const ViewRequest& view) {
  PackedScene* packed = std::get_if<PackedScene>(&input.content);
  prepare(frame, input, plan, view, packed != nullptr ? &packed->file : nullptr);
}

void aim_camera(FrameMemory& frame, const Camera& camera, const std::filesystem::path& source) {
  frame.settings.camera = camera;
  make_record(frame, source);
  store_record(frame);
}

}  // namespace gridiron::tool
