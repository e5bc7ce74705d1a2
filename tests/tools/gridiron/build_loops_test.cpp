// Bounds of loops of the passes that build the tree: where a kind of work counts turns, no item counts more than the
// bounds of its loops allow. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/passes/build_passes.h>
#include <gridiron/sim/build_pass_work.h>
#include <gridiron/sim/passes.h>
#include <gridiron/sim/trace_packing.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "core/dma/test_platform.h"
#include "gridiron/info/loop_table.h"
#include "support/image_to_build.h"

namespace gridiron::test {
namespace {

using Counts = std::array<std::uint64_t, kWorkKindCount>;

// What each item of each pass counts.
struct CountedBuild {
  std::vector<Counts> items[kBuildPassCount];
  BuildInput input;
};

Counts counts_of(const sim::TileTrace& item) {
  Counts counts{};
  sim::for_each_event(item, [&](const sim::TraceEvent& event) {
    if (event.kind != sim::EventKind::kWork) return;
    for (const sim::WorkAmount& amount : event.work) counts[amount.kind.number()] += amount.amount;
  });
  return counts;
}

// Builds the image of a mesh on one core.
template <class Layout>
CountedBuild counted_build(const TestMesh& mesh, std::uint32_t leaf_triangles) {
  ImageToBuild<Layout> built(mesh, leaf_triangles, TreeOrder::kForAnyHit);
  CountedBuild build;
  build.input = built.input;
  std::vector<sim::Pass> passes;
  for (std::uint32_t i = 0; i < kBuildPassCount; ++i) {
    const auto pass = static_cast<BuildPass>(i);
    passes.push_back({.name = sim::name_of(pass),
                      .items = {.most = built.plan.item_counts[i]},
                      .data_bytes = sizeof(BuildStore<Layout>),
                      .writable = built.writable,
                      .kernel = sim::PassKernel([&plan = built.plan, pass](auto& core, std::span<std::byte> data) {
                        return run_build_pass(core, *reinterpret_cast<BuildStore<Layout>*>(data.data()), plan, pass);
                      }),
                      .engine = &sim::work_of(pass)});
  }
  sim::ChipOptions options;
  options.threads = 1;
  options.store = Layout::kArenaBytes > 65536 ? sim::StoreSize::k256KB : sim::StoreSize::k64KB;
  const sim::PassesResult run = sim::run_passes(built.memory, passes, options);
  EXPECT_EQ(run.status, Status::kOk);
  for (std::size_t i = 0; i < run.passes.size(); ++i) {
    for (const sim::TileTrace& item : run.passes[i].result.trace.tiles) build.items[i].push_back(counts_of(item));
  }
  return build;
}

// Bounds of a build's loops.
class Bounds {
 public:
  Bounds(const BuildInput& input, std::uint32_t arena_bytes) {
    tool::LoopFacts facts;
    facts.add_build(input, arena_bytes);
    rows_ = facts.rows();
  }
  // Of the loop whose header begins so; of several the first.
  [[nodiscard]] std::uint64_t of(const char* file, const char* function, const char* loop) const {
    for (const tool::LoopRow& row : rows_) {
      if (row.file == std::string("build/") + file && row.function == function && row.loop.starts_with(loop)) {
        return row.value.value();
      }
    }
    ADD_FAILURE() << "no row of " << file << ", " << function << ", " << loop;
    return 0;
  }

 private:
  std::vector<tool::LoopRow> rows_;
};

// At most so much of a kind in each item.
struct Limit {
  BuildPass pass;
  WorkId kind;
  std::uint64_t most;
  const char* loop;
};

// What bounds of loops say of items. @param triangles  of the mesh.
std::vector<Limit> limits_of(const Bounds& bounds, std::uint64_t triangles) {
  const auto sort_loop = [&](const char* function, const char* loop) {
    return bounds.of("passes/pass_sort.h", function, loop);
  };
  const std::uint64_t windows = bounds.of("passes/pass_tools.h", "for_each_window", "for");
  // Of sort_run(): a sort by two digits, and those of all digits.
  const std::uint64_t digit_sorts = 1 + sort_loop("sort_run", "for");
  const std::uint64_t sort_counts = digit_sorts * sort_loop("sort_by_digits", "for (std::uint32_t i = 0; i < digits *");
  const std::uint64_t moved_keys = digit_sorts * sort_loop("sort_by_digits", "for (std::uint32_t digit") *
                                   (4 * sort_loop("for_each_group", "for (; count - i") +
                                    sort_loop("for_each_group", "for (; i < count"));
  const std::uint64_t exchanged_keys = sort_loop("sort_by_exchanges", "for (std::uint32_t i") + 1;
  const std::uint64_t chunks = bounds.of("passes/codes_pass.h", "code", "for (std::uint32_t chunk");
  const std::uint64_t corners = chunks * 4 * bounds.of("passes/codes_pass.h", "ask_for_corners", "for");
  const std::uint64_t fours = bounds.of("passes/codes_pass.h", "take", "for");
  const std::uint64_t cut_steps = bounds.of("passes/cuts_pass.h", "run_cuts_pass", "for (std::uint32_t first") *
                                  bounds.of("passes/cuts_pass.h", "run_cuts_pass", "for (std::uint32_t k") *
                                  bounds.of("passes/cuts_pass.h", "run_cuts_pass", "for (; next") *
                                  bounds.of("passes/cuts_pass.h", "run_cuts_pass", "for (std::uint32_t size");
  // Sorts of a bucket: one or its shares, and the same of each crowd.
  const std::uint64_t shares = bounds.of("passes/code_again.h", "sort_far", "while (done");
  const std::uint64_t bucket_sorts = (1 + triangles / (kFewTreeTriangles + 1)) * shares;
  const std::uint64_t numbered = bounds.of("passes/join_pass.h", "run_numbers_pass", "for (std::uint32_t begin") *
                                 bounds.of("passes/join_pass.h", "run_numbers_pass", "for (std::uint32_t i");
  const std::uint64_t lines = CheckStore::kWindow;
  return {
      {BuildPass::kBounds, BuildWork::kVertex,
       kVertexItem / kVertexWindow * bounds.of("passes/bounds_pass.h", "run_bounds_pass", "for"), "vertices"},
      {BuildPass::kCodes, BuildWork::kCorner, corners, "corners of chunks"},
      {BuildPass::kCodes, BuildWork::kMissedCorner, corners, "corners of chunks"},
      {BuildPass::kCodes, BuildWork::kCodedGroup, chunks * fours, "fours of chunks"},
      {BuildPass::kCodes, BuildWork::kSortedRecord,
       bounds.of("passes/codes_pass.h", "send_records", "for (std::uint32_t chunk") * 4 * fours, "records of a run"},
      {BuildPass::kCodes, BuildWork::kSortCount, sort_counts, "digits of a run"},
      {BuildPass::kCodes, BuildWork::kMovedKey, moved_keys, "keys of a run"},
      {BuildPass::kCodes, BuildWork::kExchangedKey, exchanged_keys, "exchanges in a run"},
      {BuildPass::kBuckets, BuildWork::kSortCount, sort_counts, "digits of samples"},
      {BuildPass::kBuckets, BuildWork::kMovedKey, moved_keys, "samples"},
      {BuildPass::kBuckets, BuildWork::kExchangedKey, exchanged_keys, "exchanges of samples"},
      {BuildPass::kCuts, BuildWork::kCutStep, cut_steps, "steps to cuts"},
      {BuildPass::kSort, BuildWork::kSortCount, bucket_sorts * sort_counts, "digits of a bucket"},
      {BuildPass::kSort, BuildWork::kMovedKey, bucket_sorts * moved_keys, "keys of a bucket"},
      {BuildPass::kSort, BuildWork::kExchangedKey, bucket_sorts * exchanged_keys, "exchanges in a bucket"},
      {BuildPass::kJoin, BuildWork::kNode, bounds.of("passes/join_pass.h", "run", "for"), "nodes above the pieces"},
      {BuildPass::kNumbers, BuildWork::kNumberedNode, numbered, "nodes of a bucket"},
      {BuildPass::kCheck, CheckWork::kCheckedLine, windows * lines, "lines of a piece"},
  };
}

// What bounds say of an item's kinds of work together.
void expect_splits_within(const Counts& counts, const Bounds& bounds, std::uint64_t nodes) {
  const auto of = [&](BuildWork kind) { return counts[WorkId(kind).number()]; };
  const auto split_loop = [&](const char* function, const char* loop) {
    return bounds.of("tree/tree_splits.h", function, loop);
  };
  const std::uint64_t parts = split_loop("split_by_codes", "while");
  EXPECT_LE(of(BuildWork::kPart), nodes * parts) << "parts of a node";
  EXPECT_LE(of(BuildWork::kWeighedPart), nodes * parts * split_loop("split_by_codes", "for")) << "weighed parts";
  // Each turn of either loop splits a part at most.
  const std::uint64_t splits = of(BuildWork::kPart) + nodes * split_loop("split_to_leaves", "while");
  EXPECT_LE(of(BuildWork::kSearchStep), splits * split_loop("first_like_last", "for")) << "steps to the middle";
  EXPECT_LE(of(BuildWork::kTakenRecord),
            of(BuildWork::kLeaf) * bounds.of("passes/subtrees_pass.h", "add_leaf", "for")) << "triangles of a leaf";
}

template <class Layout>
void expect_within(const TestMesh& mesh, std::uint32_t leaf_triangles) {
  SCOPED_TRACE(testing::Message() << mesh.triangles.size() << " triangles, leaf " << leaf_triangles);
  const CountedBuild build = counted_build<Layout>(mesh, leaf_triangles);
  const Bounds bounds(build.input, Layout::kArenaBytes);
  for (const Limit& limit : limits_of(bounds, mesh.triangles.size())) {
    const auto& items = build.items[static_cast<std::size_t>(limit.pass)];
    EXPECT_FALSE(items.empty()) << sim::name_of(limit.pass);
    for (const Counts& counts : items) {
      EXPECT_LE(counts[limit.kind.number()], limit.most) << sim::name_of(limit.pass) << ": " << limit.loop;
    }
  }
  const std::uint64_t tops = bounds.of("passes/join_pass.h", "run", "for");
  for (const Counts& counts : build.items[static_cast<std::size_t>(BuildPass::kTop)]) {
    expect_splits_within(counts, bounds, tops);
  }
  for (const Counts& counts : build.items[static_cast<std::size_t>(BuildPass::kSubtrees)]) {
    const std::uint64_t nodes = counts[WorkId(BuildWork::kNode).number()];
    const std::uint64_t leaves = counts[WorkId(BuildWork::kLeaf).number()];
    expect_splits_within(counts, bounds, nodes);
    // Each node is opened, but for the first one of a piece before its turns, and ended.
    const std::uint64_t turns = bounds.of("passes/subtrees_pass.h", "add", "while");
    EXPECT_LE(leaves + nodes, turns) << "turns of pieces";
    EXPECT_LE(nodes, turns / (kTreeWidth + 1)) << "nodes of a bucket";
  }
}

template <class Layout>
class BuildLoops : public testing::Test {};
using Layouts = testing::Types<BuildLayout256K, BuildLayout64K>;
TYPED_TEST_SUITE(BuildLoops, Layouts);

TYPED_TEST(BuildLoops, ASmallMeshKeepsTheirBounds) {
  expect_within<TypeParam>(make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 8);
  for (const std::uint32_t leaf : {1u, 8u, 16u}) expect_within<TypeParam>(make_torus(50, 60, 3, 1), leaf);
}

// A crowd of one code that no store holds, one of equal triangles, triangles without area, and codes that differ in
// their last bits alone.
TYPED_TEST(BuildLoops, ACrowdKeepsTheirBounds) {
  TestMesh mesh = moved(make_random_soup(TypeParam::kLoneKeys + 1500, 0.001f, 3), 1e-5f);
  for (int i = 0; i < 400; ++i) {
    const auto x = static_cast<float>(i);
    mesh.append(make_triangle({0, 0, 0}, {x, 0, 0}, {2 * x, 0, 0}));
    mesh.append(make_triangle({0, 9, 0}, {1, 9, 0}, {0, 10, 0}));
  }
  mesh.append(moved(make_random_soup(2000, 0.3f, 4), 3000.0f));
  mesh.append(make_triangle({1e6f, 1e6f, 1e6f}, {1e6f, 1e6f, 1e6f + 8}, {1e6f, 1e6f + 8, 1e6f}));
  for (const std::uint32_t leaf : {1u, 4u}) expect_within<TypeParam>(mesh, leaf);
}

// So many levels that triangles are split by their number.
TYPED_TEST(BuildLoops, ADeepTreeKeepsTheirBounds) {
  TestMesh mesh;
  float scale = 1e-20f;
  for (std::uint64_t i = 0; i < 14; ++i, scale *= 2000) {
    mesh.append(moved(make_random_soup(i == 0 ? TypeParam::kBucketKeys + 900 : 40, 0.3f, i), scale));
  }
  for (const std::uint32_t leaf : {1u, 16u}) expect_within<TypeParam>(mesh, leaf);
}

// Of a build of so many triangles.
template <class Layout>
Bounds bounds_of(std::uint32_t triangles) {
  BuildInput input;
  input.vertex_count = input.triangle_count = triangles;
  return {input, Layout::kArenaBytes};
}

// The most shares that a number of keys can make: at each digit a key alone before a value of too many keys, down to a
// code of too many.
TYPED_TEST(BuildLoops, TheWorstKeysMakeNoMoreShares) {
  constexpr std::uint32_t kRoom = TypeParam::kFarKeys, kDigit = TypeParam::kDigitBits, kBlocks = 20;
  constexpr std::uint32_t kLevels = (kTreeCodeBits + kDigit - 1) / kDigit;
  std::vector<std::uint32_t> codes;
  for (std::uint32_t block = 0; block < kBlocks; ++block) {
    std::uint32_t code = 2 * block << (kTreeCodeBits - kDigit), bits = kTreeCodeBits;
    for (std::uint32_t level = 0; level < kLevels; ++level) {
      bits = bits > kDigit ? bits - kDigit : 0;
      codes.push_back(code);
      code += 1u << bits;
    }
    codes.insert(codes.end(), kRoom + 1, code);
  }
  TestPlatform platform(16, Moves::kAtOnce, 0);
  WorkCounters work;
  BuildTransfers<TestPlatform> transfers(platform, work);
  std::vector<BucketKey> keys(kRoom);
  alignas(16) static std::uint32_t counts[kSortCounts<kDigit>];
  std::uint32_t shares = 0, looks = 0, most_looks = 0, last_code = ~0u;
  std::vector<std::uint32_t> sorted;
  const auto each = [&](auto&& visit) {
    ++looks;
    for (std::uint32_t i = 0; i < codes.size(); ++i) EXPECT_EQ(visit(codes[codes.size() - 1 - i], i), Status::kOk);
    return Status::kOk;
  };
  const auto emit = [&](const BucketKey* share, std::uint32_t count) {
    if (share[0].key.code() != last_code) {  // else more of a code of too many
      ++shares;
      most_looks = std::max(most_looks, looks);
      looks = 0;
    }
    for (std::uint32_t i = 0; i < count; ++i) sorted.push_back(share[i].key.code());
    last_code = sorted.back();
    return Status::kOk;
  };
  const auto count = static_cast<std::uint32_t>(codes.size());
  ASSERT_EQ(sort_far<TypeParam>(transfers, count, keys.data(), kRoom, counts, each, emit), Status::kOk);
  EXPECT_EQ(sorted, codes);
  EXPECT_EQ(shares, kBlocks * (kLevels + 1));
  const Bounds bounds = bounds_of<TypeParam>(count);
  EXPECT_LE(shares, bounds.of("passes/code_again.h", "sort_far", "while (done"));
  // The last look of a share takes it.
  EXPECT_EQ(most_looks, bounds.of("passes/code_again.h", "sort_far", "while (end") + 1);
}

// Splits ranges of codes, and counts turns of its loops each time they are entered.
class CountedSplits : private TreeSplits<CountedSplits> {
 public:
  explicit CountedSplits(std::vector<std::uint32_t> codes) : TreeSplits(8), codes_(std::move(codes)) {}

  void split(std::uint32_t begin, std::uint32_t end, std::uint32_t depth) {
    TreeRange ranges[kTreeWidth];
    std::uint32_t count = 0;
    rounds_ = 0;
    EXPECT_EQ(split_range(begin, end, depth, ranges, count), Status::kOk);
    for (std::uint32_t i = 0; i < count; ++i) {
      if (ranges[i].level >= 0) split(ranges[i].begin, ranges[i].end, depth + 1);
    }
  }
  mutable std::uint32_t most_steps = 0, most_rounds = 0, most_weighed = 0;

 private:
  friend TreeSplits;
  [[nodiscard]] std::uint32_t code_of(std::uint32_t i) const { return codes_[i]; }
  [[nodiscard]] std::uint32_t middle_of(const TreeRange& part) const {
    return first_like_last(part.begin, part.end, code_of(part.begin), code_of(part.end - 1));
  }
  [[nodiscard]] Status code_again(std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) codes_[i] = i - begin;
    return Status::kOk;
  }
  [[nodiscard]] std::uint32_t whole_count() const { return static_cast<std::uint32_t>(codes_.size()); }
  void count_work(SplitWork work, std::uint32_t amount) const {
    steps_ = work == SplitWork::kSearchStep ? steps_ + amount : 0;
    most_steps = std::max(most_steps, steps_);
    if (work != SplitWork::kWeighedPart) return;
    most_rounds = std::max(most_rounds, ++rounds_);
    most_weighed = std::max(most_weighed, amount);
  }

  std::vector<std::uint32_t> codes_;
  mutable std::uint32_t steps_ = 0, rounds_ = 0;
};

TYPED_TEST(BuildLoops, SplitsTakeTheirMostTurns) {
  for (const std::uint32_t count : {300u, 5000u, 100000u}) {
    TestRandom random(count);
    std::vector<std::uint32_t> codes(count);
    for (std::uint32_t& code : codes) code = random.below(1u << kTreeCodeBits);
    std::ranges::sort(codes);
    CountedSplits splits(codes);
    splits.split(0, count, 1);
    const Bounds bounds = bounds_of<TypeParam>(count);
    EXPECT_EQ(splits.most_steps, bounds.of("tree/tree_splits.h", "first_like_last", "for"));
    EXPECT_EQ(splits.most_rounds, bounds.of("tree/tree_splits.h", "split_by_codes", "while"));
    EXPECT_EQ(splits.most_weighed, bounds.of("tree/tree_splits.h", "split_by_codes", "for"));
  }
}

TEST(BuildLoopRows, AreNotKnownWithoutABuild) {
  for (const tool::LoopRow& row : tool::LoopFacts().rows()) EXPECT_EQ(row.value.has_value(), row.kind == "constant");
}

}  // namespace
}  // namespace gridiron::test
