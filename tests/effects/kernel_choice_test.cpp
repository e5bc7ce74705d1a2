// Choice of effects: one that a scene does not call for costs nothing; one that a kernel lacks is reported by name.
// SPDX-License-Identifier: Apache-2.0
#include "effects/effect_scene.h"
#include "effects/kernel_check.h"
#include "effects/kernel_variants.h"

namespace gridiron::test {
namespace {

using tool::SceneDescription;

constexpr std::uint32_t kSize = 64;  // 2 x 2 tiles

// Each shipped scene, built and rendered once by the kernel with all effects.
struct Shipped {
  SceneDescription description;
  KernelScene scene;
  KernelPicture picture;
};
Shipped& shipped(std::string_view name) {
  static std::map<std::string, Shipped, std::less<>> known;
  const auto found = known.find(name);
  if (found != known.end()) return found->second;
  Shipped& made = known[std::string(name)];
  made.description = shipped_scene(name);
  made.scene = build_kernel_scene(made.description, {});
  made.picture = render_all_effects(made.scene, camera_of(made.description.view), kSize, kSize, {});
  EXPECT_EQ(made.picture.status, Status::kOk) << name;
  return made;
}

std::vector<KernelVariant> all_variants() {
  std::vector<KernelVariant> variants;
  for (const auto& some : {plain_variants(), bounce_variants(), shading_variants()}) {
    variants.insert(variants.end(), some.begin(), some.end());
  }
  return variants;
}

std::uint64_t bytes_of(const KernelPicture& picture, Stage stage) {
  return picture.stage_bytes[static_cast<std::size_t>(stage)];
}

TEST(KernelChoice, WhatASceneDoesNotCallForHappensNever) {
  std::uint32_t called = 0, left_aside = 0;
  for (const std::string_view name : kShippedScenes) {
    SCOPED_TRACE(name);
    const Shipped& scene = shipped(name);
    const std::uint32_t effects = scene.scene.called_for;
    const WorkCounters& work = scene.picture.work;
    called |= effects;
    left_aside |= ~effects & kAllEffects;
    const auto expect_work = [&](std::uint32_t wanted_by, Work kind) {
      if ((effects & wanted_by) != 0) {
        EXPECT_GT(work[kind], 0u) << "kind " << static_cast<int>(kind);
      } else {
        EXPECT_EQ(work[kind], 0u) << "kind " << static_cast<int>(kind);
      }
    };
    // Lights are read, however lit: the stage of shadows moves bytes where lights are many, or cast shadows.
    const bool has_shadows =
        scene.description.shadows && !(scene.description.point_lights.empty() && scene.description.area_lights.empty());
    if (has_shadows) {
      EXPECT_GT(work[Work::kShadowRay], 0u);
      EXPECT_GT(bytes_of(scene.picture, Stage::kShadow), 0u);
    } else {
      EXPECT_EQ(work[Work::kShadowRay], 0u);
      EXPECT_EQ(bytes_of(scene.picture, Stage::kShadow), 0u);
    }
    EXPECT_EQ((effects & kPointShadows) != 0, scene.description.shadows && !scene.description.point_lights.empty());
    expect_work(kAmbientOcclusion, Work::kOcclusionRay);
    EXPECT_EQ(bytes_of(scene.picture, Stage::kOcclusion) != 0, (effects & kAmbientOcclusion) != 0);
    expect_work(kReflection | kRefraction, Work::kMirrorRay);
    expect_work(kReflection | kRefraction, Work::kQueuedRay);
    expect_work(kRefraction, Work::kRefractedRay);
    EXPECT_EQ(bytes_of(scene.picture, Stage::kBounce) != 0, (effects & (kReflection | kRefraction)) != 0);
    expect_work(kEnvironment, Work::kEnvironmentLookup);
    EXPECT_EQ(bytes_of(scene.picture, Stage::kEnvironment) != 0, (effects & kEnvironment) != 0);
    expect_work(kSmoothNormals, Work::kSmoothNormal);
    expect_work(kHighlights, Work::kHighlight);
    const std::uint32_t samples = (effects & kMultisampling) != 0 ? scene.description.samples_per_pixel : 1;
    EXPECT_EQ((effects & kMultisampling) != 0, samples > 1);
    EXPECT_EQ(work[Work::kWaveRay] - work[Work::kQueuedRay], samples * kSize * kSize);
    // Without any ray beyond the eye's no list begins.
    const bool has_rays = has_shadows || (effects & (kAmbientOcclusion | kReflection | kRefraction)) != 0;
    for (const Work kind : {Work::kListRay, Work::kListNode, Work::kListChild}) {
      EXPECT_EQ(work[kind] != 0, has_rays) << static_cast<int>(kind);
    }
    EXPECT_EQ(work[Work::kListBoxQuad] + work[Work::kListSharedBox] != 0, has_rays);
    if (!has_rays) {
      EXPECT_EQ(work[Work::kListRayNode], 0u);
    }
  }
  EXPECT_EQ(called, kTextEffects);
  EXPECT_EQ(left_aside, kAllEffects & ~kSceneShading);
}

// The same code paths, whatever else there is code for.
TEST(KernelChoice, BuiltForJustItsEffectsASceneIsTheSame) {
  const std::vector<KernelVariant> variants = all_variants();
  ASSERT_EQ(variants.size() + 1, std::size(kShippedScenes));  // `everything` is the kernel with all
  EXPECT_EQ(shipped("everything").scene.called_for, kTextEffects);
  for (const KernelVariant& variant : variants) {
    SCOPED_TRACE(variant.name);
    Shipped& scene = shipped(variant.name);
    ASSERT_EQ(scene.scene.called_for, variant.effects);
    const KernelPicture picture =
        variant.render(scene.scene, camera_of(scene.description.view), kSize, kSize, {});
    ASSERT_EQ(picture.status, Status::kOk) << picture.violation;
    EXPECT_EQ(picture.color, scene.picture.color);
    EXPECT_EQ(different_work(picture.work, scene.picture.work), "");
    EXPECT_EQ(picture.stage_bytes, scene.picture.stage_bytes);
    EXPECT_EQ(picture.stage_transfers, scene.picture.stage_transfers);
  }
}

TEST(KernelChoice, WhatIsMissingIsToldByName) {
  std::uint32_t seen = 0;
  for (const KernelVariant& variant : all_variants()) {
    for (const std::string_view name : kShippedScenes) {
      Shipped& scene = shipped(name);
      const std::uint32_t missing = scene.scene.called_for & ~variant.effects;
      const KernelPicture picture = variant.render(scene.scene, camera_of(scene.description.view), 8, 8, {});
      EXPECT_EQ(picture.status, missing == 0 ? Status::kOk : Status::kMissingEffect);
      EXPECT_EQ(picture.missing_effects, missing) << name << " by the kernel of " << variant.name;
      seen |= picture.missing_effects;
    }
  }
  EXPECT_EQ(seen, kTextEffects & ~kSceneShading);
  Shipped& scene = shipped("shadow");
  const Camera camera = camera_of(scene.description.view);
  EXPECT_EQ(render_without_effects(scene.scene, camera, 8, 8, {}).missing_effects, kSceneShading);
  const KernelOptions plain{.shading = Shading::kSimple};
  EXPECT_EQ(render_without_effects(scene.scene, camera, 8, 8, plain).status, Status::kOk);
}

// An image without effects says so; another shading needs none.
TEST(KernelChoice, OtherShadingsLeaveEffectsAside) {
  Shipped& scene = shipped("everything");
  const Camera camera = camera_of(scene.description.view);
  const KernelOptions plain{.shading = Shading::kSimple};
  const KernelPicture with = render_all_effects(scene.scene, camera, kSize, kSize, plain);
  const KernelPicture without = render_without_effects(scene.scene, camera, kSize, kSize, plain);
  ASSERT_EQ(with.status, Status::kOk);
  ASSERT_EQ(without.status, Status::kOk);
  EXPECT_EQ(with.color, without.color);
  for (const Stage stage : {Stage::kSurface, Stage::kShadow, Stage::kOcclusion, Stage::kBounce, Stage::kEnvironment}) {
    EXPECT_EQ(bytes_of(with, stage), 0u);
  }
  EXPECT_EQ(with.work[Work::kWaveRay], 0u);
}

TEST(KernelChoice, SpillRegionsAreHeldAgainstWhatTheDepthAsks) {
  Shipped& scene = shipped("mirror");
  const Camera camera = camera_of(scene.description.view);
  const std::uint64_t needed = spill_bytes(scene.description.recursion_depth);
  ASSERT_GT(needed, 0u);
  KernelOptions options;
  for (const std::uint64_t bytes : {std::uint64_t{0}, needed - 4096, needed - 1}) {
    options.spill_bytes = bytes;
    EXPECT_EQ(render_all_effects(scene.scene, camera, 8, 8, options).status, Status::kSpillTooSmall) << bytes;
  }
  options.spill_bytes = needed;
  EXPECT_EQ(render_all_effects(scene.scene, camera, 8, 8, options).status, Status::kOk);
  options.spill_shift = 128;
  EXPECT_EQ(render_all_effects(scene.scene, camera, 8, 8, options).status, Status::kSpillTooSmall);
  // Scenes without such rays need none.
  options.spill_bytes = 0;
  Shipped& plain = shipped("shadow");
  EXPECT_EQ(render_all_effects(plain.scene, camera_of(plain.description.view), 8, 8, options).status, Status::kOk);
}

TEST(KernelChoice, FramesThatEffectsCannotBeRenderedForAreRefused) {
  Shipped& scene = shipped("shadow");
  const Camera camera = camera_of(scene.description.view);
  KernelOptions options;
  const auto status_of = [&](void (*alter)(FrameRecord&)) {
    options.alter = alter;
    return render_all_effects(scene.scene, camera, 8, 8, options).status;
  };
  EXPECT_EQ(status_of(+[](FrameRecord&) {}), Status::kOk);
  EXPECT_EQ(status_of(+[](FrameRecord& frame) { frame.fetch_depth = 0; }), Status::kUnsupportedFrame);
  EXPECT_EQ(status_of(+[](FrameRecord& frame) { frame.fetch_depth = 16; }), Status::kUnsupportedFrame);
  EXPECT_EQ(status_of(+[](FrameRecord& frame) { frame.fetch_depth = 0xFFFFFFFFu; }), Status::kUnsupportedFrame);
  EXPECT_EQ(status_of(+[](FrameRecord& frame) { frame.effects_address = 0; }), Status::kBadFrame);
  EXPECT_EQ(status_of(+[](FrameRecord& frame) { frame.image_address = 0; }), Status::kBadFrame);
  EXPECT_EQ(status_of(+[](FrameRecord& frame) { frame.tree_address = 0; }), Status::kBadFrame);
  EXPECT_EQ(status_of(+[](FrameRecord& frame) {
              frame.accuracy = static_cast<std::uint32_t>(Accuracy::kPaper);
              frame.engine.grid.triangle_format = static_cast<std::uint32_t>(TriangleFormat::kProjection);
            }),
            Status::kUnsupportedFrame);
  options.alter = nullptr;
  // The set-up of frames does not make them either.
  options.fetch_depth = 0;
  EXPECT_NE(render_all_effects(scene.scene, camera, 8, 8, options).status, Status::kOk);
  options.fetch_depth = 15;
  options.accuracy = Accuracy::kPaper;
  EXPECT_NE(render_all_effects(scene.scene, camera, 8, 8, options).status, Status::kOk);
  options.accuracy = Accuracy::kStandard;
  for (const std::uint32_t depth : {1u, 8u, 15u}) {
    options.fetch_depth = depth;
    EXPECT_EQ(render_all_effects(scene.scene, camera, 8, 8, options).status, Status::kOk) << depth;
  }
}

// Smooth normals are fetched only if a material calls for them: a ball in the first of four tiles.
TEST(KernelChoice, SmoothNormalsCostNothingInTilesWithoutThem) {
  const auto make = [](bool is_smooth) {
    SceneDescription scene = empty_scene({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 60);
    const tool::SceneMaterial material{.smooth_normals = is_smooth};
    const std::uint16_t matt = add_material(scene, {});
    add_ball(scene, {-1.2f, 1.2f, 0}, 0.6f, 4, add_material(scene, material));
    add_parallelogram(scene, {-2, -2, -1}, {4, 0, 0}, {0, 4, 0}, matt);
    scene.point_lights.push_back({{0, 0, 4}, Vec3(1)});
    return scene;
  };
  const KernelPicture smooth = render_scene(make(true), 64, 64);
  const KernelPicture flat = render_scene(make(false), 64, 64);
  ASSERT_EQ(smooth.status, Status::kOk);
  ASSERT_EQ(flat.status, Status::kOk);
  EXPECT_EQ(flat.work[Work::kSmoothNormal], 0u);
  ASSERT_GT(smooth.work[Work::kSmoothNormal], 0u);
  // Every hit on the ball is one normal; they are all in the first tile.
  const KernelOptions planes{.wants_planes = true};
  const SceneDescription scene = make(true);
  const KernelPicture ids = render_scene(scene, 64, 64, planes);
  std::uint32_t on_ball = 0;
  for (std::size_t i = 0; i < ids.ids.size(); ++i) {
    if (ids.ids[i] >= scene.geometry.triangles.size() - 2) continue;  // the wall's, or none
    ++on_ball;
    EXPECT_TRUE(i % 64 < 32 && i / 64 < 32);
  }
  EXPECT_EQ(smooth.work[Work::kSmoothNormal], on_ball);
  ASSERT_EQ(smooth.tile_bytes.size(), 4u);
  EXPECT_GT(smooth.tile_bytes[0], flat.tile_bytes[0]);
  for (std::size_t tile = 1; tile < 4; ++tile) {
    EXPECT_EQ(smooth.tile_bytes[tile], flat.tile_bytes[tile]) << tile;
    for (std::uint32_t i = 0; i < 32 * 32; ++i) {
      const std::size_t pixel = (tile / 2 * 32 + i / 32) * 64 + tile % 2 * 32 + i % 32;
      ASSERT_EQ(smooth.color[pixel], flat.color[pixel]);
    }
  }
}

}  // namespace
}  // namespace gridiron::test
