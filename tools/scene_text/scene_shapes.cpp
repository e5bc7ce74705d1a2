// Shapes of a text scene. SPDX-License-Identifier: Apache-2.0
#include "scene_text/scene_shapes.h"

#include <cfloat>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "files/interrupt.h"

namespace gridiron::tool {
namespace {

struct Bounds {
  DVec3 low{DBL_MAX}, high{-DBL_MAX};

  void add(const DVec3& point, double radius = 0) {
    low = glm::min(low, point - radius);
    high = glm::max(high, point + radius);
  }
};

// A direction at right angles to a unit vector, chosen by its smallest component.
DVec3 any_perpendicular(const DVec3& axis) {
  const DVec3 size = glm::abs(axis);
  const DVec3 other = size.x <= size.y && size.x <= size.z ? DVec3(1, 0, 0)
                      : size.y <= size.z                   ? DVec3(0, 1, 0)
                                                           : DVec3(0, 0, 1);
  return glm::normalize(glm::cross(axis, other));
}

// Points of polygons and patches between a corner and the next one.
std::size_t points_a_corner(const SceneShape& shape) {
  return shape.kind == ShapeKind::kPatch ? 2 : 1;
}

}  // namespace

double RoundShape::distance_to(const DVec3& eye) const {
  if (is_sphere) return std::fabs(glm::length(base - eye) - base_radius);
  const DVec3 axis = apex - base;
  const double along = std::clamp(glm::dot(eye - base, axis) / glm::dot(axis, axis), 0.0, 1.0);
  return std::max(0.0, glm::length(base + along * axis - eye) - radius());
}

bool is_round(const SceneShape& shape) {
  return shape.kind == ShapeKind::kSphere || shape.kind == ShapeKind::kCone;
}

RoundShape round_shape(const SceneEntities& entities, const SceneShape& shape) {
  const bool is_sphere = shape.kind == ShapeKind::kSphere;
  const double* const base = entities.numbers.data() + shape.first;
  const double* const apex = is_sphere ? base : base + 4;
  return {is_sphere, {base[0], base[1], base[2]}, {apex[0], apex[1], apex[2]}, base[3], apex[3]};
}

const Vec3& corner_of(const SceneEntities& entities, const SceneShape& shape, std::size_t i) {
  return entities.points[shape.first + i * points_a_corner(shape)];
}

Frame frame_of(const DVec3& axis) {
  const DVec3 right = any_perpendicular(axis);
  return {axis, right, glm::cross(axis, right)};
}

double diagonal_of_shapes(const SceneEntities& entities) {
  Bounds bounds;
  for (const SceneShape& shape : entities.shapes) {
    if (is_round(shape)) {
      const RoundShape round = round_shape(entities, shape);
      bounds.add(round.base, round.base_radius);
      bounds.add(round.apex, round.apex_radius);
    } else if (shape.kind == ShapeKind::kMesh) {
      for (const Vec3& vertex : entities.meshes[shape.first].vertices) bounds.add(DVec3(vertex));
    } else {
      for (std::size_t i = 0; i < shape.count; ++i) bounds.add(DVec3(corner_of(entities, shape, i)));
    }
  }
  return glm::length(bounds.high - bounds.low);
}

void visit_shapes(const SceneEntities& entities, RoundShapes& shapes, const PointVisitor& visitor) {
  constexpr std::uint32_t kFrequency = 2, kSegments = 12;
  std::vector<Vec3> points;
  std::uint64_t shape_count = 0;
  for (const SceneShape& shape : entities.shapes) {
    if (++shape_count % 4096 == 0) stop_if_interrupted();
    if (shape.kind == ShapeKind::kMesh) {
      visitor(entities.meshes[shape.first].vertices);
      continue;
    }
    points.clear();
    if (!is_round(shape)) {
      for (std::size_t i = 0; i < shape.count; ++i) points.push_back(corner_of(entities, shape, i));
    } else if (const RoundShape round = round_shape(entities, shape); round.is_sphere) {
      for (const DVec3& place : shapes.sphere(kFrequency).vertices) {
        points.emplace_back(round.base + round.base_radius * place);
      }
    } else {
      const Frame frame = frame_of(glm::normalize(round.apex - round.base));
      for (const DVec3& place : shapes.circle(kSegments)) {
        points.emplace_back(round.base + round.base_radius * frame.across(place));
        points.emplace_back(round.apex + round.apex_radius * frame.across(place));
      }
    }
    visitor(points);
  }
}

}  // namespace gridiron::tool
