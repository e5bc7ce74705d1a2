// Samples: the hash, places in pixels and on lights, directions over a point. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/effect_records.h>
#include <gridiron/shade/sample_points.h>

#include "support/test_headers.h"

namespace gridiron::test {
namespace {

std::uint32_t reversed_word(std::uint32_t s) {
  std::uint32_t result = 0;
  for (int bit = 0; bit < 32; ++bit) result |= (s >> bit & 1u) << (31 - bit);
  return result;
}

std::uint32_t random_word(std::mt19937& random) {
  return static_cast<std::uint32_t>(random());
}

Vector3 random_unit(std::mt19937& random) {
  std::normal_distribution<float> part;
  return normalized({part(random), part(random), part(random)});
}

double dot_of(Vector3 a, Vector3 b) {
  return static_cast<double>(a.x) * b.x + static_cast<double>(a.y) * b.y + static_cast<double>(a.z) * b.z;
}

TEST(Mix32, IsTheHashOfItsSource) {
  // The last ones were computed with integers without bounds.
  EXPECT_EQ(mix32(0u), 0u);
  EXPECT_EQ(mix32(0x1u), 0x688990c0u);
  EXPECT_EQ(mix32(0x2u), 0xd1132181u);
  EXPECT_EQ(mix32(0xdeadbeefu), 0xe628c683u);
  EXPECT_EQ(mix32(0xffffffffu), 0x6768824au);
}

TEST(Mix32, ChangesHalfTheBitsForEachBit) {
  std::mt19937 random(1);
  constexpr int kCount = 20000;
  for (std::uint32_t in = 0; in < 32; ++in) {
    int changed[32] = {};
    for (int i = 0; i < kCount; ++i) {
      const std::uint32_t word = random_word(random);
      const std::uint32_t difference = mix32(word) ^ mix32(word ^ 1u << in);
      for (int out = 0; out < 32; ++out) changed[out] += static_cast<int>(difference >> out & 1u);
    }
    // Six standard deviations are 0.021.
    for (int out = 0; out < 32; ++out) EXPECT_NEAR(changed[out] / double{kCount}, 0.5, 0.025) << in << " " << out;
  }
}

TEST(UnitFloat, IsExactAndBelowOne) {
  EXPECT_EQ(unit_float(0xFFu), 0.0f);
  EXPECT_EQ(unit_float(0x100u), 0x1p-24f);
  EXPECT_EQ(unit_float(0x80000000u), 0.5f);
  EXPECT_EQ(unit_float(0xFFFFFFFFu), 1.0f - 0x1p-24f);
}

TEST(Jitter, IsThatOfTheFormula) {
  const std::uint32_t seed = sample_seed(5, 3, 640 * 17 + 9);
  EXPECT_EQ(seed, mix32(mix32(mix32(5) + 3) + 640 * 17 + 9));
  const std::uint32_t key = mix32(seed + 2u * 0x9E3779B9u);
  const Jitter jitter = jitter_of(seed, area_light_purpose(1));
  EXPECT_EQ(jitter.j1, static_cast<float>(key >> 8) / 16777216.0f);
  EXPECT_EQ(jitter.j2, static_cast<float>(mix32(key + 1) >> 8) / 16777216.0f);
}

TEST(Jitter, IsEvenAndKnowsNothingOfItsNeighbours) {
  // Uncorrelated numbers: a correlation of n pairs has a deviation of 1 / sqrt(n) = 0.004.
  constexpr std::uint32_t kWidth = 256, kHeight = 256;
  const auto at = [](std::uint32_t path, std::uint32_t sample, std::uint32_t pixel, std::uint32_t purpose) {
    return jitter_of(sample_seed(path, sample, pixel), purpose);
  };
  double sum1 = 0, sum2 = 0, square1 = 0, square2 = 0;
  double pair = 0, next_pixel = 0, next_row = 0, next_sample = 0, next_path = 0, next_purpose = 0;
  for (std::uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel) {
    const Jitter here = at(1, 0, pixel, 0);
    const double a = here.j1 - 0.5, b = here.j2 - 0.5;
    sum1 += a;
    sum2 += b;
    square1 += a * a;
    square2 += b * b;
    pair += a * b;
    next_pixel += a * (at(1, 0, pixel + 1, 0).j1 - 0.5);
    next_row += a * (at(1, 0, pixel + kWidth, 0).j1 - 0.5);
    next_sample += a * (at(1, 1, pixel, 0).j1 - 0.5);
    next_path += a * (at(2, 0, pixel, 0).j1 - 0.5);
    next_purpose += a * (at(1, 0, pixel, 1).j1 - 0.5);
  }
  constexpr double kCount = kWidth * kHeight, kVariance = 1.0 / 12.0;
  EXPECT_NEAR(sum1 / kCount, 0.0, 0.006);
  EXPECT_NEAR(sum2 / kCount, 0.0, 0.006);
  EXPECT_NEAR(square1 / kCount, kVariance, 0.002);
  EXPECT_NEAR(square2 / kCount, kVariance, 0.002);
  for (const double products : {pair, next_pixel, next_row, next_sample, next_path, next_purpose}) {
    EXPECT_NEAR(products / kCount / kVariance, 0.0, 0.02);
  }
}

TEST(ReversedFraction, IsTheReversedWord) {
  for (std::uint32_t s = 0; s < 256; ++s) {
    EXPECT_EQ(static_cast<double>(reversed_fraction(s)), reversed_word(s) / 4294967296.0) << s;
  }
}

TEST(PixelOffset, IsThatOfTheTable) {
  EXPECT_EQ(pixel_offset(1, 0).dx, 0.0f);
  EXPECT_EQ(pixel_offset(1, 0).dy, 0.0f);
  const int p[4] = {1, 3, 0, 2};
  for (std::uint32_t s = 0; s < 4; ++s) {
    EXPECT_EQ(pixel_offset(4, s).dx, (static_cast<float>(s) + 0.5f) / 4.0f - 0.5f);
    EXPECT_EQ(pixel_offset(4, s).dy, (static_cast<float>(p[s]) + 0.5f) / 4.0f - 0.5f);
  }
  for (std::uint32_t s = 0; s < 16; ++s) {
    EXPECT_EQ(pixel_offset(16, s).dx, (static_cast<float>(s) + 0.5f) / 16.0f - 0.5f);
    EXPECT_EQ(pixel_offset(16, s).dy, (static_cast<float>(reversed_word(s) >> 28) + 0.5f) / 16.0f - 0.5f);
  }
}

TEST(PixelOffset, IsTheCentreOnAverageAndTakesEachRowOnce) {
  for (const std::uint32_t count : {1u, 4u, 16u}) {
    float dx = 0.0f, dy = 0.0f;
    std::set<float> rows;
    for (std::uint32_t s = 0; s < count; ++s) {
      const PixelOffset offset = pixel_offset(count, s);
      dx += offset.dx;
      dy += offset.dy;
      rows.insert(offset.dy);
    }
    EXPECT_EQ(dx, 0.0f);
    EXPECT_EQ(dy, 0.0f);
    EXPECT_EQ(rows.size(), count);
  }
}

TEST(AreaLightPlace, IsThatOfTheFormulaAndInTheSquare) {
  std::mt19937 random(1);
  const float last = 1.0f - 0x1p-24f;
  for (std::uint32_t count = 1; count <= kMaxEffectSamples; ++count) {
    for (std::uint32_t s = 0; s < count; ++s) {
      for (int i = 0; i < 20; ++i) {
        const Jitter jitter = i == 0   ? Jitter{0, 0}
                              : i == 1 ? Jitter{last, last}
                                       : Jitter{unit_float(random_word(random)), unit_float(random_word(random))};
        const SquarePlace place = area_light_place(s, count, jitter);
        ASSERT_GE(place.a, 0.0f);
        ASSERT_LE(place.a, 1.0f);
        ASSERT_GE(place.b, 0.0f);
        ASSERT_LT(place.b, 1.0f);
        ASSERT_NEAR(place.a, (s + static_cast<double>(jitter.j1)) / count, 0x1p-23);
        const double b = reversed_word(s) / 4294967296.0 + static_cast<double>(jitter.j2);
        // 2^-24 is lost at most, where the sum is rounded: never across 1.
        ASSERT_NEAR(place.b, b - std::floor(b), 0x1p-24) << count << " " << s << " " << i;
      }
    }
  }
}

TEST(Tangents, AreUnitAndPerpendicular) {
  std::mt19937 random(1);
  std::vector<Vector3> normals = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {1, 0, -0.0f}};
  for (const float tiny : {0x1p-10f, 0x1p-12f, 0x1p-20f, 0x1p-60f, 0x1p-126f}) {
    for (const float z : {1.0f, -1.0f}) {
      normals.push_back(normalized({tiny, tiny, z}));
      normals.push_back(normalized({1.0f, -tiny, tiny * z}));
    }
  }
  for (int i = 0; i < 200000; ++i) normals.push_back(random_unit(random));
  for (const Vector3 n : normals) {
    const Tangents t = tangents_of(n);
    // Those of the formula, not any: images depend on it. 1 / (g + z) is at most 1.
    const double x = n.x, y = n.y, z = n.z, g = z >= 0 ? 1 : -1, q = -1 / (g + z);
    ASSERT_NEAR(t.a.x, 1 + g * x * x * q, 0x1p-21);
    ASSERT_NEAR(t.a.y, g * x * y * q, 0x1p-21);
    ASSERT_NEAR(t.a.z, -g * x, 0x1p-21);
    ASSERT_NEAR(t.b.x, x * y * q, 0x1p-21);
    ASSERT_NEAR(t.b.y, g + y * y * q, 0x1p-21);
    ASSERT_NEAR(t.b.z, -y, 0x1p-21);
    ASSERT_NEAR(dot_of(t.a, t.a), 1.0, 0x1p-20) << n.x << " " << n.y << " " << n.z;
    ASSERT_NEAR(dot_of(t.b, t.b), 1.0, 0x1p-20) << n.x << " " << n.y << " " << n.z;
    ASSERT_NEAR(dot_of(t.a, t.b), 0.0, 0x1p-20) << n.x << " " << n.y << " " << n.z;
    ASSERT_NEAR(dot_of(t.a, n), 0.0, 0x1p-20) << n.x << " " << n.y << " " << n.z;
    ASSERT_NEAR(dot_of(t.b, n), 0.0, 0x1p-20) << n.x << " " << n.y << " " << n.z;
  }
}

TEST(OcclusionDirection, IsUnitAndThatOfTheFormula) {
  std::mt19937 random(1);
  const double pi = std::acos(-1.0);
  for (int i = 0; i < 200000; ++i) {
    const Vector3 n = random_unit(random);
    const std::uint32_t count = 1 + random_word(random) % kMaxEffectSamples, s = random_word(random) % count;
    const Jitter jitter{unit_float(random_word(random)), unit_float(random_word(random))};
    const Vector3 d = occlusion_direction(s, count, jitter, n);
    ASSERT_NEAR(std::sqrt(dot_of(d, d)), 1.0, 0x1p-20);
    const double turn = (s + static_cast<double>(jitter.j1)) / count;
    const double sum = reversed_word(s) / 4294967296.0 + static_cast<double>(jitter.j2);
    // Roots magnify the rounding of u near 0 and 1, angles do so of the tangents'.
    const double u = sum - std::floor(sum), r = std::sqrt(u);
    const double slack = 0x1p-21 + 0x1p-25 / std::max(std::min(r, std::sqrt(1.0 - u)), 0x1p-12);
    const Tangents t = tangents_of(n);
    ASSERT_NEAR(dot_of(d, t.a), r * std::cos(2 * pi * turn), slack + 0x1p-20);
    ASSERT_NEAR(dot_of(d, t.b), r * std::sin(2 * pi * turn), slack + 0x1p-20);
    ASSERT_NEAR(dot_of(d, n), std::sqrt(1.0 - u), slack + 0x1p-20);
  }
}

TEST(OcclusionDirection, IsSpreadAsTheCosine) {
  // Cosines c over the normal have density 2 c: mean 2/3, mean of squares 1/2; sideways means are 0, squares 1/4.
  const Vector3 n = normalized({1, -2, 0.5f});
  const Tangents t = tangents_of(n);
  for (const std::uint32_t count : {1u, 5u, 16u, 64u}) {
    double cosine = 0, square = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    int directions = 0;
    for (std::uint32_t pixel = 0; directions < 400000; ++pixel) {
      const Jitter jitter = jitter_of(sample_seed(1, 0, pixel), kOcclusionPurpose);
      for (std::uint32_t s = 0; s < count; ++s, ++directions) {
        const Vector3 d = occlusion_direction(s, count, jitter, n);
        const double c = dot_of(d, n), da = dot_of(d, t.a), db = dot_of(d, t.b);
        cosine += c;
        square += c * c;
        a += da;
        b += db;
        aa += da * da;
        bb += db * db;
        ab += da * db;
      }
    }
    EXPECT_NEAR(cosine / directions, 2.0 / 3.0, 0.004) << count;
    EXPECT_NEAR(square / directions, 0.5, 0.004) << count;
    EXPECT_NEAR(a / directions, 0.0, 0.005) << count;
    EXPECT_NEAR(b / directions, 0.0, 0.005) << count;
    EXPECT_NEAR(aa / directions, 0.25, 0.004) << count;
    EXPECT_NEAR(bb / directions, 0.25, 0.004) << count;
    EXPECT_NEAR(ab / directions, 0.0, 0.004) << count;
  }
}

}  // namespace
}  // namespace gridiron::test
