// Rays at features: edges, vertices, along edges, in planes, edge-on. SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "numeric/hard_cases/shapes.h"
#include "numeric/hard_cases/trial.h"

namespace gridiron::test {
namespace {

// From inside each of the solids.
Tally shoot_from_inside(const Salvo& count, std::uint64_t seed) {
  Tally tally;
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.name);
    EXPECT_TRUE(is_closed(solid.mesh));
    tally += shoot({.mesh = solid.mesh, .grade = Grade::kClosed, .aim = [&](const TestMesh& mesh) {
                      std::vector<Rays> rays = salvo(mesh, solid.middle, solid.room, count, seed);
                      TestRandom random(seed);
                      for (std::uint32_t i = 0; i < times(4); ++i) {
                        const auto triangle = random.below(static_cast<std::uint32_t>(mesh.triangles.size()));
                        rays.push_back(picture_of_triangle(mesh, triangle, solid.middle));
                      }
                      return rays;
                    }});
  }
  return tally;
}

TEST(HardCase01, RayThroughSharedEdge) {
  const Tally tally = shoot_from_inside({{Aim::kEdge}, times(12), 32, 1}, 1);
  EXPECT_EQ(tally.hits, tally.rays);
  EXPECT_GT(tally.ties, 500u);
}

}  // namespace
}  // namespace gridiron::test
