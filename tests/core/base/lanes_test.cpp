// Lanes: every operation on W lanes is the same operation on each float alone.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/lanes.h>

#include "core/lane_types.h"
#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kSamples[] = {
    0.0f,           -0.0f,     1.0f,       -1.0f,    0.5f,  3.0f,   -2.75f,          0x1p-149f,        -0x1p-149f,
    1e-40f,         0x1p-126f, -0x1p-126f, 0x1p-60f, 1e30f, -1e30f, 0x1.fffffep127f, -0x1.fffffep127f, 0x1.000002p0f,
    0x1.fffffep-1f, kInfinity, -kInfinity, kNaN};
constexpr std::size_t kSampleCount = std::size(kSamples);

// Same bits, or both NaN: which NaN an operation returns is not specified.
testing::AssertionResult same(float actual, float expected) {
  const bool equal = std::isnan(expected)
                         ? std::isnan(actual)
                         : std::bit_cast<std::uint32_t>(actual) == std::bit_cast<std::uint32_t>(expected);
  if (equal) return testing::AssertionSuccess();
  return testing::AssertionFailure() << std::hexfloat << actual << " instead of " << expected;
}

template <class L>
class LanesTest : public testing::Test {
 protected:
  static constexpr std::size_t kWidth = L::kCount;
  using Array = std::array<float, kWidth>;
  struct alignas(64) Memory {
    Array values;
  };

  static typename L::Float load(const Array& values) {
    const Memory memory{values};
    return L::Float::load(memory.values.data());
  }
  static Array store(typename L::Float lanes) {
    Memory memory{};
    lanes.store(memory.values.data());
    return memory.values;
  }

  // Calls body(a, b) with arrays in which every pair of samples is in every lane at least once.
  template <class Body>
  static void for_each_pair(Body&& body) {
    for (std::size_t shift = 0; shift < kSampleCount; ++shift) {
      for (std::size_t first = 0; first < kSampleCount; ++first) {
        Array a, b;
        for (std::size_t i = 0; i < kWidth; ++i) {
          a[i] = kSamples[(first + i) % kSampleCount];
          b[i] = kSamples[(first + i + shift) % kSampleCount];
        }
        body(a, b);
      }
    }
  }

  template <class VectorOperation, class ScalarOperation>
  static void expect_same(VectorOperation&& of_lanes, ScalarOperation&& of_floats, const char* name) {
    for_each_pair([&](const Array& a, const Array& b) {
      const Array result = store(of_lanes(load(a), load(b)));
      for (std::size_t i = 0; i < kWidth; ++i) {
        ASSERT_TRUE(same(result[i], of_floats(a[i], b[i]))) << name << " of " << a[i] << ", " << b[i] << ", lane " << i;
      }
    });
  }

  template <class VectorOperation, class ScalarOperation>
  static void expect_same_truth(VectorOperation&& of_lanes, ScalarOperation&& of_floats, const char* name) {
    for_each_pair([&](const Array& a, const Array& b) {
      const std::uint32_t bits = of_lanes(load(a), load(b)).bits();
      ASSERT_EQ(bits & ~L::kAllBits, 0u) << name;
      for (std::size_t i = 0; i < kWidth; ++i) {
        ASSERT_EQ((bits >> i & 1u) != 0, of_floats(a[i], b[i]))
            << name << " of " << a[i] << ", " << b[i] << ", lane " << i;
      }
    });
  }
};

TYPED_TEST_SUITE(LanesTest, LaneTypes, LaneNames);

TYPED_TEST(LanesTest, ArithmeticIsThatOfEachLane) {
  this->expect_same([](auto a, auto b) { return a + b; }, [](float a, float b) { return a + b; }, "sum");
  this->expect_same([](auto a, auto b) { return a - b; }, [](float a, float b) { return a - b; }, "difference");
  this->expect_same([](auto a, auto b) { return a * b; }, [](float a, float b) { return a * b; }, "product");
  this->expect_same([](auto a, auto b) { return a / b; }, [](float a, float b) { return a / b; }, "quotient");
  this->expect_same([](auto a, auto) { return -a; }, [](float a, float) { return -a; }, "negative");
  this->expect_same([](auto a, auto) { return TypeParam::abs(a); }, [](float a, float) { return std::fabs(a); }, "abs");
}

TYPED_TEST(LanesTest, MinAndMaxTakeTheSecondWhereNothingIsLess) {
  this->expect_same([](auto a, auto b) { return TypeParam::min(a, b); }, [](float a, float b) { return a < b ? a : b; },
                    "min");
  this->expect_same([](auto a, auto b) { return TypeParam::max(a, b); }, [](float a, float b) { return a > b ? a : b; },
                    "max");
}

TYPED_TEST(LanesTest, ComparesAndNaNIsNeverTrue) {
  this->expect_same_truth([](auto a, auto b) { return a < b; }, [](float a, float b) { return a < b; }, "<");
  this->expect_same_truth([](auto a, auto b) { return a > b; }, [](float a, float b) { return a > b; }, ">");
  this->expect_same_truth([](auto a, auto b) { return a <= b; }, [](float a, float b) { return a <= b; }, "<=");
  this->expect_same_truth([](auto a, auto b) { return a >= b; }, [](float a, float b) { return a >= b; }, ">=");
  using Float = typename TypeParam::Float;
  for (const float other : kSamples) {
    const Float nan(kNaN), value(other);
    EXPECT_EQ(((nan < value) | (nan <= value) | (nan > value) | (nan >= value)).bits(), 0u) << other;
    EXPECT_EQ(((value < nan) | (value <= nan) | (value > nan) | (value >= nan)).bits(), 0u) << other;
  }
}

TYPED_TEST(LanesTest, BroadcastKeepsEveryValueAndTheSignOfZero) {
  for (const float value : kSamples) {
    const auto lanes = this->store(typename TypeParam::Float(value));
    for (const float lane : lanes) EXPECT_TRUE(same(lane, value));
  }
}

TYPED_TEST(LanesTest, MaskBitsRoundTrip) {
  constexpr std::uint32_t kLast = TypeParam::kAllBits;
  EXPECT_EQ(std::popcount(kLast), TypeParam::kCount);
  for (std::uint32_t bits = 0; bits <= kLast; ++bits) {
    const auto mask = TypeParam::mask_from_bits(bits);
    ASSERT_EQ(mask.bits(), bits);
    const std::uint32_t other = (bits * 0x9E3779B9u >> 7) & kLast;
    const auto other_mask = TypeParam::mask_from_bits(other);
    ASSERT_EQ((mask & other_mask).bits(), bits & other);
    ASSERT_EQ((mask | other_mask).bits(), bits | other);
  }
}

TYPED_TEST(LanesTest, SelectTakesTheFirstWhereTheMaskIsSet) {
  TestRandom random(3);
  this->for_each_pair([&](const auto& a, const auto& b) {
    const auto bits = static_cast<std::uint32_t>(random.next()) & TypeParam::kAllBits;
    const auto result = this->store(TypeParam::select(TypeParam::mask_from_bits(bits), this->load(a), this->load(b)));
    for (std::size_t i = 0; i < result.size(); ++i) {
      ASSERT_TRUE(same(result[i], (bits >> i & 1u) != 0 ? a[i] : b[i])) << "lane " << i << " of mask " << bits;
    }
  });
}

TYPED_TEST(LanesTest, FlipSignFlipsItWhereTheMaskIsSet) {
  TestRandom random(4);
  this->for_each_pair([&](const auto& a, const auto&) {
    const auto bits = static_cast<std::uint32_t>(random.next()) & TypeParam::kAllBits;
    const auto result = this->store(TypeParam::flip_sign(TypeParam::mask_from_bits(bits), this->load(a)));
    for (std::size_t i = 0; i < result.size(); ++i) {
      ASSERT_TRUE(same(result[i], (bits >> i & 1u) != 0 ? -a[i] : a[i])) << "lane " << i << " of mask " << bits;
    }
  });
}

TYPED_TEST(LanesTest, QuadsAreLoadedAndRearrangedAlike) {
  constexpr std::size_t kQuads = TypeParam::kCount / 4;
  struct alignas(16) Quad {
    float values[4];
  };
  Quad quads[kQuads][2];
  const float* first[kQuads];
  const float* second[kQuads];
  for (std::size_t quad = 0; quad < kQuads; ++quad) {
    for (std::size_t i = 0; i < 4; ++i) {
      quads[quad][0].values[i] = static_cast<float>(10 * quad + i);
      quads[quad][1].values[i] = static_cast<float>(100 + 10 * quad + i);
    }
    first[quad] = quads[quad][0].values;
    second[quad] = quads[quad][1].values;
  }
  const auto a = TypeParam::load_quads(first);
  const auto b = TypeParam::load_quads(second);
  const auto loaded = this->store(a);
  const auto from_both = this->store(TypeParam::template shuffle_quads<2, 5, 7, 0>(a, b));
  const auto from_one = this->store(TypeParam::template shuffle_quads<1, 2, 0, 0>(a));
  for (std::size_t quad = 0; quad < kQuads; ++quad) {
    const auto base = static_cast<float>(10 * quad);
    const float expected_both[4] = {base + 2, 100 + base + 1, 100 + base + 3, base};
    const float expected_one[4] = {base + 1, base + 2, base, base};
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(loaded[4 * quad + i], base + static_cast<float>(i));
      EXPECT_EQ(from_both[4 * quad + i], expected_both[i]);
      EXPECT_EQ(from_one[4 * quad + i], expected_one[i]);
    }
  }
}

TYPED_TEST(LanesTest, HalfBitsAreTheSigns) {
  constexpr int kHalf = TypeParam::kCount / 2;
  constexpr std::int64_t kNegative[] = {-1, std::numeric_limits<std::int64_t>::min(), -0x100000000};
  constexpr std::int64_t kOther[] = {0, std::numeric_limits<std::int64_t>::max(), 0x80000000};
  for (std::uint32_t bits = 0; bits < (1u << kHalf); ++bits) {
    for (int kind = 0; kind < 3; ++kind) {
      typename TypeParam::LongVector vector{};
      for (int i = 0; i < kHalf; ++i) vector[i] = (bits >> i & 1u) != 0 ? kNegative[kind] : kOther[kind];
      ASSERT_EQ(TypeParam::half_bits({vector}), bits);
    }
  }
}

TYPED_TEST(LanesTest, HorizontalExtremesAreThoseOfAllLanes) {
  for_each_seed(2000, [&](TestRandom& random) {
    typename TestFixture::Array values;
    for (float& value : values) value = random.between(-1.0f, 1.0f) * (random.below(2) != 0 ? 1.0f : 1e30f);
    float least = values[0];
    float largest = values[0];
    for (const float value : values) {
      least = std::fmin(least, value);
      largest = std::fmax(largest, value);
    }
    EXPECT_EQ(TypeParam::horizontal_min(this->load(values)), least);
    EXPECT_EQ(TypeParam::horizontal_max(this->load(values)), largest);
  });
}

// Words that are hard for signed and unsigned alike, one of them more often.
std::uint32_t random_word(TestRandom& random) {
  constexpr std::uint32_t kWords[] = {0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x3F800000, 0x7FC00000, 0xFFC00001};
  return random.below(3) == 0 ? static_cast<std::uint32_t>(random.next()) : kWords[random.below(8)];
}

template <std::size_t kCount>
struct alignas(64) Words {
  std::uint32_t values[kCount];
};

template <std::size_t kCount>
Words<kCount> random_words(TestRandom& random) {
  Words<kCount> words;
  for (std::uint32_t& word : words.values) word = random_word(random);
  return words;
}

TYPED_TEST(LanesTest, WordsAreThoseOfEachLane) {
  using Int = typename TypeParam::Int;
  constexpr std::size_t kLanes = TypeParam::kCount;
  for_each_seed(2000, [&](TestRandom& random) {
    const auto a = random_words<kLanes>(random), b = random_words<kLanes>(random);
    const std::uint32_t word = random_word(random);
    const Int first = Int::load(a.values), second = Int::load(b.values);
    const int shift = static_cast<int>(random.below(32));
    Words<kLanes> copied{}, joined{}, shifted{}, splat{};
    first.store(copied.values);
    (first | second).store(joined.values);
    (first << shift).store(shifted.values);
    Int::splat(word).store(splat.values);
    const std::uint32_t less = (first < second).bits();
    const std::uint32_t equal = TypeParam::equal(word, a.values).bits();
    const auto mask = static_cast<std::uint32_t>(random.next()) & TypeParam::kAllBits;
    Words<kLanes> chosen{}, where = a;
    TypeParam::select(TypeParam::mask_from_bits(mask), first, second).store(chosen.values);
    TypeParam::store_where(TypeParam::mask_from_bits(mask), word, where.values);
    ASSERT_EQ((less | equal) & ~TypeParam::kAllBits, 0u);
    for (std::size_t i = 0; i < kLanes; ++i) {
      const bool is_set = (mask >> i & 1u) != 0;
      ASSERT_EQ(first[static_cast<int>(i)], static_cast<std::int32_t>(a.values[i]));
      ASSERT_EQ(copied.values[i], a.values[i]);
      ASSERT_EQ(joined.values[i], a.values[i] | b.values[i]);
      ASSERT_EQ(shifted.values[i], a.values[i] << shift);
      ASSERT_EQ(splat.values[i], word);
      ASSERT_EQ((less >> i & 1u) != 0, static_cast<std::int32_t>(a.values[i]) < static_cast<std::int32_t>(b.values[i]));
      ASSERT_EQ((equal >> i & 1u) != 0, a.values[i] == word);
      ASSERT_EQ(chosen.values[i], is_set ? a.values[i] : b.values[i]);
      ASSERT_EQ(where.values[i], is_set ? word : a.values[i]);
    }
  });
}

TYPED_TEST(LanesTest, QuadsAreStoredAStrideApart) {
  constexpr std::uint32_t kLanes = TypeParam::kCount;
  constexpr std::uint32_t kUntouched = 0xA5A5A5A5u;
  TestRandom random(7);
  for (const std::uint32_t stride : {4u, 8u, 32u, 64u}) {
    const auto words = random_words<kLanes>(random);
    Words<256> target;
    std::ranges::fill(target.values, kUntouched);
    TypeParam::store_quads(TypeParam::Int::load(words.values), target.values + 4, stride);
    struct alignas(64) {
      float values[256];
    } floats;
    std::ranges::fill(floats.values, std::bit_cast<float>(kUntouched));
    typename TypeParam::FloatVector lanes;
    for (std::uint32_t i = 0; i < kLanes; ++i) lanes[i] = std::bit_cast<float>(words.values[i]);
    TypeParam::store_quads(typename TypeParam::Float(lanes), floats.values + 4, stride);
    std::vector<std::uint32_t> expected(256, kUntouched);
    for (std::uint32_t i = 0; i < kLanes; ++i) expected[4 + i / 4 * stride + i % 4] = words.values[i];
    for (std::size_t i = 0; i < 256; ++i) {
      ASSERT_EQ(target.values[i], expected[i]) << "word " << i << ", stride " << stride;
      ASSERT_EQ(std::bit_cast<std::uint32_t>(floats.values[i]), expected[i]) << "float " << i << ", stride " << stride;
    }
  }
}

TYPED_TEST(LanesTest, SquareRootsAndWholePartsAreThoseOfEachLane) {
  this->expect_same([](auto a, auto) { return TypeParam::square_root(a); }, [](float a, float) { return std::sqrt(a); },
                    "square root");
  for_each_seed(2000, [&](TestRandom& random) {
    typename TestFixture::Array values, roots;
    for (float& value : values) value = std::ldexp(random.unit(), static_cast<int>(random.below(250)) - 125);
    roots = this->store(TypeParam::square_root(this->load(values)));
    for (std::size_t i = 0; i < values.size(); ++i) {
      // A float's square root in double is precise enough to be rounded a second time (2 * 24 + 2 <= 53 bits).
      ASSERT_TRUE(same(roots[i], static_cast<float>(std::sqrt(double{values[i]}))));
    }
    for (float& value : values) value = random.between(-1, 1) * std::ldexp(1.0f, static_cast<int>(random.below(31)));
    const auto whole = TypeParam::truncate(this->load(values));
    for (std::size_t i = 0; i < values.size(); ++i) {
      ASSERT_EQ(whole[static_cast<int>(i)], static_cast<std::int32_t>(values[i]));
      ASSERT_EQ(TypeParam::lane(this->load(values), static_cast<std::uint32_t>(i)), values[i]);
    }
  });
}

TEST(CountBits, IsThePopulationCount) {
  for (std::uint32_t bits = 0; bits < 65536; ++bits) {
    ASSERT_EQ(count_bits(bits), static_cast<std::uint32_t>(std::popcount(bits)));
    ASSERT_EQ(count_bits(bits << 16), static_cast<std::uint32_t>(std::popcount(bits)));
  }
  TestRandom random(5);
  for (int i = 0; i < 100000; ++i) {
    const auto bits = static_cast<std::uint32_t>(random.next());
    ASSERT_EQ(count_bits(bits), static_cast<std::uint32_t>(std::popcount(bits))) << bits;
  }
  EXPECT_EQ(count_bits(0xFFFFFFFFu), 32u);
}

TEST(SquareRoot, IsTheNearestFloat) {
  TestRandom random(9);
  for (int i = 0; i < 100000; ++i) {
    const float value = std::bit_cast<float>(static_cast<std::uint32_t>(random.next()) & 0x7F7FFFFFu);
    // A float's square root in double is precise enough to be rounded a second time (2 * 24 + 2 <= 53 bits).
    ASSERT_EQ(square_root(value), static_cast<float>(std::sqrt(double{value}))) << std::hexfloat << value;
  }
  EXPECT_TRUE(same(square_root(-0.0f), -0.0f));
  EXPECT_TRUE(same(square_root(0x1p-149f), static_cast<float>(std::sqrt(0x1p-149))));
  EXPECT_EQ(square_root(2.0), std::sqrt(2.0));
}

}  // namespace
}  // namespace gridiron::test
