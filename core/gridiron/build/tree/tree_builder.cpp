// Building the wide tree: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/lanes.h>
#include <gridiron/build/tree/tree_box.h>
#include <gridiron/build/tree/tree_builder.h>

#include <bit>
#include <cstddef>

namespace gridiron {
namespace {

constexpr std::uint32_t kCodeBits = 30;          // ten of an axis
constexpr std::uint32_t kCodedAgain = 1u << 31;  // of a code that is not one of the whole mesh

// Equal codes of more triangles are coded again, on a lattice of their own; fewer are split by their number.
constexpr std::uint32_t kFewTriangles = 32;

// A leaf stands for more of what it holds than a node, whose triangles a ray may still miss.
constexpr float kLeafDensity = 1.5f;

// One word, so that it is moved as one.
struct Key {
  std::uint64_t bits;

  [[nodiscard]] static Key of(std::uint32_t code, std::uint32_t id) { return {std::uint64_t{id} << 32 | code}; }
  // Keys of triangles first to first + 3.
  static GRIDIRON_INLINE void store_four(Lanes<4>::Int codes, std::uint32_t first, Key* keys) {
    using L = Lanes<4>;
    const L::Int ids = L::Int::splat(first) + L::Int{{0, 1, 2, 3}};
    const L::Float low = L::shuffle_quads<0, 4, 1, 5>(L::floats_of(codes), L::floats_of(ids));
    const L::Float high = L::shuffle_quads<2, 6, 3, 7>(L::floats_of(codes), L::floats_of(ids));
    __builtin_memcpy(keys, &low, sizeof low);
    __builtin_memcpy(keys + 2, &high, sizeof high);
  }
  // Along the Z curve.
  [[nodiscard]] std::uint32_t code() const { return static_cast<std::uint32_t>(bits); }
  // Of a triangle.
  [[nodiscard]] std::uint32_t id() const { return static_cast<std::uint32_t>(bits >> 32); }
};

// Twice the area; where floats overflow or underflow any number, as it decides an order alone.
float area_of(const CornerQuads& corners) {
  const CornerQuad e = corners.b - corners.a, f = corners.c - corners.a;
  const CornerQuad normal = e * turned(f) - turned(e) * f;  // z, x, y
  const CornerQuad squares = normal * normal;
  return __builtin_sqrtf(squares.v[1] + squares.v[2] + squares.v[0]);
}

// The lattice of a Z curve: 1,024 places along each axis of a range of middles.
class Curve {
 public:
  explicit Curve(const QuadBox& middles) {
    for (int axis = 0; axis < 3; ++axis) {
      const float low = middles.low.v[axis], extent = middles.high.v[axis] - low;
      low_[axis] = CornerQuad(low);
      // The last middle falls into the last place; a smaller extent would have a scale that is no number.
      const bool has_extent = extent > 0x1p-100f;
      scale_[axis] = CornerQuad(has_extent ? 1023.9375f / extent : 0.0f);
      is_flat_ = is_flat_ && !has_extent;
    }
  }
  // All triangles are at one place.
  [[nodiscard]] bool is_flat() const { return is_flat_; }

  // The codes of boxes, by their middles.
  [[nodiscard]] GRIDIRON_INLINE Lanes<4>::Int codes_of(const FourBoxes& boxes) const {
    const auto part_of = [this](int axis, CornerQuad low, CornerQuad high) GRIDIRON_INLINE_LAMBDA {
      return spread(Lanes<4>::truncate(((low + high) - low_[axis]) * scale_[axis]));
    };
    return part_of(0, boxes.low.x, boxes.high.x) | part_of(1, boxes.low.y, boxes.high.y) << 1 |
           part_of(2, boxes.low.z, boxes.high.z) << 2;
  }

 private:
  // Two zeros behind each of ten bits.
  [[nodiscard]] static GRIDIRON_INLINE Lanes<4>::Int spread(Lanes<4>::Int bits) {
    using Int = Lanes<4>::Int;
    bits = (bits | bits << 16) & Int::splat(0x030000FFu);
    bits = (bits | bits << 8) & Int::splat(0x0300F00Fu);
    bits = (bits | bits << 4) & Int::splat(0x030C30C3u);
    return (bits | bits << 2) & Int::splat(0x09249249u);
  }

  CornerQuad low_[3], scale_[3];
  bool is_flat_ = true;
};

// The number of the highest bit, from 1; 0 of none: from the exponent of a double that holds it exactly.
// std::bit_width() calls a library where there is no instruction for it.
[[nodiscard]] std::int32_t width_of(std::uint32_t bits) {
  return static_cast<std::int32_t>(std::bit_cast<std::uint64_t>(static_cast<double>(bits) + 0.5) >> 52) - 1022;
}

// Sorts keys by their codes, equal ones in the order they have, digit by digit: to `to` if there is an odd number of
// digits, else back to `from`. Both are changed.
template <std::uint32_t kDigitBits>
void sort_keys(Key* from, Key* to, std::uint32_t count, std::uint32_t* counts) {
  constexpr std::uint32_t kDigits = kCodeBits / kDigitBits, kValues = 1u << kDigitBits;
  static_assert(kDigits * kDigitBits == kCodeBits);
  const auto digit_of = [](Key key, std::uint32_t digit)
                            GRIDIRON_INLINE_LAMBDA { return (key.code() >> kDigitBits * digit) % kValues; };
  for (std::uint32_t i = 0; i < kDigits * kValues; ++i) counts[i] = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t digit = 0; digit < kDigits; ++digit) ++counts[digit * kValues + digit_of(from[i], digit)];
  }
  for (std::uint32_t digit = 0; digit < kDigits; ++digit) {
    std::uint32_t* const places = counts + digit * kValues;
    std::uint32_t sum = 0;
    for (std::uint32_t i = 0; i < kValues; ++i) {
      const std::uint32_t here = places[i];
      places[i] = sum;
      sum += here;
    }
    // Several keys are read before the first of them is written: a processor that has once seen a place read right
    // after it was written would let each key wait for the one before.
    constexpr std::uint32_t kGroup = 8;
    std::uint32_t i = 0;
    for (; count - i >= kGroup; i += kGroup) {
      Key keys[kGroup];
      for (std::uint32_t k = 0; k < kGroup; ++k) keys[k] = from[i + k];
      for (const Key key : keys) to[places[digit_of(key, digit)]++] = key;
    }
    for (; i < count; ++i) to[places[digit_of(from[i], digit)]++] = from[i];
    Key* const sorted = to;
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
    const CornerQuads corners = CornerQuads::of(mesh, mesh.triangles[id]);
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
class TreeBuilder {
 public:
  using Record = typename Form::Record;

  TreeBuilder(const Mesh& mesh, std::uint32_t leaf_triangles, std::span<Record> records, std::span<TreeNode> nodes,
              std::span<std::byte> scratch, TreeSize& size, TreeOrder order)
      : mesh_(mesh),
        form_(mesh),
        leaf_triangles_(leaf_triangles),
        records_(records),
        nodes_(nodes),
        keys_(reinterpret_cast<Key*>(scratch.data())),
        spare_(keys_ + mesh.triangles.size()),
        counts_(reinterpret_cast<std::uint32_t*>(spare_ + mesh.triangles.size())),
        size_(size),
        order_(order) {}

  [[nodiscard]] Status build() {
    size_ = {};
    QuadBox vertices;
    if (!bound_vertices(mesh_.vertices, vertices)) return Status::kBadVertex;
    GRIDIRON_TRY(take_triangles(vertices));
    const std::uint32_t count = size_.triangle_count;
    if (count > records_.size()) return Status::kMemoryTooSmall;
    GRIDIRON_TRY(split_all(count));
    write_all();
    return Status::kOk;
  }

 private:
  struct Range {
    std::uint32_t begin, end;
    std::int32_t level;    // the highest bit in which codes differ, from 1; 0: they are equal; -1: a leaf
    std::uint32_t group;   // of a node's first four parts: from which it comes
    std::uint64_t weight;  // of parts that can be split, in the order in which they are; 0: a leaf
  };

  // By trial with two scans, a room and balls on a floor. More than any part weighs: kMostWeight.
  static constexpr std::int32_t kLevelWeight = 5, kNumberWeight = 2, kRootWeight = 3, kMostWeight = 1000;
  // Of a part's weight, above its size and its number: the first of the largest of those that weigh the most.
  static constexpr std::uint32_t kNumberBits = 4, kWeightShift = kNumberBits + 28;
  static constexpr std::uint64_t kByNumber = 0xFEDCBA9876543210u;  // TreeNode::order
  static constexpr std::uint32_t kGroups = 4, kGroupSize = kTreeWidth / kGroups;

  // --- Triangles --------------------------------------------------------------------------------------------------

  // Sorts the triangles that have an area by their codes, and bounds them.
  [[nodiscard]] Status take_triangles(const QuadBox& vertices) {
    // The least and the greatest middle that a triangle can have.
    const Curve curve({vertices.low + vertices.low, vertices.high + vertices.high});
    FourBoxes bounds = FourBoxes::none();
    std::uint32_t count = 0;
    const auto take = [&](std::uint32_t first, const FourTriangles& triangles, std::uint32_t kept)
                          GRIDIRON_INLINE_LAMBDA {
                            FourBoxes boxes = triangles.boxes();
                            const Lanes<4>::Int codes = curve.codes_of(boxes);
                            if (kept == 15u) {
                              Key::store_four(codes, first, spare_ + count);
                              count += 4;
                            } else {
                              for (int lane = 0; lane < 4; ++lane) {
                                if ((kept >> lane & 1u) == 0) continue;
                                const auto code = static_cast<std::uint32_t>(codes[lane]);
                                spare_[count++] = Key::of(code, first + static_cast<std::uint32_t>(lane));
                              }
                              boxes.keep(kept);
                            }
                            bounds.add(boxes);
                          };
    GRIDIRON_TRY(for_each_four(mesh_, take));
    if (count == 0) return Status::kNoTriangles;
    size_.triangle_count = count;
    size_.dropped_triangle_count = static_cast<std::uint32_t>(mesh_.triangles.size()) - count;
    const QuadBox all = QuadBox::around(bounds);
    for (int axis = 0; axis < 3; ++axis) {
      size_.low[axis] = all.low.v[axis];
      size_.high[axis] = all.high.v[axis];
    }
    if (mesh_.triangles.size() < kManyTreeTriangles) {
      sort_keys<kKeysDigit>(spare_, keys_, count, counts_);
    } else {
      sort_keys<kManyKeysDigit>(spare_, keys_, count, counts_);
      ends_ = counts_ + (1u << kManyKeysDigit);
      Key* const sorted = spare_;
      spare_ = keys_;
      keys_ = sorted;
    }
    return Status::kOk;
  }

  // --- Nodes ------------------------------------------------------------------------------------------------------

  [[nodiscard]] Range range_of(std::uint32_t begin, std::uint32_t end) const {
    const std::uint32_t size = end - begin;
    if (size <= leaf_triangles_) return {begin, end, -1, 0, 0};
    const std::int32_t level = width_of(keys_[begin].code() ^ keys_[end - 1].code());
    // Rays meet large cells, and a box is worth more above many triangles.
    const std::int32_t weight = 2 * kMostWeight + kLevelWeight * level + kNumberWeight * width_of(size);
    return {begin, end, level, 0, static_cast<std::uint64_t>(weight) << kWeightShift | size << kNumberBits};
  }

  // Level by level: nodes that are still to be split lie behind those that are done.
  [[nodiscard]] Status split_all(std::uint32_t count) {
    size_.node_count = 0;
    GRIDIRON_TRY(append_node({0, count, 0, 0, 0}, 1));
    for (std::uint32_t i = 0; i < size_.node_count; ++i) {
      if (size_.node_count - i > kNodesAhead) {
        const TreeNode& later = nodes_[i + kNodesAhead];
        const std::uint32_t begin = later.children[0].bits, end = later.children[1].bits;
        ask_for(keys_ + begin, end - begin < kFewKeys ? end - begin : kFewKeys);
      }
      GRIDIRON_TRY(split(nodes_[i]));
    }
    return Status::kOk;
  }

  // Until a node is split it holds its range and its depth.
  [[nodiscard]] Status append_node(const Range& range, std::uint32_t depth) {
    if (size_.node_count == nodes_.size()) return Status::kMemoryTooSmall;
    TreeNode& node = nodes_[size_.node_count++];
    node.children[0].bits = range.begin;
    node.children[1].bits = range.end;
    node.children[2].bits = depth;
    size_.depth = depth > size_.depth ? depth : size_.depth;
    return Status::kOk;
  }

  [[nodiscard]] Status split(TreeNode& node) {
    const std::uint32_t begin = node.children[0].bits, end = node.children[1].bits, depth = node.children[2].bits;
    Range ranges[kTreeWidth];
    std::uint32_t count = 0;
    if (is_deep(end - begin, depth)) {
      count = split_by_number(begin, end, ranges);
    } else {
      count = split_to_leaves(begin, end, ranges);
      if (count == 0) count = split_by_codes(begin, end, ranges);
    }
    // Boxes are written at last.
    __builtin_memset(node.children, 0, sizeof(TreeNode) - offsetof(TreeNode, children));
    node.child_count = count;
    for (std::uint32_t i = 0; i < count; ++i) {
      const Range& range = ranges[i];
      if (range.level < 0) {
        node.children[i] = TreeChild::leaf(range.begin, range.end - range.begin);
        continue;
      }
      node.children[i] = TreeChild::node(size_.node_count);
      GRIDIRON_TRY(append_node(range, depth + 1));
    }
    return Status::kOk;
  }

  // Whether so many triangles might not fit below a node: of d levels of nodes below it, each 16 times as many as of
  // d - 1. Splitting them by their number makes a sixteenth of them fit a level less.
  [[nodiscard]] bool is_deep(std::uint32_t count, std::uint32_t depth) const {
    std::uint64_t fitting = leaf_triangles_;
    for (std::uint32_t level = depth; level < kMaxTreeDepth && fitting < count; ++level) fitting *= kTreeWidth;
    return count > fitting;
  }

  // Into as many parts as leaves are needed, at most 16.
  [[nodiscard]] std::uint32_t split_by_number(std::uint32_t begin, std::uint32_t end, Range* ranges) const {
    const std::uint64_t count = end - begin;
    const std::uint64_t leaves = (count + leaf_triangles_ - 1) / leaf_triangles_;
    const std::uint64_t parts = leaves < kTreeWidth ? leaves : kTreeWidth;
    for (std::uint64_t i = 0; i < parts; ++i) {
      ranges[i] = range_of(begin + static_cast<std::uint32_t>(count * i / parts),
                           begin + static_cast<std::uint32_t>(count * (i + 1) / parts));
    }
    return static_cast<std::uint32_t>(parts);
  }

  // Where all parts become leaves before there are too many, it does not matter which one is split first. Such nodes
  // are most of all. @returns 0 where they do not, and where codes are equal.
  [[nodiscard]] std::uint32_t split_to_leaves(std::uint32_t begin, std::uint32_t end, Range* ranges) const {
    if (end - begin > kTreeWidth * leaf_triangles_) return 0;
    std::uint32_t ends[kTreeWidth];  // of the parts from `begin` on, the last first
    std::uint32_t count = 0, open = 1;
    ends[0] = end;
    while (open > 0) {
      const std::uint32_t part_end = ends[open - 1];
      if (part_end - begin <= leaf_triangles_) {
        ranges[count++] = {begin, part_end, -1, 0, 0};
        begin = part_end;
        --open;
        continue;
      }
      const std::uint32_t first = keys_[begin].code(), last = keys_[part_end - 1].code();
      if (first == last || count + open == kTreeWidth) return 0;
      ends[open++] = first_like_last(begin, part_end, first, last);
    }
    return count;
  }

  // Where a part is split.
  [[nodiscard]] std::uint32_t middle_of(const Range& part) const {
    const std::uint32_t first = keys_[part.begin].code(), last = keys_[part.end - 1].code();
    if (ends_ == nullptr || part.level <= static_cast<std::int32_t>(kManyKeysDigit) || (first & kCodedAgain) != 0) {
      return first_like_last(part.begin, part.end, first, last);
    }
    // Sorting by the high digit has left the end of the keys of each of its values.
    const std::uint32_t bit = 1u << (part.level - 1);
    return ends_[((last & ~(bit - 1)) >> kManyKeysDigit) - 1];
  }

  // The first key that has the highest bit in which the first and the last one differ as the last one has it.
  [[nodiscard]] std::uint32_t first_like_last(std::uint32_t begin, std::uint32_t end, std::uint32_t first,
                                              std::uint32_t last) const {
    // The first is among [low, low + count]. No branch depends on a code: none could be predicted.
    std::uint32_t low = begin + 1;
    for (std::uint32_t count = end - begin - 2; count > 0;) {
      const std::uint32_t half = (count + 1) / 2;
      const std::uint32_t code = keys_[low + half - 1].code();
      low += (code ^ first) > (code ^ last) ? 0 : half;
      count -= half;
    }
    return low;
  }

  // Splits the part that weighs the most until there are 16 or all are leaves. A core tests rays against the union box
  // of each four children first, so the first four parts become groups of four: below the root a group gets more only
  // if no other can be split. At the root, which all rays enter, a group may grow where its parts weigh much more.
  [[nodiscard]] std::uint32_t split_by_codes(std::uint32_t begin, std::uint32_t end, Range* ranges) {
    const bool is_root = end - begin == size_.triangle_count;
    const std::uint64_t full_weight = static_cast<std::uint64_t>(is_root ? kRootWeight : kMostWeight) << kWeightShift;
    std::uint32_t group_sizes[kGroups] = {1, 1, 1, 1};
    std::uint64_t less[kGroups] = {};  // what the parts of a group that is full weigh less
    ranges[0] = range_of(begin, end);
    std::uint32_t count = 1;
    while (count < kTreeWidth) {
      std::uint64_t most = 0;
      for (std::uint32_t i = 0; i < count; ++i) {
        const Range& range = ranges[i];
        const std::uint64_t weight = range.weight == 0 ? 0 : (range.weight - less[range.group]) | (kTreeWidth - 1 - i);
        most = weight > most ? weight : most;
      }
      if (most == 0) break;
      const std::uint32_t best = kTreeWidth - 1 - static_cast<std::uint32_t>(most % kTreeWidth);
      split_part(ranges, count, best);
      ++count;
      const std::uint32_t group = ranges[best].group;
      if (count > kGroups && ++group_sizes[group] >= kGroupSize) less[group] = full_weight;
      if (count == kGroups) {
        for (std::uint32_t i = 0; i < kGroups; ++i) ranges[i].group = i;
      }
    }
    return count;
  }

  // Splits part i of `count` in two.
  void split_part(Range* ranges, std::uint32_t count, std::uint32_t i) {
    Range& part = ranges[i];
    const std::uint32_t group = part.group;
    if (part.level == 0) {
      code_again(part.begin, part.end);
      part = range_of(part.begin, part.end);
    }
    const std::uint32_t middle = middle_of(part);
    for (std::uint32_t k = count; k > i + 1; --k) ranges[k] = ranges[k - 1];
    ranges[i + 1] = range_of(middle, part.end);
    part = range_of(part.begin, middle);
    part.group = ranges[i + 1].group = group;
  }

  static void number(Key* keys, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) keys[i] = Key::of(i | kCodedAgain, keys[i].id());
  }

  // The boxes of the triangles of the next four keys; if fewer are left, of the last one again.
  [[nodiscard]] FourBoxes boxes_of(const Key* keys, std::uint32_t left) const {
    CornerQuads corners[4];
    for (std::uint32_t k = 0; k < 4; ++k) {
      corners[k] = CornerQuads::of(mesh_, mesh_.triangles[keys[k < left ? k : left - 1].id()]);
    }
    return FourTriangles::of(corners).boxes();
  }

  // Gives triangles of one code new ones that differ, and sorts them: on a lattice around them, or by their number if
  // they are few or all in one place.
  void code_again(std::uint32_t begin, std::uint32_t end) {
    const std::uint32_t count = end - begin;
    Key* const keys = keys_ + begin;
    if (count <= kFewTriangles) {
      number(keys, count);
      return;
    }
    FourBoxes middles = FourBoxes::none();
    for (std::uint32_t i = 0; i < count; i += 4) {
      const FourBoxes boxes = boxes_of(keys + i, count - i);
      const QuadRows middle = {boxes.low.x + boxes.high.x, boxes.low.y + boxes.high.y, boxes.low.z + boxes.high.z};
      middles.add({middle, middle});
    }
    const Curve curve(QuadBox::around(middles));
    if (curve.is_flat()) {
      number(keys, count);
      return;
    }
    const bool are_few = count <= kFewSortedKeys;
    Key* const unsorted = are_few ? keys : spare_ + begin;
    for (std::uint32_t i = 0; i < count; i += 4) {
      const Lanes<4>::Int codes = curve.codes_of(boxes_of(keys + i, count - i));
      for (std::uint32_t k = 0; k < 4 && i + k < count; ++k) {
        const std::uint32_t code = static_cast<std::uint32_t>(codes[static_cast<int>(k)]) | kCodedAgain;
        unsorted[i + k] = Key::of(code, keys[i + k].id());
      }
    }
    if (are_few) {
      sort_keys<kFewKeysDigit>(keys, spare_ + begin, count, counts_);
    } else {
      sort_keys<kKeysDigit>(unsorted, keys, count, counts_);
    }
  }

  // --- Records and boxes ------------------------------------------------------------------------------------------

  // From the last node to the first, so that children come before their parents. Codes are not needed any more.
  void write_all() {
    margin_ = tree_margin_of(size_.low, size_.high);
    for (std::uint32_t i = size_.node_count; i-- > 0;) {
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
      } else {
        boxes[i] = QuadBox::of_node(nodes_[child.node_index()]);
        if constexpr (kHasOrder) area = areas[child.node_index()];
      }
      if constexpr (kHasOrder) {
        total += area;
        densities[i] = area * (child.is_leaf() ? kLeafDensity : 1.0f) / boxes[i].half_surface();
      }
    }
    for (std::uint32_t i = 0; i < kTreeWidth; i += 4) {
      CornerQuad lows[4], highs[4];
      for (std::uint32_t k = 0; k < 4; ++k) {
        lows[k] = boxes[i + k].low;
        highs[k] = boxes[i + k].high;
      }
      QuadRows::of(lows).store(node.low, i);
      QuadRows::of(highs).store(node.high, i);
    }
    node.order = kByNumber;
    if constexpr (kHasOrder) {
      areas[number] = total;
      node.order = order_of(densities, node.child_count);
    }
  }

  // Writes a leaf's records. @returns its box; the area of its triangles if that is asked for.
  template <bool kHasArea>
  [[nodiscard]] QuadBox write_leaf(TreeChild leaf, float& area) const {
    QuadBox box;
    for (std::uint32_t k = leaf.first(); k < leaf.first() + leaf.count(); ++k) {
      const CornerQuads corners = form_.write(mesh_, keys_[k].id(), records_[k]);
      box.add(corners);
      if constexpr (kHasArea) area += area_of(corners);
    }
    return box.grown(margin_);
  }

  // The densest first; of equal ones the first.
  [[nodiscard]] static std::uint64_t order_of(const float* densities, std::uint32_t count) {
    std::uint32_t children[kTreeWidth];
    for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
      std::uint32_t place = i;
      if (i < count) {
        for (; place > 0 && densities[children[place - 1]] < densities[i]; --place) {
          children[place] = children[place - 1];
        }
      }
      children[place] = i;
    }
    std::uint64_t order = 0;
    for (std::uint32_t i = 0; i < kTreeWidth; ++i) order |= std::uint64_t{children[i]} << 4 * i;
    return order;
  }

  const Mesh& mesh_;
  Form form_;
  std::uint32_t leaf_triangles_;
  std::span<Record> records_;
  std::span<TreeNode> nodes_;
  Key* keys_;
  Key* spare_;
  std::uint32_t* counts_;
  const std::uint32_t* ends_ = nullptr;  // of the keys of each value of the high digit; null: not known
  TreeSize& size_;
  TreeOrder order_;
  float margin_ = 0.0f;
};

template <class Form, class Mesh>
Status build(const Mesh& mesh, std::uint32_t leaf_triangles, std::span<typename Form::Record> records,
             std::span<TreeNode> nodes, std::span<std::byte> scratch, TreeSize& size, TreeOrder order) {
  if (leaf_triangles == 0 || leaf_triangles > kMaxTreeLeaf) return Status::kBadParameter;
  if (mesh.triangles.size() > kMaxTreeTriangles) return Status::kTooManyTriangles;
  if (scratch.size() < tree_scratch_bytes(mesh.triangles.size())) return Status::kMemoryTooSmall;
  return TreeBuilder<Mesh, Form>(mesh, leaf_triangles, records, nodes, scratch, size, order).build();
}

}  // namespace

Status build_tree(const MeshView& mesh, std::uint32_t leaf_triangles, std::span<VertexTriangle> records,
                  std::span<TreeNode> nodes, std::span<std::byte> scratch, TreeSize& size, TreeOrder order) {
  return build<VertexForm>(mesh, leaf_triangles, records, nodes, scratch, size, order);
}

Status build_tree(const LatticeMesh& mesh, std::uint32_t leaf_triangles, std::span<LatticeTriangle> records,
                  std::span<TreeNode> nodes, std::span<std::byte> scratch, TreeSize& size, TreeOrder order) {
  return build<LatticeForm>(mesh, leaf_triangles, records, nodes, scratch, size, order);
}

}  // namespace gridiron
