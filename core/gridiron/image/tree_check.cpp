// Checks of the wide tree: see image_checker.h. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/math.h>
#include <gridiron/build/tree/tree_box.h>
#include <gridiron/build/triangle_records.h>
#include <gridiron/image/image_checker.h>

namespace gridiron {
namespace {

// --- Triangles ------------------------------------------------------------------------------------------------------

std::uint64_t place_of_triangle(const TreeRecord& tree, std::uint64_t number) {
  return tree.triangles_offset_bytes + number * tree.triangle_bytes;
}

// A triangle of the tree where it lies, or as it is read from a lattice: words that were just copied load slowly in
// other groups than they were stored in.
const VertexTriangle& triangle_at(const ImageChecker& checker, const SceneImageView& view, std::uint64_t place,
                                  VertexTriangle& read) {
  if (view.tree.triangle_format != static_cast<std::uint32_t>(TriangleFormat::kLattice)) {
    return checker.at<VertexTriangle>(place);
  }
  read = checker.read_triangle(place, view.grid);
  return read;
}

// With effects a record has the corners of the surface with its id, which says where the record stands. So no two
// records have one id, and as there are as many as triangles that are kept, each of these is there. Without, its
// corners are numbers within the bounds and span an area, and if no triangle was dropped, the sum of the ids is that of
// all. The bounds are tight.
bool check_tree_triangles(ImageChecker& checker, const SceneImageView& view) {
  const TreeRecord& tree = view.tree;
  const float lows[4] = {tree.bounds_minimum[0], tree.bounds_minimum[1], tree.bounds_minimum[2], 0.0f};
  const float highs[4] = {tree.bounds_maximum[0], tree.bounds_maximum[1], tree.bounds_maximum[2], 0.0f};
  const CornerQuad low = CornerQuad::load(lows), high = CornerQuad::load(highs);
  const std::uint64_t id_offset = tree.triangle_bytes - sizeof(std::uint32_t);
  TreeBox bounds;
  std::uint64_t id_sum = 0;
  const bool is_lattice = tree.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kLattice);
  VertexTriangle read{};
  for (std::uint64_t i = 0; i < tree.triangle_count; ++i) {
    const std::uint64_t base = place_of_triangle(tree, i);
    const VertexTriangle& triangle = triangle_at(checker, view, base, read);
    const std::uint32_t id = triangle.triangle_id;
    if (!checker.require(id < view.header.triangle_count, base + id_offset, "tree_triangle.triangle_id")) return false;
    if (is_lattice) {
      const auto tree_triangle = checker.read<LatticeTriangle>(base);
      GRIDIRON_REQUIRE(tree_triangle.reserved == 0, base, tree_triangle, reserved);
    } else {
      const VertexTriangle& tree_triangle = triangle;
      GRIDIRON_REQUIRE(all_zero(tree_triangle.reserved, 2), base, tree_triangle, reserved);
    }
    id_sum += id;
    const auto corner = [&](int k) { return Vec3(triangle.v[k][0], triangle.v[k][1], triangle.v[k][2]); };
    for (int k = 0; k < 3; ++k) bounds.add(corner(k));
    if (!view.has_effects) {
      const CornerQuad a = corner_quad(triangle, 0), b = corner_quad(triangle, 1), c = corner_quad(triangle, 2);
      const auto inside = ((a >= low) & (a <= high)) & ((b >= low) & (b <= high)) & ((c >= low) & (c <= high));
      const bool good = (inside.bits() & 7u) == 7u && !has_zero_area(corner(0), corner(1), corner(2));
      if (!checker.require(good, base, "tree_triangle.v")) return false;
      continue;
    }
    const std::uint64_t surface_base = view.effects.surfaces_offset_bytes + std::uint64_t{id} * sizeof(SurfaceRecord);
    const auto surface = checker.read<SurfaceRecord>(surface_base);
    if (!checker.require(same_bits(&surface.v[0][0], &triangle.v[0][0], 9), base, "tree_triangle.v")) return false;
    if (surface.tree_place == i) continue;
    // Either the record has another's id, or the surface names another's place.
    const bool is_elsewhere =
        surface.tree_place == kNoTriangle ||
        checker.read<std::uint32_t>(place_of_triangle(tree, surface.tree_place) + id_offset) == id;
    return is_elsewhere
               ? checker.require(false, base + id_offset, "tree_triangle.triangle_id")
               : checker.require(false, surface_base + offsetof(SurfaceRecord, tree_place), "surface.tree_place");
  }
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint64_t tree_base = view.tree_offset_bytes;
    GRIDIRON_REQUIRE(bounds.low[axis] == tree.bounds_minimum[axis], tree_base, tree, bounds_minimum);
    GRIDIRON_REQUIRE(bounds.high[axis] == tree.bounds_maximum[axis], tree_base, tree, bounds_maximum);
  }
  const std::uint64_t count = view.header.triangle_count;
  const bool are_all = view.has_effects || view.header.dropped_triangle_count != 0 || id_sum == count * (count - 1) / 2;
  return checker.require(are_all, tree.triangles_offset_bytes, "tree_triangle.triangle_id");
}

// --- Nodes ----------------------------------------------------------------------------------------------------------

std::uint64_t place_of_node(const TreeRecord& tree, std::uint64_t index) {
  return tree.nodes_offset_bytes + index * sizeof(TreeNode);
}

// Each child once, those that are there first; the others by number.
bool is_order(std::uint64_t order, std::uint32_t child_count) {
  std::uint32_t seen = 0;
  bool good = true;
  for (std::uint32_t place = 0; place < kTreeWidth; ++place) {
    const auto child = static_cast<std::uint32_t>(order >> 4 * place & 15u);
    seen |= 1u << child;
    good = good && (place < child_count ? child < child_count : child == place);
  }
  return good && seen == 0xFFFFu;
}

// Checks what a node says of its children. @param numbered  nodes that are children of those so far, and the root.
bool check_children(ImageChecker& checker, const TreeRecord& tree, std::uint64_t base, const TreeNode& node,
                    bool is_root, std::uint32_t& numbered) {
  GRIDIRON_REQUIRE(node.child_count >= (is_root ? 1u : 2u) && node.child_count <= kTreeWidth, base, node, child_count);
  for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
    const TreeChild child = node.children[i];
    bool good = false;
    if (i >= node.child_count) {
      good = child.bits == 0;
    } else if (child.is_leaf()) {
      good = child.count() <= tree.leaf_triangles && child.first() + child.count() <= tree.triangle_count;
    } else {
      good = child.node_index() == numbered && numbered < tree.node_count && node.child_count == kTreeWidth;
      ++numbered;
    }
    GRIDIRON_REQUIRE(good, base, node, children);
  }
  GRIDIRON_REQUIRE(is_order(node.order, node.child_count), base, node, order);
  GRIDIRON_REQUIRE(all_zero(node.reserved, 13), base, node, reserved);
  return true;
}

// Nodes are numbered level by level. So the children of a node must be the next ones that have no parent yet, each
// node then has one parent, which comes before it, and a level ends where the first child of its first node begins.
bool check_levels(ImageChecker& checker, std::uint64_t tree_base, const TreeRecord& tree) {
  std::uint32_t numbered = 1, level_end = 1, depth = 1;
  for (std::uint32_t i = 0; i < tree.node_count; ++i) {
    GRIDIRON_REQUIRE(i < numbered, tree_base, tree, node_count);
    if (i == level_end) {
      ++depth;
      level_end = numbered;
    }
    const std::uint64_t base = place_of_node(tree, i);
    if (!check_children(checker, tree, base, checker.at<TreeNode>(base), i == 0, numbered)) return false;
  }
  GRIDIRON_REQUIRE(depth == tree.depth, tree_base, tree, depth);
  return true;
}

// Records [first, end).
struct Run {
  std::uint64_t first, end;
};

// The records below a child, if its leaves cover them in order. Precondition: levels are right. Cost: its depth.
Run run_of(const ImageChecker& checker, const TreeRecord& tree, TreeChild child) {
  const auto child_at = [&](std::uint32_t node, std::uint32_t number) {
    return checker.read<TreeChild>(place_of_node(tree, node) + offsetof(TreeNode, children) +
                                   number * sizeof(TreeChild));
  };
  TreeChild first = child, last = child;
  for (std::uint32_t depth = 1; depth < kMaxTreeDepth && !first.is_leaf(); ++depth) {
    first = child_at(first.node_index(), 0);
  }
  for (std::uint32_t depth = 1; depth < kMaxTreeDepth && !last.is_leaf(); ++depth) {
    const auto child_count =
        checker.read<std::uint32_t>(place_of_node(tree, last.node_index()) + offsetof(TreeNode, child_count));
    last = child_at(last.node_index(), child_count - 1);
  }
  return {first.first(), std::uint64_t{last.first()} + last.count()};
}

// The box that the builder gives a child.
TreeBox box_of_child(const ImageChecker& checker, const SceneImageView& view, TreeChild child, float margin) {
  const TreeRecord& tree = view.tree;
  if (!child.is_leaf()) return box_of_node(checker.at<TreeNode>(place_of_node(tree, child.node_index())));
  QuadBox box;
  VertexTriangle read{};
  for (std::uint32_t i = child.first(); i < child.first() + child.count(); ++i) {
    const VertexTriangle& triangle = triangle_at(checker, view, place_of_triangle(tree, i), read);
    box.add(corner_quad(triangle, 0), corner_quad(triangle, 1), corner_quad(triangle, 2));
  }
  return box.grown(margin);
}

// Asks the caches for the triangles of a node's leaves.
void ask_for_triangles(const ImageChecker& checker, const TreeRecord& tree, const TreeNode& node) {
  for (const TreeChild child : node.children) {
    if (!child.is_leaf()) continue;
    const std::byte* const bytes = checker.image().data() + place_of_triangle(tree, child.first());
    for (std::uint32_t offset = 0; offset < child.count() * tree.triangle_bytes; offset += 64) {
      __builtin_prefetch(bytes + offset);
    }
  }
}

// Every child begins where the one before it ends, so the leaves of any node cover its records in order. A child that
// is a node has too many records for a leaf. Boxes are as built; from the last node to the first, so that a wrong box
// is named, not that of its parent, which is made of it.
bool check_runs_and_boxes(ImageChecker& checker, const SceneImageView& view) {
  const TreeRecord& tree = view.tree;
  const float margin = tree_margin_of(tree.bounds_minimum, tree.bounds_maximum);
  for (std::uint32_t i = tree.node_count; i-- > 0;) {
    const std::uint64_t base = place_of_node(tree, i);
    const auto& node = checker.at<TreeNode>(base);
    if (i > 0) ask_for_triangles(checker, tree, checker.at<TreeNode>(base - sizeof(TreeNode)));
    std::uint64_t end = i == 0 ? 0 : run_of(checker, tree, node.children[0]).first;
    for (std::uint32_t k = 0; k < kTreeWidth; ++k) {
      TreeBox box;
      if (k < node.child_count) {
        const TreeChild child = node.children[k];
        const Run run = run_of(checker, tree, child);
        const bool is_large = child.is_leaf() || run.end > run.first + tree.leaf_triangles;
        GRIDIRON_REQUIRE(run.first == end && is_large, base, node, children);
        end = run.end;
        box = box_of_child(checker, view, child, margin);
      }
      for (int axis = 0; axis < 3; ++axis) {
        GRIDIRON_REQUIRE(same_bits(&node.low[axis][k], &box.low[axis], 1), base, node, low);
        GRIDIRON_REQUIRE(same_bits(&node.high[axis][k], &box.high[axis], 1), base, node, high);
      }
    }
    if (i != 0) continue;
    GRIDIRON_REQUIRE(end == tree.triangle_count, base, node, children);
    GRIDIRON_REQUIRE((node.child_count == 1) == (end <= tree.leaf_triangles), base, node, child_count);
  }
  return true;
}

}  // namespace

bool check_tree_space(ImageChecker& checker, const SceneImageView& view) {
  const TreeRecord& tree = view.tree;
  const std::uint64_t base = view.tree_offset_bytes;
  for (int axis = 0; axis < 3; ++axis) {
    const float low = tree.bounds_minimum[axis], high = tree.bounds_maximum[axis];
    GRIDIRON_REQUIRE(low >= -kCoordinateLimit && low <= kCoordinateLimit && !is_negative_zero(low), base, tree,
                     bounds_minimum);
    GRIDIRON_REQUIRE(high >= low && high <= kCoordinateLimit && !is_negative_zero(high), base, tree, bounds_maximum);
  }
  if (tree.triangle_format != static_cast<std::uint32_t>(TriangleFormat::kLattice)) {
    GRIDIRON_REQUIRE(is_no_lattice(tree.lattice), base, tree, lattice);
    return true;
  }
  GRIDIRON_REQUIRE(is_lattice_step(tree.lattice.step), base, tree, lattice.step);
  for (const float origin : tree.lattice.origin) {
    GRIDIRON_REQUIRE(is_lattice_origin(origin, tree.lattice.step), base, tree, lattice.origin);
  }
  return true;
}

// Without a grid the view's has the tree's bounds and lattice.
bool check_tree(ImageChecker& checker, const SceneImageView& view) {
  if (!view.has_tree) return true;
  const TreeRecord& tree = view.tree;
  const GridRecord& grid = view.grid;
  const std::uint64_t base = view.tree_offset_bytes;
  GRIDIRON_REQUIRE(same_bits(tree.bounds_minimum, grid.bounds_minimum, 3), base, tree, bounds_minimum);
  GRIDIRON_REQUIRE(same_bits(tree.bounds_maximum, grid.bounds_maximum, 3), base, tree, bounds_maximum);
  const bool has_lattice =
      same_bits(tree.lattice.origin, grid.lattice.origin, 3) && same_bits(&tree.lattice.step, &grid.lattice.step, 1);
  GRIDIRON_REQUIRE(has_lattice, base, tree, lattice);
  return check_tree_triangles(checker, view) && check_levels(checker, base, tree) &&
         check_runs_and_boxes(checker, view);
}

}  // namespace gridiron
