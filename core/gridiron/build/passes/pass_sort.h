// Sorts keys in a core's store, digit by digit.
// Memory: caller's. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/build/tree/tree_curve.h>

#include <cstdint>

namespace gridiron {

/// Words of counts that sort_run() needs.
template <std::uint32_t kDigitBits>
inline constexpr std::uint32_t kSortCounts = ((kTreeCodeBits + kDigitBits - 1) / kDigitBits) << kDigitBits;

/// Sorts keys by the low bits of their codes, equal ones in the order they have.
///
/// @param from, to  keys at every kStride'th place; both are changed.
/// @param bits      of the code by which keys differ, 0..kTreeCodeBits.
/// @returns whether the sorted keys are in `to`, else in `from`.
template <std::uint32_t kDigitBits, std::uint32_t kStride>
bool sort_run(TreeKey* from, TreeKey* to, std::uint32_t count, std::uint32_t bits, std::uint32_t* counts) {
  constexpr std::uint32_t kValues = 1u << kDigitBits;
  const std::uint32_t digits = (bits + kDigitBits - 1) / kDigitBits;
  for (std::uint32_t i = 0; i < digits * kValues; ++i) counts[i] = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t code = from[i * kStride].code();
    for (std::uint32_t digit = 0; digit < digits; ++digit, code >>= kDigitBits) {
      ++counts[digit * kValues + code % kValues];
    }
  }
  for (std::uint32_t digit = 0; digit < digits; ++digit) {
    std::uint32_t* const places = counts + digit * kValues;
    std::uint32_t sum = 0;
    for (std::uint32_t i = 0; i < kValues; ++i) {
      const std::uint32_t here = places[i];
      places[i] = sum;
      sum += here;
    }
    const std::uint32_t shift = digit * kDigitBits;
    for (std::uint32_t i = 0; i < count; ++i) {
      const TreeKey key = from[i * kStride];
      to[places[(key.code() >> shift) % kValues]++ * kStride] = key;
    }
    TreeKey* const sorted = to;
    to = from;
    from = sorted;
  }
  return digits % 2 != 0;
}

}  // namespace gridiron
