// One lane: every operation is that of a lane among four, bit by bit. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/one_lane.h>

#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using One = Lanes<1>;
using Four = Lanes<4>;

std::uint32_t bits_of(float value) {
  return std::bit_cast<std::uint32_t>(value);
}
std::uint32_t bits_of(One::Float a) {
  return bits_of(a.v);
}
std::uint32_t bits_of(Four::Float a) {
  return bits_of(Four::lane(a, 2));
}
std::uint32_t bits_of(One::Int a) {
  return static_cast<std::uint32_t>(a.v);
}
std::uint32_t bits_of(Four::Int a) {
  return static_cast<std::uint32_t>(a[2]);
}
std::uint32_t bits_of(LaneMask<1> mask) {
  return mask.bits();
}
std::uint32_t bits_of(LaneMask<4> mask) {
  return mask.bits() >> 2 & 1u;
}

// Any finite float.
float random_float(TestRandom& random) {
  const auto word = static_cast<std::uint32_t>(random.next());
  const float value = std::bit_cast<float>(word);
  return std::isfinite(value) ? value : std::bit_cast<float>(word ^ 0x00800000u);
}

template <class L, class Operation>
std::uint32_t of_floats(const Operation& operation, float a, float b) {
  return bits_of(operation(L{}, typename L::Float(a), typename L::Float(b)));
}
template <class L, class Operation>
std::uint32_t of_words(const Operation& operation, std::uint32_t a, std::uint32_t b) {
  return bits_of(operation(L{}, L::Int::splat(a), L::Int::splat(b)));
}

TEST(OneLane, FloatsAreThoseOfALane) {
  for_each_seed(3000, [](TestRandom& random) {
    const float a = random_float(random), b = random.below(4) == 0 ? a : random_float(random);
    const auto expect_same = [&](const char* name, const auto& operation) {
      ASSERT_EQ(of_floats<One>(operation, a, b), of_floats<Four>(operation, a, b)) << name << " of " << a << ", " << b;
    };
    expect_same("min", [](auto l, auto x, auto y) { return l.min(x, y); });
    expect_same("max", [](auto l, auto x, auto y) { return l.max(x, y); });
    expect_same("larger_size", [](auto l, auto x, auto y) { return l.larger_size(x, y); });
    expect_same("square_root", [](auto l, auto x, auto) { return l.square_root(l.abs(x)); });
    expect_same("reciprocal_estimate", [](auto l, auto x, auto) { return l.reciprocal_estimate(x); });
    expect_same("turn_by", [](auto l, auto x, auto y) { return l.turn_by(x, y); });
    expect_same("words_of", [](auto l, auto x, auto) { return l.words_of(x); });
    expect_same("floats_of", [](auto l, auto x, auto) { return l.floats_of(l.words_of(x)); });
    expect_same("select", [](auto l, auto x, auto y) { return l.select(x < y, x, y); });
    expect_same("select of words",
                [](auto l, auto x, auto y) { return l.select(x < y, l.words_of(x), l.words_of(y)); });
    const float whole = random.between(-1e6f, 1e6f);
    ASSERT_EQ(One::truncate(One::Float(whole)).v, Four::truncate(Four::Float(whole))[2]) << whole;
    ASSERT_EQ(One::to_float(One::truncate(One::Float(whole))).v, std::trunc(whole));
  });
}

TEST(OneLane, WordsAreThoseOfALane) {
  for_each_seed(3000, [](TestRandom& random) {
    const auto a = static_cast<std::uint32_t>(random.next()) >> random.below(32);
    const auto b = static_cast<std::uint32_t>(random.next()) >> random.below(32);
    const int shift = static_cast<int>(random.below(32));
    const auto expect_same = [&](const char* name, const auto& operation) {
      ASSERT_EQ(of_words<One>(operation, a, b), of_words<Four>(operation, a, b)) << name << " of " << a << ", " << b;
    };
    expect_same("sum", [](auto, auto x, auto y) { return (x >> 1) + (y >> 2); });
    expect_same("or", [](auto, auto x, auto y) { return x | y; });
    expect_same("and", [](auto, auto x, auto y) { return x & y; });
    expect_same("left", [shift](auto, auto x, auto) { return x << shift; });
    expect_same("right", [shift](auto, auto x, auto) { return x >> shift; });
    expect_same("less", [](auto, auto x, auto y) { return x < y; });
    EXPECT_EQ(One::equal(a, &b).is_set, a == b);
    EXPECT_TRUE(One::equal(a, &a).is_set);
    std::uint32_t target[2] = {1, 2};
    One::compress(One::Int::splat(a), 1, target);
    EXPECT_EQ(target[0], a);
    One::store_quads(One::Int::splat(b), target, 64);
    EXPECT_EQ(target[0], b);
    EXPECT_EQ(target[1], 2u);
  });
}

}  // namespace
}  // namespace gridiron::test
