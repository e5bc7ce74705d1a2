// Checks of the wide tree: see image_checker.h. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/math.h>
#include <gridiron/build/shared_parts.h>
#include <gridiron/build/tree/tree_box.h>
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

// What triangles are together.
struct TreeTotals {
  QuadBox bounds;
  std::uint64_t id_sum = 0;

  void add(const QuadBox& box) {
    bounds.low = Lanes<4>::min(box.low, bounds.low);
    bounds.high = Lanes<4>::max(box.high, bounds.high);
  }
};

// Checks the triangles, each of which is to be taken once. With effects a record has the corners of the surface with
// its id, which says where the record stands. So no two records have one id, and as there are as many as triangles that
// are kept, each of these is there. Without, its corners are numbers within the bounds and span an area, and if no
// triangle was dropped, the sum of the ids is that of all. The bounds are tight.
class TreeTriangles {
 public:
  TreeTriangles(ImageChecker& checker, const SceneImageView& view)
      : checker_(checker),
        view_(view),
        low_(quad_of(bounds_of(view.tree.bounds_minimum))),
        high_(quad_of(bounds_of(view.tree.bounds_maximum))),
        is_lattice_(view.tree.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kLattice)) {}

  // Takes triangles [first, end), those of a leaf. @param box  of them.
  [[nodiscard]] bool take(std::uint64_t first, std::uint64_t end, QuadBox& box) {
    if (is_lattice_ || view_.has_effects) {
      for (std::uint64_t i = first; i < end; ++i) {
        if (!take_one(i, box)) return false;
      }
    } else if (!take_good(first, end, box)) {
      QuadBox same_box;
      for (std::uint64_t i = first; i < end; ++i) {
        if (!take_one(i, same_box)) return false;
      }
    }
    totals_.add(box);
    return true;
  }

  [[nodiscard]] const TreeTotals& totals() const { return totals_; }

 private:
  // Of an image of vertices without effects: looks at all triangles at once. @returns false if one of them may be
  // wrong; none is taken then.
  [[nodiscard]] bool take_good(std::uint64_t first, std::uint64_t end, QuadBox& box) {
    std::uint64_t id_sum = 0;
    std::uint32_t wrong = 0;
    CornerQuad sum(0.0f);
    for (std::uint64_t i = first; i < end; ++i) {
      const auto& triangle = checker_.at<VertexTriangle>(place_of_triangle(view_.tree, i));
      const CornerQuads corners = corner_quads(triangle);
      wrong |= triangle.triangle_id < view_.header.triangle_count && corners.surely_have_area() ? 0u : 1u;
      wrong |= triangle.reserved[0] | triangle.reserved[1];
      id_sum += triangle.triangle_id;
      box.add(corners);
      sum = sum + (corners.a + corners.b + corners.c);
    }
    // The sum is a number only if all are; the least and the greatest of some may be.
    const auto good = (box.low >= low_) & (box.high <= high_) & (sum <= sum);
    if (wrong != 0 || (good.bits() & 7u) != 7u) return false;
    totals_.id_sum += id_sum;
    return true;
  }

  // Adds triangle i to a box.
  [[nodiscard]] bool take_one(std::uint64_t i, QuadBox& box) {
    const std::uint64_t base = place_of_triangle(view_.tree, i);
    const VertexTriangle& triangle = triangle_at(checker_, view_, base, read_);
    const std::uint32_t id = triangle.triangle_id;
    if (!checker_.require(id < view_.header.triangle_count, base + id_offset(), "tree_triangle.triangle_id")) {
      return false;
    }
    if (!is_reserved_zero(base, triangle)) return false;
    totals_.id_sum += id;
    const CornerQuads corners = corner_quads(triangle);
    box.add(corners);
    if (view_.has_effects) return is_of_surface(i, base, triangle);
    const auto is_inside = [this](CornerQuad corner) {
      return (((corner >= low_) & (corner <= high_)).bits() & 7u) == 7u;
    };
    const bool good = is_inside(corners.a) && is_inside(corners.b) && is_inside(corners.c) && !corners.have_zero_area();
    return checker_.require(good, base, "tree_triangle.v");
  }

  [[nodiscard]] static Vec3 bounds_of(const float side[3]) { return {side[0], side[1], side[2]}; }
  [[nodiscard]] std::uint64_t id_offset() const { return view_.tree.triangle_bytes - sizeof(std::uint32_t); }

  [[nodiscard]] bool is_reserved_zero(std::uint64_t base, const VertexTriangle& tree_triangle) {
    ImageChecker& checker = checker_;
    if (!is_lattice_) {
      GRIDIRON_REQUIRE(all_zero(tree_triangle.reserved, 2), base, tree_triangle, reserved);
      return true;
    }
    const bool is_zero = checker.at<LatticeTriangle>(base).reserved == 0;
    return checker.require(is_zero, base + offsetof(LatticeTriangle, reserved), "tree_triangle.reserved");
  }

  [[nodiscard]] bool is_of_surface(std::uint64_t i, std::uint64_t base, const VertexTriangle& triangle) {
    const std::uint32_t id = triangle.triangle_id;
    const std::uint64_t surface_base = view_.effects.surfaces_offset_bytes + std::uint64_t{id} * sizeof(SurfaceRecord);
    const auto surface = checker_.read<SurfaceRecord>(surface_base);
    if (!checker_.require(same_bits(&surface.v[0][0], &triangle.v[0][0], 9), base, "tree_triangle.v")) return false;
    if (surface.tree_place == i) return true;
    // Either the record has another's id, or the surface names another's place.
    const bool is_elsewhere =
        surface.tree_place == kNoTriangle ||
        checker_.read<std::uint32_t>(place_of_triangle(view_.tree, surface.tree_place) + id_offset()) == id;
    return is_elsewhere
               ? checker_.require(false, base + id_offset(), "tree_triangle.triangle_id")
               : checker_.require(false, surface_base + offsetof(SurfaceRecord, tree_place), "surface.tree_place");
  }

  ImageChecker& checker_;
  const SceneImageView& view_;
  CornerQuad low_, high_;
  bool is_lattice_;
  VertexTriangle read_{};
  TreeTotals totals_;
};

bool check_totals(ImageChecker& checker, const SceneImageView& view, const TreeTotals& totals) {
  const TreeRecord& tree = view.tree;
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint64_t tree_base = view.tree_offset_bytes;
    GRIDIRON_REQUIRE(totals.bounds.low.v[axis] == tree.bounds_minimum[axis], tree_base, tree, bounds_minimum);
    GRIDIRON_REQUIRE(totals.bounds.high.v[axis] == tree.bounds_maximum[axis], tree_base, tree, bounds_maximum);
  }
  const std::uint64_t count = view.header.triangle_count;
  const bool are_all =
      view.has_effects || view.header.dropped_triangle_count != 0 || totals.id_sum == count * (count - 1) / 2;
  return checker.require(are_all, tree.triangles_offset_bytes, "tree_triangle.triangle_id");
}

// --- Nodes ----------------------------------------------------------------------------------------------------------

std::uint64_t place_of_node(const TreeRecord& tree, std::uint64_t index) {
  return tree.nodes_offset_bytes + index * sizeof(TreeNode);
}

constexpr std::uint64_t kOrderByNumber = 0xFEDCBA9876543210u;  // right for any number of children

// Each child once, those that are there first; the others by number.
bool is_order(std::uint64_t order, std::uint32_t child_count) {
  if (order == kOrderByNumber) return true;
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
// @param level_begins  gets the first node of each level, and the end of the last.
bool check_levels(ImageChecker& checker, std::uint64_t tree_base, const TreeRecord& tree, std::uint32_t* level_begins) {
  std::uint32_t numbered = 1, level_end = 1, depth = 1;
  level_begins[0] = 0;
  for (std::uint32_t i = 0; i < tree.node_count; ++i) {
    GRIDIRON_REQUIRE(i < numbered, tree_base, tree, node_count);
    if (i == level_end) {
      if (depth < kMaxTreeDepth) level_begins[depth] = i;
      ++depth;
      level_end = numbered;
    }
    const std::uint64_t base = place_of_node(tree, i);
    if (!check_children(checker, tree, base, checker.at<TreeNode>(base), i == 0, numbered)) return false;
  }
  GRIDIRON_REQUIRE(depth == tree.depth, tree_base, tree, depth);
  level_begins[depth] = tree.node_count;
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

// Compares boxes with those that are built.
class TreeBoxes {
 public:
  // Of four children of a node. The first that is wrong is the one to blame.
  void compare(std::uint64_t base, const TreeNode& node, std::uint32_t child, const QuadBox* boxes) {
    CornerQuad lows[4], highs[4];
    for (int i = 0; i < 4; ++i) {
      lows[i] = boxes[i].low;
      highs[i] = boxes[i].high;
    }
    const QuadRows low = QuadRows::of(lows), high = QuadRows::of(highs);
    const auto differ = [child](CornerQuad side, const float* sides) GRIDIRON_INLINE_LAMBDA {
      return Lanes<4>::words_of(side) ^ Lanes<4>::words_of(CornerQuad::load(sides + child));
    };
    using Int = Lanes<4>::Int;
    const Int in_low = differ(low.x, node.low[0]) | differ(low.y, node.low[1]) | differ(low.z, node.low[2]);
    const Int in_high = differ(high.x, node.high[0]) | differ(high.y, node.high[1]) | differ(high.z, node.high[2]);
    if (is_zero(in_low | in_high) || wrong_field_ != nullptr) return;
    const bool is_low = !is_zero(in_low);
    wrong_place_ = base + (is_low ? offsetof(TreeNode, low) : offsetof(TreeNode, high));
    wrong_field_ = is_low ? "node.low" : "node.high";
  }
  /// 0: none.
  [[nodiscard]] std::uint64_t wrong_place() const { return wrong_place_; }
  [[nodiscard]] bool check_all(ImageChecker& checker) const {
    return checker.require(wrong_field_ == nullptr, wrong_place_, wrong_field_);
  }

 private:
  [[nodiscard]] static GRIDIRON_INLINE bool is_zero(Lanes<4>::Int words) {
    return (words[0] | words[1] | words[2] | words[3]) == 0;
  }

  std::uint64_t wrong_place_ = 0;
  const char* wrong_field_ = nullptr;
};

// Checks nodes, the last one first, so that a wrong box is named, not that of its parent, which is made of it. Every
// child begins where the one before it ends, so the leaves of any node cover its records in order. A child that is a
// node has too many records for a leaf. Triangles and boxes are as built.
class NodeCheck {
 public:
  NodeCheck(ImageChecker& checker, const SceneImageView& view)
      : checker_(checker),
        view_(view),
        margin_(tree_margin_of(view.tree.bounds_minimum, view.tree.bounds_maximum)),
        triangles_(checker, view) {}

  [[nodiscard]] bool take(std::uint32_t i) {
    ImageChecker& checker = checker_;
    const TreeRecord& tree = view_.tree;
    const std::uint64_t base = place_of_node(tree, i);
    const auto& node = checker.at<TreeNode>(base);
    if (i > 0) ask_for_triangles(checker, tree, checker.at<TreeNode>(base - sizeof(TreeNode)));
    QuadBox boxes[kTreeWidth];
    std::uint64_t end = i == 0 ? 0 : run_of(checker, tree, node.children[0]).first;
    for (std::uint32_t k = 0; k < node.child_count; ++k) {
      const TreeChild child = node.children[k];
      const Run run = run_of(checker, tree, child);
      const bool is_large = child.is_leaf() || run.end > run.first + tree.leaf_triangles;
      GRIDIRON_REQUIRE(run.first == end && is_large, base, node, children);
      end = run.end;
      if (!child.is_leaf()) {
        boxes[k] = QuadBox::of_node(checker.at<TreeNode>(place_of_node(tree, child.node_index())));
        continue;
      }
      QuadBox leaf;
      if (!triangles_.take(run.first, run.end, leaf)) return false;
      boxes[k] = leaf.grown(margin_);
    }
    for (std::uint32_t k = 0; k < kTreeWidth; k += 4) boxes_.compare(base, node, k, boxes + k);
    if (i != 0) return true;
    GRIDIRON_REQUIRE(end == tree.triangle_count, base, node, children);
    GRIDIRON_REQUIRE((node.child_count == 1) == (end <= tree.leaf_triangles), base, node, child_count);
    return true;
  }

  [[nodiscard]] const TreeTotals& totals() const { return triangles_.totals(); }
  [[nodiscard]] const TreeBoxes& boxes() const { return boxes_; }

 private:
  ImageChecker& checker_;
  const SceneImageView& view_;
  float margin_;
  TreeTriangles triangles_;
  TreeBoxes boxes_;
};

// Of what is wrong that of the last node is named; a wrong triangle before a wrong box.
bool check_runs_and_contents(ImageChecker& checker, const SceneImageView& view, const std::uint32_t* level_begins) {
  const TreeRecord& tree = view.tree;
  const WorkSharing& sharing = checker.sharing();
  constexpr std::uint32_t kLeastNodes = 256;  // for a share
  const std::uint32_t most = tree.node_count / kLeastNodes + 1, count = shares_for(sharing);
  const std::uint32_t shares = count < most ? count : most;
  struct Found {
    SceneImageError error;
    std::uint32_t wrong_node;  // + 1; 0: none
    TreeTotals totals;
    TreeBoxes boxes;
  };
  Found found[kMostShares];
  // A share is a part of each level, as it is where the tree is built: what a core has written it has at hand.
  share(sharing, shares, [&](std::uint32_t i) {
    ImageChecker own(checker.image(), found[i].error, sharing);
    NodeCheck check(own, view);
    found[i].wrong_node = 0;
    for (std::uint32_t level = tree.depth; level-- > 0 && found[i].wrong_node == 0;) {
      const std::uint32_t begin = level_begins[level];
      const Share nodes = share_of(level_begins[level + 1] - begin, shares, i);
      for (auto k = begin + static_cast<std::uint32_t>(nodes.end); k-- > begin + nodes.begin;) {
        if (check.take(k)) continue;
        found[i].wrong_node = k + 1;
        break;
      }
    }
    found[i].totals = check.totals();
    found[i].boxes = check.boxes();
  });
  const Found* last = &found[0];
  TreeTotals totals;
  for (std::uint32_t i = 0; i < shares; ++i) {
    if (found[i].wrong_node > last->wrong_node) last = &found[i];
    totals.add(found[i].totals.bounds);
    totals.id_sum += found[i].totals.id_sum;
  }
  if (last->wrong_node != 0) return checker.require(false, last->error.byte_offset, last->error.field);
  if (!check_totals(checker, view, totals)) return false;
  for (std::uint32_t i = 0; i < shares; ++i) {
    if (found[i].boxes.wrong_place() > last->boxes.wrong_place()) last = &found[i];
  }
  return last->boxes.check_all(checker);
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
  std::uint32_t level_begins[kMaxTreeDepth + 1];
  return check_levels(checker, base, tree, level_begins) && check_runs_and_contents(checker, view, level_begins);
}

}  // namespace gridiron
