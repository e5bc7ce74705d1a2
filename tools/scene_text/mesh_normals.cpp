// Mesh normals. SPDX-License-Identifier: Apache-2.0
#include "scene_text/mesh_normals.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

namespace gridiron::tool {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;

}  // namespace

DVec3 unit_or_zero(const DVec3& vector) {
  const double largest = std::max({std::fabs(vector.x), std::fabs(vector.y), std::fabs(vector.z)});
  if (!(largest > 0) || !std::isfinite(largest)) return DVec3(0.0);
  return glm::normalize(vector / largest);
}

MeshNormals make_mesh_normals(std::span<const Vec3> vertices, std::span<const UVec3> triangles) {
  std::vector<DVec3> sums(vertices.size(), DVec3(0.0));
  for (const UVec3& triangle : triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t at = triangle[corner];
      const DVec3 place(vertices[at]);
      const DVec3 a = DVec3(vertices[triangle[(corner + 1) % 3]]) - place;
      const DVec3 b = DVec3(vertices[triangle[(corner + 2) % 3]]) - place;
      const double weight = glm::dot(a, a) * glm::dot(b, b);
      if (weight > 0 && std::isfinite(weight)) sums[at] += glm::cross(a, b) / weight;
    }
  }

  MeshNormals result;
  std::vector<std::uint32_t> index_of_vertex(vertices.size(), kNone);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const DVec3 normal = unit_or_zero(sums[i]);
    if (normal == DVec3(0.0)) continue;
    index_of_vertex[i] = static_cast<std::uint32_t>(result.normals.size());
    result.normals.emplace_back(normal);
  }
  result.triangles.reserve(triangles.size());
  for (const UVec3& triangle : triangles) {
    UVec3 indices(index_of_vertex[triangle.x], index_of_vertex[triangle.y], index_of_vertex[triangle.z]);
    if (indices.x == kNone || indices.y == kNone || indices.z == kNone) {
      const DVec3 origin(vertices[triangle.x]);
      const DVec3 own =
          unit_or_zero(glm::cross(DVec3(vertices[triangle.y]) - origin, DVec3(vertices[triangle.z]) - origin));
      const auto index = static_cast<std::uint32_t>(result.normals.size());
      result.normals.emplace_back(own == DVec3(0.0) ? DVec3(0, 0, 1) : own);
      for (int corner = 0; corner < 3; ++corner) {
        if (indices[corner] == kNone) indices[corner] = index;
      }
    }
    result.triangles.push_back(indices);
  }
  return result;
}

}  // namespace gridiron::tool
