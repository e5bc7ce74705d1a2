// Entities of a text scene after reading: parsed and checked one by one, not yet tessellated.
// Memory: std::vector. Threads: any may read. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>

#include <cstdint>
#include <vector>

#include "scene_text/scene_description.h"

namespace gridiron::tool {

/// The surfaces of a material with shading normals of their own: the state of `sn`.
enum class Smoothness : std::uint8_t {
  kCurved,  ///< before the first `sn`: s, c and pp
  kAll,     ///< `sn on`: meshes too
  kNone,    ///< `sn off`
};

/// An `f` line.
struct SceneFill {
  SceneMaterial material;
  Smoothness smoothness = Smoothness::kCurved;
};

enum class ShapeKind : std::uint8_t { kSphere, kCone, kPolygon, kPatch, kMesh };

/// One object of the text.
struct SceneShape {
  ShapeKind kind = ShapeKind::kSphere;
  std::uint32_t fill = 0;   ///< of SceneEntities::fills
  std::uint64_t line = 0;   ///< of its keyword
  std::uint64_t first = 0;  ///< sphere, cone: of numbers; polygon, patch: of points; mesh: of meshes
  std::uint32_t count = 0;  ///< corners of a polygon or patch
};

/// A mesh in world space, triangles turned outwards as in its file.
struct SceneMesh {
  std::vector<Vec3> vertices;
  std::vector<UVec3> triangles;
};

struct SceneEntities {
  SceneDescription scene;  ///< all but materials, geometry, tolerance and notes
  std::vector<SceneFill> fills;
  std::vector<SceneShape> shapes;  ///< in the file's order
  std::vector<double> numbers;     ///< sphere: centre, radius; cone: base, its radius, apex, its radius
  std::vector<Vec3> points;        ///< polygon: corners; patch: corner, unit normal, corner, ...
  std::vector<SceneMesh> meshes;
};

}  // namespace gridiron::tool
