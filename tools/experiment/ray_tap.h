// Secondary rays of a frame as the kernel itself casts and answers them, and the same rays asked again.
// Memory: std::vector; a RayTree owns a copy of the frame's tree. Threads: any, no shared state.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>
#include <gridiron/base/records.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/scene/mesh.h>

#include <cstdint>
#include <span>
#include <vector>

#include "experiment/effect_frames.h"
#include "experiment/secondary_scenes.h"

namespace gridiron::experiment {

/// A secondary ray, and the kernel's answer.
struct TracedRay {
  Vec3 origin, dir;                ///< dir is not normalised
  float t = 0;                     ///< it looks for hits with 0 < distance / |dir| <= t
  RayKind kind{};                  ///< refracted rays alone are kRefraction; what glass reflects is kReflection
  std::uint32_t id = kNoTriangle;  ///< a triangle that it hits: any, or the nearest, as its kind wants

  bool from_light = false;  ///< it runs from a light to a surface, not away from it

  [[nodiscard]] bool has_hit() const { return id != kNoTriangle; }
};

/// Renders a frame by core's own code in plain copies, with an engine of rays that notes each ray and its answer.
/// @returns all secondary rays, tile by tile. Precondition: all lights of the scene are points, or all are areas.
/// Errors: tool::Failure.
[[nodiscard]] std::vector<TracedRay> trace_secondary_rays(PreparedEffectFrame& frame);

/// The nearest hit of a ray.
struct RayHit {
  std::uint32_t id = kNoTriangle;
  float t = 0;  ///< in units of the ray's direction
};

/// The tree of a frame, in memory that any ray can be asked in: by core's lists of rays, without a simulated store.
class RayTree {
 public:
  explicit RayTree(PreparedEffectFrame& frame);

  /// @returns the nearest hit of each ray, as an accuracy decides it on the triangles that the frame stores.
  /// @param work  counts what that takes.
  [[nodiscard]] std::vector<RayHit> nearest(std::span<const TracedRay> rays, Accuracy accuracy,
                                            WorkCounters& work) const;
  [[nodiscard]] std::vector<RayHit> nearest(std::span<const TracedRay> rays, Accuracy accuracy) const {
    WorkCounters ignored;
    return nearest(rays, accuracy, ignored);
  }

  /// @returns a ray for each one that hits a triangle: from the surface that it leaves, or comes to from a light, to an
  /// edge of that triangle or, a quarter of them, to a vertex. It passes that point within the roundings of its
  /// direction and looks as far as there is anything. @param hits  of the rays.
  [[nodiscard]] std::vector<TracedRay> aimed_at_edges(std::span<const TracedRay> rays,
                                                      std::span<const RayHit> hits) const;

  [[nodiscard]] float diagonal() const { return diagonal_; }               ///< of the box around all triangles
  [[nodiscard]] MeshView mesh() const { return {vertices_, triangles_}; }  ///< as the frame stores it

 private:
  std::vector<Vec3> vertices_;
  std::vector<UVec3> triangles_;
  std::vector<TreeNode> nodes_;
  std::vector<VertexTriangle> records_;  ///< in the order of the leaves
  float largest_ = 0, diagonal_ = 0;
};

}  // namespace gridiron::experiment
