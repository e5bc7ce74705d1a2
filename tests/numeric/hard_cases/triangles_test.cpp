// Degenerate triangles: slivers, needles, no area, many in one place, a float apart.
// SPDX-License-Identifier: Apache-2.0
#include "numeric/hard_cases/shapes.h"
#include "numeric/hard_cases/trial.h"

namespace gridiron::test::hard {
namespace {

// Every triangle split by one of 1 : 10^2 to 1 : 10^8, some of them turned round by rounding; and a fan of open ones.
TEST(HardCase05, Slivers) {
  Tally tally;
  for (int exponent = 2; exponent <= 8; ++exponent) {
    const float width = std::pow(10.0f, static_cast<float>(-exponent));
    SCOPED_TRACE(width);
    const TestMesh mesh = split_by_slivers(make_sphere(6, 8, 1.0f), width, static_cast<std::uint64_t>(exponent));
    ASSERT_TRUE(is_closed(mesh));
    tally += shoot(
        {.mesh = mesh, .grade = Grade::kClosed, .aim = salvo_at(Vec3(0.0f), 0.4f, {kFeatures, times(4), 24, 1}, 5)});
  }
  EXPECT_EQ(tally.hits, tally.rays);
  const Tally fan = shoot(
      {.mesh = make_sliver_fan(300, 1e-5f), .aim = salvo_at(Vec3(0, 0, 1), 0.5f, {kFeatures, times(4), 24, 1}, 6)});
  EXPECT_GT(fan.hits, fan.rays / 8);
}

TEST(HardCase06, NeedlesOfOneFloat) {
  Tally tally;
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.name);
    const TestMesh mesh = split_by_needles(solid.mesh, 6);
    ASSERT_TRUE(is_closed(mesh));
    tally += shoot({.mesh = mesh,
                    .grade = Grade::kClosed,
                    .aim = salvo_at(solid.middle, solid.room, {kFeatures, times(4), 24, 1}, 6)});
  }
  EXPECT_EQ(tally.hits, tally.rays);
  EXPECT_GT(tally.ties, 300u);
}

// Triangles of no area along the edges, in front of the others, and in the place of gaps at T-junctions.
TEST(HardCase07, NoArea) {
  Tally tally;
  for (const TestMesh& whole :
       {on_lattice(make_sphere(8, 12, 1.0f), 0x1p-5f), on_lattice(make_torus(10, 8, 1.0f, 0.5f), 0x1p-5f)}) {
    TestMesh mesh;
    mesh.vertices = whole.vertices;
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const float k : {1.0f, 2.0f, 4.0f}) mesh.vertices.push_back(k * Vec3(0.03125f, -0.0625f, 0.09375f));
    for (const UVec3& t : whole.triangles) {
      mesh.triangles.push_back({t.x, t.x, t.y});
      mesh.triangles.push_back({t.z, t.z, t.z});
    }
    mesh.triangles.push_back({base, base + 1, base + 2});
    mesh.triangles.push_back({base + 2, base + 1, base});
    const std::size_t none = mesh.triangles.size();
    const TestMesh cut = cut_edges(whole);
    mesh.vertices.insert(mesh.vertices.end(), cut.vertices.begin() + base, cut.vertices.end());
    for (UVec3 t : cut.triangles) {
      for (int corner = 0; corner < 3; ++corner) {
        if (t[corner] >= whole.vertices.size()) t[corner] += 3;
      }
      mesh.triangles.push_back(t);
    }
    ASSERT_TRUE(is_closed(mesh));
    const Target target(mesh, {}, kProfiles[0]);
    EXPECT_EQ(target.need().dropped_triangle_count, none + whole.triangles.size());
    const Vec3 middle = tally.rays == 0 ? Vec3(0.0f) : Vec3(1, 0, 0);
    tally +=
        shoot({.mesh = mesh, .grade = Grade::kClosed, .aim = salvo_at(middle, 0.2f, {kFeatures, times(12), 24, 1}, 7)});
  }
  EXPECT_EQ(tally.hits, tally.rays);
  EXPECT_GT(tally.ties, 80u);
}

// The same triangle a hundred thousand times: the first of them is hit, whatever comes first.
TEST(HardCase29, IdenticalTriangles) {
  TestMesh mesh = make_triangle({-1, -1, 0.125f}, {1, -1, 0}, {0, 1, -0.25f});
  const TestMesh one = mesh;  // of so few bits that `compact` keeps it
  mesh.triangles.resize(100000, mesh.triangles[0]);
  const Rays rays = picture({0.1f, 0.2f, 3}, {-1.1f, -1.3f, -3}, {0.25f, 0, 0}, {0, 0.25f, 0}, 8, 8);
  Rays list = rays;
  list.columns = 0;
  const Oracle oracle(one.view(), {.reading = Reading::kStandard});
  std::vector<NearestHit> wanted;
  std::size_t hits = 0;
  for (std::size_t i = 0; i < rays.directions.size(); ++i) {
    wanted.push_back(oracle.nearest(oracle_ray(rays, i)));
    hits += wanted.back().ties.size();
  }
  EXPECT_GT(hits, 16u);
  const GridParameters grid{.lambda = 1e-5f};  // one cell
  std::size_t turn = 0;
  for (const Profile& profile : kProfiles) {
    Target target(mesh, grid, profile);
    ASSERT_EQ(target.status(), Status::kOk) << profile.name;
    const PipelineWay& way = pipeline_ways()[turn++];
    const std::vector<Answer> answers = target.by_pipeline(rays, way);
    const auto order = profile.is_exact ? IntersectorWay::Order::kShuffled : IntersectorWay::Order::kAscending;
    const std::vector<Answer> alone = target.by_intersector(list, {4, 8, order});
    for (std::size_t i = 0; profile.is_exact && i < answers.size(); ++i) {
      const std::uint32_t id = wanted[i].ties.empty() ? kNoTriangle : 0u;
      ASSERT_EQ(answers[i].id, id) << profile.name << ", ray " << i;
      ASSERT_EQ(alone[i].id, id) << profile.name << ", ray " << i;
      ASSERT_EQ(alone[i].t, wanted[i].t) << profile.name << ", ray " << i;
    }
  }
}

// Sheets from one float to a thousand floats apart, in no order, level and tilted.
TEST(HardCase34, CoplanarStack) {
  constexpr std::uint32_t kSteps[] = {30, 0, 3, 1000, 1, 100, 2, 10, 300, 5};
  Tally tally;
  for (const float tilt : {0.0f, 0.3f}) {
    TestMesh mesh;
    for (const std::uint32_t steps : kSteps) {
      const auto raised = [&](float z) { return std::bit_cast<float>(std::bit_cast<std::uint32_t>(z) + steps); };
      mesh.append(make_triangle({-2, -2, raised(1.0f + tilt)}, {2, -2, raised(1.5f)}, {0, 2, raised(1.25f + tilt)}));
    }
    tally += shoot({.mesh = mesh,
                    .aim = all_of({salvo_at({0, 0, -2}, 1.5f, {kFeatures, times(8), 24, 1}, 34),
                                   salvo_at({0, 0, 5}, 1.5f, {kFeatures, times(8), 24, 1}, 34)})});
  }
  EXPECT_GT(tally.hits, tally.rays / 3);
  EXPECT_GT(tally.ties, 1000u);
}

}  // namespace
}  // namespace gridiron::test::hard
