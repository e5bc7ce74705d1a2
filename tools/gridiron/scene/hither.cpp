// Hither plane. SPDX-License-Identifier: Apache-2.0
#include "hither.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <glm/geometric.hpp>

#include "base/failure.h"
#include "base/words.h"

namespace gridiron::tool {
namespace {

// A convex polygon; each of the pyramid's four planes adds one corner at most.
struct Polygon {
  std::array<DVec3, 8> corners;
  std::size_t count = 0;

  void add(const DVec3& corner) { corners[count++] = corner; }
};

// The part on the side of a plane through the eye where dot(normal, p) >= 0.
Polygon clip(const Polygon& polygon, const DVec3& normal) {
  Polygon inside;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const DVec3& from = polygon.corners[i];
    const DVec3& to = polygon.corners[(i + 1) % polygon.count];
    const double from_side = glm::dot(normal, from);
    const double to_side = glm::dot(normal, to);
    if (from_side >= 0) inside.add(from);
    if ((from_side >= 0) != (to_side >= 0)) inside.add(from + (to - from) * (from_side / (from_side - to_side)));
  }
  return inside;
}

}  // namespace

std::optional<HitherCut> find_hither_cut(const Camera& camera, double aspect, double hither, const MeshView& mesh) {
  const DVec3 eye(camera.eye);
  const DVec3 forward = glm::normalize(DVec3(camera.at) - eye);
  const DVec3 right = glm::normalize(glm::cross(forward, DVec3(camera.up)));
  const DVec3 up = glm::cross(right, forward);
  const double slope_y = camera.tan_half_fov;
  const double slope_x = slope_y * aspect;
  const DVec3 sides[] = {{1, 0, slope_x}, {-1, 0, slope_x}, {0, 1, slope_y}, {0, -1, slope_y}};

  std::optional<HitherCut> cut;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    Polygon polygon;
    for (int corner = 0; corner < 3; ++corner) {
      const DVec3 offset = DVec3(mesh.vertices[mesh.triangles[i][corner]]) - eye;
      polygon.add({glm::dot(right, offset), glm::dot(up, offset), glm::dot(forward, offset)});
    }
    const auto is_nearer = [](const DVec3& a, const DVec3& b) { return a.z < b.z; };
    const auto* const first = polygon.corners.data();
    const double limit = cut ? cut->depth : hither;
    if (std::min_element(first, first + 3, is_nearer)->z >= limit) continue;
    for (const DVec3& side : sides) polygon = clip(polygon, side);
    if (polygon.count == 0) continue;
    const auto [nearest, farthest] = std::minmax_element(first, first + polygon.count, is_nearer);
    // Convex: it has points in (0, hither) if its depths overlap that interval.
    if (nearest->z < limit && farthest->z > 0) cut = HitherCut{i, std::max(nearest->z, 0.0)};
  }
  return cut;
}

void check_hither(const SceneInput& input, const Camera& camera, std::uint32_t width, std::uint32_t height) {
  if (!input.text || input.text->view.hither <= 0) return;
  const SceneView& view = input.text->view;
  const std::optional<HitherCut> cut =
      find_hither_cut(camera, static_cast<double>(width) / height, view.hither, std::get<Mesh>(input.content).view());
  if (!cut) return;
  char text[160];
  std::snprintf(text, sizeof text, "hither %g would cut what is seen from %.8g on; this renderer has no near plane",
                static_cast<double>(view.hither), cut->depth);
  input_error(input.path, view.line, text);
}

}  // namespace gridiron::tool
