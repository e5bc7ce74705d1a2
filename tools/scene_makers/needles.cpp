// Stars of slivers: many long thin triangles that meet in a point, the hard case for a grid and for a shared edge.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include "scene_makers/shapes.h"

namespace gridiron::scene_makers {
namespace {

constexpr double kTipRadius = 1;
constexpr double kValleyRadius = 0.3;
constexpr double kCentreHeight = 0.05;

// Point i of `count` on the unit circle by its rational parametrisation, one quadrant at a time: no sine, no cosine.
void circle_point(std::uint32_t i, std::uint32_t count, double& x, double& y) {
  const std::uint32_t quarter = count / 4;
  const double t = static_cast<double>(i % quarter) / static_cast<double>(quarter);
  const double along = (1 - t * t) / (1 + t * t);
  const double across = 2 * t / (1 + t * t);
  switch (i / quarter) {
    case 0:
      x = along, y = across;
      break;
    case 1:
      x = -across, y = along;
      break;
    case 2:
      x = -along, y = -across;
      break;
    default:
      x = across, y = -along;
      break;
  }
}

void add_star(Mesh& mesh, std::size_t axis, std::uint32_t rays) {
  const auto place = [&](double u, double v, double height) {
    Point point{};
    point[(axis + 1) % 3] = u;
    point[(axis + 2) % 3] = v;
    point[axis] = height;
    return mesh.add_vertex(point);
  };
  const std::uint32_t top = place(0, 0, kCentreHeight);
  const std::uint32_t bottom = place(0, 0, -kCentreHeight);
  const std::uint32_t rim_count = 2 * rays;
  const std::uint32_t first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t i = 0; i < rim_count; ++i) {
    double u = 0, v = 0;
    circle_point(i, rim_count, u, v);
    const double radius = i % 2 == 0 ? kTipRadius : kValleyRadius;
    place(radius * u, radius * v, 0);
  }
  for (std::uint32_t i = 0; i < rim_count; ++i) {
    const std::uint32_t here = first + i;
    const std::uint32_t next = first + (i + 1) % rim_count;
    mesh.triangles.push_back({top, here, next});
    mesh.triangles.push_back({bottom, next, here});
  }
}

}  // namespace

Mesh make_needles(std::uint32_t rays) {
  Mesh mesh;
  for (std::size_t axis = 0; axis < 3; ++axis) add_star(mesh, axis, rays);
  return mesh;
}

}  // namespace gridiron::scene_makers
