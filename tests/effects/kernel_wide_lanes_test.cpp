// Lanes of other instruction sets: their pictures are those of four lanes, and the reference's.
// SPDX-License-Identifier: Apache-2.0
#include "core/lane_types.h"
#include "effects/compare_pictures.h"
#include "effects/effect_scene.h"
#include "effects/kernel_scene.h"
#include "effects/reference/reference_renderer.h"

namespace gridiron::test {
namespace {

constexpr std::uint32_t kWidth = 40, kHeight = 34;
using Layout = EffectLayout256K<kAllEffects>;

template <class L>
class KernelLanes : public testing::Test {};
TYPED_TEST_SUITE(KernelLanes, LaneTypes, LaneNames);

tool::SceneDescription lit_glass() {
  tool::SceneDescription scene = glass_ball_scene(/*is_smooth=*/true, 4);
  scene.area_lights.push_back({{1, 4, 1}, {1, 0, 0}, {0, 0, 1}, Vec3(0.5f), 4});
  scene.ambient_occlusion = tool::AmbientOcclusion{4, 1.5f};
  set_environment(scene, {0.2f, 0.4f, 0.3f}, 3);
  return scene;
}

TYPED_TEST(KernelLanes, ChangeNoPixelAndNoRay) {
  for (const Accuracy accuracy : {Accuracy::kStandard, Accuracy::kExact, Accuracy::kCompact, Accuracy::kFast}) {
    const KernelOptions options{.accuracy = accuracy};
    const tool::SceneDescription description = lit_glass();
    KernelScene scene = build_kernel_scene(description, options);
    const Camera camera = camera_of(description.view);
    const KernelPicture four = render_kernel<Layout, Lanes<4>>(scene, camera, kWidth, kHeight, options);
    const KernelPicture picture = render_kernel<Layout, TypeParam>(scene, camera, kWidth, kHeight, options);
    ASSERT_EQ(picture.status, Status::kOk) << picture.violation;
    EXPECT_EQ(picture.color, four.color);
    for (const Work kind :
         {Work::kListRay, Work::kListNode, Work::kListRayNode, Work::kListChild, Work::kListLeaf,
          Work::kWaveRay, Work::kQueuedRay, Work::kSurfacePoint, Work::kShadowRay, Work::kLightSample,
          Work::kOcclusionRay, Work::kMirrorRay, Work::kRefractedRay, Work::kEnvironmentLookup, Work::kColorAdded}) {
      EXPECT_EQ(picture.work[kind], four.work[kind]) << "kind " << static_cast<int>(kind);
    }
    if (accuracy == Accuracy::kCompact) continue;  // its vertices are others
    const ReferencePicture reference = render_reference(description, kWidth, kHeight);
    const auto steps = compare_steps(picture.color, reference.color);
    ASSERT_TRUE(steps.has_value());
    EXPECT_LE(steps->off_by_more_than_1, 6u) << "of " << steps->pixels << ", by up to " << steps->largest;
  }
}

}  // namespace
}  // namespace gridiron::test
