// Shapes of a text scene before they are triangles: their sizes, points and places.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "base/points.h"
#include "scene_text/round_shapes.h"
#include "scene_text/scene_entities.h"

namespace gridiron::tool {

/// A sphere or a cone. Base and apex of a sphere are the same ball.
struct RoundShape {
  bool is_sphere;
  DVec3 base, apex;
  double base_radius, apex_radius;

  [[nodiscard]] double radius() const { return std::max(base_radius, apex_radius); }
  /// @returns the distance from the eye to a ball around the axis of the shape, which contains it.
  [[nodiscard]] double distance_to(const DVec3& eye) const;
};

[[nodiscard]] bool is_round(const SceneShape& shape);

/// Precondition: is_round(shape).
[[nodiscard]] RoundShape round_shape(const SceneEntities& entities, const SceneShape& shape);

/// @returns a corner of a polygon or patch. @param i  [0, shape.count).
[[nodiscard]] const Vec3& corner_of(const SceneEntities& entities, const SceneShape& shape, std::size_t i);

/// Orthonormal.
struct Frame {
  DVec3 axis, right, up;
  [[nodiscard]] DVec3 across(const DVec3& place) const { return right * place.x + up * place.y; }
};

/// @param axis  of length 1.
[[nodiscard]] Frame frame_of(const DVec3& axis);

/// @returns the diagonal of the box around all shapes.
[[nodiscard]] double diagonal_of_shapes(const SceneEntities& entities);

/// Visits points around all shapes, at most a twentieth of a radius inside of round ones. Interrupts as
/// stop_if_interrupted().
void visit_shapes(const SceneEntities& entities, RoundShapes& shapes, const PointVisitor& visitor);

}  // namespace gridiron::tool
