// Meshes made to be hard, and rays aimed at their features.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "numeric/hard_cases/trial.h"
#include "numeric/hard_rays.h"
#include "support/test_mesh.h"

namespace gridiron::test::hard {

/// @returns whether a mesh has an edge and every one is passed as often in one direction as in the other.
bool is_closed(const TestMesh& mesh);

/// Rounds every vertex to multiples of `step`, a power of two.
TestMesh on_lattice(TestMesh mesh, float step);

/// The surface of a heap of unit cubes in [0, n]^3: those around the middle, others by chance. Whole-numbered vertices.
TestMesh make_cubes(std::uint32_t n, std::uint64_t seed);

/// Splits every triangle in three by a point beside one of its edges: `width` times that edge away, so that one of the
/// three is a sliver. What was closed stays closed.
TestMesh split_by_slivers(const TestMesh& mesh, float width, std::uint64_t seed);

/// The same with a point one float from a vertex: two of the three are needles.
TestMesh split_by_needles(const TestMesh& mesh, std::uint64_t seed);

/// Cuts an edge of every triangle at its middle and closes the gap with a triangle of no area: T-junctions, seen by
/// who drops it. Middles have to be floats.
TestMesh cut_edges(const TestMesh& mesh);

/// A closed mesh and where its inside is.
struct Solid {
  const char* name;
  TestMesh mesh;
  Vec3 middle;
  float room;  ///< within it on each axis of the middle, all is inside
};

/// Sphere, torus, box, all of them of ordinary floats; a sphere and cubes on a lattice, where rays can hit exactly.
std::vector<Solid> solids();

/// `count` rays from `origin` at features of a mesh.
Rays rays_at(const TestMesh& mesh, Vec3 origin, Aim aim, std::uint32_t count, TestRandom& random);

/// A picture of 20 x 12 pixels around a feature, from steps as long as its triangle to steps of a float or two.
Rays picture_at(const TestMesh& mesh, Vec3 origin, Aim aim, TestRandom& random);

/// @returns whether every direction is one: a pixel may lie where the eye is.
[[nodiscard]] bool are_rays(const Rays& rays);

/// A picture whose pixels lie on a triangle, its corner, an edge and their neighbours exactly in the pixels' middles,
/// as far as floats allow it.
Rays picture_of_triangle(const TestMesh& mesh, std::uint32_t triangle, Vec3 origin);

/// What a mesh has at every triangle.
inline const std::vector<Aim> kFeatures = {Aim::kEdge, Aim::kVertex, Aim::kInside};

/// How many rays, at what.
struct Salvo {
  std::vector<Aim> aims;
  std::uint32_t origins;
  std::uint32_t rays;      ///< for each origin and aim
  std::uint32_t pictures;  ///< the same
};

/// A single ray.
Rays one_ray(Vec3 origin, Vec3 direction);

/// The same rays with directions, each times a power of two, of a largest component in [1, 2).
std::vector<Rays> with_unit_directions(std::vector<Rays> all);

/// A salvo from origins within `room` of a place; every fourth origin is rounded to eighths of `room`.
std::vector<Rays> salvo(const TestMesh& mesh, Vec3 middle, float room, const Salvo& count, std::uint64_t seed);
/// The same at whatever mesh a trial has.
AimAtMesh salvo_at(Vec3 middle, float room, const Salvo& count, std::uint64_t seed);

/// Rays of times(count) calls of add(all, number of the call, random, mesh).
template <class Add>
AimAtMesh rounds(std::uint32_t count, std::uint64_t seed, Add add) {
  return [=](const TestMesh& mesh) {
    TestRandom random(seed);
    std::vector<Rays> all;
    for (std::uint32_t i = 0; i < times(count); ++i) add(all, i, random, mesh);
    return all;
  };
}

/// The rays of several aims, one after the other.
AimAtMesh all_of(std::vector<AimAtMesh> aims);

}  // namespace gridiron::test::hard
