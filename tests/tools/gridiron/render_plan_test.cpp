// Plans: how resolve() completes requests for a frame and for info, and what it rejects; it opens no file.
// SPDX-License-Identifier: Apache-2.0
#include "gridiron/frame/render_plan.h"

#include "failure_of.h"
#include "gridiron/info/info_plan.h"

namespace gridiron::test {
namespace {

using sim::StoreSize;
using tool::SceneKind;

constexpr tool::Host kHost = {.threads = 6, .lanes = 8, .has_instrumented_mode = false};
constexpr tool::KnownScene kMesh = {.kind = SceneKind::kMesh};
constexpr tool::KnownScene kText = {.kind = SceneKind::kText, .has_effects = true};
constexpr tool::KnownScene kPacked = {.kind = SceneKind::kPacked};

tool::SceneRequest scene_request(const char* configuration) {
  tool::SceneRequest scene;
  scene.input = "folder/scene";
  scene.machine = tool::find_machine("cell-ps3");
  scene.configuration = tool::find_configuration(configuration);
  return scene;
}

tool::RenderRequest render_request(const char* configuration) {
  tool::RenderRequest request;
  request.scene = scene_request(configuration);
  return request;
}

tool::RenderPlan plan_of(const tool::RenderRequest& request, const tool::KnownScene& scene = kMesh) {
  return tool::resolve(request, scene, kHost);
}

std::string refusal(const tool::RenderRequest& request, const tool::KnownScene& scene = kMesh) {
  return failure_of([&] { return plan_of(request, scene); }, tool::ExitCode::kUsage);
}

TEST(RenderPlan, WhatIsNotAskedForIsTheScenesTheMachinesTheHostsAndTheConfigurations) {
  const tool::RenderRequest request = render_request("grid");
  const tool::RenderPlan mesh = plan_of(request);
  EXPECT_EQ(mesh.outputs.picture, "scene.png");
  EXPECT_EQ(mesh.width, 1024u);
  EXPECT_EQ(mesh.cores, request.scene.machine->core_count);
  EXPECT_EQ(mesh.threads, kHost.threads);
  EXPECT_EQ(mesh.lanes, 4u);
  EXPECT_EQ(mesh.shading, Shading::kSimple);
  EXPECT_EQ(mesh.layout.store, StoreSize::k256KB);
  EXPECT_EQ(mesh.layout.packet_width, 32u);
  EXPECT_EQ(mesh.depths, request.scene.configuration->depths);
  EXPECT_EQ(mesh.techniques, request.scene.configuration->techniques);
  tool::KnownScene sized = kText;
  sized.size = {40, 30};
  const tool::RenderPlan text = plan_of(request, sized);
  EXPECT_EQ(text.width, 40u);
  EXPECT_EQ(text.height, 30u);
  EXPECT_EQ(text.threads, 2u) << "one for each tile";
  EXPECT_EQ(text.shading, Shading::kScene);
  EXPECT_TRUE(text.layout.has_effects);
}

// A configuration that nobody named follows from scene, machine, mode and store.
TEST(RenderPlan, TheDefaultConfigurationIsCompleted) {
  tool::RenderRequest request;
  request.scene = scene_request("best");
  request.scene.configuration = nullptr;
  const auto name = [](const tool::RenderPlan& plan) { return plan.scene.configuration->name; };
  EXPECT_EQ(name(plan_of(request)), "best");
  EXPECT_EQ(plan_of(request).engine, EngineId::kTree);
  EXPECT_EQ(plan_of(request).techniques, 0u);
  EXPECT_EQ(name(plan_of(request, kText)), "best");
  EXPECT_EQ(plan_of(request, kText).layout.tile_width, 32u);
  EXPECT_EQ(name(plan_of(request, kPacked)), "best") << "nobody knows before it is read";
  EXPECT_EQ(name(plan_of(request, {.kind = SceneKind::kPacked, .is_read = true, .has_tree = false})), "grid");
  EXPECT_EQ(request.scene.configuration, nullptr);
  request.scene.machine = tool::find_machine("fu540");
  EXPECT_EQ(name(plan_of(request)), "grid");
  request.mode = sim::Mode::kPlain;
  EXPECT_EQ(name(plan_of(request)), "best") << "nothing is counted";
  request.layout.store = StoreSize::k64KB;
  EXPECT_EQ(name(plan_of(request)), "best");
  EXPECT_EQ(name(plan_of(request, kText)), "best") << "all rays by lists";
  request.accuracy = Accuracy::kPaper;
  EXPECT_EQ(name(plan_of(request)), "reference");
}

TEST(RenderPlan, WhatIsAskedForIsKept) {
  tool::RenderRequest request = render_request("grid");
  request.ids_plane = true;
  request.outputs.depth = "depth.pfm";
  request.size = {64, 64};
  request.cores = 2;
  request.mode = sim::Mode::kPlain;
  request.lanes = 4;
  request.layout = {StoreSize::k64KB, std::nullopt, 8, tool::kSingleBuffering};
  request.shading = Shading::kNone;
  request.no_mailbox = true;
  const tool::RenderPlan plan = plan_of(request, kPacked);
  EXPECT_TRUE(plan.has_depth && plan.has_ids);
  EXPECT_EQ(plan.cores, 2u);
  EXPECT_EQ(plan.lanes, 4u) << "not the widest of the host";
  EXPECT_EQ(plan.layout.store, StoreSize::k64KB);
  EXPECT_EQ(plan.layout.packet_width, 8u);
  EXPECT_EQ(plan.depths, tool::kSingleBuffering);
  EXPECT_EQ(plan.shading, Shading::kNone);
  EXPECT_EQ(plan.techniques, std::uint32_t{kUseEmptySkip | kUseSubpackets});
}

// A layout with memory for four lanes gets four of a wider host's, unless others are asked for.
TEST(RenderPlan, TheTreeInASmallStoreHasFourLanes) {
  if (tool::this_host().lanes < kHost.lanes) GTEST_SKIP() << "needs kernels for 8 lanes";
  tool::RenderRequest request = render_request("best");
  request.mode = sim::Mode::kPlain;
  EXPECT_EQ(plan_of(request).lanes, 8u);
  EXPECT_EQ(plan_of(request).layout.tile_width, 64u);
  request.layout.store = StoreSize::k64KB;
  EXPECT_EQ(plan_of(request).lanes, 4u);
  EXPECT_EQ(plan_of(request).layout.tile_width, 16u);
  request.lanes = 8;
  EXPECT_NE(refusal(request).find("--lanes 1, 4"), std::string::npos) << refusal(request);
  request.lanes = 1;
  EXPECT_EQ(plan_of(request).lanes, 1u);
}

TEST(RenderPlan, AConfigurationGetsTheBuffersThatTheStoreHas) {
  tool::RenderRequest request = render_request("deep");
  request.layout.store = StoreSize::k64KB;
  const tool::RenderPlan plan = plan_of(request);
  const tool::BufferDepths most = tool::find_store_facts(plan.layout)->most_depths;
  EXPECT_LT(most.triangle, request.scene.configuration->depths.triangle);
  EXPECT_EQ(plan.depths.triangle, most.triangle);
  request.layout.depths = request.scene.configuration->depths;
  EXPECT_NE(refusal(request).find("--store 64: holds at most"), std::string::npos) << "asked for: kept or refused";
}

TEST(RenderPlan, RefusesByWhatIsKnownOfTheScene) {
  tool::RenderRequest request = render_request("grid");
  request.shading = Shading::kScene;
  EXPECT_EQ(refusal(request), 
                              "--shading scene: a mesh has no lights and materials; --look studio gives it some, "
                              "text scenes (NFF) have their own");
  EXPECT_NO_THROW((void)plan_of(request, kPacked)) << "nobody knows before it is read";
  EXPECT_NE(refusal(request, {.kind = SceneKind::kPacked, .is_read = true}).find("scene has no lights"),
            std::string::npos);
  request.accuracy = Accuracy::kPaper;
  EXPECT_NE(refusal(request, kText).find("--accuracy paper: has no --shading scene"), std::string::npos);
}

TEST(RenderPlan, RefusesWhatTheHostCannotRun) {
  tool::RenderRequest request = render_request("grid");
  request.lanes = 16;
  EXPECT_EQ(refusal(request), "--lanes: this host and this build (GRIDIRON_WIDE_LANES) have at most 8 lanes");
  request.lanes.reset();
  request.mode = sim::Mode::kInstrumented;
  EXPECT_EQ(refusal(request), "--mode instrumented: this build has no instrumented kernel");
}

TEST(InfoPlan, TheDefaultConfigurationIsCompleted) {
  tool::InfoRequest request;
  request.scene = scene_request("best");
  request.scene.configuration = nullptr;
  const auto name = [&](const tool::KnownScene& scene) {
    return tool::resolve(request, scene).scene.configuration->name;
  };
  EXPECT_EQ(name(kMesh), "best");
  EXPECT_EQ(name(kText), "best");
  EXPECT_EQ(name({.kind = SceneKind::kPacked, .is_read = true, .has_tree = false}), "grid");
  EXPECT_EQ(name({.kind = SceneKind::kPacked, .is_read = true, .has_tree = false, .has_projection = true}),
            "reference");
  request.format = TriangleFormat::kProjection;
  EXPECT_EQ(name(kMesh), "reference");
  request.format.reset();
  request.layout.store = StoreSize::k128KB;
  EXPECT_EQ(name(kMesh), "best");
}

TEST(InfoPlan, SettlesTheLocalStoreThatIsToldOf) {
  tool::InfoRequest request;
  request.scene = scene_request("grid");
  request.layout.store = StoreSize::k128KB;
  EXPECT_EQ(tool::resolve(request, kMesh).layout.store, StoreSize::k128KB);
  const tool::InfoPlan text = tool::resolve(request, kText);
  EXPECT_EQ(text.store, StoreSize::k128KB);
  EXPECT_EQ(text.layout.store, StoreSize::k256KB) << "effects have no map in 128 KB";
  EXPECT_EQ(text.local_store.packet_width, 32u);
  request.accuracy = Accuracy::kCompact;
  EXPECT_EQ(tool::resolve(request, kMesh).format, TriangleFormat::kLattice);
  request.format = TriangleFormat::kVertices;
  EXPECT_THROW((void)tool::resolve(request, kMesh), tool::Failure);
}

}  // namespace
}  // namespace gridiron::test
