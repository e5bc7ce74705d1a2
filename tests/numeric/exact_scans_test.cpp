// `exact` on the scans: every pixel of five views shows the oracle's triangle. SPDX-License-Identifier: Apache-2.0
#include <thread>

#include "numeric/oracle.h"
#include "support/brute_force.h"
#include "support/ply_load.h"
#include "support/render_mesh.h"
#include "support/scenes.h"
#include "support/views.h"

namespace gridiron::test {
namespace {

constexpr std::uint32_t kWidth = 1024;

class ExactScans : public testing::TestWithParam<SceneView> {};

// Packets of 32 without depth: distances are estimated first, ties broken last. The id plane is the oracle's nearest
// triangle by exact distance, the least id of those exactly as near.
TEST_P(ExactScans, EveryPixelShowsTheOraclesTriangle) {
  const SceneView& view = GetParam();
  const SharedFile file = find_scene(view.file);
  GRIDIRON_SKIP_IF_MISSING(file);
  const auto mesh = load_ply(file.path);
  ASSERT_TRUE(mesh) << file.path << " cannot be read";
  const unsigned threads = std::max(1u, std::thread::hardware_concurrency());

  SceneInMemory scene(mesh->view(), GridParameters{});
  ASSERT_EQ(scene.status(), Status::kOk);
  const FrameSettings settings{.camera = view.camera ? *view.camera : framed_camera(mesh->view()),
                               .width = kWidth,
                               .height = kWidth,
                               .accuracy = Accuracy::kExact,
                               .shading = Shading::kNone,
                               .techniques = kUseMailbox | kUseEmptySkip | kUseSubpackets,
                               .macro_depth = 4,
                               .triangle_depth = 3};
  const sim::ChipOptions chip{.threads = threads, .packet_width = 32};
  const RenderedFrame rendered = scene.render(settings, chip, PlaneSet::kColorAndIds);
  ASSERT_EQ(rendered.result.status, Status::kOk);

  const Oracle oracle(mesh->view());
  std::vector<OracleRay> rays(kWidth);
  std::uint64_t hits = 0, ties = 0, float_ties = 0, others = 0;
  std::string first_other;
  for (std::uint32_t y = 0; y < kWidth; ++y) {
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      const Vec3 direction = pixel_direction(rendered.frame, x, y);
      const float* const eye = rendered.frame.eye;
      rays[x] = {{eye[0], eye[1], eye[2]}, {direction.x, direction.y, direction.z}};
    }
    const std::vector<NearestHit> nearest = oracle.nearest(rays, threads);
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      const NearestHit& hit = nearest[x];
      const std::uint32_t wanted = hit.ties.empty() ? kNoTriangle : hit.ties.front();
      hits += hit.ties.empty() ? 0u : 1u;
      ties += hit.ties.size() > 1 ? 1u : 0u;
      float_ties += hit.float_ties.size() > hit.ties.size() ? 1u : 0u;
      const std::uint32_t shown = rendered.planes.ids[rendered.pixel_index(x, y)];
      if (shown == wanted) continue;
      if (others++ == 0) {
        first_other = "pixel " + std::to_string(x) + ", " + std::to_string(y) + " shows " + std::to_string(shown) +
                      ", not " + std::to_string(wanted);
      }
    }
  }
  std::printf("%s: %llu of %u pixels hit; %llu met several triangles at one distance, %llu others at one float\n",
              view.name, static_cast<unsigned long long>(hits), kWidth * kWidth, static_cast<unsigned long long>(ties),
              static_cast<unsigned long long>(float_ties));
  EXPECT_EQ(others, 0u) << first_other;
  EXPECT_GT(hits, kWidth * kWidth / 8u);
}

INSTANTIATE_TEST_SUITE_P(Views, ExactScans,
                         testing::Values(kBunnyView, kHorseView, kArmadilloView, kConferenceView, kConferenceView2),
                         [](const testing::TestParamInfo<SceneView>& tested) { return tested.param.name; });

}  // namespace
}  // namespace gridiron::test
