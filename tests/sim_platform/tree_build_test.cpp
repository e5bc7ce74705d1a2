// The passes that build the tree on the cores: the same bytes as build_tree(), whatever the mesh, the store, the number
// of cores, the order of items and the time that transfers take.
// Memory: std::vector and the simulated main memory. Threads: starts some. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/passes/build_passes.h>
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/build/tree/tree_builder.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/sim/build_pass_work.h>
#include <gridiron/sim/passes.h>

#include "build_entry.h"
#include "core/build/grid/line_buffer.h"
#include "support/image_to_build.h"
#include "support/ply_load.h"

namespace gridiron::test {
namespace {

using sim::Completion;

struct Built {
  Status status = Status::kOk;
  TreeSize size{};
  std::vector<VertexTriangle> records;
  std::vector<TreeNode> nodes;
  std::vector<sim::FrameTrace> traces;  // of passes
  std::uint64_t transfers = 0;          // of all passes
  std::string words;                    // of rules that were broken
};

Built built_by_one(const TestMesh& mesh, std::uint32_t leaf_triangles, TreeOrder order) {
  Built tree;
  const std::uint64_t count = mesh.triangles.size();
  tree.records.resize(count);
  tree.nodes.resize(most_tree_nodes(count, leaf_triangles));
  std::vector<std::uint64_t> scratch(tree_scratch_bytes(count) / 8);
  tree.status = build_tree(mesh.view(), leaf_triangles, tree.records, tree.nodes,
                           std::as_writable_bytes(std::span(scratch)), tree.size, order);
  tree.records.resize(tree.size.triangle_count);
  tree.nodes.resize(tree.size.node_count);
  return tree;
}

// A core that claims the last item first.
template <class P>
class Backwards {
 public:
  Backwards(P& inner, std::uint32_t count) : inner_(inner), count_(count) {}
  [[nodiscard]] PlatformLimits limits() const { return inner_.limits(); }
  Status get(void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    return inner_.get(local, address, bytes, tag);
  }
  Status put(const void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    return inner_.put(local, address, bytes, tag);
  }
  Status wait(TagMask tags) { return inner_.wait(tags); }
  ItemClaim claim_item() {
    ItemClaim claim = inner_.claim_item();
    claim.item = count_ - 1 - claim.item;
    return claim;
  }

 private:
  P& inner_;
  std::uint32_t count_;
};

struct Way {
  std::uint32_t cores = 1;
  Completion completion = Completion::kEarly;
  std::uint64_t seed = 0;
  sim::Mode mode = sim::Mode::kChecked;
  std::uint32_t queue_depth = 16;
  bool backwards = false;
  std::optional<std::uint32_t> record_room{}, node_room{};
  std::uint64_t fail_transfer = 0;
  bool is_instrumented = false;
};

// Runs a pass by code whose loads and stores are checked. @param data  BuildStore, then room for a plan.
template <class Layout>
Status run_instrumented([[maybe_unused]] sim::SimCore& core, [[maybe_unused]] std::span<std::byte> data,
                        [[maybe_unused]] const BuildPlan& plan, [[maybe_unused]] BuildPass pass) {
#ifdef GRIDIRON_INSTRUMENTED
  const auto& copy = *new (data.data() + sizeof(BuildStore<Layout>)) BuildPlan(plan);
  const sim::SimCore::AccessScope scope(core, __builtin_frame_address(0));
  return build_instrumented(Layout::kArenaBytes == 65536, core, data.data(), copy, pass);
#else
  return Status::kBadParameter;
#endif
}

// Runs the passes of a plan.
template <class Layout>
sim::PassesResult run_plan(sim::SimMemory& memory, const BuildPlan& plan, const Way& way,
                           const std::vector<sim::MainRange>& writable) {
  std::vector<sim::Pass> passes;
  for (std::uint32_t i = 0; i < kBuildPassCount; ++i) {
    const auto kernel = [&plan, &way, i](auto& core, std::span<std::byte> data) {
      // Whatever ran before has left something there.
      std::ranges::fill(data, std::byte{0x5A});
      auto& store = *reinterpret_cast<BuildStore<Layout>*>(data.data());
      if constexpr (std::is_same_v<decltype(core), sim::SimCore&>) {
        if (way.is_instrumented) return run_instrumented<Layout>(core, data, plan, static_cast<BuildPass>(i));
      }
      if (!way.backwards) return run_build_pass(core, store, plan, static_cast<BuildPass>(i));
      Backwards reversed(core, plan.item_counts[i]);
      return run_build_pass(reversed, store, plan, static_cast<BuildPass>(i));
    };
    passes.push_back({.name = "pass",
                      .items = {.most = plan.item_counts[i]},
                      .data_bytes = static_cast<std::uint32_t>(sizeof(BuildStore<Layout>) +
                                                               (way.is_instrumented ? sizeof(BuildPlan) : 0)),
                      .writable = writable,
                      .kernel = sim::PassKernel(kernel),
                      .engine = &sim::work_of(static_cast<BuildPass>(i))});
  }
  sim::ChipOptions options;
  options.mode = way.mode;
  options.threads = way.cores;
  options.completion = way.completion;
  options.seed = way.seed;
  options.limits.queue_depth = way.queue_depth;
  options.fail_transfer = way.fail_transfer;
  options.store = Layout::kArenaBytes > 65536 ? sim::StoreSize::k256KB : sim::StoreSize::k64KB;
  return sim::run_passes(memory, passes, options);
}

std::string words_of_violations(const sim::PassesResult& run) {
  std::string words;
  for (const sim::PassRun& pass : run.passes) {
    for (const sim::Violation& violation : pass.result.violations) words += violation.detail + "\n";
  }
  return words;
}

template <class Layout>
Built built_by_cores(const TestMesh& mesh, std::uint32_t leaf_triangles, TreeOrder order, const Way& way) {
  const std::uint64_t count = mesh.triangles.size();
  BuildInput input;
  input.vertex_count = static_cast<std::uint32_t>(mesh.vertices.size());
  input.triangle_count = static_cast<std::uint32_t>(count);
  input.leaf_triangles = leaf_triangles;
  input.order = order;
  input.record_room = way.record_room.value_or(input.triangle_count);
  input.node_room = way.node_room.value_or(static_cast<std::uint32_t>(most_tree_nodes(count, leaf_triangles)));
  const std::uint64_t scratch_bytes = build_scratch_bytes<Layout>(input);
  sim::SimMemory memory(scratch_bytes + 16 * mesh.vertices.size() + 64 * count + 512ull * input.node_room + (1u << 20));
  const auto place = [&memory](std::uint64_t bytes) {
    return memory.allocate(std::max<std::uint64_t>(bytes, 128)).value();
  };
  const auto vertices = place(12 * mesh.vertices.size() + 16), triangles = place(12 * count + 16);
  const auto records = place(sizeof(VertexTriangle) * count), nodes = place(sizeof(TreeNode) * input.node_room);
  const auto result = place(sizeof(BuildResult)), scratch = place(scratch_bytes);
  std::ranges::copy(std::as_bytes(std::span(mesh.vertices)), vertices.bytes.begin());
  std::ranges::copy(std::as_bytes(std::span(mesh.triangles)), triangles.bytes.begin());
  for (const auto& region : {records, nodes, result, scratch}) std::ranges::fill(region.bytes, std::byte{0xA5});
  input.vertices = vertices.address;
  input.triangles = triangles.address;
  input.records = records.address;
  input.nodes = nodes.address;
  input.result = result.address;
  input.scratch = scratch.address;

  Built tree;
  BuildPlan plan{};
  tree.status = plan_build<Layout>(input, plan);
  if (tree.status != Status::kOk) return tree;
  std::vector<sim::MainRange> writable;
  for (const auto& region : {records, nodes, result, scratch}) {
    writable.push_back({region.address.value, region.address.value + region.bytes.size()});
  }
  sim::PassesResult run = run_plan<Layout>(memory, plan, way, writable);
  tree.status = run.status;
  tree.words = words_of_violations(run);
  tree.transfers = run.transfers;
  for (sim::PassRun& pass : run.passes) tree.traces.push_back(std::move(pass.result.trace));
  if (tree.status != Status::kOk) return tree;
  std::memcpy(&tree.size, result.bytes.data(), sizeof tree.size);
  const auto taken = [](const auto& region, auto& elements, std::uint32_t n) {
    elements.resize(n);
    std::ranges::copy(region.bytes.first(n * sizeof elements[0]), std::as_writable_bytes(std::span(elements)).begin());
    const auto rest = region.bytes.subspan(n * sizeof elements[0]);
    return std::ranges::all_of(rest, [](std::byte byte) { return byte == std::byte{0xA5}; });
  };
  EXPECT_TRUE(taken(records, tree.records, tree.size.triangle_count)) << "a record behind the last one";
  EXPECT_TRUE(taken(nodes, tree.nodes, tree.size.node_count)) << "a node behind the last one";
  return tree;
}

template <class Element>
std::size_t first_difference(const std::vector<Element>& a, const std::vector<Element>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::memcmp(&a[i], &b[i], sizeof a[i]) != 0) return i;
  }
  return a.size();
}

void expect_same(const Built& cores, const Built& one) {
  ASSERT_EQ(cores.status, one.status) << cores.words;
  if (one.status != Status::kOk) return;
  ASSERT_EQ(cores.size.triangle_count, one.size.triangle_count);
  ASSERT_EQ(cores.size.node_count, one.size.node_count);
  EXPECT_EQ(std::memcmp(&cores.size, &one.size, sizeof one.size), 0);
  EXPECT_EQ(first_difference(cores.records, one.records), one.records.size());
  EXPECT_EQ(first_difference(cores.nodes, one.nodes), one.nodes.size());
}

// Any of the ways.
template <class Layout>
void expect_same_any_way(const TestMesh& mesh, std::uint32_t leaf_triangles = 8) {
  const Built one = built_by_one(mesh, leaf_triangles, TreeOrder::kForAnyHit);
  const Way ways[] = {{.cores = 1, .completion = Completion::kLate},
                      {.cores = 3, .completion = Completion::kRandom, .seed = 5},
                      {.cores = 16, .completion = Completion::kRandom, .seed = 6, .queue_depth = 1},
                      {.mode = sim::Mode::kPlain, .backwards = true}};
  for (const Way& way : ways) {
    SCOPED_TRACE(testing::Message() << "leaf " << leaf_triangles << " cores " << way.cores << " queue "
                                    << way.queue_depth << " bytes " << Layout::kArenaBytes);
    expect_same(built_by_cores<Layout>(mesh, leaf_triangles, TreeOrder::kForAnyHit, way), one);
  }
  expect_same(built_by_cores<Layout>(mesh, leaf_triangles, TreeOrder::kByNumber, {.mode = sim::Mode::kPlain}),
              built_by_one(mesh, leaf_triangles, TreeOrder::kByNumber));
}

template <class Layout>
class TreeBuild : public testing::Test {};
using Layouts = testing::Types<BuildLayout256K, BuildLayout64K>;
TYPED_TEST_SUITE(TreeBuild, Layouts);

TestMesh flat(std::uint32_t count) {
  TestMesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto x = static_cast<float>(i);
    mesh.append(make_triangle({0, 0, 0}, {x, 0, 0}, {2 * x, 0, 0}));
  }
  return mesh;
}
TestMesh equal_triangles(std::uint32_t count) {
  TestMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles.assign(count, UVec3(0, 1, 2));
  return mesh;
}

TYPED_TEST(TreeBuild, IsThatOfOneCore) {
  expect_same_any_way<TypeParam>(make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  expect_same_any_way<TypeParam>(make_torus(50, 60, 3, 1), 7);
  expect_same_any_way<TypeParam>(make_random_soup(5000, 1.0f, 4), 16);
  expect_same_any_way<TypeParam>(make_height_field(40, 0.2f, 3), 1);
}

TYPED_TEST(TreeBuild, OfTrianglesInAnyOrder) {
  TestMesh mesh = make_height_field(60, 0.2f, 9);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::swap(mesh.triangles[i], mesh.triangles[i * 7919 % mesh.triangles.size()]);
  }
  expect_same_any_way<TypeParam>(mesh);
}

TYPED_TEST(TreeBuild, OfZerosOfBothSigns) {
  TestMesh mesh = make_height_field(40, 0.2f, 9);
  for (Vec3& vertex : mesh.vertices) vertex.y = vertex.y > 0 ? -0.0f : 0.0f;
  expect_same_any_way<TypeParam>(mesh);
}

TYPED_TEST(TreeBuild, OfNothingThatHasAnArea) {
  expect_same_any_way<TypeParam>(TestMesh{});
  expect_same_any_way<TypeParam>(flat(1));
  expect_same_any_way<TypeParam>(flat(3000));
}

TYPED_TEST(TreeBuild, RejectsBadMeshes) {
  const TestMesh good = make_sphere(20, 30, 1);
  TestMesh no_number = good, far_away = good, bad_index = good, last_index = good;
  no_number.vertices[17].y = std::numeric_limits<float>::quiet_NaN();
  far_away.vertices.back().z = -0x1p121f;
  bad_index.triangles[500].z = static_cast<std::uint32_t>(good.vertices.size());
  last_index.triangles.back().x = ~0u;
  TestMesh both = last_index;
  both.vertices[0].x = std::numeric_limits<float>::infinity();
  for (const TestMesh& mesh : {no_number, far_away, bad_index, last_index, both}) expect_same_any_way<TypeParam>(mesh);
  EXPECT_EQ(built_by_cores<TypeParam>(both, 8, {}, {}).status, Status::kBadVertex);
  EXPECT_EQ(built_by_cores<TypeParam>(last_index, 8, {}, {}).status, Status::kBadIndex);
  EXPECT_EQ(built_by_cores<TypeParam>(good, 0, {}, {}).status, Status::kBadParameter);
  EXPECT_EQ(built_by_cores<TypeParam>(good, kMaxTreeLeaf + 1, {}, {}).status, Status::kBadParameter);
}

TYPED_TEST(TreeBuild, RejectsTooLittleMemory) {
  const TestMesh mesh = make_sphere(20, 30, 1);
  const Built one = built_by_one(mesh, 8, TreeOrder::kForAnyHit);
  const auto with_room = [&](std::uint32_t records, std::uint32_t nodes) {
    Way way;
    way.record_room = records;
    way.node_room = nodes;
    return built_by_cores<TypeParam>(mesh, 8, TreeOrder::kForAnyHit, way);
  };
  expect_same(with_room(one.size.triangle_count, one.size.node_count), one);
  EXPECT_EQ(with_room(one.size.triangle_count - 1, one.size.node_count).status, Status::kMemoryTooSmall);
  EXPECT_EQ(with_room(one.size.triangle_count, one.size.node_count - 1).status, Status::kMemoryTooSmall);
}

TYPED_TEST(TreeBuild, PlansAsManyAsATreeMayHave) {
  const auto planned = [](std::uint32_t vertices, std::uint32_t triangles) {
    BuildInput input;
    input.vertex_count = vertices;
    input.triangle_count = triangles;
    BuildPlan plan{};
    return plan_build<TypeParam>(input, plan);
  };
  EXPECT_EQ(planned(kMostVertices, kMaxTreeTriangles), Status::kOk);
  EXPECT_EQ(planned(kMostVertices + 1, kMaxTreeTriangles), Status::kBadParameter);
  EXPECT_EQ(planned(kMostVertices, kMaxTreeTriangles + 1), Status::kTooManyTriangles);
}

// A core that gets two items, and then a reason why there are no more.
struct StoppedCore {
  ItemClaim::Kind reason;
  std::uint32_t claims = 0;
  [[nodiscard]] PlatformLimits limits() const { return {}; }
  Status get(void*, MainAddress, std::uint32_t, Tag) { return Status::kOk; }
  Status put(const void*, MainAddress, std::uint32_t, Tag) { return Status::kOk; }
  Status wait(TagMask) { return Status::kOk; }
  ItemClaim claim_item() {
    const std::uint32_t item = claims++;
    return item < 2 ? ItemClaim{ItemClaim::Kind::kItem, item} : ItemClaim{reason, 0};
  }
};

TEST(TreeBuildItems, EndForTheReasonThatAClaimGives) {
  const auto ended = [](ItemClaim::Kind reason) {
    StoppedCore core{reason};
    WorkCounters work{};
    BuildTransfers<StoppedCore> transfers(core, work);
    std::uint32_t items = 0;
    const Status status = for_each_item(transfers, 5, [&](std::uint32_t) {
      ++items;
      return Status::kOk;
    });
    EXPECT_EQ(items, 2u);
    EXPECT_EQ(core.claims, 3u);
    return status;
  };
  EXPECT_EQ(ended(ItemClaim::Kind::kNone), Status::kOk);
  EXPECT_EQ(ended(ItemClaim::Kind::kAborted), Status::kAborted);
  EXPECT_EQ(ended(ItemClaim::Kind::kDeadline), Status::kDeadline);
}

// One code of more triangles than a store holds: they are gone through several times.
TYPED_TEST(TreeBuild, OfCrowds) {
  expect_same_any_way<TypeParam>(equal_triangles(3000), 16);
  const std::uint32_t many = TypeParam::kBucketKeys * 2 + 77;
  expect_same_any_way<TypeParam>(equal_triangles(many), 4);
  const TestMesh crowd = moved(make_random_soup(many, 0.001f, 3), 1e-5f);
  const TestMesh far = make_triangle({1e6f, 1e6f, 1e6f}, {1e6f, 1e6f, 1e6f + 8}, {1e6f, 1e6f + 8, 1e6f});
  expect_same_any_way<TypeParam>(joined(crowd, far), 2);
  const TestMesh twin = moved(crowd, 1, Vec3(1e6f, 0, 0));
  expect_same_any_way<TypeParam>(joined(crowd, twin), 8);
}

// While one core codes a crowd again in main memory, others read the records of their buckets.
TYPED_TEST(TreeBuild, OfCrowdsAmongOthers) {
  const TestMesh others = make_random_soup(9000, 0.3f, 9);
  for (const std::uint32_t count : {33u, 200u, TypeParam::kBucketKeys - 100, TypeParam::kBucketKeys + 1000}) {
    TestMesh mesh = joined(moved(make_random_soup(count, 0.001f, 3), 1e-5f), others);
    mesh.append(moved(make_random_soup(count / 2, 0.001f, 4), 1e-5f, Vec3(0.125f)));
    expect_same_any_way<TypeParam>(mesh, 4);
  }
}

// So many levels that triangles are split by their number, also in the middle of a crowd.
TYPED_TEST(TreeBuild, OfDeepTrees) {
  TestMesh nested;
  float scale = 1e-20f;
  for (std::uint64_t i = 0; i < 14; ++i, scale *= 2000) {
    nested.append(moved(make_random_soup(i == 0 ? TypeParam::kBucketKeys + 900 : 40, 0.3f, i), scale));
  }
  ASSERT_EQ(built_by_one(nested, 1, TreeOrder::kForAnyHit).size.depth, kMaxTreeDepth);
  for (const std::uint32_t leaf : {1u, 16u}) expect_same_any_way<TypeParam>(nested, leaf);
  TestMesh geometric = moved(make_random_soup(3000, 1e-8f, 5), 1e-6f);
  for (int i = 0; i < 110; ++i) {
    const float size = std::ldexp(1.0f, i);
    geometric.append(moved(make_triangle({0, 0, 0}, {.3f, 0, 0}, {0, .3f, 0}), size, Vec3(size)));
  }
  for (const std::uint32_t leaf : {1u, 2u}) expect_same_any_way<TypeParam>(geometric, leaf);
}

// A node at depth 8 has a few triangles of one code more than fit below it, so it cuts the crowd by number. If they are
// two, most of its sixteenths are coded again; if they are 104, all are cut too, and most parts of these coded again.
TYPED_TEST(TreeBuild, OfALargeCrowdThatIsCutByNumber) {
  constexpr std::uint32_t kMore = TypeParam::kPieceKeys < 4096 ? 2 : 104;
  constexpr std::uint32_t kMany = 65536 + kMore - 200;  // the node has 200 others
  TestMesh nested = moved(make_random_soup(kMany, 0.3f, 1), 1e-20f);
  float scale = 1e-20f;
  for (std::uint64_t i = 0; i < 12; ++i) {
    scale *= 2000;
    nested.append(moved(make_random_soup(40, 0.3f, i), scale));
  }
  const Built one = built_by_one(nested, 1, TreeOrder::kForAnyHit);
  ASSERT_EQ(one.status, Status::kOk);
  ASSERT_EQ(one.size.depth, kMaxTreeDepth);
  expect_same(built_by_cores<TypeParam>(nested, 1, TreeOrder::kForAnyHit, {.cores = 6}), one);
}

// The transfers of an item do not depend on what the core did before.
TYPED_TEST(TreeBuild, HasTheSameTraceOnAnyNumberOfCores) {
  const TestMesh mesh = joined(make_height_field(60, 0.2f, 9), moved(equal_triangles(500), 0.001f));
  const Built first = built_by_cores<TypeParam>(mesh, 8, TreeOrder::kForAnyHit, {.cores = 1});
  const Built second = built_by_cores<TypeParam>(mesh, 8, TreeOrder::kForAnyHit, {.cores = 7});
  ASSERT_EQ(first.status, Status::kOk) << first.words;
  ASSERT_EQ(second.status, Status::kOk) << second.words;
  for (std::size_t pass = 0; pass < kBuildPassCount; ++pass) {
    const auto& tiles = first.traces[pass].tiles;
    ASSERT_EQ(tiles.size(), second.traces[pass].tiles.size());
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      EXPECT_EQ(tiles[i].packed, second.traces[pass].tiles[i].packed) << "pass " << pass << " item " << i;
    }
  }
}

// --- The image around the tree --------------------------------------------------------------------------------------

std::vector<std::byte> image_by_one(const TestMesh& mesh, std::uint32_t leaf_triangles) {
  const GridParameters parameters{.leaf_triangles = leaf_triangles, .has_tree = true, .has_grid = false};
  GridNeed need{};
  EXPECT_EQ(count_scene_image(mesh.view(), parameters, need), Status::kOk);
  LineBuffer image(need.image_bytes);
  std::vector<std::uint64_t> scratch(need.scratch_bytes / 8 + 1);
  EXPECT_EQ(build_scene_image(mesh.view(), parameters, need, image.bytes(), std::as_writable_bytes(std::span(scratch))),
            Status::kOk);
  SceneImageView view{};
  SceneImageError error;
  EXPECT_EQ(open_scene_image(image.bytes(), view, error), Status::kOk);
  const auto bytes = image.bytes().first(view.header.image_bytes);
  return {bytes.begin(), bytes.end()};
}

template <class Layout>
std::vector<std::byte> image_by_cores(const TestMesh& mesh, std::uint32_t leaf_triangles, const Way& way) {
  ImageToBuild<Layout> built(mesh, leaf_triangles, TreeOrder::kByNumber);
  const BuildPlan& plan = built.plan;
  const sim::PassesResult run = run_plan<Layout>(built.memory, plan, way, built.writable);
  EXPECT_EQ(run.status, Status::kOk) << words_of_violations(run);
  if (run.status != Status::kOk) return {};
  const std::span<std::byte> image = built.image.bytes;
  auto& header = *reinterpret_cast<ImageHeader*>(image.data());
  const auto checks = built.memory.bytes_at(plan.piece_checks,
                                            sizeof(PieceCheck) * std::uint64_t{plan.item_counts[kBuildPassCount - 1]});
  EXPECT_EQ(finish_built_image({reinterpret_cast<const PieceCheck*>(checks.data()), checks.size() / sizeof(PieceCheck)},
                               header),
            Status::kOk);
  SceneImageView view{};
  SceneImageError error;
  EXPECT_EQ(open_scene_image(image, view, error), Status::kOk) << error.field;
  EXPECT_TRUE(std::ranges::all_of(image.subspan(header.image_bytes),
                                  [](std::byte byte) { return byte == ImageToBuild<Layout>::kUnwritten; }))
      << "behind its end";
  return {image.begin(), image.begin() + static_cast<std::ptrdiff_t>(header.image_bytes)};
}

// Each transfer that fails ends the build with its status, in whichever pass it is.
TYPED_TEST(TreeBuild, EveryFailedTransferSurfaces) {
  TestMesh mesh = make_random_soup(90, 1, 6);
  for (int i = 0; i < 40; ++i) mesh.append(make_triangle({0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}));
  const Built whole = built_by_cores<TypeParam>(mesh, 2, TreeOrder::kForAnyHit, {});
  ASSERT_EQ(whole.status, Status::kOk) << whole.words;
  std::set<std::size_t> passes;
  for (std::uint64_t i = 1; i <= whole.transfers; ++i) {
    Way way = {.cores = i % 2 == 0 ? 1u : 3u, .completion = Completion::kLate};
    way.fail_transfer = i;
    const Built failed = built_by_cores<TypeParam>(mesh, 2, TreeOrder::kForAnyHit, way);
    ASSERT_EQ(failed.status, Status::kTransferFailed) << "transfer " << i << " of " << whole.transfers;
    passes.insert(failed.traces.size());
  }
  EXPECT_EQ(passes.size(), kBuildPassCount - 1u) << "every pass but that of an image";
}

// No load or store beyond the store and the stack, nor of bytes that are under way.
TYPED_TEST(TreeBuild, InstrumentedCodeStaysInItsStore) {
#ifndef GRIDIRON_INSTRUMENTED
  GTEST_SKIP() << "no instrumentation in this build";
#endif
  TestMesh mesh = make_random_soup(5003, 1, 4);
  mesh.append(equal_triangles(TypeParam::kBucketKeys * 2 + 77));
  for (const std::uint32_t leaf : {3u, 16u}) {
    const Way way = {.cores = 3, .completion = Completion::kLate, .is_instrumented = true};
    EXPECT_EQ(image_by_cores<TypeParam>(mesh, leaf, way), image_by_one(mesh, leaf));
  }
}

// Header, section table, record of the tree, triangles, padding, nodes and check value.
TYPED_TEST(TreeBuild, WholeImageIsThatOfPrepare) {
  TestMesh some_flat = make_torus(50, 60, 3, 1);
  some_flat.append(flat(7));
  TestMesh below_zero = make_height_field(20, 0.2f, 3);
  for (Vec3& vertex : below_zero.vertices) vertex.y = -0.0f;
  for (const TestMesh& mesh : {make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), some_flat, make_random_soup(5003, 1, 4),
                               moved(make_height_field(40, 0.2f, 3), 1, Vec3(-7, 0, 0)), below_zero}) {
    for (const std::uint32_t leaf : {3u, 16u}) {
      const std::vector<std::byte> one = image_by_one(mesh, leaf);
      for (std::uint32_t cores = 1; cores <= 16; cores += cores < 3 ? 1 : 13) {
        SCOPED_TRACE(testing::Message() << mesh.triangles.size() << " leaf " << leaf << " cores " << cores);
        const Way way = {.cores = cores, .completion = Completion::kRandom, .seed = cores, .backwards = cores == 2};
        const std::vector<std::byte> many = image_by_cores<TypeParam>(mesh, leaf, way);
        ASSERT_EQ(many.size(), one.size());
        const auto [first, second] = std::ranges::mismatch(many, one);
        EXPECT_EQ(first - many.begin(), std::ptrdiff_t(one.size())) << "the first byte that differs";
      }
    }
  }
}

// One check value of all pieces; an image that has one keeps it.
TEST(TreeBuildImage, GetsOneCheckValue) {
  ImageHeader header{};
  header.image_bytes = 2 * ImageCheckValue::kPieceBytes + kLineBytes;
  const PieceCheck checks[] = {{17, 0}, {4, 0}, {1234, 0}, {5, 0}};
  EXPECT_EQ(finish_built_image(std::span(checks).first(2), header), Status::kBadImage);
  EXPECT_EQ(header.check_value, 0u);
  ASSERT_EQ(finish_built_image(checks, header), Status::kOk);
  ImageCheckValue expected;
  for (const PieceCheck& check : std::span(checks).first(3)) expected.add_piece(check.value);
  EXPECT_EQ(header.check_value, expected.value());
  EXPECT_EQ(finish_built_image(checks, header), Status::kBadImage);
  EXPECT_EQ(header.check_value, expected.value());
}

// So many runs that each has few samples, and so many buckets that their codes and cuts leave in parts,
// each when it is waited for.
TEST(TreeBuildRuns, AreManyInASmallStore) {
  const TestMesh mesh = make_height_field(260, 0.2f, 3);
  ASSERT_GT(mesh.triangles.size(), 128u * BuildLayout64K::kRunTriangles);
  expect_same(built_by_cores<BuildLayout64K>(mesh, 16, TreeOrder::kForAnyHit,
                                             {.cores = 2, .completion = Completion::kLate, .queue_depth = 250}),
              built_by_one(mesh, 16, TreeOrder::kForAnyHit));
}

TEST(TreeBuildFiles, AreThoseOfOneCore) {
  for (const char* name : {"teapot.ply", "needles.ply"}) {
    const std::optional<TestMesh> mesh = load_ply(std::filesystem::path(GRIDIRON_SCENE_FILES) / name);
    ASSERT_TRUE(mesh) << name;
    expect_same_any_way<BuildLayout256K>(*mesh);
    expect_same_any_way<BuildLayout64K>(*mesh);
  }
}

}  // namespace
}  // namespace gridiron::test
