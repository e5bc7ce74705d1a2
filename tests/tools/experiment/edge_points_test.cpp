// Edge points: on the edges of what a picture shows. SPDX-License-Identifier: Apache-2.0
#include "experiment/edge_points.h"

#include <gridiron/base/records.h>

#include <glm/geometric.hpp>

#include "experiment/views.h"
#include "support/test_headers.h"

namespace gridiron::test {
namespace {

using namespace experiment;

double distance_to_edge(const DVec3& point, const DVec3& from, const DVec3& to) {
  const double share = std::clamp(glm::dot(point - from, to - from) / glm::dot(to - from, to - from), 0.0, 1.0);
  return glm::length(point - (from + share * (to - from)));
}

TEST(EdgePoints, LieOnEdgesOfShownTriangles) {
  const View knot = make_knot_view(600);
  const MeshView mesh = knot.mesh().view();
  // Two triangles shown, one of them in every third pixel; nothing in between.
  const std::vector<std::uint32_t> ids = {5, kNoTriangle, 5, 5, kNoTriangle, 400};
  const std::vector<Vec3> points = edge_points(mesh, ids, 40);
  ASSERT_EQ(points.size(), 40u);
  int vertices = 0, inside = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const UVec3& triangle = mesh.triangles[i < 30 ? 5 : 400];
    double nearest = HUGE_VAL;
    bool is_vertex = false;
    for (int edge = 0; edge < 3; ++edge) {
      const Vec3 from = mesh.vertices[triangle[edge]], to = mesh.vertices[triangle[(edge + 1) % 3]];
      nearest = std::min(nearest, distance_to_edge(DVec3(points[i]), DVec3(from), DVec3(to)));
      is_vertex = is_vertex || points[i] == from;
    }
    EXPECT_LT(nearest, 1e-6) << i;
    EXPECT_EQ(is_vertex, i % 4 == 3) << i;
    ++(is_vertex ? vertices : inside);
  }
  EXPECT_EQ(vertices, 10);
  EXPECT_EQ(inside, 30);
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (i % 4 == 3 || i % 4 == 0) continue;
    EXPECT_NE(points[i], points[i - 1]) << "edges take turns";
  }
}

TEST(EdgePoints, NothingShownHasNone) {
  const View knot = make_knot_view(600);
  EXPECT_TRUE(edge_points(knot.mesh().view(), std::vector<std::uint32_t>(9, kNoTriangle), 5).empty());
  EXPECT_TRUE(edge_points(knot.mesh().view(), {}, 5).empty());
}

}  // namespace
}  // namespace gridiron::test
