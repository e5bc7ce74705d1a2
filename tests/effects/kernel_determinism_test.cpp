// The same picture and the same work, however a core is built and whatever its platform is like.
// SPDX-License-Identifier: Apache-2.0
#include <glm/common.hpp>

#include "effects/effect_scene.h"
#include "effects/kernel_check.h"
#include "effects/kernel_variants.h"

namespace gridiron::test {
namespace {

using tool::SceneDescription;

// A picture of each accuracy of a scene that calls for everything, with what stays the same in all of them.
struct Base {
  SceneDescription description;
  Camera camera;
  KernelScene scene;
  KernelPicture picture;
};
constexpr std::uint32_t kWidth = 40, kHeight = 34;  // 2 x 2 tiles, cut

SceneDescription everything_small() {
  // Not the shipped one: its triangles are many. All effects, all kinds of rays.
  SceneDescription scene = glass_ball_scene(/*is_smooth=*/true, 4);
  const tool::SceneMaterial mirror{.kd = 0.3f, .ks = 0.6f, .shine = 20.0f};
  add_box(scene, {-1.8f, -0.7f, -1.6f}, {-0.7f, 1.5f, -0.8f}, add_material(scene, mirror));
  scene.area_lights.push_back({{1, 4, 1}, {1, 0, 0}, {0, 0, 1}, {0.5f, 0.4f, 0.3f}, 4});
  scene.ambient_occlusion = tool::AmbientOcclusion{4, 1.5f};
  scene.samples_per_pixel = 4;
  scene.levels = ColorLevels::kSrgb;
  for (tool::SceneMaterial& material : scene.materials) {
    if (material.smooth_normals) material.vertex_colors = true;
  }
  for (const Vec3& vertex : scene.geometry.vertices) scene.geometry.colors.push_back(glm::abs(glm::fract(vertex)));
  for (std::size_t i = 0; i < scene.geometry.triangles.size(); ++i) {
    const bool is_colored = scene.materials[scene.geometry.triangle_materials[i]].vertex_colors;
    scene.geometry.triangle_colors.push_back(is_colored ? scene.geometry.triangles[i] : UVec3(tool::kNoNormal));
  }
  set_environment(scene, Vec3(0.4f), 9);
  for (std::size_t face = 0; face < tool::kCubeFaceCount; ++face) {
    for (std::size_t i = 0; i < 81; ++i) {
      scene.environment->texels[face][i] = Vec3(static_cast<float>((i * 7 + face * 5) % 11) / 10.0f);
    }
  }
  return scene;
}

Base& base(Accuracy accuracy) {
  static std::map<Accuracy, Base> known;
  const auto [entry, is_new] = known.try_emplace(accuracy);
  Base& made = entry->second;
  if (!is_new) return made;
  const KernelOptions options{.accuracy = accuracy};
  made.description = everything_small();
  made.camera = camera_of(made.description.view);
  made.scene = build_kernel_scene(made.description, options);
  EXPECT_EQ(made.scene.called_for, kAllEffects);
  made.picture = render_all_effects(made.scene, made.camera, kWidth, kHeight, options);
  EXPECT_EQ(made.picture.status, Status::kOk);
  return made;
}

class KernelDeterminism : public testing::TestWithParam<Accuracy> {
 protected:
  // Renders another way and compares picture, ids and work with the base; on demand waits may differ, or all transfers.
  enum class Alike { kAll, kAllButWaits, kAllButTransfers };
  void expect_same(const KernelOptions& changed, Alike alike, const std::string& what,
                   RenderKernel* render = render_all_effects) {
    SCOPED_TRACE(what);
    Base& scene = base(GetParam());
    KernelOptions options = changed;
    options.accuracy = GetParam();
    const KernelPicture picture = render(scene.scene, scene.camera, kWidth, kHeight, options);
    ASSERT_EQ(picture.status, Status::kOk) << picture.violation;
    EXPECT_EQ(picture.violation, "");
    EXPECT_EQ(picture.color, scene.picture.color);
    if (alike == Alike::kAllButTransfers) {
      EXPECT_EQ(different_but_in_transfers(picture.work, scene.picture.work), "");
      return;
    }
    const bool is_all = alike == Alike::kAll;
    EXPECT_EQ(is_all ? different_work(picture.work, scene.picture.work)
                     : different_work(picture.work, scene.picture.work, {Work::kWait}),
              "");
    EXPECT_EQ(picture.stage_bytes, scene.picture.stage_bytes);
    EXPECT_EQ(picture.stage_transfers, scene.picture.stage_transfers);
  }
};

// Nodes and leaves that are asked for ahead may displace others, which are then fetched again.
TEST_P(KernelDeterminism, HowMuchIsAskedForAheadChangesNoWorkButTransfers) {
  for (const std::uint32_t depth : {1u, 2u, 3u, 5u, 8u, 15u}) {
    KernelOptions options{.fetch_depth = depth};
    expect_same(options, Alike::kAllButTransfers, "depth: " + std::to_string(depth));
    options.queue_depth = 32;
    expect_same(options, Alike::kAllButTransfers, "depth: " + std::to_string(depth) + ", a longer queue");
  }
}

// A queue that is full waits for what began first: waits more, and nothing else.
TEST_P(KernelDeterminism, TheQueueOfTransfersChangesWaitsAlone) {
  for (const std::uint32_t depth : {1u, 2u, 16u}) {
    KernelOptions options{.queue_depth = depth};
    expect_same(options, Alike::kAllButWaits, "commands: " + std::to_string(depth));
    options.moves_late = true;
    expect_same(options, Alike::kAllButWaits, "late, commands: " + std::to_string(depth));
    options.fetch_depth = 3;
    expect_same(options, Alike::kAllButTransfers, "late, depth: 3, commands: " + std::to_string(depth));
  }
}

// Nothing is read before it was waited for.
TEST_P(KernelDeterminism, BytesThatComeLateChangeNothing) {
  const KernelOptions options{.moves_late = true};
  expect_same(options, Alike::kAll, "late");
}

// Packets and lanes change how eye rays and groups are counted; pixels and rays they do not. Packets leave lists as
// they are. Four lanes have five lists a node where wider ones have one, so lists are cut elsewhere: KernelLanes.
TEST_P(KernelDeterminism, PacketsAndLanesChangeNoPixelAndNoRay) {
  Base& scene = base(GetParam());
  const KernelOptions options{.accuracy = GetParam()};
  const std::pair<const char*, RenderKernel*> kernels[] = {{"packets of 8", render_packets_of_8},
                                                           {"packets of 16", render_packets_of_16},
                                                           {"8 lanes", render_eight_lanes},
                                                           {"16 lanes", render_sixteen_lanes}};
  for (const auto& [name, render] : kernels) {
    SCOPED_TRACE(name);
    const KernelPicture picture = render(scene.scene, scene.camera, kWidth, kHeight, options);
    ASSERT_EQ(picture.status, Status::kOk) << picture.violation;
    EXPECT_EQ(picture.color, scene.picture.color);
    EXPECT_EQ(rays_of(picture), rays_of(scene.picture)) << words_of(rays_of(picture));
    EXPECT_EQ(picture.work[Work::kLightSample], scene.picture.work[Work::kLightSample]);
    EXPECT_EQ(picture.work[Work::kColorAdded], scene.picture.work[Work::kColorAdded]);
    EXPECT_EQ(picture.work[Work::kListRay], scene.picture.work[Work::kListRay]);
    if (render == render_eight_lanes || render == render_sixteen_lanes) continue;
    for (const Work kind : {Work::kListChild, Work::kListEntry, Work::kListNode, Work::kListRun, Work::kListRayNode,
                            Work::kListBoxQuad, Work::kListLeaf, Work::kListTriangleGroup, Work::kListCandidate,
                            Work::kRayDistance}) {
      EXPECT_EQ(picture.work[kind], scene.picture.work[kind]) << static_cast<int>(kind);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Accuracies, KernelDeterminism,
                         testing::Values(Accuracy::kStandard, Accuracy::kExact, Accuracy::kCompact, Accuracy::kFast),
                         [](const auto& accuracy) {
                           switch (accuracy.param) {
                             case Accuracy::kExact: return "exact";
                             case Accuracy::kCompact: return "compact";
                             case Accuracy::kFast: return "fast";
                             default: return "standard";
                           }
                         });

// Of one scene in several grids: `compact` moves vertices by its grid, so it is not among them.
TEST(KernelGrids, ChangeNoPixelAndNoRay) {
  for (const Accuracy accuracy : {Accuracy::kStandard, Accuracy::kExact}) {
    Base& scene = base(accuracy);
    for (const auto& [lambda, macro_width] : {std::pair{0.5f, 4u}, {2.0f, 2u}, {2.0f, 6u}, {8.0f, 4u}, {8.0f, 6u}}) {
      SCOPED_TRACE(testing::Message() << "lambda " << lambda << ", macrocells of " << macro_width);
      const KernelOptions options{.accuracy = accuracy, .lambda = lambda, .macro_width = macro_width};
      const KernelPicture picture = render_scene(scene.description, kWidth, kHeight, options);
      ASSERT_EQ(picture.status, Status::kOk) << picture.violation;
      EXPECT_EQ(picture.color, scene.picture.color);
      EXPECT_EQ(rays_of(picture), rays_of(scene.picture)) << words_of(rays_of(picture));
    }
  }
}

}  // namespace
}  // namespace gridiron::test
