// Hither plane: what is in front of it and seen. SPDX-License-Identifier: Apache-2.0
#include "gridiron/scene/hither.h"

#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

// From the origin along -z; the picture spans |x| <= 2 depth, |y| <= depth.
std::optional<tool::HitherCut> cut_of(const TestMesh& mesh, double hither, Vec3 eye = Vec3(0, 0, 0),
                                      Vec3 at = Vec3(0, 0, -1)) {
  const Camera camera = {.eye = eye, .at = at, .up = Vec3(0, 1, 0), .tan_half_fov = 1.0f};
  return tool::find_hither_cut(camera, 2.0, hither, mesh.view());
}

TestMesh triangle(Vec3 a, Vec3 b, Vec3 c) {
  return make_triangle(a, b, c);
}

TEST(Hither, DepthDecides) {
  const TestMesh mesh = triangle({-1, 0, -5}, {1, 0, -5}, {0, 1, -5});
  EXPECT_FALSE(cut_of(mesh, 4.0));
  EXPECT_FALSE(cut_of(mesh, 5.0)) << "on the plane it is seen";
  const auto cut = cut_of(mesh, 5.5);
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->triangle, 0u);
  EXPECT_NEAR(cut->depth, 5.0, 1e-12);
}

TEST(Hither, TheNearestOfAllIsTold) {
  TestMesh mesh = triangle({-1, 0, -5}, {1, 0, -5}, {0, 1, -5});
  mesh.append(triangle({-1, 0, -4}, {1, 0, -4}, {0, 1, -4}));
  mesh.append(triangle({-1, 0, -4.5f}, {1, 0, -4.5f}, {0, 1, -4.5f}));
  const auto cut = cut_of(mesh, 6.0);
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->triangle, 1u);
  EXPECT_NEAR(cut->depth, 4.0, 1e-12);
}

TEST(Hither, DepthIsAlongTheView) {
  // Seen from (3, 0, 0) towards -x, it is 2 away at its nearest corner.
  const TestMesh mesh = triangle({1, 0, 0}, {-4, 1, 0}, {-4, 0, 1});
  EXPECT_FALSE(cut_of(mesh, 1.9, Vec3(3, 0, 0), Vec3(-9, 0, 0)));
  EXPECT_TRUE(cut_of(mesh, 2.1, Vec3(3, 0, 0), Vec3(-9, 0, 0)));
}

TEST(Hither, OutsideThePictureNothingIsCut) {
  EXPECT_FALSE(cut_of(triangle({5, 0, -1}, {6, 0, -1}, {5, 1, -1}), 2.0)) << "to the right";
  EXPECT_FALSE(cut_of(triangle({-5, 0, -1}, {-6, 0, -1}, {-5, 1, -1}), 2.0)) << "to the left";
  EXPECT_FALSE(cut_of(triangle({0, 3, -1}, {1, 3, -1}, {0, 4, -1}), 2.0)) << "above";
  EXPECT_FALSE(cut_of(triangle({0, -3, -1}, {1, -3, -1}, {0, -4, -1}), 2.0)) << "below";
  EXPECT_FALSE(cut_of(triangle({0, 0, 1}, {1, 0, 1}, {0, 1, 1}), 2.0)) << "behind";
  EXPECT_TRUE(cut_of(triangle({1.9f, 0, -1}, {6, 0, -1}, {6, 1, -1}), 2.0)) << "a corner inside";
  // Twice as wide as high.
  EXPECT_FALSE(cut_of(triangle({0, 1.9f, -1}, {1, 1.9f, -1}, {0, 3, -1}), 2.0));
}

TEST(Hither, TrianglesWhoseCornersAreAllOutside) {
  EXPECT_TRUE(cut_of(triangle({-90, -90, -1}, {90, -90, -1}, {0, 90, -1}), 2.0)) << "fills the picture";
  EXPECT_TRUE(cut_of(triangle({-90, 0, -1}, {90, 0.1f, -1}, {90, -0.1f, -1}), 2.0)) << "a bar across";
  EXPECT_TRUE(cut_of(triangle({-9, -1, 9}, {9, -1, 9}, {0, -1, -90}), 2.0)) << "a floor from behind the eye";
  EXPECT_FALSE(cut_of(triangle({-9, -1, 9}, {9, -1, 9}, {0, -1, -90}), 0.9)) << "seen from depth 1 on";
  // In front of the hither plane only where the picture does not reach.
  EXPECT_FALSE(cut_of(triangle({8, 0, -1}, {0, 0, -9}, {8, 0, -9}), 1.5));
}

// Points of a triangle, close together, tested one by one.
TEST(Hither, AgreesWithPoints) {
  std::uint32_t cuts = 0;
  const TestMesh soup = make_random_soup(400, 1.5f, 11);
  for (const UVec3& indices : soup.triangles) {
    const Vec3 a = soup.vertices[indices.x], b = soup.vertices[indices.y], c = soup.vertices[indices.z];
    const Vec3 eye(0.5f, 0.5f, 1.2f), at(0.5f, 0.5f, -9.0f);
    const double hither = 0.4;
    bool is_hit = false, is_close = false;  // a point inside, and a point that nearly is
    constexpr int kSteps = 60;
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const DVec3 p =
            (DVec3(a) * double(i) + DVec3(b) * double(j) + DVec3(c) * double(kSteps - i - j)) / double(kSteps) -
            DVec3(eye);
        const double depth = -p.z;
        const auto is_inside = [&](double room) {
          return depth > -room && depth < hither + room && std::abs(p.x) <= 2 * depth + room &&
                 std::abs(p.y) <= depth + room;
        };
        is_hit |= is_inside(-1e-6);
        is_close |= is_inside(0.1);
      }
    }
    const bool is_cut = cut_of(make_triangle(a, b, c), hither, eye, at).has_value();
    if (is_hit) {
      EXPECT_TRUE(is_cut);
    }
    if (!is_close) {
      EXPECT_FALSE(is_cut);
    }
    cuts += is_cut ? 1u : 0u;
  }
  EXPECT_GT(cuts, 5u);
  EXPECT_LT(cuts, 395u);
}

}  // namespace
}  // namespace gridiron::test
