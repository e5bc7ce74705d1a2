// Generated meshes: see the header. SPDX-License-Identifier: Apache-2.0
#include "support/test_mesh.h"

#include <gridiron/build/lattice.h>

#include <numbers>
#include <stdexcept>

namespace gridiron::test {
namespace {

// Appends the two triangles of the quadrilateral a b c d, counter-clockwise seen from outside.
void add_quad(TestMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

double angle_of(std::uint32_t step, std::uint32_t steps) {
  return 2.0 * std::numbers::pi * step / steps;
}

Vec3 to_vec3(double x, double y, double z) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

}  // namespace

// A mesh may be appended to itself, so its size is taken first.
void TestMesh::append(const TestMesh& other) {
  const auto base = static_cast<std::uint32_t>(vertices.size());
  const std::size_t vertex_count = other.vertices.size(), triangle_count = other.triangles.size();
  for (std::size_t i = 0; i < vertex_count; ++i) vertices.push_back(Vec3(other.vertices[i]));
  for (std::size_t i = 0; i < triangle_count; ++i) triangles.push_back(other.triangles[i] + UVec3(base));
}

void TestMesh::snap() {
  Lattice lattice{};
  if (find_lattice(view(), lattice) != Status::kOk) throw std::invalid_argument("a mesh without a lattice");
  for (Vec3& vertex : vertices) vertex = gridiron::snap(lattice, vertex);
}

void TestMesh::transform(float scale, Vec3 offset) {
  for (Vec3& p : vertices) p = Vec3(DVec3(p) * double{scale} + DVec3(offset));
}

TestMesh moved(TestMesh mesh, float scale, Vec3 offset) {
  mesh.transform(scale, offset);
  return mesh;
}

TestMesh joined(TestMesh mesh, const TestMesh& other) {
  mesh.append(other);
  return mesh;
}

std::uint64_t TestRandom::next() {
  // SplitMix64 (Steele, Lea, Flood 2014): a bijection of a counter.
  state_ += 0x9E3779B97F4A7C15u;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

float TestRandom::unit() {
  return static_cast<float>(next() >> 40) * 0x1p-24f;
}

float TestRandom::between(float low, float high) {
  return low + unit() * (high - low);
}

std::uint32_t TestRandom::below(std::uint32_t count) {
  return static_cast<std::uint32_t>(((next() >> 32) * count) >> 32);
}

TestMesh make_box(Vec3 minimum, Vec3 maximum) {
  TestMesh mesh;
  for (unsigned corner = 0; corner < 8; ++corner) {
    mesh.vertices.push_back({(corner & 1u) != 0 ? maximum.x : minimum.x, (corner & 2u) != 0 ? maximum.y : minimum.y,
                             (corner & 4u) != 0 ? maximum.z : minimum.z});
  }
  add_quad(mesh, 0, 4, 6, 2);
  add_quad(mesh, 1, 3, 7, 5);
  add_quad(mesh, 0, 1, 5, 4);
  add_quad(mesh, 2, 6, 7, 3);
  add_quad(mesh, 0, 2, 3, 1);
  add_quad(mesh, 4, 5, 7, 6);
  return mesh;
}

TestMesh make_sphere(std::uint32_t rings, std::uint32_t segments, float radius) {
  TestMesh mesh;
  mesh.vertices.push_back({0, radius, 0});
  for (std::uint32_t ring = 1; ring < rings; ++ring) {
    const double polar = std::numbers::pi * ring / rings;
    for (std::uint32_t segment = 0; segment < segments; ++segment) {
      const double around = angle_of(segment, segments);
      mesh.vertices.push_back(to_vec3(radius * std::sin(polar) * std::cos(around), radius * std::cos(polar),
                                      -radius * std::sin(polar) * std::sin(around)));
    }
  }
  const auto south = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back({0, -radius, 0});
  const auto index = [segments](std::uint32_t ring, std::uint32_t segment) {
    return 1 + (ring - 1) * segments + segment % segments;
  };
  for (std::uint32_t segment = 0; segment < segments; ++segment) {
    mesh.triangles.push_back({0, index(1, segment), index(1, segment + 1)});
    for (std::uint32_t ring = 1; ring + 1 < rings; ++ring) {
      add_quad(mesh, index(ring, segment), index(ring + 1, segment), index(ring + 1, segment + 1),
               index(ring, segment + 1));
    }
    mesh.triangles.push_back({south, index(rings - 1, segment + 1), index(rings - 1, segment)});
  }
  return mesh;
}

TestMesh make_torus(std::uint32_t rings, std::uint32_t segments, float major_radius, float minor_radius) {
  TestMesh mesh;
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    const double around = angle_of(ring, rings);
    for (std::uint32_t segment = 0; segment < segments; ++segment) {
      const double tube = angle_of(segment, segments);
      const double distance = major_radius + minor_radius * std::cos(tube);
      mesh.vertices.push_back(
          to_vec3(distance * std::cos(around), minor_radius * std::sin(tube), -distance * std::sin(around)));
    }
  }
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    const std::uint32_t here = ring * segments;
    const std::uint32_t there = (ring + 1) % rings * segments;
    for (std::uint32_t segment = 0; segment < segments; ++segment) {
      const std::uint32_t next = (segment + 1) % segments;
      add_quad(mesh, here + segment, there + segment, there + next, here + next);
    }
  }
  return mesh;
}

TestMesh make_height_field(std::uint32_t cells, float height, std::uint64_t seed) {
  TestMesh mesh;
  TestRandom random(seed);
  const std::uint32_t row = cells + 1;
  mesh.vertices.reserve(std::size_t{row} * row);
  mesh.triangles.reserve(std::size_t{2} * cells * cells);
  for (std::uint32_t j = 0; j < row; ++j) {
    for (std::uint32_t i = 0; i < row; ++i) {
      const double x = 2.0 * i / cells - 1.0;
      const double z = 2.0 * j / cells - 1.0;
      const double hills = 0.6 * std::sin(5.0 * x + 1.0) * std::cos(4.0 * z) + 0.3 * std::sin(13.0 * x * z + 2.0);
      const double noise = 0.1 * std::fmin(1.0, 64.0 / cells) * (2.0 * double{random.unit()} - 1.0);
      mesh.vertices.push_back(to_vec3(x, height * (hills + noise), z));
    }
  }
  for (std::uint32_t j = 0; j < cells; ++j) {
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t corner = j * row + i;
      add_quad(mesh, corner, corner + row, corner + row + 1, corner + 1);
    }
  }
  return mesh;
}

TestMesh make_sliver_fan(std::uint32_t count, float thickness) {
  TestMesh mesh;
  mesh.vertices.push_back({0, 0, 0});
  for (std::uint32_t i = 0; i <= count; ++i) {
    const double along = (double{thickness} * i) - 0.5 * double{thickness} * count;
    mesh.vertices.push_back(to_vec3(along, 1.0, 0.1 * along));
  }
  for (std::uint32_t i = 0; i < count; ++i) mesh.triangles.push_back({0, i + 1, i + 2});
  return mesh;
}

TestMesh make_random_soup(std::uint32_t count, float extent, std::uint64_t seed) {
  TestMesh mesh;
  TestRandom random(seed);
  for (std::uint32_t i = 0; i < count; ++i) {
    const float x = random.between(-1, 1);
    const float y = random.between(-1, 1);
    const float z = random.between(-1, 1);
    for (int corner = 0; corner < 3; ++corner) {
      const float dx = random.between(-extent, extent);
      const float dy = random.between(-extent, extent);
      const float dz = random.between(-extent, extent);
      mesh.vertices.push_back({x + dx, y + dy, z + dz});
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

TestMesh make_triangle(Vec3 a, Vec3 b, Vec3 c) {
  return {{a, b, c}, {{0, 1, 2}}};
}

}  // namespace gridiron::test
