// Tree building. SPDX-License-Identifier: Apache-2.0
#include "tree_building.h"

#include <gridiron/build/passes/build_passes.h>
#include <gridiron/sim/build_pass_work.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include "base/failure.h"
#include "base/progress.h"
#include "base/words.h"
#include "files/interrupt.h"
#include "frame_failure.h"
#include "gridiron/device/accuracies.h"

namespace gridiron::tool {
namespace {

sim::MainRange range_of(const sim::MemoryRegion& region) {
  return {region.address.value, region.address.value + region.bytes.size()};
}

// Main memory for a build; where there is not enough, the message names the way out.
class BuildMemory {
 public:
  BuildMemory(sim::SimMemory& memory, const std::filesystem::path& input) : memory_(memory), input_(input) {}

  [[nodiscard]] sim::MemoryRegion allocate(std::uint64_t bytes) {
    try {
      const std::optional<sim::MemoryRegion> region = memory_.allocate(bytes);
      if (region) return *region;
    } catch (const std::bad_alloc&) {
      input_error(input_, "this host has not enough memory to build its tree on the cores");
    }
    input_error(input_, "the main memory of " + words_of_bytes(memory_.capacity_bytes()) +
                            " is full: to build its tree the cores need " + words_of_bytes(bytes) +
                            " more; --build master needs none");
  }

 private:
  sim::SimMemory& memory_;
  const std::filesystem::path& input_;
};

// Writes the mesh as the cores read it.
void place_mesh(const Mesh& mesh, std::optional<VertexOrder>* order, BuildMemory& memory, BuildInput& build) {
  constexpr std::uint64_t kReadBehind = 16;  // bytes
  const sim::MemoryRegion vertices = memory.allocate(mesh.vertices.size() * sizeof(Vec3) + kReadBehind);
  const sim::MemoryRegion triangles = memory.allocate(mesh.triangles.size() * sizeof(UVec3) + kReadBehind);
  build.vertices = vertices.address;
  build.triangles = triangles.address;
  if (order != nullptr) {
    if (!*order || !(*order)->is_of(mesh)) order->emplace(mesh);
    (*order)->place(mesh, reinterpret_cast<Vec3*>(vertices.bytes.data()),
                    reinterpret_cast<UVec3*>(triangles.bytes.data()));
    return;
  }
  std::ranges::copy(std::as_bytes(std::span(mesh.vertices)), vertices.bytes.begin());
  std::ranges::copy(std::as_bytes(std::span(mesh.triangles)), triangles.bytes.begin());
}

// All passes of a plan. @param writable  of each of them.
template <class Layout>
std::vector<sim::Pass> passes_of(const BuildPlan& plan, const std::vector<sim::MainRange>& writable) {
  std::vector<sim::Pass> passes;
  for (std::uint32_t i = 0; i < kBuildPassCount; ++i) {
    const auto pass = static_cast<BuildPass>(i);
    sim::ItemCount items{.most = plan.item_counts[i]};
    constexpr std::uint64_t kCounted = ~std::uint32_t{0};
    if (pass == BuildPass::kCheck && plan.input.image_room <= kCounted) {
      items.address = plan.input.image.offset_by(offsetof(ImageHeader, image_bytes));
      items.per_item = ImageCheckValue::kPieceBytes;
    }
    passes.push_back({.name = sim::name_of(pass),
                      .items = items,
                      .data_bytes = sizeof(BuildStore<Layout>),
                      .writable = writable,
                      .kernel = sim::PassKernel([&plan, pass](auto& core, std::span<std::byte> data) {
                        return run_build_pass(core, *reinterpret_cast<BuildStore<Layout>*>(data.data()), plan, pass);
                      }),
                      .engine = &sim::work_of(pass)});
  }
  return passes;
}

// Runs the passes; `input` has all addresses but that of scratch memory.
template <class Layout>
void run_build(sim::SimMemory& main_memory, BuildMemory& memory, const SceneInput& scene, const RenderPlan& plan,
               BuildInput input, const sim::MemoryRegion& image, CoresBuild& build) {
  const sim::MemoryRegion result = memory.allocate(sizeof(BuildResult));
  input.result = result.address;
  const sim::MemoryRegion scratch = memory.allocate(build_scratch_bytes<Layout>(input));
  input.scratch = scratch.address;
  BuildPlan build_plan{};
  if (const Status status = plan_build<Layout>(input, build_plan); status != Status::kOk) {
    input_error(scene.path, std::string("cannot build its tree on the cores: ") + words_of(status));
  }
  sim::ChipOptions options;
  options.threads = plan.threads;
  options.store = plan.layout.store;
  options.completion = plan.completion;
  options.seed = plan.seed;
  options.limits.queue_depth = plan.scene.machine->queue_depth;
  options.abort = &interrupt_flag();
  const std::vector<sim::Pass> passes =
      passes_of<Layout>(build_plan, {range_of(image), range_of(result), range_of(scratch)});
  sim::PassesResult run = sim::run_passes(main_memory, passes, options);
  stop_if_interrupted();
  for (const sim::PassRun& pass : run.passes) {
    if (const std::optional<Failure> failure = frame_failure(pass.result, scene.path)) {
      throw Failure(failure->code(), "pass " + std::string(pass.name) + " of the build: " + failure->what());
    }
  }
  auto& header = *reinterpret_cast<ImageHeader*>(image.bytes.data());
  const std::uint32_t pieces = run.passes.back().items;
  const std::span<const std::byte> checks =
      main_memory.bytes_at(build_plan.piece_checks, std::uint64_t{pieces} * sizeof(PieceCheck));
  if (finish_built_image({reinterpret_cast<const PieceCheck*>(checks.data()), pieces}, header) != Status::kOk) {
    throw Failure(ExitCode::kCheckFailed, scene.path.string() + ": the cores built an image of another size");
  }
  build.passes = std::move(run.passes);
  build.piece_count = pieces;
}

// Prepares an image with effects for the cores: its other sections are there, those of the tree are overwritten.
// @returns the check value that it must have.
std::uint64_t place_tree_between(const SceneImageView& view, const sim::MemoryRegion& image, BuildInput& build) {
  const auto take = [&](std::uint64_t offset, std::uint64_t bytes) {
    std::ranges::fill(image.bytes.subspan(offset, bytes), std::byte{0xA5});
    return image.address.offset_by(offset);
  };
  build.records = take(view.tree.triangles_offset_bytes, view.tree.triangle_count * sizeof(VertexTriangle));
  build.nodes = take(view.tree.nodes_offset_bytes, view.tree.node_count * sizeof(TreeNode));
  build.record_room = view.tree.triangle_count;
  build.node_room = view.tree.node_count;
  build.image_room = view.header.image_bytes;
  build.order = TreeOrder::kForAnyHit;
  auto& header = *reinterpret_cast<ImageHeader*>(image.bytes.data());
  return std::exchange(header.check_value, 0);
}

}  // namespace

bool cores_can_build(const RenderPlan& plan) {
  return plan.engine == EngineId::kTree && format_of(plan.accuracy) == TriangleFormat::kVertices &&
         plan.mode == sim::Mode::kChecked && !sim::counts_instructions(*plan.scene.machine);
}

SceneImageView build_on_cores(sim::SimMemory& memory, const SceneInput& input, const Mesh& mesh, const RenderPlan& plan,
                              const GridChoice& choice, const sim::MemoryRegion& image,
                              std::optional<VertexOrder>* order, const EffectsView* effects, CoresBuild& build) {
  BuildInput build_input;
  build_input.vertex_count = static_cast<std::uint32_t>(mesh.vertices.size());
  build_input.triangle_count = static_cast<std::uint32_t>(mesh.triangles.size());
  build_input.leaf_triangles = choice.parameters.leaf_triangles;
  build_input.image = image.address;
  std::optional<std::uint64_t> check_value;
  if (effects != nullptr) {
    check_value = place_tree_between(build_image(input, mesh, choice, image.bytes, effects), image, build_input);
  } else {
    build_input.is_tree_image = true;
    build_input.order = TreeOrder::kByNumber;
    build_input.record_room = build_input.triangle_count;
    const std::uint64_t kept = mesh.triangles.size() - choice.need.dropped_triangle_count;
    build_input.node_room = static_cast<std::uint32_t>(most_tree_nodes(kept, build_input.leaf_triangles));
    build_input.image_room = image.bytes.size();
  }
  stop_if_interrupted();
  const Stage stage(input.path, "building its tree on the cores");
  const std::uint64_t mark = memory.used_bytes();
  BuildMemory build_memory(memory, input.path);
  place_mesh(mesh, order, build_memory, build_input);
  if (sim::arena_bytes(plan.layout.store) >= BuildLayout256K::kArenaBytes) {
    run_build<BuildLayout256K>(memory, build_memory, input, plan, build_input, image, build);
  } else {
    run_build<BuildLayout64K>(memory, build_memory, input, plan, build_input, image, build);
  }
  memory.release_to(mark);
  SceneImageView view{};
  SceneImageError error;
  if (open_scene_image(image.bytes, view, error) != Status::kOk ||
      (check_value && view.header.check_value != *check_value)) {
    throw Failure(ExitCode::kCheckFailed, input.path.string() +
                                              ": the image that the cores built is not valid: field " + error.field +
                                              " at byte " + std::to_string(error.byte_offset));
  }
  return view;
}

}  // namespace gridiron::tool
