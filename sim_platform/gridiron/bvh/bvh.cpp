// Binned build by surface area, merging of pairs to four children, layout in cache lines.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/math.h>
#include <gridiron/build/build_step.h>
#include <gridiron/build/triangle_records.h>
#include <gridiron/bvh/bvh.h>
#include <gridiron/sim/machine_profile.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace gridiron::bvh {

namespace {

using sim::BuildStep;

constexpr std::uint32_t kMaxBins = 64;
constexpr std::uint32_t kMaxRecords = 1u << BvhChild::kFirstBits;

struct Box {
  float low[3] = {kFloatMax, kFloatMax, kFloatMax};
  float high[3] = {-kFloatMax, -kFloatMax, -kFloatMax};

  void grow(const Vec3& p) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  void grow(const Box& box) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], box.low[axis]);
      high[axis] = std::max(high[axis], box.high[axis]);
    }
  }
  /// Half the surface.
  [[nodiscard]] double area() const {
    double size[3];
    for (int axis = 0; axis < 3; ++axis) size[axis] = double{high[axis]} - double{low[axis]};
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
  }
  [[nodiscard]] double center(int axis) const { return 0.5 * (double{low[axis]} + double{high[axis]}); }
  [[nodiscard]] Vec3 center() const {
    return {static_cast<float>(center(0)), static_cast<float>(center(1)), static_cast<float>(center(2))};
  }
};

/// A node of the tree of pairs. first_child 0: a leaf with the triangles [first, first + count) of the order.
struct PairNode {
  Box box;
  std::uint32_t first_child = 0;  ///< the second one follows it
  std::uint32_t first = 0, count = 0;
};

struct Bin {
  Box box;
  std::uint32_t count = 0;
};

/// Which bin of an axis a triangle is in, by the centre of its box.
class Binning {
 public:
  Binning() = default;
  Binning(const Box& centers, int axis, std::uint32_t bin_count)
      : axis_(axis),
        low_(centers.low[axis]),
        scale_(bin_count / (double{centers.high[axis]} - low_)),
        last_(bin_count - 1) {}
  [[nodiscard]] std::uint32_t bin_of(const Box& box) const {
    return static_cast<std::uint32_t>(std::clamp((box.center(axis_) - low_) * scale_, 0.0, last_));
  }

 private:
  int axis_ = 0;
  double low_ = 0, scale_ = 0, last_ = 0;
};

struct Split {
  bool found = false;
  Binning binning;
  std::uint32_t bin = 0;  ///< the first bin of the right side
  double cost = 0;        ///< in tests of a box, times half surfaces
  Box left, right;        ///< of the triangles of each side
};

/// A part of a node's triangles.
struct Part {
  std::uint32_t count = 0;
  Box box, centers;  ///< of its triangles, and of their centres
};

class Builder {
 public:
  Builder(const MeshView& mesh, const BvhParameters& parameters, Bvh& bvh, const std::atomic<bool>* abort)
      : mesh_(mesh), parameters_(parameters), bvh_(bvh), abort_(abort) {}

  [[nodiscard]] Status build() {
    GRIDIRON_TRY(take_triangles());
    enter_step<BuildStep::kNodeMade>();
    GRIDIRON_TRY(build_pairs());
    enter_step<BuildStep::kNodeMerged>();
    merge_to_four();
    enter_step<BuildStep::kNodePlaced>();
    if (is_aborted()) return Status::kAborted;
    return lay_out();
  }

 private:
  [[nodiscard]] bool is_aborted() const { return abort_ != nullptr && abort_->load(std::memory_order_relaxed); }

  [[nodiscard]] Status take_triangles() {
    enter_step<BuildStep::kBvhVertexCheck>();
    for (const Vec3& vertex : mesh_.vertices) {
      for (int axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(vertex[axis])) return Status::kBadVertex;
      }
    }
    enter_step<BuildStep::kBvhTriangleSurvey>();
    if (mesh_.triangles.size() >= kMaxRecords) return Status::kTooManyTriangles;
    for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
      const UVec3& corners = mesh_.triangles[i];
      Box box;
      for (int corner = 0; corner < 3; ++corner) {
        if (corners[corner] >= mesh_.vertices.size()) return Status::kBadIndex;
        box.grow(mesh_.vertices[corners[corner]]);
      }
      if (has_zero_area(mesh_.vertices[corners.x], mesh_.vertices[corners.y], mesh_.vertices[corners.z])) continue;
      boxes_.push_back(box);
      ids_.push_back(i);
    }
    if (boxes_.empty()) return Status::kNoTriangles;
    bvh_.triangle_count = static_cast<std::uint32_t>(mesh_.triangles.size());
    return Status::kOk;
  }

  // Top down, with a list of open nodes instead of recursion.
  [[nodiscard]] Status build_pairs() {
    struct Open {
      std::uint32_t node, depth;
      Box centers;
    };
    const auto count = static_cast<std::uint32_t>(boxes_.size());
    enter_step<BuildStep::kBvhTriangleSurvey>();
    order_.resize(count);
    right_order_.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) order_[i] = i;
    enter_step<BuildStep::kNodeMade>();
    const Part all = part_of(0, count);
    pairs_.push_back({all.box, 0, 0, count});
    std::vector<Open> open = {{0, 1, all.centers}};
    while (!open.empty()) {
      if (is_aborted()) return Status::kAborted;
      const auto [index, depth, centers] = open.back();
      open.pop_back();
      const PairNode node = pairs_[index];
      Part left, right;
      if (!partition(node, depth, centers, left, right)) continue;
      const auto first_child = static_cast<std::uint32_t>(pairs_.size());
      pairs_[index].first_child = first_child;
      pairs_.push_back({left.box, 0, node.first, left.count});
      pairs_.push_back({right.box, 0, node.first + left.count, right.count});
      open.push_back({first_child + 1, depth + 1, right.centers});
      open.push_back({first_child, depth + 1, left.centers});
    }
    bvh_.counts.binary_nodes = pairs_.size();
    return Status::kOk;
  }

  [[nodiscard]] Part part_of(std::uint32_t first, std::uint32_t count) {
    bvh_.counts.boxes_bounded += count;
    enter_step<BuildStep::kBoxBound>();
    Part part{.count = count, .box = {}, .centers = {}};
    for (std::uint32_t i = first; i < first + count; ++i) {
      const Box& box = boxes_[order_[i]];
      part.box.grow(box);
      part.centers.grow(box.center());
    }
    enter_step<BuildStep::kNodeMade>();
    return part;
  }

  // Partitions the node's triangles. @returns false: it becomes a leaf.
  [[nodiscard]] bool partition(const PairNode& node, std::uint32_t depth, const Box& centers, Part& left, Part& right) {
    if (node.count == 1) return false;
    // The remaining depth must suffice for halving.
    const bool must_halve = depth + std::bit_width(node.count - 1) >= kMaxBvhDepth;
    const Split split = must_halve ? Split{} : best_split(node, centers);
    if (node.count <= parameters_.leaf_triangles) {
      const double leaf_cost = double{parameters_.triangle_cost} * node.count * node.box.area();
      if (!split.found || split.cost >= leaf_cost) return false;
    }
    if (split.found) {
      move_triangles(node, split, left, right);
    } else {
      // All centres are equal, or the tree would get too deep.
      halve(node, widest_axis(centers));
      left = part_of(node.first, node.count / 2);
      right = part_of(node.first + left.count, node.count - left.count);
    }
    return true;
  }

  // Keeps the order on each side. Boxes of the sides are known from the bins, those of their centres are not.
  void move_triangles(const PairNode& node, const Split& split, Part& left, Part& right) {
    enter_step<BuildStep::kTriangleMoved>();
    bvh_.counts.triangles_moved += node.count;
    if (node.count > BuildCounts::kNearTriangles && node.count <= order_.size() / 4) {
      bvh_.counts.far_triangles += node.count;
    }
    left.box = split.left;
    right.box = split.right;
    std::uint32_t* const order = &order_[node.first];
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const std::uint32_t triangle = order[i];
      const Box& box = boxes_[triangle];
      if (split.binning.bin_of(box) < split.bin) {
        left.centers.grow(box.center());
        order[left.count++] = triangle;
      } else {
        right.centers.grow(box.center());
        right_order_[right.count++] = triangle;
      }
    }
    std::copy_n(right_order_.begin(), right.count, order + left.count);
    enter_step<BuildStep::kNodeMade>();
  }

  void halve(const PairNode& node, int axis) {
    enter_step<BuildStep::kTriangleHalved>();
    bvh_.counts.halving_steps += std::uint64_t{node.count} * static_cast<std::uint64_t>(std::bit_width(node.count));
    const auto begin = order_.begin() + node.first;
    const auto end = begin + node.count;
    const std::uint32_t half = node.count / 2;
    std::nth_element(begin, begin + half, end, [&](std::uint32_t a, std::uint32_t b) {
      const double center_a = boxes_[a].center(axis), center_b = boxes_[b].center(axis);
      return center_a != center_b ? center_a < center_b : a < b;
    });
    // nth_element leaves an order that depends on the library; a sorted one does not.
    std::sort(begin, begin + half);
    std::sort(begin + half, end);
    enter_step<BuildStep::kNodeMade>();
  }

  [[nodiscard]] static int widest_axis(const Box& box) {
    int widest = 0;
    for (int axis = 1; axis < 3; ++axis) {
      if (box.high[axis] - box.low[axis] > box.high[widest] - box.low[widest]) widest = axis;
    }
    return widest;
  }

  [[nodiscard]] Split best_split(const PairNode& node, const Box& centers) {
    const std::uint32_t bin_count = parameters_.bin_count;
    const bool every_axis = node.count >= parameters_.every_axis_from;
    Split best;
    for (int axis = every_axis ? 0 : widest_axis(centers); axis < 3; axis = every_axis ? axis + 1 : 3) {
      if (!(centers.high[axis] > centers.low[axis])) continue;
      const Binning binning(centers, axis, bin_count);
      enter_step<BuildStep::kBinSwept>();
      bins_.assign(bin_count, Bin{});
      enter_step<BuildStep::kBinUpdate>();
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const Box& box = boxes_[order_[i]];
        Bin& bin = bins_[binning.bin_of(box)];
        bin.box.grow(box);
        ++bin.count;
      }
      enter_step<BuildStep::kBinSwept>();
      bvh_.counts.bin_updates += node.count;
      bvh_.counts.bins_swept += 2 * bin_count;
      rights_.resize(bin_count);
      Bin right;
      for (std::uint32_t i = bin_count - 1; i > 0; --i) {
        right.box.grow(bins_[i].box);
        right.count += bins_[i].count;
        rights_[i] = right;
      }
      Box left;
      std::uint32_t left_count = 0;
      for (std::uint32_t i = 1; i < bin_count; ++i) {
        left.grow(bins_[i - 1].box);
        left_count += bins_[i - 1].count;
        if (left_count == 0 || left_count == node.count) continue;
        // Two more boxes to test at each visit of the node.
        const double cost =
            2.0 * node.box.area() +
            double{parameters_.triangle_cost} * (left.area() * left_count + rights_[i].box.area() * rights_[i].count);
        if (!best.found || cost < best.cost) best = {true, binning, i, cost, left, rights_[i].box};
      }
      enter_step<BuildStep::kNodeMade>();
    }
    return best;
  }

  // Opens the child with the largest surface until there are four.
  void merge_to_four() {
    struct Open {
      std::uint32_t node, depth;
    };
    wide_.push_back({{0}, 1});
    std::vector<Open> open = {{0, 1}};
    wide_of_pair_.assign(pairs_.size(), 0);
    while (!open.empty()) {
      const Open current = open.back();
      open.pop_back();
      bvh_.depth = std::max(bvh_.depth, current.depth);
      std::array<std::uint32_t, kNodeWidth> children{};
      std::uint32_t count = 1;
      children[0] = wide_[current.node].children[0];  // the pair node that it replaces
      while (count < kNodeWidth) {
        std::uint32_t widest = kNodeWidth;
        for (std::uint32_t i = 0; i < count; ++i) {
          if (pairs_[children[i]].first_child == 0) continue;
          if (widest == kNodeWidth || pairs_[children[i]].box.area() > pairs_[children[widest]].box.area()) widest = i;
        }
        if (widest == kNodeWidth) break;
        const std::uint32_t opened = pairs_[children[widest]].first_child;
        children[widest] = opened;
        children[count++] = opened + 1;
      }
      wide_[current.node] = {children, count};
      for (std::uint32_t i = 0; i < count; ++i) {
        if (pairs_[children[i]].first_child == 0) continue;
        wide_of_pair_[children[i]] = static_cast<std::uint32_t>(wide_.size());
        open.push_back({static_cast<std::uint32_t>(wide_.size()), current.depth + 1});
        wide_.push_back({{children[i]}, 1});
      }
    }
    bvh_.counts.wide_nodes = wide_.size();
  }

  // Fills cache lines with pieces of the tree: a node, then repeatedly the child with the largest surface of the nodes
  // in the line. Nodes that do not fit begin lines of their own. Triangles follow in the order of the nodes.
  [[nodiscard]] Status lay_out() {
    std::vector<std::uint32_t> place(wide_.size());
    std::vector<std::uint32_t> sequence;
    std::vector<std::uint32_t> roots = {0};
    const std::uint32_t line_nodes = parameters_.line_nodes;
    std::vector<std::uint32_t> frontier;
    while (!roots.empty()) {
      frontier.assign(1, roots.back());
      roots.pop_back();
      // A line that is not full takes the next piece if the piece's root fits.
      std::uint32_t room = line_nodes - static_cast<std::uint32_t>(sequence.size()) % line_nodes;
      for (; room != 0 && !frontier.empty(); --room) {
        const auto larger = [&](std::uint32_t a, std::uint32_t b) { return box_of(a).area() < box_of(b).area(); };
        const auto next = std::max_element(frontier.begin(), frontier.end(), larger);
        const std::uint32_t node = *next;
        frontier.erase(next);
        place[node] = static_cast<std::uint32_t>(sequence.size());
        sequence.push_back(node);
        for (std::uint32_t i = 0; i < wide_[node].count; ++i) {
          const std::uint32_t child = wide_[node].children[i];
          if (pairs_[child].first_child != 0) frontier.push_back(wide_of_pair_[child]);
        }
      }
      roots.insert(roots.end(), frontier.rbegin(), frontier.rend());
    }
    const std::size_t padded = (sequence.size() + line_nodes - 1) / line_nodes * line_nodes;
    enter_step<BuildStep::kNodeWritten>();
    bvh_.nodes.assign(padded, BvhNode{});
    for (std::uint32_t i = 0; i < sequence.size(); ++i) GRIDIRON_TRY(write_node(wide_[sequence[i]], place, i));
    enter_step<BuildStep::kNodeWritten>();
    while (bvh_.triangles.size() % parameters_.line_triangles != 0) bvh_.triangles.push_back(VertexTriangle{});
    std::copy_n(pairs_[0].box.low, 3, bvh_.low);
    std::copy_n(pairs_[0].box.high, 3, bvh_.high);
    return Status::kOk;
  }

  [[nodiscard]] Status write_node(const auto& wide, const std::vector<std::uint32_t>& place, std::uint32_t index) {
    enter_step<BuildStep::kNodeWritten>();
    BvhNode& node = bvh_.nodes[index];
    node.child_count = wide.count;
    for (std::uint32_t i = 0; i < kNodeWidth; ++i) {
      const Box box = i < wide.count ? pairs_[wide.children[i]].box : Box{};
      for (int axis = 0; axis < 3; ++axis) {
        node.bounds[0][axis][i] = box.low[axis];
        node.bounds[1][axis][i] = box.high[axis];
      }
      node.children[i].bits = BvhChild::kNone;
      if (i >= wide.count) continue;
      const PairNode& child = pairs_[wide.children[i]];
      if (child.first_child != 0) {
        node.children[i] = BvhChild::node(place[wide_of_pair_[wide.children[i]]]);
        continue;
      }
      const std::uint32_t line = parameters_.line_triangles;
      if (bvh_.triangles.size() % line + child.count > line) {
        while (bvh_.triangles.size() % line != 0) bvh_.triangles.push_back(VertexTriangle{});
      }
      if (bvh_.triangles.size() + child.count > kMaxRecords) return Status::kTooManyTriangles;
      node.children[i] = BvhChild::leaf(static_cast<std::uint32_t>(bvh_.triangles.size()), child.count);
      ++bvh_.counts.leaves;
      enter_step<BuildStep::kBvhTriangleWrite>();
      for (std::uint32_t k = child.first; k < child.first + child.count; ++k) append_record(ids_[order_[k]]);
      enter_step<BuildStep::kNodeWritten>();
    }
    return Status::kOk;
  }

  void append_record(std::uint32_t id) {
    VertexTriangle record{};
    const UVec3& corners = mesh_.triangles[id];
    for (int corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis) record.v[corner][axis] = mesh_.vertices[corners[corner]][axis];
    }
    record.triangle_id = id;
    bvh_.triangles.push_back(record);
    ++bvh_.counts.records_written;
  }

  /// Children are pair nodes; before a node is opened, the first one is the pair node that it replaces.
  struct WideNode {
    std::array<std::uint32_t, kNodeWidth> children{};
    std::uint32_t count = 0;
  };

  [[nodiscard]] Box box_of(std::uint32_t wide) const {
    Box box;
    for (std::uint32_t i = 0; i < wide_[wide].count; ++i) box.grow(pairs_[wide_[wide].children[i]].box);
    return box;
  }

  const MeshView& mesh_;
  const BvhParameters& parameters_;
  Bvh& bvh_;
  const std::atomic<bool>* abort_;
  std::vector<Box> boxes_;                  ///< of the triangles that are kept
  std::vector<std::uint32_t> ids_;          ///< their places in the mesh
  std::vector<std::uint32_t> order_;        ///< of the kept triangles
  std::vector<std::uint32_t> right_order_;  ///< of the right side, while a node's triangles are moved
  std::vector<Bin> bins_;                   ///< of the node that is split
  std::vector<Bin> rights_;                 ///< right sides, by their first bins
  std::vector<PairNode> pairs_;
  std::vector<WideNode> wide_;
  std::vector<std::uint32_t> wide_of_pair_;
};

}  // namespace

Status build_bvh(const MeshView& mesh, const BvhParameters& parameters, Bvh& bvh, const std::atomic<bool>* abort) {
  const auto in_range = [](std::uint32_t value, std::uint32_t least, std::uint32_t most) {
    return value >= least && value <= most;
  };
  if (!in_range(parameters.bin_count, 2, kMaxBins) || !in_range(parameters.leaf_triangles, 1, kMaxLeafTriangles) ||
      !in_range(parameters.line_triangles, 2, kMaxLineTriangles) || parameters.line_triangles % 2 != 0 ||
      parameters.line_triangles < parameters.leaf_triangles || !in_range(parameters.line_nodes, 1, 32) ||
      !(parameters.triangle_cost > 0.0f) || !std::isfinite(parameters.triangle_cost)) {
    return Status::kBadParameter;
  }
  enter_step<BuildStep::kBvhOnce>();
  bvh = Bvh{};
  bvh.parameters = parameters;
  return Builder(mesh, bvh.parameters, bvh, abort).build();
}

}  // namespace gridiron::bvh
