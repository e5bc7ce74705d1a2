// Generated meshes for tests: small, seeded, the same triangles on every run.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/scene/mesh.h>

#include "support/test_headers.h"

namespace gridiron::test {

/// A mesh that owns its arrays.
struct TestMesh {
  std::vector<Vec3> vertices;
  std::vector<UVec3> triangles;

  [[nodiscard]] MeshView view() const { return {vertices, triangles}; }

  /// Appends the triangles of `other` behind the own ones.
  void append(const TestMesh& other);

  /// Replaces every vertex that a triangle has by its place on the mesh's own lattice.
  void snap();

  /// Replaces every vertex p by the floats nearest to p * scale + offset.
  void transform(float scale, Vec3 offset);
};

/// A mesh whose vertices p are the floats nearest to p * scale + offset.
TestMesh moved(TestMesh mesh, float scale, Vec3 offset = Vec3(0));

/// The triangles of two meshes, those of `other` behind.
TestMesh joined(TestMesh mesh, const TestMesh& other);

/// SplitMix64 random numbers: the same for a seed on every host and library.
class TestRandom {
 public:
  explicit TestRandom(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next();
  /// Uniform in [0, 1), multiples of 2^-24.
  float unit();
  /// Uniform in [low, high).
  float between(float low, float high);
  /// Uniform in [0, count).
  std::uint32_t below(std::uint32_t count);

 private:
  std::uint64_t state_;
};

/// Two triangles a face, 12 in all; faces look outward.
TestMesh make_box(Vec3 minimum, Vec3 maximum);

/// Latitude-longitude sphere; the poles are vertices of valence `segments`. 2 * segments * (rings - 1) triangles.
TestMesh make_sphere(std::uint32_t rings, std::uint32_t segments, float radius);

/// 2 * rings * segments triangles around the y axis.
TestMesh make_torus(std::uint32_t rings, std::uint32_t segments, float major_radius, float minor_radius);

/// 2 * cells^2 triangles over [-1, 1]^2 in x and z; y in [-height, height], smooth hills with seeded noise on top.
TestMesh make_height_field(std::uint32_t cells, float height, std::uint64_t seed);

/// `count` triangles around one apex whose far edges are `thickness` long: valence and aspect ratio as high as wanted.
TestMesh make_sliver_fan(std::uint32_t count, float thickness);

/// `count` unconnected triangles with corners within `extent` of centres drawn from [-1, 1]^3.
TestMesh make_random_soup(std::uint32_t count, float extent, std::uint64_t seed);

/// One triangle.
TestMesh make_triangle(Vec3 a, Vec3 b, Vec3 c);

}  // namespace gridiron::test
