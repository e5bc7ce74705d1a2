// Invariants of the hierarchy. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/triangle_records.h>
#include <gridiron/bvh/bvh.h>

#include "support/test_mesh.h"

namespace gridiron::bvh {
namespace {

/// What a walk over all nodes found.
struct Walk {
  std::vector<int> leaves_of_triangle;
  std::vector<int> visits_of_node;
  std::uint32_t depth = 0;
};

struct Bounds {
  float low[3] = {kFloatMax, kFloatMax, kFloatMax};
  float high[3] = {-kFloatMax, -kFloatMax, -kFloatMax};

  void grow(const Bounds& bounds) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], bounds.low[axis]);
      high[axis] = std::max(high[axis], bounds.high[axis]);
    }
  }
  bool operator==(const Bounds&) const = default;
};

Bounds bounds_of(const VertexTriangle& triangle) {
  Bounds bounds{};
  for (int axis = 0; axis < 3; ++axis) {
    bounds.low[axis] = std::min({triangle.v[0][axis], triangle.v[1][axis], triangle.v[2][axis]});
    bounds.high[axis] = std::max({triangle.v[0][axis], triangle.v[1][axis], triangle.v[2][axis]});
  }
  return bounds;
}

void check(const test::TestMesh& mesh, const BvhParameters& parameters) {
  Bvh bvh;
  ASSERT_EQ(build_bvh(mesh.view(), parameters, bvh), Status::kOk);
  ASSERT_EQ(bvh.nodes.size() % parameters.line_nodes, 0u);
  ASSERT_EQ(bvh.triangles.size() % parameters.line_triangles, 0u);
  Walk walk;
  walk.leaves_of_triangle.assign(mesh.triangles.size(), 0);
  walk.visits_of_node.assign(bvh.nodes.size(), 0);
  struct Open {
    std::uint32_t node, depth;
    Bounds bounds;
  };
  Bounds all{};
  std::memcpy(all.low, bvh.low, sizeof all.low);
  std::memcpy(all.high, bvh.high, sizeof all.high);
  std::vector<Open> open = {{0, 1, all}};
  std::uint64_t leaves = 0;
  while (!open.empty()) {
    const Open current = open.back();
    open.pop_back();
    walk.depth = std::max(walk.depth, current.depth);
    ASSERT_LT(current.node, bvh.nodes.size());
    ASSERT_EQ(++walk.visits_of_node[current.node], 1);
    const BvhNode& node = bvh.nodes[current.node];
    ASSERT_GE(node.child_count, 1u);
    ASSERT_LE(node.child_count, kNodeWidth);
    Bounds of_children;
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      Bounds bounds{};
      for (int axis = 0; axis < 3; ++axis) {
        bounds.low[axis] = node.bounds[0][axis][i];
        bounds.high[axis] = node.bounds[1][axis][i];
      }
      of_children.grow(bounds);
      const BvhChild child = node.children[i];
      if (!child.is_leaf()) {
        open.push_back({child.node_index(), current.depth + 1, bounds});
        continue;
      }
      ++leaves;
      const std::uint32_t first = child.first_triangle(), count = child.triangle_count();
      ASSERT_LE(count, parameters.leaf_triangles);
      ASSERT_LE(first + count, bvh.triangles.size());
      EXPECT_EQ(first / parameters.line_triangles, (first + count - 1) / parameters.line_triangles);
      Bounds of_triangles;
      for (std::uint32_t k = first; k < first + count; ++k) {
        const VertexTriangle& triangle = bvh.triangles[k];
        ASSERT_LT(triangle.triangle_id, mesh.triangles.size());
        ++walk.leaves_of_triangle[triangle.triangle_id];
        of_triangles.grow(bounds_of(triangle));
        const UVec3& corners = mesh.triangles[triangle.triangle_id];
        for (int corner = 0; corner < 3; ++corner) {
          EXPECT_EQ(std::memcmp(triangle.v[corner], &mesh.vertices[corners[corner]], 12), 0);
        }
      }
      EXPECT_EQ(of_triangles, bounds) << "node " << current.node << ", child " << i;
    }
    EXPECT_EQ(of_children, current.bounds) << "node " << current.node;
  }
  std::uint64_t kept = 0;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const UVec3& t = mesh.triangles[i];
    const bool has_area = !has_zero_area(mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z]);
    EXPECT_EQ(walk.leaves_of_triangle[i], has_area ? 1 : 0) << i;
    kept += has_area ? 1 : 0;
  }
  EXPECT_EQ(walk.depth, bvh.depth);
  EXPECT_LE(bvh.depth, kMaxBvhDepth);
  EXPECT_EQ(bvh.counts.leaves, leaves);
  EXPECT_EQ(bvh.counts.records_written, kept);
  EXPECT_EQ(bvh.counts.binary_nodes, 2 * leaves - 1);
  std::uint64_t visited = 0;
  for (const int visits : walk.visits_of_node) visited += static_cast<std::uint64_t>(visits);
  EXPECT_EQ(bvh.counts.wide_nodes, visited);
}

/// Triangles in a line at distances that double: every split by area takes one off.
test::TestMesh make_doubling_line(std::uint32_t count) {
  test::TestMesh mesh;
  float at = 1e-20f;
  for (std::uint32_t i = 0; i < count; ++i, at *= 1.9f) {
    mesh.append(test::make_triangle({at, 0, 0}, {at * 1.1f, 0, 0}, {at, at * 0.1f, 0}));
  }
  return mesh;
}

TEST(Bvh, EveryTriangleLiesInOneLeafInsideItsBoxes) {
  const BvhParameters parameters[] = {
      {},
      {.bin_count = 4, .leaf_triangles = 1, .triangle_cost = 1, .line_triangles = 2, .line_nodes = 1},
      {.bin_count = 64, .leaf_triangles = 8, .triangle_cost = 8, .line_triangles = 16, .line_nodes = 8},
      {.leaf_triangles = kMaxLeafTriangles, .triangle_cost = 0.01f, .every_axis_from = 0},
      {.line_triangles = kMaxLineTriangles, .every_axis_from = 100}};
  test::TestMesh with_empty_ones = test::make_random_soup(100, 0.2f, 5);
  with_empty_ones.append(test::make_triangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2}));
  with_empty_ones.append(test::make_triangle({1, 0, 0}, {1, 0, 0}, {2, 2, 2}));
  test::TestMesh same_center;
  for (int i = 0; i < 50; ++i) same_center.append(test::make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  for (const BvhParameters& tried : parameters) {
    check(test::make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), tried);
    check(test::make_random_soup(2000, 0.1f, 1), tried);
    check(test::make_torus(40, 20, 1, 0.3f), tried);
    check(test::make_sliver_fan(300, 1e-4f), tried);
    check(with_empty_ones, tried);
    check(same_center, tried);
    check(make_doubling_line(130), tried);
  }
}

TEST(Bvh, SameTreeForTheSameMesh) {
  const test::TestMesh mesh = test::make_random_soup(3000, 0.1f, 9);
  Bvh a, b;
  ASSERT_EQ(build_bvh(mesh.view(), {}, a), Status::kOk);
  ASSERT_EQ(build_bvh(mesh.view(), {}, b), Status::kOk);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  EXPECT_EQ(std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(BvhNode)), 0);
  ASSERT_EQ(a.triangles.size(), b.triangles.size());
  EXPECT_EQ(std::memcmp(a.triangles.data(), b.triangles.data(), a.triangles.size() * sizeof(VertexTriangle)), 0);
}

TEST(Bvh, CountsWhatABuildOfTwoTrianglesDoes) {
  test::TestMesh mesh = test::make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  mesh.append(test::make_triangle({10, 0, 0}, {11, 0, 0}, {10, 1, 0}));
  Bvh bvh;
  ASSERT_EQ(build_bvh(mesh.view(), {.bin_count = 8, .leaf_triangles = 1}, bvh), Status::kOk);
  // One split: they differ along x only, so one axis is tried, with 8 bins from each side.
  EXPECT_EQ(bvh.counts.bin_updates, 2u);
  EXPECT_EQ(bvh.counts.bins_swept, 16u);
  EXPECT_EQ(bvh.counts.triangles_moved, 2u);
  EXPECT_EQ(bvh.counts.boxes_bounded, 2u);
  EXPECT_EQ(bvh.counts.halving_steps, 0u);
  EXPECT_EQ(bvh.counts.records_written, 2u);
  EXPECT_EQ(bvh.counts.binary_nodes, 3u);
  EXPECT_EQ(bvh.counts.wide_nodes, 1u);
  EXPECT_EQ(bvh.counts.leaves, 2u);
}

TEST(Bvh, RefusesWhatItCannotBuild) {
  Bvh bvh;
  const test::TestMesh good = test::make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  EXPECT_EQ(build_bvh(good.view(), {.bin_count = 1}, bvh), Status::kBadParameter);
  EXPECT_EQ(build_bvh(good.view(), {.leaf_triangles = kMaxLeafTriangles + 1, .line_triangles = 128}, bvh),
            Status::kBadParameter);
  EXPECT_EQ(build_bvh(good.view(), {.line_triangles = kMaxLineTriangles + 2}, bvh), Status::kBadParameter);
  EXPECT_EQ(build_bvh(good.view(), {.leaf_triangles = 4, .line_triangles = 2}, bvh), Status::kBadParameter);
  EXPECT_EQ(build_bvh(good.view(), {.line_triangles = 5}, bvh), Status::kBadParameter);
  EXPECT_EQ(build_bvh(good.view(), {.line_nodes = 0}, bvh), Status::kBadParameter);
  EXPECT_EQ(build_bvh({}, {}, bvh), Status::kNoTriangles);
  test::TestMesh bad = good;
  bad.triangles[0].y = 3;
  EXPECT_EQ(build_bvh(bad.view(), {}, bvh), Status::kBadIndex);
  bad = good;
  bad.vertices[1].z = std::numeric_limits<float>::infinity();
  EXPECT_EQ(build_bvh(bad.view(), {}, bvh), Status::kBadVertex);
  EXPECT_EQ(build_bvh(test::make_triangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2}).view(), {}, bvh), Status::kNoTriangles);
}

}  // namespace
}  // namespace gridiron::bvh
