// Four 32-bit words in a vector, next to the floats of core's lanes. Source: GCC vector extensions.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>

#include <cstdint>

namespace gridiron::bvh {

/// Words side by side; operations per word. In a mask all bits of a word are equal.
struct FourWords {
  using Four = Lanes<4>;
  LaneVectors<4>::IntVector v;

  /// @param source  16-byte aligned.
  [[nodiscard]] static GRIDIRON_INLINE FourWords load(const std::uint32_t* source) {
    return {*reinterpret_cast<const Memory*>(source)};
  }
  GRIDIRON_INLINE void store(std::uint32_t* target) const { *reinterpret_cast<Memory*>(target) = v; }
  [[nodiscard]] static GRIDIRON_INLINE FourWords splat(std::uint32_t word) {
    const auto value = static_cast<std::int32_t>(word);
    return {LaneVectors<4>::IntVector{value, value, value, value}};
  }
  /// `constant` where the mask is set, else 0.
  [[nodiscard]] static GRIDIRON_INLINE FourWords where(Four::Mask mask, std::uint32_t constant) {
    return {mask.v & splat(constant).v};
  }
  [[nodiscard]] static GRIDIRON_INLINE FourWords select(Four::Mask mask, FourWords a, FourWords b) {
    return {(a.v & mask.v) | (b.v & ~mask.v)};
  }
  friend GRIDIRON_INLINE FourWords operator|(FourWords a, FourWords b) { return {a.v | b.v}; }
  friend GRIDIRON_INLINE FourWords operator&(FourWords a, FourWords b) { return {a.v & b.v}; }
  [[nodiscard]] GRIDIRON_INLINE Four::Mask equal(FourWords other) const { return {v == other.v}; }
  /// As signed numbers.
  [[nodiscard]] GRIDIRON_INLINE Four::Mask less(FourWords other) const { return {v < other.v}; }
  /// The same, reversed where `turned` is set.
  [[nodiscard]] GRIDIRON_INLINE Four::Mask less_but(FourWords other, FourWords turned) const {
    return {(v < other.v) ^ turned.v};
  }
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t word(std::uint32_t index) const {
    return static_cast<std::uint32_t>(v[index]);
  }
  /// The same bits.
  [[nodiscard]] GRIDIRON_INLINE Four::Float floats() const {
    return Four::Float(reinterpret_cast<LaneVectors<4>::FloatVector>(v));
  }
  [[nodiscard]] static GRIDIRON_INLINE FourWords of(Four::Float floats) {
    return {reinterpret_cast<LaneVectors<4>::IntVector>(floats.v)};
  }

 private:
  typedef std::int32_t Memory __attribute__((vector_size(16), may_alias));
};

}  // namespace gridiron::bvh
