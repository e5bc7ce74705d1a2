// Ray walks: secondary rays through a grid hit what testing every triangle finds, however many walks are
// under way, whenever transfers arrive; transfers that fail are reported.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/engine/grid/walk_driver.h>
#include <gridiron/store/local_store.h>

#include "core/build/grid/built_image.h"
#include "core/dma/test_platform.h"
#include "core/lane_types.h"
#include "numeric/hard_rays.h"
#include "numeric/oracle.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using Layout = EffectLayout256K<kAllEffects, 8>;
using Store = LocalStore<Layout>;
using Table = decltype(Store::EngineStore::table);

constexpr std::uint64_t kImage = 4096;
constexpr std::uint32_t kTraced = 0xFFFFFFFEu;  // an id that no walk gives

// A mesh, its image and the exact answers.
struct WalkScene {
  TestMesh mesh;
  LineBuffer image;
  SceneImageView view{};
  Accuracy accuracy;

  WalkScene(Accuracy wanted, float lambda, std::uint32_t macro_width) : accuracy(wanted) {
    mesh = make_sphere(9, 14, 0.5f);
    mesh.append(make_random_soup(150, 0.2f, 5));
    TestMesh again = make_random_soup(40, 0.2f, 5);  // ties: some triangles are there twice
    mesh.append(again);
    TestMesh box = make_box({-0.75f, -0.75f, -0.75f}, {0.75f, 0.75f, 0.75f});
    mesh.append(box);
    const bool is_compact = accuracy == Accuracy::kCompact;
    if (is_compact) mesh.snap();
    GridParameters parameters;
    parameters.lambda = lambda;
    parameters.macro_width = macro_width;
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
  [[nodiscard]] std::uint32_t macro_cells() const {
    return view.grid.macro_cell_count[0] * view.grid.macro_cell_count[1] * view.grid.macro_cell_count[2];
  }
  [[nodiscard]] bool table_fits() const { return macro_cells() <= 32 * Table::kEntryCount; }
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
  float t = 0.0f;
  friend bool operator==(const Answer&, const Answer&) = default;
};

// Hands rays out in jobs of 1..16 and takes the answers back.
struct RayJobs {
  const std::vector<OracleRay>& rays;
  std::vector<Answer> answers;
  std::uint32_t next_ray = 0, under_way = 0, most_under_way = 0;

  explicit RayJobs(const std::vector<OracleRay>& all) : rays(all), answers(all.size()) {}

  std::uint32_t next(WalkRays& job, std::uint32_t& purpose) {
    purpose = next_ray;
    const std::uint32_t wanted = next_ray % 5 == 0 ? 1 + next_ray % 16 : kWalkRays;
    const std::uint32_t count = std::min(wanted, static_cast<std::uint32_t>(rays.size()) - next_ray);
    for (std::uint32_t i = 0; i < count; ++i) {
      const OracleRay& ray = rays[next_ray + i];
      for (int axis = 0; axis < 3; ++axis) {
        job.origin[axis][i] = ray.origin[axis];
        job.dir[axis][i] = ray.direction[axis];
      }
      job.t[i] = ray.t_max;
      job.id[i] = kNoTriangle;
      job.owner[i] = next_ray + i;
    }
    next_ray += count;
    if (count != 0) most_under_way = std::max(most_under_way, ++under_way);
    return count;
  }
  void finish(const WalkRays& job, std::uint32_t count, std::uint32_t purpose) {
    --under_way;
    for (std::uint32_t i = 0; i < count; ++i) {
      EXPECT_EQ(job.owner[i], purpose + i);
      EXPECT_EQ(answers[job.owner[i]].id, kTraced) << "a ray is answered twice";
      answers[job.owner[i]] = {job.id[i], job.t[i]};
    }
  }
};

struct RunOptions {
  bool any_hit = false;
  std::uint32_t walks = 8, queue_depth = 16;
  Moves moves = Moves::kAtTheWait;
  std::optional<std::size_t> failing_command = std::nullopt;
};

struct Run {
  Status status = Status::kOk;
  std::vector<Answer> answers;
  WorkCounters work;
  std::string violation;
  std::size_t commands = 0, left_pending = 0;
  std::uint32_t most_under_way = 0;
};

void set_up(const WalkScene& scene, std::uint32_t walks, Store& store) {
  std::memset(static_cast<void*>(&store), 0xC3, sizeof(store));
  store.frame = {};
  store.work = {};
  store.frame.engine.grid = scene.view.grid;
  store.frame.accuracy = static_cast<std::uint32_t>(scene.accuracy);
  store.frame.walk_depth = walks;
  store.frame.engine.macro_table_address = kImage + scene.view.macro_table_offset_bytes;
  store.frame.engine.cell_blocks_address = kImage + scene.view.cell_blocks_offset_bytes;
  store.frame.engine.triangles_address = kImage + scene.view.triangles_offset_bytes;
  store.engine.table.forget();
  if (!scene.table_fits()) return;
  const std::uint32_t chunks = (scene.macro_cells() + 32 * Table::kChunkEntries - 1) / (32 * Table::kChunkEntries);
  std::memcpy(store.engine.table.entries, scene.image.bytes().data() + scene.view.macro_table_offset_bytes,
              std::size_t{chunks} * kLineBytes);
  for (std::uint32_t chunk = 0; chunk < chunks; ++chunk) store.engine.table.chunk_of_slot[chunk] = chunk;
}

Run finish_run(Store& store, TestPlatform& platform, const std::vector<OracleRay>& rays, const RayQuestion& question,
               auto walk_rays_through) {
  Run run;
  Transfers<TestPlatform> transfers(platform, store.work);
  RayJobs jobs(rays);
  run.status = walk_rays_through(transfers, question, jobs);
  run.answers = jobs.answers;
  run.work = store.work;
  run.violation = platform.violation();
  run.commands = platform.commands().size();
  run.left_pending = platform.pending();
  run.most_under_way = jobs.most_under_way;
  return run;
}

template <class L>
Run trace(const WalkScene& scene, const std::vector<OracleRay>& rays, const RunOptions& options) {
  TestPlatform platform(options.queue_depth, options.moves, kImage + scene.image.bytes().size() + 4096);
  std::memcpy(platform.at(kImage), scene.image.bytes().data(), scene.image.bytes().size());
  platform.failing_command = options.failing_command;
  const auto store = std::make_unique<Store>();
  set_up(scene, options.walks, *store);
  const RayQuestion question{options.any_hit, false, MainAddress{kImage + scene.view.effects.surfaces_offset_bytes}};
  const auto walk = [&](Transfers<TestPlatform>& transfers, const RayQuestion& asked, RayJobs& jobs) {
    return WalkDriver<L, Store, TestPlatform>(*store, transfers).run(asked, jobs);
  };
  Run run = finish_run(*store, platform, rays, question, walk);
  if (options.failing_command) {
    // What is still on its way can be waited for, and the same store then serves another run.
    EXPECT_EQ(platform.wait(TagMask{~0u}), Status::kOk);
    EXPECT_EQ(platform.pending(), 0u);
    platform.failing_command.reset();
    if (!scene.table_fits()) store->engine.table.forget();  // as every tile does
    const Run again = finish_run(*store, platform, rays, question, walk);
    EXPECT_EQ(again.status, Status::kOk);
    EXPECT_EQ(again.violation, "");
    run.answers = again.answers;
  }
  return run;
}

// Holds answers against the oracle's. @returns how many rays hit.
std::uint32_t expect_truth(const WalkScene& scene, const std::vector<OracleRay>& rays, bool any_hit,
                           const std::vector<Answer>& answers) {
  const Oracle oracle(scene.mesh.view(), {.reading = Reading::kStandard});
  std::uint32_t hit_count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const NearestHit nearest = oracle.nearest(rays[i]);
    const bool hits = !nearest.ties.empty();
    hit_count += hits ? 1u : 0u;
    if (!hits) {
      EXPECT_EQ(answers[i].id, kNoTriangle) << "ray " << i;
      EXPECT_EQ(answers[i].t, rays[i].t_max) << "ray " << i;
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
class RayWalksTest : public testing::Test {};
TYPED_TEST_SUITE(RayWalksTest, LaneTypes, LaneNames);

TYPED_TEST(RayWalksTest, AnswerAsTheOracleDoes) {
  for (const Accuracy accuracy : {Accuracy::kStandard, Accuracy::kExact, Accuracy::kCompact}) {
    for (const bool any_hit : {false, true}) {
      // Few large cells, whose triangles take several buffers, or many small ones.
      const bool has_long_runs = any_hit != (accuracy == Accuracy::kExact);
      const WalkScene scene(accuracy, has_long_runs ? 0.05f : 4.0f, has_long_runs ? 2 : 3);
      ASSERT_TRUE(scene.table_fits());
      const std::vector<OracleRay> rays = random_rays(scene.mesh, 1200, 40 + static_cast<std::uint64_t>(accuracy));
      const Run run = trace<TypeParam>(scene, rays, {.any_hit = any_hit});
      ASSERT_EQ(run.status, Status::kOk);
      EXPECT_EQ(run.violation, "");
      EXPECT_EQ(run.left_pending, 0u);
      const std::uint32_t hits = expect_truth(scene, rays, any_hit, run.answers);
      EXPECT_GT(hits, 500u);
      EXPECT_LT(hits, 1190u);
      if (has_long_runs) {
        EXPECT_GT(run.work[GridWork::kTriangleBatch], run.work[GridWork::kCellVisit] + 100u)
            << "no cell takes two buffers";
      }
    }
  }
}

TYPED_TEST(RayWalksTest, WalksAndTransfersChangeNothing) {
  for (const bool any_hit : {false, true}) {
    const WalkScene scene(Accuracy::kStandard, 4.0f, 4);
    const std::vector<OracleRay> rays = random_rays(scene.mesh, 300, 8);
    const Run first = trace<Lanes<4>>(scene, rays, {.any_hit = any_hit, .walks = 1, .moves = Moves::kAtOnce});
    ASSERT_EQ(first.status, Status::kOk);
    EXPECT_EQ(first.most_under_way, 1u);
    for (std::uint32_t walks = 1; walks <= kWalkCount<Layout>; ++walks) {
      for (const std::uint32_t queue_depth : {1u, 3u, 16u}) {
        const Run run = trace<TypeParam>(scene, rays, {.any_hit = any_hit, .walks = walks, .queue_depth = queue_depth});
        ASSERT_EQ(run.status, Status::kOk);
        EXPECT_EQ(run.violation, "") << walks << " walks, queue of " << queue_depth;
        EXPECT_EQ(run.left_pending, 0u);
        EXPECT_EQ(run.most_under_way, walks);
        EXPECT_TRUE(run.answers == first.answers) << walks << " walks, queue of " << queue_depth;
        for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) {
          const WorkId work(kind);
          // A full queue is waited for, and a transfer may take two commands; groups are as wide as the lanes.
          if (work == Work::kWait && queue_depth < 2 * walks) continue;
          if ((work == GridWork::kShaftGroup || work == Work::kRayGroupTest) && TypeParam::kCount != 4) continue;
          EXPECT_EQ(run.work.counts[kind], first.work.counts[kind]) << "kind " << kind << ", " << walks << " walks";
        }
      }
    }
  }
}

TYPED_TEST(RayWalksTest, TablesLargerThanTheStore) {
  const WalkScene scene(Accuracy::kStandard, 300.0f, 1);
  ASSERT_FALSE(scene.table_fits());
  const std::vector<OracleRay> rays = random_rays(scene.mesh, 300, 9);
  for (const bool any_hit : {false, true}) {
    const Run run = trace<TypeParam>(scene, rays, {.any_hit = any_hit});
    ASSERT_EQ(run.status, Status::kOk);
    EXPECT_EQ(run.violation, "");
    EXPECT_GT(expect_truth(scene, rays, any_hit, run.answers), 100u);
    for (const std::uint32_t walks : {1u, 3u}) {
      const Run other = trace<TypeParam>(scene, rays, {.any_hit = any_hit, .walks = walks, .queue_depth = walks});
      ASSERT_EQ(other.status, Status::kOk);
      EXPECT_EQ(other.violation, "");
      EXPECT_TRUE(other.answers == run.answers) << walks;
    }
  }
}

// Every so many commands one fails.
TYPED_TEST(RayWalksTest, FailuresAreReported) {
  for (const bool is_large : {false, true}) {
    const WalkScene scene(is_large ? Accuracy::kStandard : Accuracy::kExact, is_large ? 300.0f : 2.0f,
                          is_large ? 1 : 4);
    const std::vector<OracleRay> rays = random_rays(scene.mesh, 40, 10);
    const RunOptions good{.walks = 3, .queue_depth = 2};
    const Run whole = trace<TypeParam>(scene, rays, good);
    ASSERT_EQ(whole.status, Status::kOk);
    ASSERT_GT(whole.commands, 200u);
    const std::size_t step = is_large ? whole.commands / 20 + 1 : whole.commands / 150 + 1;
    for (std::size_t i = TypeParam::kCount % step; i < whole.commands; i += step) {
      RunOptions options = good;
      options.failing_command = i;
      const Run run = trace<TypeParam>(scene, rays, options);
      ASSERT_EQ(run.status, Status::kTransferFailed) << "command " << i;
      EXPECT_EQ(run.commands, i + 1) << "goes on after a failure";
      EXPECT_EQ(run.violation, "");
      EXPECT_TRUE(run.answers == whole.answers) << "command " << i;
    }
  }
}

TYPED_TEST(RayWalksTest, NoJobsNoTransfers) {
  const WalkScene scene(Accuracy::kStandard, 4.0f, 4);
  const Run none = trace<TypeParam>(scene, {}, {});
  EXPECT_EQ(none.status, Status::kOk);
  EXPECT_EQ(none.commands, 0u);
  // Rays without a direction, of no numbers, or past the grid: answered, without a transfer.
  std::vector<OracleRay> rays(20);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i] = {{5, 5, 5}, {1, 0, 0}};
    if (i % 3 == 0) rays[i].direction[0] = 0.0f;
    if (i % 3 == 1) rays[i].direction[1] = std::numeric_limits<float>::quiet_NaN();
  }
  const Run past = trace<TypeParam>(scene, rays, {});
  EXPECT_EQ(past.status, Status::kOk);
  EXPECT_EQ(past.commands, 0u);
  for (const Answer& answer : past.answers) EXPECT_EQ(answer, (Answer{kNoTriangle, kFloatMax}));
}

}  // namespace
}  // namespace gridiron::test
