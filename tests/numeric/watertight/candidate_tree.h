// Candidates: the triangles of a mesh that rays may touch, none left out. The suite's own search, so that what an
// intersector misses is the intersector's fault.
// Memory: std::vector. Threads: any, once built. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/scene/mesh.h>

#include <cstdint>
#include <vector>

#include "numeric/watertight/shot.h"
#include "support/median_tree.h"

namespace gridiron::test {

/// A tree of the exact bounds of triangles.
class CandidateTree {
 public:
  /// @param mesh  finite. @param triangles  the ids of those that are searched.
  CandidateTree(const MeshView& mesh, std::vector<std::uint32_t> triangles);

  /// Finds all triangles whose bounds one of a packet's rays touches at t >= 0.
  ///
  /// The bounds are floats and differences of floats have the right sign in double, so a box is left out only where
  /// two of a ray's distances to its planes, each within 3 * 2^-53 of itself, are apart by more than 2^-48.
  void find(const watertight::Shot& rays, std::vector<std::uint32_t>& found) const;

  /// Finds all triangles whose closed bounds hold a point.
  void find(const Vec3& point, std::vector<std::uint32_t>& found) const;

  /// The triangles, ordered so that near ones are next to each other.
  [[nodiscard]] const std::vector<std::uint32_t>& order() const { return tree_.order(); }
  /// @returns the place of a triangle in it. Precondition: it is one of them.
  [[nodiscard]] std::uint32_t place(std::uint32_t triangle_id) const { return places_[triangle_id]; }

 private:
  struct Rays;

  template <class Touches, class Visit>
  void walk(std::uint32_t node, std::uint32_t mask, const Touches& touches, const Visit& visit) const;

  MedianTree tree_;
  std::vector<std::uint32_t> places_;  // by id
  std::vector<PlacedBox> boxes_;       // by id
};

}  // namespace gridiron::test
