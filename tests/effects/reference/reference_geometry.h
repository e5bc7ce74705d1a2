// Triangles of a scene and the rays that meet them, in double: the ground of the reference renderer.
// Source: own; edge volumes as in Woop, Benthin, Wald 2013, so that neighbours leave no gap. Nothing of core's code.
// Memory: std::vector. Threads: any may ask. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "scene_text/scene_description.h"
#include "support/median_tree.h"
#include "support/test_headers.h"

namespace gridiron::test {

/// Stands for "no triangle" in planes of ids and where a ray starts from none.
inline constexpr std::uint32_t kReferenceNoTriangle = 0xFFFFFFFFu;

/// A ray in world space; hits count if least_t < t <= most_t, in units of `dir`.
struct ReferenceRay {
  glm::dvec3 origin{0.0}, dir{0.0};
  double least_t = 0.0;
  double most_t = std::numeric_limits<double>::infinity();
  std::uint32_t skipped = kReferenceNoTriangle;  ///< the triangle that it starts from
};

struct ReferenceHit {
  std::uint32_t id = kReferenceNoTriangle;
  double t = 0.0;
  double weights[3] = {};  ///< of the corners; not negative, their sum is 1
};

/// How rays look for triangles: both answer alike.
enum class ReferenceSearch : std::uint8_t { kEveryTriangle, kBoxTree };

/// The triangles that have an area.
class ReferenceGeometry {
 public:
  explicit ReferenceGeometry(const tool::SceneGeometry& geometry);

  /// @returns the nearest hit. Of distances that are the same float, the triangle of the lower id, as every kernel has
  ///          it: else triangles in one plane would change with each rounding.
  [[nodiscard]] std::optional<ReferenceHit> nearest(const ReferenceRay& ray, ReferenceSearch search) const;

  /// @returns whether there is a hit.
  [[nodiscard]] bool is_any(const ReferenceRay& ray, ReferenceSearch search) const;

  [[nodiscard]] const glm::dvec3& corner(std::uint32_t id, int k) const { return triangles_[index_of_[id]].v[k]; }
  /// Unit, by the winding.
  [[nodiscard]] const glm::dvec3& normal(std::uint32_t id) const { return triangles_[index_of_[id]].normal; }

 private:
  struct Triangle {
    glm::dvec3 v[3], normal;
    std::uint32_t id;
  };
  [[nodiscard]] std::optional<ReferenceHit> hit(const Triangle& triangle, const ReferenceRay& ray) const;
  // Gives each triangle near the ray to `take`, which returns whether to go on and may bring most_t nearer.
  template <class Take>
  bool visit(std::uint32_t node, ReferenceRay& ray, const Take& take) const;

  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> index_of_;  // of an id; none for triangles without area
  MedianTree tree_;
};

}  // namespace gridiron::test
