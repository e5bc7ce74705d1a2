// Scenes of the Standard Procedural Databases as NFF text, at any size, and a sky for environment cubes.
// Made with the four operations and square roots only: the same bytes everywhere.
// Source: E. Haines, "A Proposal for Standard Graphics Environments", 1987, and the descriptions published with it.
// Memory: std::vector, std::string. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace gridiron::scene_makers {

// Largest sizes that this project's reader accepts (2^24 objects, 1 GB of text).
inline constexpr std::uint32_t kMostBallsSize = 7, kMostTetraSize = 11, kMostMountSize = 11, kMostRingsSize = 90;
inline constexpr std::uint32_t kMostLatticeSize = 100, kMostShellsSize = 100;

/// The sphereflake: a ball of radius 1/2 that carries nine of a third of its radius, and so on, `size` times over a
/// square floor. 1 + 9 + ... + 9^size spheres, 1 polygon, 3 lights, mirrors. @param size  0..kMostBallsSize.
[[nodiscard]] std::string make_balls(std::uint32_t size);

/// The tetrahedral pyramid of Sierpinski: 4^size triangles, 4 to a tetrahedron; 1 light. @param
/// size  1..kMostTetraSize.
[[nodiscard]] std::string make_tetra(std::uint32_t size);

/// A fractal mountain of 2 * 4^size triangles behind a pyramid of four glass balls; 1 light. The heights come from our
/// own hash. @param size  1..kMostMountSize.
[[nodiscard]] std::string make_mount(std::uint32_t size);

/// A pyramid of 1 + 4 + ... + size^2 objects before a wall, seen from its tip. Each is six pentagonal rings through the
/// midpoints of a dodecahedron's edges: 30 cylinders and 30 spheres; 3 lights, mirrors. @param size  1..kMostRingsSize.
[[nodiscard]] std::string make_rings(std::uint32_t size);

/// A lattice of (size + 1)^3 balls joined by 3 size (size + 1)^2 tubes in the unit cube; 2 lights, mirrors. View, radii
/// and colours are our own. @param size  1..kMostLatticeSize.
[[nodiscard]] std::string make_lattice(std::uint32_t size);

/// size^2 sea shells on the ground, each of 288 balls that reach into their neighbours, along a spiral that narrows as
/// it rises; 1 polygon, 1 light, mirrors. The spiral is our own. @param size  1..kMostShellsSize.
[[nodiscard]] std::string make_shells(std::uint32_t size);

/// Names of the six faces of an environment cube in the order in which scenes name them.
inline constexpr std::array<const char*, 6> kFaceNames = {"px", "nx", "py", "ny", "pz", "nz"};

/// A blue sky with a sun brighter than 1 over a brown ground. @param face  0..5. @param width  texels, >= 1.
/// @returns the bytes of a PFM file: colour, little-endian.
[[nodiscard]] std::vector<char> make_sky_face(std::uint32_t face, std::uint32_t width);

}  // namespace gridiron::scene_makers
