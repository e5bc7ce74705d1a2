// The suite's own parts: which meshes are closed, that no candidate is left out, which points are inside.
// SPDX-License-Identifier: Apache-2.0
#include "numeric/watertight/solids.h"

#include "core/seeds.h"
#include "numeric/hard_rays.h"
#include "numeric/watertight/aims.h"
#include "numeric/watertight/placed_solid.h"

namespace gridiron::test {
namespace {

TEST(WatertightSolids, AllAreClosed) {
  for (const Detail detail : {Detail::kLow, Detail::kFull}) {
    for (const Solid& solid : make_solids(detail)) EXPECT_EQ(why_not_closed(solid.mesh), "") << solid.name;
  }
}

TEST(WatertightSolids, ClosedMeansTwoOpposedFacesAtEveryEdge) {
  const TestMesh box = make_box({-1, -1, -1}, {1, 1, 1});
  EXPECT_EQ(why_not_closed(box), "");
  TestMesh turned = box;
  std::swap(turned.triangles[3].x, turned.triangles[3].y);
  EXPECT_NE(why_not_closed(turned), "");
  TestMesh open = box;
  open.triangles.pop_back();
  EXPECT_NE(why_not_closed(open), "");
  TestMesh doubled = box;
  doubled.append(box);  // other vertices: two boxes
  EXPECT_EQ(why_not_closed(doubled), "");
  for (std::size_t i = box.triangles.size(); i < doubled.triangles.size(); ++i) {
    doubled.triangles[i] = box.triangles[i - box.triangles.size()];  // the same vertices: four faces at each edge
  }
  EXPECT_NE(why_not_closed(doubled), "");
  TestMesh stray = box;
  stray.triangles[0].x = 99;
  EXPECT_NE(why_not_closed(stray), "");
  TestMesh folded = box;
  folded.triangles.push_back({0, 1, 0});
  EXPECT_NE(why_not_closed(folded), "");
  EXPECT_NE(why_not_closed(TestMesh{}), "");
}

TEST(WatertightSolids, CandidatesLeaveNoTriangleOut) {
  std::uint64_t hits = 0;
  for (const Solid& solid : make_solids(Detail::kLow)) {
    for (const Placement& placement : all_placements()) {
      const PlacedSolid placed(solid, placement);
      for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        watertight::Shot shot;
        ASSERT_TRUE(aim(placed, kRayKinds[seed % std::size(kRayKinds)], seed, shot));
        CandidateRecords records;
        placed.add_candidates(shot, records);
        for (std::uint32_t ray = 0; ray < watertight::kShotRays; ++ray) {
          if ((shot.active >> ray & 1u) == 0) continue;
          const OracleRay asked{{shot.origin[0], shot.origin[1], shot.origin[2]},
                                {shot.dir[0][ray], shot.dir[1][ray], shot.dir[2][ray]}};
          const auto found = placed.oracle().hits(asked);
          ASSERT_FALSE(found.empty()) << solid.name << ' ' << placement.name << ": by the oracle a ray gets out";
          for (const OracleHit& hit : found) {
            ASSERT_NE(std::ranges::find(records.ids, hit.triangle_id), records.ids.end())
                << solid.name << ' ' << placement.name << ", seed " << seed << ", ray " << ray;
            ++hits;
          }
        }
      }
    }
  }
  EXPECT_GT(hits, 10000u);
}

TEST(WatertightSolids, InsideIsInside) {
  const PlacedSolid ball({"sphere", make_sphere(20, 21, 1.0f)}, {});
  TestRandom random(1);
  EXPECT_TRUE(ball.look_around(Vec3(0.0f), random).is_inside);
  EXPECT_TRUE(ball.look_around(Vec3(0.9f, 0.0f, 0.0f), random).is_inside);
  EXPECT_FALSE(ball.look_around(Vec3(1.1f, 0.0f, 0.0f), random).is_inside);
  EXPECT_FALSE(ball.look_around(ball.mesh().vertices[0], random).is_inside) << "on a vertex";
  const PlacedSolid ring({"torus", make_torus(24, 16, 0.7f, 0.3f)}, {});
  EXPECT_FALSE(ring.look_around(Vec3(0.0f), random).is_inside) << "in the hole";
  const PlacedSolid box({"box", make_box({-1, -1, -1}, {1, 1, 1})}, {});
  EXPECT_FALSE(box.look_around(Vec3(1.0f, 0.25f, 0.5f), random).is_inside) << "in a face";
  EXPECT_FALSE(box.look_around(Vec3(1.0f, 1.0f, 0.5f), random).is_inside) << "on an edge";
  EXPECT_TRUE(box.look_around(Vec3(std::nextafter(1.0f, 0.0f), 0.25f, 0.5f), random).is_inside);
  EXPECT_FALSE(box.look_around(Vec3(std::nextafter(1.0f, 2.0f), 0.25f, 0.5f), random).is_inside);
  const std::uint32_t seen = box.look_around(Vec3(0.0f), random).seen_triangle;
  EXPECT_LT(seen, 12u);
}

}  // namespace
}  // namespace gridiron::test
