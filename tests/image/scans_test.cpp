// The scans at full size, pixel by pixel against the ground truth. SPDX-License-Identifier: Apache-2.0
#include <thread>

#include "support/check_truth.h"
#include "support/ply_load.h"
#include "support/render_mesh.h"
#include "support/scenes.h"
#include "support/views.h"

namespace gridiron::test {
namespace {

constexpr std::size_t kRandomPixels = 20000;
constexpr std::size_t kBorderPixels = 20000;
constexpr std::uint64_t kSeed = 2012;

class ScansTest : public testing::TestWithParam<SceneView> {};

// Checked mode, four lanes: the chip's own configuration. Views: figures 6 to 10 of the paper.
TEST_P(ScansTest, PixelsEqualTheTruthBitForBit) {
  const SceneView& view = GetParam();
  const SharedFile file = find_scene(view.file);
  GRIDIRON_SKIP_IF_MISSING(file);
  const auto mesh = load_ply(file.path);
  ASSERT_TRUE(mesh) << file.path << " cannot be read";

  SceneInMemory scene(mesh->view(), GridParameters{});
  ASSERT_EQ(scene.status(), Status::kOk);
  FrameSettings settings{
      .camera = view.camera ? *view.camera : framed_camera(mesh->view()), .width = 1024, .height = 1024};
  sim::ChipOptions chip{.threads = std::max(1u, std::thread::hardware_concurrency())};
  const RenderedFrame rendered = scene.render(settings, chip);
  ASSERT_EQ(rendered.result.status, Status::kOk);
  EXPECT_TRUE(rendered.result.violations.empty()) << rendered.result.violations.front().detail;

  std::vector<std::size_t> pixels = random_pixels(rendered.frame, kRandomPixels, kSeed);
  const std::vector<std::size_t> borders = border_pixels(rendered, kBorderPixels, kSeed + 1);
  ASSERT_EQ(pixels.size(), kRandomPixels);
  ASSERT_EQ(borders.size(), kBorderPixels);
  pixels.insert(pixels.end(), borders.begin(), borders.end());

  const TruthReport report = check_against_truth(rendered, mesh->view(), pixels);
  std::printf(
      "%s: %zu triangles, %zu random and %zu border pixels, %zu of them hit, %zu differ; truth took %llu pairs, "
      "%llu candidates, %llu exact signs, %llu exact distances\n",
      view.name, mesh->triangles.size(), kRandomPixels, borders.size(), report.hits, report.mismatches,
      static_cast<unsigned long long>(report.work.pairs), static_cast<unsigned long long>(report.work.candidates),
      static_cast<unsigned long long>(report.work.exact_signs),
      static_cast<unsigned long long>(report.work.exact_distances));
  EXPECT_EQ(report.mismatches, 0u) << view.name << ", seed " << kSeed << ": " << report.first_mismatch;
  EXPECT_GT(report.hits, kBorderPixels / 2);

  // The `grid` configuration: another traversal, the same bits in every pixel.
  settings.techniques = kUseMailbox | kUseEmptySkip | kUseSubpackets;
  settings.macro_depth = 4;
  settings.triangle_depth = 8;
  chip.packet_width = 32;
  EXPECT_EQ(first_difference(rendered, scene.render(settings, chip)), "");
}

INSTANTIATE_TEST_SUITE_P(Views, ScansTest,
                         testing::Values(kBunnyView, kHorseView, kArmadilloView, kConferenceView, kConferenceView2),
                         [](const testing::TestParamInfo<SceneView>& tested) { return tested.param.name; });

}  // namespace
}  // namespace gridiron::test
