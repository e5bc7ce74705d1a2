// The lattice of a scene whose vertices are stored in 16 bits an axis. The whole scene has one, so that equal vertices
// stay equal and a closed mesh stays closed. Vertices move by at most half a step. A triangle smaller than a step may
// lose its area.
// Source: own. Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>
#include <gridiron/base/records.h>
#include <gridiron/platform/status.h>
#include <gridiron/scene/mesh.h>

#include <cstdint>
#include <span>

namespace gridiron {

/// The finest lattice over the vertices of a mesh's triangles. Its step is the least power of two, not below
/// kLeastLatticeStep, with which its places span them and keep them within kMostStepsFromZero steps of zero.
///
/// Errors: kBadIndex; kBadVertex where a coordinate is beyond kCoordinateLimit. Cost: linear.
[[nodiscard]] Status find_lattice(const MeshView& mesh, Lattice& lattice);

/// Places of a point on a lattice, nearest, halves up, 0..65535.
struct LatticePoint {
  std::uint16_t place[3];
};
[[nodiscard]] LatticePoint lattice_point(const Lattice& lattice, const Vec3& point);

/// @returns the lattice's point nearest to `point`; exactly a float on each axis.
[[nodiscard]] Vec3 snap(const Lattice& lattice, const Vec3& point);

/// Vertices as they will be stored.
struct LatticeVertices {
  std::span<const Vec3> vertices;
  Lattice lattice;

  [[nodiscard]] Vec3 operator[](std::size_t i) const { return snap(lattice, vertices[i]); }
  [[nodiscard]] std::size_t size() const { return vertices.size(); }
};

/// A mesh as it will be stored on a lattice; MeshView is the same for one that is stored unchanged.
struct LatticeMesh {
  LatticeVertices vertices;
  std::span<const UVec3> triangles;
};
template <class Mesh>
inline constexpr bool kIsOnLattice = false;
template <>
inline constexpr bool kIsOnLattice<LatticeMesh> = true;

}  // namespace gridiron
