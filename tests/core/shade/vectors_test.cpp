// Vectors of the effects: unit vectors of vectors of any size. SPDX-License-Identifier: Apache-2.0
#include <gridiron/shade/vectors.h>

#include "support/test_headers.h"

namespace gridiron::test {
namespace {

TEST(Vectors, GoToArraysAndBack) {
  const float source[3] = {1.0f, -2.0f, 3.5f};
  float target[3];
  store(2.0f * (vector_of(source) + Vector3{0.5f, 0.25f, 0.125f}) - Vector3{1, 1, 1}, target);
  EXPECT_EQ(target[0], 2.0f);
  EXPECT_EQ(target[1], -4.5f);
  EXPECT_EQ(target[2], 6.25f);
  EXPECT_EQ(dot(vector_of(source), Vector3{2, 3, 4}), 10.0f);
}

TEST(Normalized, IsUnitWhateverTheSize) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  for (int power = -148; power <= 127; ++power) {
    for (int i = 0; i < 2000; ++i) {
      const double size = std::ldexp(1.0, power);
      const float spread = i % 3 == 0 ? 0x1p-20f : 1.0f;  // thin ones too
      const Vector3 a{static_cast<float>(part(random) * size), static_cast<float>(part(random) * size) * spread,
                      static_cast<float>(part(random) * size) * spread};
      const double x = a.x, y = a.y, z = a.z;
      const double length = std::sqrt(x * x + y * y + z * z);
      if (length == 0.0) continue;
      const Vector3 unit = normalized(a);
      ASSERT_NEAR(unit.x, x / length, 0x1p-22) << power << " " << i;
      ASSERT_NEAR(unit.y, y / length, 0x1p-22) << power << " " << i;
      ASSERT_NEAR(unit.z, z / length, 0x1p-22) << power << " " << i;
      const double ux = unit.x, uy = unit.y, uz = unit.z;
      ASSERT_NEAR(std::sqrt(ux * ux + uy * uy + uz * uz), 1.0, 0x1p-21) << power << " " << i;
    }
  }
}

TEST(Normalized, IsUnitForTheGreatestFloats) {
  const float most = std::numeric_limits<float>::max();
  const Vector3 unit = normalized({most, -most, most});
  EXPECT_NEAR(unit.x, std::sqrt(1.0 / 3.0), 0x1p-22);
  EXPECT_NEAR(unit.y, -std::sqrt(1.0 / 3.0), 0x1p-22);
  EXPECT_EQ(normalized({0.0f, most, 0.0f}).y, 1.0f);
}

TEST(Normalized, LeavesTheZeroVector) {
  const Vector3 unit = normalized({0.0f, -0.0f, 0.0f});
  EXPECT_EQ(unit.x, 0.0f);
  EXPECT_EQ(unit.y, 0.0f);
  EXPECT_EQ(unit.z, 0.0f);
}

}  // namespace
}  // namespace gridiron::test
