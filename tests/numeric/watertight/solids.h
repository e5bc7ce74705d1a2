// Solids: the closed meshes of the suite, the definition of closed, and their places.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>

#include "support/test_mesh.h"

namespace gridiron::test {

/// @returns why a mesh is not closed; empty where every edge is shared by exactly two faces that run along it in
/// opposite directions, and no face meets itself.
std::string why_not_closed(const TestMesh& mesh);

/// A tetrahedron of which one edge is cut into `count` pieces, `thickness` long and not quite in a line: two fans of
/// slivers, their apexes of valence count + 4.
TestMesh make_fan_solid(std::uint32_t count, float thickness);

/// make_height_field's hills on a block: skirts of one cell's width down to a floor of the same cells, all in one
/// plane.
TestMesh make_height_solid(std::uint32_t cells, float height, std::uint64_t seed);

/// Moves the middle of a mesh's bounds to 0 and scales it by a power of two, so that half its largest extent is in
/// [1/2, 1).
void centre(TestMesh& mesh);

/// A closed mesh around 0.
struct Solid {
  std::string name;
  TestMesh mesh;
};

enum class Detail : std::uint8_t { kLow, kFull };

/// Sphere, torus, fan of slivers, height field.
std::vector<Solid> make_solids(Detail detail);

/// A scan, or why it is left out.
struct ScanSolid {
  Solid solid;
  std::string left_out;  ///< empty where it is closed
};
/// The PLY files of a directory.
std::vector<ScanSolid> load_scans(const std::filesystem::path& directory);

/// Where a solid is put: every vertex becomes the floats nearest to v * 2^exponent + offset.
struct Placement {
  std::string name;
  int exponent = 0;
  Vec3 offset{0.0f};

  friend void PrintTo(const Placement& placement, std::ostream* out) { *out << placement.name; }
};
/// Centred at 0, then elsewhere, then of other sizes.
std::vector<Placement> all_placements();

}  // namespace gridiron::test
