// NFF as text: the lines that the makers of procedural scenes write.
// Memory: std::string. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>

#include "scene_makers/mesh.h"

namespace gridiron::scene_makers {

/// Adds "word number number ...\n"; numbers are rounded to float and written as the shortest exact decimals.
void add_line(std::string& text, const char* word, std::initializer_list<double> numbers);

/// @returns the beginning that all these scenes have: a comment, a view with the angle 45 and 512x512 pixels, and the
/// background.
[[nodiscard]] std::string begin_scene(const std::string& name, std::uint32_t size, const Point& from, const Point& at,
                                      const Point& up, double hither);

/// Adds a sphere, a polygon, a cone.
void add_sphere(std::string& text, const Point& center, double radius);
void add_polygon(std::string& text, std::initializer_list<Point> corners);
void add_cylinder(std::string& text, const Point& base, const Point& apex, double radius);

[[nodiscard]] inline Point operator+(const Point& a, const Point& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
[[nodiscard]] inline Point operator*(const Point& a, double scale) {
  return {a[0] * scale, a[1] * scale, a[2] * scale};
}
[[nodiscard]] inline double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] inline Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace gridiron::scene_makers
