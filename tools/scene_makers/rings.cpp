// The pyramid of linked rings. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "scene_makers/nff_text.h"
#include "scene_makers/procedural.h"

namespace gridiron::scene_makers {
namespace {

constexpr std::size_t kRingCount = 6, kRingCorners = 5;
using Ring = std::array<Point, kRingCorners>;
using Rings = std::array<Ring, kRingCount>;

constexpr double kSpacing = 2.6;  // between neighbours of a layer, and between layers; an object is 2.2 wide
constexpr double kTube = 0.1;     // radius of cylinders and of the spheres that join them

// Midpoints of the edges of a dodecahedron, at distance 1: (+-1, 0, 0), (+-1/2, +-g/2, +-1/2g) and their cyclic shifts,
// g the golden ratio.
std::vector<Point> edge_midpoints(double golden) {
  std::vector<Point> points;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto shifted = [axis](double x, double y, double z) {
      Point point{};
      point[axis] = x;
      point[(axis + 1) % 3] = y;
      point[(axis + 2) % 3] = z;
      return point;
    };
    for (const double x : {1.0, -1.0}) {
      points.push_back(shifted(x, 0, 0));
      for (const double y : {1.0, -1.0}) {
        for (const double z : {1.0, -1.0}) points.push_back(shifted(0.5 * x, 0.5 * golden * y, 0.5 / golden * z));
      }
    }
  }
  return points;
}

// The ten midpoints on the great circle across a five-fold axis, in order around it: always the nearest remaining one.
std::vector<Point> circle_across(const std::vector<Point>& points, const Point& axis) {
  std::vector<Point> left, ordered;
  for (const Point& point : points) {
    if (std::fabs(dot(point, axis)) < 1e-9) left.push_back(point);
  }
  ordered.push_back(left.front());
  left.erase(left.begin());
  while (!left.empty()) {
    const auto next = std::max_element(left.begin(), left.end(), [&](const Point& a, const Point& b) {
      return dot(a, ordered.back()) < dot(b, ordered.back()) - 1e-9;
    });
    ordered.push_back(*next);
    left.erase(next);
  }
  return ordered;
}

// Six pentagons of every other point of six great circles that together use each midpoint once.
Rings make_object() {
  const double golden = 0.5 * (1.0 + std::sqrt(5.0));
  const std::vector<Point> points = edge_midpoints(golden);
  const std::array<Point, kRingCount> axes = {
      {{0, golden, 1}, {0, golden, -1}, {1, 0, golden}, {-1, 0, golden}, {golden, 1, 0}, {golden, -1, 0}}};
  Rings rings{};
  for (std::uint32_t choice = 0; choice < 64; ++choice) {
    std::vector<Point> used;
    for (std::size_t i = 0; i < kRingCount; ++i) {
      const std::vector<Point> circle = circle_across(points, axes[i]);
      for (std::size_t corner = 0; corner < kRingCorners; ++corner) {
        rings[i][corner] = circle[2 * corner + (choice >> i & 1u)];
        used.push_back(rings[i][corner]);
      }
    }
    std::sort(used.begin(), used.end());
    if (std::adjacent_find(used.begin(), used.end()) == used.end()) break;
  }
  return rings;
}

void add_object(std::string& text, const Rings& rings, const Point& center) {
  constexpr std::array<Point, kRingCount> kColors = {
      {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}}};
  for (std::size_t i = 0; i < kRingCount; ++i) {
    add_line(text, "f", {kColors[i][0], kColors[i][1], kColors[i][2], 0.5, 0.5, 10, 0, 1});
    for (std::size_t corner = 0; corner < kRingCorners; ++corner) {
      const Point here = center + rings[i][corner];
      add_sphere(text, here, kTube);
      add_cylinder(text, here, center + rings[i][(corner + 1) % kRingCorners], kTube);
    }
  }
}

}  // namespace

std::string make_rings(std::uint32_t size) {
  const double eye_y = -4.5, wall_y = kSpacing * size;
  const Point from = {-1, eye_y, 0.5};
  std::string text = begin_scene("rings", size, from, from + Point{0, 1, 0}, {0, 0, 1}, 1);
  add_line(text, "l", {3, eye_y, 3});
  add_line(text, "l", {-4, eye_y, 1});
  add_line(text, "l", {2, eye_y, -4});

  // The wall fills the view: it reaches half its distance to all sides, and half of 45 degrees has the tangent 0.414.
  add_line(text, "f", {1, 1, 1, 1, 0, 0, 0, 0});
  const double reach = 0.5 * (wall_y - eye_y);
  add_polygon(text, {{from[0] - reach, wall_y, from[2] - reach},
                     {from[0] + reach, wall_y, from[2] - reach},
                     {from[0] + reach, wall_y, from[2] + reach},
                     {from[0] - reach, wall_y, from[2] + reach}});

  const Rings rings = make_object();
  for (std::uint32_t layer = 0; layer < size; ++layer) {
    const double first = -0.5 * kSpacing * layer;
    for (std::uint32_t row = 0; row <= layer; ++row) {
      for (std::uint32_t column = 0; column <= layer; ++column) {
        add_object(text, rings, {first + kSpacing * column, kSpacing * layer, first + kSpacing * row});
      }
    }
  }
  return text;
}

}  // namespace gridiron::scene_makers
