// Edge points. SPDX-License-Identifier: Apache-2.0
#include "experiment/edge_points.h"

#include <gridiron/base/records.h>

#include <cmath>

namespace gridiron::experiment {

std::vector<Vec3> edge_points(const MeshView& mesh, std::span<const std::uint32_t> ids, std::size_t count) {
  std::vector<std::uint32_t> shown;
  for (const std::uint32_t id : ids) {
    if (id != kNoTriangle) shown.push_back(id);
  }
  std::vector<Vec3> points;
  if (shown.empty()) return points;
  constexpr double kGolden = 0.6180339887498949;  // its multiples are spread evenly between 0 and 1
  for (std::size_t i = 0; i < count; ++i) {
    const UVec3& triangle = mesh.triangles[shown[i * shown.size() / count]];
    const auto edge = static_cast<int>(i % 3);
    const DVec3 from(mesh.vertices[triangle[edge]]), to(mesh.vertices[triangle[(edge + 1) % 3]]);
    const double share = static_cast<double>(i + 1) * kGolden;
    points.emplace_back(i % 4 == 3 ? from : from + (to - from) * (share - std::floor(share)));
  }
  return points;
}

}  // namespace gridiron::experiment
