// Checks of the kernel: see the header. SPDX-License-Identifier: Apache-2.0
#include "effects/kernel_check.h"

#include "effects/compare_pictures.h"
#include "effects/kernel_variants.h"
#include "scene_text/scene_reader.h"

namespace gridiron::test {

tool::SceneDescription shipped_scene(std::string_view name, float tolerance) {
  tool::SceneOptions options;
  options.relative_tolerance = tolerance;
  return tool::read_scene_text(std::filesystem::path(GRIDIRON_SOURCE_DIR) / "scenes" / (std::string(name) + ".nff"),
                               options);
}

ReferenceCounts rays_of(const KernelPicture& picture) {
  const WorkCounters& work = picture.work;
  return {.primary = std::uint64_t{work[Work::kWaveRay]} - work[Work::kQueuedRay],
          .shadow = work[Work::kShadowRay],
          .occlusion = work[Work::kOcclusionRay],
          .reflected = work[Work::kMirrorRay],
          .refracted = work[Work::kRefractedRay],
          .environment = work[Work::kEnvironmentLookup]};
}

std::string words_of(const ReferenceCounts& counts) {
  std::string words;
  for (const auto& [name, count] : kReferenceCounts) {
    words += (words.empty() ? "" : ", ") + std::string(name) + ' ' + std::to_string(counts.*count);
  }
  return words;
}

double largest_share(const ReferenceCounts& a, const ReferenceCounts& b) {
  const auto share = [](std::uint64_t one, std::uint64_t other) {
    if (one == other) return 0.0;
    if (other == 0) return std::numeric_limits<double>::infinity();
    return std::abs(static_cast<double>(one) - static_cast<double>(other)) / static_cast<double>(other);
  };
  double largest = 0.0;
  for (const auto& [name, count] : kReferenceCounts) largest = std::max(largest, share(a.*count, b.*count));
  return largest;
}

std::string different_work(const WorkCounters& a, const WorkCounters& b, std::initializer_list<WorkId> except) {
  std::string words;
  for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) {
    if (a.counts[kind] == b.counts[kind]) continue;
    if (std::find(except.begin(), except.end(), WorkId(kind)) != except.end()) continue;
    words += "kind " + std::to_string(kind) + ": " + std::to_string(a.counts[kind]) + " and " +
             std::to_string(b.counts[kind]) + "; ";
  }
  return words;
}

KernelPicture render_scene(const tool::SceneDescription& scene, std::uint32_t width, std::uint32_t height,
                           const KernelOptions& options) {
  KernelScene built = build_kernel_scene(scene, options);
  return render_all_effects(built, camera_of(scene.view), width, height, options);
}

void expect_reference(const tool::SceneDescription& scene, std::uint32_t width, std::uint32_t height,
                      const PictureTolerance& tolerance, const KernelOptions& options) {
  const KernelPicture picture = render_scene(scene, width, height, options);
  ASSERT_EQ(picture.status, Status::kOk) << picture.violation;
  ASSERT_EQ(picture.violation, "");
  const ReferencePicture reference = render_reference(scene, width, height);
  const auto steps = compare_steps(picture.color, reference.color);
  ASSERT_TRUE(steps.has_value());
  const ReferenceCounts rays = rays_of(picture);
  const double share = largest_share(rays, reference.counts);
  // What is off by more than a step sits beside a discontinuity and may be off by anything; the others tell rounding.
  double squares = 0.0;
  for (std::size_t i = 0; i < picture.color.size(); ++i) {
    double pixel = 0.0;
    bool is_near = true;
    for (int shift = 0; shift < 24; shift += 8) {
      const double off = std::abs(static_cast<double>(picture.color[i] >> shift & 255u) -
                                  static_cast<double>(reference.color[i] >> shift & 255u));
      is_near = is_near && off <= 1.0;
      pixel += off * off;
    }
    if (is_near) squares += pixel;
  }
  const double rmse = std::sqrt(squares / (3.0 * static_cast<double>(picture.color.size())));
  EXPECT_LE(steps->off_by_more_than_1, tolerance.off_by_more_than_1)
      << "of " << steps->pixels << ", by up to " << steps->largest << " at pixel " << steps->worst_pixel;
  EXPECT_LE(rmse, tolerance.rmse);
  EXPECT_LE(share, tolerance.ray_share)
      << "kernel: " << words_of(rays) << "\nreference: " << words_of(reference.counts);
  const auto images = compare_images(picture.color, reference.color, width, height);
  ASSERT_TRUE(images.has_value());
  EXPECT_LE(images->warned, tolerance.off_by_more_than_1);
  EXPECT_LE(images->failed, tolerance.off_by_more_than_1);
  EXPECT_LE(images->mean_error, 1.0 / 255.0);
  if (std::getenv("GRIDIRON_TELL_PICTURES") != nullptr) {
    std::printf("%ux%u: %zu pixels off by more than 1 (%zu by more than 8), rmse of the others %.4f, rays off %.2g\n",
                width, height, steps->off_by_more_than_1, steps->off_by_more_than_8, rmse, share);
  }
}

}  // namespace gridiron::test
