// What one operation of the kernel becomes on the chip, counted by hand from the table of tools/calibrate/README.md.
// SPDX-License-Identifier: Apache-2.0
#include <counted/counted.h>
#include <counted/lanes.h>
#include <gridiron/engine/grid/grid_work.h>

#include "support/test_headers.h"

namespace gridiron::calibrate {
namespace {

using gridiron_counted::Counted;
using CountedLanes = gridiron_counted::Lanes<4>;

/// Operations by class.
struct Operations {
  std::uint64_t floats = 0, doubles = 0, converts = 0, fixed = 0, shifts = 0, shuffles = 0, loads = 0, stores = 0;
  bool operator==(const Operations&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Operations& o) {
  return out << "float " << o.floats << " double " << o.doubles << " convert " << o.converts << " fixed " << o.fixed
             << " shift " << o.shifts << " shuffle " << o.shuffles << " load " << o.loads << " store " << o.stores;
}

template <class T>
struct Register {
  T value;
  [[nodiscard]] Counted<T> counted() const {
    return Counted<T>::made(value, gridiron_counted::emit(OpClass::kLoad, gridiron_counted::bits_of(value)));
  }
};

// In a frame of its own: what lies above the model's stack is no register.
template <class Run>
[[gnu::noinline]] void call(const Run& run) {
  run();
}

// Runs one operation and takes away the loads of its `operands` registers.
template <class Run>
Operations operations_of(std::uint64_t operands, const Run& run) {
  const int stack_base = 0;
  const Branches none;
  PipeModel model(&none);
  model.set_stack(&stack_base);
  model.add_units(GridWork::kCellStep, 1);
  call(run);
  const KindTotals totals = model.finish().totals[WorkId(GridWork::kCellStep).number()];
  const auto of = [&](OpClass op) { return totals.operations[static_cast<std::size_t>(op)]; };
  return {of(OpClass::kFloat), of(OpClass::kDouble),  of(OpClass::kConvert),         of(OpClass::kFixed),
          of(OpClass::kShift), of(OpClass::kShuffle), of(OpClass::kLoad) - operands, of(OpClass::kStore)};
}

template <class A, class B, class Run>
Operations of_two(A a, B b, const Run& run) {
  return operations_of(2, [&] {
    const Counted<A> x = Register<A>{a}.counted();
    const Counted<B> y = Register<B>{b}.counted();
    (void)run(x, y);
  });
}

constexpr auto kPlus = [](const auto& a, const auto& b) { return a + b; };
constexpr auto kTimes = [](const auto& a, const auto& b) { return a * b; };
constexpr auto kOver = [](const auto& a, const auto& b) { return a / b; };
constexpr auto kLess = [](const auto& a, const auto& b) { return (a < b).value; };

TEST(Counted, FloatsAddAndMultiplyInOneAndDivideInSeven) {
  EXPECT_EQ(of_two(1.5f, 2.0f, kPlus), (Operations{.floats = 1}));
  EXPECT_EQ(of_two(1.5f, 2.0f, kTimes), (Operations{.floats = 1}));
  EXPECT_EQ(of_two(1.5f, 2.0f, kOver), (Operations{.floats = 5, .converts = 1, .shuffles = 1}));
  EXPECT_EQ(of_two(1.5f, 2.0f, kLess), (Operations{.fixed = 1}));
}

TEST(Counted, DoublesDivideInElevenAndCompareAsIntegers) {
  EXPECT_EQ(of_two(1.5, 2.0, kPlus), (Operations{.doubles = 1}));
  EXPECT_EQ(of_two(1.5, 2.0, kOver), (Operations{.floats = 2, .doubles = 9, .converts = 1, .shuffles = 1}));
  EXPECT_EQ(of_two(1.5, 2.0, kLess), (Operations{.fixed = 5, .shuffles = 2}));
}

// One product where both operands fit 16 bits, else three and two additions; a shift by a constant power of two.
TEST(Counted, WordsMultiplyBySixteenBits) {
  EXPECT_EQ(of_two(65535u, 3u, kTimes), (Operations{.converts = 1}));
  EXPECT_EQ(of_two(65536u, 3u, kTimes), (Operations{.converts = 3, .fixed = 2}));
  EXPECT_EQ(of_two(3u, 65536u, kTimes), (Operations{.converts = 3, .fixed = 2}));
  EXPECT_EQ(of_two(-32768, 3, kTimes), (Operations{.converts = 1}));
  EXPECT_EQ(of_two(-32769, 3, kTimes), (Operations{.converts = 3, .fixed = 2}));
  const auto times_eight = operations_of(1, [] { (void)(Register<std::uint32_t>{5}.counted() * 8u); });
  EXPECT_EQ(times_eight, (Operations{.shifts = 1}));
}

TEST(Counted, LongsAddInThreeShiftInTwoAndMultiplyInFifteen) {
  constexpr std::uint64_t kLarge = std::uint64_t{1} << 40;
  EXPECT_EQ(of_two(kLarge, kLarge, kPlus), (Operations{.fixed = 2, .shuffles = 1}));
  const auto left = operations_of(1, [] { (void)(Register<std::uint64_t>{5}.counted() << 3); });
  EXPECT_EQ(left, (Operations{.shuffles = 2}));
  EXPECT_EQ(of_two(kLarge, kLarge, kLess), (Operations{.fixed = 3, .shuffles = 1}));
  const Operations product = of_two(std::uint64_t{70000}, std::uint64_t{80000}, kTimes);
  EXPECT_EQ(product, (Operations{.converts = 4, .fixed = 4, .shuffles = 5}));
}

// A mask's bits, the quotient of lanes, the least of two.
TEST(Counted, LanesTakeWhatAVectorTakes) {
  const auto of_lanes = [](const auto& run) {
    return operations_of(2, [&] {
      const CountedLanes::Float a{CountedLanes::Native::Float(1.5f), gridiron_counted::emit(OpClass::kLoad, 1)};
      const CountedLanes::Float b{CountedLanes::Native::Float(2.0f), gridiron_counted::emit(OpClass::kLoad, 2)};
      run(a, b);
    });
  };
  EXPECT_EQ(of_lanes([](auto a, auto b) { (void)(a * b); }), (Operations{.floats = 1}));
  EXPECT_EQ(of_lanes([](auto a, auto b) { (void)(a / b); }), (Operations{.floats = 5, .converts = 1, .shuffles = 1}));
  EXPECT_EQ(of_lanes([](auto a, auto b) { (void)(a < b).bits(); }), (Operations{.fixed = 1, .shuffles = 1}));
  EXPECT_EQ(of_lanes([](auto a, auto b) { (void)(a <= b).bits(); }), (Operations{.fixed = 2, .shuffles = 1}));
  EXPECT_EQ(of_lanes([](auto a, auto b) { (void)CountedLanes::min(a, b); }), (Operations{.fixed = 2}));
  EXPECT_EQ(of_lanes([](auto a, auto) { (void)-a; }), (Operations{.fixed = 1}));
  EXPECT_EQ(of_lanes([](auto a, auto) { (void)CountedLanes::square_root(a); }),
            (Operations{.floats = 7, .converts = 1, .shuffles = 1}));
}

// There is no access of less than 16 bytes.
TEST(Counted, ScalarsInTheStoreAreLoadedRotatedMaskedAndStored) {
  alignas(16) static constinit Counted<std::uint32_t> words[8];
  const auto in_store = [](const auto& run) {
    return operations_of(0, [&] {
      PipeModel::current().set_store(words, sizeof(words));
      run();
    });
  };
  EXPECT_EQ(in_store([] { (void)(words[0] + 1u); }), (Operations{.fixed = 1, .loads = 1}));
  EXPECT_EQ(in_store([] { (void)(words[1] + 1u); }), (Operations{.fixed = 1, .shuffles = 1, .loads = 1}));
  EXPECT_EQ(in_store([] { words[5] = Counted<std::uint32_t>(7u); }),
            (Operations{.shuffles = 2, .loads = 1, .stores = 1}));
}

}  // namespace
}  // namespace gridiron::calibrate
