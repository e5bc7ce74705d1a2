// A tube along the (2, 3) torus knot: a closed mesh of any even size, for runs that scale.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <numbers>

#include "scene_makers/shapes.h"

namespace gridiron::scene_makers {
namespace {

constexpr double kTorusRadius = 2;
constexpr double kKnotRadius = 1;
constexpr double kTubeRadius = 0.45;
constexpr double kTurnsAround = 2;
constexpr double kTurnsThrough = 3;

Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Point of the tube; `along` and `around` are angles.
Point tube_point(double along, double around) {
  const double around_torus = kTurnsAround * along, through = kTurnsThrough * along;
  const double cos_a = std::cos(around_torus), sin_a = std::sin(around_torus);
  const double cos_t = std::cos(through), sin_t = std::sin(through);
  const double ring = kTorusRadius + kKnotRadius * cos_t;
  const Point centre = {ring * cos_a, ring * sin_a, kKnotRadius * sin_t};
  // The curve lies on a torus, so the torus's normal is perpendicular to it everywhere: a frame that closes.
  const Point normal = {cos_t * cos_a, cos_t * sin_a, sin_t};
  const double ring_rate = -kKnotRadius * kTurnsThrough * sin_t;
  const Point tangent = {ring_rate * cos_a - ring * kTurnsAround * sin_a,
                         ring_rate * sin_a + ring * kTurnsAround * cos_a, kKnotRadius * kTurnsThrough * cos_t};
  const double length = std::sqrt((tangent[0] * tangent[0] + tangent[1] * tangent[1]) + tangent[2] * tangent[2]);
  const Point side = cross(tangent, normal);
  Point point{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    point[axis] =
        centre[axis] + kTubeRadius * (std::cos(around) * normal[axis] + std::sin(around) * side[axis] / length);
  }
  return point;
}

}  // namespace

Mesh make_torus_knot(std::uint32_t triangle_count) {
  // The curve is about ten times as long as the tube's circumference, so quads are about square.
  const std::uint32_t around_count =
      static_cast<std::uint32_t>(std::sqrt(static_cast<double>(triangle_count) / 20.0)) + 1;
  const std::uint32_t quad_count = triangle_count / 2;
  const std::uint32_t along_count = quad_count / around_count;
  // Quads that do not fill a whole ring become four triangles around a new middle vertex instead of two.
  const std::uint32_t split_count = quad_count - along_count * around_count;

  Mesh mesh;
  mesh.vertices.reserve(along_count * around_count + split_count);
  mesh.triangles.reserve(triangle_count);
  const auto along_angle = [&](double i) { return 2 * std::numbers::pi * i / along_count; };
  const auto around_angle = [&](double j) { return 2 * std::numbers::pi * j / around_count; };
  for (std::uint32_t i = 0; i < along_count; ++i) {
    for (std::uint32_t j = 0; j < around_count; ++j) mesh.add_vertex(tube_point(along_angle(i), around_angle(j)));
  }
  for (std::uint32_t i = 0; i < along_count; ++i) {
    for (std::uint32_t j = 0; j < around_count; ++j) {
      const std::uint32_t next_i = (i + 1) % along_count, next_j = (j + 1) % around_count;
      const std::uint32_t a = i * around_count + j, b = i * around_count + next_j;
      const std::uint32_t c = next_i * around_count + next_j, d = next_i * around_count + j;
      if (i * around_count + j < split_count) {
        const std::uint32_t middle = mesh.add_vertex(tube_point(along_angle(i + 0.5), around_angle(j + 0.5)));
        mesh.triangles.push_back({a, b, middle});
        mesh.triangles.push_back({b, c, middle});
        mesh.triangles.push_back({c, d, middle});
        mesh.triangles.push_back({d, a, middle});
      } else {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      }
    }
  }
  return mesh;
}

}  // namespace gridiron::scene_makers
