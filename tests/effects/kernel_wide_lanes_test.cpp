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
// A store in which no list is ever cut: room for all rays of a batch in all five lists of every level.
// Without beams, which 16 lanes do not use.
struct UncutLayout : Layout {
  static constexpr bool kHasBeams = false;
  static constexpr std::uint32_t kArenaBytes = 512 * 1024;
  static constexpr std::uint32_t kSpareListWords = 5 * Layout::kBatchRays * kMaxTreeDepth;
};
static_assert(kFitsArena<UncutLayout>);

// What any lanes do with the same lists.
constexpr Work kListWork[] = {Work::kListChild, Work::kListNode, Work::kListLeaf};
// What they do for the same rays, however lists are cut.
constexpr Work kRayWork[] = {Work::kListRay,    Work::kWaveRay,      Work::kQueuedRay,  Work::kSurfacePoint,
                             Work::kShadowRay,  Work::kLightSample,  Work::kHighlight,  Work::kOcclusionRay,
                             Work::kMirrorRay,  Work::kRefractedRay, Work::kColorAdded, Work::kEnvironmentLookup,
                             Work::kSmoothNormal, Work::kAreaPlace,   Work::kJitterSeed};

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
    for (const Work kind : kRayWork) {
      EXPECT_EQ(picture.work[kind], four.work[kind]) << "kind " << static_cast<int>(kind);
    }
    if (accuracy == Accuracy::kCompact) continue;  // its vertices are others
    const ReferencePicture reference = render_reference(description, kWidth, kHeight);
    const auto steps = compare_steps(picture.color, reference.color);
    ASSERT_TRUE(steps.has_value());
    EXPECT_LE(steps->off_by_more_than_1, 6u) << "of " << steps->pixels << ", by up to " << steps->largest;
  }
}

// Four lanes have five lists a node, wider ones one, so that lists are cut elsewhere: a node may be entered twice, and
// rays that were stopped meanwhile are missing then. Where no list is cut, wide lanes make the same lists but for rays
// that were stopped, which leave them earlier.
TYPED_TEST(KernelLanes, MakeNoMoreListsWhereNoneIsCut) {
  for (const Accuracy accuracy : {Accuracy::kStandard, Accuracy::kCompact}) {
    const KernelOptions options{.accuracy = accuracy};
    const tool::SceneDescription description = lit_glass();
    KernelScene scene = build_kernel_scene(description, options);
    const Camera camera = camera_of(description.view);
    const KernelPicture cut = render_kernel<Layout, Lanes<4>>(scene, camera, kWidth, kHeight, options);
    const KernelPicture four = render_kernel<UncutLayout, Lanes<4>>(scene, camera, kWidth, kHeight, options);
    const KernelPicture picture = render_kernel<UncutLayout, TypeParam>(scene, camera, kWidth, kHeight, options);
    ASSERT_EQ(picture.status, Status::kOk) << picture.violation;
    EXPECT_EQ(picture.color, cut.color);
    for (const Work kind : kRayWork) EXPECT_EQ(picture.work[kind], cut.work[kind]) << "kind " << static_cast<int>(kind);
    for (const Work kind : kListWork) {
      EXPECT_LE(picture.work[kind], four.work[kind]) << "kind " << static_cast<int>(kind);
      EXPECT_GT(picture.work[kind], four.work[kind] - four.work[kind] / 8) << "kind " << static_cast<int>(kind);
    }
    // What the cache still has depends on the order in which children were asked for: 0.3 % more gets were measured.
    EXPECT_LE(picture.work[Work::kGetIssue], four.work[Work::kGetIssue] + four.work[Work::kGetIssue] / 100);
    EXPECT_GT(cut.work[Work::kListNode], four.work[Work::kListNode]) << "no list of the shipped layout is cut";
  }
}

}  // namespace
}  // namespace gridiron::test
