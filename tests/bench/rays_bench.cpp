// Secondary rays, in lists through the wide tree, against all of Embree's calls. Both sides read the same rays from
// memory, each in the layout that suits it, with origin, direction and t alone; what follows from these is timed.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/tree/tree_builder.h>

#include <cmath>

#include "bench/bench.h"
#include "bench/ray_sets.h"
#include "bench/tree_lists.h"
#include "core/build/grid/line_buffer.h"
#include "support/ply_load.h"
#include "support/views.h"

namespace gridiron::bench {
namespace {

constexpr double kMeanLimit = 1.3;   // of each kind, geometric mean of our rate over the best one of Embree
constexpr double kLeastLimit = 0.8;  // of each scene and kind
constexpr std::size_t kRays = 131072;
constexpr std::size_t kFinalists = 3, kRobustFinalists = 2;

// --- Scenes -------------------------------------------------------------------------------------------------------

// A view, and where its light is: shares of the box of the scene's triangles. Nothing: outside, above the eye's left.
struct LitView {
  test::SceneView view;
  std::optional<Vec3> light;
};

const LitView kViews[] = {
    {test::kBunnyView, {}},
    {test::kHorseView, {}},
    {test::kArmadilloView, {}},
    {test::kConferenceView, Vec3(0.5f, 0.8f, 0.5f)},
    {test::kSponzaView, Vec3(0.5f, 0.8f, 0.5f)},
    {test::kDragonView, {}},
    // The teapot from near by, behind it the field and the stands.
    {{"stadium", "teapot_in_stadium.ply", Camera{{3.13f, 1.72f, 0.18f}, {3.0f, 2.0f, 0.07f}, {0, 0, 1}, 0.41421356f}},
     Vec3(0.3f, 0.3f, 0.9f)},
};

struct Box {
  DVec3 low, high;

  [[nodiscard]] double diagonal() const {
    const DVec3 extent = high - low;
    return std::sqrt(extent.x * extent.x + extent.y * extent.y + extent.z * extent.z);
  }
};

Vec3 light_of(const LitView& view, const Box& box) {
  if (view.light) return Vec3(box.low + DVec3(*view.light) * (box.high - box.low));
  return Vec3((box.low + box.high) * 0.5 + DVec3(-0.7, 1.3, 0.8) * box.diagonal());
}

// --- Our side -----------------------------------------------------------------------------------------------------

struct Build {
  const char* name;
  std::uint32_t leaf_triangles;
  TraceLists* trace;
};

// From the narrowest to the widest, those that this host can run.
std::vector<Build> builds_of_host() {
  std::vector<Build> builds = {{"4", 8, gridiron_bench_trace_lanes4}};
#if defined(GRIDIRON_BENCH_WIDE_LANES)
  const auto add_where = [&](bool is_there, const Build& build) {
    if (is_there) builds.push_back(build);
  };
  const bool has_avx2 = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0 &&
                        __builtin_cpu_supports("bmi") != 0 && __builtin_cpu_supports("bmi2") != 0;
  const bool has_avx512 = has_avx2 && __builtin_cpu_supports("avx512f") != 0 &&
                          __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
                          __builtin_cpu_supports("avx512vl") != 0;
  add_where(has_avx2, {"8", 8, gridiron_bench_trace_lanes8});
  add_where(has_avx512, {"16", 16, gridiron_bench_trace_lanes16});
#endif
  return builds;
}

// A tree that owns its arrays.
class OwnedTree {
 public:
  OwnedTree(const MeshView& mesh, std::uint32_t leaf_triangles)
      : records_(mesh.triangles.size() * sizeof(VertexTriangle)),
        nodes_(most_tree_nodes(mesh.triangles.size(), leaf_triangles) * sizeof(TreeNode)) {
    const std::size_t count = mesh.triangles.size();
    test::LineBuffer scratch(tree_scratch_bytes(count));
    const std::span records(reinterpret_cast<VertexTriangle*>(records_.bytes().data()), count);
    const std::span nodes(reinterpret_cast<TreeNode*>(nodes_.bytes().data()), most_tree_nodes(count, leaf_triangles));
    status_ = build_tree(mesh, leaf_triangles, records, nodes, scratch.bytes(), size_);
    float largest = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      largest = std::max({largest, std::fabs(size_.low[axis]), std::fabs(size_.high[axis])});
    }
    if (status_ == Status::kOk) tree_ = {nodes.first(size_.node_count), records.first(size_.triangle_count), largest};
  }

  [[nodiscard]] Status status() const { return status_; }
  [[nodiscard]] const ListTree& tree() const { return tree_; }
  [[nodiscard]] Box box() const {
    return {DVec3(size_.low[0], size_.low[1], size_.low[2]), DVec3(size_.high[0], size_.high[1], size_.high[2])};
  }

 private:
  test::LineBuffer records_, nodes_;
  TreeSize size_{};
  Status status_;
  ListTree tree_;
};

std::vector<MemoryRay> memory_rays(std::span<const peer::PeerRay> rays) {
  std::vector<MemoryRay> copies;
  for (const peer::PeerRay& ray : rays) {
    copies.push_back({{ray.origin[0], ray.origin[1], ray.origin[2]},
                      ray.t,
                      {ray.dir[0], ray.dir[1], ray.dir[2]},
                      kNoTriangle});
  }
  return copies;
}

// --- Embree -------------------------------------------------------------------------------------------------------

constexpr peer::EmbreeQuality kQualities[] = {peer::EmbreeQuality::kLow, peer::EmbreeQuality::kMedium,
                                              peer::EmbreeQuality::kHigh};
constexpr const char* kQualityNames[] = {"low", "medium", "high"};
constexpr peer::EmbreeCall kCalls[] = {peer::EmbreeCall::kSingle, peer::EmbreeCall::kPacket16,
                                       peer::EmbreeCall::kStream};
constexpr const char* kCallNames[] = {"1", "16", "1M"};

// One scene for each quality.
class EmbreeScenes {
 public:
  EmbreeScenes(const MeshView& mesh, bool robust)
      : low_(mesh, robust, peer::EmbreeQuality::kLow),
        medium_(mesh, robust, peer::EmbreeQuality::kMedium),
        high_(mesh, robust, peer::EmbreeQuality::kHigh) {}

  [[nodiscard]] const peer::EmbreeRays& of(peer::EmbreeQuality quality) const {
    if (quality == peer::EmbreeQuality::kLow) return low_;
    return quality == peer::EmbreeQuality::kMedium ? medium_ : high_;
  }

 private:
  peer::EmbreeRays low_, medium_, high_;
};

// One way to ask Embree.
struct Way {
  std::string name;
  const peer::EmbreeRays* scene;
  std::size_t call;
  bool is_coherent;
};

// The flag makes no difference to single rays.
std::vector<Way> ways_of(const EmbreeScenes& scenes) {
  std::vector<Way> ways;
  for (const peer::EmbreeQuality quality : kQualities) {
    for (std::size_t call = 0; call < std::size(kCalls); ++call) {
      for (const bool is_coherent : {false, true}) {
        if (is_coherent && kCalls[call] == peer::EmbreeCall::kSingle) continue;
        ways.push_back({std::string(kCallNames[call]) + " " + kQualityNames[static_cast<std::size_t>(quality)] +
                            (is_coherent ? " coherent" : ""),
                        &scenes.of(quality), call, is_coherent});
      }
    }
  }
  return ways;
}

// --- Rays of one kind ---------------------------------------------------------------------------------------------

// The same rays in the layouts of all sides, and the ways to answer them.
class RaySet {
 public:
  RaySet(const std::vector<peer::PeerRay>& rays, bool any_hit, bool are_neighbors, std::uint32_t batch_rays)
      : rays_(rays),
        any_hit_(any_hit),
        are_neighbors_(are_neighbors),
        batch_rays_(batch_rays),
        ours_(memory_rays(rays)),
        answers_(rays.size() / kGroupRays) {
    for (const peer::EmbreeCall call : kCalls) batches_.emplace_back(call, any_hit);
  }

  [[nodiscard]] Candidate ours(const Build& build, const ListTree& tree) {
    return {build.name,
            [this, &build, &tree] { build.trace(tree, ours_, answers_, batch_rays_, any_hit_, are_neighbors_); }};
  }
  // Embree writes into its rays, so they are written anew for each round.
  [[nodiscard]] Candidate embree(const Way& way) {
    return {way.name, [this, &way] { way.scene->trace(batches_[way.call], batch_rays_, way.is_coherent); },
            [this, &way] { batches_[way.call].fill(rays_); }};
  }

  // Rays that the last run of ours answers in another way than single rays of Embree: in whether they hit, and in where
  // by more than a thousandth of t.
  struct Differences {
    std::size_t hit = 0, t = 0;
  };
  [[nodiscard]] Differences differences(const peer::EmbreeRays& scene) {
    peer::EmbreeRayBatch& batch = batches_[0];
    batch.fill(rays_);
    scene.trace(batch, batch_rays_, false);
    Differences result;
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (is_hit(i) != batch.is_hit(i)) {
        ++result.hit;
      } else if (!any_hit_ && is_hit(i)) {
        const float t = answers_[i / kGroupRays].t[i % kGroupRays];
        result.t += std::fabs(t - batch.t(i)) > 1e-3f * batch.t(i) ? 1u : 0u;
      }
    }
    return result;
  }
  [[nodiscard]] std::size_t hit_count() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < rays_.size(); ++i) count += is_hit(i) ? 1u : 0u;
    return count;
  }

 private:
  [[nodiscard]] bool is_hit(std::size_t ray) const {
    const AnswerGroup& group = answers_[ray / kGroupRays];
    return any_hit_ ? (group.hits >> ray % kGroupRays & 1u) != 0 : group.id[ray % kGroupRays] != kNoTriangle;
  }

  const std::vector<peer::PeerRay>& rays_;
  bool any_hit_, are_neighbors_;
  std::uint32_t batch_rays_;
  std::vector<MemoryRay> ours_;
  std::vector<AnswerGroup> answers_;
  std::vector<peer::EmbreeRayBatch> batches_;
};

// The fastest of all ways, each run twice.
std::vector<Way> finalists(RaySet& set, std::vector<Way> ways, std::size_t count) {
  std::vector<Candidate> candidates;
  for (const Way& way : ways) candidates.push_back(set.embree(way));
  const std::vector<double> seconds = least_seconds(candidates, 1);
  std::vector<std::size_t> order(ways.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return seconds[a] < seconds[b]; });
  std::vector<Way> fastest;
  for (std::size_t i = 0; i < count; ++i) fastest.push_back(ways[order[i]]);
  return fastest;
}

// --- Results ------------------------------------------------------------------------------------------------------

// What a scene and a kind gave.
struct Row {
  std::string scene;
  RayKind kind;
  std::vector<double> ratios;  // of each build to the best of Embree
};

void print_head(const std::vector<Build>& builds) {
  std::printf("%-17s %-14s %7s %5s |", "millions a second", "rays", "traced", "hit");
  for (const Build& build : builds) std::printf(" %8s", build.name);
  std::printf(" | %6s %-18s %6s %-18s |", "Embree", "best of", "robust", "best of");
  for (const Build& build : builds) std::printf(" %8s", build.name);
  std::printf(" | differ from Embree, robust\n");
}

Row bench_kind(const BenchOptions& options, const std::string& scene, RayKind kind,
               const std::vector<peer::PeerRay>& rays, const std::vector<Build>& builds,
               const std::vector<const ListTree*>& trees, const EmbreeScenes& fast, const EmbreeScenes& robust) {
  RaySet set(rays, wants_any_hit(kind), are_neighbors(kind), options.batch_rays);
  std::vector<Way> ways = finalists(set, ways_of(fast), kFinalists);
  const std::vector<Way> robust_ways = finalists(set, ways_of(robust), kRobustFinalists);
  ways.insert(ways.end(), robust_ways.begin(), robust_ways.end());

  std::vector<Candidate> candidates;
  for (const Way& way : ways) candidates.push_back(set.embree(way));
  for (std::size_t i = 0; i < builds.size(); ++i) candidates.push_back(set.ours(builds[i], *trees[i]));
  const std::vector<double> seconds = least_seconds(candidates, options.rounds);
  const auto best =
      static_cast<std::size_t>(std::min_element(seconds.begin(), seconds.begin() + kFinalists) - seconds.begin());
  const auto best_robust = static_cast<std::size_t>(
      std::min_element(seconds.begin() + kFinalists, seconds.begin() + kFinalists + kRobustFinalists) -
      seconds.begin());

  const auto rate = [&](std::size_t i) { return 1e-6 * static_cast<double>(rays.size()) / seconds[i]; };
  const RaySet::Differences from_fast = set.differences(fast.of(peer::EmbreeQuality::kMedium));
  const RaySet::Differences from_robust = set.differences(robust.of(peer::EmbreeQuality::kMedium));
  Row row{scene, kind, {}};
  std::printf("%-17s %-14s %7zu %4.0f%% |", scene.c_str(), name_of(kind), rays.size(),
              100.0 * static_cast<double>(set.hit_count()) / static_cast<double>(rays.size()));
  for (std::size_t i = 0; i < builds.size(); ++i) std::printf(" %8.2f", rate(ways.size() + i));
  std::printf(" | %6.2f %-18s %6.2f %-18s |", rate(best), ways[best].name.c_str(), rate(best_robust),
              ways[best_robust].name.c_str());
  for (std::size_t i = 0; i < builds.size(); ++i) {
    row.ratios.push_back(seconds[best] / seconds[ways.size() + i]);
    std::printf(" %8.2f", row.ratios.back());
  }
  std::printf(" | %zu hit %zu t, %zu hit %zu t\n", from_fast.hit, from_fast.t, from_robust.hit, from_robust.t);
  std::fflush(stdout);
  return row;
}

bool bench_view(const BenchOptions& options, const LitView& lit, const std::vector<Build>& builds,
                std::vector<Row>& rows) {
  const test::SceneView& view = lit.view;
  const auto mesh = test::load_ply(options.scenes / view.file);
  if (!mesh) {
    std::printf("%s: %s cannot be read; left out\n", view.name, (options.scenes / view.file).c_str());
    return true;
  }
  std::vector<std::unique_ptr<OwnedTree>> owned;
  std::vector<const ListTree*> trees;
  for (const Build& build : builds) {
    owned.push_back(std::make_unique<OwnedTree>(mesh->view(), build.leaf_triangles));
    trees.push_back(&owned.back()->tree());
    if (owned.back()->status() != Status::kOk) {
      std::printf("%s: status %u\n", view.name, static_cast<unsigned>(owned.back()->status()));
      return false;
    }
  }
  const EmbreeScenes fast(mesh->view(), false), robust(mesh->view(), true);
  const Box box = owned.front()->box();
  const Camera camera = view.camera ? *view.camera : test::framed_camera(mesh->view());
  const std::vector<HitPoint> points =
      find_hit_points(mesh->view(), camera, box.diagonal(), robust.of(peer::EmbreeQuality::kMedium));
  for (const RayKind kind : kRayKinds) {
    const std::size_t most_batches = std::max<std::size_t>(1, kRays / options.batch_rays);
    const std::vector<peer::PeerRay> rays =
        make_rays(kind, points, box.diagonal(), light_of(lit, box), options.batch_rays, most_batches);
    if (rays.empty()) {
      std::printf("%s: no %s rays; left out\n", view.name, name_of(kind));
      continue;
    }
    rows.push_back(bench_kind(options, view.name, kind, rays, builds, trees, fast, robust));
  }
  return true;
}

// The limits are those of the widest lanes.
bool report(const std::vector<Build>& builds, const std::vector<Row>& rows) {
  bool within = true;
  const auto check = [&](double ratio, double limit) {
    within = within && ratio >= limit;
    return ratio >= limit ? "" : "  BELOW";
  };
  std::printf("ratios to the best of Embree, by lanes:");
  for (const Build& build : builds) std::printf(" %8s", build.name);
  std::printf("\n");
  for (const RayKind kind : kRayKinds) {
    std::vector<double> sums(builds.size());
    std::size_t count = 0;
    for (const Row& row : rows) {
      if (row.kind != kind) continue;
      ++count;
      for (std::size_t i = 0; i < builds.size(); ++i) sums[i] += std::log(row.ratios[i]);
    }
    if (count == 0) continue;
    std::printf("  %-15s geometric mean of %zu:   ", name_of(kind), count);
    for (const double sum : sums) std::printf(" %8.2f", std::exp(sum / static_cast<double>(count)));
    std::printf("  (limit %.2f)%s\n", kMeanLimit,
                check(std::exp(sums.back() / static_cast<double>(count)), kMeanLimit));
  }
  const auto least = std::min_element(rows.begin(), rows.end(),
                                      [](const Row& a, const Row& b) { return a.ratios.back() < b.ratios.back(); });
  if (least != rows.end()) {
    std::printf("  least: %s %s %.2f with %s lanes  (limit %.2f)%s\n", least->scene.c_str(), name_of(least->kind),
                least->ratios.back(), builds.back().name, kLeastLimit, check(least->ratios.back(), kLeastLimit));
  }
  return within;
}

bool bench_rays(const BenchOptions& options) {
  if (options.scenes.empty()) {
    std::printf("GRIDIRON_SCENES is not set; left out\n");
    return true;
  }
  const std::vector<Build> builds = builds_of_host();
  std::printf("batches of %u rays, one thread; ours by number of lanes\n", options.batch_rays);
  print_head(builds);
  std::vector<Row> rows;
  bool all_built = true;
  for (const LitView& view : kViews) all_built = bench_view(options, view, builds, rows) && all_built;
  return report(builds, rows) && all_built;
}

const Registration kRegistration("rays", bench_rays);

}  // namespace
}  // namespace gridiron::bench
