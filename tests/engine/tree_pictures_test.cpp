// Pictures of eye rays through the tree are those of the grid, bit for bit, in every mode.
// SPDX-License-Identifier: Apache-2.0
#include "support/render_mesh.h"
#include "support/test_headers.h"

namespace gridiron::test {
namespace {

constexpr std::uint32_t kTileWidth = 64;

GridParameters with_tree(TriangleFormat format = TriangleFormat::kVertices) {
  GridParameters parameters;
  parameters.format = format;
  parameters.has_tree = true;
  return parameters;
}

FrameSettings settings_of(std::uint32_t width, std::uint32_t height) {
  FrameSettings settings;
  settings.camera = {.eye = {2.5f, 1.7f, 3.1f}, .at = {0.0f, 0.1f, 0.0f}};
  settings.width = width;
  settings.height = height;
  return settings;
}

FrameSettings through_tree(FrameSettings settings, std::uint32_t tile_width = kTileWidth) {
  settings.engine = EngineId::kTree;
  settings.tile_width = tile_width;
  return settings;
}

sim::ChipOptions tree_chip(sim::Mode mode = sim::Mode::kChecked, std::uint32_t lanes = 4) {
  return {.mode = mode, .lanes = lanes, .packet_width = 0};
}
sim::ChipOptions small_chip(sim::Mode mode = sim::Mode::kChecked, std::uint32_t lanes = 4) {
  return {.mode = mode, .lanes = lanes, .store = sim::StoreSize::k64KB, .packet_width = 0};
}

void expect_same(SceneInMemory& scene, const FrameSettings& settings, const sim::ChipOptions& chip,
                 PlaneSet planes = PlaneSet::kAll) {
  const RenderedFrame grid = scene.render(settings, {}, planes);
  const std::uint32_t tile_width = chip.store == sim::StoreSize::k64KB ? 16 : kTileWidth;
  const RenderedFrame tree = scene.render(through_tree(settings, tile_width), chip, planes);
  ASSERT_EQ(grid.result.status, Status::kOk);
  ASSERT_EQ(tree.result.status, Status::kOk);
  EXPECT_TRUE(tree.result.violations.empty());
  EXPECT_EQ(tree.planes.color, grid.planes.color);
  if (planes != PlaneSet::kColor) {
    EXPECT_EQ(tree.planes.ids, grid.planes.ids);
  }
  if (planes == PlaneSet::kAll) {
    EXPECT_EQ(first_difference(tree, grid), "");
  }
}

TEST(TreePictures, AreThoseOfTheGridInEveryModeAndAccuracy) {
  const TestMesh mesh = make_mixed_mesh();
  for (const Accuracy accuracy : {Accuracy::kStandard, Accuracy::kExact, Accuracy::kCompact}) {
    SCOPED_TRACE(static_cast<unsigned>(accuracy));
    const bool is_compact = accuracy == Accuracy::kCompact;
    SceneInMemory scene(mesh.view(), with_tree(is_compact ? TriangleFormat::kLattice : TriangleFormat::kVertices));
    ASSERT_EQ(scene.status(), Status::kOk);
    FrameSettings settings = settings_of(150, 97);
    settings.accuracy = accuracy;
    for (const std::uint32_t lanes : {1u, 4u}) {
      for (const sim::Mode mode : {sim::Mode::kChecked, sim::Mode::kPlain}) {
        expect_same(scene, settings, tree_chip(mode, lanes));
        expect_same(scene, settings, small_chip(mode, lanes));
      }
    }
    for (const std::uint32_t lanes : {8u, 16u}) {
      if (lanes > sim::widest_lanes()) continue;
      expect_same(scene, settings, tree_chip(sim::Mode::kPlain, lanes));
      EXPECT_EQ(scene.render(through_tree(settings, 16), small_chip(sim::Mode::kPlain, lanes)).result.status,
                Status::kUnsupportedFrame);
    }
    if (!sim::has_instrumented_mode()) continue;
    expect_same(scene, settings, tree_chip(sim::Mode::kInstrumented));
    expect_same(scene, settings, small_chip(sim::Mode::kInstrumented));
  }
}

// An image needs the tree alone.
TEST(TreePictures, AreTheSameOfAnImageWithoutAGrid) {
  const TestMesh mesh = make_mixed_mesh();
  for (const TriangleFormat format : {TriangleFormat::kVertices, TriangleFormat::kLattice}) {
    GridParameters alone = with_tree(format);
    alone.has_grid = false;
    SceneInMemory with_grid(mesh.view(), with_tree(format)), without(mesh.view(), alone);
    ASSERT_EQ(with_grid.status(), Status::kOk);
    ASSERT_EQ(without.status(), Status::kOk);
    FrameSettings settings = settings_of(150, 97);
    settings.accuracy = format == TriangleFormat::kLattice ? Accuracy::kCompact : Accuracy::kStandard;
    const RenderedFrame wanted = with_grid.render(through_tree(settings), tree_chip(), PlaneSet::kAll);
    const RenderedFrame frame = without.render(through_tree(settings), tree_chip(), PlaneSet::kAll);
    ASSERT_EQ(wanted.result.status, Status::kOk);
    ASSERT_EQ(frame.result.status, Status::kOk);
    EXPECT_TRUE(frame.result.violations.empty());
    EXPECT_EQ(frame.planes.color, wanted.planes.color);
    EXPECT_EQ(first_difference(frame, wanted), "");
    EXPECT_EQ(without.prepare(settings, {}).status(), Status::kUnsupportedImage);
  }
}

// One lane is for the tree alone, and not instrumented.
TEST(TreePictures, AreBuiltForTheLanesThatTheyRunWith) {
  for (const std::uint32_t lanes : {1u, 4u}) {
    EXPECT_TRUE(sim::is_built({sim::StoreSize::k64KB, 16, 0}, sim::Mode::kChecked, lanes));
    EXPECT_TRUE(sim::is_built({sim::StoreSize::k256KB, 64, 0}, sim::Mode::kPlain, lanes));
  }
  EXPECT_FALSE(sim::is_built({sim::StoreSize::k256KB, 32, 8}, sim::Mode::kPlain, 1));
  EXPECT_FALSE(sim::is_built({sim::StoreSize::k256KB, 64, 0}, sim::Mode::kInstrumented, 1));
  EXPECT_FALSE(sim::is_built({sim::StoreSize::k64KB, 16, 0}, sim::Mode::kChecked, 8));
  EXPECT_FALSE(sim::is_built({sim::StoreSize::k64KB, 64, 0}, sim::Mode::kChecked, 4));
}

// `fast` may show another triangle at an edge than exact arithmetic, but every size of store renders it.
TEST(TreePictures, FastPicturesHaveTheSameSilhouetteOutsideOfEdges) {
  SceneInMemory scene(make_mixed_mesh().view(), with_tree());
  ASSERT_EQ(scene.status(), Status::kOk);
  FrameSettings settings = settings_of(150, 97);
  const RenderedFrame exact = scene.render(through_tree(settings), tree_chip());
  settings.accuracy = Accuracy::kFast;
  const RenderedFrame large = scene.render(through_tree(settings), tree_chip());
  const RenderedFrame small = scene.render(through_tree(settings, 16), small_chip());
  ASSERT_EQ(small.result.status, Status::kOk);
  std::uint32_t others = 0;
  for (std::uint32_t y = 0; y < settings.height; ++y) {
    for (std::uint32_t x = 0; x < settings.width; ++x) {
      const std::uint32_t id = exact.planes.ids[exact.pixel_index(x, y)];
      others += large.planes.ids[large.pixel_index(x, y)] != id ? 1u : 0u;
      others += small.planes.ids[small.pixel_index(x, y)] != id ? 1u : 0u;
    }
  }
  EXPECT_LT(others, 30u);  // of 29,100
}

TEST(TreePictures, AreTheSameWithoutPlanesAndShading) {
  SceneInMemory scene(make_mixed_mesh().view(), with_tree());
  ASSERT_EQ(scene.status(), Status::kOk);
  for (const Shading shading : {Shading::kNone, Shading::kSimple}) {
    FrameSettings settings = settings_of(64, 130);
    settings.shading = shading;
    expect_same(scene, settings, tree_chip(), PlaneSet::kColor);
    expect_same(scene, settings, tree_chip(), PlaneSet::kColorAndIds);
    expect_same(scene, settings, small_chip(), PlaneSet::kColor);
    settings.t_far = 3.7f;
    expect_same(scene, settings, tree_chip());
    expect_same(scene, settings, small_chip());
  }
}

TEST(TreePictures, DependOnNoDepthCompletionThreadsOrQueue) {
  SceneInMemory scene(make_mixed_mesh().view(), with_tree());
  ASSERT_EQ(scene.status(), Status::kOk);
  FrameSettings settings = settings_of(130, 130);
  for (const std::uint32_t depth : {1u, 2u, 5u, 16u}) {
    settings.fetch_depth = depth;
    for (const sim::Completion completion :
         {sim::Completion::kEarly, sim::Completion::kLate, sim::Completion::kRandom}) {
      sim::ChipOptions chip = tree_chip();
      chip.completion = completion;
      chip.threads = 1 + depth % 3;
      chip.limits.queue_depth = depth == 1 ? 4 : 16;
      expect_same(scene, settings, chip);
      if (depth > 4) continue;
      chip.store = sim::StoreSize::k64KB;
      expect_same(scene, settings, chip);
    }
  }
  settings.fetch_depth = 5;
  EXPECT_EQ(scene.render(through_tree(settings, 16), small_chip()).result.status, Status::kUnsupportedFrame);
  settings.fetch_depth = 17;
  EXPECT_EQ(scene.render(through_tree(settings), tree_chip()).result.status, Status::kUnsupportedFrame);
}

TEST(TreePictures, EveryFailedTransferSurfaces) {
  SceneInMemory scene(make_torus(20, 12, 1.0f, 0.4f).view(), with_tree());
  ASSERT_EQ(scene.status(), Status::kOk);
  const FrameSettings settings = through_tree(settings_of(64, 64));
  const std::uint64_t transfers = scene.render(settings, tree_chip()).result.transfers;
  ASSERT_GT(transfers, 50u);
  for (std::uint64_t failing = 1; failing <= transfers; ++failing) {
    sim::ChipOptions chip = tree_chip();
    chip.fail_transfer = failing;
    ASSERT_NE(scene.render(settings, chip).result.status, Status::kOk) << failing;
  }
}

TEST(TreePictures, WantAnImageWithATreeInTheAccuracysFormat) {
  SceneInMemory bare(make_torus(8, 8, 1.0f, 0.4f).view(), GridParameters{});
  ASSERT_EQ(bare.status(), Status::kOk);
  FrameSettings settings = through_tree(settings_of(64, 64));
  EXPECT_EQ(bare.prepare(settings, tree_chip()).status(), Status::kUnsupportedImage);
  SceneInMemory scene(make_torus(8, 8, 1.0f, 0.4f).view(), with_tree());
  EXPECT_EQ(scene.prepare(settings, tree_chip()).status(), Status::kOk);
  for (const Accuracy accuracy : {Accuracy::kPaper, Accuracy::kCompact}) {
    settings.accuracy = accuracy;
    EXPECT_EQ(scene.prepare(settings, tree_chip()).status(), Status::kUnsupportedImage);
  }
  settings.accuracy = Accuracy::kStandard;
  settings.engine = EngineId::kEnd;
  EXPECT_EQ(scene.prepare(settings, tree_chip()).status(), Status::kUnsupportedFrame);
}

TEST(TreePictures, RecordsThatNameWhatIsNotThereAreRefused) {
  SceneInMemory scene(make_torus(8, 8, 1.0f, 0.4f).view(), with_tree());
  PreparedFrame frame = scene.prepare(through_tree(settings_of(64, 64)), tree_chip());
  ASSERT_EQ(frame.status(), Status::kOk);
  const FrameRecord good = frame.record();
  const auto status_with = [&](const auto& change) {
    FrameRecord record = good;
    change(record);
    frame.set_record(record);
    return frame.render(tree_chip()).status;
  };
  EXPECT_EQ(status_with([](FrameRecord&) {}), Status::kOk);
  EXPECT_EQ(status_with([](FrameRecord& r) { r.tree_address = 0; }), Status::kBadFrame);
  EXPECT_EQ(status_with([](FrameRecord& r) { r.image_address = 0; }), Status::kBadFrame);
  EXPECT_EQ(status_with([](FrameRecord& r) { r.fetch_depth = 0; }), Status::kBadFrame);
  EXPECT_EQ(status_with([](FrameRecord& r) { r.tree_address += std::uint64_t{1} << 40; }), Status::kBadFrame);
  EXPECT_EQ(status_with([](FrameRecord& r) { r.image_address += kLineBytes; }), Status::kBadFrame);
  EXPECT_EQ(status_with([](FrameRecord& r) { r.engine_id = 3; }), Status::kBadFrame);
}

}  // namespace
}  // namespace gridiron::test
