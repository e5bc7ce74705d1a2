// Build work of the tree: counts of meshes small enough to count by hand. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/tree/tree_builder.h>
#include <gridiron/sim/tree_build_work.h>

#include "support/test_headers.h"

namespace gridiron::sim {
namespace {

constexpr std::uint32_t kLeaf = 8;

/// Triangles, each of vertices of its own.
struct LooseMesh {
  std::vector<Vec3> vertices;
  std::vector<UVec3> triangles;

  void add(const Vec3& corner, float width) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const Vec3& offset : {Vec3(0, 0, 0), Vec3(width, 0, 0), Vec3(0, width, 0)}) {
      vertices.push_back(corner + offset);
    }
    triangles.emplace_back(first, first + 1, first + 2);
  }
  [[nodiscard]] MeshView view() const { return {vertices, triangles}; }
};

struct Built {
  std::vector<TreeNode> nodes;
  TreeSize size{};
};

Built built(const LooseMesh& mesh) {
  Built tree{std::vector<TreeNode>(most_tree_nodes(mesh.triangles.size(), kLeaf)), {}};
  std::vector<VertexTriangle> records(mesh.triangles.size());
  std::vector<std::uint64_t> scratch(tree_scratch_bytes(mesh.triangles.size()) / 8);
  EXPECT_EQ(build_tree(mesh.view(), kLeaf, records, tree.nodes, std::as_writable_bytes(std::span(scratch)), tree.size),
            Status::kOk);
  tree.nodes.resize(tree.size.node_count);
  return tree;
}

BuildWork work_of(const LooseMesh& mesh, TreeOrder order = TreeOrder::kForAnyHit, const MeshLines& lines = {}) {
  return tree_build_work(mesh.view(), {kLeaf, order, built(mesh).nodes}, lines);
}

TEST(TreeBuildWork, RowOfTrianglesCountedByHand) {
  LooseMesh mesh;
  for (int i = 0; i < 20; ++i) mesh.add(Vec3(static_cast<float>(i), 0, 0), 0.5f);
  mesh.add(Vec3(3, 0, 0), 0.0f);  // dropped
  const Built tree = built(mesh);
  ASSERT_EQ(tree.size.node_count, 1u);
  const BuildWork work = work_of(mesh);
  EXPECT_EQ(work[BuildStep::kTreeOnce], 1u);
  EXPECT_EQ(work[BuildStep::kTreeVertexBound], 63u);
  EXPECT_EQ(work[BuildStep::kTreeTriangleCode], 21u);
  EXPECT_EQ(work[BuildStep::kTreeTriangleSurvey], 0u) << "of an image alone";
  EXPECT_EQ(work[BuildStep::kTreeDigitValue], 3u * 1024);
  EXPECT_EQ(work[BuildStep::kTreeKeySorted], 3u * 20);
  EXPECT_EQ(work[BuildStep::kTreeKeyScattered], 0u);
  EXPECT_EQ(work[BuildStep::kTreeLeafSplit], tree.nodes[0].child_count);
  EXPECT_EQ(work[BuildStep::kTreeNodeSplit], 0u);
  EXPECT_EQ(work[BuildStep::kTreeCrowd] + work[BuildStep::kTreeCrowdKey], 0u);
  EXPECT_EQ(work[BuildStep::kTreeTriangleWrite], 20u);
  EXPECT_EQ(work[BuildStep::kTreeTriangleArea], 20u);
  EXPECT_EQ(work[BuildStep::kTreeNodeWrite], 1u);
  EXPECT_EQ(work[BuildStep::kTreeNodeOrder], 1u);
  EXPECT_EQ(work[BuildStep::kTreeFarLine], 0u);
  EXPECT_EQ(work[BuildStep::kVertexCheck] + work[BuildStep::kBvhOnce] + work[BuildStep::kFarLine], 0u);

  const BuildWork by_number = work_of(mesh, TreeOrder::kByNumber);
  EXPECT_EQ(by_number[BuildStep::kTreeTriangleArea] + by_number[BuildStep::kTreeNodeOrder], 0u);
  EXPECT_EQ(by_number[BuildStep::kTreeTriangleWrite], 20u);
}

TEST(TreeBuildWork, NodesAboveOthersAreSplitAsSuch) {
  LooseMesh mesh;
  for (int i = 0; i < 400; ++i) mesh.add(Vec3(static_cast<float>(i % 20), static_cast<float>(i / 20), 0), 0.5f);
  const Built tree = built(mesh);
  ASSERT_EQ(tree.size.depth, 2u);
  const BuildWork work = work_of(mesh);
  EXPECT_EQ(work[BuildStep::kTreeNodeSplit], 1u);
  std::uint64_t leaves = 0;
  for (std::size_t i = 1; i < tree.nodes.size(); ++i) leaves += tree.nodes[i].child_count;
  EXPECT_EQ(work[BuildStep::kTreeLeafSplit], leaves);
  EXPECT_EQ(work[BuildStep::kTreeNodeWrite], tree.nodes.size());
}

TEST(TreeBuildWork, CrowdsAreThoseThatALeafDoesNotHold) {
  const auto crowd = [](int count, float step) {
    LooseMesh mesh;
    mesh.add(Vec3(1000, 1000, 1000), 1.0f);
    for (int i = 0; i < count; ++i) mesh.add(Vec3(step * static_cast<float>(i), 0, 0), 1e-3f);
    return work_of(mesh);
  };
  EXPECT_EQ(crowd(8, 1e-4f)[BuildStep::kTreeCrowd], 0u);
  const BuildWork few = crowd(24, 1e-4f);
  EXPECT_EQ(few[BuildStep::kTreeCrowd], 1u);
  EXPECT_EQ(few[BuildStep::kTreeCrowdKey], 0u) << "split by number";
  const BuildWork many = crowd(100, 1e-4f);
  EXPECT_EQ(many[BuildStep::kTreeCrowd], 1u);
  EXPECT_EQ(many[BuildStep::kTreeCrowdKey], 100u);
  EXPECT_EQ(many[BuildStep::kTreeDigitValue], 3u * 1024) << "sorted by small digits";
  EXPECT_EQ(crowd(2000, 1e-5f)[BuildStep::kTreeDigitValue], 2u * 3 * 1024);
  // All in one place: looked at, and then split by number.
  const BuildWork stacked = crowd(100, 0.0f);
  EXPECT_EQ(stacked[BuildStep::kTreeCrowd], 1u);
  EXPECT_EQ(stacked[BuildStep::kTreeCrowdKey], 100u);
}

TEST(TreeBuildWork, LargeMeshesAreSortedByLargeDigits) {
  LooseMesh mesh;
  for (int i = 0; i < 40'000; ++i) mesh.add(Vec3(static_cast<float>(i % 200), static_cast<float>(i / 200), 0), 0.5f);
  const BuildWork work = work_of(mesh, TreeOrder::kByNumber,
                                 {.vertices_in_order = 1000, .vertices_in_space = 100, .triangles_in_space = 10});
  EXPECT_EQ(work[BuildStep::kTreeKeySorted], 0u);
  EXPECT_EQ(work[BuildStep::kTreeKeyScattered], 2u * 40'000);
  EXPECT_EQ(work[BuildStep::kTreeDigitValue], 2u << 15);
  // Two digits of 40,000 keys over 640,000 bytes, of which the cache holds 524,288.
  EXPECT_EQ(work[BuildStep::kTreeFarLine], 1110u + std::uint64_t{80'000} * (640'000 - 524'288) / 640'000);
}

TEST(TreeBuildWork, ImageIsSurveyedAndCheckedToo) {
  LooseMesh mesh;
  for (int i = 0; i < 20; ++i) mesh.add(Vec3(static_cast<float>(i), 0, 0), 0.5f);
  const Built tree = built(mesh);
  const BuiltTree asked{kLeaf, TreeOrder::kByNumber, tree.nodes};
  const MeshLines lines{.vertices_in_order = 7};
  const BuildWork alone = tree_build_work(mesh.view(), asked, lines);
  const BuildWork image = tree_image_work(mesh.view(), asked, 12'800, lines);
  EXPECT_EQ(image[BuildStep::kTreeVertexBound], 2 * alone[BuildStep::kTreeVertexBound]);
  EXPECT_EQ(image[BuildStep::kTreeTriangleSurvey], 20u);
  EXPECT_EQ(image[BuildStep::kTreeCheckedLine], 100u);
  EXPECT_EQ(image[BuildStep::kTreeFarLine], alone[BuildStep::kTreeFarLine]);
  EXPECT_EQ(image[BuildStep::kTreeSurveyFarLine], 7u);
  EXPECT_EQ(image[BuildStep::kBuildOnce], 1u);
  EXPECT_EQ(image[BuildStep::kTreeTriangleCode], alone[BuildStep::kTreeTriangleCode]);
}

}  // namespace
}  // namespace gridiron::sim
