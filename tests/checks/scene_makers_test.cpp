// Our own scenes: closed, turned outwards, of the requested size, and equal to the files in scenes/.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest-spi.h>

#include <numeric>

#include "scene_makers/mesh.h"
#include "scene_makers/shapes.h"
#include "support/test_headers.h"

namespace gridiron::scene_makers {
namespace {

// Signed volume of the tetrahedron of a triangle and the origin, as the file's floats have it.
double signed_volume(const Mesh& mesh, const Triangle& triangle) {
  std::array<std::array<double, 3>, 3> p{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) p[i][axis] = static_cast<float>(mesh.vertices[triangle[i]][axis]);
  }
  return (p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) - p[0][1] * (p[1][0] * p[2][2] - p[1][2] * p[2][0]) +
          p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0])) /
         6;
}

double squared_area(const Mesh& mesh, const Triangle& triangle) {
  std::array<double, 3> a{}, b{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double origin = static_cast<float>(mesh.vertices[triangle[0]][axis]);
    a[axis] = static_cast<float>(mesh.vertices[triangle[1]][axis]) - origin;
    b[axis] = static_cast<float>(mesh.vertices[triangle[2]][axis]) - origin;
  }
  const double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
  return (x * x + y * y + z * z) / 4;
}

// Checks that the mesh is closed and each connected part is turned outwards. @returns the number of parts.
std::size_t expect_closed(const Mesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> directed_edges;
  std::vector<std::uint32_t> part(mesh.vertices.size());
  std::iota(part.begin(), part.end(), 0u);
  const auto root = [&](std::uint32_t vertex) {
    while (part[vertex] != vertex) vertex = part[vertex] = part[part[vertex]];
    return vertex;
  };
  for (const Triangle& triangle : mesh.triangles) {
    EXPECT_GT(squared_area(mesh, triangle), 0);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = triangle[i], to = triangle[(i + 1) % 3];
      EXPECT_TRUE(directed_edges.emplace(from, to).second) << "edge " << from << " -> " << to << " is there twice";
      part[root(from)] = root(to);
    }
  }
  for (const auto& [from, to] : directed_edges) {
    EXPECT_TRUE(directed_edges.contains({to, from})) << "edge " << from << " -> " << to << " is open";
  }
  std::map<std::uint32_t, double> volumes;
  for (const Triangle& triangle : mesh.triangles) volumes[root(triangle[0])] += signed_volume(mesh, triangle);
  for (const auto& [vertex, volume] : volumes)
    EXPECT_GT(volume, 0) << "the part of vertex " << vertex << " is inside out";
  return volumes.size();
}

std::vector<char> bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

std::filesystem::path scene(const char* name) {
  return std::filesystem::path(GRIDIRON_SOURCE_DIR) / "scenes" / name;
}

TEST(SceneMakers, TeapotIsThreeClosedPartsAtAnySize) {
  for (const std::uint32_t segments : {2u, 3u, 7u, 15u}) {
    SCOPED_TRACE(segments);
    const Mesh teapot = make_teapot(segments);
    EXPECT_EQ(teapot.triangles.size(), 64 * segments * segments + 8 * segments);
    EXPECT_EQ(expect_closed(teapot), 3u);
  }
}

TEST(SceneMakers, NeedlesAreThreeClosedStars) {
  for (const std::uint32_t rays : {8u, 12u, 512u}) {
    SCOPED_TRACE(rays);
    const Mesh needles = make_needles(rays);
    EXPECT_EQ(needles.triangles.size(), 12 * rays);
    EXPECT_EQ(expect_closed(needles), 3u);
  }
}

TEST(SceneMakers, KnotHasExactlyTheTrianglesAskedFor) {
  for (const std::uint32_t triangle_count : {kMinKnotTriangles, 602u, 604u, 998u, 1000u, 12346u, 100000u}) {
    SCOPED_TRACE(triangle_count);
    const Mesh knot = make_torus_knot(triangle_count);
    EXPECT_EQ(knot.triangles.size(), triangle_count);
    EXPECT_EQ(expect_closed(knot), 1u);
  }
}

TEST(SceneMakers, AHoleATurnedTriangleAndADoubleAreNoticed) {
  // The check above must be able to fail: count the failures it reports on spoilt meshes.
  const auto failures = [](const std::function<void(Mesh&)>& spoil) {
    Mesh mesh = make_needles(8);
    spoil(mesh);
    testing::TestPartResultArray results;
    {
      testing::ScopedFakeTestPartResultReporter reporter(
          testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &results);
      expect_closed(mesh);
    }
    return results.size();
  };
  EXPECT_EQ(failures([](Mesh&) {}), 0);
  EXPECT_GT(failures([](Mesh& mesh) { mesh.triangles.pop_back(); }), 0);
  EXPECT_GT(failures([](Mesh& mesh) { std::swap(mesh.triangles[0][0], mesh.triangles[0][1]); }), 0);
  EXPECT_GT(failures([](Mesh& mesh) { mesh.triangles.push_back(mesh.triangles[0]); }), 0);
  EXPECT_GT(failures([](Mesh& mesh) {
              for (Triangle& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
            }),
            0);
}

TEST(SceneMakers, CommittedFilesAreWhatTheMakersWrite) {
  EXPECT_EQ(bytes_of(scene("teapot.ply")), ply_bytes(make_teapot(15), "made by make_mesh --shape teapot"));
  EXPECT_EQ(bytes_of(scene("needles.ply")), ply_bytes(make_needles(512), "made by make_mesh --shape needles"));
}

TEST(SceneMakers, AFileThatCannotBeWrittenLeavesNothing) {
  const std::string path = testing::TempDir() + "no_such_directory/mesh.ply";
  EXPECT_NE(write_whole_file(path, {'x'}), "");
  EXPECT_FALSE(std::filesystem::exists(path));
  // A directory in the file's place: the partial file must go away again.
  const std::filesystem::path taken = std::filesystem::path(testing::TempDir()) / "gridiron_taken.ply";
  std::filesystem::create_directories(taken / "inside");
  EXPECT_NE(write_whole_file(taken.string(), {'x'}), "");
  EXPECT_FALSE(std::filesystem::exists(taken.string() + ".partial"));
  std::filesystem::remove_all(taken);
  EXPECT_EQ(write_whole_file("/dev/null", {'x'}), "");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null")) << "a device is not replaced";
}

}  // namespace
}  // namespace gridiron::scene_makers
