// Edge points. SPDX-License-Identifier: Apache-2.0
#include "experiment/edge_points.h"

#include <gridiron/base/records.h>

#include <cmath>

namespace gridiron::experiment {

Vec3 edge_point(const MeshView& mesh, std::uint32_t id, std::size_t turn) {
  constexpr double kGolden = 0.6180339887498949;  // its multiples are spread evenly between 0 and 1
  const UVec3& triangle = mesh.triangles[id];
  const auto edge = static_cast<int>(turn % 3);
  const DVec3 from(mesh.vertices[triangle[edge]]), to(mesh.vertices[triangle[(edge + 1) % 3]]);
  const double share = static_cast<double>(turn + 1) * kGolden;
  return Vec3(turn % 4 == 3 ? from : from + (to - from) * (share - std::floor(share)));
}

std::vector<Vec3> edge_points(const MeshView& mesh, std::span<const std::uint32_t> ids, std::size_t count) {
  std::vector<std::uint32_t> shown;
  for (const std::uint32_t id : ids) {
    if (id != kNoTriangle) shown.push_back(id);
  }
  std::vector<Vec3> points;
  if (shown.empty()) return points;
  for (std::size_t i = 0; i < count; ++i) points.push_back(edge_point(mesh, shown[i * shown.size() / count], i));
  return points;
}

}  // namespace gridiron::experiment
