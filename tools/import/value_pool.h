// Value pool: equal vectors once, in the order of their first use.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace gridiron::tool {

/// Gives equal bits one index.
class ValuePool {
 public:
  /// @returns the index of a value, which may be new. At most 2^32 - 1 values.
  std::uint32_t index_of(const Vec3& value) {
    if (2 * (values_.size() + 1) > places_.size()) grow();
    std::size_t place = hash(value) & (places_.size() - 1);
    while (places_[place] != kFree) {  // ends: at most half of the places are taken
      if (bits(values_[places_[place]]) == bits(value)) return places_[place];
      place = (place + 1) & (places_.size() - 1);
    }
    places_[place] = static_cast<std::uint32_t>(values_.size());
    values_.push_back(value);
    return places_[place];
  }

  [[nodiscard]] std::size_t size() const { return values_.size(); }

  /// Takes the values out; the pool is used up.
  [[nodiscard]] std::vector<Vec3> take() {
    places_ = {};
    return std::move(values_);
  }

 private:
  static constexpr std::uint32_t kFree = 0xFFFFFFFFu;

  static std::array<std::uint32_t, 3> bits(const Vec3& value) {
    return {std::bit_cast<std::uint32_t>(value.x), std::bit_cast<std::uint32_t>(value.y),
            std::bit_cast<std::uint32_t>(value.z)};
  }
  static std::size_t hash(const Vec3& value) {
    std::uint64_t state = 0;
    for (const std::uint32_t word : bits(value)) {
      state = (state ^ word) * 0x9E3779B97F4A7C15u;
      state ^= state >> 29;
    }
    return static_cast<std::size_t>(state);
  }
  void grow() {
    places_.assign(places_.empty() ? 64 : places_.size() * 2, kFree);
    for (std::size_t i = 0; i < values_.size(); ++i) {
      std::size_t place = hash(values_[i]) & (places_.size() - 1);
      while (places_[place] != kFree) place = (place + 1) & (places_.size() - 1);
      places_[place] = static_cast<std::uint32_t>(i);
    }
  }

  std::vector<Vec3> values_;
  std::vector<std::uint32_t> places_;
};

}  // namespace gridiron::tool
