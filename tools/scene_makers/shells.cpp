// Sea shells of balls along spirals. SPDX-License-Identifier: Apache-2.0
#include "scene_makers/nff_text.h"
#include "scene_makers/procedural.h"

namespace gridiron::scene_makers {
namespace {

constexpr std::uint32_t kTurn = 36;  // balls a turn

// A spiral that grows from ball to ball; each is turned by about a tenth of a right angle and raised by its radius.
void add_shell(std::string& text, const Point& tip, double radius, std::uint32_t balls) {
  // A turn of 10 degrees by the four operations: (1 - h^2, 2 h) / (1 + h^2), h close to the tangent of 5 degrees.
  constexpr double kHalf = 0.0874886635;
  constexpr double kCosine = (1 - kHalf * kHalf) / (1 + kHalf * kHalf), kSine = 2 * kHalf / (1 + kHalf * kHalf);
  constexpr double kGrowth = 0.985;  // radius of each ball over that of the next outer one
  double x = 1, y = 0, scale = 1;
  for (std::uint32_t i = 0; i < balls; ++i) {
    add_sphere(text, {tip[0] + radius * scale * x, tip[1] + radius * scale * y, tip[2] + 1.6 * radius * (1 - scale)},
               0.45 * radius * scale);
    const double turned = x * kCosine - y * kSine;
    y = x * kSine + y * kCosine;
    x = turned;
    scale *= kGrowth;
  }
}

}  // namespace

std::string make_shells(std::uint32_t size) {
  std::string text = begin_scene("shells", size, {0, -3.2 * size, 3.0 * size}, {0, 0, 0.5}, {0, 0, 1}, 0.01);
  add_line(text, "l", {2.0 * size, -3.0 * size, 5.0 * size});
  add_line(text, "f", {0.9, 0.8, 0.6, 1, 0, 0, 0, 0});
  const double reach = 1.5 * size + 1.5;
  add_polygon(text, {{-reach, -reach, -0.5}, {reach, -reach, -0.5}, {reach, reach, -0.5}, {-reach, reach, -0.5}});
  for (std::uint32_t row = 0; row < size; ++row) {
    for (std::uint32_t column = 0; column < size; ++column) {
      const double shade = 0.5 + 0.5 * column / size;
      add_line(text, "f", {shade, 0.6, 1 - 0.5 * row / size, 0.7, 0.2, 20, 0, 1});
      add_shell(text, {3.0 * column - 1.5 * (size - 1), 3.0 * row - 1.5 * (size - 1), 0}, 1, 8 * kTurn);
    }
  }
  return text;
}

}  // namespace gridiron::scene_makers
