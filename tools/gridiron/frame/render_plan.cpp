// Render plan. SPDX-License-Identifier: Apache-2.0
#include "render_plan.h"

#include <algorithm>
#include <string>
#include <thread>

#include "base/failure.h"
#include "base/ranks.h"
#include "files/input_file.h"
#include "gridiron/device/store_facts.h"
#include "gridiron/sweep/sweep_files.h"

namespace gridiron::tool {
namespace {

using sim::Mode;
using sim::StoreSize;

Shading shading_of(const RenderRequest& request, const KnownScene& scene) {
  const Shading shading = request.shading.value_or(scene.has_effects ? Shading::kScene : Shading::kSimple);
  if (shading != Shading::kScene) {
    if (request.scene.look.is_given()) usage_error("--look and its parts: require --shading scene");
    return shading;
  }
  if (!scene.is_read && scene.kind == SceneKind::kMesh && !scene.has_effects) {
    usage_error(
        "--shading scene: a mesh has no lights and materials; --look studio gives it some, text scenes (NFF) have "
        "their own");
  }
  if (scene.is_read && !scene.has_effects) {
    usage_error("--shading scene: " + request.scene.input.string() +
                " has no lights and materials; --look studio gives a mesh some, text scenes (.nff) have their own");
  }
  require_effects_of(request.accuracy);
  return shading;
}

constexpr std::uint32_t kChipLanes = 4;

// The named configuration, or the default one for the scene, the machine and the kernels that are built.
const Configuration& configuration_of(const RenderRequest& request, const KnownScene& scene, const RenderPlan& plan) {
  if (request.scene.configuration != nullptr) return *request.scene.configuration;
  const sim::MachineProfile& machine = *request.scene.machine;
  const auto is_built = [&](const sim::LayoutChoice& layout) {
    return sim::is_built(layout, plan.mode, plan.lanes) ||
           (!request.lanes && sim::is_built(layout, plan.mode, kChipLanes));
  };
  return default_configuration(
      {.has_projection = request.accuracy == Accuracy::kPaper,
       .has_tree = scene.has_tree,
       .has_kernel = has_best_kernel(machine, request.layout.store, plan.shading == Shading::kScene, is_built),
       .has_bounds = scene.has_bounds,
       .has_prices = plan.mode == Mode::kPlain || !sim::counts_instructions(machine)});
}

// May lower the plan's lanes.
sim::LayoutChoice layout_of(const RenderRequest& request, RenderPlan& plan) {
  const Configuration& configuration = *plan.scene.configuration;
  const GridOption grid_options[] = {{"--packet", request.layout.packet_width.has_value()},
                                     {"--lambda", request.scene.lambda.has_value()},
                                     {"--macro-width", request.scene.macro_width.has_value()},
                                     {"--no-mailbox", request.no_mailbox},
                                     {"--no-culling", request.no_culling},
                                     {"--no-subpackets", request.no_subpackets},
                                     {"--no-empty-skip", request.no_empty_skip}};
  require_grid_for(configuration, grid_options, request.accuracy == Accuracy::kPaper ? "--accuracy paper" : nullptr);
  const auto with = [&](StoreSize store) {
    return layout_with(request.layout, configuration, store, plan.shading == Shading::kScene);
  };
  const auto is_built = [&](StoreSize store) { return sim::is_built(with(store), plan.mode, plan.lanes); };
  const StoreSize store = choose_store(*request.scene.machine, request.layout.store, is_built);
  // The host's widest lanes are a default; a layout may have memory for four only.
  if (!request.lanes && !is_built(store)) plan.lanes = kChipLanes;
  require_built(with(store), configuration, is_built(store));
  require_distances(with(store), plan.has_depth);
  return with(store);
}

// The buffers of the three levels and the width of macrocells, limited by the store.
void settle_depths(const RenderRequest& request, RenderPlan& plan) {
  const Configuration& configuration = *plan.scene.configuration;
  const StoreFacts facts = *find_store_facts(plan.layout);
  plan.engine = facts.engine;
  if (plan.engine == EngineId::kTree && plan.mode != Mode::kPlain && sim::counts_instructions(*request.scene.machine)) {
    usage_error("--machine " + std::string(request.scene.machine->name) +
                ": counts instructions, which are not known of configuration " + std::string(configuration.name) +
                "; --configuration grid has them, and --mode plain counts nothing");
  }
  const BufferDepths& most = facts.most_depths;
  const bool has_effects = plan.layout.has_effects;
  plan.depths = request.layout.depths.value_or(configuration.depths);
  if (!request.layout.depths) {  // a named configuration is limited by the store, an explicit depth is not
    const std::uint32_t fetch = plan.depths.fetch;
    plan.depths = plan.depths.within(most);
    if (!has_effects && facts.engine == EngineId::kGrid) plan.depths.fetch = fetch;
  } else if (plan.layout.packet_width == 0) {  // without packets nothing reads the grid
    plan.depths.macro = most.macro;
    plan.depths.triangle = most.triangle;
  }
  if (has_effects) plan.most_macro_width = facts.max_macro_width;
  const std::uint32_t macro_width =
      request.scene.macro_width.value_or(std::min(configuration.macro_width, plan.most_macro_width));
  if (plan.depths.output > most.output || plan.depths.macro > most.macro || plan.depths.triangle > most.triangle ||
      macro_width > facts.max_macro_width) {
    const auto blocks = [](const BufferDepths& depths, std::uint32_t width) {
      return std::to_string(depths.macro) + " cell blocks of macrocells of width " + std::to_string(width) + " and " +
             std::to_string(depths.triangle) + " triangle buffers";
    };
    usage_error("--store " + std::to_string(facts.arena_bytes >> 10) + (has_effects ? ", --shading scene" : "") +
                ": holds at most " + blocks(most, facts.max_macro_width) + "; " + blocks(plan.depths, macro_width) +
                " are requested");
  }
}

// Tiles have bounds where a whole frame is timed.
void require_bound(const RenderPlan& plan) {
  require_view_bound("--bound", plan.engine, plan.layout, plan.accuracy, plan.has_depth);
  if (plan.mode == Mode::kPlain || plan.lanes != kChipLanes || plan.tile) {
    usage_error(
        "--bound: is compared with the cycles of a frame; --mode plain, --lanes other than 4 and --tile have none");
  }
}

// The techniques of the configuration, without those that are switched off.
std::uint32_t techniques_of(const RenderRequest& request, const Configuration& configuration) {
  const auto bit = [](bool is_off, std::uint32_t technique) { return is_off ? technique : 0u; };
  const std::uint32_t off = bit(request.no_mailbox, kUseMailbox) | bit(request.no_culling, kUseCornerCulling) |
                            bit(request.no_subpackets, kUseSubpackets) | bit(request.no_empty_skip, kUseEmptySkip);
  return configuration.techniques & ~off;
}

// A sweep replays the trace of a whole frame.
void check_sweep(const RenderRequest& request, std::uint32_t lanes) {
  const FrameOutputs& outputs = request.outputs;
  if (request.varied.empty()) {
    if (outputs.sweep) usage_error("--sweep: needs --vary, which says what the machines differ in");
    if (outputs.sweep_plot) usage_error("--sweep-plot: needs --vary, which says what the machines differ in");
    return;
  }
  if (!outputs.sweep && !outputs.sweep_plot)
    usage_error("--vary: needs --sweep or --sweep-plot, a file of its figures");
  check_varied_keys(request.varied);
  if (outputs.sweep_plot) check_sweep_plot(request.varied);
  if (request.cores && !varied_core_counts(request.varied).empty()) {
    usage_error("--cores and --vary core_count: both say how many cores there are");
  }
  if (request.mode == Mode::kPlain) usage_error("--vary: --mode plain counts no cycles; --mode checked does");
  if (lanes != kChipLanes) usage_error("--vary: cycles are counted for --lanes 4 only");
  if (request.tile) usage_error("--vary: cycles are not counted for one tile alone (--tile)");
}

std::uint32_t lanes_of(const RenderRequest& request, const Host& host) {
  return request.lanes.value_or(request.mode == Mode::kPlain ? host.lanes : kChipLanes);
}

// Limits the threads to the number of tiles.
std::uint32_t threads_of(const RenderRequest& request, const RenderPlan& plan, const Host& host) {
  const auto tiles = [&plan](std::uint64_t pixels) {
    return (pixels + plan.layout.tile_width - 1) / plan.layout.tile_width;
  };
  const std::uint64_t tile_count = plan.tile ? 1 : tiles(plan.width) * tiles(plan.height);
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(request.threads.value_or(host.threads), tile_count));
}

}  // namespace

std::vector<Output> FrameOutputs::declared() const {
  std::vector<Output> outputs;
  if (picture) outputs.push_back({"-o", *picture, OutputKind::kPicture});
  if (depth) outputs.push_back({"--depth", *depth, OutputKind::kFloats});
  if (ids) outputs.push_back({"--ids", *ids, OutputKind::kFloats});
  if (report) outputs.push_back({"--report", *report, OutputKind::kText});
  if (timeline) outputs.push_back({"--timeline", *timeline, OutputKind::kText});
  if (sweep) outputs.push_back({"--sweep", *sweep, OutputKind::kText});
  if (sweep_plot) outputs.push_back({"--sweep-plot", *sweep_plot, OutputKind::kText});
  return outputs;
}

FrameOutputs RenderRequest::named_outputs() const {
  FrameOutputs named = outputs;
  if (!named.picture) named.picture = is_descriptor(scene.input) ? "picture.png" : scene.input.stem().concat(".png");
  return named;
}

Host this_host() {
  const std::uint32_t threads = ranks().usual_threads(std::max(1u, std::thread::hardware_concurrency()));
  return {threads, sim::widest_lanes(), sim::has_instrumented_mode()};
}

void check_request(const RenderRequest& request, const Host& host) {
  const std::uint32_t lanes = lanes_of(request, host);
  const bool has_timeline = request.outputs.timeline.has_value();
  if (request.view.from && request.view.eye) usage_error("--from and --eye: both say where the eye is");
  if (request.mode == Mode::kInstrumented && lanes != 4) usage_error("--mode instrumented: has 4 lanes only");
  if (request.mode == Mode::kInstrumented && !host.has_instrumented_mode) {
    usage_error("--mode instrumented: this build has no instrumented kernel");
  }
  if (has_timeline && request.mode == Mode::kPlain) {
    usage_error("--timeline: --mode plain does not record what cores do when; --mode checked does");
  }
  if (has_timeline && lanes != 4) usage_error("--timeline: cycles are counted for --lanes 4 only");
  if (has_timeline && request.tile) usage_error("--timeline: cycles are not counted for one tile alone (--tile)");
  if (lanes > host.lanes) {
    usage_error("--lanes: this host and this build (GRIDIRON_WIDE_LANES) have at most " + std::to_string(host.lanes) +
                " lanes");
  }
  check_sweep(request, lanes);
  if (request.seed && request.completion != sim::Completion::kRandom) usage_error("--seed: needs --completion random");
}

RenderPlan resolve(const RenderRequest& request, const KnownScene& scene, const Host& host) {
  check_request(request, host);
  require_time(*request.scene.machine, request.varied);
  RenderPlan plan{.scene = request.scene,
                  .outputs = request.named_outputs(),
                  .has_depth = request.outputs.depth || request.depth_plane,
                  .has_ids = request.outputs.ids || request.ids_plane,
                  .tile = request.tile,
                  .cores = request.cores.value_or(request.scene.machine->core_count),
                  .lanes = lanes_of(request, host),
                  .accuracy = request.accuracy,
                  .mode = request.mode,
                  .completion = request.completion,
                  .seed = request.seed.value_or(0),
                  .repeats = request.repeats,
                  .has_bound = request.has_bound,
                  .varied = request.varied};
  const CountPair size = request.size.value_or(scene.size.value_or(kUsualPictureSize));
  plan.width = size.x;
  plan.height = size.y;
  plan.shading = shading_of(request, scene);
  plan.scene.configuration = &configuration_of(request, scene, plan);
  plan.techniques = techniques_of(request, *plan.scene.configuration);
  plan.layout = layout_of(request, plan);
  settle_depths(request, plan);
  if (plan.has_bound) require_bound(plan);
  plan.threads = threads_of(request, plan, host);
  return plan;
}

}  // namespace gridiron::tool
