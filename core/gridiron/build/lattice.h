// The lattice of a scene whose vertices are stored in 16 bits an axis: one for all of it, so that vertices that were
// equal stay equal and a closed mesh stays closed. Vertices move by half a step at most; what is smaller than a step
// may lose its area.
// Source: own. Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>
#include <gridiron/base/records.h>
#include <gridiron/platform/status.h>
#include <gridiron/scene/mesh.h>

#include <cstdint>
#include <span>

namespace gridiron {

/// The finest lattice over the vertices that triangles of a mesh have: its step is the least power of two that spans
/// them with its places, keeps them within kMostStepsFromZero steps of zero and is not below kLeastLatticeStep.
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

/// A mesh as it will be stored: what MeshView is to one stored as it stands.
struct LatticeMesh {
  LatticeVertices vertices;
  std::span<const UVec3> triangles;
};

}  // namespace gridiron
