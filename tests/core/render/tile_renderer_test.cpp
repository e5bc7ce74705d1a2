// Tile renderer on one core: the picture is the ground truth's whatever the buffers, and wrong frames are refused.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/render/tile_renderer.h>

#include "core/render/test_frame.h"
#include "support/brute_force.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using Normal = StoreLayout256K<8>;

// As little of everything as a layout can have: the macrocell table is streamed through one line, runs of triangles
// through buffers of three.
struct TinyLayout {
  using Engine = GridEngine;
  static constexpr std::uint32_t kEffects = 0;
  static constexpr std::uint32_t kArenaBytes = 64 * 1024;
  static constexpr std::uint32_t kCodeBudgetBytes = 32 * 1024;
  static constexpr std::uint32_t kStackBudgetBytes = 6 * 1024;
  static constexpr std::uint32_t kTileWidth = 16;
  static constexpr std::uint32_t kPacketWidth = 4;
  static constexpr std::uint32_t kMailboxSlots = 64;
  static constexpr std::uint32_t kTableEntries = 16;
  static constexpr std::uint32_t kMaxMacroWidth = 3;
  static constexpr std::uint32_t kMaxMacroDepth = 3;
  static constexpr std::uint32_t kTrianglesPerBuffer = 3;
  static constexpr std::uint32_t kMaxTriangleDepth = 5;
  static constexpr std::uint32_t kMaxOutputDepth = 3;
  static constexpr std::uint32_t kRecentTriangles = 2;
};
static_assert(kFitsArena<TinyLayout>);

TestMesh make_scene() {
  return joined(make_sphere(12, 16, 0.8f), make_random_soup(150, 0.4f, 4));
}

FrameSettings settings_of(std::uint32_t width, std::uint32_t height, std::uint32_t tile_width) {
  return {.camera = {.eye = {0.7f, 0.5f, 2.9f}}, .width = width, .height = height, .tile_width = tile_width};
}

// @returns the first pixel that differs, in words.
std::string difference(const KernelFrame& a, const KernelFrame& b) {
  if (a.ids.size() != b.ids.size()) return "sizes differ";
  for (std::size_t i = 0; i < a.ids.size(); ++i) {
    if (a.ids[i] != b.ids[i] || a.color[i] != b.color[i] || a.depth[i] != b.depth[i]) {
      return "pixel " + std::to_string(i) + ": triangle " + std::to_string(a.ids[i]) + " or " +
             std::to_string(b.ids[i]);
    }
  }
  return "";
}

void expect_clean(const TestFrame& frame) {
  EXPECT_EQ(frame.platform->violation(), "");
  EXPECT_EQ(frame.platform->pending(), 0u) << "transfers nobody waited for";
  EXPECT_LE(frame.platform->most_pending(), frame.platform->limits().queue_depth);
  EXPECT_TRUE(frame.gaps_are_untouched());
}

class TileRendererTest : public testing::Test {
 protected:
  static const TestMesh& mesh() {
    static const TestMesh mesh = make_scene();
    return mesh;
  }
  static const BuiltImage& scene() {
    static const BuiltImage scene = build_image(mesh().view(), {4.0f, 6, TriangleFormat::kVertices});
    return scene;
  }
  // Over 512 macrocells: more than one line of the table.
  static const BuiltImage& fine_scene() {
    static const BuiltImage fine_scene = build_image(mesh().view(), {60.0f, 2, TriangleFormat::kVertices});
    return fine_scene;
  }
  static void expect_truth(const TestFrame& frame, const KernelFrame& rendered) {
    std::vector<Vec3> directions;
    for (std::uint32_t i = 0; i < frame.record.width * frame.record.height; ++i) {
      directions.push_back(test::pixel_direction(frame.record, i % frame.record.width, i / frame.record.width));
    }
    const Vec3 eye(frame.record.eye[0], frame.record.eye[1], frame.record.eye[2]);
    const std::vector<TrueHit> truth = BruteForce(mesh().view(), eye).trace(directions, frame.record.t_far, 1);
    ASSERT_EQ(rendered.ids.size(), truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i) {
      ASSERT_EQ(rendered.ids[i], truth[i].triangle_id) << "pixel " << i;
      ASSERT_EQ(rendered.depth[i], depth_value(truth[i], directions[i])) << "pixel " << i;
      if (truth[i].triangle_id == kNoTriangle) {
        ASSERT_EQ(rendered.color[i], frame.record.background_rgba) << "pixel " << i;
      }
    }
  }
  // Renders fine_scene() with the layout of normal size and the mesh's 64 x 48 pixels.
  static const KernelFrame& reference() {
    static const KernelFrame reference = [] {
      TestFrame frame(fine_scene(), settings_of(64, 48, Normal::kTileWidth));
      KernelFrame rendered = frame.render<Lanes<4>, Normal>();
      EXPECT_EQ(rendered.status, Status::kOk);
      expect_clean(frame);
      expect_truth(frame, rendered);
      return rendered;
    }();
    return reference;
  }
  // Renders a frame that may give no other picture than reference(), without a broken rule.
  template <class L, class Layout>
  static KernelFrame expect_reference(TestFrame& frame, const std::string& name = "") {
    const KernelFrame rendered = frame.render<L, Layout>();
    EXPECT_EQ(rendered.status, Status::kOk) << name << ": " << frame.platform->violation();
    EXPECT_EQ(difference(rendered, reference()), "") << name;
    expect_clean(frame);
    return rendered;
  }
};

TEST_F(TileRendererTest, PictureIsTheGroundTruth) {
  std::size_t hits = 0;
  for (const std::uint32_t id : reference().ids) hits += id != kNoTriangle ? 1u : 0u;
  EXPECT_GT(hits, reference().ids.size() / 4);
  EXPECT_LT(hits, reference().ids.size());
}

TEST_F(TileRendererTest, StreamedTableAndLongRunsChangeNothing) {
  const GridRecord& grid = fine_scene().view.grid;
  ASSERT_GT(grid.macro_cell_count[0] * grid.macro_cell_count[1] * grid.macro_cell_count[2],
            32u * TinyLayout::kTableEntries);
  TestFrame frame(fine_scene(), settings_of(64, 48, TinyLayout::kTileWidth));
  expect_reference<Lanes<4>, TinyLayout>(frame);
}

// Every place that make_frame_record takes does for every transfer.
TEST_F(TileRendererTest, PlanesMayLieAtEveryMultipleOfTheirAlignment) {
  for (std::uint64_t shift = kPlaneAlignment; shift < kLineBytes; shift += kPlaneAlignment) {
    for (std::uint32_t queue = 1; queue <= 17; ++queue) {
      TestFrame frame(fine_scene(), settings_of(64, 48, Normal::kTileWidth), queue, Moves::kAtTheWait, shift);
      expect_reference<Lanes<4>, Normal>(frame, std::to_string(shift) + ", queue of " + std::to_string(queue));
    }
  }
}

TEST_F(TileRendererTest, CellsOfManyRunsAreTestedWhole) {
  // A grid of a few cells with dozens of triangles each.
  const BuiltImage coarse = build_image(mesh().view(), {0.05f, 3, TriangleFormat::kVertices});
  TestFrame frame(coarse, settings_of(64, 48, TinyLayout::kTileWidth));
  const KernelFrame rendered = expect_reference<Lanes<4>, TinyLayout>(frame);
  EXPECT_GT(rendered.work[GridWork::kTriangleBatch], 5 * rendered.work[GridWork::kCellVisit]);
}

TEST_F(TileRendererTest, LanesChangeNothing) {
  TestFrame frame(fine_scene(), settings_of(64, 48, Normal::kTileWidth));
  expect_reference<Lanes<8>, Normal>(frame);
  frame.claim_all();
  expect_reference<Lanes<16>, Normal>(frame);
  TestFrame tiny(fine_scene(), settings_of(64, 48, TinyLayout::kTileWidth));
  expect_reference<Lanes<16>, TinyLayout>(tiny);
}

TEST_F(TileRendererTest, BufferingQueueAndOrderOfMovesChangeNothing) {
  for (const std::uint32_t output : {1u, 2u, 3u}) {
    for (const std::uint32_t macro : {1u, 2u, 3u}) {
      for (const std::uint32_t triangles : {1u, 2u, 5u}) {
        for (const std::uint32_t queue : {1u, 2u, 16u}) {
          const Moves moves = (output + macro + triangles + queue) % 2 == 0 ? Moves::kAtOnce : Moves::kAtTheWait;
          FrameSettings settings = settings_of(64, 48, TinyLayout::kTileWidth);
          settings.output_depth = output;
          settings.macro_depth = macro;
          settings.triangle_depth = triangles;
          TestFrame frame(fine_scene(), settings, queue, moves);
          const std::string name = std::to_string(output) + std::to_string(macro) + std::to_string(triangles) +
                                   " in a queue of " + std::to_string(queue);
          expect_reference<Lanes<4>, TinyLayout>(frame, name);
        }
      }
    }
  }
}

TEST_F(TileRendererTest, TechniquesChangeNoPixelButTheWork) {
  TestFrame all_on(fine_scene(), settings_of(64, 48, Normal::kTileWidth));
  const KernelFrame with_all = all_on.render<Lanes<4>, Normal>();
  struct Case {
    std::uint32_t bit;
    WorkId counter;
  };
  for (const Case& tested : {Case{kUseMailbox, Work::kTriangleSetup}, Case{kUseCornerCulling, Work::kGroupTestStandard},
                             Case{kUseEmptySkip, GridWork::kMacroCellVisit}}) {
    FrameSettings settings = settings_of(64, 48, Normal::kTileWidth);
    settings.techniques &= ~tested.bit;
    TestFrame frame(fine_scene(), settings);
    const KernelFrame without = expect_reference<Lanes<4>, Normal>(frame, std::to_string(tested.bit));
    EXPECT_GT(without.work[tested.counter], with_all.work[tested.counter]) << tested.bit;
  }
}

TEST_F(TileRendererTest, SubpacketsChangeNoPixelButTheWork) {
  using WholeTiles = StoreLayout256K<32>;
  FrameSettings settings = settings_of(64, 48, WholeTiles::kTileWidth);
  TestFrame whole(fine_scene(), settings);
  const KernelFrame without = expect_reference<Lanes<4>, WholeTiles>(whole);
  settings.techniques |= kUseSubpackets;
  TestFrame by_subpackets(fine_scene(), settings);
  const KernelFrame with = expect_reference<Lanes<4>, WholeTiles>(by_subpackets);
  EXPECT_LT(4 * with.work[Work::kRowTest], without.work[Work::kGroupTestStandard]);
  EXPECT_EQ(with.work[Work::kGroupTestStandard], 0u);
  EXPECT_EQ(without.work[Work::kSubpacketGroup], 0u);
  TestFrame small(fine_scene(), settings);
  expect_reference<Lanes<4>, Normal>(small);
}

TEST_F(TileRendererTest, OddSizes) {
  struct Size {
    std::uint32_t width, height;
  };
  for (const Size& size : {Size{1, 1}, Size{33, 17}, Size{31, 33}, Size{5, 64}}) {
    TestFrame frame(scene(), settings_of(size.width, size.height, Normal::kTileWidth));
    const KernelFrame rendered = frame.render<Lanes<8>, Normal>();
    ASSERT_EQ(rendered.status, Status::kOk);
    expect_truth(frame, rendered);
    expect_clean(frame);
    TestFrame tiny(fine_scene(), settings_of(size.width, size.height, TinyLayout::kTileWidth));
    EXPECT_EQ(difference(tiny.render<Lanes<4>, TinyLayout>(), rendered), "") << size.width << "x" << size.height;
    expect_clean(tiny);
  }
}

TEST_F(TileRendererTest, LimitOfTheFrameIsClosed) {
  FrameSettings settings = settings_of(64, 48, Normal::kTileWidth);
  settings.t_far = 2.75f;
  TestFrame frame(fine_scene(), settings);
  const KernelFrame rendered = frame.render<Lanes<4>, Normal>();
  ASSERT_EQ(rendered.status, Status::kOk);
  expect_truth(frame, rendered);
  EXPECT_NE(difference(rendered, reference()), "");
}

TEST_F(TileRendererTest, EyeInsideTheSceneSeesAllAround) {
  // A wide view from inside: packets whose rays march along several axes.
  FrameSettings settings = settings_of(64, 48, Normal::kTileWidth);
  settings.camera = {{0.05f, 0.1f, -0.07f}, {0.4f, 0.5f, 0.6f}, {0, 1, 0}, 6.0f};
  TestFrame frame(fine_scene(), settings);
  const KernelFrame rendered = frame.render<Lanes<4>, Normal>();
  ASSERT_EQ(rendered.status, Status::kOk);
  EXPECT_GT(rendered.work[GridWork::kPacketStart], 48u) << "no packet needs a second pass";
  expect_truth(frame, rendered);
}

TEST_F(TileRendererTest, PlanesThatAreOffAreNotWritten) {
  TestFrame frame(scene(), settings_of(40, 40, Normal::kTileWidth));
  const std::uint64_t depth = frame.record.depth_address;
  const std::uint64_t ids = frame.record.id_address;
  frame.record.depth_address = frame.record.id_address = 0;
  const KernelFrame rendered = frame.render<Lanes<4>, Normal>();
  ASSERT_EQ(rendered.status, Status::kOk);
  EXPECT_EQ(*frame.platform->at(depth), std::byte{0xA5});
  EXPECT_EQ(*frame.platform->at(ids), std::byte{0xA5});
  TestFrame full(scene(), settings_of(40, 40, Normal::kTileWidth));
  EXPECT_EQ((full.render<Lanes<4>, Normal>().color), rendered.color);
}

TEST_F(TileRendererTest, PaperFramesRenderTheSameShape) {
  const BuiltImage projected = build_image(mesh().view(), {4.0f, 6, TriangleFormat::kProjection});
  FrameSettings settings = settings_of(64, 48, Normal::kTileWidth);
  settings.accuracy = Accuracy::kPaper;
  TestFrame frame(projected, settings);
  const KernelFrame rendered = frame.render<Lanes<4>, Normal>();
  ASSERT_EQ(rendered.status, Status::kOk);
  std::size_t different = 0;
  for (std::size_t i = 0; i < rendered.ids.size(); ++i) different += rendered.ids[i] != reference().ids[i] ? 1u : 0u;
  EXPECT_LT(different, rendered.ids.size() / 200);
}

// --- Frames that are refused -------------------------------------------------------------------------------------

struct Refusal {
  std::string name;
  Status expected;
  std::function<void(FrameRecord&)> change;
};

// As many tiles as a picture of the frame's size has.
void retile(FrameRecord& f, std::uint32_t width, std::uint32_t height, std::uint32_t tile_width) {
  f.width = width;
  f.height = height;
  f.tile_width = tile_width;
  f.tiles_x = (width + tile_width - 1) / tile_width;
  f.tiles_y = (height + tile_width - 1) / tile_width;
}

std::vector<Refusal> refusals() {
  const Status bad = Status::kBadFrame;
  const Status unsupported = Status::kUnsupportedFrame;
  const Status image = Status::kUnsupportedImage;
  return {
      {"Magic", bad, [](FrameRecord& f) { f.magic ^= 1; }},
      {"Version", bad, [](FrameRecord& f) { ++f.version; }},
      {"WidthZero", bad, [](FrameRecord& f) { f.width = f.tiles_x = 0; }},
      {"HeightZero", bad, [](FrameRecord& f) { f.height = f.tiles_y = 0; }},
      {"WidthTooLarge", bad, [](FrameRecord& f) { retile(f, kMaxPictureWidth + 1, f.height, f.tile_width); }},
      {"HeightTooLarge", bad, [](FrameRecord& f) { retile(f, f.width, kMaxPictureWidth + 1, f.tile_width); }},
      {"OtherTileWidth", unsupported, [](FrameRecord& f) { retile(f, f.width, f.height, 16); }},
      {"OtherEngine", unsupported, [](FrameRecord& f) { ++f.engine_id; }},
      {"TilesAcross", bad, [](FrameRecord& f) { ++f.tiles_x; }},
      {"TilesDown", bad, [](FrameRecord& f) { --f.tiles_y; }},
      {"OutputDepthZero", unsupported, [](FrameRecord& f) { f.output_depth = 0; }},
      {"OutputDepthTooLarge", unsupported, [](FrameRecord& f) { f.output_depth = Normal::kMaxOutputDepth + 1; }},
      {"MacroDepthZero", unsupported, [](FrameRecord& f) { f.engine.macro_depth = 0; }},
      {"MacroDepthTooLarge", unsupported, [](FrameRecord& f) { f.engine.macro_depth = Normal::kMaxMacroDepth + 1; }},
      {"TriangleDepthZero", unsupported, [](FrameRecord& f) { f.engine.triangle_depth = 0; }},
      {"TriangleDepthTooLarge", unsupported,
       [](FrameRecord& f) { f.engine.triangle_depth = Normal::kMaxTriangleDepth + 1; }},
      {"LimitZero", bad, [](FrameRecord& f) { f.t_far = 0.0f; }},
      {"LimitNegative", bad, [](FrameRecord& f) { f.t_far = -1.0f; }},
      {"LimitNaN", bad, [](FrameRecord& f) { f.t_far = std::numeric_limits<float>::quiet_NaN(); }},
      {"NoColor", bad, [](FrameRecord& f) { f.color_address = 0; }},
      {"Accuracy", unsupported, [](FrameRecord& f) { f.accuracy = 5; }},
      {"Shading", unsupported, [](FrameRecord& f) { f.shading = 3; }},
      {"SceneShading", Status::kMissingEffect, [](FrameRecord& f) { f.shading = 2; }},
      {"AccuracyOfOtherTriangles", image,
       [](FrameRecord& f) { f.accuracy = static_cast<std::uint32_t>(Accuracy::kPaper); }},
      {"LatticeOfOtherTriangles", image,
       [](FrameRecord& f) { f.accuracy = static_cast<std::uint32_t>(Accuracy::kCompact); }},
      {"VerticesOfALattice", image,
       [](FrameRecord& f) { f.engine.grid.triangle_format = static_cast<std::uint32_t>(TriangleFormat::kLattice); }},
      {"TriangleFormat", image, [](FrameRecord& f) { f.engine.grid.triangle_format = 7; }},
      {"MacroWidthZero", image, [](FrameRecord& f) { f.engine.grid.macro_width = 0; }},
      {"MacroWidthTooLarge", image, [](FrameRecord& f) { f.engine.grid.macro_width = Normal::kMaxMacroWidth + 1; }},
      {"CellBlockTooLarge", image,
       [](FrameRecord& f) {
         f.engine.grid.cell_block_bytes = LocalStore<Normal>::EyeStore::kCellBlockBytes + kLineBytes;
       }},
  };
}

class RefusedFrame : public testing::TestWithParam<std::size_t> {};

TEST_P(RefusedFrame, NamesItsReasonAndTouchesNothing) {
  const BuiltImage scene = build_image(make_box({-1, -1, -1}, {1, 1, 1}).view());
  const Refusal refusal = refusals()[GetParam()];
  TestFrame frame(scene, settings_of(70, 40, Normal::kTileWidth));
  const FrameRecord good = frame.record;
  refusal.change(frame.record);
  const FrameRecord changed = frame.record;
  std::memcpy(frame.platform->at(kFrameAddress), &changed, sizeof(changed));
  const auto store = std::make_unique<LocalStore<Normal>>();
  const Status status = render_tiles<Lanes<4>>(*store, *frame.platform, MainAddress{kFrameAddress});
  EXPECT_EQ(static_cast<int>(status), static_cast<int>(refusal.expected));
  for (const Command& command : frame.platform->commands()) {
    EXPECT_NE(static_cast<int>(command.kind), static_cast<int>(Command::Kind::kClaim));
    EXPECT_NE(static_cast<int>(command.kind), static_cast<int>(Command::Kind::kPut));
  }
  EXPECT_EQ(frame.platform->pending(), 0u);
  frame.record = good;
  EXPECT_EQ((frame.render<Lanes<4>, Normal>().status), Status::kOk) << "the frame was wrong in another way too";
}

INSTANTIATE_TEST_SUITE_P(Reasons, RefusedFrame, testing::Range<std::size_t>(0, refusals().size()),
                         [](const auto& tested) { return refusals()[tested.param].name; });

// --- Frames that end early ---------------------------------------------------------------------------------------

TEST_F(TileRendererTest, AbortAndDeadlineComeBetweenTwoTiles) {
  struct Case {
    ItemClaim::Kind kind;
    Status expected;
  };
  for (const Case& tested :
       {Case{ItemClaim::Kind::kAborted, Status::kAborted}, Case{ItemClaim::Kind::kDeadline, Status::kDeadline},
        Case{ItemClaim::Kind::kNone, Status::kOk}}) {
    for (std::uint32_t tiles = 0; tiles < 4; ++tiles) {
      TestFrame frame(fine_scene(), settings_of(64, 48, Normal::kTileWidth));
      frame.platform->claims.resize(tiles);
      frame.platform->claims.push_back({tested.kind});
      const KernelFrame rendered = frame.render<Lanes<4>, Normal>();
      EXPECT_EQ(rendered.status, tested.expected);
      EXPECT_EQ(rendered.work[Work::kTileStart], tiles);
      expect_clean(frame);
      // Tiles that were begun are whole, the others are as they were.
      for (std::uint32_t y = 0; y < 48; ++y) {
        for (std::uint32_t x = 0; x < 64; ++x) {
          const bool done = x / 32 + y / 32 * 2 < tiles;
          ASSERT_EQ(rendered.color[y * 64 + x], done ? reference().color[y * 64 + x] : 0xA5A5A5A5u) << tiles;
        }
      }
    }
  }
}

TEST_F(TileRendererTest, TilesComeInAnyOrder) {
  TestFrame frame(fine_scene(), settings_of(64, 48, Normal::kTileWidth));
  frame.platform->claims.clear();
  for (const std::uint32_t tile : {3u, 0u, 2u, 1u}) frame.platform->claims.push_back({ItemClaim::Kind::kItem, tile});
  frame.platform->claims.push_back({});
  expect_reference<Lanes<4>, Normal>(frame);
}

TEST_F(TileRendererTest, ATileThatTheFrameDoesNotHaveIsAnError) {
  TestFrame frame(scene(), settings_of(64, 48, Normal::kTileWidth));
  frame.platform->claims = {{ItemClaim::Kind::kItem, 4}, {}};
  EXPECT_EQ((frame.render<Lanes<4>, Normal>().status), Status::kBadFrame);
}

TEST_F(TileRendererTest, EveryFailedCommandSurfaces) {
  FrameSettings settings = settings_of(16, 8, TinyLayout::kTileWidth);
  settings.camera.eye = {0.2f, 0.1f, 1.2f};
  TestFrame frame(fine_scene(), settings);
  ASSERT_EQ((frame.render<Lanes<4>, TinyLayout>().status), Status::kOk);
  const std::vector<Command> commands = frame.platform->commands();
  ASSERT_GT(commands.size(), 100u);
  for (const Status failure : {Status::kTransferFailed, Status::kTransferTimedOut}) {
    for (std::size_t i = 0; i < commands.size(); ++i) {
      if (commands[i].kind == Command::Kind::kClaim) continue;
      TestFrame failing(fine_scene(), settings);
      failing.platform->failing_command = i;
      failing.platform->failure = failure;
      ASSERT_EQ((failing.render<Lanes<4>, TinyLayout>().status), failure) << "command " << i;
      ASSERT_EQ(failing.platform->commands().size(), i + 1) << "nothing is asked for behind a failure";
    }
  }
}

}  // namespace
}  // namespace gridiron::test
