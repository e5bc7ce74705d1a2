// Unit normals of triangles of any shape, against rational numbers. SPDX-License-Identifier: Apache-2.0
#include <gridiron/ray/distance.h>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "support/rational_vectors.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using Long = boost::multiprecision::cpp_bin_float_100;

// The unit normal, to far more than a double's digits. @returns false where the triangle has no area.
bool exact_unit_normal(const VertexTriangle& triangle, double normal[3]) {
  const RationalPoint a = exact_point(triangle.v[0]);
  const RationalPoint exact = cross(exact_point(triangle.v[1]) - a, exact_point(triangle.v[2]) - a);
  const Rational squared = dot(exact, exact);
  if (squared == 0) return false;
  const auto as_long = [](const Rational& value) -> Long { return Long(numerator(value)) / Long(denominator(value)); };
  const Long length = sqrt(as_long(squared));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    normal[axis] = Long(as_long(exact[axis]) / length).convert_to<double>();
  }
  return true;
}

// Two corners anywhere, the third on the line through them but for `height` of their distance; all coordinates but
// those of flat ones at scale `scale`.
VertexTriangle sliver(TestRandom& random, double height, double scale, bool is_flat) {
  double corner[2][3];
  for (auto& point : corner) {
    for (double& coordinate : point) coordinate = static_cast<double>(random.between(-1.0f, 1.0f));
    if (is_flat) point[2] = 0;
  }
  const double along = static_cast<double>(random.between(-0.5f, 1.5f));
  VertexTriangle triangle{};
  for (int axis = 0; axis < 3; ++axis) {
    const double off = is_flat && axis == 2 ? 0 : height * static_cast<double>(random.between(-1.0f, 1.0f));
    triangle.v[0][axis] = static_cast<float>(scale * corner[0][axis]);
    triangle.v[1][axis] = static_cast<float>(scale * corner[1][axis]);
    triangle.v[2][axis] =
        static_cast<float>(scale * (corner[0][axis] + along * (corner[1][axis] - corner[0][axis]) + off));
  }
  return triangle;
}

void expect_normal(const VertexTriangle& triangle, std::uint64_t& checked) {
  double expected[3];
  if (!exact_unit_normal(triangle, expected)) return;
  float normal[3];
  set_up_normal(triangle, normal);
  ++checked;
  for (int axis = 0; axis < 3; ++axis) {
    ASSERT_NEAR(normal[axis], expected[axis], 0x1p-15)
        << "of (" << triangle.v[0][0] << ' ' << triangle.v[0][1] << ' ' << triangle.v[0][2] << "), ("
        << triangle.v[1][0] << ' ' << triangle.v[1][1] << ' ' << triangle.v[1][2] << "), (" << triangle.v[2][0] << ' '
        << triangle.v[2][1] << ' ' << triangle.v[2][2] << ')';
  }
}

TEST(Normal, OfSliversIsThatOfRationals) {
  TestRandom random(41);
  std::uint64_t checked = 0;
  for (double height = 1; height > 1e-36; height *= 0.1) {
    for (const double scale : {1.0, 0x1p-80, 0x1p100}) {
      for (const bool is_flat : {false, true}) {
        for (int i = 0; i < 100; ++i) {
          ASSERT_NO_FATAL_FAILURE(expect_normal(sliver(random, height, scale, is_flat), checked));
        }
      }
    }
  }
  EXPECT_GT(checked, 18'000u);
}

// Two corners on a line through 0, the third a speck beside 0: in doubles these fall together, as at the pole of a
// sphere of which the sine of pi is no zero.
TEST(Normal, OfASpeckBesideALine) {
  TestRandom random(42);
  std::uint64_t checked = 0;
  for (int i = 0; i < 20'000; ++i) {
    const float x = random.between(0.5f, 8.0f), y = std::ldexp(static_cast<float>(1 + random.below(7)), -2);
    const float times = static_cast<float>(2 + random.below(7));
    VertexTriangle triangle{{{x, y * x, 0}, {times * x, times * (y * x), 0}, {0, 0, 0}}, {}, 0};
    const bool is_flat = random.below(2) == 0;
    for (int axis = 0; axis < (is_flat ? 2 : 3); ++axis) {
      triangle.v[2][axis] = std::ldexp(random.between(-1.0f, 1.0f), -static_cast<int>(20 + random.below(80)));
    }
    ASSERT_NO_FATAL_FAILURE(expect_normal(triangle, checked));
  }
  EXPECT_GT(checked, 19'000u);
}

}  // namespace
}  // namespace gridiron::test
