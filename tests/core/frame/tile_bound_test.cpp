// The worst tile: no tile of any frame exceeds it in any count; some counts are reached.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/frame/tile_bound.h>
#include <gridiron/scene/effects.h>
#include <gridiron/sim/compiled_layouts.h>
#include <gridiron/sim/replay.h>
#include <gridiron/sim/sim_chip.h>
#include <gridiron/sim/tile_cycles.h>
#include <gridiron/sim/trace_packing.h>

#include <initializer_list>

#include "core/scene/test_effects.h"
#include "support/instrumented.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

// What one tile did.
struct TileCounts {
  std::array<std::uint64_t, kWorkKindCount> work{};
  std::uint64_t get_bytes = 0, put_bytes = 0;

  [[nodiscard]] std::uint64_t operator[](WorkId kind) const { return work[kind.number()]; }
};

TileCounts counts_of(const sim::TileTrace& tile) {
  TileCounts counts;
  const auto of = [&](WorkId kind) -> std::uint64_t& { return counts.work[kind.number()]; };
  sim::for_each_event(tile, [&](const sim::TraceEvent& event) {
    if (event.kind == sim::EventKind::kGet) {
      ++of(Work::kGetIssue);
      counts.get_bytes += event.bytes;
    } else if (event.kind == sim::EventKind::kPut) {
      ++of(Work::kPutIssue);
      counts.put_bytes += event.bytes;
    } else if (event.kind == sim::EventKind::kWait) {
      ++of(Work::kWait);
    } else if (event.kind == sim::EventKind::kWork) {
      for (const sim::WorkAmount& amount : event.work) {
        if (!sim::is_charged_as_event(amount.kind)) of(amount.kind) += amount.amount;
      }
    }
  });
  return counts;
}

constexpr std::uint32_t kMostPixels = 64;

// How a frame is rendered: what the bound depends on.
struct Way {
  const char* name;
  sim::LayoutChoice layout;
  TileFrame frame;
};

TileLayout layout_of(const sim::LayoutChoice& choice) {
  TileLayout layout{};
  const auto take = [&]<class Layout>() { layout = tile_layout_of<Layout>(4); };
  EXPECT_TRUE(choice.has_effects ? sim::visit_layout(sim::EffectLayouts{}, choice, take)
                                 : sim::visit_layout(sim::CommonLayouts{}, choice, take) ||
                                       sim::visit_layout(sim::SweepLayouts{}, choice, take));
  return layout;
}

// A scene's image in simulated memory, with space for frames.
class BoundedScene {
 public:
  BoundedScene(const MeshView& mesh, GridParameters parameters, Accuracy accuracy,
               const EffectsView* effects = nullptr) {
    parameters.format = accuracy == Accuracy::kPaper     ? TriangleFormat::kProjection
                        : accuracy == Accuracy::kCompact ? TriangleFormat::kLattice
                                                         : TriangleFormat::kVertices;
    GridNeed need;
    EXPECT_EQ(count_scene_image(mesh, parameters, need, effects), Status::kOk);
    memory_ = std::make_unique<sim::SimMemory>(need.image_bytes + (std::uint64_t{4} << 20));
    image_ = *memory_->allocate(need.image_bytes);
    std::vector<std::uint64_t> scratch(need.scratch_bytes / 8 + 1);
    const std::span<std::byte> scratch_bytes = std::as_writable_bytes(std::span(scratch));
    EXPECT_EQ(build_scene_image(mesh, parameters, need, image_.bytes, scratch_bytes, effects), Status::kOk);
    SceneImageError error;
    EXPECT_EQ(open_scene_image(image_.bytes, view_, error), Status::kOk);
    // Planes that begin anywhere: 128 bytes into a boundary.
    (void)memory_->allocate(kLineBytes);
    for (sim::MemoryRegion& plane : planes_) plane = *memory_->allocate(kMostPixels * kMostPixels * 4);
    record_ = *memory_->allocate(sizeof(FrameRecord));
    spill_.bytes_per_core = spill_bytes(kMaxRecursionDepth);
    spill_.address = memory_->allocate(spill_.slice_bytes(), kSpillAlignment)->address;
  }

  [[nodiscard]] TileScene counts(const Way& way) const {
    return count_tile_scene(image_.bytes, view_, layout_of(way.layout));
  }
  [[nodiscard]] TileBound bound(const Way& way) const {
    return worst_tile(counts(way), layout_of(way.layout), way.frame);
  }

  // Renders one frame. @returns nothing where the camera is refused.
  [[nodiscard]] std::optional<sim::FrameTrace> render(const Way& way, const Camera& camera, std::uint32_t width,
                                                      std::uint32_t height) {
    FrameSettings settings;
    settings.camera = camera;
    settings.width = width;
    settings.height = height;
    settings.tile_width = way.layout.tile_width;
    settings.accuracy = way.frame.accuracy;
    settings.shading = way.frame.shading;
    settings.techniques = way.frame.techniques;
    settings.output_depth = way.frame.output_depth;
    settings.macro_depth = way.frame.macro_depth;
    settings.triangle_depth = way.frame.triangle_depth;
    settings.fetch_depth = way.frame.fetch_depth;
    settings.color = planes_[0].address;
    if (way.frame.has_depth) settings.depth = planes_[1].address;
    if (way.frame.has_ids) settings.ids = planes_[2].address;
    FrameRecord record;
    if (make_frame_record(settings, view_, image_.address, record) != Status::kOk) return {};
    std::memcpy(record_.bytes.data(), &record, sizeof record);
    sim::ChipOptions chip;
    chip.store = way.layout.store;
    chip.packet_width = way.layout.packet_width;
    chip.limits.queue_depth = way.frame.queue_depth;
    chip.spill = spill_;
    sim::ChipResult result = render_in_test(*memory_, record_.address, chip);
    EXPECT_EQ(result.status, Status::kOk);
    return std::move(result.trace);
  }

 private:
  std::unique_ptr<sim::SimMemory> memory_;
  sim::MemoryRegion image_{}, planes_[3], record_{};
  sim::SpillMemory spill_;
  SceneImageView view_{};
};

void expect_within(const TileCounts& tile, const TileBound& bound, const std::string& name) {
  for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) {
    EXPECT_LE(tile.work[kind], bound.work[kind]) << name << ", kind " << kind;
  }
  EXPECT_LE(tile.get_bytes, bound.get_bytes) << name;
  EXPECT_LE(tile.put_bytes, bound.put_bytes) << name;
}

// Inside, outside and far away; narrow and wide.
Camera any_camera(TestRandom& random) {
  const float distance = random.below(3) == 0 ? random.between(2.0f, 60.0f) : random.between(0.0f, 1.5f);
  const auto coordinate = [&] { return random.between(-1.0f, 1.0f); };
  Camera camera;
  camera.eye = distance * Vec3(coordinate(), coordinate(), coordinate());
  camera.at = 0.5f * Vec3(coordinate(), coordinate(), coordinate());
  camera.up = {0.1f, 1, 0.2f};
  camera.tan_half_fov = std::pow(10.0f, random.between(-2.5f, 1.5f));
  return camera;
}

void expect_all_tiles_within(BoundedScene& scene, const Way& way, std::uint32_t frames, std::uint64_t seed) {
  const TileBound bound = scene.bound(way);
  const sim::MachineProfile& machine = sim::machine_profiles().front();
  const double most_cycles = sim::worst_tile_cycles(bound, machine, way.frame.output_depth).total();
  TestRandom random(seed);
  for (std::uint32_t i = 0; i < frames; ++i) {
    const Camera camera = any_camera(random);
    const std::uint32_t width = 1 + random.below(kMostPixels - 16), height = 1 + random.below(kMostPixels - 16);
    const auto trace = scene.render(way, camera, width, height);
    if (!trace) continue;
    const std::string name = std::string(way.name) + ", seed " + std::to_string(seed) + ", frame " + std::to_string(i);
    for (const sim::TileTrace& tile : trace->tiles) expect_within(counts_of(tile), bound, name);
    const sim::FrameTiming timing = sim::replay(*trace, machine, {.timeline = true});
    for (const sim::TimelineSpan& span : timing.timeline) {
      if (span.kind != sim::TimelineSpan::Kind::kTile) continue;
      EXPECT_LE(span.end_cycles - span.begin_cycles, most_cycles) << name;
    }
    if (testing::Test::HasFailure()) return;
  }
}

using sim::StoreSize;
constexpr std::uint32_t kReference = kUseMailbox | kUseCornerCulling | kUseEmptySkip;
constexpr std::uint32_t kAll = kReference | kUseSubpackets;

const Way kWays[] = {
    {"reference", {StoreSize::k256KB, 32, 8}, {}},
    {"simple, planes, short queue", {StoreSize::k256KB, 32, 8}, {.has_depth = true, .has_ids = true, .queue_depth = 2}},
    {"best",
     {StoreSize::k256KB, 32, 32},
     {.techniques = kAll & ~kUseCornerCulling, .macro_depth = 4, .triangle_depth = 3}},
    {"exact", {StoreSize::k256KB, 32, 32}, {.accuracy = Accuracy::kExact, .techniques = kAll, .has_depth = true}},
    {"exact, small packets", {StoreSize::k64KB, 16, 4}, {.accuracy = Accuracy::kExact, .techniques = 0}},
    {"fast", {StoreSize::k64KB, 16, 16}, {.accuracy = Accuracy::kFast, .shading = Shading::kNone, .techniques = kAll}},
    {"paper", {StoreSize::k256KB, 32, 16}, {.accuracy = Accuracy::kPaper, .techniques = kAll, .output_depth = 1}},
    {"paper, nothing skipped", {StoreSize::k64KB, 16, 8}, {.accuracy = Accuracy::kPaper, .techniques = 0}},
    {"compact", {StoreSize::k256KB, 32, 8}, {.accuracy = Accuracy::kCompact, .techniques = kAll, .has_depth = true}},
    {"compact, tiles of 64", {StoreSize::k512KB, 64, 32}, {.accuracy = Accuracy::kCompact, .has_ids = true}},
};

TEST(TileBound, NoTileOfAnyFrameExceedsIt) {
  // Cells with many triangles, few, and none; ties by the dozen; a table longer than the smallest store's.
  const TestMesh ties = joined(make_sphere(6, 8, 0.8f), make_sphere(6, 8, 0.8f));
  TestMesh room = make_box({-1, -1, -1}, {1, 1, 1});
  room.append(make_sliver_fan(300, 0.001f));
  const TestMesh soup = make_random_soup(1500, 0.2f, 5), torus = make_torus(40, 20, 0.7f, 0.25f);
  const struct {
    const TestMesh& mesh;
    GridParameters grid;
  } scenes[] = {
      {soup, {.lambda = 4.0f}}, {torus, {.lambda = 60.0f, .macro_width = 2}}, {ties, {}}, {room, {.lambda = 0.4f}}};
  std::uint64_t seed = 1;
  for (const Way& way : kWays) {
    for (const auto& [mesh, grid] : scenes) {
      BoundedScene scene(mesh.view(), grid, way.frame.accuracy);
      expect_all_tiles_within(scene, way, 6, seed++);
    }
  }
}

TEST(TileBound, NorDoesOneOfASceneWithEffects) {
  TestEffects subject = all_effects();
  const Way ways[] = {
      {"packets of 8",
       {StoreSize::k256KB, 32, 8, true},
       {.shading = Shading::kScene, .has_depth = true, .has_ids = true}},
      {"packets of 32",
       {StoreSize::k256KB, 32, 32, true},
       {.shading = Shading::kScene, .techniques = kAll, .macro_depth = 4, .triangle_depth = 3, .fetch_depth = 8}},
      {"exact", {StoreSize::k256KB, 32, 32, true}, {.accuracy = Accuracy::kExact, .shading = Shading::kScene}},
      {"compact", {StoreSize::k256KB, 32, 8, true}, {.accuracy = Accuracy::kCompact, .shading = Shading::kScene}},
      {"64 KB", {StoreSize::k64KB, 8, 0, true}, {.shading = Shading::kScene, .has_ids = true}},
      {"64 KB, fast, short queue",
       {StoreSize::k64KB, 8, 0, true},
       {.accuracy = Accuracy::kFast, .shading = Shading::kScene, .queue_depth = 1}},
  };
  std::uint64_t seed = 100;
  for (const bool is_large : {false, true}) {
    if (is_large) {
      // More lights and materials than are at hand, and deep bounces: rays wait in main memory.
      for (int i = 0; i < 20; ++i) subject.lights.insert(subject.lights.begin(), subject.lights.front());
      for (int i = 0; i < 80; ++i) subject.materials.push_back(subject.materials.front());
      subject.triangle_materials = {70, 1, 1, 75};
      subject.settings.recursion_depth = kMaxRecursionDepth;
      subject.settings.samples_per_pixel = 1;
      subject.settings.occlusion_samples = 1;
    }
    const EffectsView effects = subject.view();
    for (const Way& way : ways) {
      BoundedScene scene(subject.mesh(), {.lambda = 4.0f, .macro_width = 2}, way.frame.accuracy, &effects);
      expect_all_tiles_within(scene, way, 3, seed++);
    }
  }
}

// One packet from afar: a pass goes through the whole grid and tests every reference.
TEST(TileBound, IsReachedPerPassByAPacketThatSeesAll) {
  const TestMesh soup = make_random_soup(400, 0.3f, 9);
  const Way way{
      "all", {StoreSize::k64KB, 16, 16}, {.accuracy = Accuracy::kFast, .shading = Shading::kNone, .techniques = 0}};
  BoundedScene scene(soup.view(), {.lambda = 4.0f, .macro_width = 3}, way.frame.accuracy);
  const TileBound bound = scene.bound(way);
  // Along each axis: of slices the longest counts.
  std::uint64_t most_slices = 0;
  for (const Vec3 along : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    Camera camera;
    camera.eye = 40.0f * along;
    camera.at = {0, 0, 0};
    camera.up = {along.y, along.z, along.x};
    camera.tan_half_fov = 0.06f;
    const auto trace = scene.render(way, camera, 16, 16);
    ASSERT_TRUE(trace.has_value());
    ASSERT_EQ(trace->tiles.size(), 1u);
    const TileCounts tile = counts_of(trace->tiles[0]);
    const std::uint64_t passes = bound[GridWork::kPacketStart];
    ASSERT_EQ(tile[GridWork::kPacketStart], 1u);
    EXPECT_EQ(passes, 7u) << "six, and one for a ray without a direction";
    for (const WorkId kind :
         std::initializer_list<WorkId>{GridWork::kMacroCellStep, GridWork::kMacroCellVisit, GridWork::kCellStep,
                                       GridWork::kCellVisit, GridWork::kTriangleBatch, Work::kTriangleSetup}) {
      EXPECT_EQ(passes * tile[kind], bound[kind]) << "kind " << kind.number();
    }
    most_slices = std::max(most_slices, tile[GridWork::kSliceStep]);
    for (const Work kind : {Work::kTileStart, Work::kRayGenerated, Work::kShadedGroup}) {
      EXPECT_EQ(tile[kind], bound[kind]) << "kind " << static_cast<int>(kind);
    }
    EXPECT_EQ(tile.put_bytes, bound.put_bytes);
    // Boundaries that lie between two transfers are charged to one of them.
    EXPECT_LE(10 * bound[Work::kGetIssue], 11 * passes * tile[Work::kGetIssue]);
  }
  EXPECT_EQ(bound[GridWork::kSliceStep], bound[GridWork::kPacketStart] * most_slices);
}

// From the middle of the grid rays march along nearly all axes both ways, each through a half of it.
TEST(TileBound, IsWithinAFactorOfTwelveOfAPacketInTheMiddleOfAll) {
  const TestMesh soup = make_random_soup(400, 0.3f, 9);
  const Way way{
      "all", {StoreSize::k64KB, 16, 16}, {.accuracy = Accuracy::kFast, .shading = Shading::kNone, .techniques = 0}};
  BoundedScene scene(soup.view(), {.lambda = 4.0f, .macro_width = 3}, way.frame.accuracy);
  const TileBound bound = scene.bound(way);
  Camera camera;
  camera.eye = {0.01f, 0.02f, 0.03f};
  camera.at = {1, 1, 1};
  camera.up = {0, 1, 0.1f};
  camera.tan_half_fov = 20.0f;
  const auto trace = scene.render(way, camera, 16, 16);
  ASSERT_TRUE(trace.has_value());
  const TileCounts tile = counts_of(trace->tiles[0]);
  EXPECT_GE(tile[GridWork::kPacketStart], 5u);
  for (const WorkId kind : std::initializer_list<WorkId>{
           GridWork::kMacroCellStep, GridWork::kMacroCellVisit, GridWork::kCellStep, GridWork::kCellVisit,
           GridWork::kTriangleBatch, Work::kTriangleSetup, Work::kGetIssue, Work::kWait}) {
    EXPECT_LE(bound[kind], 12 * tile[kind]) << "kind " << kind.number();
  }
  EXPECT_LE(bound.get_bytes, 12 * tile.get_bytes);
}

// A floor that fills the view and faces its lights: every ray hits and is lit.
TEST(TileBound, RaysByKindAreReachedOnALitFloor) {
  TestEffects subject = all_effects();
  subject.vertices = {{-50, 0, -50}, {50, 0, -50}, {0, 0, 80}};
  subject.triangles = {{0, 2, 1}};
  subject.triangle_materials = {1};
  subject.normals = {{0, 1, 0}};
  subject.triangle_normals = {{0, 0, 0}};
  subject.triangle_colors = {{0, 1, 0}};
  for (Light& light : subject.lights) {
    light.corner = {0, 9, 0};
    if (light.samples != 0) light.edge_u = {1, 0, 0}, light.edge_v = {0, 0, 1};
  }
  subject.settings.recursion_depth = 1;
  const EffectsView effects = subject.view();
  const Way way{"floor", {StoreSize::k256KB, 32, 8, true}, {.shading = Shading::kScene}};
  BoundedScene scene(subject.mesh(), {}, way.frame.accuracy, &effects);
  const TileBound bound = scene.bound(way);
  Camera camera;
  camera.eye = {0, 6, 0};
  camera.at = {0, 0, 0.01f};
  camera.up = {0, 0, 1};
  const auto trace = scene.render(way, camera, 32, 32);
  ASSERT_TRUE(trace.has_value());
  const TileCounts tile = counts_of(trace->tiles[0]);
  for (const Work kind : {Work::kWaveRay, Work::kQueuedRay, Work::kSurfacePoint, Work::kShadowRay, Work::kLightSample,
                          Work::kOcclusionRay, Work::kColorAdded, Work::kColorGroup, Work::kSmoothNormal,
                          Work::kVertexColor, Work::kSrgbLevel, Work::kListRay}) {
    EXPECT_EQ(tile[kind], bound[kind]) << "kind " << static_cast<int>(kind);
  }
}

// Triangles of one bounding box: a ray that meets it enters every node and leaf. One pixel has one ray, whose lists are
// its own, where a tile has 64.
TEST(TileBound, ListsAreReachedByARayThatMeetsEveryBox) {
  TestEffects subject = all_effects();
  subject.vertices = {{-1, -1, -1}, {1, 1, 1}};
  subject.triangles.clear();
  TestRandom random(3);
  for (std::uint32_t i = 0; i < 200; ++i) {
    const auto coordinate = [&] { return random.between(-0.9f, 0.9f); };
    subject.vertices.emplace_back(coordinate(), coordinate(), coordinate());
    subject.triangles.emplace_back(0, 1, i + 2);
  }
  subject.triangle_materials.assign(subject.triangles.size(), 0);
  subject.triangle_normals.assign(subject.triangles.size(), UVec3(kNoNormals));
  subject.triangle_colors = subject.triangle_normals;
  subject.lights.clear();
  subject.settings.recursion_depth = 1;
  subject.settings.occlusion_samples = 0;
  subject.settings.samples_per_pixel = 1;
  const EffectsView effects = subject.view();
  const Way way{"one box", {StoreSize::k64KB, 8, 0, true}, {.shading = Shading::kScene}};
  BoundedScene scene(subject.mesh(), {}, way.frame.accuracy, &effects);
  const TileBound bound = scene.bound(way);
  const TileScene counts = scene.counts(way);
  ASSERT_GT(counts.nodes, 2u);
  ASSERT_EQ(counts.tree_triangles, 200u);
  Camera camera;
  camera.eye = {0.3f, -0.2f, 6};
  camera.at = {0.1f, 0.1f, 0};
  const auto trace = scene.render(way, camera, 1, 1);
  ASSERT_TRUE(trace.has_value());
  const TileCounts tile = counts_of(trace->tiles[0]);
  ASSERT_EQ(tile[Work::kListRay], 1u);
  constexpr std::uint64_t kRays = 64;
  for (const Work kind : {Work::kListRay, Work::kListNode, Work::kListLeaf, Work::kListTriangleGroup}) {
    EXPECT_EQ(kRays * tile[kind], bound[kind]) << "kind " << static_cast<int>(kind);
  }
  // The root is no one's child, and not all nodes have boxes in all quads.
  EXPECT_EQ(kRays * (tile[Work::kListChild] + 1), bound[Work::kListChild]);
  // Nodes of few children have no lists for their quads; of the others each quad has a list of this ray.
  const std::uint64_t quads = tile[Work::kListBoxQuad];
  EXPECT_GE(tile[Work::kListEntry], tile[Work::kListChild] + 2 * tile[Work::kListRayNode]);
  EXPECT_LT(tile[Work::kListEntry], tile[Work::kListChild] + quads);
  EXPECT_EQ(bound[Work::kListEntry], bound[Work::kListChild] + bound[Work::kListBoxQuad]);
  EXPECT_GE(4 * tile[Work::kListBoxQuad], tile[Work::kListChild]) << "a child in no quad";
  expect_within(tile, bound, way.name);
  // Each child may be fetched twice; here it is once.
  EXPECT_LE(bound.get_bytes, 3 * kRays * tile.get_bytes);
}

TEST(TileBound, CountsThatDoNotFitStayAtTheTop) {
  TileScene scene{};
  scene.macro_cells = scene.cells = scene.references = scene.runs = std::uint64_t{1} << 60;
  const TileBound bound = worst_tile(scene, tile_layout_of<StoreLayout256K<8>>(4), {});
  EXPECT_EQ(bound[GridWork::kMacroCellStep], ~std::uint64_t{0});
  EXPECT_EQ(bound.get_bytes, ~std::uint64_t{0});
  EXPECT_EQ(bound[Work::kTileStart], 1u);
}

}  // namespace
}  // namespace gridiron::test
