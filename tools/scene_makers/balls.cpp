// The sphereflake. SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "scene_makers/nff_text.h"
#include "scene_makers/procedural.h"

namespace gridiron::scene_makers {
namespace {

constexpr std::size_t kChildCount = 9;
using Directions = std::array<Point, kChildCount>;

// The children of a ball that is attached at -z: at the corners of a cuboctahedron that stands on a triangle, without
// the three at the bottom. Six at the equator, three above the gaps.
Directions child_directions() {
  const double half_root = 0.5 * std::sqrt(3.0), height = std::sqrt(2.0 / 3.0), out = std::sqrt(1.0 / 3.0);
  return {{{1, 0, 0},
           {0.5, half_root, 0},
           {-0.5, half_root, 0},
           {-1, 0, 0},
           {-0.5, -half_root, 0},
           {0.5, -half_root, 0},
           {out * half_root, out * 0.5, height},
           {-out * half_root, out * 0.5, height},
           {0, -out, height}}};
}

// Turns z into `axis` the shortest way, and `vector` with it.
Point turned(const Point& vector, const Point& axis) {
  if (axis[2] < -0.999999) return {vector[0], -vector[1], -vector[2]};
  const Point spin = cross({0, 0, 1}, axis);
  const Point once = cross(spin, vector), twice = cross(spin, once);
  return vector + once + twice * (1.0 / (1.0 + axis[2]));
}

void add_ball(std::string& text, const Directions& directions, const Point& center, double radius, const Point& axis,
              std::uint32_t size) {
  add_sphere(text, center, radius);
  if (size == 0) return;
  const double child_radius = radius / 3.0;
  for (const Point& direction : directions) {
    const Point out = turned(direction, axis);
    add_ball(text, directions, center + out * (radius + child_radius), child_radius, out, size - 1);
  }
}

}  // namespace

std::string make_balls(std::uint32_t size) {
  std::string text = begin_scene("balls", size, {2.1, 1.3, 1.7}, {0, 0, 0}, {0, 0, 1}, 0.01);
  add_line(text, "l", {4, 3, 2});
  add_line(text, "l", {1, -4, 4});
  add_line(text, "l", {-3, 1, 5});
  add_line(text, "f", {1, 0.75, 0.33, 0.8, 0, 0, 0, 1});
  add_polygon(text, {{12, 12, -0.5}, {-12, 12, -0.5}, {-12, -12, -0.5}, {12, -12, -0.5}});
  add_line(text, "f", {1, 0.9, 0.7, 0.5, 0.5, 37, 0, 1});
  add_ball(text, child_directions(), {0, 0, 0}, 0.5, {0, 0, 1}, size);
  return text;
}

}  // namespace gridiron::scene_makers
