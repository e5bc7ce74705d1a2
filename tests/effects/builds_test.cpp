// Renderers built for a set of effects, and that of a 64 KB core: the same pictures from less code, and a name for what
// was left out. The example is that of core/README.md.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/one_lane.h>
#include <gridiron/render/tile_renderer.h>
#include <gridiron/store/local_store.h>

#include "effects/effect_scene.h"
#include "effects/kernel_scene.h"

namespace gridiron::test {
namespace {

// A renderer of plain light, shadows of point lights and nothing else.
using ShadowStore = LocalStore<EffectLayout256K<kSceneShading | kPointShadows>>;

template <Platform P>
Status render_shadows(ShadowStore& store, P& platform, MainAddress frame) {
  return render_tiles<Lanes<4>>(store, platform, frame);
}

constexpr std::uint32_t kWidth = 52, kHeight = 36;

KernelOptions small_options() {
  return {.fetch_depth = 2, .macro_depth = 2, .triangle_depth = 2};
}

// A ball in a room, with all effects.
tool::SceneDescription full_scene() {
  tool::SceneDescription scene = glass_ball_scene(true);
  set_environment(scene, Vec3(0.25f, 0.5f, 0.75f), 9);
  scene.ambient_occlusion = tool::AmbientOcclusion{4, 1.0f};
  scene.samples_per_pixel = 4;
  return scene;
}

template <class Layout, class L = Lanes<4>>
KernelPicture picture_of(const tool::SceneDescription& description, KernelOptions options = small_options()) {
  KernelScene scene = build_kernel_scene(description, options);
  EXPECT_EQ(scene.status, Status::kOk);
  KernelPicture picture = render_kernel<Layout, L>(scene, camera_of(description.view), kWidth, kHeight, options);
  EXPECT_EQ(picture.violation, "");
  return picture;
}

TEST(Builds, OfAllEffectsIn64KbGiveThePictureOf256Kb) {
  for (const Accuracy accuracy : {Accuracy::kStandard, Accuracy::kExact, Accuracy::kCompact, Accuracy::kFast}) {
    SCOPED_TRACE(static_cast<int>(accuracy));
    KernelOptions options = small_options();
    options.accuracy = accuracy;
    const KernelPicture large = picture_of<EffectLayout256K<kAllEffects>>(full_scene(), options);
    ASSERT_EQ(large.status, Status::kOk);
    const KernelPicture small = picture_of<EffectLayout64K<kAllEffects>>(full_scene(), options);
    ASSERT_EQ(small.status, Status::kOk);
    const KernelPicture one_lane = picture_of<EffectLayout64K<kAllEffects>, Lanes<1>>(full_scene(), options);
    ASSERT_EQ(one_lane.status, Status::kOk);
    EXPECT_EQ(one_lane.color, small.color);
    // `fast` has edges of its own for packets.
    if (accuracy != Accuracy::kFast) {
      EXPECT_EQ(small.color, large.color);
    }
  }
}

TEST(Builds, LongerWavesOf64KbChangeNothing) {
  EXPECT_EQ((picture_of<EffectLayout64K<kAllEffects, 64>>(full_scene()).color),
            (picture_of<EffectLayout64K<kAllEffects>>(full_scene()).color));
}

TEST(Builds, ASceneGetsWhatItCallsForFromEverySetThatHasIt) {
  tool::SceneDescription scene = full_scene();
  const KernelPicture full = picture_of<EffectLayout256K<kAllEffects>>(scene);
  scene = glass_ball_scene(false);
  for (tool::SceneMaterial& material : scene.materials) {
    material.kd = 1.0f;
    material.ks = material.transmittance = 0.0f;
  }
  const KernelScene built = build_kernel_scene(scene, small_options());
  constexpr std::uint32_t kShadows = kSceneShading | kPointShadows;
  ASSERT_EQ(built.called_for & ~kShadows, 0u);
  const KernelPicture all = picture_of<EffectLayout256K<kAllEffects>>(scene);
  ASSERT_EQ(all.status, Status::kOk);
  EXPECT_NE(all.color, full.color);
  EXPECT_EQ(picture_of<EffectLayout256K<kShadows>>(scene).color, all.color);
  EXPECT_EQ(picture_of<EffectLayout64K<kShadows>>(scene).color, all.color);
}

// A platform on which the first transfer fails.
class NoPlatform {
 public:
  [[nodiscard]] PlatformLimits limits() const { return {}; }
  Status get(void*, MainAddress, std::uint32_t, Tag) { return Status::kTransferFailed; }
  Status put(const void*, MainAddress, std::uint32_t, Tag) { return Status::kTransferFailed; }
  Status wait(TagMask) { return Status::kOk; }
  ItemClaim claim_item() { return {}; }
};

TEST(Builds, WhatWasLeftOutIsNamed) {
  const auto missing = []<class Layout>() {
    const KernelPicture picture = picture_of<Layout>(glass_ball_scene(false));
    EXPECT_EQ(picture.status, Status::kMissingEffect);
    return picture.missing_effects;
  };
  const std::uint32_t called_for = build_kernel_scene(glass_ball_scene(false), small_options()).called_for;
  constexpr std::uint32_t kShadows = kSceneShading | kPointShadows;
  constexpr std::uint32_t kMirrors = kSceneShading | kReflection | kRefraction;
  EXPECT_EQ(missing.operator()<EffectLayout256K<kShadows>>(), called_for & ~kShadows);
  EXPECT_NE(called_for & ~kShadows, 0u);
  EXPECT_EQ(missing.operator()<EffectLayout64K<kMirrors>>(), called_for & ~kMirrors);
  EXPECT_EQ(missing.operator()<StoreLayout256K<8>>(), kSceneShading) << "it has not read which others there are";
  KernelOptions planes = small_options();
  planes.wants_planes = true;
  EXPECT_EQ(picture_of<EffectLayout64K<kAllEffects>>(glass_ball_scene(false), planes).status,
            Status::kUnsupportedFrame)
      << "distances of eye rays are a matter of packets";
  const auto store = std::make_unique<ShadowStore>();
  NoPlatform platform;
  EXPECT_EQ(render_shadows(*store, platform, MainAddress{4096}), Status::kTransferFailed);
}

TEST(Builds, TheReadmeShowsWhatIsCompiledHere) {
  const auto text_of = [](const char* name) {
    std::ifstream file(std::string(GRIDIRON_SOURCE_DIR) + "/" + name);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string readme = text_of("core/README.md");
  const std::string opening = "```cpp\n";
  const std::size_t begin = readme.find(opening);
  ASSERT_NE(begin, std::string::npos);
  const std::size_t end = readme.find("```", begin + opening.size());
  ASSERT_NE(end, std::string::npos);
  const std::string block = readme.substr(begin + opening.size(), end - begin - opening.size());
  EXPECT_GT(block.size(), 100u);
  EXPECT_NE(text_of("tests/effects/builds_test.cpp").find(block), std::string::npos) << block;
}

TEST(Builds, QueuesAreForThoseThatCastRays) {
  using With = LocalStore<EffectLayout64K<kSceneShading | kReflection>>;
  using Without = LocalStore<EffectLayout64K<kAllEffects & ~(kReflection | kRefraction)>>;
  EXPECT_LT(sizeof(Without), sizeof(With) - 2000);
}

}  // namespace
}  // namespace gridiron::test
