// Lanes over the Cell's numbers: the interface of core's lanes.h.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "numeric/watertight/cell/cell_float.h"
#include "numeric/watertight/cell/cell_vector.h"

#define GRIDIRON_INLINE inline
#define GRIDIRON_INLINE_LAMBDA
#define GRIDIRON_OUTLINE inline
#define GRIDIRON_RARE inline

namespace gridiron {

using watertight::CellDouble;
using watertight::CellFloat;
using watertight::CellVector;

[[nodiscard]] inline CellFloat magnitude(CellFloat value) {
  return CellFloat::from_bits(value.bits() & 0x7FFFFFFFu);
}

template <int W>
struct Lanes {
  static_assert(W == 4, "the chip's vectors have four lanes");
  static constexpr int kCount = W;
  static constexpr std::size_t kWidth = W;
  static constexpr std::size_t kHalf = W / 2;
  static constexpr std::uint32_t kAllBits = (1u << W) - 1u;

  struct Mask {
    std::uint32_t m;
    [[nodiscard]] std::uint32_t bits() const { return m; }
    friend Mask operator|(Mask a, Mask b) { return {a.m | b.m}; }
    friend Mask operator&(Mask a, Mask b) { return {a.m & b.m}; }
  };

  struct Float {
    CellVector v;

    Float() = default;
    explicit Float(CellVector vector) : v(vector) {}
    explicit Float(CellFloat value) : v(value) {}
    [[nodiscard]] static Float load(const CellFloat* source) { return Float(CellVector::load(source)); }
    void store(CellFloat* target) const { v.store(target); }

    friend Float operator+(Float a, Float b) { return Float(a.v + b.v); }
    friend Float operator-(Float a, Float b) { return Float(a.v - b.v); }
    friend Float operator*(Float a, Float b) { return Float(a.v * b.v); }
    friend Float operator/(Float a, Float b) { return Float(a.v / b.v); }
    friend Float operator-(Float a) { return Float(-a.v); }
    friend Mask operator<(Float a, Float b) { return {a.v < b.v}; }
    friend Mask operator>(Float a, Float b) { return {b.v < a.v}; }
    friend Mask operator<=(Float a, Float b) { return {a.v <= b.v}; }
    friend Mask operator>=(Float a, Float b) { return {b.v <= a.v}; }
  };

  struct Int {
    std::int32_t v[kWidth];
    [[nodiscard]] static Int splat(std::uint32_t word) {
      const auto value = static_cast<std::int32_t>(word);
      return {{value, value, value, value}};
    }
    [[nodiscard]] static Int load(const std::uint32_t* source) {
      Int result;
      for (int i = 0; i < W; ++i) result.v[i] = static_cast<std::int32_t>(source[i]);
      return result;
    }
    [[nodiscard]] std::int32_t operator[](int lane) const { return v[lane]; }
    void store(std::uint32_t* target) const {
      for (int i = 0; i < W; ++i) target[i] = static_cast<std::uint32_t>(v[i]);
    }
    friend Int operator|(Int a, const Int& b) {
      for (int i = 0; i < W; ++i) a.v[i] |= b.v[i];
      return a;
    }
    friend Int operator<<(Int a, int count) {
      for (std::int32_t& lane : a.v) lane <<= count;
      return a;
    }
    friend Mask operator<(const Int& a, const Int& b) {
      return where([&](int i) { return a.v[i] < b.v[i]; });
    }
  };

  struct Long {
    std::int64_t v[kHalf];
    friend Long operator+(Long a, std::int64_t b) { return {{a.v[0] + b, a.v[1] + b}}; }
    friend Long operator-(Long a, std::int64_t b) { return {{a.v[0] - b, a.v[1] - b}}; }
    friend Long operator>>(Long a, int count) { return {{a.v[0] >> count, a.v[1] >> count}}; }
    friend Long operator&(Long a, Long b) { return {{a.v[0] & b.v[0], a.v[1] & b.v[1]}}; }
    friend Long operator~(Long a) { return {{~a.v[0], ~a.v[1]}}; }
    friend Long operator==(Long a, Long b) { return {{-(a.v[0] == b.v[0]), -(a.v[1] == b.v[1])}}; }
    friend Long operator>=(Long a, std::int64_t b) { return {{-(a.v[0] >= b), -(a.v[1] >= b)}}; }
    friend Long operator<=(Long a, std::int64_t b) { return {{-(a.v[0] <= b), -(a.v[1] <= b)}}; }
  };

  struct Double {
    CellDouble v[kHalf];

    explicit Double(CellDouble value) : v{value, value} {}
    Double(CellDouble low, CellDouble high) : v{low, high} {}
    [[nodiscard]] static Double load_floats(const CellFloat* source) {
      return {CellDouble(source[0]), CellDouble(source[1])};
    }
    [[nodiscard]] Long pattern() const {
      return {{std::bit_cast<std::int64_t>(v[0].value()), std::bit_cast<std::int64_t>(v[1].value())}};
    }
    friend Double operator+(Double a, Double b) { return {a.v[0] + b.v[0], a.v[1] + b.v[1]}; }
    friend Double operator-(Double a, Double b) { return {a.v[0] - b.v[0], a.v[1] - b.v[1]}; }
    friend Double operator*(Double a, Double b) { return {a.v[0] * b.v[0], a.v[1] * b.v[1]}; }
    friend Double operator/(Double a, Double b) { return {a.v[0] / b.v[0], a.v[1] / b.v[1]}; }
    friend Long operator<(Double a, CellDouble b) { return {{-(a.v[0] < b), -(a.v[1] < b)}}; }
  };

  /// Lane i by a function of i.
  template <class Function>
  [[nodiscard]] static Float each(Function&& function) {
    CellVector::Bits bits{};
    for (std::uint32_t i = 0; i < 4; ++i) bits[i] = function(i).bits();
    return Float(CellVector(bits));
  }
  template <class Function>
  [[nodiscard]] static Mask where(Function&& function) {
    std::uint32_t bits = 0;
    for (int i = 0; i < W; ++i) bits |= (function(i) ? 1u : 0u) << i;
    return {bits};
  }

  [[nodiscard]] static CellFloat lane(Float a, std::uint32_t lane) { return a.v.lane(lane); }
  [[nodiscard]] static Int truncate(Float a) {
    Int result;
    for (std::uint32_t i = 0; i < 4; ++i) result.v[i] = static_cast<std::int32_t>(a.v.lane(i).value());
    return result;
  }
  static void store_patterns(Long patterns, CellFloat* target) {
    for (std::size_t i = 0; i < kHalf; ++i) target[i] = CellFloat::from_bits(static_cast<std::uint32_t>(patterns.v[i]));
  }

  [[nodiscard]] static Float min(Float a, Float b) { return select(a < b, a, b); }
  [[nodiscard]] static Float max(Float a, Float b) { return select(a > b, a, b); }
  [[nodiscard]] static CellFloat horizontal_min(Float a) {
    CellFloat least = lane(a, 0);
    for (std::uint32_t i = 1; i < 4; ++i) least = lane(a, i) < least ? lane(a, i) : least;
    return least;
  }
  [[nodiscard]] static CellFloat horizontal_max(Float a) { return -horizontal_min(-a); }
  [[nodiscard]] static Float abs(Float a) { return Float(CellVector(a.v.bits() & 0x7FFFFFFFu)); }
  [[nodiscard]] static Float select(Mask mask, Float a, Float b) {
    constexpr CellVector::Bits kLanes = {1, 2, 4, 8};
    return Float(CellVector((kLanes & mask.m) != 0 ? a.v.bits() : b.v.bits()));
  }
  static void store_where(Mask mask, std::uint32_t value, std::uint32_t* target) {
    for (int i = 0; i < W; ++i) {
      if ((mask.m >> i & 1u) != 0) target[i] = value;
    }
  }
  [[nodiscard]] static Mask equal(std::uint32_t value, const std::uint32_t* words) {
    return where([&](int i) { return words[i] == value; });
  }
  [[nodiscard]] static Mask mask_from_bits(std::uint32_t bits) { return {bits & kAllBits}; }
  [[nodiscard]] static std::uint32_t half_bits(Long a) { return (a.v[0] < 0 ? 1u : 0u) | (a.v[1] < 0 ? 2u : 0u); }
  [[nodiscard]] static Float load_halves(const std::uint16_t* source) {
    return each([&](std::uint32_t i) { return CellFloat(source[i]); });
  }
  [[nodiscard]] static Float reciprocal_estimate(Float a) {
    const Float size = abs(a);
    const Float first(CellVector(0x7EF311C7u - size.v.bits()));
    const Float error = Float(1.0f) - size * first;
    const Float better = first + first * (error + error * error);
    return Float(CellVector(better.v.bits() | (a.v.bits() & 0x80000000u)));
  }
  [[nodiscard]] static Float load_quads(const CellFloat* const* sources) { return Float::load(sources[0]); }
  template <int I0, int I1, int I2, int I3>
  [[nodiscard]] static Float shuffle_quads(Float a, Float b) {
    return Float(CellVector(__builtin_shufflevector(a.v.bits(), b.v.bits(), I0, I1, I2, I3)));
  }
  template <int I0, int I1, int I2, int I3>
  [[nodiscard]] static Float shuffle_quads(Float a) {
    return shuffle_quads<I0, I1, I2, I3>(a, a);
  }
  [[nodiscard]] static Float flip_sign(Mask mask, Float a) { return select(mask, -a, a); }
};

/// To nearest in double, then rounded as all else. No part of what is shot here takes a root.
[[nodiscard]] inline CellFloat square_root(CellFloat value) {
  return CellFloat::truncated(__builtin_sqrt(value.value()));
}
[[nodiscard]] inline CellDouble square_root(CellDouble value) {
  return __builtin_sqrt(value.value());
}
[[nodiscard]] inline CellDouble magnitude(CellDouble value) {
  return __builtin_fabs(value.value());
}
[[nodiscard]] inline std::uint32_t lowest_bit(std::uint32_t bits) {
  return static_cast<std::uint32_t>(std::countr_zero(bits));
}
[[nodiscard]] inline std::uint32_t lowest_bit(std::uint64_t bits) {
  return static_cast<std::uint32_t>(std::countr_zero(bits));
}
template <class Word, std::uint32_t Count>
void fill_words(Word (&target)[Count], Word value) {
  for (Word& word : target) word = value;
}
[[nodiscard]] inline std::uint32_t count_bits(std::uint32_t bits) {
  return static_cast<std::uint32_t>(std::popcount(bits));
}

}  // namespace gridiron
