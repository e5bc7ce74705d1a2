// The tree of an image: every hostile word is refused or harmless. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/tree/tree_box.h>

#include "core/build/tree/tree_image.h"
#include "core/image/image_damage.h"
#include "core/image/tree_oracle.h"

namespace gridiron::test {
namespace {

constexpr std::uint32_t kLeafTriangles = 2;

// 1,286 triangles that are kept: a root, a level of nodes and some below it.
const BuiltImage& whole() {
  static const BuiltImage built = build_tree_image(tree_scene(1500), kLeafTriangles);
  return built;
}

std::uint64_t node_place(const SceneImageView& view, std::uint32_t node) {
  return view.tree.nodes_offset_bytes + node * sizeof(TreeNode);
}

std::uint64_t triangle_place(const SceneImageView& view, std::uint32_t triangle) {
  return view.tree.triangles_offset_bytes + triangle * std::uint64_t{view.tree.triangle_bytes};
}

// Where the entry of one of the tree's sections stands, which are the last.
std::uint64_t entry_place(const SceneImageView& view, SectionKind kind) {
  const std::uint32_t behind = kind == SectionKind::kTree ? 3 : kind == SectionKind::kTreeTriangles ? 2 : 1;
  return kTableOffset + (view.header.section_count - behind) * sizeof(SectionEntry);
}

template <class Holds>
std::uint32_t node_that(const Holds& holds) {
  const BuiltImage& built = whole();
  for (std::uint32_t i = 1; i < built.view.tree.node_count; ++i) {
    if (holds(read_record<TreeNode>(built.image.bytes(), node_place(built.view, i)))) return i;
  }
  ADD_FAILURE() << "there is no such node";
  return 0;
}

// A node with room for another child, and one whose first two children are leaves.
std::uint32_t short_node() {
  return node_that([](const TreeNode& node) { return node.child_count < kTreeWidth; });
}
std::uint32_t leafy_node() {
  return node_that([](const TreeNode& node) {
    return node.children[0].is_leaf() && node.children[1].is_leaf() && node.children[1].count() > 1;
  });
}

TreeChild moved(TreeChild leaf, std::int32_t by) {
  return TreeChild::leaf(leaf.first() + static_cast<std::uint32_t>(by), leaf.count());
}

void exchange(TreeNode& node, std::uint32_t a, std::uint32_t b) {
  std::swap(node.children[a], node.children[b]);
  for (int axis = 0; axis < 3; ++axis) {
    std::swap(node.low[axis][a], node.low[axis][b]);
    std::swap(node.high[axis][a], node.high[axis][b]);
  }
}

TEST(Trees, OfTheTestHaveLevels) {
  const TreeRecord& tree = whole().view.tree;
  EXPECT_GE(tree.depth, 3u);
  EXPECT_EQ(tree.triangle_count, 1286u);
  const auto root = read_record<TreeNode>(whole().image.bytes(), node_place(whole().view, 0));
  EXPECT_FALSE(root.children[2].is_leaf());
  EXPECT_FALSE(root.children[3].is_leaf());
}

TEST(Trees, PassWithLeavesOfEverySize) {
  for (const TriangleFormat format : {TriangleFormat::kVertices, TriangleFormat::kLattice}) {
    for (const std::uint32_t triangles : {1u, 2u, 9u, 17u, 130u, 600u}) {
      for (std::uint32_t leaf_triangles = 1; leaf_triangles <= kMaxTreeLeaf; ++leaf_triangles) {
        const BuiltImage built = build_tree_image(tree_scene(triangles), leaf_triangles, format);
        ASSERT_FALSE(HasFailure()) << triangles << " triangles, leaves of " << leaf_triangles;
        ASSERT_STREQ(broken_tree(built.image.bytes(), built.view), nullptr);
      }
    }
  }
}

// Triangles in one place are split by their number.
TEST(Trees, PassWithTrianglesInOnePlace) {
  TestEffects scene = tree_scene(0);
  scene.vertices = {{0, 0, 0}, {1, 0, -0.0f}, {0, 1, 0}, {2, 2, 2}, {2, 3, 2}, {3, 2, 2}};
  scene.triangles.assign(3000, UVec3(0, 1, 2));
  scene.triangles.emplace_back(3, 4, 5);
  scene.triangle_materials.assign(scene.triangles.size(), 0);
  const BuiltImage built = build_tree_image(scene, 1);
  ASSERT_FALSE(HasFailure());
  EXPECT_STREQ(broken_tree(built.image.bytes(), built.view), nullptr);
}

TEST(Trees, PassAtTheLimitsOfCoordinates) {
  for (const float scale : {0x1p119f, 0x1p-100f, 1.0f}) {
    TestEffects scene = tree_scene(60);
    for (Vec3& vertex : scene.vertices) vertex = scale * (vertex - Vec3(0.5f));
    const BuiltImage built = build_tree_image(scene, 2);
    ASSERT_FALSE(HasFailure()) << scale;
    EXPECT_STREQ(broken_tree(built.image.bytes(), built.view), nullptr);
  }
}

// --- Errors by name -----------------------------------------------------------------------------------------------

#define TREE_DAMAGE(label, member, statement) \
  DAMAGE_IN(label, "tree." #member, TreeRecord, member, view.tree_offset_bytes, statement)
#define ENTRY_DAMAGE(label, kind, member, statement) \
  DAMAGE_IN(label, "section." #member, SectionEntry, member, entry_place(view, kind), statement)
#define NODE_DAMAGE(label, index, member, statement) \
  DAMAGE_IN(label, "node." #member, TreeNode, member, node_place(view, index), statement)
#define TRIANGLE_DAMAGE(label, index, member, statement) \
  DAMAGE_IN(label, "tree_triangle." #member, VertexTriangle, member, triangle_place(view, index), statement)

const Damage kDamages[] = {
    TREE_DAMAGE("no_nodes", node_count, r.node_count = 0),
    TREE_DAMAGE("no_triangles", triangle_count, r.triangle_count = 0),
    TREE_DAMAGE("more_triangles_than_are_kept", triangle_count, r.triangle_count += 1),
    TREE_DAMAGE("more_triangles_than_a_tree_holds", triangle_count, r.triangle_count = kMaxTreeTriangles + 1),
    TREE_DAMAGE("no_depth", depth, r.depth = 0),
    TREE_DAMAGE("too_deep", depth, r.depth = kMaxTreeDepth + 1),
    TREE_DAMAGE("less_deep", depth, r.depth -= 1),
    TREE_DAMAGE("deeper", depth, r.depth += 1),
    TREE_DAMAGE("leaves_of_none", leaf_triangles, r.leaf_triangles = 0),
    TREE_DAMAGE("leaves_of_seventeen", leaf_triangles, r.leaf_triangles = kMaxTreeLeaf + 1),
    TREE_DAMAGE("format_of_projections", triangle_format, r.triangle_format = 2),
    TREE_DAMAGE("format_that_is_not_the_grids", triangle_format,
                {
                  r.triangle_format = 3;
                  r.triangle_bytes = 24;
                }),
    TREE_DAMAGE("bytes_of_another_format", triangle_bytes, r.triangle_bytes = 24),
    TREE_DAMAGE("nodes_elsewhere", nodes_offset_bytes, r.nodes_offset_bytes += 512),
    TREE_DAMAGE("nodes_nowhere", nodes_offset_bytes, r.nodes_offset_bytes = 0),
    TREE_DAMAGE("triangles_elsewhere", triangles_offset_bytes, r.triangles_offset_bytes = ~std::uint64_t{127}),
    TREE_DAMAGE("bounds_below", bounds_minimum, r.bounds_minimum[2] *= 0.5f),
    TREE_DAMAGE("bounds_nan", bounds_maximum, r.bounds_maximum[0] = kNan),
    TREE_DAMAGE("lattice_of_vertices", lattice, r.lattice.step = 1.0f),
    TREE_DAMAGE("lattice_of_minus_zero", lattice, r.lattice.origin[2] = -0.0f),
    TREE_DAMAGE("tree_reserved", reserved, r.reserved[11] = 1),
    ENTRY_DAMAGE("tree_bytes", SectionKind::kTree, element_bytes, r.element_bytes = 64),
    ENTRY_DAMAGE("tree_twice", SectionKind::kTree, element_count, r.element_count = 0),
    ENTRY_DAMAGE("fewer_triangles", SectionKind::kTreeTriangles, element_count, r.element_count -= 1),
    ENTRY_DAMAGE("triangles_of_other_bytes", SectionKind::kTreeTriangles, element_bytes, r.element_bytes = 24),
    ENTRY_DAMAGE("fewer_nodes", SectionKind::kTreeNodes, element_count, r.element_count -= 1),
    ENTRY_DAMAGE("nodes_of_other_bytes", SectionKind::kTreeNodes, element_bytes, r.element_bytes = 256),

    NODE_DAMAGE("no_children", 0, child_count, r.child_count = 0),
    NODE_DAMAGE("seventeen_children", 0, child_count, r.child_count = 17),
    NODE_DAMAGE("one_child", short_node(), child_count, r.child_count = 1),
    NODE_DAMAGE("fewer_children_with_nodes_among_them", 0, children, r.child_count = 15),
    NODE_DAMAGE("children_that_are_left_out", short_node(), children, r.child_count -= 1),
    NODE_DAMAGE("itself", 0, children, r.children[2] = TreeChild::node(0)),
    NODE_DAMAGE("a_node_before", short_node(), children, r.children[0] = TreeChild::node(1)),
    NODE_DAMAGE("a_node_beyond", 0, children, r.children[2] = TreeChild::node(view.tree.node_count)),
    NODE_DAMAGE("a_node_far_beyond", 0, children, r.children[2] = TreeChild::node(TreeChild::kLeaf - 1)),
    NODE_DAMAGE("a_node_twice", 0, children, r.children[3] = r.children[2]),
    NODE_DAMAGE("nodes_out_of_order", 0, children, exchange(r, 2, 3)),
    NODE_DAMAGE("a_node_left_out", 0, children, r.children[2] = TreeChild::leaf(0, 1)),
    NODE_DAMAGE("a_leaf_too_large", leafy_node(), children,
                r.children[0] = TreeChild::leaf(r.children[0].first(), kLeafTriangles + 1)),
    NODE_DAMAGE("a_leaf_beyond", leafy_node(), children, r.children[0] = TreeChild::leaf(view.tree.triangle_count, 1)),
    NODE_DAMAGE("a_leaf_that_ends_beyond", leafy_node(), children,
                r.children[0] = TreeChild::leaf(view.tree.triangle_count - 1, 2)),
    NODE_DAMAGE("a_leaf_of_the_last_records", leafy_node(), children,
                r.children[1] = TreeChild::leaf(kMaxTreeTriangles - 1, 1)),
    NODE_DAMAGE("a_leaf_that_overlaps", leafy_node(), children, r.children[1] = moved(r.children[1], -1)),
    NODE_DAMAGE("a_leaf_with_a_gap_before_it", leafy_node(), children, r.children[1] = moved(r.children[1], 1)),
    NODE_DAMAGE("a_leaf_without_its_first_record", leafy_node(), children,
                r.children[1] = TreeChild::leaf(r.children[1].first() + 1, r.children[1].count() - 1)),
    NODE_DAMAGE("leaves_out_of_order", leafy_node(), children, exchange(r, 0, 1)),
    NODE_DAMAGE("a_child_that_is_not_there", short_node(), children, r.children[15] = TreeChild::leaf(0, 1)),
    NODE_DAMAGE("order_with_one_twice", 0, order, r.order = r.order >> 4 << 4 | (r.order >> 4 & 15)),
    NODE_DAMAGE("order_of_none", 0, order, r.order = 0),
    NODE_DAMAGE("order_with_one_that_is_not_there", short_node(), order, r.order = r.order << 4 | r.order >> 60),
    NODE_DAMAGE("node_reserved", short_node(), reserved, r.reserved[12] = 1),
    NODE_DAMAGE("box_too_small", leafy_node(), low, r.low[1][0] = std::nextafter(r.low[1][0], 9.0f)),
    NODE_DAMAGE("box_too_large", leafy_node(), low, r.low[2][1] = std::nextafter(r.low[2][1], -9.0f)),
    NODE_DAMAGE("box_nan", leafy_node(), high, r.high[0][1] = kNan),
    NODE_DAMAGE("box_infinite", leafy_node(), high, r.high[2][0] = kInfinity),
    NODE_DAMAGE("box_of_a_node_too_large", 0, high, r.high[0][2] = std::nextafter(r.high[0][2], 9.0f)),
    NODE_DAMAGE("box_of_a_node_too_small", 0, low, r.low[0][2] = std::nextafter(r.low[0][2], 9.0f)),
    NODE_DAMAGE("box_of_no_child", short_node(), low, r.low[1][15] = 0.0f),
    NODE_DAMAGE("box_of_no_child_infinite", short_node(), high, r.high[1][15] = -kInfinity),

    TRIANGLE_DAMAGE("corner_nan", 3, v, r.v[2][1] = kNan),
    TRIANGLE_DAMAGE("corner_moved", 3, v, r.v[1][0] = std::nextafter(r.v[1][0], 9.0f)),
    TRIANGLE_DAMAGE("id_of_another", 3, v, r.triangle_id = r.triangle_id == 0 ? 1 : 0),
    TRIANGLE_DAMAGE("id_beyond", 3, triangle_id, r.triangle_id = view.header.triangle_count),
    TRIANGLE_DAMAGE("id_far_beyond", 3, triangle_id, r.triangle_id = ~0u),
    TRIANGLE_DAMAGE("triangle_reserved", 3, reserved, r.reserved[1] = 1),
    TRIANGLE_DAMAGE("triangle_of_another_place", 3, triangle_id,
                    r = read_record<VertexTriangle>(whole().image.bytes(), triangle_place(view, 2))),
    TRIANGLE_DAMAGE("dropped_triangle", 3, triangle_id,
                    {
                      const auto surface = read_record<SurfaceRecord>(
                          whole().image.bytes(), view.effects.surfaces_offset_bytes + 6 * sizeof(SurfaceRecord));
                      std::memcpy(r.v, surface.v, sizeof r.v);
                      r.triangle_id = 6;
                    }),
};

class Damages : public ::testing::TestWithParam<Damage> {};

TEST_P(Damages, AreNamedWithTheirPlace) {
  expect_named(GetParam(), whole());
}
INSTANTIATE_TEST_SUITE_P(All, Damages, ::testing::ValuesIn(kDamages), [](const auto& test) { return test.param.name; });

// --- Errors that are somewhere else --------------------------------------------------------------------------------

TEST(Trees, NumbersOfNodesFollowFromTheChildren) {
  BuiltImage built = whole();
  edit<TreeRecord>(built.image, built.view.tree_offset_bytes, [](TreeRecord& tree) { --tree.node_count; });
  expect_refused(built.image, "section.element_count", entry_place(built.view, SectionKind::kTreeNodes) + 16);
  edit<SectionEntry>(built.image, entry_place(built.view, SectionKind::kTreeNodes),
                     [](SectionEntry& e) { --e.element_count; });
  expect_refused(built.image, "node.children", {}, "one that is named is not there");
}

// One more node, of which no other knows.
TEST(Trees, NodesThatNoneNamesAreRefused) {
  const BuiltImage& built = whole();
  const std::size_t size = built.image.bytes().size();
  LineBuffer image(size + sizeof(TreeNode));
  std::memcpy(image.bytes().data(), built.image.bytes().data(), size);
  std::memcpy(image.bytes().data() + size, built.image.bytes().data() + size - sizeof(TreeNode), sizeof(TreeNode));
  edit<ImageHeader>(image, 0, [](ImageHeader& header) { header.image_bytes += sizeof(TreeNode); });
  edit<TreeRecord>(image, built.view.tree_offset_bytes, [](TreeRecord& tree) { ++tree.node_count; });
  edit<SectionEntry>(image, entry_place(built.view, SectionKind::kTreeNodes), [](SectionEntry& entry) {
    ++entry.element_count;
    entry.section_bytes += sizeof(TreeNode);
  });
  expect_refused(image, "tree.node_count", built.view.tree_offset_bytes + offsetof(TreeRecord, node_count));
}

TEST(Trees, LeavesAreAsLargeAsTheRecordSays) {
  for (const std::uint32_t leaf_triangles : {kLeafTriangles - 1, kLeafTriangles + 1}) {
    BuiltImage built = whole();
    edit<TreeRecord>(built.image, built.view.tree_offset_bytes,
                     [&](TreeRecord& tree) { tree.leaf_triangles = leaf_triangles; });
    expect_refused(built.image, "node.children", {}, "leaves of " + std::to_string(leaf_triangles));
  }
}

// A root that splits what would fit a leaf.
TEST(Trees, ARootHasOneChildIfItsTrianglesFitALeaf) {
  BuiltImage built = build_tree_image(tree_scene(3), 2);
  ASSERT_FALSE(HasFailure());
  edit<TreeRecord>(built.image, built.view.tree_offset_bytes, [](TreeRecord& tree) { tree.leaf_triangles = 3; });
  expect_refused(built.image, "node.child_count", built.view.tree.nodes_offset_bytes + offsetof(TreeNode, child_count));
}

// Gives a node's first child the box of these corners, grown.
void set_first_box(TreeNode& node, const std::vector<Vec3>& corners, float margin) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax_element(corners.begin(), corners.end(),
                                                 [axis](const Vec3& a, const Vec3& b) { return a[axis] < b[axis]; });
    node.low[axis][0] = grown_low((*low)[axis], margin);
    node.high[axis][0] = grown_high((*high)[axis], margin);
  }
}

TEST(Trees, LeavesEndWithTheLastTriangle) {
  BuiltImage built = build_tree_image(tree_scene(6), 8);
  ASSERT_FALSE(HasFailure());
  edit<TreeNode>(built.image, built.view.tree.nodes_offset_bytes, [&](TreeNode& node) {
    node.children[0] = TreeChild::leaf(0, 5);
    std::vector<Vec3> corners;
    for (std::uint32_t i = 0; i < 5; ++i) {
      const auto r = read_record<VertexTriangle>(built.image.bytes(), triangle_place(built.view, i));
      for (const auto& v : r.v) corners.emplace_back(v[0], v[1], v[2]);
    }
    set_first_box(node, corners, tree_margin_of(built.view.tree.bounds_minimum, built.view.tree.bounds_maximum));
  });
  expect_refused(built.image, "node.children", built.view.tree.nodes_offset_bytes + offsetof(TreeNode, children));
}

TEST(Trees, OfALatticeHaveItsRecords) {
  const BuiltImage whole_lattice = build_tree_image(tree_scene(50), 4, TriangleFormat::kLattice);
  ASSERT_FALSE(HasFailure());
  const std::uint64_t place = triangle_place(whole_lattice.view, 5);
  BuiltImage built = whole_lattice;
  edit<LatticeTriangle>(built.image, place, [](LatticeTriangle& r) { r.v[2][1] ^= 1; });
  expect_refused(built.image, "tree_triangle.v", place);
  built = whole_lattice;
  edit<LatticeTriangle>(built.image, place, [](LatticeTriangle& r) { r.reserved = 1; });
  expect_refused(built.image, "tree_triangle.reserved", place + offsetof(LatticeTriangle, reserved));
  built = whole_lattice;
  edit<TreeRecord>(built.image, built.view.tree_offset_bytes, [](TreeRecord& tree) { tree.lattice.step *= 2.0f; });
  expect_refused(built.image, "tree.lattice", built.view.tree_offset_bytes + offsetof(TreeRecord, lattice));
}

// --- Without a grid ------------------------------------------------------------------------------------------------

// 86 triangles that are kept; without effects too.
BuiltImage alone(bool has_effects, TriangleFormat format = TriangleFormat::kVertices) {
  const TestEffects scene = tree_scene(100);
  const EffectsView view = scene.view();
  const GridParameters parameters{.format = format, .leaf_triangles = 2, .has_tree = true, .has_grid = false};
  return build_image(scene.mesh(), parameters, std::byte{0xCD}, has_effects ? &view : nullptr);
}

const Damage kAloneDamages[] = {
    TREE_DAMAGE("bounds_too_large", bounds_maximum, r.bounds_maximum[1] = std::nextafter(r.bounds_maximum[1], 9.0f)),
    TREE_DAMAGE("bounds_of_minus_zero", bounds_minimum, r.bounds_minimum[0] = -0.0f),
    TREE_DAMAGE("bounds_nan", bounds_minimum, r.bounds_minimum[0] = kNan),
    TREE_DAMAGE("bounds_infinite", bounds_maximum, r.bounds_maximum[0] = kInfinity),
    TREE_DAMAGE("bounds_beyond_the_limit", bounds_minimum, r.bounds_minimum[0] = -0x1.000002p120f),
    TREE_DAMAGE("bounds_the_wrong_way_round", bounds_maximum, r.bounds_maximum[1] = r.bounds_minimum[1] - 1.0f),
    TREE_DAMAGE("lattice_of_vertices", lattice, r.lattice.step = 1.0f),
    TREE_DAMAGE("format_of_projections", triangle_format, r.triangle_format = 2),
    TREE_DAMAGE("format_of_none", triangle_format, r.triangle_format = 0),
    TREE_DAMAGE("more_triangles_than_are_kept", triangle_count, r.triangle_count += 1),
    NODE_DAMAGE("box_too_small", 0, low, r.low[1][0] = std::nextafter(r.low[1][0], 9.0f)),
    TRIANGLE_DAMAGE("id_beyond", 3, triangle_id, r.triangle_id = view.header.triangle_count),
    TRIANGLE_DAMAGE("corner_nan", 3, v, r.v[2][1] = kNan),
    TRIANGLE_DAMAGE("corner_outside", 3, v, r.v[2][1] = 2.0f),
    TRIANGLE_DAMAGE("triangle_without_area", 3, v, std::memcpy(r.v[1], r.v[0], sizeof r.v[0])),
    TRIANGLE_DAMAGE("triangle_reserved", 3, reserved, r.reserved[0] = 1),
    ENTRY_DAMAGE("tree_of_no_kind", SectionKind::kTree, kind, r.kind = 1000),
};

class AloneDamages : public ::testing::TestWithParam<Damage> {};

TEST_P(AloneDamages, AreNamedWithTheirPlace) {
  for (const bool has_effects : {false, true}) {
    BuiltImage built = alone(has_effects);
    ASSERT_FALSE(::testing::Test::HasFailure());
    const std::uint64_t place = GetParam().apply(built.image, built.view);
    const bool is_tree_gone = std::string_view(GetParam().name) == "tree_of_no_kind";
    // Nothing is left that eye rays can be traced through.
    expect_refused(built.image, is_tree_gone ? "header.section_count" : GetParam().field,
                   is_tree_gone ? offsetof(ImageHeader, section_count) : place, has_effects ? "with effects" : "");
  }
}
INSTANTIATE_TEST_SUITE_P(All, AloneDamages, ::testing::ValuesIn(kAloneDamages),
                         [](const auto& test) { return test.param.name; });

// Without effects a corner outside the bounds is found first.
TEST(TreesAlone, HaveBoundsThatHoldAllTriangles) {
  for (const bool has_effects : {false, true}) {
    BuiltImage built = alone(has_effects);
    edit<TreeRecord>(built.image, built.view.tree_offset_bytes,
                     [](TreeRecord& r) { r.bounds_minimum[2] = std::nextafter(r.bounds_minimum[2], 9.0f); });
    expect_refused(built.image, has_effects ? "tree.bounds_minimum" : "tree_triangle.v");
  }
}

// The only triangle of a tree alone, at (-far, -1, -1), (0, -1, -1) and (-1, 0, 0), as if it had been built so.
BuiltImage lone_triangle(float far) {
  TestEffects scene;
  scene.vertices = {{-1, -1, -1}, {0, -1, -1}, {-1, 0, 0}};
  scene.triangles = {{0, 1, 2}};
  BuiltImage built = build_image(scene.mesh(), {.has_tree = true, .has_grid = false});
  const SceneImageView& view = built.view;
  edit<VertexTriangle>(built.image, view.tree.triangles_offset_bytes, [far](VertexTriangle& r) { r.v[0][0] = -far; });
  edit<TreeRecord>(built.image, view.tree_offset_bytes, [far](TreeRecord& r) { r.bounds_minimum[0] = -far; });
  edit<TreeNode>(built.image, view.tree.nodes_offset_bytes, [far](TreeNode& node) {
    set_first_box(node, {{-far, -1, -1}, {0, -1, -1}, {-1, 0, 0}}, tree_margin(far));
  });
  renew_check_value(built.image);
  return built;
}

// Coordinates have limits that no other rule of the tree knows.
TEST(TreesAlone, StayWithinTheLimitsOfCoordinates) {
  EXPECT_EQ(open_image(lone_triangle(1.0f).image.bytes()).status, Status::kOk);
  EXPECT_EQ(open_image(lone_triangle(kCoordinateLimit).image.bytes()).status, Status::kOk);
  expect_refused(lone_triangle(std::nextafter(kCoordinateLimit, kInfinity)).image, "tree.bounds_minimum");
  for (int axis = 1; axis < 3; ++axis) {
    BuiltImage built = lone_triangle(1.0f);
    edit<TreeRecord>(built.image, built.view.tree_offset_bytes,
                     [axis](TreeRecord& r) { r.bounds_maximum[axis] = -0.0f; });
    expect_refused(built.image, "tree.bounds_maximum");
  }
}

// A lattice that is not beside a grid's.
TEST(TreesAlone, HaveALatticeOfFloats) {
  struct Case {
    const char* field;
    std::function<void(Lattice&)> damage;
  };
  const Case cases[] = {
      {"tree.lattice.step", [](Lattice& l) { l.step = 0.0f; }},
      {"tree.lattice.step", [](Lattice& l) { l.step = kNan; }},
      {"tree.lattice.step", [](Lattice& l) { l.step *= 1.5f; }},
      {"tree.lattice.step", [](Lattice& l) { l.step = -l.step; }},
      {"tree.lattice.step", [](Lattice& l) { l.step = 0x1p121f; }},
      {"tree.lattice.origin", [](Lattice& l) { l.origin[1] = -0.0f; }},
      {"tree.lattice.origin", [](Lattice& l) { l.origin[2] = kNan; }},
      {"tree.lattice.origin", [](Lattice& l) { l.origin[2] += 0.5f * l.step; }},
      {"tree.lattice.origin", [](Lattice& l) { l.origin[0] = 0x1p120f; }},
  };
  for (const bool has_effects : {false, true}) {
    for (const Case& c : cases) {
      BuiltImage built = alone(has_effects, TriangleFormat::kLattice);
      edit<TreeRecord>(built.image, built.view.tree_offset_bytes, [&c](TreeRecord& r) { c.damage(r.lattice); });
      expect_refused(built.image, c.field, {}, has_effects ? "with effects" : "");
    }
    BuiltImage built = alone(has_effects, TriangleFormat::kLattice);
    edit<TreeRecord>(built.image, built.view.tree_offset_bytes, [](TreeRecord& r) { r.lattice.step *= 0.5f; });
    expect_refused(built.image, has_effects ? "surface.v" : "tree_triangle.v");
  }
}

// A grid has all of its sections. Any one or three of them are refused, as is a tree that is left without its own.
TEST(TreesAlone, AGridIsWholeOrNotThere) {
  const TestEffects scene = tree_scene(50);
  const GridParameters parameters{.macro_width = 2, .has_tree = true};
  const BuiltImage both = build_image(scene.mesh(), parameters);
  ASSERT_FALSE(HasFailure());
  for (std::uint32_t kept = 0; kept < 16; ++kept) {
    BuiltImage built = both;
    for (std::uint32_t i = 0; i < 4; ++i) {
      if ((kept >> i & 1u) != 0) continue;
      edit<SectionEntry>(built.image, kTableOffset + i * sizeof(SectionEntry), [](SectionEntry& e) { e.kind += 1000; });
    }
    if (kept != 0 && kept != 15) {
      expect_refused(built.image, "header.section_count", offsetof(ImageHeader, section_count));
      continue;
    }
    renew_check_value(built.image);
    const OpenedImage opened = open_image(built.image.bytes());
    EXPECT_EQ(opened.status, Status::kOk);
    EXPECT_EQ(opened.view.has_grid, kept == 15);
    EXPECT_STREQ(broken_tree(built.image.bytes(), opened.view), nullptr);
  }
}

// Each bit of each word of the tree of an image without grid and effects.
TEST(TreesAlone, WordsThatAreChangedAreRefusedOrHarmless) {
  for (const TriangleFormat format : {TriangleFormat::kVertices, TriangleFormat::kLattice}) {
    BuiltImage built = alone(false, format);
    ASSERT_FALSE(HasFailure());
    const std::span<std::byte> bytes = built.image.bytes();
    std::uint64_t refused = 0, opened = 0;
    for (std::uint64_t at = kTableOffset; at < bytes.size(); at += 4) {
      const auto word = read_record<std::uint32_t>(bytes, at);
      for (std::uint32_t i = 0; i < 34; ++i) {
        const std::uint32_t changed = i < 32 ? word ^ (1u << i) : i == 32 ? 0x7FC00000u : 0xFFFFFFFFu;
        std::memcpy(bytes.data() + at, &changed, sizeof changed);
        renew_check_value(built.image);
        const OpenedImage image = open_image(bytes);
        (image.status == Status::kOk ? opened : refused) += 1;
        if (image.status != Status::kOk) continue;
        ASSERT_STREQ(broken_tree(bytes, image.view), nullptr) << "word at " << at << ", " << std::hex << changed;
      }
      std::memcpy(bytes.data() + at, &word, sizeof word);
    }
    EXPECT_GT(refused, 5 * opened);
    EXPECT_GT(opened, 10u);
  }
}

// --- Every word -----------------------------------------------------------------------------------------------------

// Each bit of each word is flipped, and each word is set to the worst values for floats, counts and children.
TEST(Trees, WordsThatAreChangedAreRefusedOrHarmless) {
  for (const TriangleFormat format : {TriangleFormat::kVertices, TriangleFormat::kLattice}) {
    BuiltImage built = build_tree_image(tree_scene(30), 1, format);
    ASSERT_FALSE(HasFailure());
    ASSERT_GE(built.view.tree.depth, 2u);
    const std::span<std::byte> bytes = built.image.bytes();
    const std::uint32_t worst[] = {0u,          1u,          0x7F800000u, 0xFF800000u, 0x7FC00000u, 0xFFFFFFFFu,
                                   0x7F7FFFFFu, 0x80000000u, 0x80000001u, 0x3F800001u, 16u};
    std::uint64_t refused = 0;
    for (std::uint64_t at = built.view.tree_offset_bytes; at < bytes.size(); at += 4) {
      const auto word = read_record<std::uint32_t>(bytes, at);
      for (std::uint32_t i = 0; i < 32 + std::size(worst); ++i) {
        const std::uint32_t changed = i < 32 ? word ^ (1u << i) : worst[i - 32];
        if (changed == word) continue;
        std::memcpy(bytes.data() + at, &changed, sizeof changed);
        renew_check_value(built.image);
        const OpenedImage image = open_image(bytes);
        refused += image.status != Status::kOk ? 1 : 0;
        if (image.status == Status::kOk) {
          ASSERT_STREQ(broken_tree(bytes, image.view), nullptr) << "word at " << at << ", " << std::hex << changed;
          ADD_FAILURE() << "one word cannot be another tree: at " << at << ", " << std::hex << changed;
        }
      }
      std::memcpy(bytes.data() + at, &word, sizeof word);
    }
    EXPECT_GT(refused, 10'000u);
  }
}

// --- Layout ---------------------------------------------------------------------------------------------------------

// The offsets that core/SPEC.md prints.
TEST(TreeLayout, FieldsStandWhereTheSpecificationSays) {
  EXPECT_EQ(offsetof(TreeRecord, leaf_triangles), 12u);
  EXPECT_EQ(offsetof(TreeRecord, triangle_bytes), 20u);
  EXPECT_EQ(offsetof(TreeRecord, nodes_offset_bytes), 24u);
  EXPECT_EQ(offsetof(TreeRecord, triangles_offset_bytes), 32u);
  EXPECT_EQ(offsetof(TreeRecord, bounds_minimum), 40u);
  EXPECT_EQ(offsetof(TreeRecord, bounds_maximum), 52u);
  EXPECT_EQ(offsetof(TreeRecord, lattice), 64u);
  EXPECT_EQ(offsetof(TreeRecord, reserved), 80u);
  EXPECT_EQ(offsetof(TreeNode, high), 192u);
  EXPECT_EQ(offsetof(TreeNode, children), 384u);
  EXPECT_EQ(offsetof(TreeNode, order), 448u);
  EXPECT_EQ(offsetof(TreeNode, child_count), 456u);
  EXPECT_EQ(offsetof(TreeNode, reserved), 460u);
  EXPECT_EQ(TreeChild::leaf(5, 3).bits, 0x80000000u | 2u << 27 | 5u);
}

}  // namespace
}  // namespace gridiron::test
