// Systems. SPDX-License-Identifier: Apache-2.0
#include "experiment/systems.h"

#include <gridiron/dma/tags.h>
#include <gridiron/sim/trace_packing.h>
#include <report/report.h>

#include <algorithm>
#include <bit>
#include <glm/common.hpp>
#include <numeric>
#include <utility>

#include "base/words.h"
#include "experiment/bvh_system.h"
#include "files/interrupt.h"
#include "gridiron/device/store_facts.h"
#include "gridiron/frame/chip_frame.h"
#include "gridiron/frame/frame_memory.h"
#include "gridiron/frame/frame_pictures.h"
#include "gridiron/frame/render_plan.h"

namespace gridiron::experiment {
namespace {

tool::RenderPlan plan_of(const GridVariant& variant, const View& view, const FrameRequest& request) {
  tool::RenderPlan plan;
  plan.scene.input = view.scene->path;
  plan.scene.machine = home_machine();
  plan.cores = home_machine()->core_count;
  plan.scene.configuration = &variant.configuration;
  plan.scene.lambda = variant.configuration.lambda;  // kept or refused: a reduced grid would be another system
  plan.width = request.width;
  plan.height = request.height;
  plan.layout = {variant.store, variant.tile_width, variant.configuration.packet_width};
  plan.engine = variant.configuration.has_grid() ? EngineId::kGrid : EngineId::kTree;
  plan.depths = variant.configuration.depths;
  plan.techniques = variant.configuration.techniques;
  plan.accuracy = variant.accuracy;
  plan.shading = request.shading;
  plan.has_depth = variant.depth;
  plan.builder = variant.builder;
  return plan;
}

}  // namespace

// A frame in the main memory of the home machine. CloseLook's parts, which other sources know by name, are one.
struct PreparedFrame {
  PreparedFrame(tool::RenderPlan plan_of_frame, const View& view)
      : plan(std::move(plan_of_frame)), memory(home_machine()->main_memory_bytes) {
    tool::prepare_frame(memory, *view.scene, plan, view.camera);
  }
  sim::ChipResult render() { return tool::render_on_chip(memory, plan, {}); }

  tool::RenderPlan plan;
  tool::FrameMemory memory;
};

namespace {

// The same with all its planes, without a clock.
tool::RenderPlan answers_plan_of(const GridVariant& variant, const View& view, const FrameRequest& request) {
  tool::RenderPlan plan = plan_of(variant, view, request);
  plan.has_depth = plan.has_ids = true;
  plan.mode = sim::Mode::kPlain;
  return plan;
}

std::vector<std::uint32_t> words_of(const tool::FrameMemory& frame, const sim::MemoryRegion& plane) {
  return tool::words_of_plane(frame.record, plane.bytes).pixels;
}

std::vector<float> depth_of(const tool::FrameMemory& frame) {
  std::vector<float> depth;
  for (const std::uint32_t word : words_of(frame, frame.depth)) depth.push_back(std::bit_cast<float>(word));
  return depth;
}

std::uint64_t sum_of(const sim::WorkTotals& work, std::initializer_list<WorkId> kinds) {
  std::uint64_t sum = 0;
  for (const WorkId kind : kinds) sum += work[kind.number()];
  return sum;
}

// Bytes that gets of triangle records request. The prologue of a core has none.
std::uint64_t fetched_triangle_bytes(const sim::FrameTrace& trace) {
  std::uint64_t bytes = 0;
  sim::TraceReader steps;
  for (const sim::TileTrace& tile : trace.tiles) {
    steps.open(tile);
    while (const sim::TraceEvent* const event = steps.next()) {
      const bool is_triangles = event->kind == sim::EventKind::kGet && !event->rotating &&
                                sim::wait_level_of_tag(event->tag) == sim::WaitLevel::kTriangle;
      if (is_triangles) bytes += event->bytes;
    }
  }
  return bytes;
}

// The same frame where every packet fetches the normals of the triangles that it shows before it shades. They are
// fetched at the end of the tile, which takes a core as long.
sim::FrameTrace with_late_normals(const sim::FrameTrace& trace, const std::vector<std::uint32_t>& ids,
                                  const FrameRecord& frame, std::uint32_t packet_width) {
  constexpr std::uint32_t kNormalBytes = 16;
  constexpr TagMask kTags = TagMask::of(Tag{kFirstTriangleTag});
  sim::FrameTrace with = trace;
  sim::TraceReader steps;
  sim::TraceWriter writer;
  std::vector<std::uint32_t> shown;
  const std::uint32_t tiles_across = (frame.width + frame.tile_width - 1) / frame.tile_width;
  const auto fetch_normals = [&](std::uint32_t tile, std::uint32_t packet) {
    const std::uint32_t packets_across = frame.tile_width / packet_width;
    const std::uint32_t left = tile % tiles_across * frame.tile_width + packet % packets_across * packet_width;
    const std::uint32_t top = tile / tiles_across * frame.tile_width + packet / packets_across * packet_width;
    shown.clear();
    for (std::uint32_t y = top; y < std::min(top + packet_width, frame.height); ++y) {
      for (std::uint32_t x = left; x < std::min(left + packet_width, frame.width); ++x) {
        const std::uint32_t id = ids[std::size_t{y} * frame.width + x];
        if (id != kNoTriangle) shown.push_back(id);
      }
    }
    std::ranges::sort(shown);
    shown.erase(std::unique(shown.begin(), shown.end()), shown.end());
    for (const std::uint32_t id : shown) {
      writer.add({.kind = sim::EventKind::kGet,
                  .tag = kFirstTriangleTag,
                  .bytes = kNormalBytes,
                  .address = std::uint64_t{kNormalBytes} * id});
      writer.add({.kind = sim::EventKind::kWait, .tags = kTags.bits});
    }
  };
  for (std::size_t i = 0; i < with.tiles.size(); ++i) {
    sim::TileTrace& tile = with.tiles[i];
    bool is_shaded = false;
    steps.open(trace.tiles[i]);
    while (const sim::TraceEvent* const event = steps.next()) {
      if (event->kind == sim::EventKind::kPut && !is_shaded) {
        const std::uint32_t packets = frame.tile_width / packet_width * (frame.tile_width / packet_width);
        for (std::uint32_t packet = 0; packet < packets; ++packet) fetch_normals(tile.tile_id, packet);
        is_shaded = true;
      }
      writer.add(*event);
    }
    tile = writer.finish(tile.tile_id);
  }
  return with;
}

class GridRecording : public Recording {
 public:
  /// @param build  no passes where the general core builds.
  GridRecording(FrameFacts facts, sim::FrameTrace trace, tool::CoresBuild build)
      : facts_(std::move(facts)), trace_(std::move(trace)), build_(std::move(build)) {}
  [[nodiscard]] const FrameFacts& facts() const override { return facts_; }
  [[nodiscard]] TimedFrame time(const sim::MachineProfile& machine, std::uint32_t core_count) const override {
    TimedFrame timed{sim::replay(trace_, machine, {.core_count = core_count}), std::nullopt};
    if (!build_.passes.empty()) {
      timed.cores_build = tool::cost_of_cores(build_, machine, core_count);
      tool::add_picture(timed.timing, machine, *timed.cores_build);
    }
    return timed;
  }

 private:
  FrameFacts facts_;
  sim::FrameTrace trace_;
  tool::CoresBuild build_;
};

Contender grid_contender(std::string key, std::string title, std::string hiding, GridVariant variant) {
  variant.key = key;
  GridVariant unhidden = variant;
  unhidden.key = key + "_single";
  unhidden.configuration.depths = tool::kSingleBuffering;
  return {std::move(key),
          std::move(title),
          std::make_shared<GridSystem>(std::move(variant)),
          std::make_shared<GridSystem>(std::move(unhidden)),
          std::move(hiding),
          true,
          kPaperGridGrowth};
}

// Eye rays through the wide tree. Its two tiles take turns without hiding too.
Contender tree_contender() {
  const GridVariant best = grid_variant("best");
  Contender contender = grid_contender(
      "best", "best",
      "up to " + std::to_string(best.configuration.depths.fetch) + " nodes or leaves under way for each of two tiles",
      best);
  contender.is_grid = false;
  contender.paper_growth = {};
  return contender;
}

Contender bvh_contender() {
  return {
      "bvh", "BVH",          std::make_shared<BvhSystem>(true), std::make_shared<BvhSystem>(false), "a ring of packets",
      false, kPaperBvhGrowth};
}

}  // namespace

const tool::Machine& home_machine() {
  static const tool::Machine machine = std::make_shared<sim::MachineProfile>(sim::machine_profiles().front());
  return machine;
}

std::uint64_t FrameFacts::build_steps() const {
  return std::accumulate(build.counts.begin(), build.counts.end(), std::uint64_t{0});
}

GridVariant grid_variant(std::string_view configuration) {
  GridVariant variant{std::string(configuration), *tool::find_configuration(configuration)};
  if (!variant.configuration.has_grid()) variant.tile_width = tool::tree_tile_width(sim::StoreSize::k256KB);
  return variant;
}

std::string buffer_words(std::string_view configuration) {
  const tool::BufferDepths depths = grid_variant(configuration).configuration.depths;
  return tool::words_of_count(depths.macro, "cell block") + " and " +
         tool::words_of_count(depths.triangle, "triangle buffer");
}

std::vector<Contender> make_contenders() {
  GridVariant projection = grid_variant("reference");
  projection.accuracy = Accuracy::kPaper;
  return {grid_contender("reference", "reference", "double buffering", grid_variant("reference")),
          grid_contender("projection", "reference, projection test", "double buffering", projection),
          grid_contender("grid", "grid", buffer_words("grid"), grid_variant("grid")), tree_contender(),
          bvh_contender()};
}

std::unique_ptr<Recording> GridSystem::record(const View& view, const FrameRequest& request) const {
  PreparedFrame prepared(plan_of(variant_, view, request), view);
  sim::ChipResult result = prepared.render();
  tool::FrameMemory& frame = prepared.memory;

  FrameFacts facts;
  facts.build = tool::work_of_master(view.mesh(), frame).value_or(sim::BuildWork{});
  const bool has_grid = variant_.configuration.has_grid();
  if (has_grid) {
    facts.traversal_steps = sum_of(result.work, {GridWork::kMacroSliceStep, GridWork::kMacroCellStep,
                                                 GridWork::kSliceStep, GridWork::kCellStep, GridWork::kCellBoundStep});
  } else {
    facts.traversal_steps = sum_of(result.work, {TileWork::kChild, TileWork::kLeaf});
  }
  facts.intersection_tests =
      sum_of(result.work, {Work::kGroupTestStandard, Work::kRowTest, Work::kGroupTestPaper, Work::kListTriangleGroup});
  facts.scene_bytes = frame.image.header.image_bytes;
  facts.dropped_triangles = frame.image.header.dropped_triangle_count;
  if (frame.image.has_grid) facts.grid = frame.image.grid;
  facts.triangle_bytes = std::uint64_t{frame.image.grid.triangle_bytes} * frame.image.grid.reference_count;
  facts.fetched_triangle_bytes = fetched_triangle_bytes(result.trace);
  facts.main_memory_bytes = frame.memory.used_bytes();
  const tool::StoreFacts store = *tool::find_store_facts(prepared.plan.layout);  // it has rendered
  facts.local_store_bytes = store.data_bytes() + store.code_bytes + store.stack_bytes;
  facts.picture_hash = tool::image_hash(words_of(frame, frame.color));
  if (variant_.late_normals) {
    const std::vector<std::uint32_t> ids = render_answers(variant_, view, request).ids;
    result.trace = with_late_normals(result.trace, ids, frame.record, variant_.configuration.packet_width);
  }
  return std::make_unique<GridRecording>(std::move(facts), std::move(result.trace),
                                         std::move(prepared.memory.cores_build));
}

Answers render_answers(const GridVariant& variant, const View& view, const FrameRequest& request) {
  PreparedFrame frame(answers_plan_of(variant, view, request), view);
  (void)frame.render();
  return {words_of(frame.memory, frame.memory.color), words_of(frame.memory, frame.memory.ids), depth_of(frame.memory)};
}

struct CloseLook::Parts : PreparedFrame {
  using PreparedFrame::PreparedFrame;
};

CloseLook::CloseLook(const GridVariant& variant, const View& view)
    : parts_(std::make_unique<Parts>(
          answers_plan_of(variant, view, {.width = kWidth, .height = kWidth, .shading = Shading::kNone}), view)) {}
CloseLook::~CloseLook() = default;

void CloseLook::look_at(const Vec3& point, Answers& answers) {
  tool::FrameMemory& frame = parts_->memory;
  Camera camera = frame.settings.camera;
  camera.at = point;
  // Any direction across the view serves as up.
  const Vec3 forward = glm::abs(camera.at - camera.eye);
  camera.up = forward.x <= forward.y && forward.x <= forward.z ? Vec3(1, 0, 0)
              : forward.y <= forward.z                         ? Vec3(0, 1, 0)
                                                               : Vec3(0, 0, 1);
  // A direction's greatest component lies between 1/2 and 1, its floats 2^-24 apart.
  constexpr float kPixel = 0x1p-25f;
  camera.tan_half_fov = kPixel * kWidth / 2;
  tool::aim_camera(frame, camera);
  (void)parts_->render();
  const std::vector<std::uint32_t> ids = words_of(frame, frame.ids);
  const std::vector<float> depth = depth_of(frame);
  answers.ids.insert(answers.ids.end(), ids.begin(), ids.end());
  answers.depth.insert(answers.depth.end(), depth.begin(), depth.end());
}

tool::HostSeconds least_host_seconds(std::uint32_t repeats, const std::function<void()>& work) {
  tool::HostSeconds least;
  for (std::uint32_t i = 0; i < repeats; ++i) {
    tool::stop_if_interrupted();
    const tool::Stopwatch stopwatch;
    work();
    const tool::HostSeconds taken = stopwatch.both();
    least = i == 0 ? taken : least.least(taken);
  }
  return least;
}

HostFrame render_on_host(const GridVariant& variant, const View& view, const FrameRequest& request,
                         std::uint32_t threads, std::uint32_t repeats) {
  tool::RenderPlan plan = plan_of(variant, view, request);
  plan.mode = sim::Mode::kPlain;
  plan.lanes = sim::widest_lanes();
  plan.threads = threads;
  PreparedFrame frame(std::move(plan), view);
  return {least_host_seconds(repeats, [&frame] { (void)frame.render(); }), frame.memory.record};
}

}  // namespace gridiron::experiment
