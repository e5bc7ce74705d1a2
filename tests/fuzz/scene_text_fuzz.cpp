// libFuzzer target: the reader of text scenes on hostile text. Seeds: scenes/*.nff. Files that a text names are not
// there. Checks what a caller relies on: a scene with all indices in range, or a complaint with file and line. Memory:
// std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "base/failure.h"
#include "scene_text/scene_reader.h"

namespace {

using namespace gridiron;
using namespace gridiron::tool;

void require(bool condition) {
  if (!condition) std::abort();
}

void check(const SceneDescription& scene) {
  const SceneGeometry& geometry = scene.geometry;
  const std::size_t count = geometry.triangles.size();
  require(count > 0 && geometry.triangle_materials.size() == count);
  require(geometry.triangle_normals.size() == (geometry.normals.empty() ? 0 : count));
  for (std::size_t i = 0; i < count; ++i) {
    require(geometry.triangle_materials[i] < scene.materials.size());
    const bool is_smooth = scene.materials[geometry.triangle_materials[i]].smooth_normals;
    for (int corner = 0; corner < 3; ++corner) {
      require(geometry.triangles[i][corner] < geometry.vertices.size());
      if (is_smooth) require(geometry.triangle_normals[i][corner] < geometry.normals.size());
    }
  }
  for (const Vec3& vertex : geometry.vertices) {
    for (int axis = 0; axis < 3; ++axis) require(std::isfinite(vertex[axis]));
  }
  for (const Vec3& normal : geometry.normals) {
    for (int axis = 0; axis < 3; ++axis) require(std::fabs(normal[axis]) <= 1.000001f);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t bytes) {
  SceneOptions options;
  options.relative_tolerance = 0.02f;
  options.most_triangles = 20000;
  try {
    check(read_scene_text(std::string_view(reinterpret_cast<const char*>(data), bytes), "/nowhere/a.nff", options));
  } catch (const Failure& failure) {
    const std::string_view said = failure.what();
    require(said.starts_with("/nowhere/a.nff:") && said.find('\n') == std::string_view::npos);
    require(said.size() > 15 && said[15] >= '1' && said[15] <= '9');
  }
  return 0;
}
