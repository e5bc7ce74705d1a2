// Checks of scenes. SPDX-License-Identifier: Apache-2.0
#include "check_scene.h"

#include <glm/geometric.hpp>

#include "failure_of.h"
#include "support/test_headers.h"

namespace gridiron::test {

using tool::SceneDescription;
using tool::SceneGeometry;

SceneDescription read_good(std::string_view text, const tool::SceneOptions& options, const std::string& path) {
  try {
    return tool::read_scene_text(text, path, options);
  } catch (const tool::Failure& failure) {
    ADD_FAILURE() << failure.what();
    return {};
  }
}

std::string complaint(std::string_view text, const tool::SceneOptions& options, const std::string& path) {
  SCOPED_TRACE(text);
  return failure_of([&] { return tool::read_scene_text(text, path, options); });
}

void expect_sound(const SceneDescription& scene) {
  const SceneGeometry& geometry = scene.geometry;
  ASSERT_FALSE(geometry.triangles.empty());
  ASSERT_EQ(geometry.triangle_materials.size(), geometry.triangles.size());
  ASSERT_FALSE(scene.materials.empty());
  ASSERT_LE(scene.materials.size(), tool::kMostSceneMaterials);
  ASSERT_EQ(geometry.triangle_normals.size(), geometry.normals.empty() ? 0 : geometry.triangles.size());
  std::vector<bool> is_used(scene.materials.size());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
    const UVec3& triangle = geometry.triangles[i];
    for (int corner = 0; corner < 3; ++corner) wrong += triangle[corner] >= geometry.vertices.size();
    ASSERT_LT(geometry.triangle_materials[i], scene.materials.size());
    const tool::SceneMaterial& material = scene.materials[geometry.triangle_materials[i]];
    is_used[geometry.triangle_materials[i]] = true;
    const UVec3 normals = geometry.triangle_normals.empty() ? UVec3(tool::kNoNormal) : geometry.triangle_normals[i];
    for (int corner = 0; corner < 3; ++corner) {
      wrong +=
          material.smooth_normals ? normals[corner] >= geometry.normals.size() : normals[corner] != tool::kNoNormal;
    }
  }
  EXPECT_EQ(wrong, 0u) << "indices";
  for (const Vec3& vertex : geometry.vertices) {
    for (int axis = 0; axis < 3; ++axis) wrong += !(std::fabs(double{vertex[axis]}) <= 2 * tool::kMostSceneCoordinate);
  }
  EXPECT_EQ(wrong, 0u) << "vertices";
  for (const Vec3& normal : geometry.normals) wrong += !(std::fabs(glm::length(DVec3(normal)) - 1) < 1e-6);
  EXPECT_EQ(wrong, 0u) << "normals";
  for (const bool used : is_used) EXPECT_TRUE(used) << "a material that nothing is made of";
  EXPECT_GT(scene.tolerance, 0.0f);
  EXPECT_LE(scene.notes.size(), scene.note_count);
}

std::size_t count_open_edges(std::span<const UVec3> triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;  // uses in the rising direction less the falling ones
  std::size_t doubled = 0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const UVec3& triangle : triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t from = triangle[corner], to = triangle[(corner + 1) % 3];
      edges[{std::min(from, to), std::max(from, to)}] += from < to ? 1 : -1;
      doubled += ++uses[{from, to}] > 1;
    }
  }
  std::size_t open = doubled;
  for (const auto& [edge, balance] : edges) open += balance != 0;
  return open;
}

double signed_volume(std::span<const Vec3> vertices, std::span<const UVec3> triangles) {
  double sum = 0;
  for (const UVec3& t : triangles) {
    sum += glm::dot(DVec3(vertices[t.x]), glm::cross(DVec3(vertices[t.y]), DVec3(vertices[t.z])));
  }
  return sum / 6;
}

DVec3 doubled_area(std::span<const Vec3> vertices, std::span<const UVec3> triangles) {
  DVec3 sum(0.0);
  for (const UVec3& t : triangles) {
    const DVec3 origin(vertices[t.x]);
    sum += glm::cross(DVec3(vertices[t.y]) - origin, DVec3(vertices[t.z]) - origin);
  }
  return sum;
}

}  // namespace gridiron::test
