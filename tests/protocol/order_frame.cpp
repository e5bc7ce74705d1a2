// Frames for every order: see the header. SPDX-License-Identifier: Apache-2.0
#include "protocol/order_frame.h"

#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/render/tile_renderer.h>
#include <gridiron/sim/item_source.h>

#include <new>
#include <stdexcept>

namespace gridiron::test {
namespace {

void require(Status status) {
  if (status != Status::kOk) throw std::runtime_error("status " + std::to_string(static_cast<int>(status)));
}

}  // namespace

bool OrderOutcome::is_as(const OrderOutcome& other) const {
  return status == other.status && violation.empty() && calls == other.calls && planes.size() == other.planes.size() &&
         std::memcmp(planes.data(), other.planes.data(), planes.size()) == 0 && store.size() == other.store.size() &&
         std::memcmp(store.data(), other.store.data(), store.size()) == 0;
}

OrderFrame::OrderFrame(const OrderScene& scene, const OrderSettings& settings) {
  // 1. The image.
  EffectsView effects;
  effects.materials = scene.materials;
  effects.triangle_materials = scene.triangle_materials;
  effects.normals = scene.normals;
  effects.triangle_normals = scene.triangle_normals;
  effects.lights = scene.lights;
  effects.background = {0.25f, 0.5f, 0.75f};
  effects.recursion_depth = scene.recursion_depth;
  effects.occlusion_samples = scene.occlusion_samples;
  effects.occlusion_radius = scene.occlusion_samples == 0 ? 0.0f : 1.0f;
  if (!scene.environment_face.empty()) {
    while (effects.environment_width * effects.environment_width < scene.environment_face.size()) {
      ++effects.environment_width;
    }
    for (auto& face : effects.environment_faces) face = scene.environment_face;
  }
  const EffectsView* const called_for = scene.has_effects() ? &effects : nullptr;
  const GridParameters grid{.lambda = scene.lambda,
                            .macro_width = 2,
                            .format = TriangleFormat::kVertices,
                            .leaf_triangles = EffectOrderLayout::kLeafTriangles,
                            .has_tree = settings.engine == EngineId::kTree};
  static_assert(TileOrderLayout::kLeafTriangles == EffectOrderLayout::kLeafTriangles);
  GridNeed need{};
  require(count_scene_image(scene.mesh.view(), grid, need, called_for));
  const auto image = memory_.allocate(need.image_bytes).value();
  std::vector<std::byte> scratch(need.scratch_bytes + 16);
  require(build_scene_image(scene.mesh.view(), grid, need, image.bytes, scratch, called_for));
  SceneImageView view;
  SceneImageError error;
  require(open_scene_image(image.bytes, view, error));
  // 2. Planes, the second after the first, and memory for rays that wait.
  const std::uint32_t tile_width =
      settings.engine == EngineId::kTree ? TileOrderLayout::kTileWidth : OrderLayout::kTileWidth;
  const std::uint64_t plane_bytes = output_plane_bytes(settings.width, settings.height, tile_width);
  planes_ = memory_.allocate(plane_bytes * (settings.wants_ids ? 2 : 1), 4096).value();
  if (scene.recursion_depth > 1) {
    spill_ = memory_.allocate(spill_bytes(scene.recursion_depth), kSpillAlignment).value();
  }
  // 3. The frame.
  output_depth_ = settings.output_depth;
  FrameSettings frame{.camera = {.eye = scene.eye},
                      .width = settings.width,
                      .height = settings.height,
                      .tile_width = tile_width,
                      .shading = scene.has_effects() ? Shading::kScene : Shading::kSimple,
                      .engine = settings.engine,
                      .output_depth = settings.output_depth,
                      .macro_depth = settings.macro_depth,
                      .triangle_depth = settings.triangle_depth,
                      .fetch_depth = settings.fetch_depth,
                      .color = planes_.address};
  if (settings.wants_ids) frame.ids = planes_.address.offset_by(plane_bytes);
  const auto record = memory_.allocate(sizeof(FrameRecord)).value();
  FrameRecord& made = *new (record.bytes.data()) FrameRecord;
  require(make_frame_record(frame, view, image.address, made));
  frame_ = record.address;
  tile_count_ = made.tiles_x * made.tiles_y;
  limits_.queue_depth = settings.queue_depth;
  if (settings.engine == EngineId::kTree) {
    tile_store_ = std::make_unique<LocalStore<TileOrderLayout>>();
  } else if (scene.has_effects()) {
    effect_store_ = std::make_unique<LocalStore<EffectOrderLayout>>();
  } else {
    packet_store_ = std::make_unique<LocalStore<PacketOrderLayout>>();
  }
}

OrderOutcome OrderFrame::run(const OrderPlan& plan) {
  if (tile_store_ != nullptr) return run_layout(*tile_store_, plan);
  return effect_store_ != nullptr ? run_layout(*effect_store_, plan) : run_layout(*packet_store_, plan);
}

template <class Layout>
OrderOutcome OrderFrame::run_layout(LocalStore<Layout>& store, const OrderPlan& plan) {
  std::fill(planes_.bytes.begin(), planes_.bytes.end(), std::byte{0x11});
  std::fill(spill_.bytes.begin(), spill_.bytes.end(), std::byte{0x22});
  const std::span<std::byte> bytes(reinterpret_cast<std::byte*>(&store), sizeof(store));
  std::fill(bytes.begin(), bytes.end(), std::byte{0xC3});
  sim::ItemSource tiles(tile_count_);
  sim::SimFrame shared;
  shared.memory = &memory_;
  shared.tiles = &tiles;
  shared.writable = {{planes_.address.value, planes_.address.value + planes_.bytes.size()}};
  shared.spill = {spill_.address, spill_.bytes.size()};
  shared.limits = limits_;
  shared.completion = sim::Completion::kLate;
  shared.output_depth = output_depth_;
  sim::SimCore core(shared, 0, bytes);
  OrderCore platform(core, bytes, plan);
  OrderOutcome outcome;
  outcome.status = render_tiles<Lanes<4>>(store, platform, frame_, core.spill());
  core.finish(outcome.status == Status::kOk);
  if (!core.violations().empty()) outcome.violation = core.violations().front().detail;
  outcome.planes.assign(planes_.bytes.begin(), planes_.bytes.end());
  outcome.store.assign(bytes.begin(), bytes.end());
  outcome.calls = std::move(platform.calls);
  outcome.transfers = std::move(platform.transfers);
  outcome.waits = std::move(platform.waits);
  outcome.completions = std::move(platform.completions);
  outcome.most_pending = platform.most_pending;
  return outcome;
}

}  // namespace gridiron::test
