// A triangle mesh for scene makers, and its file.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace gridiron::scene_makers {

using Point = std::array<double, 3>;
using Triangle = std::array<std::uint32_t, 3>;

/// Indexed triangles, counter-clockwise seen from outside.
struct Mesh {
  std::vector<Point> vertices;
  std::vector<Triangle> triangles;

  /// @returns the new vertex's index.
  std::uint32_t add_vertex(const Point& point) {
    vertices.push_back(point);
    return static_cast<std::uint32_t>(vertices.size() - 1);
  }
};

/// @returns the mesh as binary little-endian PLY: float x y z, lists of three 32-bit indices.
[[nodiscard]] std::vector<char> ply_bytes(const Mesh& mesh, const std::string& comment);

/// Writes `bytes` to `path`, completely or not at all. @returns an empty string, or the reason of a failure.
[[nodiscard]] std::string write_whole_file(const std::string& path, const std::vector<char>& bytes);

}  // namespace gridiron::scene_makers
