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

/// Puts the number of keys before each value in the place of that of keys that have it.
template <std::uint32_t kValues>
GRIDIRON_INLINE void sum_counts(std::uint32_t* counts) {
  std::uint32_t sum = 0;
  for (std::uint32_t i = 0; i < kValues; ++i) {
    const std::uint32_t here = counts[i];
    counts[i] = sum;
    sum += here;
  }
}

/// Sorts keys by some bits of their codes, digit by digit from the lowest on.
/// @returns whether the sorted keys are in `to`, else in `from`.
template <std::uint32_t kDigitBits, std::uint32_t kStride>
GRIDIRON_INLINE bool sort_by_digits(TreeKey* from, TreeKey* to, std::uint32_t count, std::uint32_t shift,
                                    std::uint32_t digits, std::uint32_t* counts) {
  constexpr std::uint32_t kValues = 1u << kDigitBits;
  for (std::uint32_t i = 0; i < digits * kValues; ++i) counts[i] = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t code = from[i * kStride].code() >> shift;
    for (std::uint32_t digit = 0; digit < digits; ++digit, code >>= kDigitBits) {
      ++counts[digit * kValues + code % kValues];
    }
  }
  for (std::uint32_t digit = 0; digit < digits; ++digit) {
    sum_counts<kValues>(counts + digit * kValues);
    move_by_digit<kValues, kStride>(from, to, count, shift + digit * kDigitBits, counts + digit * kValues);
    TreeKey* const sorted = to;
    to = from;
    from = sorted;
  }
  return digits % 2 != 0;
}

/// Sorts keys by exchanges with the ones before them. @returns whether it did within `most` of them.
template <std::uint32_t kStride>
GRIDIRON_INLINE bool sort_by_exchanges(TreeKey* keys, std::uint32_t count, std::uint32_t most) {
  std::uint32_t before = count > 0 ? keys[0].code() : std::uint32_t{0}, exchanges = 0;
  for (std::uint32_t i = 1; i < count; ++i) {
    const TreeKey key = keys[i * kStride];
    const std::uint32_t code = key.code();
    if (code >= before) {
      before = code;
      continue;
    }
    std::uint32_t place = i;
    for (; place > 0 && keys[(place - 1) * kStride].code() > code; --place) {
      keys[place * kStride] = keys[(place - 1) * kStride];
    }
    keys[place * kStride] = key;
    exchanges += i - place;
    if (exchanges > most) return false;
  }
  return true;
}

/// Sorts keys by the low bits of their codes: by two digits, those that are highest, and by exchanges, which mostly are
/// few; where they are not, digit by digit from the lowest on.
///
/// @param from, to  keys at every kStride'th place; both are changed.
/// @param bits      of the code by which keys differ, 0..kTreeCodeBits; bits above are the same in all.
/// @param transfers  counts the work.
/// @returns whether the sorted keys are in `to`, else in `from`.
template <std::uint32_t kDigitBits, std::uint32_t kStride, class P>
bool sort_run(TreeKey* from, TreeKey* to, std::uint32_t count, std::uint32_t bits, std::uint32_t* counts,
              BuildTransfers<P>& transfers) {
  constexpr std::uint32_t kValues = 1u << kDigitBits;
  const std::uint32_t digits = (bits + kDigitBits - 1) / kDigitBits, tried = digits < 2 ? digits : std::uint32_t{2};
  const std::uint32_t shift = bits > tried * kDigitBits ? bits - tried * kDigitBits : std::uint32_t{0};
  transfers.add_work(BuildWork::kSortCount, tried * kValues);
  transfers.add_work(BuildWork::kMovedKey, tried * count);
  const bool is_in_to = sort_by_digits<kDigitBits, kStride>(from, to, count, shift, tried, counts);
  if (shift == 0) return is_in_to;
  TreeKey* const keys = is_in_to ? to : from;
  transfers.add_work(BuildWork::kExchangedKey, count);
  if (sort_by_exchanges<kStride>(keys, count, 2 * count)) return is_in_to;
  // Equal ones still have their order.
  transfers.add_work(BuildWork::kSortCount, digits * kValues);
  transfers.add_work(BuildWork::kMovedKey, digits * count);
  const bool is_in_other = sort_by_digits<kDigitBits, kStride>(keys, is_in_to ? from : to, count, 0, digits, counts);
  return is_in_other != is_in_to;
}

}  // namespace gridiron
