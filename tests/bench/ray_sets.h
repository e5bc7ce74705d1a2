// Secondary rays of a picture, for the benchmark of rays: at the hit points of its eye rays, in the order of blocks of
// 4x4 pixels inside tiles of 64x64.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/frame/frame_setup.h>

#include <vector>

#include "embree_peer/embree_rays.h"

namespace gridiron::bench {

/// Where an eye ray hits.
struct HitPoint {
  Vec3 point;           ///< lifted along the normal by 1e-4 of the scene's diagonal, or of the way from the eye where
                        ///< that is shorter
  Vec3 normal;          ///< geometric, unit length, towards the eye
  Vec3 dir;             ///< of the eye ray, unit length
  std::uint32_t block;  ///< number of its 4x4 pixels
};

/// The kinds of secondary rays.
enum class RayKind : std::uint8_t {
  kOcclusion,      ///< kOcclusionRays cosine-distributed rays a hit, unlimited
  kNearOcclusion,  ///< the same, as long as 0.1 of the scene's diagonal
  kMirror,         ///< reflected at the geometric normal
  kShadow,         ///< towards a point light, from hits that face it
};
inline constexpr RayKind kRayKinds[] = {RayKind::kOcclusion, RayKind::kNearOcclusion, RayKind::kMirror,
                                        RayKind::kShadow};
inline constexpr std::uint32_t kOcclusionRays = 16;

[[nodiscard]] const char* name_of(RayKind kind);
/// @returns whether the question is if there is a hit, not which is the nearest.
[[nodiscard]] bool wants_any_hit(RayKind kind);
/// Whether rays that follow each other run alike, which their maker knows.
[[nodiscard]] bool are_neighbors(RayKind kind);

/// @returns the hit points of a picture of 1024x1024 eye rays.
[[nodiscard]] std::vector<HitPoint> find_hit_points(const MeshView& mesh, const Camera& camera, double diagonal,
                                                    const peer::EmbreeRays& scene);

/// @param batch_rays   consecutive rays that are taken together; a batch that is not full is left out.
/// @param most_batches if there are more, every k-th is taken.
[[nodiscard]] std::vector<peer::PeerRay> make_rays(RayKind kind, const std::vector<HitPoint>& points, double diagonal,
                                                   const Vec3& light, std::uint32_t batch_rays,
                                                   std::size_t most_batches);

}  // namespace gridiron::bench
