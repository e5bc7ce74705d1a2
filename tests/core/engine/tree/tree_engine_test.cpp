// The tree as an engine: rays hit what testing every triangle finds, however many transfers are under way and whenever
// they arrive; transfers that fail are reported, and trees that a core cannot hold are refused.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/one_lane.h>
#include <gridiron/engine/tree/tree_engine.h>
#include <gridiron/store/local_store.h>

#include "core/build/grid/built_image.h"
#include "core/dma/test_platform.h"
#include "core/lane_types.h"
#include "numeric/hard_rays.h"
#include "numeric/oracle.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using Large = EffectLayout256K<kAllEffects, 8>;
using Small = EffectLayout64K<kAllEffects>;
/// The small layout with longer batches and lists.
struct Roomy : Small {
  static constexpr std::uint32_t kBatchRays = 4 * Small::kBatchRays;
  static constexpr std::uint32_t kSpareListWords = 1024;
};

constexpr std::uint64_t kImage = 4096;
constexpr std::uint32_t kTraced = 0xFFFFFFFEu;  // an id that no ray is answered with

// A mesh, its image and the exact answers.
struct TreeScene {
  TestMesh mesh;
  LineBuffer image;
  SceneImageView view{};
  Accuracy accuracy;

  explicit TreeScene(Accuracy wanted, std::uint32_t leaf_triangles = 8) : accuracy(wanted) {
    mesh = make_sphere(9, 14, 0.5f);
    mesh.append(make_random_soup(150, 0.2f, 5));
    TestMesh again = make_random_soup(40, 0.2f, 5);  // ties: some triangles are there twice
    mesh.append(again);
    TestMesh box = make_box({-0.75f, -0.75f, -0.75f}, {0.75f, 0.75f, 0.75f});
    mesh.append(box);
    const bool is_compact = accuracy == Accuracy::kCompact;
    if (is_compact) mesh.snap();
    GridParameters parameters;
    parameters.leaf_triangles = leaf_triangles;
    parameters.format = is_compact ? TriangleFormat::kLattice : TriangleFormat::kVertices;
    const Material materials[1] = {};
    const std::vector<std::uint16_t> triangle_materials(mesh.triangles.size(), 0);
    EffectsView effects{};
    effects.materials = materials;
    effects.triangle_materials = triangle_materials;
    BuiltImage built = build_image(mesh.view(), parameters, std::byte{0}, &effects);
    image = std::move(built.image);
    view = built.view;
  }
};

// Rays from the surfaces, from inside and outside, at vertices and edges, anywhere; with limits and without.
std::vector<OracleRay> random_rays(const TestMesh& mesh, std::uint32_t count, std::uint64_t seed) {
  std::vector<OracleRay> rays;
  TestRandom random(seed);
  Vec3 origin(0.0f);
  while (rays.size() < count) {
    // Neighbours begin near each other, as they do in a picture.
    if (random.below(12) == 0) origin = random_vec(random, random.below(3) == 0 ? 3.0f : 1.0f);
    Vec3 start = origin + random_vec(random, 0.01f);
    if (random.below(8) == 0) start = mesh.vertices[random.below(static_cast<std::uint32_t>(mesh.vertices.size()))];
    const auto aim = static_cast<Aim>(random.below(static_cast<std::uint32_t>(Aim::kCount)));
    OracleRay ray = ray_at(mesh, start, aim, random);
    if (random.below(3) == 0) {
      for (float& value : ray.direction) value = random.between(-1, 1);
    }
    const std::uint32_t limit = random.below(4);
    if (limit == 0) ray.t_max = 1.0f;
    if (limit == 1) ray.t_max = 2.0f * random.unit() + 0.01f;
    rays.push_back(ray);
  }
  return rays;
}

struct Answer {
  std::uint32_t id = kTraced;
  float t = 0.0f;  // of a hit, along the direction as it was given
  friend bool operator==(const Answer&, const Answer&) = default;
};

// Hands rays out in jobs of 1..16 and takes the answers back.
struct RayJobs {
  const std::vector<OracleRay>& rays;
  std::uint32_t batch_rays;  // that a batch has room for
  std::vector<Answer> answers;
  std::uint32_t next_ray = 0, jobs = 0, batches = 0;
  std::uint32_t rays_under_way = 0;

  RayJobs(const std::vector<OracleRay>& all, std::uint32_t room) : rays(all), batch_rays(room), answers(all.size()) {}

  // Owners are not the rays' places: nothing may depend on their order.
  [[nodiscard]] static std::uint32_t owner_of(std::uint32_t ray) { return ray ^ 0xA5u; }

  bool next(RayBatch& batch) {
    EXPECT_EQ(batch.count, rays_under_way) << "a batch goes on as it was";
    EXPECT_LE(batch.count + kJobRays, batch_rays) << "no room for a job";
    const std::uint32_t wanted = jobs % 5 == 0 ? 1 + jobs % 16 : kJobRays;
    const std::uint32_t count = std::min(wanted, static_cast<std::uint32_t>(rays.size()) - next_ray);
    for (std::uint32_t i = 0; i < count; ++i, ++next_ray) {
      const OracleRay& ray = rays[next_ray];
      BatchRay& made = batch.rays[batch.count];
      for (int axis = 0; axis < 3; ++axis) {
        made.origin[axis] = ray.origin[axis];
        made.dir[axis] = ray.direction[axis];
      }
      made.t = ray.t_max;
      made.id = kNoTriangle;
      batch.owners[batch.count] = owner_of(next_ray);
      ++batch.count;
    }
    rays_under_way += count;
    ++jobs;
    return count != 0;
  }
  void finish(const RayBatch& batch) {
    EXPECT_EQ(batch.count, rays_under_way);
    EXPECT_GT(batch.count, 0u);
    for (std::uint32_t i = 0; i < batch.count; ++i) {
      const std::uint32_t ray = owner_of(batch.owners[i]);
      ASSERT_LT(ray, answers.size());
      EXPECT_EQ(answers[ray].id, kTraced) << "a ray is answered twice";
      EXPECT_EQ(ray, next_ray - batch.count + i) << "not its own owner";
      // Directions may have been scaled by a power of two, and t with them.
      float scale = 1.0f;
      for (int axis = 0; axis < 3; ++axis) {
        if (rays[ray].direction[axis] != 0.0f) scale = batch.rays[i].dir[axis] / rays[ray].direction[axis];
      }
      answers[ray] = {batch.rays[i].id, batch.rays[i].id == kNoTriangle ? 0.0f : batch.rays[i].t * scale};
    }
    rays_under_way = 0;
    ++batches;
  }
};

struct RunOptions {
  bool any_hit = false;
  std::uint32_t depth = 2, queue_depth = 16;
  Moves moves = Moves::kAtTheWait;
  std::uint64_t seed = 1;
  std::optional<std::size_t> failing_command = std::nullopt;
};

struct Run {
  Status status = Status::kOk;
  std::vector<Answer> answers;
  WorkCounters work;
  std::string violation;
  std::size_t commands = 0, left_pending = 0;
  std::uint32_t most_pending = 0, batches = 0;
};

// A core with one engine, as a frame makes it.
template <class L, class Layout>
struct Rig {
  using Store = LocalStore<Layout>;
  TestPlatform platform;
  std::unique_ptr<Store> store = std::make_unique<Store>();
  Transfers<TestPlatform> transfers{platform, store->work};
  typename Layout::RayEngine::template Core<L, Store, TestPlatform> core{*store, transfers};
  RayQuestion question{};

  Rig(const TreeScene& scene, const RunOptions& options)
      : platform(options.queue_depth, options.moves, kImage + scene.image.bytes().size() + 4096, options.seed) {
    std::memset(static_cast<void*>(store.get()), 0xC3, sizeof(Store));
    std::memcpy(platform.at(kImage), scene.image.bytes().data(), scene.image.bytes().size());
    store->frame = {};
    store->work = {};
    store->frame.accuracy = static_cast<std::uint32_t>(scene.accuracy);
    store->frame.fetch_depth = options.depth;
    store->frame.image_address = kImage;
    store->frame.tree_address = kImage + scene.view.tree_offset_bytes;
    question = {options.any_hit, true, scene.accuracy == Accuracy::kFast, scene.accuracy == Accuracy::kExact,
                MainAddress{kImage + scene.view.effects.surfaces_offset_bytes}};
    platform.failing_command = options.failing_command;
  }
  [[nodiscard]] TreeRecord& tree() { return *reinterpret_cast<TreeRecord*>(platform.at(store->frame.tree_address)); }
  [[nodiscard]] Run trace(const std::vector<OracleRay>& rays) {
    Run run;
    RayJobs jobs(rays, Layout::kBatchRays);
    run.status = core.begin();
    if (run.status == Status::kOk) {
      core.begin_rays();
      run.status = core.trace(question, jobs);
    }
    run.answers = jobs.answers;
    run.batches = jobs.batches;
    run.work = store->work;
    run.violation = platform.violation();
    run.commands = platform.commands().size();
    run.left_pending = platform.pending();
    run.most_pending = platform.most_pending();
    return run;
  }
};

template <class L, class Layout>
Run trace(const TreeScene& scene, const std::vector<OracleRay>& rays, const RunOptions& options) {
  return Rig<L, Layout>(scene, options).trace(rays);
}

// Compares answers with the oracle's. @returns how many rays hit.
std::uint32_t expect_truth(const TreeScene& scene, const std::vector<OracleRay>& rays, bool any_hit,
                           const std::vector<Answer>& answers) {
  const Oracle oracle(scene.mesh.view(), {.reading = Reading::kStandard});
  std::uint32_t hit_count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const NearestHit nearest = oracle.nearest(rays[i]);
    const bool hits = !nearest.ties.empty();
    hit_count += hits ? 1u : 0u;
    if (!hits) {
      EXPECT_EQ(answers[i].id, kNoTriangle) << "ray " << i;
    } else if (any_hit) {
      bool is_one = false;
      for (const OracleHit& hit : oracle.hits(rays[i])) is_one = is_one || hit.triangle_id == answers[i].id;
      EXPECT_TRUE(is_one) << "ray " << i << " says " << answers[i].id;
    } else {
      EXPECT_EQ(answers[i].id, scene.accuracy == Accuracy::kExact ? nearest.ties[0] : nearest.float_ties[0])
          << "ray " << i;
      EXPECT_EQ(answers[i].t, nearest.t) << "ray " << i;
    }
  }
  return hit_count;
}

template <class L>
class TreeEngineTest : public testing::Test {};
TYPED_TEST_SUITE(TreeEngineTest, ListLaneTypes, LaneNames);

TYPED_TEST(TreeEngineTest, AnswersAsTheOracleDoes) {
  for (const Accuracy accuracy : {Accuracy::kStandard, Accuracy::kExact, Accuracy::kCompact}) {
    for (const bool any_hit : {false, true}) {
      for (const bool is_small : {false, true}) {
        // Leaves of one triangle: more nodes than the cache holds.
        const TreeScene scene(accuracy, is_small ? 1 : 8);
        const std::vector<OracleRay> rays = random_rays(scene.mesh, 1200, 40 + static_cast<std::uint64_t>(accuracy));
        const RunOptions options{.any_hit = any_hit};
        const Run run =
            is_small ? trace<TypeParam, Small>(scene, rays, options) : trace<TypeParam, Large>(scene, rays, options);
        ASSERT_EQ(run.status, Status::kOk);
        EXPECT_EQ(run.violation, "");
        EXPECT_EQ(run.left_pending, 0u);
        const std::uint32_t batch_rays = is_small ? Small::kBatchRays : Large::kBatchRays;
        EXPECT_GE(run.batches, 1200 / batch_rays);
        EXPECT_LE(run.batches, 1200 / (batch_rays - kJobRays + 1) + 1) << "batches that are not full";
        EXPECT_EQ(run.work[Work::kListRay], rays.size());
        const std::uint32_t hits = expect_truth(scene, rays, any_hit, run.answers);
        EXPECT_GT(hits, 500u);
        EXPECT_LT(hits, 1190u);
        EXPECT_EQ(run.work[Work::kExactOrder] != 0, accuracy == Accuracy::kExact && !any_hit) << "ties";
        EXPECT_EQ(run.work[Work::kLatticeTriangle] != 0, accuracy == Accuracy::kCompact);
      }
    }
  }
}

// What a run's answers and its work may depend on: the scene, the rays, the batch and no more.
template <class L, class Layout>
void expect_one_answer(Accuracy accuracy, bool any_hit) {
  const TreeScene scene(accuracy, 4);
  const std::vector<OracleRay> rays = random_rays(scene.mesh, 300, 8);
  const RunOptions slow{.any_hit = any_hit, .depth = 1, .queue_depth = 2, .moves = Moves::kAtOnce};
  const Run first = trace<L, Layout>(scene, rays, slow);
  ASSERT_EQ(first.status, Status::kOk);
  // Of several triangles in a leaf, which one any hit names depends on the lanes; that there is one does not.
  const Run four = trace<Lanes<4>, Layout>(scene, rays, slow);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(first.answers[i].id == kNoTriangle, four.answers[i].id == kNoTriangle) << "ray " << i;
    EXPECT_TRUE(any_hit || first.answers[i] == four.answers[i]) << "ray " << i;
  }
  EXPECT_LE(first.most_pending, 2u) << "one record, in two commands where it crosses a boundary";
  (void)expect_truth(scene, rays, any_hit, first.answers);
  std::uint32_t most_pending = 0;
  constexpr std::uint32_t kMost = TreeEngine::kMaxDepth<Layout>;
  for (std::uint32_t depth = 1; depth <= kMost; depth += depth < 4 ? 1 : kMost - 4 > 0 ? kMost - 4 : 1) {
    std::uint64_t seed = depth;
    for (const std::uint32_t queue_depth : {1u, 3u, 16u}) {
      for (const Moves moves : {Moves::kAtTheWait, Moves::kAtAnyTime}) {
        SCOPED_TRACE("depth " + std::to_string(depth) + ", queue of " + std::to_string(queue_depth) + ", moves " +
                     std::to_string(static_cast<int>(moves)));
        const Run run = trace<L, Layout>(scene, rays, {any_hit, depth, queue_depth, moves, seed++});
        ASSERT_EQ(run.status, Status::kOk);
        EXPECT_EQ(run.violation, "");
        EXPECT_EQ(run.left_pending, 0u);
        EXPECT_TRUE(run.answers == first.answers);
        most_pending = std::max(most_pending, run.most_pending);
        for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) {
          const WorkId work(kind);
          // What was asked for ahead may be evicted before its turn, and a full queue is waited for.
          if (work == Work::kWait || work == Work::kGetIssue || work == Work::kLatticeTriangle) continue;
          EXPECT_EQ(run.work.counts[kind], first.work.counts[kind]) << "kind " << kind;
        }
      }
    }
  }
  EXPECT_GT(most_pending, 2u) << "nothing is asked for ahead";
}

TYPED_TEST(TreeEngineTest, DepthAndTransfersChangeNothing) {
  for (const bool any_hit : {false, true}) {
    expect_one_answer<TypeParam, Large>(Accuracy::kExact, any_hit);
    expect_one_answer<TypeParam, Small>(Accuracy::kCompact, any_hit);
  }
}

// Which rays are traced together decides what is done for them, and no answer.
TYPED_TEST(TreeEngineTest, BatchesChangeNoAnswer) {
  const TreeScene scene(Accuracy::kStandard, 1);
  const std::vector<OracleRay> rays = random_rays(scene.mesh, 600, 9);
  for (const bool any_hit : {false, true}) {
    const Run long_batches = trace<TypeParam, Roomy>(scene, rays, {.any_hit = any_hit});
    const Run short_batches = trace<TypeParam, Small>(scene, rays, {.any_hit = any_hit});
    ASSERT_EQ(long_batches.status, Status::kOk) << long_batches.violation;
    ASSERT_EQ(short_batches.status, Status::kOk) << short_batches.violation;
    EXPECT_GT(short_batches.batches, 3 * long_batches.batches);
    EXPECT_GT(short_batches.work[Work::kListNode], long_batches.work[Work::kListNode]);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Answer &one = short_batches.answers[i], &other = long_batches.answers[i];
      EXPECT_EQ(one.id == kNoTriangle, other.id == kNoTriangle) << "ray " << i;
      EXPECT_TRUE(any_hit || one == other) << "ray " << i;
    }
  }
}

// Every so many commands one fails.
TYPED_TEST(TreeEngineTest, FailuresAreReported) {
  for (const Accuracy accuracy : {Accuracy::kStandard, Accuracy::kExact, Accuracy::kCompact}) {
    const TreeScene scene(accuracy, 2);
    const std::vector<OracleRay> rays = random_rays(scene.mesh, 90, 10);
    const RunOptions good{.depth = 3, .queue_depth = 2};
    const Run whole = trace<TypeParam, Small>(scene, rays, good);
    ASSERT_EQ(whole.status, Status::kOk);
    ASSERT_GT(whole.commands, 200u);
    const std::size_t step = whole.commands / 150 + 1;
    for (std::size_t i = TypeParam::kCount % step; i < whole.commands; i += step) {
      RunOptions options = good;
      options.failing_command = i;
      Rig<TypeParam, Small> rig(scene, options);
      const Run run = rig.trace(rays);
      ASSERT_EQ(run.status, Status::kTransferFailed) << "command " << i;
      EXPECT_EQ(run.commands, i + 1) << "goes on after a failure";
      EXPECT_EQ(run.violation, "");
      // What is still on its way can be waited for, and the same store then serves another frame.
      EXPECT_EQ(rig.platform.wait(TagMask{~0u}), Status::kOk);
      EXPECT_EQ(rig.platform.pending(), 0u);
      rig.platform.failing_command.reset();
      const Run again = rig.trace(rays);
      EXPECT_EQ(again.status, Status::kOk);
      EXPECT_EQ(again.violation, "");
      EXPECT_TRUE(again.answers == whole.answers) << "command " << i;
    }
  }
}

// What was fetched stays until other data takes its place: questions that follow find it, and buffers that are lent
// are fetched again.
TYPED_TEST(TreeEngineTest, LentBuffersAreFetchedAgain) {
  const TreeScene scene(Accuracy::kStandard, 8);
  const std::vector<OracleRay> rays = random_rays(scene.mesh, 200, 11);
  Rig<TypeParam, Large> rig(scene, {});
  const Run first = rig.trace(rays);
  ASSERT_EQ(first.status, Status::kOk);
  auto& memory = rig.store->wave.rays;
  const auto gets_of_another = [&] {
    const std::uint32_t before = rig.store->work[Work::kGetIssue];
    RayJobs jobs(rays, Large::kBatchRays);
    EXPECT_EQ(rig.core.trace(rig.question, jobs), Status::kOk);
    EXPECT_TRUE(jobs.answers == first.answers);
    return rig.store->work[Work::kGetIssue] - before;
  };
  // Buffers are apart, and each is as long as the longest record.
  for (std::uint32_t i = 0; i < TreeEngine::kMaxDepth<Large>; ++i) {
    const std::byte* const begin = memory.idle_buffer(i);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(begin) % kPortableCongruenceBytes, 0u);
    EXPECT_GE(begin, reinterpret_cast<const std::byte*>(&memory));
    EXPECT_LE(begin + kIdleBufferBytes, reinterpret_cast<const std::byte*>(&memory) + sizeof memory);
    if (i > 0) {
      EXPECT_GE(begin, memory.idle_buffer(i - 1) + kIdleBufferBytes);
    }
  }
  for (const std::uint32_t lent : {1u, 4u, TreeEngine::kMaxDepth<Large>}) {
    memory.lend(lent);
    for (std::uint32_t i = 0; i < lent; ++i) std::memset(memory.idle_buffer(i), 0x7E, kIdleBufferBytes);
    EXPECT_GT(gets_of_another(), 0u) << lent;
  }
}

TYPED_TEST(TreeEngineTest, TreesThatACoreCannotHoldAreRefused) {
  const TreeScene scene(Accuracy::kStandard, 8), compact(Accuracy::kCompact, 8), wide(Accuracy::kStandard, 9);
  const auto status_of = [](const TreeScene& tested, auto alter) {
    Rig<TypeParam, Small> rig(tested, {});
    alter(rig);
    const Status status = rig.core.begin();
    EXPECT_EQ(rig.platform.violation(), "");
    EXPECT_EQ(rig.platform.pending(), 0u);
    return status;
  };
  const auto nothing = [](auto&) {};
  EXPECT_EQ(status_of(scene, nothing), Status::kOk);
  EXPECT_EQ(status_of(compact, nothing), Status::kOk);
  EXPECT_EQ(status_of(wide, nothing), Status::kUnsupportedImage) << "leaves of nine triangles";
  EXPECT_EQ(status_of(scene, [](auto& rig) { rig.tree().node_count = 0; }), Status::kUnsupportedImage);
  EXPECT_EQ(status_of(scene, [](auto& rig) { rig.tree().depth = kMaxTreeDepth + 1; }), Status::kUnsupportedImage);
  const auto set_accuracy = [](Accuracy accuracy) {
    return [accuracy](auto& rig) { rig.store->frame.accuracy = static_cast<std::uint32_t>(accuracy); };
  };
  EXPECT_EQ(status_of(scene, set_accuracy(Accuracy::kFast)), Status::kOk);
  EXPECT_EQ(status_of(scene, set_accuracy(Accuracy::kCompact)), Status::kUnsupportedImage);
  EXPECT_EQ(status_of(compact, set_accuracy(Accuracy::kStandard)), Status::kUnsupportedImage);
}

TYPED_TEST(TreeEngineTest, RaysThatHitNothing) {
  const TreeScene scene(Accuracy::kStandard);
  const Run none = trace<TypeParam, Large>(scene, {}, {});
  EXPECT_EQ(none.status, Status::kOk);
  EXPECT_EQ(none.left_pending, 0u);
  EXPECT_EQ(none.batches, 0u) << "a batch of nothing is finished";
  EXPECT_LE(none.work[Work::kGetIssue], 3u) << "the record, and the root ahead of rays that do not come";
  // Rays without a direction, of no numbers, of infinities, or past the scene.
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
  std::vector<OracleRay> rays(128);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i] = {{5, 5, 5}, {1, 0, 0}};
    if (i % 8 == 0) rays[i].direction[0] = 0.0f;
    if (i % 8 == 1) rays[i].direction[i / 8 % 3] = kNan;
    if (i % 8 == 2) rays[i].origin[i / 8 % 3] = kNan;
    if (i % 8 == 3) rays[i].origin[0] = i % 16 < 8 ? kInfinity : -kInfinity;
    if (i % 8 == 4) rays[i] = {{0, 0, 0}, {0, 0, 0}};
    if (i % 8 == 5) rays[i] = {{0, 0, 0}, {1, 2, 3}, 0.0f, 0.0f};
    if (i % 8 == 6) rays[i].direction[2] = i % 16 < 8 ? kInfinity : -kInfinity;
  }
  for (const bool any_hit : {false, true}) {
    const Run past = trace<TypeParam, Large>(scene, rays, {.any_hit = any_hit});
    EXPECT_EQ(past.status, Status::kOk);
    for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(past.answers[i].id, kNoTriangle) << i;
  }
}

}  // namespace
}  // namespace gridiron::test
