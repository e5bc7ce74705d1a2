// Reference renderer of scenes with effects: what core/EFFECTS.md says, once more, as plainly as can be. Doubles, std::
// functions, recursion; no packet, no grid, no filter. It reads the document and the description of the scene only.
// Source: core/EFFECTS.md. Memory: std::vector. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "effects/reference/reference_geometry.h"
#include "scene_text/scene_description.h"

namespace gridiron::test {

/// Rays by kind. Shadow and occlusion rays are those that the document asks for: where the surface is turned away from
/// light or direction none is made.
struct ReferenceCounts {
  std::uint64_t primary = 0, shadow = 0, occlusion = 0, reflected = 0, refracted = 0;
  std::uint64_t environment = 0;  ///< rays that end in the environment

  friend bool operator==(const ReferenceCounts&, const ReferenceCounts&) = default;
};
/// Each of them by name.
inline constexpr std::pair<const char*, std::uint64_t ReferenceCounts::*> kReferenceCounts[] = {
    {"primary", &ReferenceCounts::primary},     {"shadow", &ReferenceCounts::shadow},
    {"occlusion", &ReferenceCounts::occlusion}, {"reflected", &ReferenceCounts::reflected},
    {"refracted", &ReferenceCounts::refracted}, {"environment", &ReferenceCounts::environment}};

/// A part of the picture, in pixels.
struct ReferenceRegion {
  std::uint32_t left = 0, top = 0, width = 0, height = 0;
};

struct ReferenceOptions {
  std::optional<ReferenceRegion> region;  ///< inside the picture; without it all of it
  ReferenceSearch search = ReferenceSearch::kBoxTree;
  std::uint32_t threads = 2;  ///< 1 or more; rows are theirs in turn
};

/// What a region shows, row-major, row 0 on top.
struct ReferencePicture {
  ReferenceRegion region;
  std::vector<glm::dvec3> linear;     ///< mean of the samples, not clamped
  std::vector<std::uint32_t> color;   ///< 0xAABBGGRR, clamped and rounded as the document says; alpha 255
  std::vector<std::uint32_t> ids;     ///< of sample 0; kReferenceNoTriangle where nothing
  std::vector<double> depth;          ///< of sample 0, along the unit direction; infinity where nothing
  ReferenceCounts counts;

  /// @param x, y  of the whole picture, inside the region.
  [[nodiscard]] std::size_t index(std::uint32_t x, std::uint32_t y) const {
    return std::size_t{y - region.top} * region.width + (x - region.left);
  }
};

/// The camera of a frame in floats, as the frame's record holds them.
struct ReferenceCamera {
  glm::vec3 eye, corner, step_x, step_y;

  /// (corner + x step_x) + y step_y, every operation rounded to float.
  [[nodiscard]] glm::vec3 direction(float x, float y) const;
};

/// SceneView::hither is left aside: the document knows no near plane.
[[nodiscard]] ReferenceCamera reference_camera(const tool::SceneView& view, std::uint32_t width, std::uint32_t height);

/// @returns where sample s of N (1, 4, 16) looks, in pixels from the pixel's centre.
[[nodiscard]] glm::vec2 reference_sample_offset(std::uint32_t s, std::uint32_t count);

/// The two numbers in [0, 1) of a pixel, sample, path and purpose.
struct ReferenceJitter {
  double j1, j2;
};
[[nodiscard]] ReferenceJitter reference_jitter(std::uint32_t path, std::uint32_t sample, std::uint32_t pixel,
                                               std::uint32_t purpose);

/// Renders the scene at width x height pixels, whatever size its view asks for. Any number of triangles, but all of
/// this is slow: some 10^5 rays a second and thread.
///
/// Secondary rays start at the hit itself, in double. They pass over the triangle they leave, and over whatever lies
/// within 1e-9 of the sizes that the hit was worked out from: its coplanar neighbours and doubles, which are off by
/// some 1e-16 of that. Floats resolve 6e-8, so that no feature of a scene is as small.
[[nodiscard]] ReferencePicture render_reference(const tool::SceneDescription& scene, std::uint32_t width,
                                                std::uint32_t height, const ReferenceOptions& options = {});

}  // namespace gridiron::test
