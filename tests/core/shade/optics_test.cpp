// Mirror and glass: Snell's law, Fresnel's shares and energy in doubles. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/math.h>
#include <gridiron/shade/optics.h>

#include <glm/geometric.hpp>

#include "support/test_headers.h"

namespace gridiron::test {
namespace {

DVec3 precise(Vector3 a) {
  return {a.x, a.y, a.z};
}
bool same(Vector3 a, Vector3 b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}
bool is_finite(Vector3 a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// Unit vectors at random, and now and then along axes.
class Rays {
 public:
  Vector3 unit() {
    if (random_() % 16 == 0) {
      const float sign = random_() % 2 == 0 ? 1.0f : -1.0f;
      const auto axis = random_() % 3;
      return {axis == 0 ? sign : 0.0f, axis == 1 ? sign : 0.0f, axis == 2 ? sign : 0.0f};
    }
    return normalized({part_(random_), part_(random_), part_(random_)});
  }
  /// A direction against the normal; every fourth nearly along the surface, every eighth all but straight at it.
  Vector3 against(Vector3 normal) {
    Vector3 d = unit();
    const auto kind = random_() % 8;
    const float along = gridiron::dot(d, normal);
    if (kind < 2) d = normalized(d - along * normal - std::ldexp(1.0f, -static_cast<int>(random_() % 30)) * normal);
    if (kind == 2) d = normalized(std::ldexp(1.0f, -static_cast<int>(random_() % 30)) * d - normal);
    if (gridiron::dot(d, d) == 0.0f) return -normal;
    return gridiron::dot(d, normal) > 0.0f ? -d : d;
  }
  /// 0.1..10, now and then its ends, 1 and next to 1.
  float ratio() {
    const float chosen[] = {0.1f, 10.0f, 1.0f, 1.0f + 0x1p-23f, 1.0f - 0x1p-24f, 1.5f, 1.0f / 1.5f};
    const auto kind = random_() % 14;
    return kind < 7 ? chosen[kind] : std::pow(10.0f, 2.0f * fraction_(random_) - 1.0f);
  }
  float fraction() { return fraction_(random_); }

 private:
  std::mt19937 random_{1};
  std::normal_distribution<float> part_;
  std::uniform_real_distribution<float> fraction_{0.0f, 1.0f};
};

TEST(Reflect, KeepsTheAngleAndThePlane) {
  Rays rays;
  for (int i = 0; i < 300000; ++i) {
    const Vector3 n = rays.unit(), d = rays.against(n);
    const DVec3 r = precise(reflect(d, n));
    ASSERT_NEAR(length(r), 1.0, 0x1p-20) << i;
    ASSERT_NEAR(dot(r, precise(n)), -dot(precise(d), precise(n)), 0x1p-20) << i;
    ASSERT_NEAR(dot(cross(precise(d), precise(n)), r), 0.0, 0x1p-20) << i;
  }
}

TEST(ReflectOff, LeavesTheFace) {
  Rays rays;
  int about_face = 0;
  for (int i = 0; i < 300000; ++i) {
    const Vector3 face = rays.unit(), d = rays.against(face);
    Vector3 shading = normalized(face + 0.9f * rays.unit());
    if (!(dot(shading, d) < 0.0f)) shading = face;
    const Vector3 r = reflect_off(d, shading, face), about_shading = reflect(d, shading);
    // What cannot leave is grazing, by rounding.
    ASSERT_GT(dot(r, face), dot(d, face) < -0x1p-20f ? 0.0f : -0x1p-20f) << i;
    if (dot(about_shading, face) > 0.0f) {
      ASSERT_TRUE(same(r, about_shading)) << i;
    } else {
      ++about_face;
      ASSERT_TRUE(same(r, reflect(d, face))) << i;
    }
  }
  EXPECT_GT(about_face, 1000);
}

TEST(Refract, IsSnellsLawAndFresnelsShare) {
  Rays rays;
  int total = 0, through = 0;
  for (int i = 0; i < 1000000; ++i) {
    const Vector3 n = rays.unit(), d = rays.against(n);
    const float ratio = rays.ratio();
    const Refraction got = refract(d, n, ratio);
    ASSERT_TRUE(is_finite(got.direction)) << i;
    ASSERT_GE(got.fresnel, 0.0f) << i;
    ASSERT_LE(got.fresnel, 1.0f) << i;

    const double e = static_cast<double>(ratio), c = std::max(-dot(precise(d), precise(n)), 0.0);
    const double k = 1.0 - e * e * (1.0 - c * c);
    // d, n are unit to 2^-22 and so is c to a few of that; k magnifies it by e e.
    const double slack_of_k = (1.0 + e * e) * 0x1p-20;
    if (got.is_total) {
      ASSERT_LE(k, slack_of_k) << i;
      ASSERT_EQ(got.fresnel, 1.0f) << i;
      ++total;
      continue;
    }
    ASSERT_GE(k, -slack_of_k) << i;
    ++through;
    const double f = std::sqrt(std::max(k, 0.0));
    const double slack = std::min(slack_of_k / std::max(f, 1e-30), std::sqrt(2.0 * slack_of_k)) + (1.0 + e) * 0x1p-21;
    const DVec3 t = precise(got.direction);
    ASSERT_NEAR(length(t), 1.0, slack) << i;
    ASSERT_NEAR(dot(t, precise(n)), -f, slack) << i;
    // Sines: |d x n| e = |t x n|, and on the same side of the normal.
    const DVec3 from = cross(precise(d), precise(n)), to = cross(t, precise(n));
    ASSERT_NEAR(to.x, e * from.x, (1.0 + e) * 0x1p-20) << i;
    ASSERT_NEAR(to.y, e * from.y, (1.0 + e) * 0x1p-20) << i;
    ASSERT_NEAR(to.z, e * from.z, (1.0 + e) * 0x1p-20) << i;
    // Fresnel's share from the angles, where these are not about 0: by sines and tangents instead of core's quotients.
    if (c > 0x1p-8 && f > 0x1p-8 && c < 0.9999 && std::abs(e - 1.0) > 1e-3) {
      const double in = std::acos(std::min(c, 1.0)), out = std::acos(std::min(f, 1.0));
      const double s = std::sin(in - out) / std::sin(in + out), p = std::tan(in - out) / std::tan(in + out);
      const double sensitivity = (1.0 + e) * (1.0 + 1.0 / e) * (1.0 / c + 1.0 / f);
      ASSERT_NEAR(got.fresnel, 0.5 * (s * s + p * p), 0x1p-18 * sensitivity * (1.0 + e * e / f)) << i << " " << e;
    }
  }
  EXPECT_GT(total, 50000);
  EXPECT_GT(through, 200000);
}

// From air into water, 30 degrees become 22.02; from water into air, 41.81, and beyond 48.59 nothing gets out.
TEST(Refract, KnowsInsideFromOutside) {
  EXPECT_EQ(refraction_ratio(1.25f, true), 0.8f);
  EXPECT_EQ(refraction_ratio(1.25f, false), 1.25f);
  const Vector3 n{0, 0, 1}, d{0.5f, 0, -0.866025404f};
  EXPECT_NEAR(refract(d, n, refraction_ratio(4.0f / 3.0f, true)).direction.x, 0.375f, 1e-6f);
  const Refraction out = refract(d, n, refraction_ratio(4.0f / 3.0f, false));
  EXPECT_FALSE(out.is_total);
  EXPECT_NEAR(out.direction.x, 2.0f / 3.0f, 1e-6f);
  const Vector3 steep{0.76f, 0, -0.64992307f};
  EXPECT_TRUE(refract(steep, n, refraction_ratio(4.0f / 3.0f, false)).is_total);
  EXPECT_FALSE(refract(steep, n, refraction_ratio(4.0f / 3.0f, true)).is_total);
}

TEST(Refract, HasKnownShares) {
  const Vector3 n{0, 0, 1};
  // Straight on: ((n - 1) / (n + 1))^2, the ray goes on.
  const Refraction straight = refract({0, 0, -1}, n, refraction_ratio(1.5f, true));
  EXPECT_NEAR(straight.fresnel, 0.04f, 1e-6f);
  EXPECT_NEAR(straight.direction.z, -1.0f, 1e-6f);
  EXPECT_NEAR(refract({0, 0, -1}, n, refraction_ratio(1.5f, false)).fresnel, 0.04f, 1e-6f);
  // Brewster's angle: light of one polarisation is let through whole.
  const double brewster = std::atan(1.5);
  const Vector3 d{static_cast<float>(std::sin(brewster)), 0, static_cast<float>(-std::cos(brewster))};
  const double s = (1.5 * 1.5 - 1.0) / (1.5 * 1.5 + 1.0);
  EXPECT_NEAR(refract(d, n, 1.0f / 1.5f).fresnel, 0.5 * s * s, 1e-6);
  // Nothing bends where the index is 1, and nothing is thrown back.
  const Refraction none = refract(d, n, 1.0f);
  EXPECT_NEAR(none.fresnel, 0.0f, 1e-9f);
  EXPECT_NEAR(none.direction.x, d.x, 1e-6f);
  EXPECT_NEAR(none.direction.z, d.z, 1e-6f);
  // Total on either side of the critical angle, asin(1 / 1.5) = 41.81 degrees.
  const auto at = [&](double degrees) {
    const double angle = degrees * std::acos(-1.0) / 180.0;
    return refract({static_cast<float>(std::sin(angle)), 0, static_cast<float>(-std::cos(angle))}, n, 1.5f);
  };
  EXPECT_FALSE(at(41.80).is_total);
  EXPECT_TRUE(at(41.82).is_total);
  EXPECT_EQ(at(41.82).fresnel, 1.0f);
}

TEST(Refract, IsDefinedForGrazingRays) {
  const Vector3 n{0, 0, 1};
  for (const float c : {0.0f, -0.0f, 0x1p-149f, 0x1p-126f, 0x1p-70f, 0x1p-30f, -0x1p-149f, -0x1p-24f}) {
    for (const float ratio : {0.1f, 0.5f, 1.0f - 0x1p-24f, 1.0f, 1.0f + 0x1p-23f, 2.0f, 10.0f}) {
      const Refraction got = refract({1, 0, -c}, n, ratio);
      EXPECT_TRUE(is_finite(got.direction)) << c << " " << ratio;
      EXPECT_GE(got.fresnel, 0.0f) << c << " " << ratio;
      EXPECT_LE(got.fresnel, 1.0f) << c << " " << ratio;
      EXPECT_EQ(got.is_total, ratio > 1.0f) << c << " " << ratio;
      if (c <= 0.0f) {
        EXPECT_EQ(got.fresnel, 1.0f) << c << " " << ratio;
      }
    }
  }
}

TEST(RefractThrough, LeavesTheFaceOnTheOtherSide) {
  Rays rays;
  int about_face = 0;
  for (int i = 0; i < 300000; ++i) {
    const Vector3 face = rays.unit(), d = rays.against(face);
    Vector3 shading = normalized(face + 0.9f * rays.unit());
    if (!(dot(shading, d) < 0.0f)) shading = face;
    const float ratio = rays.ratio();
    const Refraction got = refract_through(d, shading, face, ratio), first = refract(d, shading, ratio);
    const bool again = !first.is_total && !(dot(first.direction, face) < 0.0f);
    const Refraction wanted = again ? refract(d, face, ratio) : first;
    about_face += again ? 1 : 0;
    ASSERT_EQ(got.is_total, wanted.is_total) << i;
    ASSERT_EQ(got.fresnel, wanted.fresnel) << i;
    ASSERT_TRUE(same(got.direction, wanted.direction)) << i;
    if (!got.is_total) {
      ASSERT_LT(dot(got.direction, face), 0x1p-10f) << i;
    }
  }
  EXPECT_GT(about_face, 100);
}

TEST(Shares, NeverAddUpToMoreThanTheMaterials) {
  Rays rays;
  for (int i = 0; i < 100000; ++i) {
    MaterialRecord material{};
    material.specular = rays.fraction();
    material.transmittance = (1.0f - material.specular) * rays.fraction();
    for (float& part : material.transmitted) part = material.transmittance * rays.fraction();
    if (i % 3 == 0) std::fill_n(material.transmitted, 3, material.transmittance);
    const Vector3 n = rays.unit();
    const Refraction bent = refract(rays.against(n), n, rays.ratio());
    const double r = reflected_share(material, bent.fresnel);
    const Vector3 q = refracted_share(material, bent.fresnel);
    const double whole = static_cast<double>(material.specular) + material.transmittance;
    for (const float part : {q.x, q.y, q.z}) {
      ASSERT_GE(part, 0.0f);
      ASSERT_LE(r + part, whole + 0x1p-22);
      if (i % 3 == 0) {
        ASSERT_NEAR(r + part, whole, 0x1p-22) << "white glass loses nothing";
      }
    }
    if (bent.is_total) {
      ASSERT_EQ(q.x + q.y + q.z, 0.0f);
    }
  }
}

}  // namespace
}  // namespace gridiron::test
