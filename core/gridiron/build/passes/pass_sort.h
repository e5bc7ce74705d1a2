// Sorts keys in a core's store by their codes, equal ones in the order they have.
// Memory: caller's. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/build/passes/build_transfers.h>
#include <gridiron/build/tree/tree_curve.h>
#include <gridiron/dma/transfers.h>

#include <cstdint>
#include <type_traits>

namespace gridiron {

/// A count of keys fills a quadword: a store writes no less, so a narrower one would have to be put into what is there.
inline constexpr std::uint32_t kCountWords = 4;
/// Digits that are sorted by at once.
inline constexpr std::uint32_t kDigitsAtOnce = 2;
/// Words of counts that sort_run() needs, aligned to 16 bytes.
template <std::uint32_t kDigitBits>
inline constexpr std::uint32_t kSortCounts = (kDigitsAtOnce * kCountWords) << kDigitBits;

/// Calls use(first, group) for keys [0, count) in groups: `group.value` of them, a constant.
template <class Use>
GRIDIRON_INLINE void for_each_group(std::uint32_t count, Use&& use) {
  static constexpr std::uint32_t kGroup = 4;
  std::uint32_t i = 0;
  for (; count - i >= kGroup; i += kGroup) use(i, std::integral_constant<std::uint32_t, kGroup>{});
  for (; i < count; ++i) use(i, std::integral_constant<std::uint32_t, 1>{});
}

/// @returns how many digits so many bits are, without a division.
[[nodiscard]] inline std::uint32_t digits_of(std::uint32_t bits, std::uint32_t digit_bits) {
  std::uint32_t digits = 0;
  for (std::uint32_t i = 0; i < bits; i += digit_bits) ++digits;
  return digits;
}

/// Sorts keys by one or two digits of their codes, the lower one first.
/// @returns whether the sorted keys are in `to`, else in `from`.
template <std::uint32_t kStride, class P>
GRIDIRON_OUTLINE bool sort_by_digits(TreeKey* from, TreeKey* to, std::uint32_t count, std::uint32_t digit_bits,
                                     std::uint32_t shift, std::uint32_t digits, std::uint32_t* counts,
                                     BuildTransfers<P>& transfers) {
  using Int = Lanes<4>::Int;
  const std::uint32_t values = 1u << digit_bits, last_value = values - 1;
  transfers.add_work(BuildWork::kSortCount, digits * values);
  for (std::uint32_t i = 0; i < digits * values; ++i) Int::splat(0).store(counts + i * kCountWords);
  transfers.add_work(BuildWork::kMovedKey, digits * count);
  const auto count_one = [counts](std::uint32_t value) GRIDIRON_INLINE_LAMBDA {
    std::uint32_t* const place = counts + value * kCountWords;
    (Int::load(place) + Int::splat(1)).store(place);
  };
  // Several keys at a time, so that their loads do not wait for the counts of the ones before.
  const auto count_keys = [&](std::uint32_t first, auto group) GRIDIRON_INLINE_LAMBDA {
    std::uint32_t codes[group.value];
    for (std::uint32_t k = 0; k < group.value; ++k) codes[k] = from[(first + k) * kStride].code() >> shift;
    for (std::uint32_t k = 0; k < group.value; ++k) count_one(codes[k] & last_value);
    if (digits == 1) return;
    for (std::uint32_t k = 0; k < group.value; ++k) count_one(values + ((codes[k] >> digit_bits) & last_value));
  };
  for_each_group(count, count_keys);
  for (std::uint32_t digit = 0; digit < digits; ++digit) {
    transfers.charge_to(BuildWork::kSortCount);
    // The number of keys before each value in the place of that of keys that have it.
    std::uint32_t* const places = counts + digit * values * kCountWords;
    Int sum = Int::splat(0);
    for (std::uint32_t i = 0; i < values; ++i) {
      const Int here = Int::load(places + i * kCountWords);
      sum.store(places + i * kCountWords);
      sum = sum + here;
    }
    transfers.charge_to(BuildWork::kMovedKey);
    const auto move_keys = [&](std::uint32_t first, auto group) GRIDIRON_INLINE_LAMBDA {
      TreeKey keys[group.value];
      for (std::uint32_t k = 0; k < group.value; ++k) keys[k] = from[(first + k) * kStride];
      for (const TreeKey key : keys) {
        std::uint32_t* const next = places + ((key.code() >> shift) & last_value) * kCountWords;
        const Int place = Int::load(next);
        (place + Int::splat(1)).store(next);
        to[static_cast<std::uint32_t>(place[0]) * kStride] = key;
      }
    };
    for_each_group(count, move_keys);
    TreeKey* const sorted = to;
    to = from;
    from = sorted;
    shift += digit_bits;
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
/// @param digit_bits  of a digit.
/// @param bits      of the code by which keys differ, 0..kTreeCodeBits; bits above are the same in all.
/// @param transfers  counts the work.
/// @returns whether the sorted keys are in `to`, else in `from`.
template <std::uint32_t kStride, class P>
bool sort_run(TreeKey* from, TreeKey* to, std::uint32_t count, std::uint32_t digit_bits, std::uint32_t bits,
              std::uint32_t* counts, BuildTransfers<P>& transfers) {
  const std::uint32_t digits = digits_of(bits, digit_bits), tried = digits < kDigitsAtOnce ? digits : kDigitsAtOnce;
  const std::uint32_t shift = bits > tried * digit_bits ? bits - tried * digit_bits : std::uint32_t{0};
  const bool is_in_to = sort_by_digits<kStride>(from, to, count, digit_bits, shift, tried, counts, transfers);
  if (shift == 0) return is_in_to;
  TreeKey* const keys = is_in_to ? to : from;
  transfers.add_work(BuildWork::kExchangedKey, count);
  if (sort_by_exchanges<kStride>(keys, count, 2 * count)) return is_in_to;
  // Equal ones still have their order.
  TreeKey* spare = is_in_to ? from : to;
  TreeKey* sorted = keys;
  for (std::uint32_t done = 0; done < digits; done += kDigitsAtOnce) {
    const std::uint32_t left = digits - done;
    if (sort_by_digits<kStride>(sorted, spare, count, digit_bits, done * digit_bits,
                                left < kDigitsAtOnce ? left : kDigitsAtOnce, counts, transfers)) {
      TreeKey* const other = sorted;
      sorted = spare;
      spare = other;
    }
  }
  return sorted == to;
}

}  // namespace gridiron
