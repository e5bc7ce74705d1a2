// Counted lanes: the interface of core's lanes.h, four floats that tell the pipe model what is done with them.
// Memory: values. Threads: the model's. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <counted/counted.h>
#include <gridiron/base/lanes.h>

#include <cstddef>
#include <cstdint>

namespace gridiron_counted {

template <int W>
struct Lanes {
  static_assert(W == 4, "a chip's vectors have four lanes");
  static constexpr int kCount = W;
  static constexpr std::uint32_t kAllBits = 0xF;
  using Native = gridiron::Lanes<4>;

  template <class Vector>
  static std::uint64_t tie(const Vector& v) {
    std::uint64_t words[2];
    static_assert(sizeof(words) == sizeof(Vector));
    __builtin_memcpy(words, &v, sizeof(words));
    return words[0] * 0x9E3779B97F4A7C15u + words[1];
  }

  struct Mask {
    Native::Mask v;
    Node node;
    /// Gather of the words' lowest bits.
    [[nodiscard]] Counted<std::uint32_t> bits() const {
      return Counted<std::uint32_t>::made(v.bits(), emit(OpClass::kShuffle, v.bits(), node));
    }
    friend Mask operator|(Mask a, Mask b) {
      return {a.v | b.v, emit(OpClass::kFixed, tie((a.v | b.v).v), a.node, b.node)};
    }
    friend Mask operator&(Mask a, Mask b) {
      return {a.v & b.v, emit(OpClass::kFixed, tie((a.v & b.v).v), a.node, b.node)};
    }
  };

  struct Float {
    Native::Float v;
    Node node;

    Float() = default;
    Float(Native::Float value, Node made) : v(value), node(made) {}
    explicit Float(float constant) : v(constant), node(0) {}
    explicit Float(const Counted<float>& value)
        : v(value.value), node(PipeModel::current().splat_of(&value.value, bits_of(value.value))) {}

    [[nodiscard]] static Float load(const Counted<float>* source) {
      const Native::Float value = Native::Float::load(&source->value);
      return {value, PipeModel::current().load_quad(source, tie(value.v))};
    }
    void store(Counted<float>* target) const {
      v.store(&target->value);
      PipeModel::current().store_quad(target, node, tie(v.v));
    }

    friend Float operator+(Float a, Float b) { return make(OpClass::kFloat, a.v + b.v, a, b); }
    friend Float operator-(Float a, Float b) { return make(OpClass::kFloat, a.v - b.v, a, b); }
    friend Float operator*(Float a, Float b) {
      const Native::Float value = a.v * b.v;
      return {value, a.node == 0 && b.node == 0 ? 0 : PipeModel::current().emit_product(tie(value.v), a.node, b.node)};
    }
    friend Float operator/(Float a, Float b) {
      const Native::Float value = a.v / b.v;
      return {value, divide_floats(a.node, b.node, tie(value.v))};
    }
    friend Float operator-(Float a) { return make(OpClass::kFixed, -a.v, a, a); }  // the sign bit
    friend Mask operator<(Float a, Float b) { return compare(a.v < b.v, a, b); }
    friend Mask operator>(Float a, Float b) { return compare(a.v > b.v, a, b); }
    // There is only "greater": not greater, turned around.
    friend Mask operator<=(Float a, Float b) { return turned(compare(a.v <= b.v, a, b)); }
    friend Mask operator>=(Float a, Float b) { return turned(compare(a.v >= b.v, a, b)); }
  };

  static Float make(OpClass op, Native::Float value, Float a, Float b) {
    return {value, a.node == 0 && b.node == 0 ? 0 : emit(op, tie(value.v), a.node, b.node)};
  }
  static Mask compare(Native::Mask value, Float a, Float b) {
    return {value, emit(OpClass::kFixed, tie(value.v), a.node, b.node)};
  }
  static Mask turned(Mask mask) { return {mask.v, emit(OpClass::kFixed, tie(mask.v.v) + 1, mask.node)}; }

  struct Int {
    Native::Int v;
    Node node;
    [[nodiscard]] Counted<std::int32_t> operator[](int lane) const {
      const std::int32_t value = v[lane];
      return Counted<std::int32_t>::made(value, lane == 0 ? node : emit(OpClass::kShuffle, bits_of(value), node));
    }
    [[nodiscard]] static Int splat(std::uint32_t constant) { return {Native::Int::splat(constant), 0}; }
    [[nodiscard]] static Int splat(const Counted<std::uint32_t>& word) {
      return {Native::Int::splat(word.value), PipeModel::current().splat_of(&word.value, word.value)};
    }
    [[nodiscard]] static Int load(const Counted<std::uint32_t>* source) {
      const Native::Int value = Native::Int::load(&source->value);
      return {value, PipeModel::current().load_quad(source, tie(value.v))};
    }
    void store(Counted<std::uint32_t>* target) const { store_quads(*this, target, 0); }
    friend Mask operator<(Int a, Int b) {
      return {a.v < b.v, emit(OpClass::kFixed, tie((a.v < b.v).v), a.node, b.node)};
    }
    friend Int operator+(Int a, Int b) {
      return {a.v + b.v, emit(OpClass::kFixed, tie((a.v + b.v).v), a.node, b.node)};
    }
    friend Int operator|(Int a, Int b) {
      return {a.v | b.v, emit(OpClass::kFixed, tie((a.v | b.v).v), a.node, b.node)};
    }
    friend Int operator&(Int a, Int b) {
      return {a.v & b.v, emit(OpClass::kFixed, tie((a.v & b.v).v), a.node, b.node)};
    }
    friend Int operator^(Int a, Int b) {
      return {a.v ^ b.v, emit(OpClass::kFixed, tie((a.v ^ b.v).v), a.node, b.node)};
    }
    friend Int operator<<(Int a, int count) {
      return {a.v << count, emit(OpClass::kShift, tie((a.v << count).v), a.node)};
    }
    friend Int operator>>(Int a, int count) {
      return {a.v >> count, emit(OpClass::kShift, tie((a.v >> count).v), a.node)};
    }
    friend Int operator>>(Int a, Int counts) {
      return {a.v >> counts.v, emit(OpClass::kShift, tie((a.v >> counts.v).v), a.node, counts.node)};
    }
  };

  /// Two integers of 64 bits. What a scalar of 64 bits takes, two of them take.
  struct Long {
    Native::Long v;
    Node node;
    friend Long operator+(Long a, std::int64_t b) { return {a.v + b, add_longs(a.node, 0, tie((a.v + b).v))}; }
    friend Long operator-(Long a, std::int64_t b) { return {a.v - b, add_longs(a.node, 0, tie((a.v - b).v))}; }
    // The words apart: high word shifted with its sign, bits of it moved to the low one.
    friend Long operator>>(Long a, int count) {
      const Native::Long value = a.v >> count;
      const Node low = emit(OpClass::kShift, tie(value.v), a.node);
      const Node high = emit(OpClass::kShift, tie(value.v) + 1, a.node);
      const Node carried = emit(OpClass::kShuffle, tie(value.v), a.node);
      return {value, emit(OpClass::kFixed, tie(value.v), low, high, carried)};
    }
    friend Long operator&(Long a, Long b) {
      return {a.v & b.v, emit(OpClass::kFixed, tie((a.v & b.v).v), a.node, b.node)};
    }
    friend Long operator~(Long a) { return {~a.v, emit(OpClass::kFixed, tie((~a.v).v), a.node)}; }
    friend Long operator==(Long a, Long b) {
      return {a.v == b.v, compare_longs(a.node, b.node, tie((a.v == b.v).v), true)};
    }
    friend Long operator>=(Long a, std::int64_t b) {
      return {a.v >= b, compare_longs(a.node, 0, tie((a.v >= b).v), false)};
    }
    friend Long operator<=(Long a, std::int64_t b) {
      return {a.v <= b, compare_longs(a.node, 0, tie((a.v <= b).v), false)};
    }
  };

  struct Double {
    Native::Double v;
    Node node;
    Double(Native::Double value, Node made) : v(value), node(made) {}
    explicit Double(const Counted<double>& value)
        : v(value.value), node(PipeModel::current().splat_of(&value.value, bits_of(value.value))) {}
    /// Half a quadword: moved apart, then extended.
    [[nodiscard]] static Double load_floats(const Counted<float>* source) {
      const Native::Double value = Native::Double::load_floats(&source->value);
      const auto* quad = reinterpret_cast<const Counted<float>*>(reinterpret_cast<std::uintptr_t>(source) / 16 * 16);
      const Node loaded = PipeModel::current().load_quad(quad, tie(value.v));
      return {value, emit(OpClass::kDouble, tie(value.v), emit(OpClass::kShuffle, tie(value.v), loaded))};
    }
    [[nodiscard]] Long pattern() const { return {v.pattern(), node}; }

    friend Double operator+(Double a, Double b) { return make_double(a.v + b.v, a, b); }
    friend Double operator-(Double a, Double b) { return make_double(a.v - b.v, a, b); }
    friend Double operator*(Double a, Double b) { return make_double(a.v * b.v, a, b); }
    // Both halves at once.
    friend Double operator/(Double a, Double b) {
      const Native::Double value = a.v / b.v;
      return {value, divide_doubles(a.node, b.node, tie(value.v))};
    }
    friend Long operator<(Double a, double b) { return {a.v < b, compare_doubles(a.node, 0, tie((a.v < b).v))}; }
  };
  static Double make_double(Native::Double value, Double a, Double b) {
    return {value, emit(OpClass::kDouble, tie(value.v), a.node, b.node)};
  }

  /// A rotation by a variable count.
  [[nodiscard]] static Counted<float> lane(Float a, const Counted<std::uint32_t>& lane) {
    const float value = a.v.v[lane.value];
    return Counted<float>::made(value, emit(OpClass::kShuffle, bits_of(value), a.node, node_of(lane)));
  }
  /// Words and floats are the same registers.
  [[nodiscard]] static Int words_of(Float a) { return {Native::words_of(a.v), a.node}; }
  [[nodiscard]] static Float floats_of(Int a) { return {Native::floats_of(a.v), a.node}; }
  [[nodiscard]] static Float to_float(Int a) {
    const Native::Float value = Native::to_float(a.v);
    return {value, emit(OpClass::kConvert, tie(value.v), a.node)};
  }
  [[nodiscard]] static Int truncate(Float a) {
    const Native::Int value = Native::truncate(a.v);
    return {value, emit(OpClass::kConvert, tie(value.v), a.node)};
  }
  /// Low words side by side, and half a quadword of memory replaced.
  static void store_patterns(Long patterns, Counted<float>* target) {
    Native::store_patterns(patterns.v, &target->value);
    auto* quad = reinterpret_cast<Counted<float>*>(reinterpret_cast<std::uintptr_t>(target) / 16 * 16);
    const Node merged = emit(OpClass::kShuffle, tie(patterns.v.v), patterns.node);
    PipeModel::current().store_quad(quad, merged, tie(patterns.v.v));
  }

  // Compare and select.
  [[nodiscard]] static Float min(Float a, Float b) {
    return make(OpClass::kFixed, Native::min(a.v, b.v), a, chosen(a, b));
  }
  static constexpr bool kRoundsOnce = false;
  /// One instruction: a bounded value may be rounded once.
  [[nodiscard]] static Float bounded_sum(Float a, Float b, Float c) {
    const Native::Float value = Native::bounded_sum(a.v, b.v, c.v);
    const bool is_constant = a.node == 0 && b.node == 0 && c.node == 0;
    return {value, is_constant ? 0 : emit(OpClass::kFloat, tie(value.v), a.node, b.node, c.node)};
  }
  [[nodiscard]] static Float bounded_difference(Float a, Float b, Float c, Float d) {
    const Float second = c * d;
    const Native::Float value = Native::bounded_difference(a.v, b.v, c.v, d.v);
    return {value, emit(OpClass::kFloat, tie(value.v), a.node, b.node, second.node)};
  }
  [[nodiscard]] static Float max(Float a, Float b) {
    return make(OpClass::kFixed, Native::max(a.v, b.v), a, chosen(a, b));
  }
  static Float chosen(Float a, Float b) {
    return {b.v, emit(OpClass::kFixed, tie(a.v.v) + tie(b.v.v), a.node, b.node)};
  }
  [[nodiscard]] static Float abs(Float a) { return make(OpClass::kFixed, Native::abs(a.v), a, a); }
  [[nodiscard]] static Float larger_size(Float a, Float b) { return max(abs(a), abs(b)); }
  [[nodiscard]] static Float select(Mask mask, Float a, Float b) {
    const Native::Float value = Native::select(mask.v, a.v, b.v);
    return {value, emit(OpClass::kFixed, tie(value.v), mask.node, a.node, b.node)};
  }
  [[nodiscard]] static Mask equal(const Counted<std::uint32_t>& value, const Counted<std::uint32_t>* words) {
    const Int wanted = Int::splat(value), loaded = Int::load(words);
    const Native::Mask equal = Native::equal(plain(value), &words->value);
    return {equal, emit(OpClass::kFixed, tie(equal.v), wanted.node, loaded.node)};
  }
  [[nodiscard]] static Int select(Mask mask, Int a, Int b) {
    const Native::Int value = Native::select(mask.v, a.v, b.v);
    return {value, emit(OpClass::kFixed, tie(value.v), mask.node, a.node, b.node)};
  }
  [[nodiscard]] static Float square_root(Float a) {
    const Native::Float value = Native::square_root(a.v);
    return {value, root_of_float(a.node, tie(value.v))};
  }
  /// There is one quad only, whatever the stride.
  static void store_quads(Int a, Counted<std::uint32_t>* target, const Counted<std::uint32_t>&) {
    Native::store_quads(a.v, &target->value, 0);
    PipeModel::current().store_quad(target, a.node, tie(a.v.v));
  }
  static void store_quads(Float a, Counted<float>* target, const Counted<std::uint32_t>&) { a.store(target); }
  /// A pattern by the bits for one shuffle, then a store across two quads.
  static void compress(Int a, const Counted<std::uint32_t>& bits, Counted<std::uint32_t>* target) {
    alignas(16) std::uint32_t words[4];
    Native::compress(a.v, bits.value, words);
    const std::uint64_t tied = tie(a.v.v) + bits.value;
    const Node place = emit(OpClass::kShift, tied, node_of(bits));
    const Node pattern = emit(OpClass::kLoad, tied, place);
    const Node packed = emit(OpClass::kShuffle, tied, a.node, pattern);
    const auto first = reinterpret_cast<std::uintptr_t>(target) / 16 * 16;
    for (const std::uintptr_t part : {first, first + 16}) {
      const auto* const quad = reinterpret_cast<const void*>(part);
      const Node before = PipeModel::current().load_quad(quad, tied);
      const Node turned = emit(OpClass::kShuffle, tied + 1, packed);
      PipeModel::current().store_quad(quad, emit(OpClass::kFixed, tied + 2, before, turned), tied);
    }
    const std::uint32_t count = gridiron::count_bits(bits.value);
    for (std::uint32_t i = 0; i < count; ++i) target[i].value = words[i];
  }
  /// Patterns by the bits and by the count: of one shuffle, of a rotation, of what stays.
  struct Packing {
    Packing(const Counted<std::uint32_t>& lanes, const Counted<std::uint32_t>& words)
        : bits(lanes.value), count(words.value) {
      const std::uint64_t tied = bits * 16 + count;
      const Node place = emit(OpClass::kShift, tied, node_of(lanes));
      pattern = emit(OpClass::kLoad, tied, place);
      rotation = emit(OpClass::kShift, tied + 1, node_of(words));
      stays = emit(OpClass::kLoad, tied + 1, rotation);
    }
    std::uint32_t bits, count;
    Node pattern, rotation, stays;
  };
  static void append(const Packing& packing, Int a, Counted<std::uint32_t>* target) {
    alignas(16) std::uint32_t words[4];
    Native::compress(a.v, packing.bits, words);
    const std::uint64_t tied = tie(a.v.v) + packing.bits;
    const Node before = PipeModel::current().load_quad(target, tied);
    const Node packed = emit(OpClass::kShuffle, tied, a.node, packing.pattern);
    const Node turned = emit(OpClass::kShuffle, tied + 1, packed, packing.rotation);
    PipeModel::current().store_quad(target, emit(OpClass::kFixed, tied, before, turned, packing.stays), tied);
    PipeModel::current().store_quad(target + W, turned, tied + 1);
    const std::uint32_t count = gridiron::count_bits(packing.bits);
    for (std::uint32_t i = 0; i < count; ++i) target[packing.count + i].value = words[i];
  }
  template <class Quad>
  static void copy_quad(const Quad& source, Quad& target) {
    static_assert(sizeof(Quad) == 16);
    std::uint64_t words[2];
    __builtin_memcpy(words, &source, sizeof words);
    const std::uint64_t tied = words[0] * 31 + words[1];
    const Node node = PipeModel::current().load_quad(&source, tied);
    __builtin_memcpy(static_cast<void*>(&target), words, sizeof words);
    PipeModel::current().store_quad(&target, node, tied);
  }
  /// A comparison with 0, and the gather.
  [[nodiscard]] static Counted<std::uint32_t> sign_bits(Int a) {
    const std::uint32_t bits = Native::sign_bits(a.v);
    const Node is_negative = emit(OpClass::kFixed, tie(a.v.v), a.node);
    return Counted<std::uint32_t>::made(bits, emit(OpClass::kShuffle, bits, is_negative));
  }
  /// A word after the other.
  template <class Word>
  [[nodiscard]] static Int gather(const Counted<Word>* base, Int bytes) {
    Native::Int words = Native::Int::splat(0);
    Node node = bytes.node;
    for (int i = 0; i < W; ++i) {
      const Counted<Word>& word = base[bytes.v[i] / 4];
      words.v[i] = std::bit_cast<std::int32_t>(word.value);
      node = emit(OpClass::kShuffle, word.value, node, PipeModel::current().splat_of(&word.value, word.value));
    }
    return {words, node};
  }
  static void store_where(Mask mask, const Counted<std::uint32_t>& value, Counted<std::uint32_t>* target) {
    store_quads(select(mask, Int::splat(value), Int::load(target)), target, 0);
  }
  [[nodiscard]] static Mask mask_from_bits(const Counted<std::uint32_t>& bits) {
    return {Native::mask_from_bits(bits.value), emit(OpClass::kShuffle, bits.value, node_of(bits))};
  }
  [[nodiscard]] static Counted<std::uint32_t> half_bits(Long v) {
    const std::uint32_t bits = Native::half_bits(v.v);
    return Counted<std::uint32_t>::made(bits, emit(OpClass::kShuffle, bits, v.node));
  }
  /// Halves of a quadword moved apart, then converted.
  [[nodiscard]] static Float load_halves(const std::uint16_t* source) {
    const Native::Float value = Native::load_halves(source);
    const auto* quad = reinterpret_cast<const Counted<float>*>(reinterpret_cast<std::uintptr_t>(source) / 16 * 16);
    const Node loaded = PipeModel::current().load_quad(quad, tie(value.v));
    return {value, emit(OpClass::kConvert, tie(value.v), emit(OpClass::kShuffle, tie(value.v), loaded))};
  }
  /// Estimate and interpolation.
  [[nodiscard]] static Float reciprocal_estimate(Float a) {
    const Native::Float value = Native::reciprocal_estimate(a.v);
    return {value, emit(OpClass::kConvert, tie(value.v), a.node, emit(OpClass::kShuffle, tie(value.v), a.node))};
  }
  [[nodiscard]] static Float repeat_quad(const Counted<float>* source) { return Float::load(source); }
  [[nodiscard]] static Float splat_quads(const Counted<float>* source) { return Float(*source); }
  [[nodiscard]] static Float load_quads(const Counted<float>* const* sources) { return Float::load(sources[0]); }
  template <int I0, int I1, int I2, int I3>
  [[nodiscard]] static Float shuffle_quads(Float a, Float b) {
    return make(OpClass::kShuffle, Native::shuffle_quads<I0, I1, I2, I3>(a.v, b.v), a, b);
  }
  template <int I0, int I1, int I2, int I3>
  [[nodiscard]] static Float shuffle_quads(Float a) {
    return shuffle_quads<I0, I1, I2, I3>(a, a);
  }
  /// The mask's sign bit, exclusive or.
  /// The sign bits, which several share, and an exclusive or.
  [[nodiscard]] static Float turn_by(Float by, Float a) {
    const Native::Float value = Native::turn_by(by.v, a.v);
    const Node sign = emit(OpClass::kFixed, tie(by.v.v), by.node);
    return {value, emit(OpClass::kFixed, tie(value.v), a.node, sign)};
  }
  [[nodiscard]] static Float flip_sign(Mask mask, Float a) {
    const Native::Float value = Native::flip_sign(mask.v, a.v);
    const Node sign = emit(OpClass::kFixed, tie(value.v), mask.node);
    return {value, emit(OpClass::kFixed, tie(value.v), sign, a.node)};
  }
  [[nodiscard]] static Counted<float> horizontal_max(Float a) {
    a = max(a, swap_lanes<2>(a));
    const Float result = max(a, swap_lanes<1>(a));
    return Counted<float>::made(result.v.v[0], result.node);
  }
  [[nodiscard]] static Counted<float> horizontal_min(Float a) {
    a = min(a, swap_lanes<2>(a));
    const Float result = min(a, swap_lanes<1>(a));
    return Counted<float>::made(result.v.v[0], result.node);
  }
  template <int Distance>
  [[nodiscard]] static Float swap_lanes(Float a) {
    return make(OpClass::kShuffle, Native::swap_lanes<Distance>(a.v), a, a);
  }
};

[[nodiscard]] inline Counted<float> square_root(const Counted<float>& value) {
  return Counted<float>::made(gridiron::square_root(value.value), root_of_float(node_of(value), bits_of(value.value)));
}
[[nodiscard]] inline Counted<double> square_root(const Counted<double>& value) {
  return Counted<double>::made(gridiron::square_root(value.value),
                               root_of_double(node_of(value), bits_of(value.value)));
}
template <class T>
[[nodiscard]] Counted<T> magnitude(const Counted<T>& value) {
  const Node node = node_of(value);
  return Counted<T>::made(gridiron::magnitude(value.value),
                          node == 0 ? 0 : emit(OpClass::kFixed, bits_of(value.value), node));
}

/// x & -x, leading zeros of it, 31 - that; of 64 bits the word that holds it first.
template <class T>
[[nodiscard]] Counted<std::uint32_t> lowest_bit(const Counted<T>& bits) {
  const std::uint32_t value = gridiron::lowest_bit(bits.value);
  Node node = node_of(bits);
  if constexpr (sizeof(T) == 8) {
    node = emit(OpClass::kFixed, bits.value, emit(OpClass::kShuffle, bits.value, node));
  }
  const Node negative = emit(OpClass::kFixed, bits.value + 1, node);
  const Node lowest = emit(OpClass::kFixed, bits.value + 2, node, negative);
  const Node zeros = emit(OpClass::kFixed, bits.value + 3, lowest);
  return Counted<std::uint32_t>::made(value, emit(OpClass::kFixed, value, zeros));
}
/// Bits of bytes, sum of bytes.
[[nodiscard]] inline Counted<std::uint32_t> count_bits(const Counted<std::uint32_t>& bits) {
  const std::uint32_t value = gridiron::count_bits(bits.value);
  return Counted<std::uint32_t>::made(value,
                                      emit(OpClass::kShift, value, emit(OpClass::kShift, bits.value, node_of(bits))));
}
/// Four words a store.
template <class T, std::size_t Count, class Value>
void fill_words(Counted<T> (&target)[Count], const Value& value) {
  static_assert(Count % 4 == 0 && sizeof(T) == 4);
  const T word = static_cast<T>(plain(value));
  const Node node = emit(OpClass::kShuffle, bits_of(word), node_of(value));
  for (std::size_t i = 0; i < Count; ++i) target[i].value = word;
  for (std::size_t i = 0; i < Count; i += 4) PipeModel::current().store_quad(target + i, node, i);
}

}  // namespace gridiron_counted
