// A team of host threads: each part of a work once; and builds and checks of images that a team shares: the same bytes,
// the same errors as of one thread. Threads: starts some. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/build/tree/tree_builder.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/sim/host_team.h>

#include <random>
#include <system_error>

#include "core/build/grid/line_buffer.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using sim::HostTeam;

// Calls work(i) for each i < count.
template <class Work>
void share(const WorkSharing& sharing, std::uint32_t count, Work&& work) {
  using Called = std::remove_reference_t<Work>;
  sharing.run(sharing.team, count, [](void* called, std::uint32_t i) { (*static_cast<Called*>(called))(i); }, &work);
}

TEST(HostTeam, EachPartIsCalledOnceWorkAfterWork) {
  for (const std::uint32_t threads : {0u, 1u, 2u, 5u, 40u}) {
    HostTeam team(threads);
    const WorkSharing sharing = team.sharing();
    EXPECT_EQ(sharing.sharers, std::min(std::max(threads, 1u), kMostSharers));
    for (const std::uint32_t count : {0u, 1u, 2u, 3u, 64u, 1000u, 7u}) {
      std::vector<std::atomic<int>> calls(count);
      share(sharing, count, [&](std::uint32_t i) { ++calls[i]; });
      for (const std::atomic<int>& call : calls) ASSERT_EQ(call, 1);
    }
  }
}

TEST(HostTeam, ThreadsThatCannotBeStartedAreLeftOut) {
  for (const std::uint32_t limit : {0u, 1u, 2u}) {
    HostTeam team(4, [limit, started = 0u](std::function<void()> run) mutable {
      if (started++ >= limit) throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
      return std::thread(std::move(run));
    });
    EXPECT_EQ(team.sharing().sharers, limit + 1);
    std::atomic<int> calls = 0;
    share(team.sharing(), 10, [&](std::uint32_t) { ++calls; });
    EXPECT_EQ(calls, 10);
  }
}

// --- Images ---------------------------------------------------------------------------------------------------------

// More than kManyTreeTriangles: soup, crowds of one code, triangles without an area, some of them where a share begins.
TestMesh large_mesh() {
  TestMesh mesh = moved(make_random_soup(34'000, 0.1f, 3), 50.0f);
  for (const Vec3& place : {Vec3(-40, -40, -40), Vec3(40, -40, -40), Vec3(-40, 40, 40), Vec3(40, 40, 40)}) {
    mesh = joined(std::move(mesh), moved(make_random_soup(1'100, 0.1f, 4), 1e-3f, place));
  }
  for (std::uint32_t i = 0; i < mesh.triangles.size(); i += 97) mesh.triangles[i].z = mesh.triangles[i].x;
  for (std::uint32_t i = 0; i < 40; ++i) mesh.triangles[mesh.triangles.size() / 2 - 20 + i].y = mesh.triangles[0].x;
  return mesh;
}

struct Image {
  Status status = Status::kOk;
  GridNeed need{};
  LineBuffer bytes;
};

Image built(const MeshView& mesh, TriangleFormat format, const WorkSharing& sharing, std::byte fill) {
  const GridParameters parameters = {.format = format, .leaf_triangles = 8, .has_tree = true, .has_grid = false};
  Image image;
  image.status = count_scene_image(mesh, parameters, image.need, nullptr, kAnyImageBytes, {}, sharing);
  if (image.status != Status::kOk) return image;
  image.bytes = LineBuffer(static_cast<std::size_t>(image.need.image_bytes), fill);
  std::vector<std::uint64_t> scratch(image.need.scratch_bytes / 8);
  image.status = build_scene_image(mesh, parameters, image.need, image.bytes.bytes(),
                                   std::as_writable_bytes(std::span(scratch)), nullptr, sharing);
  ImageHeader header;
  std::memcpy(&header, image.bytes.bytes().data(), sizeof header);
  if (image.status == Status::kOk) image.bytes.shrink(static_cast<std::size_t>(header.image_bytes));
  return image;
}

bool are_same(const Image& a, const Image& b) {
  const auto x = a.bytes.bytes(), y = b.bytes.bytes();
  return a.status == b.status && a.need.image_bytes == b.need.image_bytes &&
         a.need.dropped_triangle_count == b.need.dropped_triangle_count && x.size() == y.size() &&
         std::memcmp(x.data(), y.data(), x.size()) == 0;
}

// One thread that takes the last part first.
WorkSharing backwards(std::uint32_t sharers) {
  return {sharers,
          [](void*, std::uint32_t count, WorkSharing::Part part, void* work) {
            while (count-- > 0) part(work, count);
          },
          nullptr};
}

// A thread for each part, so that a sanitizer sees what two parts share, however busy the host is.
WorkSharing all_at_once(std::uint32_t sharers) {
  return {sharers,
          [](void*, std::uint32_t count, WorkSharing::Part part, void* work) {
            std::vector<std::thread> threads;
            for (std::uint32_t i = 0; i < count; ++i) threads.emplace_back(part, work, i);
            for (std::thread& thread : threads) thread.join();
          },
          nullptr};
}

TEST(SharedBuild, ImagesAreThoseOfOneThread) {
  const TestMesh mesh = large_mesh();
  for (const TriangleFormat format : {TriangleFormat::kVertices, TriangleFormat::kLattice}) {
    const Image alone = built(mesh.view(), format, {}, std::byte{0xA5});
    ASSERT_EQ(alone.status, Status::kOk);
    EXPECT_GT(alone.need.dropped_triangle_count, 300u);
    for (const std::uint32_t sharers : {2u, 3u, 16u}) {
      HostTeam team(sharers);
      EXPECT_TRUE(are_same(built(mesh.view(), format, team.sharing(), std::byte{0x5A}), alone)) << sharers;
      EXPECT_TRUE(are_same(built(mesh.view(), format, backwards(sharers), std::byte{0}), alone)) << sharers;
    }
    EXPECT_TRUE(are_same(built(mesh.view(), format, all_at_once(4), std::byte{0}), alone));
  }
}

// Shares count in the memory of the records: these have just no room for two shares, just room, and more.
TEST(SharedBuild, OfManyTrianglesFewMayHaveAnArea) {
  constexpr std::uint32_t kCounts = 262'144;  // bytes
  for (const TriangleFormat format : {TriangleFormat::kVertices, TriangleFormat::kLattice}) {
    const auto bytes = static_cast<std::uint32_t>(format == TriangleFormat::kVertices ? sizeof(VertexTriangle)
                                                                                      : sizeof(LatticeTriangle));
    for (const std::uint32_t kept : {2'000u, kCounts / bytes, kCounts / bytes + 1, 2 * kCounts / bytes + 1}) {
      TestMesh mesh = moved(make_random_soup(34'000, 0.1f, 3), 50.0f);
      for (std::uint32_t i = kept; i < mesh.triangles.size(); ++i) mesh.triangles[i].z = mesh.triangles[i].x;
      const Image alone = built(mesh.view(), format, {}, std::byte{0xA5});
      ASSERT_EQ(alone.status, Status::kOk);
      ASSERT_EQ(mesh.triangles.size() - alone.need.dropped_triangle_count, kept);
      EXPECT_TRUE(are_same(built(mesh.view(), format, all_at_once(16), std::byte{0x5A}), alone)) << kept;
    }
  }
}

TEST(SharedBuild, ErrorsAreThoseOfOneThread) {
  const TestMesh good = large_mesh();
  HostTeam team(3);
  const auto expect_status = [&](const TestMesh& mesh, Status status) {
    EXPECT_EQ(built(mesh.view(), TriangleFormat::kVertices, {}, {}).status, status);
    EXPECT_EQ(built(mesh.view(), TriangleFormat::kVertices, team.sharing(), {}).status, status);
  };
  for (const std::size_t place : {std::size_t{0}, good.triangles.size() / 2, good.triangles.size() - 1}) {
    TestMesh mesh = good;
    mesh.triangles[place].y = static_cast<std::uint32_t>(mesh.vertices.size());
    expect_status(mesh, Status::kBadIndex);
    mesh = good;
    mesh.vertices[place].z = std::numeric_limits<float>::quiet_NaN();
    expect_status(mesh, Status::kBadVertex);
  }
  TestMesh flat = good;
  for (UVec3& triangle : flat.triangles) triangle.z = triangle.x;
  expect_status(flat, Status::kNoTriangles);
}

// Two words of the tree are changed: which of them is named must not depend on who found it.
TEST(SharedBuild, DamageIsNamedAsByOneThread) {
  const TestMesh mesh = large_mesh();
  Image image = built(mesh.view(), TriangleFormat::kVertices, {}, {});
  ASSERT_EQ(image.status, Status::kOk);
  const std::span<std::byte> bytes = image.bytes.bytes();
  SceneImageView view;
  SceneImageError error;
  ASSERT_EQ(open_scene_image(bytes, view, error), Status::kOk);
  ASSERT_GT(view.tree.node_count, 1024u) << "for several shares";
  HostTeam team(4);
  std::mt19937_64 random(5);
  std::uint32_t refused = 0, of_nodes = 0;
  for (int i = 0; i < 120; ++i) {
    std::vector<std::pair<std::size_t, std::uint32_t>> words;
    for (int k = 0; k < 2; ++k) {
      // Nodes are fewer bytes than triangles.
      const std::uint64_t begin = random() % 2 == 0 ? view.tree_offset_bytes : view.tree.nodes_offset_bytes;
      const std::size_t at = static_cast<std::size_t>(begin + random() % (bytes.size() - begin) / 4 * 4);
      std::uint32_t word;
      std::memcpy(&word, bytes.data() + at, 4);
      words.emplace_back(at, word);
      word ^= 1u << random() % 32;
      std::memcpy(bytes.data() + at, &word, 4);
    }
    const std::uint64_t check_value = scene_image_check_value(bytes);
    ASSERT_EQ(scene_image_check_value(bytes, team.sharing()), check_value);
    std::memcpy(bytes.data() + offsetof(ImageHeader, check_value), &check_value, sizeof check_value);
    const Status status = open_scene_image(bytes, view, error);
    refused += status != Status::kOk ? 1 : 0;
    of_nodes += error.byte_offset >= view.tree.nodes_offset_bytes ? 1 : 0;
    for (const WorkSharing& sharing : {team.sharing(), backwards(4), all_at_once(4)}) {
      SceneImageError other;
      EXPECT_EQ(open_scene_image(bytes, view, other, sharing), status);
      EXPECT_EQ(other.byte_offset, error.byte_offset);
      EXPECT_STREQ(other.field, error.field);
    }
    for (auto word = words.rbegin(); word != words.rend(); ++word) {
      std::memcpy(bytes.data() + word->first, &word->second, 4);
    }
  }
  EXPECT_GT(refused, 90u);
  EXPECT_GT(of_nodes, 10u);
}

}  // namespace
}  // namespace gridiron::test
