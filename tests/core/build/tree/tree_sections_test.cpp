// Sections of the tree: their place, size and contents in the image of a scene with effects.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/lattice.h>
#include <gridiron/build/tree/tree_builder.h>
#include <gridiron/build/tree/tree_sections.h>

#include "core/build/tree/tree_image.h"
#include "core/image/tree_oracle.h"

namespace gridiron::test {
namespace {

constexpr TriangleFormat kFormats[] = {TriangleFormat::kVertices, TriangleFormat::kLattice};

SectionEntry entry_at(const BuiltImage& built, std::uint32_t number) {
  return read_record<SectionEntry>(built.image.bytes(),
                                   built.view.header.section_table_offset_bytes + number * sizeof(SectionEntry));
}

TEST(TreeSections, AreTheLastOfAnImageWithEffects) {
  for (const TriangleFormat format : kFormats) {
    const BuiltImage built = build_tree_image(tree_scene(100), 4, format);
    ASSERT_FALSE(HasFailure());
    const TreeRecord& tree = built.view.tree;
    const std::uint32_t count = built.view.header.section_count;
    const SectionEntry record = entry_at(built, count - 3), triangles = entry_at(built, count - 2),
                       nodes = entry_at(built, count - 1);
    EXPECT_EQ(record.kind, 11u);
    EXPECT_EQ(record.element_bytes, 128u);
    EXPECT_EQ(record.element_count, 1u);
    EXPECT_EQ(record.offset_bytes, built.view.tree_offset_bytes);
    const SectionEntry before = entry_at(built, count - 4);
    EXPECT_EQ(record.offset_bytes, before.offset_bytes + before.section_bytes);
    EXPECT_EQ(triangles.kind, 13u);
    EXPECT_EQ(triangles.element_bytes, format == TriangleFormat::kLattice ? 24u : 48u);
    EXPECT_EQ(triangles.element_count, built.view.header.triangle_count - built.view.header.dropped_triangle_count);
    EXPECT_EQ(triangles.offset_bytes, record.offset_bytes + 128);
    EXPECT_EQ(triangles.offset_bytes, tree.triangles_offset_bytes);
    EXPECT_EQ(nodes.kind, 12u);
    EXPECT_EQ(nodes.element_bytes, 512u);
    EXPECT_EQ(nodes.element_count, tree.node_count);
    EXPECT_EQ(nodes.offset_bytes, triangles.offset_bytes + triangles.section_bytes);
    EXPECT_EQ(nodes.offset_bytes, tree.nodes_offset_bytes);
    EXPECT_EQ(nodes.section_bytes, 512u * tree.node_count);
    EXPECT_EQ(nodes.offset_bytes + nodes.section_bytes, built.view.header.image_bytes);
  }
}

TEST(TreeSections, HoldTheTreeOfTheBuilder) {
  const TestEffects scene = tree_scene(500);
  for (const TriangleFormat format : kFormats) {
    for (const std::uint32_t leaf_triangles : {1u, 3u, 8u, 16u}) {
      const BuiltImage built = build_tree_image(scene, leaf_triangles, format);
      ASSERT_FALSE(HasFailure());
      const TreeRecord& tree = built.view.tree;
      const std::uint64_t kept = built.view.header.triangle_count - built.view.header.dropped_triangle_count;
      std::vector<TreeNode> nodes(most_tree_nodes(kept, leaf_triangles));
      std::vector<VertexTriangle> vertices(kept);
      std::vector<LatticeTriangle> places(kept);
      std::vector<std::uint64_t> words(tree_scratch_bytes(scene.triangles.size()) / 8);
      const std::span<std::byte> scratch = std::as_writable_bytes(std::span(words));
      TreeSize size{};
      const bool is_lattice = format == TriangleFormat::kLattice;
      const LatticeMesh moved{{scene.vertices, built.view.grid.lattice}, scene.triangles};
      ASSERT_EQ(is_lattice ? build_tree(moved, leaf_triangles, places, nodes, scratch, size)
                           : build_tree(scene.mesh(), leaf_triangles, vertices, nodes, scratch, size),
                Status::kOk);
      EXPECT_EQ(tree.node_count, size.node_count);
      EXPECT_EQ(tree.triangle_count, kept);
      EXPECT_EQ(tree.depth, size.depth);
      EXPECT_EQ(tree.leaf_triangles, leaf_triangles);
      EXPECT_EQ(tree.triangle_format, static_cast<std::uint32_t>(format));
      const std::byte* const bytes = built.image.bytes().data();
      EXPECT_EQ(std::memcmp(bytes + tree.nodes_offset_bytes, nodes.data(), size.node_count * sizeof(TreeNode)), 0);
      const void* const records = is_lattice ? static_cast<const void*>(places.data()) : vertices.data();
      EXPECT_EQ(std::memcmp(bytes + tree.triangles_offset_bytes, records, kept * tree.triangle_bytes), 0);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(tree.bounds_minimum[axis], built.view.grid.bounds_minimum[axis]);
        EXPECT_EQ(tree.bounds_maximum[axis], built.view.grid.bounds_maximum[axis]);
        EXPECT_EQ(tree.lattice.origin[axis], built.view.grid.lattice.origin[axis]);
      }
      EXPECT_EQ(tree.lattice.step, built.view.grid.lattice.step);
      EXPECT_EQ(tree.lattice.step != 0.0f, is_lattice);
      EXPECT_STREQ(broken_tree(built.image.bytes(), built.view), nullptr);
    }
  }
}

TEST(TreeSections, SurfacesSayWhereTheirTrianglesStand) {
  const BuiltImage built = build_tree_image(tree_scene(100), 8);
  ASSERT_FALSE(HasFailure());
  std::uint32_t dropped = 0;
  for (std::uint32_t id = 0; id < 100; ++id) {
    const auto surface = read_record<SurfaceRecord>(
        built.image.bytes(), built.view.effects.surfaces_offset_bytes + id * sizeof(SurfaceRecord));
    if (id % 7 == 6) {
      EXPECT_EQ(surface.tree_place, kNoTriangle) << id;
      ++dropped;
      continue;
    }
    ASSERT_LT(surface.tree_place, built.view.tree.triangle_count) << id;
    const auto triangle = read_record<VertexTriangle>(
        built.image.bytes(), built.view.tree.triangles_offset_bytes + surface.tree_place * sizeof(VertexTriangle));
    EXPECT_EQ(triangle.triangle_id, id);
  }
  EXPECT_EQ(dropped, built.view.header.dropped_triangle_count);
}

TEST(TreeSections, AreTheSameBytesWhateverTheMemoryHeld) {
  for (const TriangleFormat format : kFormats) {
    const BuiltImage one = build_tree_image(tree_scene(300), 8, format, std::byte{0x00});
    const BuiltImage other = build_tree_image(tree_scene(300), 8, format, std::byte{0xFF});
    ASSERT_FALSE(HasFailure());
    EXPECT_TRUE(std::ranges::equal(one.image.bytes(), other.image.bytes()));
  }
}

TEST(TreeSections, OfOneTriangleAreOneNode) {
  const BuiltImage built = build_tree_image(tree_scene(1), 8);
  ASSERT_FALSE(HasFailure());
  EXPECT_EQ(built.view.tree.node_count, 1u);
  EXPECT_EQ(built.view.tree.depth, 1u);
  EXPECT_STREQ(broken_tree(built.image.bytes(), built.view), nullptr);
}

TEST(TreeSections, OfAnImageWithoutEffectsAreNone) {
  const BuiltImage built = build_image(tree_scene(100).mesh(), {.lambda = 0.1f, .leaf_triangles = 1});
  ASSERT_FALSE(HasFailure());
  EXPECT_EQ(built.view.header.section_count, 4u);
  EXPECT_EQ(built.view.tree_offset_bytes, 0u);
  EXPECT_EQ(built.view.tree.node_count, 0u);
  EXPECT_EQ(built.need.scratch_bytes, 0u);
}

// --- Memory -------------------------------------------------------------------------------------------------------

// What is counted has room for the most nodes; each byte less of it is refused before anything is written.
TEST(TreeMemory, IsWhatWasCountedOrRefused) {
  const TestEffects scene = tree_scene(2000);
  const EffectsView view = scene.view();
  for (const TriangleFormat format : kFormats) {
    const GridParameters parameters{.lambda = 0.1f, .format = format};
    GridNeed need{};
    ASSERT_EQ(count_scene_image(scene.mesh(), parameters, need, &view), Status::kOk);
    EXPECT_EQ(need.scratch_bytes, tree_scratch_bytes(2000));
    LineBuffer image(need.image_bytes + 4096, std::byte{0xAB});
    std::vector<std::uint64_t> words(need.scratch_bytes / 8);
    const std::span<std::byte> scratch = std::as_writable_bytes(std::span(words));
    const auto status = [&](std::uint64_t image_bytes, std::uint64_t scratch_bytes) {
      return build_scene_image(scene.mesh(), parameters, need, image.bytes().first(image_bytes),
                               scratch.first(scratch_bytes), &view);
    };
    EXPECT_EQ(status(need.image_bytes - 1, need.scratch_bytes), Status::kMemoryTooSmall);
    EXPECT_EQ(status(need.image_bytes, need.scratch_bytes - 1), Status::kMemoryTooSmall);
    EXPECT_TRUE(std::ranges::all_of(image.bytes(), [](std::byte byte) { return byte == std::byte{0xAB}; }));
    EXPECT_EQ(status(need.image_bytes, need.scratch_bytes), Status::kOk);
    const auto header = read_record<ImageHeader>(image.bytes(), 0);
    EXPECT_LT(header.image_bytes, need.image_bytes);
    for (std::uint64_t i = need.image_bytes; i < image.bytes().size(); ++i) {
      ASSERT_EQ(image.bytes()[i], std::byte{0xAB}) << "written behind the image";
    }
  }
}

TEST(TreeMemory, FitsWithTheMostNodesThatThereMayBe) {
  const TestEffects scene = tree_scene(2000);
  const EffectsView view = scene.view();
  const GridParameters parameters{.lambda = 4.0f};
  GridNeed need{};
  ASSERT_EQ(count_scene_image(scene.mesh(), parameters, need, &view), Status::kOk);
  GridNeed fitting{};
  ASSERT_EQ(fit_scene_image(scene.mesh(), parameters, need.image_bytes, fitting, &view), Status::kOk);
  EXPECT_EQ(fitting.grid.lambda, 4.0f);
  ASSERT_EQ(fit_scene_image(scene.mesh(), parameters, need.image_bytes - 1, fitting, &view), Status::kOk);
  EXPECT_EQ(fitting.grid.lambda, 2.0f);
  EXPECT_EQ(count_scene_image(scene.mesh(), parameters, fitting, &view, need.image_bytes - 1), Status::kMemoryTooSmall);
}

// --- Errors -------------------------------------------------------------------------------------------------------

TEST(TreeErrors, LeavesHaveOneToSixteenTriangles) {
  const TestEffects scene = tree_scene(20);
  const EffectsView view = scene.view();
  for (const EffectsView* effects : {&view, static_cast<const EffectsView*>(nullptr)}) {
    for (const std::uint32_t leaf_triangles : {0u, 1u, 16u, 17u, ~0u}) {
      const GridParameters parameters{.leaf_triangles = leaf_triangles};
      const bool is_good = leaf_triangles == 1 || leaf_triangles == 16;
      GridNeed need{};
      EXPECT_EQ(count_scene_image(scene.mesh(), parameters, need, effects),
                is_good ? Status::kOk : Status::kBadParameter);
    }
  }
}

TEST(TreeErrors, MoreTrianglesThanATreeHoldsAreRefusedUnread) {
  const UVec3 one(0, 0, 0);
  const Vec3 vertex(0, 0, 0);
  const MeshView mesh{{&vertex, 1}, {&one, std::size_t{kMaxTreeTriangles} + 1}};
  const TestEffects scene = tree_scene(1);
  const EffectsView view = scene.view();
  GridNeed need{};
  EXPECT_EQ(count_scene_image(mesh, {}, need, &view), Status::kTooManyTriangles);
}

TEST(TreeErrors, AnotherMeshThanTheCountedOne) {
  TestEffects scene = tree_scene(100);
  const EffectsView view = scene.view();
  const GridParameters parameters{.lambda = 0.1f};
  GridNeed need{};
  ASSERT_EQ(count_scene_image(scene.mesh(), parameters, need, &view), Status::kOk);
  LineBuffer image(need.image_bytes);
  std::vector<std::uint64_t> words(need.scratch_bytes / 8);
  const auto status = [&] {
    return build_scene_image(scene.mesh(), parameters, need, image.bytes(), std::as_writable_bytes(std::span(words)),
                             &view);
  };
  EXPECT_EQ(status(), Status::kOk);
  const Vec3 corner = scene.vertices[0];
  scene.vertices[0] = scene.vertices[1];
  EXPECT_EQ(status(), Status::kBadParameter) << "one more has no area";
  scene.vertices[0] = corner;
  scene.vertices[18] += Vec3(0.5f, 0.25f, 0.125f);
  scene.vertices[19] += Vec3(0.125f, 0.25f, 0.5f);
  EXPECT_EQ(status(), Status::kBadParameter) << "one less";
}

}  // namespace
}  // namespace gridiron::test
