// Zero areas and projections against rational arithmetic. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/corner_quad.h>
#include <gridiron/build/triangle_records.h>

#include "support/rational_vectors.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

RationalPoint exact_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const RationalPoint p = exact_point(a);
  return cross(exact_point(b) - p, exact_point(c) - p);
}

bool exactly_zero_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return exact_normal(a, b, c) == RationalPoint{};
}

Vec3 random_point(TestRandom& random, float scale) {
  return scale * Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
}

TEST(ZeroArea, NamedKinds) {
  const Vec3 a(1, 2, 3), b(4, 5, 6.5f), far(3e38f, -3e38f, 3e38f);
  EXPECT_TRUE(has_zero_area(a, a, a));
  EXPECT_TRUE(has_zero_area(a, a, b));
  EXPECT_TRUE(has_zero_area(a, b, a));
  EXPECT_TRUE(has_zero_area(b, a, a));
  EXPECT_TRUE(has_zero_area({0, 0, 0}, {-0.0f, 0, 0}, b));
  EXPECT_TRUE(has_zero_area({0, 0, 0}, {1, 1, 1}, {3, 3, 3}));
  EXPECT_TRUE(has_zero_area({0, 0, 5}, {0, 0, 7}, {0, 0, 7.25f}));
  EXPECT_TRUE(has_zero_area(far, -far, {0, 0, 0}));
  EXPECT_FALSE(has_zero_area(far, -far, {0, 0, 1e-45f}));
  EXPECT_FALSE(has_zero_area({0, 0, 0}, {1e-45f, 0, 0}, {0, 1e-45f, 0}));
  EXPECT_FALSE(has_zero_area({0, 0, 0}, {1, 1, 1}, {3, 3, std::nextafter(3.0f, 4.0f)}));
  EXPECT_FALSE(has_zero_area({0, 0, 0}, {1e30f, 0, 0}, {-1e30f, 1e-30f, 0}));
}

// Points on a line whose differences are rounded.
TEST(ZeroArea, FloatsAreNotSureOfRoundedEdges) {
  int rounded = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    TestRandom random(seed);
    const auto part = [&] { return static_cast<float>(random.below(4095)) - 2047.0f; };
    const Vec3 step(part(), part(), part());
    const float scale = std::ldexp(1.0f, static_cast<int>(random.below(100)) - 60);
    const auto at = [&](float place) { return scale * place * step; };
    const Vec3 a = at(std::ldexp(-1.0f, 13 + static_cast<int>(random.below(8))));
    const Vec3 b = at(1.0f + static_cast<float>(random.below(7)));
    const Vec3 c = at(std::ldexp(1.0f + static_cast<float>(random.below(7)), static_cast<int>(random.below(12))));
    ASSERT_TRUE(exactly_zero_area(a, b, c)) << "seed " << seed;
    const CornerQuads corners{quad_of(a), quad_of(b), quad_of(c)};
    EXPECT_FALSE(corners.surely_have_area()) << "seed " << seed;
    const CornerQuads four[4] = {corners, corners, corners, corners};
    EXPECT_EQ(FourTriangles::of(four).with_area(), 0u) << "seed " << seed;
    rounded += double{b.x} - double{a.x} != double{b.x - a.x} ? 1 : 0;
  }
  EXPECT_GT(rounded, 500);
}

// Collinear points and their neighbours by one unit in the last place, at every scale.
TEST(ZeroArea, AgreesWithRationals) {
  int zero = 0;
  int not_zero = 0;
  int sure = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    TestRandom random(seed);
    const float scale = std::ldexp(1.0f, static_cast<int>(random.below(240)) - 130);
    const auto small = [&] { return scale * (static_cast<float>(random.below(4096)) - 2048.0f); };
    const Vec3 a(small(), small(), small());
    const Vec3 step(small(), small(), random.below(3) == 0 ? 0.0f : small());
    const Vec3 b = a + static_cast<float>(random.below(64)) * step;
    Vec3 c = a - static_cast<float>(random.below(64)) * step;
    if (seed % 2 == 0) {
      const int axis = static_cast<int>(random.below(3));
      c[axis] = std::nextafter(c[axis], seed % 4 == 0 ? 1e38f : -1e38f);
    }
    const bool expected = exactly_zero_area(a, b, c);
    EXPECT_EQ(has_zero_area(a, b, c), expected) << "seed " << seed;
    // Floats decide most, and never wrongly.
    const CornerQuads corners{quad_of(a), quad_of(b), quad_of(c)};
    EXPECT_EQ(corners.have_zero_area(), expected) << "seed " << seed;
    EXPECT_FALSE(corners.surely_have_area() && expected) << "seed " << seed;
    const CornerQuads other{quad_of({0, 0, 0}), quad_of({1, 0, 0}), quad_of({0, 1, 0})};
    const CornerQuads four[4] = {other, corners, corners, other};
    EXPECT_EQ(FourTriangles::of(four).with_area(), expected ? 9u : 15u) << "seed " << seed;
    sure += corners.surely_have_area() ? 1 : 0;
    ++(expected ? zero : not_zero);
  }
  EXPECT_GT(zero, 500);
  EXPECT_GT(not_zero, 500);
  EXPECT_GT(sure, 100);
}

struct ProjectionCase {
  const char* name;
  float scale;
  float offset;
  float squeeze;  // size of one axis relative to the others
};

class Projection : public ::testing::TestWithParam<ProjectionCase> {};

// Each stored float is the rational one within a few units in the last place of double, then rounded once.
TEST_P(Projection, IsTheRationalOneRounded) {
  const ProjectionCase& param = GetParam();
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    TestRandom random(seed);
    Vec3 p[3];
    for (Vec3& corner : p) {
      corner = random_point(random, param.scale);
      corner[static_cast<int>(seed % 3)] *= param.squeeze;
      corner += Vec3(param.offset);
    }
    if (exactly_zero_area(p[0], p[1], p[2])) continue;
    ProjectionTriangle record;
    make_projection_triangle(p[0], p[1], p[2], 1234, record);
    EXPECT_EQ(record.triangle_id, 1234u);
    EXPECT_EQ(record.reserved, 0u);
    ASSERT_LT(record.axis_k, 3u);
    const RationalPoint n = exact_normal(p[0], p[1], p[2]);
    const std::size_t k = record.axis_k;
    const std::size_t u = (k + 1) % 3;
    const std::size_t v = (k + 2) % 3;
    const RationalPoint a = exact_point(p[0]);
    const RationalPoint e1 = exact_point(p[1]) - a, e2 = exact_point(p[2]) - a;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LE(abs(n[i]), abs(n[k]) * Rational(1 + 1e-12)) << "seed " << seed << ": axis_k is not the largest";
    }
    const Rational n_k = n[k];
    const auto expect_near = [&](float stored, const Rational& exact, const Rational& terms, const char* field) {
      const Rational error = abs(Rational(stored) - exact);
      EXPECT_LE(error, abs(exact) * Rational(std::ldexp(1.0, -24)) + terms * Rational(std::ldexp(1.0, -47)) +
                           Rational(std::ldexp(1.0, -150)))
          << param.name << " seed " << seed << ' ' << field;
    };
    const Rational nu = n[u] / n_k;
    const Rational nv = n[v] / n_k;
    expect_near(record.n_u, nu, abs(nu) + 1, "n_u");
    expect_near(record.n_v, nv, abs(nv) + 1, "n_v");
    expect_near(record.n_d, a[k] + nu * a[u] + nv * a[v], abs(a[k]) + abs(a[u]) + abs(a[v]), "n_d");
    const Rational d = abs(1 / n_k);
    expect_near(record.b_u, e2[v] / n_k, d * abs(e2[v]), "b_u");
    expect_near(record.b_v, -e2[u] / n_k, d * abs(e2[u]), "b_v");
    expect_near(record.b_d, (a[v] * e2[u] - a[u] * e2[v]) / n_k, d * (abs(a[v] * e2[u]) + abs(a[u] * e2[v])), "b_d");
    expect_near(record.c_u, -e1[v] / n_k, d * abs(e1[v]), "c_u");
    expect_near(record.c_v, e1[u] / n_k, d * abs(e1[u]), "c_v");
    expect_near(record.c_d, (a[u] * e1[v] - a[v] * e1[u]) / n_k, d * (abs(a[v] * e1[u]) + abs(a[u] * e1[v])), "c_d");
  }
}
INSTANTIATE_TEST_SUITE_P(Kinds, Projection,
                         ::testing::Values(ProjectionCase{"plain", 1, 0, 1}, ProjectionCase{"flat", 1, 0, 1e-6f},
                                           ProjectionCase{"moved", 1, 1e5f, 1}, ProjectionCase{"small", 1e-12f, 0, 1},
                                           ProjectionCase{"large", 1e12f, 0, 1}),
                         [](const auto& test) { return test.param.name; });

TEST(Projection, MeansWhatTheRecordSays) {
  const Vec3 a(1, 2, 3), b(4, 2.5f, 3.25f), c(1.5f, 6, 2);
  ProjectionTriangle r;
  make_projection_triangle(a, b, c, 7, r);
  const int k = static_cast<int>(r.axis_k);
  const int u = (k + 1) % 3;
  const int v = (k + 2) % 3;
  const auto beta = [&](const Vec3& p) { return r.b_u * p[u] + r.b_v * p[v] + r.b_d; };
  const auto gamma = [&](const Vec3& p) { return r.c_u * p[u] + r.c_v * p[v] + r.c_d; };
  for (const Vec3& p : {a, b, c}) EXPECT_NEAR(p[k], r.n_d - r.n_u * p[u] - r.n_v * p[v], 1e-5f);
  EXPECT_NEAR(beta(a), 0, 1e-6f);
  EXPECT_NEAR(beta(b), 1, 1e-6f);
  EXPECT_NEAR(beta(c), 0, 1e-6f);
  EXPECT_NEAR(gamma(a), 0, 1e-6f);
  EXPECT_NEAR(gamma(b), 0, 1e-6f);
  EXPECT_NEAR(gamma(c), 1, 1e-6f);
}

TEST(Projection, StaysFiniteForEveryTriangleWithAnArea) {
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    TestRandom random(seed);
    const float scale = std::ldexp(1.0f, static_cast<int>(random.below(270)) - 145);
    const Vec3 a = random_point(random, scale);
    const Vec3 b = a + random_point(random, scale * 1e-6f);
    Vec3 c = a + 2.0f * (b - a);
    const int axis = static_cast<int>(random.below(3));
    c[axis] = std::nextafter(c[axis], seed % 2 == 0 ? 1e38f : -1e38f);
    if (has_zero_area(a, b, c)) continue;
    ProjectionTriangle r;
    make_projection_triangle(a, b, c, 0, r);
    for (const float value : {r.n_u, r.n_v, r.n_d, r.b_u, r.b_v, r.b_d, r.c_u, r.c_v, r.c_d}) {
      EXPECT_TRUE(std::isfinite(value)) << "seed " << seed;
    }
  }
}

// A sliver whose normal double cancels to nothing: only the exact normal knows the axis.
TEST(Projection, SliverBelowTheReachOfDoubles) {
  const Vec3 a(0, 0, 0);
  const Vec3 b(1e30f, 1e-30f, 0);
  const Vec3 c(-1e30f, 0, 0);
  ASSERT_FALSE(has_zero_area(a, b, c));
  const float o = 1e10f;
  const Vec3 d(o, o, o);
  const Vec3 e(1e-10f, 1e-10f, 1e-10f);
  const Vec3 f(-o, -o, std::nextafter(-o, 0.0f));
  ASSERT_FALSE(has_zero_area(d, e, f));
  ProjectionTriangle r;
  make_projection_triangle(d, e, f, 0, r);
  const RationalPoint n = exact_normal(d, e, f);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LE(abs(n[i]), abs(n[r.axis_k]));
}

}  // namespace
}  // namespace gridiron::test
