// Sorts keys in a core's store by their codes, equal ones in the order they have.
// Memory: caller's. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/build/passes/build_work.h>
#include <gridiron/build/tree/tree_curve.h>
#include <gridiron/dma/transfers.h>

#include <cstdint>

namespace gridiron {

/// Words of counts that sort_run() needs.
template <std::uint32_t kDigitBits>
inline constexpr std::uint32_t kSortCounts = ((kTreeCodeBits + kDigitBits - 1) / kDigitBits) << kDigitBits;

/// How far keys may have to move in all, for each of them, to be sorted by exchanges.
inline constexpr std::uint32_t kMostExchanges = 6;

/// Moves keys to where one digit of their codes belongs.
/// @param places  by value of the digit, of the first key that has it; ends at the next one's.
template <std::uint32_t kValues, std::uint32_t kStride>
GRIDIRON_INLINE void move_by_digit(const TreeKey* from, TreeKey* to, std::uint32_t count, std::uint32_t shift,
                                   std::uint32_t* places) {
  for (std::uint32_t i = 0; i < count; ++i) {
    const TreeKey key = from[i * kStride];
    to[places[(key.code() >> shift) % kValues]++ * kStride] = key;
  }
}

/// Puts the number of keys before each value in the place of that of keys that have it. @returns how many exchanges the
/// keys of each value may take among themselves, at most.
template <std::uint32_t kValues>
GRIDIRON_INLINE std::uint64_t sum_counts(std::uint32_t* counts) {
  std::uint32_t sum = 0;
  std::uint64_t pairs = 0;
  for (std::uint32_t i = 0; i < kValues; ++i) {
    const std::uint32_t here = counts[i];
    counts[i] = sum;
    sum += here;
    pairs += std::uint64_t{here} * here;
  }
  return pairs / 2;
}

/// Sorts keys by the low bits of their codes: by the highest digit of these, then by exchanges, if few keys share a value
/// of it; else digit by digit from the lowest on.
///
/// @param from, to  keys at every kStride'th place; both are changed.
/// @param bits      of the code by which keys differ, 0..kTreeCodeBits.
/// @param transfers  counts the work.
/// @returns whether the sorted keys are in `to`, else in `from`.
template <std::uint32_t kDigitBits, std::uint32_t kStride, class P>
bool sort_run(TreeKey* from, TreeKey* to, std::uint32_t count, std::uint32_t bits, std::uint32_t* counts,
              Transfers<P>& transfers) {
  constexpr std::uint32_t kValues = 1u << kDigitBits;
  if (bits == 0) return false;
  const std::uint32_t high_shift = bits > kDigitBits ? bits - kDigitBits : std::uint32_t{0};
  transfers.add_work(BuildWork::kSortCount, kValues);
  transfers.add_work(BuildWork::kMovedKey, count);
  for (std::uint32_t i = 0; i < kValues; ++i) counts[i] = 0;
  for (std::uint32_t i = 0; i < count; ++i) ++counts[(from[i * kStride].code() >> high_shift) % kValues];
  if (sum_counts<kValues>(counts) <= std::uint64_t{kMostExchanges} * count) {
    move_by_digit<kValues, kStride>(from, to, count, high_shift, counts);
    if (high_shift == 0) return true;
    transfers.add_work(BuildWork::kExchangedKey, count);
    std::uint32_t before = count > 0 ? to[0].code() : std::uint32_t{0};
    for (std::uint32_t i = 1; i < count; ++i) {
      const TreeKey key = to[i * kStride];
      const std::uint32_t code = key.code();
      if (code >= before) {
        before = code;
        continue;
      }
      std::uint32_t place = i;
      for (; place > 0 && to[(place - 1) * kStride].code() > code; --place) {
        to[place * kStride] = to[(place - 1) * kStride];
      }
      to[place * kStride] = key;
    }
    return true;
  }

  const std::uint32_t digits = (bits + kDigitBits - 1) / kDigitBits;
  transfers.add_work(BuildWork::kSortCount, digits * kValues);
  transfers.add_work(BuildWork::kMovedKey, digits * count);
  for (std::uint32_t i = 0; i < digits * kValues; ++i) counts[i] = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t code = from[i * kStride].code();
    for (std::uint32_t digit = 0; digit < digits; ++digit, code >>= kDigitBits) {
      ++counts[digit * kValues + code % kValues];
    }
  }
  for (std::uint32_t digit = 0; digit < digits; ++digit) {
    static_cast<void>(sum_counts<kValues>(counts + digit * kValues));
    move_by_digit<kValues, kStride>(from, to, count, digit * kDigitBits, counts + digit * kValues);
    TreeKey* const sorted = to;
    to = from;
    from = sorted;
  }
  return digits % 2 != 0;
}

}  // namespace gridiron
