// One lane, for cores without vectors. It has what renderers without packets need of lanes, in a third of the code that
// four lanes take in those of effects. Changes no pixel.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>

#include <bit>
#include <cstdint>

namespace gridiron {

/// A truth value with the interface of wider masks.
template <>
struct LaneMask<1> {
  bool is_set;

  [[nodiscard]] GRIDIRON_INLINE std::uint32_t bits() const { return is_set ? 1u : 0u; }
  friend GRIDIRON_INLINE LaneMask operator|(LaneMask a, LaneMask b) { return {a.is_set || b.is_set}; }
  friend GRIDIRON_INLINE LaneMask operator&(LaneMask a, LaneMask b) { return {a.is_set && b.is_set}; }
};

/// Every operation is the IEEE one; min and max choose operands as those of wider lanes do.
template <>
struct Lanes<1> {
  static constexpr int kCount = 1;
  static constexpr std::uint32_t kAllBits = 1;

  using Mask = LaneMask<1>;

  struct Float {
    float v;

    Float() = default;
    GRIDIRON_INLINE explicit Float(float value) : v(value) {}
    [[nodiscard]] static GRIDIRON_INLINE Float load(const float* source) { return Float(*source); }
    GRIDIRON_INLINE void store(float* target) const { *target = v; }

    friend GRIDIRON_INLINE Float operator+(Float a, Float b) { return Float(a.v + b.v); }
    friend GRIDIRON_INLINE Float operator-(Float a, Float b) { return Float(a.v - b.v); }
    friend GRIDIRON_INLINE Float operator*(Float a, Float b) { return Float(a.v * b.v); }
    friend GRIDIRON_INLINE Float operator/(Float a, Float b) { return Float(a.v / b.v); }
    friend GRIDIRON_INLINE Float operator-(Float a) { return Float(-a.v); }
    friend GRIDIRON_INLINE Mask operator<(Float a, Float b) { return {a.v < b.v}; }
    friend GRIDIRON_INLINE Mask operator>(Float a, Float b) { return {a.v > b.v}; }
    friend GRIDIRON_INLINE Mask operator<=(Float a, Float b) { return {a.v <= b.v}; }
    friend GRIDIRON_INLINE Mask operator>=(Float a, Float b) { return {a.v >= b.v}; }
  };

  /// One signed integer.
  struct Int {
    std::int32_t v;

    [[nodiscard]] static GRIDIRON_INLINE Int splat(std::uint32_t word) { return {static_cast<std::int32_t>(word)}; }
    [[nodiscard]] static GRIDIRON_INLINE Int load(const std::uint32_t* source) { return splat(*source); }
    GRIDIRON_INLINE void store(std::uint32_t* target) const { *target = static_cast<std::uint32_t>(v); }

    friend GRIDIRON_INLINE Int operator+(Int a, Int b) { return {a.v + b.v}; }
    friend GRIDIRON_INLINE Int operator|(Int a, Int b) { return {a.v | b.v}; }
    friend GRIDIRON_INLINE Int operator&(Int a, Int b) { return {a.v & b.v}; }
    friend GRIDIRON_INLINE Int operator^(Int a, Int b) { return {a.v ^ b.v}; }
    friend GRIDIRON_INLINE Int operator<<(Int a, int count) { return {a.v << count}; }
    friend GRIDIRON_INLINE Int operator>>(Int a, int count) { return {a.v >> count}; }
    friend GRIDIRON_INLINE Mask operator<(Int a, Int b) { return {a.v < b.v}; }
  };

  /// An integer of 64 bits. Comparisons give -1 where they hold, else 0.
  struct Long {
    std::int64_t v;

    friend GRIDIRON_INLINE Long operator+(Long a, std::int64_t b) { return {a.v + b}; }
    friend GRIDIRON_INLINE Long operator-(Long a, std::int64_t b) { return {a.v - b}; }
    friend GRIDIRON_INLINE Long operator>>(Long a, int count) { return {a.v >> count}; }
    friend GRIDIRON_INLINE Long operator&(Long a, Long b) { return {a.v & b.v}; }
    friend GRIDIRON_INLINE Long operator~(Long a) { return {~a.v}; }
    friend GRIDIRON_INLINE Long operator==(Long a, Long b) { return {a.v == b.v ? -1 : 0}; }
    friend GRIDIRON_INLINE Long operator>=(Long a, std::int64_t b) { return {a.v >= b ? -1 : 0}; }
    friend GRIDIRON_INLINE Long operator<=(Long a, std::int64_t b) { return {a.v <= b ? -1 : 0}; }
  };
  /// A double: half of the lanes, rounded up.
  struct Double {
    double v;

    GRIDIRON_INLINE explicit Double(double value) : v(value) {}
    [[nodiscard]] static GRIDIRON_INLINE Double load_floats(const float* source) { return Double(double{*source}); }
    [[nodiscard]] GRIDIRON_INLINE Long pattern() const { return {std::bit_cast<std::int64_t>(v)}; }

    friend GRIDIRON_INLINE Double operator+(Double a, Double b) { return Double(a.v + b.v); }
    friend GRIDIRON_INLINE Double operator-(Double a, Double b) { return Double(a.v - b.v); }
    friend GRIDIRON_INLINE Double operator*(Double a, Double b) { return Double(a.v * b.v); }
    friend GRIDIRON_INLINE Double operator/(Double a, Double b) { return Double(a.v / b.v); }
    friend GRIDIRON_INLINE Long operator<(Double a, double b) { return {a.v < b ? -1 : 0}; }
  };
  static GRIDIRON_INLINE void store_patterns(Long patterns, float* target) {
    *target = std::bit_cast<float>(static_cast<std::uint32_t>(patterns.v));
  }
  [[nodiscard]] static GRIDIRON_INLINE std::uint32_t half_bits(Long a) { return a.v < 0 ? 1u : 0u; }

  [[nodiscard]] static GRIDIRON_INLINE Int truncate(Float a) { return {static_cast<std::int32_t>(a.v)}; }
  [[nodiscard]] static GRIDIRON_INLINE Int words_of(Float a) { return {std::bit_cast<std::int32_t>(a.v)}; }
  [[nodiscard]] static GRIDIRON_INLINE Float floats_of(Int a) { return Float(std::bit_cast<float>(a.v)); }
  [[nodiscard]] static GRIDIRON_INLINE Float to_float(Int a) { return Float(static_cast<float>(a.v)); }

  [[nodiscard]] static GRIDIRON_INLINE Float min(Float a, Float b) { return a.v < b.v ? a : b; }
  [[nodiscard]] static GRIDIRON_INLINE Float max(Float a, Float b) { return a.v > b.v ? a : b; }
  static constexpr bool kRoundsOnce = false;
  [[nodiscard]] static GRIDIRON_INLINE Float bounded_sum(Float a, Float b, Float c) { return a * b + c; }
  [[nodiscard]] static GRIDIRON_INLINE Float bounded_difference(Float a, Float b, Float c, Float d) {
    return a * b - c * d;
  }
  [[nodiscard]] static GRIDIRON_INLINE Float abs(Float a) { return Float(magnitude(a.v)); }
  [[nodiscard]] static GRIDIRON_INLINE Float larger_size(Float a, Float b) { return max(abs(a), abs(b)); }
  [[nodiscard]] static GRIDIRON_INLINE Float square_root(Float a) { return Float(__builtin_sqrtf(a.v)); }
  /// As of wider lanes, bit by bit.
  [[nodiscard]] static GRIDIRON_INLINE Float reciprocal_estimate(Float a) {
    const auto bits = std::bit_cast<std::uint32_t>(a.v);
    const Float first(std::bit_cast<float>(0x7EF311C7u - (bits & 0x7FFFFFFFu)));
    const Float error = Float(1.0f) - abs(a) * first;
    const Float better = first + first * (error + error * error);
    return Float(std::bit_cast<float>(std::bit_cast<std::uint32_t>(better.v) | (bits & 0x80000000u)));
  }
  [[nodiscard]] static GRIDIRON_INLINE Float select(Mask mask, Float a, Float b) { return mask.is_set ? a : b; }
  [[nodiscard]] static GRIDIRON_INLINE Int select(Mask mask, Int a, Int b) { return mask.is_set ? a : b; }
  [[nodiscard]] static GRIDIRON_INLINE Mask equal(std::uint32_t value, const std::uint32_t* words) {
    return {*words == value};
  }
  // Whole quads of lanes are rows of pixels; of one lane they are pixels.
  [[nodiscard]] static GRIDIRON_INLINE Float repeat_quad(const float* source) { return Float(*source); }
  [[nodiscard]] static GRIDIRON_INLINE Float splat_quads(const float* source) { return Float(*source); }
  static GRIDIRON_INLINE void store_quads(Int a, std::uint32_t* target, std::uint32_t) { a.store(target); }
  static GRIDIRON_INLINE void store_quads(Float a, float* target, std::uint32_t) { a.store(target); }
  static GRIDIRON_INLINE void compress(Int a, std::uint32_t, std::uint32_t* target) { a.store(target); }
  struct Packing {
    std::uint32_t bits, count;
  };
  static GRIDIRON_INLINE void append(const Packing& packing, Int a, std::uint32_t* target) {
    a.store(target + packing.count);
  }
  template <class Quad>
  static GRIDIRON_INLINE void copy_quad(const Quad& source, Quad& target) {
    target = source;
  }
  [[nodiscard]] static GRIDIRON_INLINE std::uint32_t sign_bits(Int a) { return a.v < 0 ? 1u : 0u; }
  [[nodiscard]] static GRIDIRON_INLINE Float flip_sign(Mask mask, Float a) { return mask.is_set ? -a : a; }
  [[nodiscard]] static GRIDIRON_INLINE Float turn_by(Float by, Float a) {
    return __builtin_signbit(by.v) != 0 ? -a : a;
  }
  [[nodiscard]] static GRIDIRON_INLINE Mask mask_from_bits(std::uint32_t bits) { return {(bits & 1u) != 0}; }
  [[nodiscard]] static GRIDIRON_INLINE float horizontal_max(Float a) { return a.v; }
  [[nodiscard]] static GRIDIRON_INLINE float horizontal_min(Float a) { return a.v; }
};

}  // namespace gridiron
