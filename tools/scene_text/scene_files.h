// Files that a text scene names: meshes and faces of an environment cube.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "scene_text/scene_entities.h"

namespace gridiron::tool {

/// A 3x4 matrix, row by row: x' = m[0] x + m[1] y + m[2] z + m[3] and so on.
using SceneMatrix = std::array<double, 12>;

/// @returns whether a matrix has an inverse in doubles: its determinant exceeds 1e-12 of the product of its rows'
/// lengths.
[[nodiscard]] bool is_invertible(const SceneMatrix& matrix);

/// Throws Failure (kBadInput) for a folder, device or pipe, which would block or never end.
void require_regular_file(const std::filesystem::path& path);

/// Reads a PLY file and moves it. Triangles stay turned outwards if the matrix mirrors.
///
/// Errors: Failure (kBadInput), `file:line: reason`, `file:byte N: reason` or `file: reason`: not a regular file,
/// unreadable, wrong, more than kMostSceneVertices or kMostSceneTriangles, no triangle, a vertex moved farther than
/// kMostSceneCoordinate.
[[nodiscard]] SceneMesh read_scene_mesh(const std::filesystem::path& path, const std::optional<SceneMatrix>& matrix);

/// A face of an environment cube: width * width texels, first row on top.
struct EnvironmentFace {
  std::uint32_t width = 0;
  std::vector<Vec3> texels;
};

/// Reads a PNG or PFM file, distinguished by its first bytes.
///
/// PNG: a channel's value divided by 255, no transfer curve, as pictures are written; 16 bits are reduced to 8, alpha
/// is over black. PFM: colour or grey, either byte order; the magnitude of its scale is ignored.
/// Errors: Failure (kBadInput), `file: reason`: not a regular file, unreadable, neither format, broken, not square,
/// wider than kMostEnvironmentWidth, a texel that is negative, NaN or infinite.
[[nodiscard]] EnvironmentFace read_environment_face(const std::filesystem::path& path);

}  // namespace gridiron::tool
