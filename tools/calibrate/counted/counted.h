// Counted<T>: a number that tells the pipe model what is done with it. Same size and bytes as T, so that records in
// memory are read as they are; where its value comes from is kept by address, in the model.
// What one operation takes on a chip without scalar units, 64-bit integers, division or double compare is written
// beside it. Memory: values. Threads: the model's. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pipe_model.h>

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

namespace gridiron_counted {

using gridiron::calibrate::Node;
using gridiron::calibrate::OpClass;
using gridiron::calibrate::PipeModel;
using gridiron::calibrate::Site;

template <class T>
concept Arithmetic = std::is_arithmetic_v<T>;

template <Arithmetic T>
constexpr std::uint64_t bits_of(T value) {
  if constexpr (std::is_same_v<T, float>)
    return std::bit_cast<std::uint32_t>(value);
  else if constexpr (std::is_same_v<T, double>)
    return std::bit_cast<std::uint64_t>(value);
  else
    return static_cast<std::uint64_t>(value);
}

inline Node emit(OpClass op, std::uint64_t tie, Node a = 0, Node b = 0, Node c = 0) {
  return PipeModel::current().emit(op, tie, a, b, c);
}

/// Truth of a comparison.
struct CountedBool {
  bool value;
  Node node;
  constexpr operator bool() const {
    if (!std::is_constant_evaluated()) PipeModel::current().use_condition(value, node);
    return value;
  }
  constexpr CountedBool operator!() const { return {!value, node}; }
};

// --- What one operation becomes --------------------------------------------------------------------------------------

// 1/x: estimate, interpolation, Newton step (2); a/x: product, and one step with the remainder (2).
inline Node divide_floats(Node a, Node b, std::uint64_t tie) {
  const Node estimate = emit(OpClass::kShuffle, tie, b);
  const Node better = emit(OpClass::kConvert, tie, b, estimate);
  const Node error = emit(OpClass::kFloat, tie, better, b);
  const Node reciprocal = emit(OpClass::kFloat, tie + 1, error, better);
  const Node quotient = emit(OpClass::kFloat, tie + 2, a, reciprocal);
  const Node rest = emit(OpClass::kFloat, tie + 3, quotient, a, b);
  return emit(OpClass::kFloat, tie + 4, rest, reciprocal, quotient);
}

// Estimate of 1/sqrt, interpolation, Newton step (3), product, one step with the remainder (2).
inline Node root_of_float(Node a, std::uint64_t tie) {
  const Node estimate = emit(OpClass::kShuffle, tie, a);
  const Node better = emit(OpClass::kConvert, tie, a, estimate);
  const Node half = emit(OpClass::kFloat, tie, a);
  const Node square = emit(OpClass::kFloat, tie + 1, better, half);
  const Node error = emit(OpClass::kFloat, tie + 2, square, better);
  const Node reciprocal = emit(OpClass::kFloat, tie + 3, error, better);
  const Node root = emit(OpClass::kFloat, tie + 4, a, reciprocal);
  const Node rest = emit(OpClass::kFloat, tie + 5, root, a);
  return emit(OpClass::kFloat, tie + 6, rest, reciprocal, root);
}

// To float, estimate, interpolation, Newton step; to double, two Newton steps (4), product, step with remainder (2).
inline Node divide_doubles(Node a, Node b, std::uint64_t tie) {
  const Node single = emit(OpClass::kDouble, tie, b);
  const Node estimate = emit(OpClass::kShuffle, tie, single);
  const Node better = emit(OpClass::kConvert, tie, single, estimate);
  const Node error = emit(OpClass::kFloat, tie, better, single);
  const Node reciprocal = emit(OpClass::kFloat, tie + 1, error, better);
  Node wide = emit(OpClass::kDouble, tie + 1, reciprocal);
  for (std::uint64_t step = 0; step < 2; ++step) {
    const Node wide_error = emit(OpClass::kDouble, tie + 2 + step, wide, b);
    wide = emit(OpClass::kDouble, tie + 4 + step, wide_error, wide);
  }
  const Node quotient = emit(OpClass::kDouble, tie + 6, a, wide);
  const Node rest = emit(OpClass::kDouble, tie + 7, quotient, a, b);
  return emit(OpClass::kDouble, tie + 8, rest, wide, quotient);
}

// As a division, with Newton steps of three operations: in float, then twice in double.
inline Node root_of_double(Node a, std::uint64_t tie) {
  const Node single = emit(OpClass::kDouble, tie, a);
  const Node reciprocal = root_of_float(single, tie);
  Node wide = emit(OpClass::kDouble, tie + 1, reciprocal);
  for (std::uint64_t step = 0; step < 2; ++step) {
    const Node square = emit(OpClass::kDouble, tie + 2 + step, wide, a);
    const Node error = emit(OpClass::kDouble, tie + 4 + step, square, wide);
    wide = emit(OpClass::kDouble, tie + 6 + step, error, wide);
  }
  const Node root = emit(OpClass::kDouble, tie + 8, a, wide);
  const Node rest = emit(OpClass::kDouble, tie + 9, root, a);
  return emit(OpClass::kDouble, tie + 10, rest, wide, root);
}

// No compare of doubles: as integers of 64 bits (below), after turning the negative ones around (3 for both).
inline Node compare_doubles(Node a, Node b, std::uint64_t tie) {
  const Node sign_a = emit(OpClass::kShuffle, tie, a);
  const Node turned = emit(OpClass::kFixed, tie, a, b, sign_a);
  const Node high = emit(OpClass::kFixed, tie + 1, turned);
  const Node equal = emit(OpClass::kFixed, tie + 2, turned);
  const Node low = emit(OpClass::kFixed, tie + 3, turned);
  const Node moved = emit(OpClass::kShuffle, tie + 4, low);
  return emit(OpClass::kFixed, tie + 5, high, equal, moved);
}

// Sum or difference of 64 bits: carries of the words, moved up by a shuffle, extended add (the low words' beside it).
inline Node add_longs(Node a, Node b, std::uint64_t tie) {
  const Node carry = emit(OpClass::kFixed, tie, a, b);
  const Node moved = emit(OpClass::kShuffle, tie, carry);
  return emit(OpClass::kFixed, tie + 1, a, b, moved);
}

inline Node compare_longs(Node a, Node b, std::uint64_t tie, bool equality) {
  const Node equal = emit(OpClass::kFixed, tie, a, b);
  if (equality) return emit(OpClass::kShuffle, tie, equal);  // gather both words' bits
  const Node greater = emit(OpClass::kFixed, tie + 1, a, b);
  const Node moved = emit(OpClass::kShuffle, tie + 1, greater);
  return emit(OpClass::kFixed, tie + 2, greater, equal, moved);
}

// By bits, then by bytes; to the right the counts are negated first; of signed ones the sign is spread and put in.
inline Node shift_long(Node a, Node count, std::uint64_t tie, bool right, bool with_sign) {
  const Node amount = right ? emit(OpClass::kFixed, tie, count) : count;
  const Node bits = emit(OpClass::kShuffle, tie, a, amount);
  const Node bytes = emit(OpClass::kShuffle, tie + 1, bits, amount);
  if (!with_sign) return bytes;
  const Node sign = emit(OpClass::kShift, tie, a);
  return emit(OpClass::kFixed, tie + 1, bytes, sign);
}

// Multipliers are of 16 bits: one product where both operands fit, else two cross products and a low one, two
// additions.
inline Node multiply_words(Node a, Node b, std::uint64_t tie, bool fits) {
  if (fits) return emit(OpClass::kConvert, tie, a, b);
  const Node cross = emit(OpClass::kConvert, tie, a, b);
  const Node other = emit(OpClass::kConvert, tie + 1, b, a);
  const Node low = emit(OpClass::kConvert, tie + 2, a, b);
  const Node sum = emit(OpClass::kFixed, tie, cross, other);
  return emit(OpClass::kFixed, tie + 1, sum, low);
}

// 32 x 32 to 64 bits: four products of 16 bits, of which two are shifted into place, and two additions of 64 bits.
inline Node multiply_to_long(Node a, Node b, std::uint64_t tie) {
  const Node low = emit(OpClass::kConvert, tie, a, b);
  const Node high = emit(OpClass::kConvert, tie + 1, a, b);
  const Node cross = emit(OpClass::kConvert, tie + 2, a, b);
  const Node other = emit(OpClass::kConvert, tie + 3, b, a);
  const Node base = emit(OpClass::kShuffle, tie, low, high);
  const Node moved = emit(OpClass::kShuffle, tie + 1, cross);
  const Node other_moved = emit(OpClass::kShuffle, tie + 2, other);
  return add_longs(add_longs(base, moved, tie + 4), other_moved, tie + 8);
}

// --- The number -----------------------------------------------------------------------------------------------------

template <Arithmetic T>
struct Counted;

template <class T>
struct PlainOf {
  using type = T;
};
template <class T>
struct PlainOf<Counted<T>> {
  using type = T;
};
template <class T>
using Plain = typename PlainOf<std::remove_cvref_t<T>>::type;
template <class T>
concept IsCounted = !std::is_same_v<Plain<T>, std::remove_cvref_t<T>>;
template <class A, class B>
concept CountedPair = (IsCounted<A> || IsCounted<B>)&&Arithmetic<Plain<A>>&& Arithmetic<Plain<B>>;

template <class T>
constexpr auto plain(const T& value) {
  if constexpr (IsCounted<T>)
    return value.value;
  else
    return value;
}

template <class To, class From>
Node convert_node(Node node, std::uint64_t tie) {
  if (std::is_same_v<To, From> || node == 0) return node;
  if constexpr (std::is_same_v<To, double> || std::is_same_v<From, double>) {
    return emit(OpClass::kDouble, tie, node);  // extend, round; integers by way of float
  } else if constexpr (std::is_floating_point_v<To> || std::is_floating_point_v<From>) {
    return emit(OpClass::kConvert, tie, node);
  } else if constexpr (sizeof(To) > sizeof(From)) {
    return emit(OpClass::kFixed, tie, node);  // sign or zero extended
  } else if constexpr (sizeof(To) < sizeof(From)) {
    return emit(OpClass::kShuffle, tie, node);  // low word to where scalars live
  } else {
    return node;
  }
}

template <class T>
Node node_of(const T& value) {
  if constexpr (IsCounted<T>)
    return PipeModel::current().scalar_at(&value.value, bits_of(value.value));
  else
    return 0;
}

template <Arithmetic T>
struct Counted {
  T value;

  constexpr Counted() : value{} { make(0); }
  template <Arithmetic U>
  requires(!std::is_same_v<U, bool>) constexpr Counted(U constant) : value(static_cast<T>(constant)) { make(0); }
  template <class U>
  requires std::is_enum_v<U>
  explicit(!std::is_convertible_v<U, std::underlying_type_t<U>>) constexpr Counted(U constant)
      : Counted(static_cast<std::underlying_type_t<U>>(constant)) {}
  constexpr Counted(const Counted& other) : value(other.value) {
    if (!std::is_constant_evaluated()) set(node_of(other));
  }
  template <Arithmetic U>
  constexpr Counted(const Counted<U>& other) : value(static_cast<T>(other.value)) {
    if (!std::is_constant_evaluated()) set(convert_node<T, U>(node_of(other), bits_of(value)));
  }
  constexpr Counted& operator=(const Counted& other) {
    value = other.value;
    if (!std::is_constant_evaluated()) set(node_of(other));
    return *this;
  }
  [[nodiscard]] static constexpr Counted made(T value, Node node) {
    Counted result;
    result.value = value;
    result.make(node);
    return result;
  }

  /// An index: part of an address. Scaling is done by whoever counts the loop.
  constexpr operator std::ptrdiff_t() const requires std::is_integral_v<T> {
    if (!std::is_constant_evaluated()) {
      const Node node = node_of(*this);
      if (node != 0) PipeModel::current().note_address(emit(OpClass::kFixed, bits_of(value), node));
    }
    return static_cast<std::ptrdiff_t>(value);
  }
  template <class B>
  constexpr Counted& operator+=(const B& b) {
    return *this = Counted(*this + b);
  }
  template <class B>
  constexpr Counted& operator-=(const B& b) {
    return *this = Counted(*this - b);
  }
  template <class B>
  constexpr Counted& operator*=(const B& b) {
    return *this = Counted(*this * b);
  }
  template <class B>
  constexpr Counted& operator&=(const B& b) {
    return *this = Counted(*this & b);
  }
  template <class B>
  constexpr Counted& operator|=(const B& b) {
    return *this = Counted(*this | b);
  }
  template <class B>
  constexpr Counted& operator^=(const B& b) {
    return *this = Counted(*this ^ b);
  }
  template <class B>
  constexpr Counted& operator<<=(const B& b) {
    return *this = Counted(*this << b);
  }
  template <class B>
  constexpr Counted& operator>>=(const B& b) {
    return *this = Counted(*this >> b);
  }
  constexpr Counted& operator++() { return *this = Counted(*this + T{1}); }
  constexpr Counted& operator--() { return *this = Counted(*this - T{1}); }
  constexpr Counted operator++(int) {
    const Counted before = *this;
    ++*this;
    return before;
  }
  constexpr Counted operator--(int) {
    const Counted before = *this;
    --*this;
    return before;
  }

 private:
  constexpr void make(Node node) {
    if (!std::is_constant_evaluated()) PipeModel::current().make_register(&value, node);
  }
  void set(Node node) { PipeModel::current().set_scalar(&value, node, bits_of(value)); }
};
static_assert(sizeof(Counted<float>) == 4 && sizeof(Counted<std::uint64_t>) == 8);

/// A literal, or a constant of the kernel.
template <class T>
bool is_constant(const T& value) {
  if constexpr (IsCounted<T>)
    return PipeModel::current().is_constant(&value.value);
  else
    return true;
}

template <class T>
bool is_power_of_two(const T& value) {
  if constexpr (!std::is_integral_v<Plain<T>>)
    return false;
  else
    return is_constant(value) && std::has_single_bit(static_cast<std::make_unsigned_t<Plain<T>>>(plain(value)));
}

/// Whether an integer is one that a 16-bit multiplier takes: of the few numbers that the kernel multiplies, places in
/// the grid and strides, the largest are known where it is written.
template <class T>
bool fits_16_bits(const T& value) {
  if constexpr (std::is_signed_v<Plain<T>>) {
    return plain(value) >= -32768 && plain(value) <= 32767;
  } else {
    return plain(value) <= 65535u;
  }
}

// An operand as the operation takes it: in floating point, if the other one is. Integers stay as they are.
template <class Common, class T>
Node operand_node(const T& operand, std::uint64_t tie) {
  using To = std::conditional_t<std::is_integral_v<Common>, Plain<T>, Common>;
  return convert_node<To, Plain<T>>(node_of(operand), tie);
}

template <class A, class B, class R>
auto counted_result(const A& a, const B& b, R value, char symbol) {
  using Common = decltype(Plain<A>{} + Plain<B>{});
  const std::uint64_t tie = bits_of(value);
  const bool shift = symbol == '<' || symbol == '>';
  const Node x = operand_node<Common>(a, tie);
  const Node y = operand_node<Common>(b, tie);
  Node node = 0;
  if (x == 0 && y == 0) return Counted<R>::made(value, 0);
  if constexpr (std::is_same_v<Common, float>) {
    if (symbol == '*') return Counted<R>::made(value, PipeModel::current().emit_product(tie, x, y));
    node = symbol == '/' ? divide_floats(x, y, tie) : emit(OpClass::kFloat, tie, x, y);
  } else if constexpr (std::is_same_v<Common, double>) {
    node = symbol == '/' ? divide_doubles(x, y, tie) : emit(OpClass::kDouble, tie, x, y);
  } else if (symbol == '&' || symbol == '|' || symbol == '^') {
    node = emit(OpClass::kFixed, tie, x, y);
  } else if (symbol == '*' || symbol == '/' || symbol == '%') {
    if (is_power_of_two(b) || (symbol == '*' && is_power_of_two(a))) {
      if (symbol == '%') {
        node = emit(OpClass::kFixed, tie, x, y);
      } else {
        node = sizeof(R) == 8 ? shift_long(x, y, tie, symbol == '/', false) : emit(OpClass::kShift, tie, x, y);
      }
    } else if (symbol == '*') {
      // Of 64 bits, only products of 32-bit values occur, and products with +-1.
      node =
          sizeof(R) == 8 ? multiply_to_long(x, y, tie) : multiply_words(x, y, tie, fits_16_bits(a) && fits_16_bits(b));
    } else {
      // By way of float, the quotient checked by a product.
      const Node quotient = divide_floats(emit(OpClass::kConvert, tie, x), emit(OpClass::kConvert, tie + 1, y), tie);
      node = multiply_words(emit(OpClass::kConvert, tie + 2, quotient), y, tie, fits_16_bits(b));
      node = emit(OpClass::kFixed, tie + 2, node, x);
    }
  } else if (shift) {
    node = sizeof(R) == 8 ? shift_long(x, y, tie, symbol == '>', symbol == '>' && std::is_signed_v<R>)
                          : emit(OpClass::kShift, tie, x, y);
  } else {
    node = sizeof(R) == 8 ? add_longs(x, y, tie) : emit(OpClass::kFixed, tie, x, y);
  }
  return Counted<R>::made(value, node);
}

#define GRIDIRON_COUNTED_BINARY(op)                                              \
  template <class A, class B>                                                    \
  requires CountedPair<A, B>                                                     \
  constexpr auto operator op(const A& a, const B& b) {                           \
    using R = decltype(plain(a) op plain(b));                                    \
    if (std::is_constant_evaluated()) return Counted<R>(plain(a) op plain(b));   \
    return counted_result(a, b, static_cast<R>(plain(a) op plain(b)), (#op)[0]); \
  }
GRIDIRON_COUNTED_BINARY(+)
GRIDIRON_COUNTED_BINARY(-)
GRIDIRON_COUNTED_BINARY(*)
GRIDIRON_COUNTED_BINARY(/)
GRIDIRON_COUNTED_BINARY(%)
GRIDIRON_COUNTED_BINARY(&)
GRIDIRON_COUNTED_BINARY(|)
GRIDIRON_COUNTED_BINARY(^)
GRIDIRON_COUNTED_BINARY(<<)
GRIDIRON_COUNTED_BINARY(>>)
#undef GRIDIRON_COUNTED_BINARY

template <class A, class B>
CountedBool counted_truth(const A& a, const B& b, bool value, bool equality) {
  using Common = decltype(Plain<A>{} + Plain<B>{});
  const Node x = operand_node<Common>(a, value);
  const Node y = operand_node<Common>(b, value);
  if (x == 0 && y == 0) return {value, 0};
  if constexpr (std::is_same_v<Common, double>) {
    return {value, compare_doubles(x, y, value)};
  } else {
    // A branch on zero needs no compare.
    if constexpr (std::is_integral_v<Common> && sizeof(Common) == 4) {
      if (equality && plain(b) == 0 && is_constant(b)) return {value, x};
    }
    if (sizeof(Common) == 8) return {value, compare_longs(x, y, value, equality)};
    return {value, emit(OpClass::kFixed, value, x, y)};  // the reverse question is the branch's other way
  }
}

#define GRIDIRON_COUNTED_COMPARE(op, equality)                          \
  template <class A, class B>                                           \
  requires CountedPair<A, B>                                            \
  constexpr CountedBool operator op(const A& a, const B& b) {           \
    if (std::is_constant_evaluated()) return {plain(a) op plain(b), 0}; \
    return counted_truth(a, b, plain(a) op plain(b), equality);         \
  }
GRIDIRON_COUNTED_COMPARE(<, false)
GRIDIRON_COUNTED_COMPARE(>, false)
GRIDIRON_COUNTED_COMPARE(<=, false)
GRIDIRON_COUNTED_COMPARE(>=, false)
GRIDIRON_COUNTED_COMPARE(==, true)
GRIDIRON_COUNTED_COMPARE(!=, true)
#undef GRIDIRON_COUNTED_COMPARE

template <Arithmetic T>
constexpr auto operator-(const Counted<T>& a) {
  using R = decltype(-a.value);
  if (std::is_constant_evaluated()) return Counted<R>(-a.value);
  const Node node = node_of(a);
  return Counted<R>::made(-a.value, node == 0 ? 0 : emit(OpClass::kFixed, bits_of(a.value), node));
}
template <Arithmetic T>
constexpr auto operator~(const Counted<T>& a) {
  using R = decltype(~a.value);
  if (std::is_constant_evaluated()) return Counted<R>(~a.value);
  const Node node = node_of(a);
  return Counted<R>::made(static_cast<R>(~a.value), node == 0 ? 0 : emit(OpClass::kFixed, bits_of(a.value), node));
}

/// Branches of the kernel: if and while record where they are, and so do most loops.
constexpr bool branch_at(Site site, const CountedBool& condition) {
  if (!std::is_constant_evaluated()) PipeModel::current().branch(site, condition.value, condition.node);
  return condition.value;
}
constexpr bool branch_at(Site site, bool condition) {
  return branch_at(site, CountedBool{condition, 0});
}

/// A number for a file, by its name.
consteval Site file_number(const char* name) {
  Site hash = 0;
  for (; *name != 0; ++name) hash = hash * 31 + static_cast<unsigned char>(*name);
  return hash % 65536;
}

/// A loop whose one condition is a branch. Those whose index is an unsigned number of the kernel, and those of several
/// conditions, have operations in its place: so the tables were counted. Not so in the passes of a build, whose loops
/// are long and have no other branches: there the first condition of any loop is one, and loops over constants, which a
/// compiler unrolls, have one each 16 turns.
struct CountedLoop {
  Site site;
  bool is_unrolled;
  std::uint32_t turns = 0;

  constexpr CountedLoop(Site place, std::string_view file, std::string_view head)
      : site(place), is_unrolled(file.find("/gridiron/build/") != file.npos) {
    if (!is_unrolled && (head.starts_with("std::uint") || head.find("&&") != head.npos)) site = 0;
    expect_condition();
  }
  constexpr ~CountedLoop() { expect_none(); }
  constexpr void expect_condition() {
    if (!std::is_constant_evaluated()) PipeModel::current().expect_loop(site, is_unrolled ? &turns : nullptr);
  }
  static constexpr void expect_none() {
    if (!std::is_constant_evaluated()) PipeModel::current().expect_loop(0);
  }
};

/// A turn of it: behind it the step and the condition follow.
struct CountedTurn {
  CountedLoop& loop;

  explicit constexpr CountedTurn(CountedLoop& of) : loop(of) { CountedLoop::expect_none(); }
  constexpr ~CountedTurn() { loop.expect_condition(); }
};

/// One of an enumeration, in memory.
template <class T>
struct CountedEnum {
  T value;

  CountedEnum& operator=(T constant) {
    value = constant;
    PipeModel::current().set_scalar(&value, 0, static_cast<std::uint64_t>(constant));
    return *this;
  }
  [[nodiscard]] Node node() const { return PipeModel::current().scalar_at(&value, static_cast<std::uint64_t>(value)); }
  friend CountedBool operator==(const CountedEnum& a, T b) {
    return {a.value == b, emit(OpClass::kFixed, a.value == b, a.node())};
  }
  friend CountedBool operator!=(const CountedEnum& a, T b) { return !(a == b); }
};

/// An enumeration that lies in the local store.
template <class Enumeration>
using Stored = CountedEnum<Enumeration>;

/// A jump by a table: one of its places is expected, to the others it goes the rarer way.
template <class T>
T switch_at(Site site, const CountedEnum<T>& choice) {
  const auto tie = static_cast<std::uint64_t>(choice.value);
  const Node place = emit(OpClass::kShift, tie, choice.node());
  const Node target = emit(OpClass::kShuffle, tie, emit(OpClass::kLoad, tie, place), place);  // a word of the table
  PipeModel::current().branch(site, choice.value == T::kNextCell, target);
  return choice.value;
}
/// What is no number of the kernel is not counted.
template <class T>
constexpr T switch_at(Site, T choice) {
  return choice;
}

/// The value of type To with the same bits.
template <class To, Arithmetic From>
constexpr To counted_bit_cast(const Counted<From>& value) {
  const Plain<To> bits = std::bit_cast<Plain<To>>(value.value);
  return std::is_constant_evaluated() ? To(bits) : To::made(bits, node_of(value));
}

}  // namespace gridiron_counted
