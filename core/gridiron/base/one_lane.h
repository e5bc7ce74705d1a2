// One lane, for cores without vectors. It has what renderers without packets need of lanes, in a third of the code that
// four lanes take there. Changes no pixel.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>

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

  [[nodiscard]] static GRIDIRON_INLINE Float min(Float a, Float b) { return a.v < b.v ? a : b; }
  [[nodiscard]] static GRIDIRON_INLINE Float max(Float a, Float b) { return a.v > b.v ? a : b; }
  static constexpr bool kRoundsOnce = false;
  [[nodiscard]] static GRIDIRON_INLINE Float bounded_sum(Float a, Float b, Float c) { return a * b + c; }
  [[nodiscard]] static GRIDIRON_INLINE Float bounded_difference(Float a, Float b, Float c, Float d) {
    return a * b - c * d;
  }
  [[nodiscard]] static GRIDIRON_INLINE Float abs(Float a) { return Float(magnitude(a.v)); }
  [[nodiscard]] static GRIDIRON_INLINE Float larger_size(Float a, Float b) { return max(abs(a), abs(b)); }
  [[nodiscard]] static GRIDIRON_INLINE Float select(Mask mask, Float a, Float b) { return mask.is_set ? a : b; }
  [[nodiscard]] static GRIDIRON_INLINE Float flip_sign(Mask mask, Float a) { return mask.is_set ? -a : a; }
  [[nodiscard]] static GRIDIRON_INLINE Float turn_by(Float by, Float a) {
    return __builtin_signbit(by.v) != 0 ? -a : a;
  }
  [[nodiscard]] static GRIDIRON_INLINE Mask mask_from_bits(std::uint32_t bits) { return {(bits & 1u) != 0}; }
  [[nodiscard]] static GRIDIRON_INLINE float horizontal_max(Float a) { return a.v; }
  [[nodiscard]] static GRIDIRON_INLINE float horizontal_min(Float a) { return a.v; }
};

}  // namespace gridiron
