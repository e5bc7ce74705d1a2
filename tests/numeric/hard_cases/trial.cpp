// Trials: see the header. SPDX-License-Identifier: Apache-2.0
#include "numeric/hard_cases/trial.h"

#include <gridiron/build/triangle_records.h>

#include "numeric/hard_cases/judge.h"
#include "numeric/rounding_scope.h"

namespace gridiron::test::hard {
namespace {

constexpr IntersectorWay kIntersectorWays[] = {{4, 8, IntersectorWay::Order::kAscending},
                                               {8, 32, IntersectorWay::Order::kDescending},
                                               {16, 16, IntersectorWay::Order::kShuffled}};

// With few rays every way is tried with each of them, else one after the other.
constexpr std::size_t kFewRays = 6;

std::string words_of(const IntersectorWay& way) {
  constexpr const char* kOrders[] = {"ascending", "descending", "shuffled"};
  return "intersector, " + std::to_string(way.lanes) + " lanes, packet " + std::to_string(way.packet_width) + ", " +
         kOrders[static_cast<int>(way.order)];
}

std::string words_of(const PipelineWay& way) {
  return std::string("pipeline") + (way.mode == sim::Mode::kChecked ? ", checked" : "") +
         (way.store == sim::StoreSize::k64KB ? ", 64 KB" : ", 256 KB") + ", packet " +
         std::to_string(way.packet_width) + ", " + std::to_string(way.lanes) + " lanes" +
         (way.wants_distances ? "" : ", no distances") + ", techniques " + std::to_string(way.techniques);
}

void shoot_by_intersector(Judge& judge, const Target& target, const Rays& rays, std::size_t index, bool all_ways) {
  if (!target.profile().is_exact) {
    // What single precision decides may depend on the order of triangles and on the packet, but not on the lanes.
    const std::vector<Answer> first = target.by_intersector(rays, kIntersectorWays[0]);
    judge.check(rays, first, {}, Judge::Form::kDistance, words_of(kIntersectorWays[0]));
    const IntersectorWay wide{index % 2 == 0 ? 16u : 8u, 8, IntersectorWay::Order::kAscending};
    EXPECT_TRUE(target.by_intersector(rays, wide) == first) << target.profile().name << ", " << words_of(wide);
    return;
  }
  for (std::size_t i = 0; i < std::size(kIntersectorWays); ++i) {
    if (!all_ways && i != index % std::size(kIntersectorWays)) continue;
    const IntersectorWay& way = kIntersectorWays[i];
    judge.check(rays, target.by_intersector(rays, way), {}, Judge::Form::kDistance, words_of(way));
  }
}

bool is_usable(const PipelineWay& way, const GridRecord& grid) {
  return way.store != sim::StoreSize::k64KB || grid.macro_width <= 6;
}

void shoot_by_pipeline(Judge& judge, Target& target, const Rays& rays, std::size_t index, bool all_ways) {
  const std::span<const PipelineWay> ways = pipeline_ways();
  const bool is_exact = target.profile().is_exact;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const PipelineWay& way = ways[i];
    if (!is_usable(way, target.grid())) continue;
    const Judge::Form form = way.wants_distances ? Judge::Form::kDepth : Judge::Form::kTriangle;
    if (rays.columns != 0) {
      const std::size_t turn = (i + index) % ways.size();
      if (!all_ways && turn >= (is_exact ? 3u : 1u)) continue;
      judge.check(rays, target.by_pipeline(rays, way), {}, form, words_of(way));
      continue;
    }
    // One ray after the other goes the next way; where only C is promised, every third of them.
    std::vector<std::size_t> only;
    for (std::size_t ray = 0; ray < rays.directions.size(); ++ray) {
      const bool is_left_out = !is_exact && !all_ways && (ray + index) % 3 != 0;
      if ((ray + index) / (is_exact ? 1 : 3) % ways.size() == i && !is_left_out) only.push_back(ray);
    }
    if (only.empty()) continue;
    judge.check(rays, target.by_pipeline(rays, way, only), only, form, words_of(way));
  }
}

// The rays as a frame has them: rounded, and flushed, as it computes their directions.
Rays as_in_frame(const Rays& rays, const Trial& trial) {
  const RoundingScope scope(trial.rounding, trial.flush);
  Rays computed = rays;
  if (rays.columns != 0) {
    recompute_picture(computed);
    return computed;
  }
  for (std::size_t i = 0; i < rays.directions.size(); ++i) {
    computed.directions[i] = picture(rays.origin, rays.directions[i], Vec3(0.0f), Vec3(0.0f), 1, 1).directions[0];
  }
  return computed;
}

bool has_same_directions(const Rays& a, const Rays& b) {
  return std::memcmp(a.directions.data(), b.directions.data(), a.directions.size() * sizeof(Vec3)) == 0;
}

std::vector<NearestHit> ask(const Oracle& oracle, const Rays& rays) {
  std::vector<OracleRay> asked;
  for (std::size_t i = 0; i < rays.directions.size(); ++i) asked.push_back(oracle_ray(rays, i));
  return oracle.nearest(asked, 1);
}

void append_to_table(const Trial& trial, const Tally& tally, const std::vector<std::string>& shares) {
  const char* path = std::getenv("GRIDIRON_HARD_CASES_TABLE");
  if (path == nullptr) return;
  const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
  std::ofstream table(path, std::ios::app);
  table << test.test_suite_name() << '.' << test.name() << ' ' << "ABCD"[static_cast<int>(trial.grade)] << ' '
        << tally.rays << ' ' << tally.hits << ' ' << tally.ties << ' ' << tally.traced << ' ' << tally.frames;
  for (const std::string& share : shares) table << ' ' << share;
  table << '\n';
}

}  // namespace

bool operator==(const Answer& a, const Answer& b) {
  return a.id == b.id && std::bit_cast<std::uint32_t>(a.t) == std::bit_cast<std::uint32_t>(b.t);
}

Rays picture(Vec3 origin, Vec3 corner, Vec3 step_x, Vec3 step_y, std::uint32_t columns, std::uint32_t rows) {
  Rays rays{origin, std::vector<Vec3>(std::size_t{columns} * rows), kFloatMax, columns, corner, step_x, step_y};
  recompute_picture(rays);
  return rays;
}

void recompute_picture(Rays& rays) {
  for (std::size_t i = 0; rays.columns != 0 && i < rays.directions.size(); ++i) {
    const auto x = static_cast<float>(i % rays.columns), y = static_cast<float>(i / rays.columns);
    rays.directions[i] = (rays.corner + x * rays.step_x) + y * rays.step_y;
  }
}

OracleRay oracle_ray(const Rays& rays, std::size_t i) {
  const Vec3& o = rays.origin;
  const Vec3& d = rays.directions[i];
  OracleRay ray{{o.x, o.y, o.z}, {d.x, d.y, d.z}};
  ray.t_max = rays.t_far;
  return ray;
}

std::uint32_t times(std::uint32_t count) {
  const char* factor = std::getenv("GRIDIRON_HARD_CASES_FACTOR");
  return factor != nullptr ? count * static_cast<std::uint32_t>(std::strtoul(factor, nullptr, 10)) : count;
}

Tally& Tally::operator+=(const Tally& other) {
  rays += other.rays;
  hits += other.hits;
  ties += other.ties;
  traced += other.traced;
  frames += other.frames;
  return *this;
}

Tally shoot(const Trial& trial) {
  Tally tally;
  std::vector<std::string> shares;
  const TestMesh* truth_mesh = nullptr;
  std::vector<Rays> all_rays;
  std::vector<std::vector<NearestHit>> truths, frame_truths;
  TestMesh last_mesh;
  for (const Profile& profile : kProfiles) {
    std::optional<Target> built;
    {
      const RoundingScope scope(trial.rounding, trial.flush && trial.flush_builder);
      built.emplace(trial.mesh, trial.grid, profile);
    }
    Target& target = *built;
    if (target.status() == Status::kNoTriangles && &profile != kProfiles) continue;  // rounding left no area
    EXPECT_EQ(target.status(), Status::kOk) << profile.name;
    if (target.status() != Status::kOk) return tally;
    const TestMesh& mesh = target.mesh();
    if (truth_mesh == nullptr || mesh.vertices != last_mesh.vertices) {
      last_mesh = mesh;
      truth_mesh = &last_mesh;
      all_rays = trial.aim(mesh);
      const Oracle oracle(mesh.view(), {.reading = Reading::kStandard});
      truths.clear();
      frame_truths.clear();
      for (Rays& rays : all_rays) {
        const Rays in_frame = as_in_frame(rays, trial);
        if (rays.columns != 0) rays = in_frame;
        truths.push_back(ask(oracle, rays));
        frame_truths.push_back(has_same_directions(rays, in_frame) ? truths.back() : ask(oracle, in_frame));
      }
    }
    Judge judge(target, trial.grade);
    const bool all_ways = all_rays.size() < kFewRays;
    for (std::size_t i = 0; i < all_rays.size(); ++i) {
      {
        const RoundingScope scope(trial.rounding, trial.flush);
        judge.set_truth(truths[i]);
        shoot_by_intersector(judge, target, all_rays[i], i, all_ways);
      }
      const RoundingScope scope(trial.rounding, trial.flush);
      judge.set_truth(frame_truths[i]);
      shoot_by_pipeline(judge, target, all_rays[i], i, all_ways);
    }
    EXPECT_EQ(judge.failures(), 0u) << profile.name;
    tally.traced += judge.checked();
    tally.frames += target.frames();
    if (!profile.is_exact) {
      std::ostringstream share;
      share << profile.name << '=' << judge.differing() << '/' << judge.checked() << '/' << judge.largest_error();
      shares.push_back(share.str());
    }
    if (&profile != kProfiles) continue;
    for (std::size_t i = 0; i < truths.size(); ++i) {
      tally.rays += truths[i].size();
      for (const NearestHit& truth : truths[i]) {
        tally.hits += truth.float_ties.empty() ? 0u : 1u;
        tally.ties += truth.float_ties.size() > 1 ? 1u : 0u;
      }
    }
  }
  append_to_table(trial, tally, shares);
  return tally;
}

}  // namespace gridiron::test::hard
