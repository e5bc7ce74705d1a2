// Meshes of text scenes. SPDX-License-Identifier: Apache-2.0
#include <gridiron/io/ply_reader.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <utility>

#include "base/failure.h"
#include "base/words.h"
#include "files/input_file.h"
#include "files/interrupt.h"
#include "scene_text/scene_files.h"

namespace gridiron::tool {
namespace {

constexpr std::size_t kMostMeshBytes = std::size_t{4} << 30;

[[noreturn]] void fail(const std::filesystem::path& path, const PlyResult& result) {
  const PlyPosition& position = result.position;
  std::string message = path.string() + ":";
  message += position.line != 0 ? std::to_string(position.line) : "byte " + std::to_string(position.byte_offset);
  throw Failure(ExitCode::kBadInput, message + ": " + words_of(result.error));
}

DVec3 row(const SceneMatrix& matrix, std::size_t index) {
  return {matrix[4 * index], matrix[4 * index + 1], matrix[4 * index + 2]};
}

double determinant(const SceneMatrix& matrix) {
  return glm::dot(row(matrix, 0), glm::cross(row(matrix, 1), row(matrix, 2)));
}

DVec3 moved(const SceneMatrix& matrix, const DVec3& point) {
  return DVec3(glm::dot(row(matrix, 0), point), glm::dot(row(matrix, 1), point), glm::dot(row(matrix, 2), point)) +
         DVec3(matrix[3], matrix[7], matrix[11]);
}

}  // namespace

bool is_invertible(const SceneMatrix& matrix) {
  const double volume = glm::length(row(matrix, 0)) * glm::length(row(matrix, 1)) * glm::length(row(matrix, 2));
  return std::fabs(determinant(matrix)) > 1e-12 * volume;
}

SceneMesh read_scene_mesh(const std::filesystem::path& path, const std::optional<SceneMatrix>& matrix) {
  require_regular_file(path);
  const InputFile file = read_input_file(path, "expected a PLY mesh", kMostMeshBytes);
  PlyConfig config;
  config.max_vertices = kMostSceneVertices;
  config.max_triangles = kMostSceneTriangles;
  const PlyResult counted = count_ply(file.bytes, config);
  if (counted.error != PlyError::kNone) fail(path, counted);
  if (counted.counts.triangles == 0) input_error(path, "holds no triangle");
  stop_if_interrupted();
  SceneMesh mesh;
  mesh.vertices.resize(counted.counts.vertices);
  mesh.triangles.resize(counted.counts.triangles);
  const PlyResult result = read_ply(file.bytes, mesh.vertices, mesh.triangles, config);
  if (result.error != PlyError::kNone) fail(path, result);

  for (Vec3& vertex : mesh.vertices) {
    const DVec3 place = matrix ? moved(*matrix, DVec3(vertex)) : DVec3(vertex);
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::fabs(place[axis]) <= kMostSceneCoordinate)) {
        input_error(path, "a vertex lies farther than 1e18 from the origin");
      }
    }
    vertex = Vec3(place);
  }
  if (matrix && determinant(*matrix) < 0) {
    for (UVec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
  }
  return mesh;
}

void require_regular_file(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  // A missing file is reported by the function that opens it.
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    input_error(path, "not a regular file");
  }
}

}  // namespace gridiron::tool
