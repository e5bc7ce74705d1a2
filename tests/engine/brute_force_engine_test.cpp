// The seam between engines: engines that core does not know render the frames of grid and tree, effects and all, and
// the simulated chip runs, counts and replays it. SPDX-License-Identifier: Apache-2.0
#include "engine/brute_force_engine.h"

#include <gridiron/render/tile_renderer.h>
#include <gridiron/sim/core_runner.h>
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/replay.h>

#include <nlohmann/json.hpp>

#include "effects/kernel_scene.h"
#include "report/report.h"
#include "report/timeline.h"
#include "scene_text/scene_reader.h"
#include "support/render_mesh.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using BruteForceFrame = Frame<BruteForceRecord>;

template <std::uint32_t Effects, std::uint32_t TileWidth>
struct BruteForceLayout {
  using Engine = BruteForceEngine;
  using RayEngine = BruteForceRays;
  static constexpr std::uint32_t kEffects = Effects;
  static constexpr std::uint32_t kArenaBytes = 256 * 1024;
  static constexpr std::uint32_t kCodeBudgetBytes = 92 * 1024;
  static constexpr std::uint32_t kStackBudgetBytes = 9 * 1024;
  static constexpr std::uint32_t kTileWidth = TileWidth;
  static constexpr std::uint32_t kPacketWidth = 8;
  static constexpr std::uint32_t kMaxOutputDepth = 2;
  static constexpr std::uint32_t kWaveRays = 64;
  static constexpr std::uint32_t kMaterialSlots = 8;
  static constexpr std::uint32_t kLightSlots = 4;
};
// What the host knows of it.
constexpr sim::WorkKind kBruteForceKinds[] = {{BruteForceWork::kBuffer, "buffer_read", true},
                                              {BruteForceWork::kTriangle, "triangle_tried"}};
constexpr double kBufferCycles = 64, kTriangleCycles = 3;
constexpr sim::WorkPrice kBruteForcePrices[] = {{BruteForceWork::kBuffer, kBufferCycles},
                                                {BruteForceWork::kTriangle, kTriangleCycles}};
constexpr sim::EngineWork kDescription = {.id = BruteForceEngine::kId,
                                          .name = "brute_force",
                                          .kinds = kBruteForceKinds,
                                          .prices = kBruteForcePrices,
                                          .wait_levels = {"planes", "nothing", "all_triangles", "record"}};
constexpr sim::EngineWork kBruteForce = sim::EngineWork::make(BruteForceWork::kEnd, kDescription);

// Whether the description would still compile after a change.
template <class Change>
consteval bool is_whole_after(Change change) {
  sim::EngineWork engine = kDescription;
  change(engine);
  return sim::EngineWork::is_whole(BruteForceWork::kEnd, engine);
}
constexpr sim::WorkKind kSwapped[] = {kBruteForceKinds[1], kBruteForceKinds[0]};
constexpr sim::WorkKind kNameless[] = {kBruteForceKinds[0], {BruteForceWork::kTriangle, ""}};
constexpr sim::WorkKind kNamedAlike[] = {kBruteForceKinds[0], {BruteForceWork::kTriangle, "buffer_read"}};
constexpr sim::WorkKind kNamedAsShared[] = {kBruteForceKinds[0], {BruteForceWork::kTriangle, "triangle_setup"}};
static_assert(is_whole_after([](sim::EngineWork&) {}));
static_assert(!is_whole_after([](sim::EngineWork& engine) { engine.name = ""; }));
static_assert(!is_whole_after([](sim::EngineWork& engine) { engine.id = sim::kGridEngine.id; }));
static_assert(!is_whole_after([](sim::EngineWork& engine) { engine.id = sim::kTreeEngine.id; }));
static_assert(!is_whole_after([](sim::EngineWork& engine) { engine.wait_levels[2] = ""; }));
static_assert(!is_whole_after([](sim::EngineWork& engine) { engine.prices = engine.prices.first(1); }));
static_assert(!is_whole_after([](sim::EngineWork& engine) { engine.kinds = engine.kinds.first(1); }));
static_assert(!is_whole_after([](sim::EngineWork& engine) { engine.kinds = kSwapped; }));
static_assert(!is_whole_after([](sim::EngineWork& engine) { engine.kinds = kNameless; }));
static_assert(!is_whole_after([](sim::EngineWork& engine) { engine.kinds = kNamedAlike; }));
static_assert(!is_whole_after([](sim::EngineWork& engine) { engine.kinds = kNamedAsShared; }));

using GridLayout = EffectLayout256K<kAllEffects, 8>;
static_assert(kFitsArena<BruteForceLayout<0, 32>> && kFitsArena<BruteForceLayout<kAllEffects, 16>>);

// The grid's frame as this engine's: the same head, and all triangle records of the image.
BruteForceFrame brute_force_frame(const FrameRecord& grid) {
  BruteForceFrame frame{};
  static_cast<FrameHead&>(frame) = grid;
  frame.engine_id = BruteForceEngine::kId;
  frame.engine = {grid.engine.triangles_address, grid.engine.grid.reference_count, 0};
  return frame;
}

void make_brute_force(FrameRecord& record) {
  const BruteForceFrame frame = brute_force_frame(record);
  static_assert(sizeof frame <= sizeof record);
  std::memcpy(static_cast<void*>(&record), &frame, sizeof frame);
}

KernelScene everything(tool::SceneDescription& scene, const KernelOptions& options) {
  scene = tool::read_scene_text(GRIDIRON_SOURCE_DIR "/scenes/everything.nff");
  return build_kernel_scene(scene, options);
}

// Edges of tiles lie across both edges of the picture.
constexpr std::uint32_t kWidth = 37, kHeight = 27;

// @param shipped  the frame by grid and tree.
void expect_same_frames(KernelScene& built, const Camera& camera, std::uint32_t width, std::uint32_t height,
                        KernelPicture& shipped) {
  ASSERT_EQ(built.status, Status::kOk);
  KernelOptions options;
  options.wants_planes = true;
  shipped = render_kernel<GridLayout>(built, camera, width, height, options);
  ASSERT_EQ(shipped.status, Status::kOk) << shipped.violation;
  options.alter = make_brute_force;
  options.fetch_depth = 1;
  const KernelPicture brute_force =
      render_kernel<BruteForceLayout<kAllEffects, 16>>(built, camera, width, height, options);
  ASSERT_EQ(brute_force.status, Status::kOk) << brute_force.violation;
  EXPECT_EQ(brute_force.color, shipped.color);
  EXPECT_EQ(brute_force.depth, shipped.depth);
  EXPECT_EQ(brute_force.ids, shipped.ids);
  // Shading does the same for every engine; only part of its order depends on the engine.
  for (const Work kind : {Work::kWaveRay, Work::kShadowRay, Work::kSurfacePoint, Work::kQueuedRay, Work::kColorAdded}) {
    EXPECT_EQ(brute_force.work[kind], shipped.work[kind]) << static_cast<int>(kind);
  }
}

TEST(BruteForceEngine, RendersEffectsAsGridAndTreeDo) {
  tool::SceneDescription scene;
  KernelScene built = everything(scene, {});
  KernelPicture shipped;
  expect_same_frames(built, camera_of(scene.view), kWidth, kHeight, shipped);
}

// Hills of 2 * cells^2 triangles in the middle of the scene, in turn of each of its materials without normals.
void add_hills(tool::SceneDescription& scene, std::uint32_t cells) {
  std::vector<std::uint16_t> materials;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    if (!scene.materials[i].smooth_normals) materials.push_back(static_cast<std::uint16_t>(i));
  }
  tool::SceneGeometry& geometry = scene.geometry;
  const TestMesh hills = moved(make_height_field(cells, 0.3f, 7), 2.0f, {0, 1, 0});
  const auto first = static_cast<std::uint32_t>(geometry.vertices.size());
  geometry.vertices.insert(geometry.vertices.end(), hills.vertices.begin(), hills.vertices.end());
  for (const UVec3& t : hills.triangles) {
    geometry.triangle_materials.push_back(materials[geometry.triangles.size() % materials.size()]);
    geometry.triangles.push_back(t + UVec3(first));
    geometry.triangle_normals.push_back(UVec3(tool::kNoNormal));
  }
}

// GRIDIRON_BRUTE_FORCE_CELLS: of the hills; 1000 for 2 million triangles.
TEST(BruteForceEngine, RendersManyTrianglesAsGridAndTreeDo) {
  const char* const wanted = std::getenv("GRIDIRON_BRUTE_FORCE_CELLS");
  tool::SceneDescription scene = tool::read_scene_text(GRIDIRON_SOURCE_DIR "/scenes/everything.nff");
  const auto first = static_cast<std::uint32_t>(scene.geometry.triangles.size());
  add_hills(scene, wanted == nullptr ? 40 : static_cast<std::uint32_t>(std::atoi(wanted)));
  scene.samples_per_pixel = 1;
  scene.recursion_depth = 3;
  scene.view.angle_degrees = 15;
  KernelScene built = build_kernel_scene(scene, {});
  KernelPicture shipped;
  expect_same_frames(built, camera_of(scene.view), 8, 8, shipped);
  const auto is_of_hills = [first](std::uint32_t id) { return id >= first && id != kNoTriangle; };
  EXPECT_GT(std::count_if(shipped.ids.begin(), shipped.ids.end(), is_of_hills), 16);
  for (const Work kind :
       {Work::kShadowRay, Work::kAreaPlace, Work::kOcclusionRay, Work::kMirrorRay, Work::kRefractedRay}) {
    EXPECT_GT(shipped.work[kind], 0u) << static_cast<int>(kind);
  }
}

TEST(BruteForceEngine, FramesOfOtherEnginesAreRefused) {
  tool::SceneDescription scene;
  KernelOptions options;
  KernelScene built = everything(scene, options);
  const Camera camera = camera_of(scene.view);
  const auto status_of = [&](auto layout, void (*alter)(FrameRecord&), std::uint32_t fetch_depth) {
    options.alter = alter;
    options.fetch_depth = fetch_depth;
    return render_kernel<decltype(layout)>(built, camera, kWidth, kHeight, options).status;
  };
  using BruteForce = BruteForceLayout<kAllEffects, 16>;
  EXPECT_EQ(status_of(BruteForce{}, nullptr, 1), Status::kUnsupportedFrame);
  EXPECT_EQ(status_of(GridLayout{}, make_brute_force, 1), Status::kUnsupportedFrame);
  EXPECT_EQ(status_of(BruteForce{}, make_brute_force, 2), Status::kUnsupportedFrame)
      << "more groups than it has room for";
  const auto make_exact = [](FrameRecord& record) {
    make_brute_force(record);
    record.accuracy = static_cast<std::uint32_t>(Accuracy::kExact);
  };
  EXPECT_EQ(status_of(BruteForce{}, make_exact, 1), Status::kUnsupportedFrame);
}

// Its kinds of work and its waits stand in the report by the names that it brings.
void expect_reported(const sim::ChipResult& result, const sim::MachineProfile& machine, std::uint32_t triangle_count) {
  tool::ReportInput input;
  input.machine = machine;
  input.work = result.work;
  input.timing = sim::replay(result.trace, machine, {.core_count = 1, .timeline = true});
  const auto report = nlohmann::json::parse(tool::report_json(input));
  const auto& work = report["work"];
  EXPECT_EQ(work.size(), kSharedWorkCount + 2);
  EXPECT_EQ(work["tile_start"], 9);
  EXPECT_FALSE(work.contains("packet_start")) << "of the grid";
  const std::uint64_t buffers = work["buffer_read"];
  EXPECT_GT(buffers, 0u);
  EXPECT_EQ(work["triangle_tried"], buffers / ((triangle_count + 63) / 64) * triangle_count);
  const auto& waits = report["cores"][0]["dma_wait_cycles"];
  EXPECT_EQ(waits["nothing"], 0.0);
  EXPECT_GT(waits["all_triangles"], 0.0);
  EXPECT_NE(tool::timeline_json(input.timing, machine).find("wait all_triangles"), std::string::npos);
  // What its kinds cost, against the same frame with kinds that cost nothing: buffers count as initialisation.
  sim::EngineWork free_of_charge = kBruteForce;
  constexpr sim::WorkPrice kNothing[] = {{BruteForceWork::kBuffer, 0}, {BruteForceWork::kTriangle, 0}};
  free_of_charge.prices = kNothing;
  sim::FrameTrace trace = result.trace;
  trace.engine = &free_of_charge;
  const sim::CoreTiming free = sim::replay(trace, machine, {.core_count = 1}).cores[0];
  const sim::CoreTiming& core = input.timing.cores[0];
  EXPECT_EQ(core.init_cycles - free.init_cycles, kBufferCycles * static_cast<double>(buffers));
  EXPECT_EQ(core.compute_cycles - free.compute_cycles, kTriangleCycles * work["triangle_tried"].get<double>());
}

// On the simulated chip, every rule checked; counted, replayed and reported like any other program of a core.
TEST(BruteForceEngine, RunsOnTheSimulatedChip) {
  using Layout = BruteForceLayout<0, 32>;
  const TestMesh mesh = joined(make_sphere(9, 14, 0.8f), make_random_soup(60, 0.3f, 5));
  SceneInMemory scene(mesh.view(), {});
  ASSERT_EQ(scene.status(), Status::kOk);
  FrameSettings settings;
  settings.camera.eye = {0.7f, 0.5f, 2.9f};
  settings.width = 90;
  settings.height = 70;
  settings.tile_width = Layout::kTileWidth;
  for (const Shading shading : {Shading::kSimple, Shading::kNone}) {
    settings.shading = shading;
    sim::ChipOptions chip;
    chip.threads = 3;
    PreparedFrame frame = scene.prepare(settings, chip);
    ASSERT_EQ(frame.status(), Status::kOk);
    ASSERT_EQ(frame.render(chip).status, Status::kOk);
    const Planes expected = frame.planes();
    const FrameRecord grid = frame.record();
    FrameRecord record = grid;
    make_brute_force(record);
    frame.set_record(record);
    const sim::ChipResult result = frame.run(
        chip, sizeof(LocalStore<Layout>),
        [](sim::SimCore& core, std::span<std::byte> data, MainAddress address) {
          auto& store = *::new (static_cast<void*>(data.data())) LocalStore<Layout>;
          return render_tiles<Lanes<4>>(store, core, address);
        },
        kBruteForce);
    ASSERT_EQ(result.status, Status::kOk);
    EXPECT_TRUE(result.violations.empty());
    EXPECT_EQ(frame.planes(), expected);
    const auto count_of = [&](WorkId kind) { return result.work[kind.number()]; };
    EXPECT_EQ(count_of(Work::kTileStart), 9u);
    EXPECT_GT(count_of(Work::kTriangleSetup), 0u);
    // One core needs longer than three, and no core waits for cell blocks.
    const sim::MachineProfile machine = *sim::find_machine_profile("cell-ps3");
    const sim::FrameTiming one = sim::replay(result.trace, machine, {.core_count = 1});
    const sim::FrameTiming three = sim::replay(result.trace, machine, {.core_count = 3});
    EXPECT_GT(one.frame_cycles, 2 * three.frame_cycles);
    EXPECT_EQ(one.cores[0].dma_wait_cycles[static_cast<std::size_t>(sim::WaitLevel::kMacroCell)], 0.0);
    EXPECT_GT(one.cores[0].dma_wait_cycles[static_cast<std::size_t>(sim::WaitLevel::kTriangle)], 0.0);
    expect_reported(result, machine, grid.engine.grid.reference_count);
  }
}

}  // namespace
}  // namespace gridiron::test
