// NFF as text. SPDX-License-Identifier: Apache-2.0
#include "scene_makers/nff_text.h"

#include <charconv>

namespace gridiron::scene_makers {

void add_line(std::string& text, const char* word, std::initializer_list<double> numbers) {
  text += word;
  for (const double number : numbers) {
    char digits[32];
    const float rounded = static_cast<float>(number) + 0.0f;  // no -0
    const auto [end, error] = std::to_chars(digits, digits + sizeof digits, rounded);
    static_cast<void>(error);  // the longest float has 15 characters
    if (!text.empty() && text.back() != '\n') text += ' ';
    text.append(digits, end);
  }
  text += '\n';
}

std::string begin_scene(const std::string& name, std::uint32_t size, const Point& from, const Point& at,
                        const Point& up, double hither) {
  std::string text = "# " + name + ", size " + std::to_string(size) + ": made by make_scene\nv\n";
  add_line(text, "from", {from[0], from[1], from[2]});
  add_line(text, "at", {at[0], at[1], at[2]});
  add_line(text, "up", {up[0], up[1], up[2]});
  add_line(text, "angle", {45});
  add_line(text, "hither", {hither});
  add_line(text, "resolution", {512, 512});
  add_line(text, "b", {0.078, 0.361, 0.753});
  return text;
}

void add_sphere(std::string& text, const Point& center, double radius) {
  add_line(text, "s", {center[0], center[1], center[2], radius});
}

void add_polygon(std::string& text, std::initializer_list<Point> corners) {
  add_line(text, "p", {static_cast<double>(corners.size())});
  for (const Point& corner : corners) add_line(text, "", {corner[0], corner[1], corner[2]});
}

void add_cylinder(std::string& text, const Point& base, const Point& apex, double radius) {
  text += "c\n";
  add_line(text, "", {base[0], base[1], base[2], radius});
  add_line(text, "", {apex[0], apex[1], apex[2], radius});
}

}  // namespace gridiron::scene_makers
