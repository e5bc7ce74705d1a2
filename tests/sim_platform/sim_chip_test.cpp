// The simulated chip with the real kernel: one picture and one trace for any threads, completion, lanes and mode.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/sim_chip.h>
#include <gridiron/sim/sim_core.h>

#include <atomic>

#include "determinism/trace_difference.h"
#include "sim_platform/program_bench.h"
#include "support/render_mesh.h"
#include "support/test_mesh.h"
#include "support/views.h"

namespace gridiron::sim {

namespace {

/// A torus in front of hills, with enough triangles per cell to stream, in a picture that tiles do not divide.
class Scene {
 public:
  Scene() : mesh_(make()), scene_(mesh_.view(), {}) {
    settings = {.camera = test::framed_camera(mesh_.view()), .width = 150, .height = 100};
  }
  [[nodiscard]] test::RenderedFrame render(const ChipOptions& options) { return scene_.render(settings, options); }

  FrameSettings settings;

 private:
  static test::TestMesh make() {
    test::TestMesh mesh = test::make_torus(24, 40, 0.6f, 0.2f);
    mesh.append(test::make_height_field(24, 0.2f, 3));
    return mesh;
  }
  test::TestMesh mesh_;
  test::SceneInMemory scene_;
};

TEST(SimChip, ACheckedFrameBreaksNoRuleAndShowsSomething) {
  Scene scene;
  const test::RenderedFrame frame = scene.render({});
  ASSERT_EQ(frame.result.status, Status::kOk) << words(frame.result);
  EXPECT_TRUE(frame.result.violations.empty()) << words(frame.result);
  std::uint32_t hits = 0;
  for (const std::uint32_t id : frame.planes.ids) hits += id != kNoTriangle;
  EXPECT_GT(hits, 150u * 100u / 10u);
  EXPECT_LT(hits, 150u * 100u);
  EXPECT_EQ(frame.result.trace.tiles.size(), 5u * 4u);
  EXPECT_GT(frame.result.transfers, 100u);
  EXPECT_EQ(frame.result.work[static_cast<std::size_t>(Work::kTileStart)], 20u);
}

/// How a frame is run; none of it may change picture, trace or totals.
struct HowToRun {
  std::uint32_t threads;
  Completion completion;
  std::uint64_t seed;
  Mode mode = Mode::kChecked;
};

TEST(SimChip, PictureTraceAndTotalsAreTheSameForAnyThreadsCompletionAndSeed) {
  // Single, double and deep buffering, with queues that are often full.
  struct Buffering {
    std::uint32_t depth, queue_depth;
  };
  for (const auto [depth, queue_depth] : {Buffering{1, 16}, {2, 16}, {12, 16}, {12, 10}, {2, 4}, {2, 2}, {2, 1}}) {
    Scene scene;
    scene.settings.output_depth = std::min(depth, 2u);
    scene.settings.macro_depth = std::min(depth, 4u);
    scene.settings.triangle_depth = depth;
    const ChipOptions reference_options{.limits = {.queue_depth = queue_depth}};
    const test::RenderedFrame reference = scene.render(reference_options);
    ASSERT_EQ(reference.result.status, Status::kOk) << words(reference.result);
    std::vector<HowToRun> runs = {{1, Completion::kLate, 0},  {2, Completion::kEarly, 0}, {3, Completion::kLate, 0},
                                  {6, Completion::kEarly, 0}, {8, Completion::kLate, 0},  {32, Completion::kEarly, 0}};
    const std::uint64_t seeds = depth == 2 && queue_depth == 16 ? 20 : 2;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      runs.push_back({static_cast<std::uint32_t>(seed % 3 + 1), Completion::kRandom, seed});
    }
    if (has_instrumented_mode()) runs.push_back({2, Completion::kEarly, 0, Mode::kInstrumented});
    for (const HowToRun& how : runs) {
      SCOPED_TRACE(testing::Message() << "depth " << depth << ", threads " << how.threads << ", completion "
                                      << static_cast<int>(how.completion) << ", seed " << how.seed << ", mode "
                                      << static_cast<int>(how.mode));
      ChipOptions options = reference_options;
      options.threads = how.threads;
      options.completion = how.completion;
      options.seed = how.seed;
      options.mode = how.mode;
      const test::RenderedFrame frame = scene.render(options);
      ASSERT_EQ(frame.result.status, Status::kOk) << words(frame.result);
      EXPECT_EQ(test::first_difference(reference, frame), "");
      EXPECT_EQ(test::first_difference(reference.result.trace, frame.result.trace), "");
      EXPECT_EQ(frame.result.work, reference.result.work);
    }
  }
}

// What is built, written down a second time: store, tile width, packet width.
bool is_built_here(const LayoutChoice& layout, Mode mode, std::uint32_t lanes) {
  const bool is_common = layout.store == StoreSize::k64KB ? layout.tile_width == 16 && layout.packet_width <= 16
                                                          : layout.store == StoreSize::k256KB &&
                                                                layout.tile_width == 32 && layout.packet_width <= 32;
  if (is_common) return mode != Mode::kInstrumented || (has_instrumented_mode() && lanes == 4);
  constexpr std::tuple<StoreSize, std::uint32_t, std::uint32_t> kSwept[] = {
      {StoreSize::k128KB, 32, 8},  {StoreSize::k128KB, 32, 32}, {StoreSize::k512KB, 32, 8}, {StoreSize::k512KB, 32, 32},
      {StoreSize::k512KB, 64, 8},  {StoreSize::k512KB, 64, 32}, {StoreSize::k256KB, 8, 8},  {StoreSize::k256KB, 16, 8},
      {StoreSize::k256KB, 16, 16}, {StoreSize::k256KB, 64, 8},  {StoreSize::k256KB, 64, 32}};
  const std::tuple asked(layout.store, layout.tile_width, layout.packet_width);
  return mode == Mode::kChecked && lanes == 4 && std::ranges::find(kSwept, asked) != std::end(kSwept);
}

// Every mode, lane count and layout that can be asked for.
void for_each_build(const std::function<void(Mode, std::uint32_t lanes, const LayoutChoice&)>& visit) {
  for (const Mode mode : {Mode::kChecked, Mode::kPlain, Mode::kInstrumented}) {
    for (const std::uint32_t lanes : {4u, 8u, 16u}) {
      for (const StoreSize store : kStoreSizes) {
        for (const std::uint32_t tile_width : {8u, 16u, 32u, 64u}) {
          for (const std::uint32_t packet_width : {4u, 8u, 16u, 32u, 64u}) {
            visit(mode, lanes, {store, tile_width, packet_width});
          }
        }
      }
    }
  }
}

TEST(SimChip, PictureIsTheSameForAnyLanesStoreTilePacketAndQueue) {
  Scene scene;
  const test::RenderedFrame reference = scene.render({});
  ASSERT_EQ(reference.result.status, Status::kOk) << words(reference.result);
  int rendered = 0;
  for_each_build([&](Mode mode, std::uint32_t lanes, const LayoutChoice& layout) {
    // The helper gives a frame with tiles of 32 the store's usual ones.
    if (layout.tile_width == 32 && usual_tile_width(layout.store) != 32) return;
    for (const std::uint32_t queue_depth : {1u, 2u, 16u}) {
      const ChipOptions options{.mode = mode,
                                .threads = 2,
                                .lanes = lanes,
                                .store = layout.store,
                                .packet_width = layout.packet_width,
                                .limits = {.queue_depth = queue_depth}};
      scene.settings.tile_width = layout.tile_width;
      SCOPED_TRACE(testing::Message() << "mode " << static_cast<int>(mode) << ", lanes " << lanes << ", store "
                                      << (arena_bytes(layout.store) >> 10) << ", tile " << layout.tile_width
                                      << ", packet " << layout.packet_width << ", queue " << queue_depth);
      const bool built = is_built_here(layout, mode, lanes);
      if (lanes <= widest_lanes()) {
        EXPECT_EQ(is_built(layout, mode, lanes), built);
      }
      const test::RenderedFrame frame = scene.render(options);
      if (!built || lanes > widest_lanes()) {
        EXPECT_EQ(frame.result.status, Status::kUnsupportedFrame);
        continue;
      }
      ASSERT_EQ(frame.result.status, Status::kOk) << words(frame.result);
      EXPECT_EQ(test::first_difference(reference, frame), "");
      ++rendered;
    }
  });
  EXPECT_GE(rendered, 3 * (7 + 7 + 11)) << "each layout in checked mode, the common ones in plain mode too";
}

// One tile, some, and some more than there are threads; all others stay as they were.
TEST(SimChip, TilesRenderedAloneAreTilesOfTheFrame) {
  Scene scene;
  const test::RenderedFrame whole = scene.render({});
  ASSERT_EQ(whole.result.status, Status::kOk);
  for (const std::vector<std::uint32_t>& tiles :
       {std::vector<std::uint32_t>{0}, {7}, {19}, {1, 7, 8, 19}, {0, 2, 4, 6, 8, 10, 12, 14, 16, 18}}) {
    for (const Mode mode : {Mode::kChecked, Mode::kPlain}) {
      std::vector<std::uint32_t> totals;
      const auto progress = [&totals](std::uint32_t, std::uint32_t total) { totals.push_back(total); };
      const test::RenderedFrame alone =
          scene.render({.mode = mode, .threads = 3, .only_tiles = tiles, .progress = progress});
      ASSERT_EQ(alone.result.status, Status::kOk) << words(alone.result);
      EXPECT_EQ(totals, std::vector<std::uint32_t>(tiles.size(), static_cast<std::uint32_t>(tiles.size())));
      std::size_t differing = 0;  // pixels of tiles that were not asked for
      for (std::uint32_t y = 0; y < 100; ++y) {
        for (std::uint32_t x = 0; x < 150; ++x) {
          const std::size_t i = whole.pixel_index(x, y);
          const bool equal =
              alone.planes.color[i] == whole.planes.color[i] && alone.planes.ids[i] == whole.planes.ids[i];
          const bool is_asked_for = std::ranges::count(tiles, y / 32 * 5 + x / 32) != 0;
          ASSERT_TRUE(equal || !is_asked_for) << "pixel " << x << ", " << y << " of " << tiles.size() << " tiles";
          if (!equal) ++differing;
        }
      }
      EXPECT_GT(differing, 0u);
      if (mode == Mode::kPlain) continue;
      ASSERT_EQ(alone.result.trace.tiles.size(), tiles.size());
      for (std::size_t i = 0; i < tiles.size(); ++i) {
        EXPECT_EQ(alone.result.trace.tiles[i].tile_id, tiles[i]);
        EXPECT_EQ(test::first_difference(alone.result.trace.tiles[i], whole.result.trace.tiles[tiles[i]]), "")
            << "tile " << tiles[i];
      }
    }
  }
}

TEST(SimChip, ProgressCountsEveryTileOnceAndAbortStopsBetweenTiles) {
  for (const Mode mode : {Mode::kChecked, Mode::kPlain}) {
    Scene scene;
    std::vector<std::uint32_t> seen;
    ChipOptions options{.mode = mode, .threads = 3};
    options.progress = [&](std::uint32_t done, std::uint32_t total) {
      EXPECT_EQ(total, 20u);
      seen.push_back(done);
    };
    ASSERT_EQ(scene.render(options).result.status, Status::kOk);
    ASSERT_EQ(seen.size(), 20u);
    for (std::uint32_t i = 0; i < 20; ++i) EXPECT_EQ(seen[i], i + 1);

    std::atomic<bool> abort{false};
    options.abort = &abort;
    options.threads = 2;
    options.progress = [&](std::uint32_t done, std::uint32_t) { abort = done >= 5; };
    seen.clear();
    const ChipResult result = scene.render(options).result;
    EXPECT_EQ(result.status, Status::kAborted) << words(result);
    EXPECT_TRUE(result.violations.empty()) << words(result);
  }
}

TEST(SimChip, RefusesWhatItCannotRender) {
  Scene scene;
  const auto status_of = [&](auto change) {
    ChipOptions options;
    change(options);
    return scene.render(options).result.status;
  };
  EXPECT_EQ(status_of([](ChipOptions& o) { o.packet_width = 5; }), Status::kUnsupportedFrame);
  EXPECT_EQ(status_of([](ChipOptions& o) { o.lanes = 6; }), Status::kUnsupportedFrame);
  EXPECT_EQ(status_of([](ChipOptions& o) { o.threads = 0; }), Status::kBadParameter);
  for (const std::vector<std::uint32_t>& tiles : {std::vector<std::uint32_t>{20}, {3, 3}, {4, 3}}) {
    EXPECT_EQ(status_of([&](ChipOptions& o) { o.only_tiles = tiles; }), Status::kBadParameter);
  }
  EXPECT_EQ(status_of([](ChipOptions& o) { o.limits.queue_depth = 0; }), Status::kBadParameter);
  EXPECT_EQ(status_of([](ChipOptions& o) { o.limits.tag_count = 33; }), Status::kBadParameter);
  EXPECT_EQ(status_of([](ChipOptions& o) { o.limits.alignment_bytes = 24; }), Status::kBadParameter);

  SimMemory memory(1 << 16);
  EXPECT_EQ(render_frame(memory, MainAddress{0}, {}).status, Status::kBadFrame);
  const MemoryRegion record = *memory.allocate(sizeof(FrameRecord));
  for (const Mode mode : {Mode::kChecked, Mode::kPlain}) {
    EXPECT_EQ(render_frame(memory, record.address, {.mode = mode}).status, Status::kBadFrame);
  }
}

// --- Frames with effects ----------------------------------------------------------------------------------------

TEST(SimChipEffects, HaveLayoutsOfTheirOwn) {
  for_each_build([](Mode mode, std::uint32_t lanes, LayoutChoice layout) {
    if (lanes > widest_lanes()) return;
    const bool has_layout = layout.store == StoreSize::k256KB && layout.tile_width == 32 &&
                            (layout.packet_width == 8 || layout.packet_width == 32);
    const bool has_mode = mode == Mode::kPlain || (lanes == 4 && (mode == Mode::kChecked || has_instrumented_mode()));
    layout.has_effects = true;
    EXPECT_EQ(is_built(layout, mode, lanes), has_layout && has_mode);
  });
}

/// A frame with effects of which only the records exist: they are checked before a core reads them.
class EffectsFrame {
 public:
  static constexpr std::uint32_t kTriangles = 30;
  static constexpr std::uint64_t kSurfaceBytes = 1536;  // of 30 surfaces, in whole lines

  EffectsFrame() : memory_(1 << 20), image_(*memory_.allocate(64 * 1024)), color_(*memory_.allocate(32 * 32 * 4)) {
    image.magic = kImageMagic;
    image.image_bytes = 48 * 1024;
    image.triangle_count = kTriangles;
    effects.material_count = 3;
    effects.light_count = 2;
    effects.recursion_depth = effects.samples_per_pixel = 1;
    effects.smooth_triangle_count = 5;
    effects.environment_width = 16;  // 6 faces of 3x3 blocks of 768 bytes
    effects.materials_offset_bytes = 1024;
    effects.lights_offset_bytes = 1280;
    effects.surfaces_offset_bytes = 1408;
    effects.normals_offset_bytes = 2944;
    effects.environment_offset_bytes = 4096;
    tree.node_count = 4;
    tree.triangle_count = kTriangles;
    tree.depth = 2;
    tree.leaf_triangles = 8;
    tree.triangle_format = static_cast<std::uint32_t>(TriangleFormat::kVertices);
    tree.triangle_bytes = sizeof(VertexTriangle);
    tree.triangles_offset_bytes = 3328;
    tree.nodes_offset_bytes = 2048;
    frame.magic = kFrameMagic;
    frame.version = kFrameVersion;
    frame.width = frame.height = frame.tile_width = 32;
    frame.tiles_x = frame.tiles_y = frame.output_depth = 1;
    frame.engine_id = static_cast<std::uint32_t>(EngineId::kGrid);
    frame.shading = static_cast<std::uint32_t>(Shading::kScene);
    frame.t_far = kFloatMax;
    frame.color_address = color_.address.value;
    frame.effects_address = image_.address.value + 512;
    frame.image_address = image_.address.value;
    frame.tree_address = image_.address.value + 768;
  }

  /// @returns kBadParameter where the frame is sound: the spill memory is not, and that is looked at last.
  [[nodiscard]] Status status(Mode mode = Mode::kChecked) {
    std::memcpy(image_.bytes.data(), &image, sizeof image);
    std::memcpy(image_.bytes.data() + 512, &effects, sizeof effects);
    std::memcpy(image_.bytes.data() + 768, &tree, sizeof tree);
    const std::uint64_t mark = memory_.used_bytes();
    const MemoryRegion record = *memory_.allocate(sizeof frame);
    std::memcpy(record.bytes.data(), &frame, sizeof frame);
    const ChipOptions options{.mode = mode, .spill = {MainAddress{4096 + 128}, 4096}};
    const Status status = render_frame(memory_, record.address, options).status;
    memory_.release_to(mark);
    return status;
  }

  ImageHeader image{};
  EffectsRecord effects{};
  TreeRecord tree{};
  FrameRecord frame{};

 private:
  SimMemory memory_;
  MemoryRegion image_, color_;
};

TEST(SimChipEffects, WhatAFrameNamesMustLieInMemory) {
  for (const Mode mode : {Mode::kChecked, Mode::kPlain}) {
    ASSERT_EQ(EffectsFrame().status(mode), Status::kBadParameter) << "the frame itself is sound";
    const auto status_of = [&](auto change) {
      EffectsFrame frame;
      change(frame);
      return frame.status(mode);
    };
    using F = EffectsFrame;
    EXPECT_EQ(status_of([](F& f) { f.frame.effects_address = 0; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.frame.effects_address = ~std::uint64_t{0} - 63; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.frame.image_address = 0; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.frame.image_address = 1 << 20; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.image.magic = 0; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.image.image_bytes = 1 << 20; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.image.triangle_count = 1 << 20; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.effects.material_count = kMaxMaterials; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.effects.material_count = ~0u; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.effects.light_count = kMaxLights + 1; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.effects.recursion_depth = kMaxRecursionDepth + 1; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.frame.output_depth = 0; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.frame.accuracy = kAccuracyCount; }), Status::kUnsupportedFrame);
    EXPECT_EQ(status_of([](F& f) { f.effects.smooth_triangle_count = 1 << 20; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.effects.environment_width = kMaxEnvironmentWidth; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.effects.environment_width = ~0u; }), Status::kBadFrame);
    const std::uint64_t end = 48 * 1024;
    EXPECT_EQ(status_of([&](F& f) { f.effects.materials_offset_bytes = end - 128; }), Status::kBadFrame);
    EXPECT_EQ(status_of([&](F& f) { f.effects.lights_offset_bytes = ~std::uint64_t{0}; }), Status::kBadFrame);
    EXPECT_EQ(status_of([&](F& f) { f.effects.surfaces_offset_bytes = end - F::kSurfaceBytes + 128; }),
              Status::kBadFrame);
    EXPECT_EQ(status_of([&](F& f) { f.effects.surfaces_offset_bytes = end - F::kSurfaceBytes; }),
              Status::kBadParameter);
    EXPECT_EQ(status_of([&](F& f) { f.effects.normals_offset_bytes = end - 128; }), Status::kBadFrame);
    EXPECT_EQ(status_of([&](F& f) { f.effects.environment_offset_bytes = end - 6 * 9 * 768 + 128; }),
              Status::kBadFrame);
    EXPECT_EQ(status_of([&](F& f) { f.effects.environment_offset_bytes = end - 6 * 9 * 768; }), Status::kBadParameter);
    EXPECT_EQ(status_of([](F& f) { f.frame.tree_address = 0; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.frame.tree_address = 1 << 20; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.frame.tree_address = ~std::uint64_t{0} - 63; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.tree.node_count = 0; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.tree.node_count = ~0u; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.tree.triangle_count = kMaxTreeTriangles; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.tree.triangle_bytes = 1 << 20; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.tree.depth = kMaxTreeDepth + 1; }), Status::kBadFrame);
    EXPECT_EQ(status_of([](F& f) { f.tree.leaf_triangles = kMaxTreeLeaf + 1; }), Status::kBadFrame);
    EXPECT_EQ(status_of([&](F& f) { f.tree.nodes_offset_bytes = end - 4 * sizeof(TreeNode) + 128; }),
              Status::kBadFrame);
    EXPECT_EQ(status_of([&](F& f) { f.tree.nodes_offset_bytes = end - 4 * sizeof(TreeNode); }), Status::kBadParameter);
    EXPECT_EQ(status_of([&](F& f) { f.tree.triangles_offset_bytes = end - 1408; }), Status::kBadFrame);
    EXPECT_EQ(status_of([&](F& f) { f.tree.triangles_offset_bytes = ~std::uint64_t{127}; }), Status::kBadFrame);
    EXPECT_EQ(status_of([&](F& f) { f.tree.triangles_offset_bytes = end - 1536; }), Status::kBadParameter);
    // Other shadings have neither effects nor spill memory.
    EXPECT_NE(status_of([](F& f) { f.frame.shading = 1, f.frame.effects_address = 0; }), Status::kBadParameter);
  }
}

}  // namespace
}  // namespace gridiron::sim
