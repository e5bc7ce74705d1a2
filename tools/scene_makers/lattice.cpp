// A lattice of balls and tubes. SPDX-License-Identifier: Apache-2.0
#include "scene_makers/nff_text.h"
#include "scene_makers/procedural.h"

namespace gridiron::scene_makers {

std::string make_lattice(std::uint32_t size) {
  std::string text = begin_scene("lattice", size, {1.75, 1.55, 3}, {0.5, 0.5, 0.5}, {0, 1, 0}, 0.01);
  add_line(text, "l", {4, 5, 6});
  add_line(text, "l", {-3, 6, 4});
  const double step = 1.0 / size, ball = 0.2 * step, tube = 0.06 * step;
  const auto place = [step](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return Point{step * x, step * y, step * z};
  };
  add_line(text, "f", {1, 0.9, 0.7, 0.5, 0.5, 20, 0, 1});
  for (std::uint32_t z = 0; z <= size; ++z) {
    for (std::uint32_t y = 0; y <= size; ++y) {
      for (std::uint32_t x = 0; x <= size; ++x) {
        add_sphere(text, place(x, y, z), ball);
        if (x < size) add_cylinder(text, place(x, y, z), place(x + 1, y, z), tube);
        if (y < size) add_cylinder(text, place(x, y, z), place(x, y + 1, z), tube);
        if (z < size) add_cylinder(text, place(x, y, z), place(x, y, z + 1), tube);
      }
    }
  }
  return text;
}

}  // namespace gridiron::scene_makers
