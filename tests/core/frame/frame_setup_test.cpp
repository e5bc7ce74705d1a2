// Frame set-up: frames with the effects of a scene, and those without. SPDX-License-Identifier: Apache-2.0
#include <gridiron/frame/frame_setup.h>
#include <gtest/gtest.h>

#include "core/grid/built_image.h"
#include "core/scene/test_effects.h"

namespace gridiron::test {
namespace {

constexpr MainAddress kImageAddress{0x12340000};

FrameSettings scene_settings_of(Accuracy accuracy = Accuracy::kStandard) {
  FrameSettings settings;
  settings.camera.eye = {0, 0, 5};
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
    EXPECT_EQ(frame.walk_depth, 2u);
    EXPECT_EQ(frame.background_rgba, 0xFF112233u);
    settings.walk_depth = 5;
    ASSERT_EQ(make_frame_record(settings, built.view, kImageAddress, frame), Status::kOk);
    EXPECT_EQ(frame.walk_depth, 5u);
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

TEST(FramesWithEffects, WalkAtLeastOnce) {
  const BuiltImage built = image_with_effects();
  FrameSettings settings = scene_settings_of();
  settings.walk_depth = 0;
  FrameRecord frame{};
  EXPECT_EQ(make_frame_record(settings, built.view, kImageAddress, frame), Status::kBadFrame);
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
    EXPECT_EQ(frame.walk_depth, 0u);
  }
}

}  // namespace
}  // namespace gridiron::test
