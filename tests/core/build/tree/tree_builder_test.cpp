// The wide tree: what every tree has, whatever the mesh. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/tree/tree_builder.h>
#include <gridiron/build/triangle_records.h>

#include <bit>
#include <cstring>
#include <glm/common.hpp>

#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

// Memory with a pattern in front of it, behind it and, at first, in it.
template <class T>
class Guarded {
 public:
  Guarded(std::uint64_t count, std::byte pattern)
      : pattern_(pattern), bytes_(count * sizeof(T) + 2 * kGuard + alignof(T), pattern) {
    void* place = bytes_.data() + kGuard;
    std::size_t room = bytes_.size();
    first_ = static_cast<T*>(std::align(alignof(T), count * sizeof(T), place, room));
    count_ = count;
  }
  [[nodiscard]] std::span<T> span() { return {first_, static_cast<std::size_t>(count_)}; }
  [[nodiscard]] bool is_intact() const {
    const auto is_pattern = [this](std::byte byte) { return byte == pattern_; };
    const std::byte* const begin = reinterpret_cast<const std::byte*>(first_);
    return std::all_of(bytes_.data(), begin, is_pattern) &&
           std::all_of(begin + count_ * sizeof(T), bytes_.data() + bytes_.size(), is_pattern);
  }

 private:
  static constexpr std::size_t kGuard = 256;
  std::byte pattern_;
  std::vector<std::byte> bytes_;
  T* first_;
  std::uint64_t count_;
};

template <class Record>
struct Tree {
  TreeSize size{};
  std::vector<Record> records;
  std::vector<TreeNode> nodes;
};

LatticeMesh on_lattice(const TestMesh& mesh) {
  LatticeMesh view{{mesh.vertices, {}}, mesh.triangles};
  EXPECT_EQ(find_lattice(mesh.view(), view.vertices.lattice), Status::kOk);
  return view;
}

// Builds with guards around all memory, in which `pattern` stands.
template <class Record, class Mesh>
Tree<Record> built(const Mesh& mesh, std::uint32_t leaf_triangles, std::byte pattern = std::byte{0xA5}) {
  const std::uint64_t count = mesh.triangles.size();
  Guarded<Record> records(count, pattern);
  Guarded<TreeNode> nodes(most_tree_nodes(count, leaf_triangles), pattern);
  Guarded<std::uint64_t> scratch(tree_scratch_bytes(count) / 8, pattern);
  Tree<Record> tree;
  EXPECT_EQ(
      build_tree(mesh, leaf_triangles, records.span(), nodes.span(), std::as_writable_bytes(scratch.span()), tree.size),
      Status::kOk);
  EXPECT_TRUE(records.is_intact() && nodes.is_intact() && scratch.is_intact());
  const auto first = [](auto span, std::uint32_t n) { return std::vector(span.begin(), span.begin() + n); };
  tree.records = first(records.span(), tree.size.triangle_count);
  tree.nodes = first(nodes.span(), tree.size.node_count);
  return tree;
}

struct Bounds {
  float low[3] = {kFloatMax, kFloatMax, kFloatMax};
  float high[3] = {-kFloatMax, -kFloatMax, -kFloatMax};

  void add(const float* low_corner, const float* high_corner) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], low_corner[axis]);
      high[axis] = std::max(high[axis], high_corner[axis]);
    }
  }
  bool operator==(const Bounds&) const = default;
};

Bounds grown(Bounds bounds, const TreeSize& size) {
  float largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    largest = std::max({largest, std::fabs(size.low[axis]), std::fabs(size.high[axis])});
  }
  const float margin = tree_margin(largest);
  for (int axis = 0; axis < 3; ++axis) {
    bounds.low[axis] = grown_low(bounds.low[axis], margin);
    bounds.high[axis] = grown_high(bounds.high[axis], margin);
    EXPECT_LE(bounds.low[axis] + margin / 2, bounds.high[axis]);
  }
  return bounds;
}

Bounds bounds_of(const TreeNode& node, std::uint32_t child) {
  Bounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    bounds.low[axis] = node.low[axis][child];
    bounds.high[axis] = node.high[axis][child];
  }
  return bounds;
}

Vec3 corner_of(const MeshView&, const VertexTriangle& record, int corner) {
  return {record.v[corner][0], record.v[corner][1], record.v[corner][2]};
}
Vec3 corner_of(const LatticeMesh& mesh, const LatticeTriangle& record, int corner) {
  const Lattice& lattice = mesh.vertices.lattice;
  Vec3 p;
  for (int axis = 0; axis < 3; ++axis)
    p[axis] = lattice.origin[axis] + lattice.step * static_cast<float>(record.v[corner][axis]);
  return p;
}

// What every tree of a mesh has.
template <class Record, class Mesh>
void expect_sound(const Mesh& mesh, std::uint32_t leaf_triangles) {
  const Tree<Record> tree = built<Record>(mesh, leaf_triangles);
  const TreeSize& size = tree.size;
  ASSERT_LE(size.node_count, most_tree_nodes(mesh.triangles.size(), leaf_triangles));
  EXPECT_LE(size.depth, kMaxTreeDepth);
  // Each triangle with an area has one record, those without have none.
  std::vector<int> records_of(mesh.triangles.size(), 0);
  for (const Record& record : tree.records) {
    ASSERT_LT(record.triangle_id, mesh.triangles.size());
    ++records_of[record.triangle_id];
    for (int corner = 0; corner < 3; ++corner) {
      const Vec3 stored = corner_of(mesh, record, corner);
      const Vec3 given = mesh.vertices[mesh.triangles[record.triangle_id][corner]];
      EXPECT_EQ(std::memcmp(&stored, &given, sizeof stored), 0);
    }
  }
  std::uint32_t dropped = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const UVec3& t = mesh.triangles[i];
    const bool has_area = !has_zero_area(mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z]);
    EXPECT_EQ(records_of[i], has_area ? 1 : 0) << i;
    dropped += has_area ? 0 : 1;
  }
  EXPECT_EQ(size.dropped_triangle_count, dropped);
  // From the last node to the first: where its records begin and end, its bounds, and its depth from below.
  struct Part {
    std::uint32_t first, end, height;
    Bounds bounds;
  };
  std::vector<Part> parts(size.node_count);
  std::vector<int> parents_of(size.node_count, 0);
  std::uint32_t next_node = 1;
  for (std::uint32_t i = 0; i < size.node_count; ++i) {
    const TreeNode& node = tree.nodes[i];
    ASSERT_GE(node.child_count, i == 0 ? 1u : 2u);
    ASSERT_LE(node.child_count, kTreeWidth);
    for (std::uint32_t k = 0; k < node.child_count; ++k) {
      if (node.children[k].is_leaf()) continue;
      ASSERT_EQ(node.children[k].node_index(), next_node++) << "level by level";
      ASSERT_LT(node.children[k].node_index(), size.node_count);
    }
  }
  EXPECT_EQ(next_node, size.node_count);
  for (std::uint32_t i = size.node_count; i-- > 0;) {
    const TreeNode& node = tree.nodes[i];
    Part part{0, 0, 1, {}};
    for (std::uint32_t k = 0; k < node.child_count; ++k) {
      const TreeChild child = node.children[k];
      Part below{child.first(), child.first() + child.count(), 0, {}};
      if (child.is_leaf()) {
        ASSERT_LE(child.count(), leaf_triangles);
        ASSERT_LE(below.end, size.triangle_count);
        for (std::uint32_t t = below.first; t < below.end; ++t) {
          for (int corner = 0; corner < 3; ++corner) {
            const Vec3 p = corner_of(mesh, tree.records[t], corner);
            below.bounds.add(&p.x, &p.x);
          }
        }
      } else {
        below = parts[child.node_index()];
      }
      if (k == 0) part.first = below.first;
      if (k != 0) {
        EXPECT_EQ(below.first, part.end) << "records in order";
      }
      part.end = below.end;
      part.height = std::max(part.height, below.height + 1);
      part.bounds.add(below.bounds.low, below.bounds.high);
      EXPECT_EQ(bounds_of(node, k), grown(below.bounds, size)) << "node " << i << ", child " << k;
    }
    std::uint32_t children = 0;
    for (std::uint32_t k = 0; k < kTreeWidth; ++k) {
      const auto child = static_cast<std::uint32_t>(node.order >> 4 * k & 15);
      children |= 1u << child;
      EXPECT_EQ(child < node.child_count, k < node.child_count) << "those that are not there last";
      if (k < node.child_count) continue;
      EXPECT_EQ(bounds_of(node, k), Bounds{});
      EXPECT_EQ(node.children[k].bits, 0u);
    }
    EXPECT_EQ(children, 0xFFFFu) << "a permutation";
    for (const std::uint32_t word : node.reserved) EXPECT_EQ(word, 0u);
    parts[i] = part;
  }
  EXPECT_EQ(parts[0].first, 0u);
  EXPECT_EQ(parts[0].end, size.triangle_count);
  EXPECT_EQ(parts[0].height, size.depth);
  Bounds all;
  std::copy_n(size.low, 3, all.low);
  std::copy_n(size.high, 3, all.high);
  EXPECT_EQ(parts[0].bounds, all);
  // Nothing else decides: not what stood in memory before.
  const Tree<Record> again = built<Record>(mesh, leaf_triangles, std::byte{0x3C});
  ASSERT_EQ(again.nodes.size(), tree.nodes.size());
  EXPECT_EQ(std::memcmp(again.nodes.data(), tree.nodes.data(), tree.nodes.size() * sizeof(TreeNode)), 0);
  EXPECT_EQ(std::memcmp(again.records.data(), tree.records.data(), tree.records.size() * sizeof(Record)), 0);
}

// Clusters in clusters: each of `depth` levels has all but one triangle in a cell of the level above it, by `factor`.
TestMesh make_nested(std::uint32_t depth, std::uint32_t per_level, float factor) {
  TestMesh mesh;
  float scale = 1.0f;
  for (std::uint32_t level = 0; level < depth; ++level, scale *= factor) {
    for (std::uint32_t i = 0; i < per_level; ++i) {
      mesh.append(moved(make_triangle({1, 1, 1}, {1.25f, 1, 1}, {1, 1.25f, 1}),
                        scale * (1.0f + 0.01f * static_cast<float>(i))));
    }
  }
  return mesh;
}

TestMesh copies(const TestMesh& mesh, std::uint32_t count) {
  TestMesh all;
  for (std::uint32_t i = 0; i < count; ++i) all.append(mesh);
  return all;
}

struct Case {
  const char* name;
  TestMesh mesh;
};

std::vector<Case> cases() {
  const TestMesh one = make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  std::vector<Case> all = {
      {"one", one},
      {"two", joined(one, moved(one, 1.0f, {5, 5, 5}))},
      {"eight", copies(one, 8)},
      {"nine", copies(one, 9)},
      {"one_place", copies(one, 5000)},
      {"torus", make_torus(96, 48, 1.0f, 0.35f)},
      {"soup", make_random_soup(7000, 0.05f, 3)},
      {"slivers", make_sliver_fan(3000, 1e-6f)},
      {"flat", make_height_field(40, 0.0f, 1)},
      {"stadium", joined(moved(make_torus(80, 40, 1.0f, 0.35f), 1e-4f), make_box({-100, -1, -100}, {100, 50, 100}))},
      {"nested", make_nested(60, 60, 0.25f)},
      {"nested_steep", make_nested(9, 400, 0x1p-13f)},
      {"peeled", make_nested(200, 1, 0.5f)},
      {"huge", moved(make_random_soup(3000, 0.05f, 4), 0x1p119f)},
      {"tiny", moved(make_random_soup(3000, 0.3f, 5), 0x1p-110f)},
      {"subnormal", moved(make_random_soup(3000, 0.3f, 6), 0x1p-140f)},
      {"far", moved(make_torus(60, 30, 1.0f, 0.35f), 1.0f, {1e6f, 1e6f, 1e6f})},
  };
  TestMesh flat_ones = make_random_soup(500, 0.1f, 7);
  for (std::size_t i = 0; i < flat_ones.triangles.size(); i += 3) flat_ones.triangles[i].z = flat_ones.triangles[i].y;
  all.push_back({"with_zero_areas", flat_ones});
  return all;
}

TEST(TreeBuilder, EveryTreeIsSound) {
  for (const Case& tested : cases()) {
    SCOPED_TRACE(tested.name);
    for (const std::uint32_t leaf : {1u, 3u, 8u, 16u}) {
      SCOPED_TRACE(leaf);
      expect_sound<VertexTriangle>(tested.mesh.view(), leaf);
    }
  }
}

TEST(TreeBuilder, EveryTreeOnALatticeIsSound) {
  for (const Case& tested : cases()) {
    SCOPED_TRACE(tested.name);
    const LatticeMesh mesh = on_lattice(tested.mesh);
    bool has_area = false;
    for (const UVec3& t : mesh.triangles) {
      has_area = has_area || !has_zero_area(mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z]);
    }
    TreeSize size;
    std::vector<std::uint64_t> scratch(tree_scratch_bytes(mesh.triangles.size()) / 8);
    if (!has_area) {
      EXPECT_EQ(build_tree(mesh, 8, {}, {}, std::as_writable_bytes(std::span(scratch)), size), Status::kNoTriangles);
      continue;
    }
    expect_sound<LatticeTriangle>(mesh, 8);
    expect_sound<LatticeTriangle>(mesh, 16);
  }
}

TEST(TreeBuilder, CrowdedCellsAreSplitByPlaceNotByNumber) {
  // Two small tori at the ends of a large box: most triangles share two codes. Their order is random.
  const TestMesh torus = moved(make_torus(60, 40, 1.0f, 0.35f), 0x1p-16f);
  TestMesh mesh = joined(torus, moved(torus, 1.0f, {4, 4, 4}));
  TestRandom random(5);
  for (std::size_t i = mesh.triangles.size(); i > 1; --i) {
    std::swap(mesh.triangles[i - 1], mesh.triangles[static_cast<std::size_t>(random.next() % i)]);
  }
  const Tree<VertexTriangle> tree = built<VertexTriangle>(mesh.view(), 8);
  double surfaces = 0, leaves = 0;
  for (const TreeNode& node : tree.nodes) {
    for (std::uint32_t k = 0; k < node.child_count; ++k) {
      if (!node.children[k].is_leaf()) continue;
      double e[3];
      for (int axis = 0; axis < 3; ++axis) e[axis] = double{node.high[axis][k]} - double{node.low[axis][k]};
      surfaces += e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
      ++leaves;
    }
  }
  // Each of 1,200 leaves of random triangles would have half the surface of a torus, some 6 squares of 2^-16.
  EXPECT_LT(surfaces, 400 * 0x1p-32);
  EXPECT_LT(leaves, 9600 / 3.0);
}

// Codes along the Z curve of a mesh's triangles, ten bits an axis.
std::vector<std::uint32_t> codes_of(const TestMesh& mesh) {
  Vec3 low(kFloatMax), high(-kFloatMax);
  for (const Vec3& p : mesh.vertices) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  std::vector<std::uint32_t> codes;
  for (const UVec3& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t.x], &b = mesh.vertices[t.y], &c = mesh.vertices[t.z];
    const Vec3 middle = glm::min(glm::min(a, b), c) + glm::max(glm::max(a, b), c);
    std::uint32_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float scale = 1023.9375f / (2 * high[axis] - 2 * low[axis]);
      const auto place = static_cast<std::uint32_t>((middle[axis] - 2 * low[axis]) * scale);
      for (int bit = 0; bit < 10; ++bit) code |= (place >> bit & 1u) << (3 * bit + axis);
    }
    codes.push_back(code);
  }
  return codes;
}

// Records follow the curve, and each part of a node ends where a higher bit changes than within it; with and without
// the large digits of many triangles.
TEST(TreeBuilder, NodesAreSplitAtTheHighestBits) {
  static_assert(kManyTreeTriangles == 32768);
  for (const std::uint32_t count : {32'767u, 32'768u, 50'000u}) {
    const TestMesh mesh = make_random_soup(count, 0.01f, 3);
    ASSERT_EQ(mesh.triangles.size(), count);
    const std::vector<std::uint32_t> codes = codes_of(mesh);
    const Tree<VertexTriangle> tree = built<VertexTriangle>(mesh.view(), 16);
    ASSERT_EQ(tree.records.size(), count);
    const auto code_at = [&](std::size_t i) { return codes[tree.records[i].triangle_id]; };
    for (std::size_t i = 1; i < count; ++i) ASSERT_LE(code_at(i - 1), code_at(i)) << count << ", record " << i;

    std::vector<std::uint32_t> firsts(tree.nodes.size()), ends(tree.nodes.size());
    std::size_t compared = 0;
    for (std::size_t i = tree.nodes.size(); i-- > 0;) {
      const TreeNode& node = tree.nodes[i];
      const auto first_of = [&](TreeChild c) { return c.is_leaf() ? c.first() : firsts[c.node_index()]; };
      const auto end_of = [&](TreeChild c) { return c.is_leaf() ? c.first() + c.count() : ends[c.node_index()]; };
      firsts[i] = first_of(node.children[0]);
      ends[i] = end_of(node.children[node.child_count - 1]);
      for (std::uint32_t k = 0; k + 1 < node.child_count; ++k) {
        const std::uint32_t end = end_of(node.children[k]);
        const std::uint32_t change = code_at(end - 1) ^ code_at(end);
        if (change == 0) continue;  // coded again
        for (const TreeChild child : {node.children[k], node.children[k + 1]}) {
          const std::uint32_t within = code_at(first_of(child)) ^ code_at(end_of(child) - 1);
          ASSERT_LT(std::bit_width(within), std::bit_width(change)) << count << ", node " << i << ", child " << k;
          ++compared;
        }
      }
    }
    EXPECT_GT(compared, count / 16);
  }
}

struct SplitPart {
  std::uint32_t begin, end, group;
};

// The parts of a node by the rule of tree_splits.h, written again. None if it meets triangles of one code.
template <class CodeAt>
std::vector<SplitPart> parts_of(const CodeAt& code_at, std::uint32_t begin, std::uint32_t end, bool is_root,
                                std::uint32_t leaf_triangles) {
  std::vector<SplitPart> parts = {{begin, end, 0}};
  std::uint32_t group_sizes[4] = {1, 1, 1, 1};
  while (parts.size() < kTreeWidth) {
    std::size_t best = parts.size();
    std::pair<int, std::uint32_t> most;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::uint32_t size = parts[i].end - parts[i].begin;
      if (size <= leaf_triangles) continue;
      const auto level = static_cast<int>(std::bit_width(code_at(parts[i].begin) ^ code_at(parts[i].end - 1)));
      std::pair<int, std::uint32_t> weight(5 * level + 2 * static_cast<int>(std::bit_width(size)), size);
      if (group_sizes[parts[i].group] >= 4) weight.first -= is_root ? 3 : 1000;
      if (best < parts.size() && weight <= most) continue;
      best = i;
      most = weight;
    }
    if (best == parts.size()) break;
    SplitPart& part = parts[best];
    const std::uint32_t change = code_at(part.begin) ^ code_at(part.end - 1);
    if (change == 0) return {};
    SplitPart behind = part;
    while ((code_at(behind.begin) & std::bit_floor(change)) == 0) ++behind.begin;
    part.end = behind.begin;
    parts.insert(parts.begin() + static_cast<std::ptrdiff_t>(best) + 1, behind);
    if (parts.size() > 4) ++group_sizes[behind.group];
    for (std::uint32_t i = 0; i < 4 && parts.size() == 4; ++i) parts[i].group = i;
  }
  return parts;
}

TEST(TreeBuilder, TheHeaviestPartIsSplitFirstAndGroupsAreOfFour) {
  const TestMesh soup = make_random_soup(5'000, 0.01f, 3);
  const TestMesh uneven = joined(joined(soup, moved(soup, 0.03f, Vec3(0.4f))), make_height_field(30, 0.2f, 3));
  for (const TestMesh& mesh : {soup, uneven}) {
    for (const std::uint32_t leaf : {2u, 8u}) {
      const std::vector<std::uint32_t> codes = codes_of(mesh);
      const Tree<VertexTriangle> tree = built<VertexTriangle>(mesh.view(), leaf);
      const auto code_at = [&](std::size_t i) { return codes[tree.records[i].triangle_id]; };
      std::vector<std::uint32_t> firsts(tree.nodes.size()), ends(tree.nodes.size());
      std::size_t compared = 0;
      for (std::size_t i = tree.nodes.size(); i-- > 0;) {
        const TreeNode& node = tree.nodes[i];
        std::vector<std::uint32_t> child_ends;
        for (std::uint32_t k = 0; k < node.child_count; ++k) {
          const TreeChild c = node.children[k];
          if (k == 0) firsts[i] = c.is_leaf() ? c.first() : firsts[c.node_index()];
          child_ends.push_back(c.is_leaf() ? c.first() + c.count() : ends[c.node_index()]);
        }
        ends[i] = child_ends.back();
        const std::vector<SplitPart> parts = parts_of(code_at, firsts[i], ends[i], i == 0, leaf);
        if (parts.empty()) continue;
        ASSERT_EQ(parts.size(), child_ends.size()) << "node " << i;
        for (std::size_t k = 0; k < parts.size(); ++k) ASSERT_EQ(parts[k].end, child_ends[k]) << "node " << i;
        ++compared;
      }
      EXPECT_GT(compared, tree.nodes.size() / 2);
    }
  }
}

TEST(TreeBuilder, OrderByNumberChangesNothingElse) {
  const TestMesh mesh = make_random_soup(2'000, 0.1f, 4);
  const Tree<VertexTriangle> tree = built<VertexTriangle>(mesh.view(), 8);
  std::vector<VertexTriangle> records(mesh.triangles.size());
  std::vector<TreeNode> nodes(most_tree_nodes(mesh.triangles.size(), 8));
  std::vector<std::uint64_t> scratch(tree_scratch_bytes(mesh.triangles.size()) / 8);
  TreeSize size;
  ASSERT_EQ(build_tree(mesh.view(), 8, records, nodes, std::as_writable_bytes(std::span(scratch)), size,
                       TreeOrder::kByNumber),
            Status::kOk);
  ASSERT_EQ(size.node_count, tree.nodes.size());
  EXPECT_EQ(std::memcmp(records.data(), tree.records.data(), tree.records.size() * sizeof(VertexTriangle)), 0);
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    EXPECT_EQ(nodes[i].order, 0xFEDCBA9876543210u);
    nodes[i].order = tree.nodes[i].order;
    EXPECT_EQ(std::memcmp(&nodes[i], &tree.nodes[i], sizeof(TreeNode)), 0) << i;
  }
}

TEST(TreeBuilder, OccludersComeFirst) {
  // Dust in front of a wall: of equal boxes the one that is filled is asked first.
  TestMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const float x = 0.125f * static_cast<float>(i), y = static_cast<float>(i % 2);
    mesh.append(make_triangle({x, y, 0}, {x + 0.01f, y, 0}, {x, y + 0.01f, 0.1f}));
  }
  mesh.append(make_triangle({0, 0, 5}, {1, 0, 5}, {0, 1, 5.1f}));
  const Tree<VertexTriangle> tree = built<VertexTriangle>(mesh.view(), 8);
  const TreeNode& root = tree.nodes[0];
  ASSERT_EQ(root.child_count, 2u);
  const auto first = static_cast<std::uint32_t>(root.order & 15);
  ASSERT_TRUE(root.children[first].is_leaf());
  EXPECT_EQ(first, 1u);
  EXPECT_EQ(root.children[first].count(), 1u) << "the wall";
  EXPECT_EQ(tree.records[root.children[first].first()].triangle_id, 8u);
}

TEST(TreeBuilder, NeedsWhatItSaysAndNotAByteLess) {
  for (const Case& tested : cases()) {
    SCOPED_TRACE(tested.name);
    const MeshView mesh = tested.mesh.view();
    const Tree<VertexTriangle> tree = built<VertexTriangle>(mesh, 8);
    std::vector<std::uint64_t> scratch(tree_scratch_bytes(mesh.triangles.size()) / 8);
    const auto status = [&](std::size_t records, std::size_t nodes, std::size_t scratch_bytes) {
      Guarded<VertexTriangle> some_records(records, std::byte{0x11});
      Guarded<TreeNode> some_nodes(nodes, std::byte{0x11});
      TreeSize size;
      const Status result = build_tree(mesh, 8, some_records.span(), some_nodes.span(),
                                       std::as_writable_bytes(std::span(scratch)).first(scratch_bytes), size);
      EXPECT_TRUE(some_records.is_intact() && some_nodes.is_intact());
      return result;
    };
    const std::size_t records = tree.records.size(), nodes = tree.nodes.size(), bytes = scratch.size() * 8;
    EXPECT_EQ(status(records, nodes, bytes), Status::kOk);
    EXPECT_EQ(status(records - 1, nodes, bytes), Status::kMemoryTooSmall);
    EXPECT_EQ(status(records, nodes - 1, bytes), Status::kMemoryTooSmall);
    EXPECT_EQ(status(records, nodes, bytes - 1), Status::kMemoryTooSmall);
  }
}

TEST(TreeBuilder, RefusesWhatItCannotBuild) {
  const auto status = [](const TestMesh& mesh, std::uint32_t leaf = 8) {
    std::vector<VertexTriangle> records(100);
    std::vector<TreeNode> nodes(100);
    std::vector<std::uint64_t> scratch(tree_scratch_bytes(100) / 8);
    TreeSize size;
    return build_tree(mesh.view(), leaf, records, nodes, std::as_writable_bytes(std::span(scratch)), size);
  };
  const TestMesh good = make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  EXPECT_EQ(status(good), Status::kOk);
  EXPECT_EQ(status(good, 0), Status::kBadParameter);
  EXPECT_EQ(status(good, kMaxTreeLeaf + 1), Status::kBadParameter);
  EXPECT_EQ(status(TestMesh{}), Status::kNoTriangles);
  EXPECT_EQ(status(make_triangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2})), Status::kNoTriangles);
  for (int axis = 0; axis < 3; ++axis) {
    for (const float bad : {std::nanf(""), kInfinity, -kInfinity, 0x1.000002p120f, -0x1.000002p120f}) {
      TestMesh mesh = good;
      mesh.vertices[1][axis] = bad;
      EXPECT_EQ(status(mesh), Status::kBadVertex) << bad;
    }
    TestMesh mesh = good;
    mesh.triangles[0][axis] = 3;
    EXPECT_EQ(status(mesh), Status::kBadIndex);
  }
}

}  // namespace
}  // namespace gridiron::test
