// Building the wide tree on the cores: what the passes share. Sizes of a local store, where things lie in main memory,
// and the records that one pass writes and another reads. BUILD.md describes the passes.
// Source: own. Memory: caller's. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/check_value.h>
#include <gridiron/base/math.h>
#include <gridiron/base/records.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/build/corner_quad.h>
#include <gridiron/build/tree/tree_curve.h>
#include <gridiron/build/tree/tree_size.h>
#include <gridiron/platform/contract.h>
#include <gridiron/platform/status.h>

#include <cstddef>
#include <cstdint>

namespace gridiron {

/// Sizes of a core of 256 KB. None changes a byte of the tree.
struct BuildLayout256K {
  static constexpr std::uint32_t kArenaBytes = 256 * 1024;            ///< local memory of a core
  static constexpr std::uint32_t kCodeBudgetBytes = 67 * 1024;        ///< of it for code
  static constexpr std::uint32_t kStackBudgetBytes = 4 * 1024 + 512;  ///< of it for the stack
  static constexpr std::uint32_t kRunTriangles = 1728;                ///< that one item codes and sorts
  static constexpr bool kSortsRecords = true;                         ///< runs have their records in the order of codes
  static constexpr std::uint32_t kCacheLines = 512;                   ///< of vertices, a power of two
  static constexpr std::uint32_t kChunkTriangles = 32;                ///< whose corners are asked for at once
  static constexpr std::uint32_t kIndexWindow = 128;                  ///< triangles
  static constexpr std::uint32_t kSamples = 4096;                     ///< codes by which buckets are chosen, at most
  static constexpr std::uint32_t kBucketKeys = 2400;     ///< that are sorted in the store, with their records
  static constexpr std::uint32_t kBucketRecords = 2656;  ///< places for these, a few between runs
  static constexpr std::uint32_t kLoneKeys = 8960;       ///< that are sorted there without their records
  static constexpr std::uint32_t kPieceKeys = 7680;      ///< that are split there
  static constexpr std::uint32_t kFarKeys = 1024;        ///< of more than fit the store, sorted at once
  static constexpr std::uint32_t kDigitBits = 9;         ///< of a code, sorted at once
  static constexpr std::uint32_t kFewDigitBits = 6;      ///< the same for a few keys
  static constexpr std::uint32_t kTopSamples = 4096;     ///< codes that guide the splits of large ranges
  static constexpr std::uint32_t kRecordWindow = 32;     ///< records that are read or written at once
};

/// Sizes of a core of 64 KB.
struct BuildLayout64K {
  /// @cond
  static constexpr std::uint32_t kArenaBytes = 64 * 1024;
  static constexpr std::uint32_t kCodeBudgetBytes = 24 * 1024;
  static constexpr std::uint32_t kStackBudgetBytes = 4 * 1024 + 512;
  static constexpr std::uint32_t kRunTriangles = 1024;
  static constexpr bool kSortsRecords = false;
  static constexpr std::uint32_t kCacheLines = 32;
  static constexpr std::uint32_t kChunkTriangles = 16;
  static constexpr std::uint32_t kIndexWindow = 32;
  static constexpr std::uint32_t kSamples = 1024;
  static constexpr std::uint32_t kBucketKeys = 768;
  static constexpr std::uint32_t kBucketRecords = 0;
  static constexpr std::uint32_t kLoneKeys = 768;
  static constexpr std::uint32_t kPieceKeys = 432;
  static constexpr std::uint32_t kFarKeys = 128;
  static constexpr std::uint32_t kDigitBits = 6;
  static constexpr std::uint32_t kFewDigitBits = 6;
  static constexpr std::uint32_t kTopSamples = 512;
  static constexpr std::uint32_t kRecordWindow = 16;
  /// @endcond
};

/// What is built and where. All addresses are multiples of kLineBytes. Memory behind the arrays of vertices and
/// triangles is readable up to a multiple of 16 bytes.
struct BuildInput {
  MainAddress vertices;   ///< Vec3[vertex_count]
  MainAddress triangles;  ///< UVec3[triangle_count]
  std::uint32_t vertex_count = 0;
  std::uint32_t triangle_count = 0;  ///< at most kMaxTreeTriangles
  std::uint32_t leaf_triangles = 8;  ///< records of a leaf, 1..kMaxTreeLeaf
  TreeOrder order = TreeOrder::kForAnyHit;
  MainAddress records;  ///< VertexTriangle[record_room]
  MainAddress nodes;    ///< TreeNode[node_room]
  std::uint32_t record_room = 0;
  std::uint32_t node_room = 0;
  MainAddress result;            ///< BuildResult
  MainAddress scratch;           ///< build_scratch_bytes()
  MainAddress image;             ///< scene image whose pieces the last pass checks; 0: none
  std::uint64_t image_room = 0;  ///< of that image, bytes
  /// The image holds nothing but this tree. Then the cores write all of it but its check value: its head, the records
  /// behind it (`records` is not used), padding, and the nodes behind that (`nodes` is not used).
  bool is_tree_image = false;
};

/// What the join pass writes.
struct alignas(32) BuildResult {
  TreeSize size;
  std::uint32_t reserved[6];
};
static_assert(sizeof(BuildResult) == 64);

// --- Records between passes ---------------------------------------------------------------------------------------

/// A box: bounds of a run of vertices, or of what a child holds.
struct CornerBox {
  StoredQuad low, high;
};
static_assert(sizeof(CornerBox) == 32);

/// What coding a run of triangles has found.
struct RunPart {
  StoredQuad low[3], high[3];  ///< bounds, lane by lane, so that a zero has the sign that the first triangle gives it
  std::uint32_t count;         ///< of triangles that have an area: keys
  std::uint32_t reserved[7];

  [[nodiscard]] GRIDIRON_INLINE FourBoxes bounds() const {
    return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
  }
};
static_assert(sizeof(RunPart) == 128);

/// All triangles.
struct BuildState {
  float low[4], high[4];
  std::uint32_t triangle_count;  ///< kept
  std::uint32_t bucket_count;    ///< to sort; some may be empty
  std::uint32_t reserved[22];
};
static_assert(sizeof(BuildState) == 128);

/// What is known of the triangle whose record stands at the same place among the sorted ones. Triangles whose code is
/// that of more than kFewTreeTriangles, a crowd, stand in the order of `again`, their codes on a lattice of their own.
struct alignas(16) SortedKey {
  std::uint32_t code, again;
  float area;
  std::uint32_t place;  ///< of its record before it is sorted, where a crowd is coded again in main memory
};
static_assert(sizeof(SortedKey) == 16);

/// A range of sorted keys that one core makes into a leaf or into a node with all that is below it.
struct Piece {
  std::uint32_t begin, end;
  std::uint32_t depth;   ///< of the node; 0: a leaf
  std::uint32_t bucket;  ///< that it is in, and whether it is part of a crowd that was split by `again`
  static constexpr std::uint32_t kOfCrowd = 1u << 31;
  [[nodiscard]] std::uint32_t bucket_number() const { return bucket & ~kOfCrowd; }
};
static_assert(sizeof(Piece) == 16);

/// What became of a piece, or of a node above the pieces.
struct PieceResult {
  float low[3], area;
  float high[3];
  std::uint32_t number;  ///< of its node: a piece's among those of its bucket and level, else in the tree
};
static_assert(sizeof(PieceResult) == 32);

/// Neighbouring pieces: an item.
struct SubtreeBucket {
  std::uint32_t first_piece, piece_count;
  std::uint32_t begin, end;  ///< keys
};
static_assert(sizeof(SubtreeBucket) == 16);

/// Nodes of each level of a bucket; or the numbers of the first of them.
struct LevelCounts {
  std::uint32_t of[16];  ///< by depth - 1
};
static_assert(sizeof(LevelCounts) == 64 && kMaxTreeDepth <= 16);

/// A node above the pieces, in the order of a walk that visits a node before its children.
struct alignas(32) TopNode {
  static constexpr std::uint32_t kTop = 1u << 31;  ///< of a child: the number of a TopNode is below, else of a Piece
  std::uint32_t begin, depth, child_count;
  std::uint32_t number;  ///< of the node in the tree
  std::uint32_t children[kTreeWidth];
  std::uint32_t reserved[12];
};
static_assert(sizeof(TopNode) == 128);

/// What splitting the large ranges has made.
struct alignas(32) TopState {
  std::uint32_t top_count, piece_count, bucket_count;
  std::uint32_t triangle_count;  ///< kept
  std::uint32_t reserved[28];
};
static_assert(sizeof(TopState) == 128);

/// The check value of a piece of the image.
struct alignas(16) PieceCheck {
  std::uint64_t value, reserved;
};
static_assert(sizeof(PieceCheck) == 16);

inline constexpr std::uint32_t kTreeImageHeadBytes = 384;  ///< of an image that holds a tree alone, before its records

// --- Plan ---------------------------------------------------------------------------------------------------------

inline constexpr std::uint32_t kVertexItem = 2048;        ///< vertices that one item bounds
inline constexpr std::uint32_t kVertexWindow = 256;       ///< of them at once
inline constexpr std::uint32_t kMostVertices = 1u << 29;  ///< of a mesh
inline constexpr std::uint32_t kLeastRunSamples = 8;      // both ends of their transfer are congruent
static_assert(4 * kLeastRunSamples % kPortableCongruenceBytes == 0);
inline constexpr std::uint32_t kMostRunSamples = 32;
inline constexpr std::uint32_t kNoSample = ~0u;      ///< more than any code
inline constexpr std::uint32_t kRunGroup = 8;        ///< runs whose cuts one item finds
inline constexpr std::uint32_t kBucketPieces = 256;  ///< of a bucket, at most
inline constexpr std::uint32_t kVertexBytes = sizeof(Vec3), kIndexBytes = sizeof(UVec3);
static_assert(kVertexBytes == 12 && kIndexBytes == 12);

inline constexpr std::uint32_t kLeastSampleStep = 8;  ///< between sorted keys that guide the top pass

/// The passes in their order.
enum class BuildPass : std::uint8_t {
  kBounds,
  kCodes,
  kBuckets,
  kCuts,
  kSort,
  kTop,
  kSubtrees,
  kJoin,
  kNumbers,
  kCheck,
  kCount
};
inline constexpr std::uint32_t kBuildPassCount = static_cast<std::uint32_t>(BuildPass::kCount);

/// Counts and places that follow from the input and a layout's sizes.
struct BuildPlan {
  BuildInput input;
  std::uint32_t vertex_items, run_count, run_stride;  ///< run_stride: entries of a row of cuts, a multiple of kRunGroup
  std::uint32_t run_triangles;                        ///< of a run
  std::uint32_t sample_step;                          ///< every so many'th sorted key guides the top pass
  std::uint32_t run_samples;                          ///< of a run
  std::uint32_t sampled_runs;                         ///< every so many'th run is sampled
  std::uint32_t bucket_room;                          ///< buckets that are sorted, at most
  std::uint32_t bucket_limit;                         ///< keys of one, as far as samples tell
  std::uint32_t piece_limit;                          ///< triangles of a piece that can be split
  std::uint32_t subtree_room;                         ///< buckets of pieces, at most
  std::uint32_t item_counts[kBuildPassCount];
  MainAddress vertex_parts, run_keys, samples, run_parts, state, splitters, cuts, sorted, sorted_samples, raw_records,
      top_state, tops, top_results, pieces, piece_results, buckets, level_counts, level_firsts, raw_nodes, piece_checks;
  std::uint64_t end;  ///< of scratch memory
};
static_assert(sizeof(BuildPlan) == 352);

/// @returns how many nodes are made of this many triangles at most, from the start of a piece on.
[[nodiscard]] constexpr std::uint64_t raw_node_place(std::uint64_t triangles, std::uint32_t leaf_triangles) {
  // See most_tree_nodes(); without its constant, as a piece has more triangles than a leaf.
  return leaf_triangles < 15 ? triangles * 16 / (15 * (leaf_triangles + 1)) : triangles / 15;
}

/// @returns where the nodes lie. @param kept  triangles that have an area: those of a tree's image lie behind them.
[[nodiscard]] constexpr MainAddress nodes_of(const BuildPlan& plan, std::uint32_t kept) {
  if (!plan.input.is_tree_image) return plan.input.nodes;
  return plan.input.records.offset_by(
      round_up<std::uint64_t>(std::uint64_t{kept} * sizeof(VertexTriangle), kLineBytes));
}

/// @returns triangles of a run: so many runs that any few cores end at about the same time.
template <class Layout>
[[nodiscard]] constexpr std::uint32_t run_triangles_of(std::uint32_t triangle_count) {
  constexpr std::uint32_t kLeastRuns = 48, kRunsMultiple = 12, kLeastTriangles = 64, kMultiple = 32;
  const std::uint32_t needed = triangle_count / Layout::kRunTriangles + 1;
  const std::uint32_t runs =
      needed < kLeastRuns ? kLeastRuns : (needed + kRunsMultiple - 1) / kRunsMultiple * kRunsMultiple;
  const std::uint32_t triangles = round_up(triangle_count / runs + 1, kMultiple);
  return triangles < kLeastTriangles         ? kLeastTriangles
         : triangles < Layout::kRunTriangles ? triangles
                                             : Layout::kRunTriangles;
}

/// Errors: kBadParameter, kTooManyTriangles: as of build_tree().
template <class Layout>
[[nodiscard]] constexpr Status plan_build(const BuildInput& input, BuildPlan& plan) {
  if (input.leaf_triangles == 0 || input.leaf_triangles > kMaxTreeLeaf) return Status::kBadParameter;
  if (input.vertex_count > kMostVertices) return Status::kBadParameter;
  if (input.triangle_count > kMaxTreeTriangles) return Status::kTooManyTriangles;
  const std::uint32_t n = input.triangle_count;
  const auto shares = [](std::uint64_t count, std::uint64_t share) {
    return static_cast<std::uint32_t>((count + share - 1) / share);
  };
  plan.input = input;
  if (input.is_tree_image) plan.input.records = input.image.offset_by(kTreeImageHeadBytes);
  plan.vertex_items = shares(input.vertex_count, kVertexItem);
  plan.run_triangles = run_triangles_of<Layout>(n);
  plan.run_count = shares(n, plan.run_triangles);
  plan.run_stride = round_up(plan.run_count, kRunGroup);
  plan.sampled_runs = 1;
  while (std::uint64_t{shares(plan.run_count, plan.sampled_runs)} * kLeastRunSamples > Layout::kSamples)
    ++plan.sampled_runs;
  plan.run_samples = kLeastRunSamples;
  while (plan.run_samples * 8 <= plan.run_triangles && plan.run_samples < kMostRunSamples &&
         std::uint64_t{shares(plan.run_count, plan.sampled_runs)} * plan.run_samples * 2 <= Layout::kSamples) {
    plan.run_samples *= 2;
  }
  // Enough shares that cores end at about the same time, and not so many that their beginnings count.
  const auto clamped = [](std::uint32_t value, std::uint32_t low, std::uint32_t high) {
    return value < low ? low : value > high ? high : value;
  };
  plan.bucket_limit = clamped(n / 48, Layout::kBucketKeys / 16, Layout::kBucketKeys * 15 / 32);
  plan.bucket_room = 2 * shares(n, plan.bucket_limit) + 2;
  plan.piece_limit = clamped(n / 48, Layout::kPieceKeys / 16, Layout::kPieceKeys);
  const std::uint32_t top_room = (kMaxTreeDepth - 1) * shares(n, plan.piece_limit) + 1;
  const std::uint32_t piece_room = top_room * kTreeWidth;
  plan.subtree_room = 2 * shares(n, plan.piece_limit) + 2 + shares(piece_room, kBucketPieces);
  plan.sample_step = kLeastSampleStep;
  while (n / plan.sample_step >= Layout::kTopSamples) plan.sample_step *= 2;
  std::uint32_t items[kBuildPassCount] = {plan.vertex_items,
                                          plan.run_count,
                                          1,
                                          plan.run_stride / kRunGroup,
                                          plan.bucket_room,
                                          1,
                                          plan.subtree_room,
                                          1,
                                          plan.subtree_room,
                                          0};
  if (input.image.value != 0) items[kBuildPassCount - 1] = shares(input.image_room, ImageCheckValue::kPieceBytes);
  for (std::uint32_t i = 0; i < kBuildPassCount; ++i) plan.item_counts[i] = items[i];
  std::uint64_t end = input.scratch.value;
  const auto place = [&end](std::uint64_t bytes) {
    const MainAddress address{end};
    end += round_up(bytes, std::uint64_t{kLineBytes});
    return address;
  };
  plan.vertex_parts = place(sizeof(CornerBox) * std::uint64_t{plan.vertex_items});
  plan.run_keys = place(sizeof(TreeKey) * std::uint64_t{plan.run_triangles} * plan.run_count);
  plan.samples = place(std::uint64_t{4} * plan.run_samples * shares(plan.run_count, plan.sampled_runs));
  plan.run_parts = place(sizeof(RunPart) * std::uint64_t{plan.run_count});
  plan.state = place(sizeof(BuildState));
  plan.splitters = place(std::uint64_t{4} * (plan.bucket_room + 1));
  plan.cuts = place(std::uint64_t{4} * plan.run_stride * (plan.bucket_room + 1));
  plan.sorted = place(sizeof(SortedKey) * std::uint64_t{n});
  plan.sorted_samples = place(sizeof(SortedKey) * (std::uint64_t{n / plan.sample_step} + 1));
  plan.raw_records = place(sizeof(VertexTriangle) * std::uint64_t{n});
  plan.top_state = place(sizeof(TopState));
  plan.tops = place(sizeof(TopNode) * std::uint64_t{top_room});
  plan.top_results = place(sizeof(PieceResult) * std::uint64_t{top_room});
  plan.pieces = place(sizeof(Piece) * std::uint64_t{piece_room});
  plan.piece_results = place(sizeof(PieceResult) * std::uint64_t{piece_room});
  plan.buckets = place(sizeof(SubtreeBucket) * std::uint64_t{plan.subtree_room});
  plan.level_counts = place(sizeof(LevelCounts) * std::uint64_t{plan.subtree_room});
  plan.level_firsts = place(sizeof(LevelCounts) * std::uint64_t{plan.subtree_room});
  plan.raw_nodes = place(sizeof(TreeNode) * (raw_node_place(n, input.leaf_triangles) + 1));
  plan.piece_checks = place(sizeof(PieceCheck) * std::uint64_t{items[kBuildPassCount - 1]});
  plan.end = end;
  return Status::kOk;
}

/// @returns bytes of main memory that the passes work in.
template <class Layout>
[[nodiscard]] constexpr std::uint64_t build_scratch_bytes(BuildInput input) {
  BuildPlan plan{};
  input.scratch = MainAddress{0};
  return plan_build<Layout>(input, plan) == Status::kOk ? plan.end : 0;
}

}  // namespace gridiron
