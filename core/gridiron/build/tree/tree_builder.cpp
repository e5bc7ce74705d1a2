// Building the wide tree: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/lanes.h>
#include <gridiron/build/build_step.h>
#include <gridiron/build/mesh_quads.h>
#include <gridiron/build/shared_parts.h>
#include <gridiron/build/tree/tree_box.h>
#include <gridiron/build/tree/tree_builder.h>
#include <gridiron/build/tree/tree_curve.h>
#include <gridiron/build/tree/tree_order.h>
#include <gridiron/build/tree/tree_splits.h>

#include <cstddef>

namespace gridiron {
namespace {

// Sorts keys by their codes, equal ones in the order they have, digit by digit: to `to` if there is an odd number of
// digits, else back to `from`. Both are changed.
template <std::uint32_t kDigitBits, TreeStep kKeyStep, TreeStep kValueStep = TreeStep::kDigitValue>
void sort_keys(TreeKey* from, TreeKey* to, std::uint32_t count, std::uint32_t* counts) {
  constexpr std::uint32_t kDigits = kTreeCodeBits / kDigitBits, kValues = 1u << kDigitBits;
  static_assert(kDigits * kDigitBits == kTreeCodeBits);
  const auto digit_of = [](TreeKey key, std::uint32_t digit)
                            GRIDIRON_INLINE_LAMBDA { return (key.code() >> kDigitBits * digit) % kValues; };
  enter_step<kValueStep>();
  for (std::uint32_t i = 0; i < kDigits * kValues; ++i) counts[i] = 0;
  enter_step<kKeyStep>();
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t digit = 0; digit < kDigits; ++digit) ++counts[digit * kValues + digit_of(from[i], digit)];
  }
  for (std::uint32_t digit = 0; digit < kDigits; ++digit) {
    enter_step<kValueStep>();
    std::uint32_t* const places = counts + digit * kValues;
    std::uint32_t sum = 0;
    for (std::uint32_t i = 0; i < kValues; ++i) {
      const std::uint32_t here = places[i];
      places[i] = sum;
      sum += here;
    }
    enter_step<kKeyStep>();
    // Several keys are read before the first of them is written: a processor that has once seen a place read right
    // after it was written would let each key wait for the one before.
    constexpr std::uint32_t kGroup = 8;
    std::uint32_t i = 0;
    for (; count - i >= kGroup; i += kGroup) {
      TreeKey keys[kGroup];
      for (std::uint32_t k = 0; k < kGroup; ++k) keys[k] = from[i + k];
      for (const TreeKey key : keys) to[places[digit_of(key, digit)]++] = key;
    }
    for (; i < count; ++i) to[places[digit_of(from[i], digit)]++] = from[i];
    TreeKey* const sorted = to;
    to = from;
    from = sorted;
  }
}
constexpr std::uint32_t kFewKeysDigit = 5, kKeysDigit = 10, kManyKeysDigit = 15;  // bits
constexpr std::uint32_t kFewSortedKeys = 1024;

// Nodes ahead of the one that is split whose keys are asked for, at most so many.
constexpr std::uint32_t kNodesAhead = 2, kFewKeys = 256;

// Asks the caches for elements.
template <class Element>
void ask_for(const Element* elements, std::uint32_t count) {
  const auto* const bytes = reinterpret_cast<const std::byte*>(elements);
  for (std::uint32_t offset = 0; offset < count * sizeof(Element); offset += 64) __builtin_prefetch(bytes + offset);
}

// What a mesh's records are.
struct VertexForm {
  using Record = VertexTriangle;

  explicit VertexForm(const MeshView&) {}
  // Writes a triangle's record. @returns its corners.
  static GRIDIRON_INLINE CornerQuads write(const MeshView& mesh, std::uint32_t id, Record& record) {
    const CornerQuads corners = corners_of(mesh, mesh.triangles[id]);
    // Each store overwrites the last lane of the one before; the last lane of a corner is 0.
    auto* const bytes = reinterpret_cast<std::byte*>(&record);
    const std::uint64_t end = std::uint64_t{id} << 32;
    static_assert(offsetof(Record, reserved) == 36 && offsetof(Record, triangle_id) == 44);
    __builtin_memcpy(bytes, &corners.a, sizeof corners.a);
    __builtin_memcpy(bytes + 12, &corners.b, sizeof corners.b);
    __builtin_memcpy(bytes + 24, &corners.c, sizeof corners.c);
    __builtin_memcpy(bytes + 40, &end, sizeof end);
    return corners;
  }
};

struct LatticeForm {
  using Record = LatticeTriangle;
  Lattice lattice;

  explicit LatticeForm(const LatticeMesh& mesh) : lattice(mesh.vertices.lattice) {}
  CornerQuads write(const LatticeMesh& mesh, std::uint32_t id, Record& record) const {
    const UVec3& t = mesh.triangles[id];
    record = {};
    CornerQuad corners[3];
    for (int corner = 0; corner < 3; ++corner) {
      const LatticePoint p = lattice_point(lattice, mesh.vertices.vertices[t[corner]]);
      Vec3 point;
      for (int axis = 0; axis < 3; ++axis) {
        record.v[corner][axis] = p.place[axis];
        // Exact: see Lattice.
        point[axis] = lattice.origin[axis] + lattice.step * static_cast<float>(std::int32_t{p.place[axis]});
      }
      corners[corner] = quad_of(point);
    }
    record.triangle_id = id;
    return {corners[0], corners[1], corners[2]};
  }
};

std::span<const Vec3> part_of(std::span<const Vec3> vertices, const Share& part) {
  return vertices.subspan(part.begin, part.size());
}
LatticeVertices part_of(const LatticeVertices& vertices, const Share& part) {
  return {part_of(vertices.vertices, part), vertices.lattice};
}

bool bound_vertices(std::span<const Vec3> vertices, QuadBox& box) {
  return bound_points(vertices, box);
}
bool bound_vertices(const LatticeVertices& vertices, QuadBox& box) {
  bool are_inside = true;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3 point = vertices[i];
    QuadBox one;
    are_inside = bound_points({&point, 1}, one) && are_inside;
    box.add(one.low);
  }
  return are_inside;
}

template <class Mesh, class Form>
class TreeBuilder : private TreeSplits<TreeBuilder<Mesh, Form>> {
 public:
  using Record = typename Form::Record;

  TreeBuilder(const Mesh& mesh, std::uint32_t leaf_triangles, std::span<Record> records, std::span<TreeNode> nodes,
              std::span<std::byte> scratch, TreeSize& size, TreeOrder order, const WorkSharing& sharing)
      : Splits(leaf_triangles),
        mesh_(mesh),
        form_(mesh),
        records_(records),
        nodes_(nodes),
        keys_(reinterpret_cast<TreeKey*>(scratch.data())),
        spare_(keys_ + mesh.triangles.size()),
        counts_(reinterpret_cast<std::uint32_t*>(spare_ + mesh.triangles.size())),
        size_(size),
        order_(order),
        sharing_(sharing),
        shares_(shares_of(mesh.triangles.size(), records.size_bytes(), sharing)) {}

  [[nodiscard]] Status build() {
    size_ = {};
    QuadBox vertices;
    enter_step<TreeStep::kVertexBound>();
    if (!bound_all_vertices(vertices)) return Status::kBadVertex;
    enter_step<TreeStep::kTriangleCode>();
    GRIDIRON_TRY(take_triangles(vertices));
    enter_step<TreeStep::kNodeSplit>();
    const std::uint32_t count = size_.triangle_count;
    if (count > records_.size()) return Status::kMemoryTooSmall;
    GRIDIRON_TRY(split_all(count));
    enter_step<TreeStep::kNodeWrite>();
    write_all();
    enter_step<TreeStep::kOnce>();
    return Status::kOk;
  }

 private:
  using Splits = TreeSplits<TreeBuilder>;
  friend Splits;

  // --- Triangles --------------------------------------------------------------------------------------------------

  // Each share sorts with counts of its own, all but the first in memory of the records, which are not there yet.
  static constexpr std::uint32_t kManyKeysCounts = 2u << kManyKeysDigit, kCrowdCounts = 3u << kKeysDigit;
  [[nodiscard]] std::uint32_t* counts_of(std::uint32_t share, std::uint32_t size) const {
    return share == 0 ? counts_ : reinterpret_cast<std::uint32_t*>(records_.data()) + (share - 1) * size;
  }
  [[nodiscard]] static std::uint32_t shares_of(std::size_t triangle_count, std::size_t record_bytes,
                                               const WorkSharing& sharing) {
    if (triangle_count < kManyTreeTriangles) return 1;
    const std::size_t room = record_bytes / (kManyKeysCounts * sizeof(std::uint32_t)) + 1;
    const std::uint32_t wanted = shares_for(sharing);
    return wanted < room ? wanted : static_cast<std::uint32_t>(room);
  }

  [[nodiscard]] bool bound_all_vertices(QuadBox& box) {
    QuadBox boxes[kMostShares];
    bool are_right[kMostShares] = {};
    share(sharing_, shares_, [&](std::uint32_t i) {
      are_right[i] = bound_vertices(part_of(mesh_.vertices, share_of(mesh_.vertices.size(), shares_, i)), boxes[i]);
    });
    bool all_are = true;
    for (std::uint32_t i = 0; i < shares_; ++i) {
      all_are = all_are && are_right[i];
      box.low = Lanes<4>::min(boxes[i].low, box.low);
      box.high = Lanes<4>::max(boxes[i].high, box.high);
    }
    return all_are;
  }

  // What coding a share of the triangles has found. Its keys lie from the place of its first triangle on.
  struct CodedShare {
    Status status;
    std::uint32_t count;
    FourBoxes bounds;
  };

  // Sorts the triangles that have an area by their codes, and bounds them.
  [[nodiscard]] Status take_triangles(const QuadBox& vertices) {
    // The least and the greatest middle that a triangle can have.
    const TreeCurve curve({vertices.low + vertices.low, vertices.high + vertices.high});
    CodedShare coded[kMostShares];
    share(sharing_, shares_, [&](std::uint32_t i) { coded[i] = code_share(curve, triangles_of(i)); });
    FourBoxes bounds = FourBoxes::none();
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < shares_; ++i) {
      GRIDIRON_TRY(coded[i].status);
      bounds.add(coded[i].bounds);
      count += coded[i].count;
    }
    if (count == 0) return Status::kNoTriangles;
    size_.triangle_count = count;
    size_.dropped_triangle_count = static_cast<std::uint32_t>(mesh_.triangles.size()) - count;
    const QuadBox all = QuadBox::around(bounds);
    for (int axis = 0; axis < 3; ++axis) {
      size_.low[axis] = all.low.v[axis];
      size_.high[axis] = all.high.v[axis];
    }
    sort_all(coded);
    return Status::kOk;
  }
  [[nodiscard]] Share triangles_of(std::uint32_t i) const { return share_of(mesh_.triangles.size(), shares_, i, 4); }

  [[nodiscard]] CodedShare code_share(const TreeCurve& curve, const Share& part) const {
    const auto begin = static_cast<std::uint32_t>(part.begin);
    TreeKey* const keys = spare_ + begin;
    FourBoxes bounds = FourBoxes::none();
    std::uint32_t count = 0;
    const auto take = [&](std::uint32_t place, const FourTriangles& triangles, std::uint32_t kept)
                          GRIDIRON_INLINE_LAMBDA {
                            const std::uint32_t first = begin + place;
                            FourBoxes boxes = triangles.boxes();
                            const Lanes<4>::Int codes = curve.codes_of(boxes);
                            if (kept == 15u) {
                              TreeKey::store_four(codes, first, keys + count);
                              count += 4;
                            } else {
                              for (int lane = 0; lane < 4; ++lane) {
                                if ((kept >> lane & 1u) == 0) continue;
                                const auto code = static_cast<std::uint32_t>(codes[lane]);
                                keys[count++] = TreeKey::of(code, first + static_cast<std::uint32_t>(lane));
                              }
                              boxes.keep(kept);
                            }
                            bounds.add(boxes);
                          };
    const Status status = for_each_four(Mesh{mesh_.vertices, mesh_.triangles.subspan(part.begin, part.size())}, take);
    return {status, count, bounds};
  }

  void sort_all(const CodedShare* coded) {
    const std::uint32_t count = size_.triangle_count;
    if (kSharesWork && shares_ > 1) {
      sort_shares(coded);
    } else if (mesh_.triangles.size() < kManyTreeTriangles) {
      sort_keys<kKeysDigit, kPricedStep<TreeStep::kKeySorted>>(spare_, keys_, count, counts_);
    } else {
      sort_keys<kManyKeysDigit, kPricedStep<TreeStep::kKeyScattered>>(spare_, keys_, count, counts_);
      ends_ = counts_ + (1u << kManyKeysDigit);
      TreeKey* const sorted = spare_;
      spare_ = keys_;
      keys_ = sorted;
    }
  }

  // Sorts as sort_keys() does. First keys go to ranges of codes, one for each share, then each share sorts a range.
  void sort_shares(const CodedShare* coded) {
    constexpr std::uint32_t kBits = 10, kShift = kTreeCodeBits - kBits, kValues = 1u << kBits;
    static_assert(kMostShares * kValues <= kManyKeysCounts);
    const std::uint32_t all = size_.triangle_count;
    share(sharing_, shares_, [&](std::uint32_t i) {
      std::uint32_t* const counts = counts_ + i * kValues;
      for (std::uint32_t value = 0; value < kValues; ++value) counts[value] = 0;
      const TreeKey* const keys = spare_ + triangles_of(i).begin;
      for (std::uint32_t k = 0; k < coded[i].count; ++k) ++counts[keys[k].code() >> kShift];
    });
    // Ranges of nearly as many keys; where a key of a share goes: behind those of the shares before it.
    std::uint8_t range_of[kValues];
    std::uint32_t begins[kMostSharers + 1], places[kMostSharers][kMostSharers] = {};
    std::uint32_t before = 0;
    for (std::uint32_t value = 0; value < kValues; ++value) {
      const auto range = static_cast<std::uint8_t>(std::uint64_t{before} * shares_ / (std::uint64_t{all} + 1));
      range_of[value] = range;
      for (std::uint32_t i = 0; i < shares_; ++i) {
        places[i][range] += counts_[i * kValues + value];
        before += counts_[i * kValues + value];
      }
    }
    for (std::uint32_t range = 0, place = 0; range < shares_; ++range) {
      begins[range] = place;
      for (std::uint32_t i = 0; i < shares_; ++i) {
        const std::uint32_t here = places[i][range];
        places[i][range] = place;
        place += here;
      }
    }
    begins[shares_] = all;
    share(sharing_, shares_, [&](std::uint32_t i) {
      const TreeKey* const keys = spare_ + triangles_of(i).begin;
      std::uint32_t next[kMostSharers];
      for (std::uint32_t range = 0; range < shares_; ++range) next[range] = places[i][range];
      for (std::uint32_t k = 0; k < coded[i].count; ++k) keys_[next[range_of[keys[k].code() >> kShift]]++] = keys[k];
    });
    share(sharing_, shares_, [&](std::uint32_t range) {
      const std::uint32_t begin = begins[range];
      sort_keys<kManyKeysDigit, kPricedStep<TreeStep::kKeyScattered>>(
          keys_ + begin, spare_ + begin, begins[range + 1] - begin, counts_of(range, kManyKeysCounts));
    });
    // The ends of the keys of each value of the high digit, as one share would have left them.
    constexpr std::uint32_t kEnds = 1u << (kManyKeysDigit - kBits);
    std::uint32_t* const ends = counts_ + (1u << kManyKeysDigit);
    for (std::uint32_t value = 0; value < kValues; ++value) {
      const std::uint32_t range = range_of[value];
      const std::uint32_t* const own = counts_of(range, kManyKeysCounts) + (1u << kManyKeysDigit);
      for (std::uint32_t k = value * kEnds; k < (value + 1) * kEnds; ++k) ends[k] = begins[range] + own[k];
    }
    ends_ = ends;
  }

  // --- Nodes ------------------------------------------------------------------------------------------------------

  // Level by level: nodes that are still to be split lie behind those that are done.
  [[nodiscard]] Status split_all(std::uint32_t count) {
    size_.node_count = 0;
    GRIDIRON_TRY(append_node(0, count, 1));
    if (kSharesWork && shares_ > 1) return split_levels();
    for (std::uint32_t i = 0; i < size_.node_count; ++i) {
      ask_ahead(i, size_.node_count);
      GRIDIRON_TRY(split(nodes_[i]));
      GRIDIRON_TRY(number_children(nodes_[i]));
    }
    return Status::kOk;
  }
  // The nodes of a level are split one by one, and then numbered in order.
  [[nodiscard]] Status split_levels() {
    for (std::uint32_t begin = 0; begin < size_.node_count;) {
      const std::uint32_t end = size_.node_count;
      const NodeShares shares(*this, end - begin);
      Status statuses[NodeShares::kMost];
      share(sharing_, shares.count, [&](std::uint32_t i) {
        TreeBuilder own(*this);
        own.counts_ = counts_of(i, kCrowdCounts);
        statuses[i] = own.split_nodes(begin + shares.begin(i), begin + shares.begin(i + 1));
      });
      for (std::uint32_t i = 0; i < shares.count; ++i) GRIDIRON_TRY(statuses[i]);
      for (; begin < end; ++begin) GRIDIRON_TRY(number_children(nodes_[begin]));
    }
    return Status::kOk;
  }
  [[nodiscard]] Status split_nodes(std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) {
      ask_ahead(i, end);
      GRIDIRON_TRY(split(nodes_[i]));
    }
    return Status::kOk;
  }
  void ask_ahead(std::uint32_t node, std::uint32_t end) const {
    if (end - node <= kNodesAhead) return;
    const TreeNode& later = nodes_[node + kNodesAhead];
    const std::uint32_t first = later.children[0].bits, last = later.children[1].bits;
    ask_for(keys_ + first, last - first < kFewKeys ? last - first : kFewKeys);
  }

  // Shares of the nodes of a level: more than there are sharers, as some nodes take longer than others.
  struct NodeShares {
    static constexpr std::uint32_t kTurns = 4, kMost = kMostShares * kTurns, kLeastNodes = 4;  // of a share
    // Their counts fit where those for sorting were: of two sharers, and of each further one.
    static_assert((2 * kTurns - 1) * kCrowdCounts <= kManyKeysCounts && kTurns * kCrowdCounts <= kManyKeysCounts);
    std::uint32_t nodes, count;

    NodeShares(const TreeBuilder& builder, std::uint32_t of) : nodes(of), count((of + kLeastNodes - 1) / kLeastNodes) {
      const std::uint32_t most = builder.shares_ * kTurns;
      count = count < most ? count : most;
    }
    [[nodiscard]] std::uint32_t begin(std::uint32_t i) const {
      return static_cast<std::uint32_t>(std::uint64_t{nodes} * i / count);
    }
  };

  // Until a node is split it holds its range and its depth.
  [[nodiscard]] Status append_node(std::uint32_t begin, std::uint32_t end, std::uint32_t depth) {
    if (size_.node_count == nodes_.size()) return Status::kMemoryTooSmall;
    TreeNode& node = nodes_[size_.node_count++];
    node.children[0].bits = begin;
    node.children[1].bits = end;
    node.children[2].bits = depth;
    if (depth > size_.depth) {
      size_.depth = depth;
      level_begins_[depth - 1] = size_.node_count - 1;
    }
    return Status::kOk;
  }

  [[nodiscard]] Status split(TreeNode& node) {
    const std::uint32_t begin = node.children[0].bits, end = node.children[1].bits, depth = node.children[2].bits;
    TreeRange ranges[kTreeWidth];
    std::uint32_t count = 0;
    GRIDIRON_TRY(this->split_range(begin, end, depth, ranges, count));
    // Boxes are written at last.
    __builtin_memset(node.children, 0, sizeof(TreeNode) - offsetof(TreeNode, children));
    node.child_count = count;
    bool are_leaves = true;
    for (std::uint32_t i = 0; i < count; ++i) {
      const TreeRange& range = ranges[i];
      const bool is_leaf = range.level < 0;
      node.children[i] = is_leaf ? TreeChild::leaf(range.begin, range.end - range.begin) : TreeChild{range.begin};
      are_leaves = are_leaves && is_leaf;
    }
    // Until the children are numbered.
    node.reserved[0] = are_leaves ? std::uint32_t{0} : depth;
    node.reserved[1] = end;
    return Status::kOk;
  }
  // Appends those children that are nodes.
  [[nodiscard]] Status number_children(TreeNode& node) {
    const std::uint32_t depth = node.reserved[0], end = node.reserved[1];
    node.reserved[0] = node.reserved[1] = 0;
    if (depth == 0) return Status::kOk;
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      if (node.children[i].is_leaf()) continue;
      const std::uint32_t child_begin = node.children[i].bits;
      // Children cover the range in order.
      const std::uint32_t child_end = i + 1 < node.child_count ? node.children[i + 1].first() : end;
      node.children[i] = TreeChild::node(size_.node_count);
      GRIDIRON_TRY(append_node(child_begin, child_end, depth + 1));
    }
    return Status::kOk;
  }

  // Where a kind of work begins.
  GRIDIRON_INLINE void count_work(SplitWork work, std::uint32_t) const {
    if (work == SplitWork::kLeaf) enter_step<TreeStep::kLeafSplit>();
    if (work == SplitWork::kPart) enter_step<TreeStep::kNodeSplit>();
  }
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t code_of(std::uint32_t i) const { return keys_[i].code(); }
  [[nodiscard]] std::uint32_t whole_count() const { return size_.triangle_count; }

  // Where a part is split.
  [[nodiscard]] std::uint32_t middle_of(const TreeRange& part) const {
    const std::uint32_t first = code_of(part.begin), last = code_of(part.end - 1);
    if (ends_ == nullptr || part.level <= static_cast<std::int32_t>(kManyKeysDigit) || (first & kTreeCodedAgain) != 0) {
      return this->first_like_last(part.begin, part.end, first, last);
    }
    // Sorting by the high digit has left the end of the keys of each of its values.
    const std::uint32_t bit = 1u << (part.level - 1);
    return ends_[((last & ~(bit - 1)) >> kManyKeysDigit) - 1];
  }

  static void number(TreeKey* keys, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) keys[i] = numbered(i, keys[i].id());
  }

  // The boxes of the triangles of the next four keys; if fewer are left, of the last one again.
  [[nodiscard]] FourBoxes boxes_of(const TreeKey* keys, std::uint32_t left) const {
    CornerQuads corners[4];
    for (std::uint32_t k = 0; k < 4; ++k) {
      corners[k] = corners_of(mesh_, mesh_.triangles[keys[k < left ? k : left - 1].id()]);
    }
    return FourTriangles::of(corners).boxes();
  }

  // Gives triangles of one code new ones that differ, and sorts them: on a lattice around them, or by their number if
  // they are few or all in one place.
  [[nodiscard]] Status code_again(std::uint32_t begin, std::uint32_t end) {
    const std::uint32_t count = end - begin;
    TreeKey* const keys = keys_ + begin;
    enter_step<TreeStep::kCrowd>();
    if (count <= kFewTreeTriangles) {
      number(keys, count);
      return Status::kOk;
    }
    enter_step<TreeStep::kCrowdKey>();
    FourBoxes middles = FourBoxes::none();
    for (std::uint32_t i = 0; i < count; i += 4) {
      const FourBoxes boxes = boxes_of(keys + i, count - i);
      const QuadRows middle = {boxes.low.x + boxes.high.x, boxes.low.y + boxes.high.y, boxes.low.z + boxes.high.z};
      middles.add({middle, middle});
    }
    const TreeCurve curve(QuadBox::around(middles));
    if (curve.is_flat()) {
      number(keys, count);
      return Status::kOk;
    }
    const bool are_few = count <= kFewSortedKeys;
    TreeKey* const unsorted = are_few ? keys : spare_ + begin;
    for (std::uint32_t i = 0; i < count; i += 4) {
      const Lanes<4>::Int codes = curve.codes_of(boxes_of(keys + i, count - i));
      for (std::uint32_t k = 0; k < 4 && i + k < count; ++k) {
        const std::uint32_t code = static_cast<std::uint32_t>(codes[static_cast<int>(k)]) | kTreeCodedAgain;
        unsorted[i + k] = TreeKey::of(code, keys[i + k].id());
      }
    }
    if (are_few) {
      sort_keys<kFewKeysDigit, kPricedStep<TreeStep::kCrowdKey>, kPricedStep<TreeStep::kCrowd>>(keys, spare_ + begin,
                                                                                                count, counts_);
    } else {
      sort_keys<kKeysDigit, kPricedStep<TreeStep::kCrowdKey>>(unsorted, keys, count, counts_);
    }
    return Status::kOk;
  }

  // --- Records and boxes ------------------------------------------------------------------------------------------

  // From the last node to the first, so that children come before their parents. Codes are not needed any more.
  void write_all() {
    margin_ = tree_margin_of(size_.low, size_.high);
    std::uint32_t end = size_.node_count;
    if (kSharesWork && shares_ > 1) {
      // Of a level each node is written by itself.
      for (std::uint32_t level = size_.depth; level-- > 1;) {
        const std::uint32_t begin = level_begins_[level];
        const NodeShares shares(*this, end - begin);
        share(sharing_, shares.count,
              [&](std::uint32_t i) { write_nodes(begin + shares.begin(i), begin + shares.begin(i + 1)); });
        end = begin;
      }
    }
    write_nodes(0, end);
  }
  void write_nodes(std::uint32_t begin, std::uint32_t end) const {
    for (std::uint32_t i = end; i-- > begin;) {
      if (order_ == TreeOrder::kForAnyHit) {
        write<true>(i);
      } else {
        write<false>(i);
      }
    }
  }

  // Asks the caches for what a leaf of a node that comes later needs: its keys, then its triangles, then their
  // corners and the place of its records.
  void ask_for_keys(std::uint32_t node, std::uint32_t child_number) const {
    const TreeChild child = nodes_[node].children[child_number];
    if (child.is_leaf()) ask_for(&keys_[child.first()], child.count());
  }
  void ask_for_triangles(std::uint32_t node, std::uint32_t child_number) const {
    const TreeChild child = nodes_[node].children[child_number];
    if (!child.is_leaf()) return;
    for (std::uint32_t i = 0; i < child.count(); ++i)
      __builtin_prefetch(&mesh_.triangles[keys_[child.first() + i].id()]);
  }
  void ask_for_leaf(std::uint32_t node, std::uint32_t child_number) const {
    const TreeChild child = nodes_[node].children[child_number];
    if (!child.is_leaf()) return;
    for (std::uint32_t i = 0; i < child.count(); ++i) {
      ask_for_corners(mesh_, mesh_.triangles[keys_[child.first() + i].id()]);
    }
    ask_for(&records_[child.first()], child.count());
  }

  // Writes the records of a node's leaves, and the boxes and the order of its children.
  template <bool kHasOrder>
  void write(std::uint32_t number) const {
    TreeNode& node = nodes_[number];
    auto* const areas = reinterpret_cast<float*>(spare_);  // by node; there are no more nodes than triangles
    float total = 0.0f, densities[kTreeWidth];
    QuadBox boxes[kTreeWidth];
    for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
      if (number >= 3) {
        ask_for_keys(number - 3, i);
        ask_for_triangles(number - 2, i);
        ask_for_leaf(number - 1, i);
      }
      if (i >= node.child_count) continue;
      const TreeChild child = node.children[i];
      float area = 0.0f;
      if (child.is_leaf()) {
        boxes[i] = write_leaf<kHasOrder>(child, area);
        enter_step<TreeStep::kNodeWrite>();
      } else {
        boxes[i] = QuadBox::of_node(nodes_[child.node_index()]);
        if constexpr (kHasOrder) area = areas[child.node_index()];
      }
      if constexpr (kHasOrder) {
        enter_step<TreeStep::kNodeOrder>();
        total += area;
        densities[i] = density_of(area, child.is_leaf(), boxes[i]);
        enter_step<TreeStep::kNodeWrite>();
      }
    }
    store_child_boxes(boxes, node);
    node.order = kTreeOrderByNumber;
    if constexpr (kHasOrder) {
      enter_step<TreeStep::kNodeOrder>();
      areas[number] = total;
      node.order = order_of(densities, node.child_count);
      enter_step<TreeStep::kNodeWrite>();
    }
  }

  // Writes a leaf's records. @returns its box; the area of its triangles if that is asked for.
  template <bool kHasArea>
  [[nodiscard]] QuadBox write_leaf(TreeChild leaf, float& area) const {
    QuadBox box;
    for (std::uint32_t k = leaf.first(); k < leaf.first() + leaf.count(); ++k) {
      enter_step<TreeStep::kTriangleWrite>();
      const CornerQuads corners = form_.write(mesh_, keys_[k].id(), records_[k]);
      box.add(corners);
      if constexpr (kHasArea) {
        enter_step<TreeStep::kTriangleArea>();
        area += area_of(corners);
      }
    }
    return box.grown(margin_);
  }

  const Mesh& mesh_;
  Form form_;
  std::span<Record> records_;
  std::span<TreeNode> nodes_;
  TreeKey* keys_;
  TreeKey* spare_;
  std::uint32_t* counts_;
  const std::uint32_t* ends_ = nullptr;  // of the keys of each value of the high digit; null: not known
  TreeSize& size_;
  TreeOrder order_;
  const WorkSharing& sharing_;
  std::uint32_t shares_;
  std::uint32_t level_begins_[kMaxTreeDepth] = {};  // the first node of each level
  float margin_ = 0.0f;
};

template <class Form, class Mesh>
Status build(const Mesh& mesh, std::uint32_t leaf_triangles, std::span<typename Form::Record> records,
             std::span<TreeNode> nodes, std::span<std::byte> scratch, TreeSize& size, TreeOrder order,
             const WorkSharing& sharing) {
  enter_step<TreeStep::kOnce>();
  if (leaf_triangles == 0 || leaf_triangles > kMaxTreeLeaf) return Status::kBadParameter;
  if (mesh.triangles.size() > kMaxTreeTriangles) return Status::kTooManyTriangles;
  if (scratch.size() < tree_scratch_bytes(mesh.triangles.size())) return Status::kMemoryTooSmall;
  return TreeBuilder<Mesh, Form>(mesh, leaf_triangles, records, nodes, scratch, size, order, sharing).build();
}

}  // namespace

Status build_tree(const MeshView& mesh, std::uint32_t leaf_triangles, std::span<VertexTriangle> records,
                  std::span<TreeNode> nodes, std::span<std::byte> scratch, TreeSize& size, TreeOrder order,
                  const WorkSharing& sharing) {
  return build<VertexForm>(mesh, leaf_triangles, records, nodes, scratch, size, order, sharing);
}

Status build_tree(const LatticeMesh& mesh, std::uint32_t leaf_triangles, std::span<LatticeTriangle> records,
                  std::span<TreeNode> nodes, std::span<std::byte> scratch, TreeSize& size, TreeOrder order,
                  const WorkSharing& sharing) {
  return build<LatticeForm>(mesh, leaf_triangles, records, nodes, scratch, size, order, sharing);
}

}  // namespace gridiron
