// Four CellFloats at once, for the sake of speed: the same bits as CellFloat, which says why.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>

#include "numeric/watertight/cell/cell_float.h"

namespace watertight {

class CellVector {
 public:
  typedef std::uint32_t Bits __attribute__((vector_size(16)));
  typedef double Values __attribute__((vector_size(32)));

  CellVector() = default;
  explicit CellVector(Bits bits) : bits_(bits) {}
  explicit CellVector(CellFloat value) : bits_(Bits{} + value.bits()) {}
  [[nodiscard]] static CellVector load(const CellFloat* source) {
    CellVector result;
    std::memcpy(&result.bits_, source, sizeof(result.bits_));
    return result;
  }
  void store(CellFloat* target) const { std::memcpy(static_cast<void*>(target), &bits_, sizeof(bits_)); }
  [[nodiscard]] Bits bits() const { return bits_; }
  [[nodiscard]] CellFloat lane(std::uint32_t i) const { return CellFloat::from_bits(bits_[i]); }

  [[nodiscard]] Values values() const {
    const Wide wide = __builtin_convertvector(bits_, Wide);
    const Wide size = wide & 0x7FFFFFFFu;
    const Wide pattern = ((size << 29) + (kRebias << 52)) | (wide >> 31 << 63);
    return reinterpret_cast<Values>(pattern & reinterpret_cast<Wide>(size >= 0x00800000u));
  }

  friend CellVector operator+(CellVector a, CellVector b) { return sum(a.values(), b.values()); }
  friend CellVector operator-(CellVector a, CellVector b) { return sum(a.values(), -b.values()); }
  friend CellVector operator*(CellVector a, CellVector b) {
    return truncated(reinterpret_cast<Wide>(a.values() * b.values()));
  }
  friend CellVector operator/(CellVector a, CellVector b) {
    Bits result{};
    for (std::uint32_t i = 0; i < 4; ++i) result[i] = (a.lane(i) / b.lane(i)).bits();
    return CellVector(result);
  }
  friend CellVector operator-(CellVector a) { return CellVector(a.bits_ ^ 0x80000000u); }
  /// Bit i = lane i.
  friend std::uint32_t operator<(CellVector a, CellVector b) { return gather(a.values() < b.values()); }
  friend std::uint32_t operator<=(CellVector a, CellVector b) { return gather(a.values() <= b.values()); }

 private:
  typedef std::uint64_t Wide __attribute__((vector_size(32)));
  typedef std::int64_t Truth __attribute__((vector_size(32)));
  static constexpr std::uint64_t kRebias = 1023 - 127;

  [[nodiscard]] static std::uint32_t gather(Truth truth) {
    std::uint32_t result = 0;
    for (std::uint32_t i = 0; i < 4; ++i) result |= (static_cast<std::uint32_t>(truth[i]) & 1u) << i;
    return result;
  }
  [[nodiscard]] static CellVector truncated(Wide pattern) {
    const Wide size = pattern & 0x7FFFFFFFFFFFFFFFu;
    const Wide sign = pattern >> 63 << 31;
    const Wide moved = (size >> 29) - (kRebias << 23);
    const Wide is_in_range = reinterpret_cast<Wide>(size >= (kRebias + 1) << 52);
    const Wide is_too_large = reinterpret_cast<Wide>(size >= (kRebias + 256) << 52);
    const Wide kept = (is_too_large & 0x7FFFFFFFu) | (~is_too_large & moved);
    return CellVector(__builtin_convertvector((kept | sign) & is_in_range, Bits));
  }
  [[nodiscard]] static CellVector sum(Values a, Values b) {
    const Values near = a + b;
    const Values b_part = near - a;
    const Values rest = (a - (near - b_part)) + (b - b_part);
    Wide pattern = reinterpret_cast<Wide>(near);
    const Truth is_float = (pattern & 0x1FFFFFFFu) == 0;
    const Truth is_farther = ((rest < 0.0) ^ (near < 0.0)) & (rest != 0.0);
    pattern += reinterpret_cast<Wide>(is_float & is_farther);  // a truth is -1
    return truncated(pattern);
  }

  Bits bits_;
};

}  // namespace watertight
