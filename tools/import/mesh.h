// Mesh: triangles as read from a file, with the surface that the file gives them.
// Memory: std::vector. Threads: any may read. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/scene/mesh.h>

#include <cstdint>
#include <vector>

#include "scene_text/scene_description.h"

namespace gridiron::tool {

/// Materials, normals and colours of a mesh. Any of the three may be missing: its vectors are empty then. A frame
/// without effects does not need them.
struct MeshSurface {
  std::vector<SceneMaterial> materials;           ///< 0..kMostSceneMaterials
  std::vector<std::uint16_t> triangle_materials;  ///< empty or one per triangle: index into materials
  std::vector<Vec3> normals;                      ///< unit to float rounding, world space
  std::vector<UVec3> triangle_normals;  ///< empty or one per triangle: indices into normals, or kNoNormal three times
  std::vector<Vec3> colors;             ///< linear, 0..1 each
  std::vector<UVec3> triangle_colors;   ///< empty or one per triangle: indices into colors, or kNoNormal three times;
                                        ///< the colour of a corner replaces that of its material

  [[nodiscard]] bool is_empty() const {
    return triangle_materials.empty() && triangle_normals.empty() && triangle_colors.empty();
  }
};

/// Triangles as read, in the input's order after fanning.
struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<UVec3> triangles;
  MeshSurface surface{};

  [[nodiscard]] MeshView view() const { return {vertices, triangles}; }
};

}  // namespace gridiron::tool
