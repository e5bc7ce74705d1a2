// The tetrahedral pyramid. SPDX-License-Identifier: Apache-2.0
#include "scene_makers/nff_text.h"
#include "scene_makers/procedural.h"

namespace gridiron::scene_makers {
namespace {

// Every other corner of a cube.
constexpr std::array<Point, 4> kCorners = {{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}};

// Adds the faces of a tetrahedron, or of the four of half its size in its corners.
void add_tetrahedron(std::string& text, const Point& center, double scale, std::uint32_t size) {
  if (size > 1) {
    for (const Point& corner : kCorners) {
      add_tetrahedron(text, center + corner * (0.5 * scale), 0.5 * scale, size - 1);
    }
    return;
  }
  const auto place = [&](std::size_t i) { return center + kCorners[i] * scale; };
  add_polygon(text, {place(0), place(2), place(3)});
  add_polygon(text, {place(0), place(3), place(1)});
  add_polygon(text, {place(0), place(1), place(2)});
  add_polygon(text, {place(1), place(3), place(2)});
}

}  // namespace

std::string make_tetra(std::uint32_t size) {
  std::string text = begin_scene("tetra", size, {1.022846, -3.177154, -2.174512}, {-0.004103, -0.004103, 0.216539},
                                 {-0.816497, -0.816497, 0.816497}, 1);
  add_line(text, "l", {2, -18, -5});
  add_line(text, "f", {1, 0.2, 0.2, 1, 0, 0, 0, 0});
  add_tetrahedron(text, {0, 0, 0}, 1, size);
  return text;
}

}  // namespace gridiron::scene_makers
