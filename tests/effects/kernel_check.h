// Common questions of the tests of the kernel's effects: scenes by name, rays by kind, and the reference's picture.
// Memory: std::vector. Threads: the reference starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "effects/kernel_scene.h"
#include "effects/reference/reference_renderer.h"
#include "scene_text/scene_description.h"

namespace gridiron::test {

/// @param name  of scenes/, without .nff. @param tolerance  of round shapes, in diagonals of the scene; ten times what
///              readers use, as the reference is slow. Errors: tool::Failure.
[[nodiscard]] tool::SceneDescription shipped_scene(std::string_view name, float tolerance = 1e-3f);

/// The names of all text scenes in scenes/, in the order of their effects, `everything` last.
inline constexpr std::string_view kShippedScenes[] = {
    "shadow",       "area_light", "mirror",        "glass",    "ambient_occlusion",
    "environment", "smooth_normals", "highlight", "multisampling", "everything"};

/// The kernel's counters of rays, as the reference counts them.
[[nodiscard]] ReferenceCounts rays_of(const KernelPicture& picture);
[[nodiscard]] std::string words_of(const ReferenceCounts& counts);

/// @returns the largest difference of a kind of rays, as a share of the second's rays of that kind.
[[nodiscard]] double largest_share(const ReferenceCounts& a, const ReferenceCounts& b);

/// @returns the kinds of work in which two frames differ, "" where in none. @param except  kinds left aside.
[[nodiscard]] std::string different_work(const WorkCounters& a, const WorkCounters& b,
                                         std::initializer_list<WorkId> except = {});
/// The same but for transfers: frames that ask for another number of nodes and leaves ahead may fetch some again that
/// were displaced, and make their triangles of the lattice again.
[[nodiscard]] inline std::string different_but_in_transfers(const WorkCounters& a, const WorkCounters& b) {
  return different_work(a, b, {Work::kGetIssue, Work::kWait, Work::kLatticeTriangle});
}

/// @returns the brightest channel of a pixel. @param color  0xAABBGGRR.
[[nodiscard]] constexpr std::uint32_t brightest(std::uint32_t color) {
  const std::uint32_t red = color & 255u, green = color >> 8 & 255u, blue = color >> 16 & 255u;
  const std::uint32_t most = red > green ? red : green;
  return most > blue ? most : blue;
}

/// The kernel with all effects and its view's camera.
[[nodiscard]] KernelPicture render_scene(const tool::SceneDescription& scene, std::uint32_t width,
                                         std::uint32_t height, const KernelOptions& options = {});

/// How far a picture may be from the reference's.
/// What texts can call for: they bring no colours at vertices.
inline constexpr std::uint32_t kTextEffects = kAllEffects & ~kVertexColors;

struct PictureTolerance {
  std::size_t off_by_more_than_1 = 0;  ///< pixels
  double ray_share = 0.0;              ///< of any kind of rays
  double rmse = 0.1;                   ///< steps, over all pixels but those that are off by more than 1
};

/// Renders a scene by kernel and reference and expects them to agree, by steps and as OpenImageIO compares them.
void expect_reference(const tool::SceneDescription& scene, std::uint32_t width, std::uint32_t height,
                      const PictureTolerance& tolerance, const KernelOptions& options = {});

}  // namespace gridiron::test
