// Frame set-up: where planes and image may lie; frames with the effects of a scene, and those without.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/frame/frame_setup.h>

#include "core/build/grid/built_image.h"
#include "core/scene/test_effects.h"

namespace gridiron::test {
namespace {

constexpr MainAddress kImageAddress{0x12340000};

constexpr MainAddress kColorAddress{0x56780000};
static_assert(kPlaneAlignment == 32);

FrameSettings plain_settings() {
  FrameSettings settings;
  settings.camera.eye = {0, 0, 5};
  settings.color = kColorAddress;
  return settings;
}

FrameSettings scene_settings_of(Accuracy accuracy = Accuracy::kStandard) {
  FrameSettings settings = plain_settings();
  settings.shading = Shading::kScene;
  settings.accuracy = accuracy;
  settings.background_rgba = 0xFF112233u;
  return settings;
}

BuiltImage image_with_effects(TriangleFormat format = TriangleFormat::kVertices) {
  const TestEffects scene = all_effects();
  const EffectsView view = scene.view();
  return build_image(scene.mesh(), {4.0f, 2, format}, std::byte{0xCD}, &view);
}

// @returns what becomes of the settings, and checks that a refusal leaves the record alone.
Status status_of(const FrameSettings& settings, const BuiltImage& built, MainAddress image = kImageAddress) {
  FrameRecord frame{};
  frame.magic = 1;
  const Status status = make_frame_record(settings, built.view, image, frame);
  EXPECT_EQ(frame.magic, status == Status::kOk ? kFrameMagic : 1u);
  return status;
}

TEST(Planes, AreWhatTheSettingsSay) {
  const BuiltImage built = image_with_effects();
  FrameSettings settings = plain_settings();
  FrameRecord frame{};
  ASSERT_EQ(make_frame_record(settings, built.view, kImageAddress, frame), Status::kOk);
  EXPECT_EQ(frame.color_address, kColorAddress.value);
  EXPECT_EQ(frame.depth_address, 0u) << "not wanted";
  EXPECT_EQ(frame.id_address, 0u) << "not wanted";
  settings.depth = kColorAddress.offset_by(0x1000000);
  settings.ids = kColorAddress.offset_by(0x2000000);
  ASSERT_EQ(make_frame_record(settings, built.view, kImageAddress, frame), Status::kOk);
  EXPECT_EQ(frame.depth_address, settings.depth.value);
  EXPECT_EQ(frame.id_address, settings.ids.value);
}

TEST(Planes, OfColorAreRequired) {
  const BuiltImage built = image_with_effects();
  FrameSettings settings = plain_settings();
  settings.depth = settings.ids = kColorAddress;
  settings.color = MainAddress{};
  EXPECT_EQ(status_of(settings, built), Status::kBadFrame);
  settings.shading = Shading::kScene;
  EXPECT_EQ(status_of(settings, built), Status::kBadFrame);
}

TEST(Settings, AreInRange) {
  const BuiltImage built = image_with_effects();
  const auto status_with = [&built](void (*change)(FrameSettings&)) {
    FrameSettings settings = scene_settings_of();
    change(settings);
    return status_of(settings, built);
  };
  const Status bad = Status::kBadFrame, unsupported = Status::kUnsupportedFrame;
  EXPECT_EQ(status_with([](FrameSettings&) {}), Status::kOk);
  EXPECT_EQ(status_with([](FrameSettings& s) { s.t_far = std::numeric_limits<float>::infinity(); }), Status::kOk);
  EXPECT_EQ(status_with([](FrameSettings& s) { s.t_far = std::numeric_limits<float>::quiet_NaN(); }), bad);
  EXPECT_EQ(status_with([](FrameSettings& s) { s.tile_width = 0; }), bad);
  EXPECT_EQ(status_with([](FrameSettings& s) { s.tile_width = kMaxPictureWidth + 1; }), bad);
  EXPECT_EQ(status_with([](FrameSettings& s) { s.output_depth = 0; }), bad);
  EXPECT_EQ(status_with([](FrameSettings& s) { s.macro_depth = 0; }), bad);
  EXPECT_EQ(status_with([](FrameSettings& s) { s.triangle_depth = 0; }), bad);
  EXPECT_EQ(status_with([](FrameSettings& s) { s.fetch_depth = 0; }), bad);
  EXPECT_EQ(status_with([](FrameSettings& s) { s.accuracy = static_cast<Accuracy>(kAccuracyCount); }), unsupported);
  EXPECT_EQ(status_with([](FrameSettings& s) { s.shading = static_cast<Shading>(3); }), unsupported);
}

// What a platform's transfers would refuse in the middle of a frame.
TEST(Planes, LieWhereTransfersReachThem) {
  const BuiltImage built = image_with_effects();
  for (MainAddress FrameSettings::*const plane : {&FrameSettings::color, &FrameSettings::depth, &FrameSettings::ids}) {
    for (std::uint64_t shift = 0; shift <= 4 * kPlaneAlignment; ++shift) {
      FrameSettings settings = plain_settings();
      settings.*plane = kColorAddress.offset_by(shift);
      EXPECT_EQ(status_of(settings, built), shift % kPlaneAlignment == 0 ? Status::kOk : Status::kTransferAlignment)
          << shift;
    }
  }
}

TEST(Images, LieWhereTheirPartsAreAligned) {
  const BuiltImage built = image_with_effects();
  for (const Shading shading : {Shading::kSimple, Shading::kScene}) {
    FrameSettings settings = plain_settings();
    settings.shading = shading;
    for (std::uint64_t shift = 0; shift <= 2 * kLineBytes; ++shift) {
      EXPECT_EQ(status_of(settings, built, kImageAddress.offset_by(shift)),
                shift % kLineBytes == 0 ? Status::kOk : Status::kTransferAlignment)
          << shift;
    }
  }
}

// The kernel takes 0 for a frame without effects.
TEST(Images, WithEffectsLieNotAtZero) {
  const BuiltImage built = image_with_effects();
  EXPECT_EQ(status_of(plain_settings(), built, MainAddress{}), Status::kOk);
  EXPECT_EQ(status_of(scene_settings_of(), built, MainAddress{}), Status::kBadFrame);
}

TEST(FramesWithEffects, SayWhereTheEffectsLie) {
  for (const Accuracy accuracy : {Accuracy::kStandard, Accuracy::kExact, Accuracy::kFast, Accuracy::kCompact}) {
    const BuiltImage built = image_with_effects(format_of(accuracy));
    ASSERT_FALSE(HasFailure());
    FrameSettings settings = scene_settings_of(accuracy);
    FrameRecord frame{};
    ASSERT_EQ(make_frame_record(settings, built.view, kImageAddress, frame), Status::kOk);
    EXPECT_EQ(frame.shading, static_cast<std::uint32_t>(Shading::kScene));
    EXPECT_EQ(frame.image_address, kImageAddress.value);
    const auto record = read_record<EffectsRecord>(built.image.bytes(), frame.effects_address - kImageAddress.value);
    EXPECT_EQ(record.called_for, kAllEffects);
    const auto tree = read_record<TreeRecord>(built.image.bytes(), frame.tree_address - kImageAddress.value);
    EXPECT_EQ(std::memcmp(&tree, &built.view.tree, sizeof tree), 0);
    EXPECT_EQ(tree.node_count, 1u);
    EXPECT_EQ(frame.fetch_depth, 2u);
    EXPECT_EQ(frame.background_rgba, 0xFF112233u);
    settings.fetch_depth = 5;
    ASSERT_EQ(make_frame_record(settings, built.view, kImageAddress, frame), Status::kOk);
    EXPECT_EQ(frame.fetch_depth, 5u);
  }
}

TEST(FramesWithEffects, WantAnImageThatHasThem) {
  const BuiltImage bare = build_image(all_effects().mesh(), {4.0f, 2, TriangleFormat::kVertices});
  FrameRecord frame{};
  EXPECT_EQ(make_frame_record(scene_settings_of(), bare.view, kImageAddress, frame), Status::kUnsupportedImage);
}

TEST(FramesWithEffects, AreNotForProjections) {
  BuiltImage bare = build_image(all_effects().mesh(), {4.0f, 2, TriangleFormat::kProjection});
  bare.view.has_effects = true;  // which no image that opens would say
  FrameRecord frame{};
  EXPECT_EQ(make_frame_record(scene_settings_of(Accuracy::kPaper), bare.view, kImageAddress, frame),
            Status::kUnsupportedImage);
}

TEST(FramesWithEffects, FetchAtLeastOneAtATime) {
  const BuiltImage built = image_with_effects();
  FrameSettings settings = scene_settings_of();
  settings.fetch_depth = 0;
  FrameRecord frame{};
  EXPECT_EQ(make_frame_record(settings, built.view, kImageAddress, frame), Status::kBadFrame);
}

// The engine of eye rays reads the grid or the tree; the image has it or the frame is refused.
TEST(Engines, WantAnImageThatHoldsWhatTheyRead) {
  const TestEffects scene = all_effects();
  const EffectsView view = scene.view();
  const auto image_with = [&](bool has_grid, bool has_tree, bool has_effects) {
    const GridParameters parameters{.macro_width = 2, .has_tree = has_tree, .has_grid = has_grid};
    return build_image(scene.mesh(), parameters, std::byte{0xCD}, has_effects ? &view : nullptr);
  };
  const auto status_with = [](const BuiltImage& built, EngineId engine, Shading shading) {
    FrameSettings settings = plain_settings();
    settings.engine = engine;
    settings.shading = shading;
    return status_of(settings, built);
  };
  const BuiltImage grid = image_with(true, false, false), tree = image_with(false, true, false),
                   both = image_with(true, true, false), effects = image_with(false, false, true);
  ASSERT_FALSE(HasFailure());
  const Status missing = Status::kUnsupportedImage;
  EXPECT_EQ(status_with(grid, EngineId::kGrid, Shading::kSimple), Status::kOk);
  EXPECT_EQ(status_with(grid, EngineId::kTree, Shading::kSimple), missing);
  EXPECT_EQ(status_with(tree, EngineId::kGrid, Shading::kSimple), missing);
  EXPECT_EQ(status_with(tree, EngineId::kTree, Shading::kSimple), Status::kOk);
  EXPECT_EQ(status_with(tree, EngineId::kTree, Shading::kScene), missing);
  EXPECT_EQ(status_with(both, EngineId::kGrid, Shading::kSimple), Status::kOk);
  EXPECT_EQ(status_with(both, EngineId::kTree, Shading::kSimple), Status::kOk);
  EXPECT_EQ(status_with(effects, EngineId::kGrid, Shading::kScene), missing);
  EXPECT_EQ(status_with(effects, EngineId::kTree, Shading::kScene), Status::kOk);
}

TEST(FramesWithoutEffects, LeaveTheirFieldsZero) {
  const BuiltImage built = image_with_effects();
  for (const Shading shading : {Shading::kNone, Shading::kSimple}) {
    FrameSettings settings = scene_settings_of();
    settings.shading = shading;
    FrameRecord frame{};
    ASSERT_EQ(make_frame_record(settings, built.view, kImageAddress, frame), Status::kOk);
    EXPECT_EQ(frame.effects_address, 0u);
    EXPECT_EQ(frame.image_address, 0u);
    EXPECT_EQ(frame.tree_address, 0u);
    EXPECT_EQ(frame.fetch_depth, 0u);
  }
}

}  // namespace
}  // namespace gridiron::test
