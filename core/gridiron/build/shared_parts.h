// How builders and checks divide their work: see work_sharing.h. Without GRIDIRON_SHARES_WORK, which is defined where
// these libraries are compiled for an operating system, nothing is divided: code and stack are those of one thread.
// Internal header, for core's own sources. Memory: values. Threads: those of the caller.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/build/work_sharing.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace gridiron {

#ifdef GRIDIRON_SHARES_WORK
constexpr bool kSharesWork = true;
#else
constexpr bool kSharesWork = false;
#endif
constexpr std::uint32_t kMostShares = kSharesWork ? kMostSharers : 1;

/// Shares of a work that is large enough to be divided.
[[nodiscard]] static inline std::uint32_t shares_for([[maybe_unused]] const WorkSharing& sharing) {
  if constexpr (!kSharesWork) return 1;
  if (sharing.run == nullptr || sharing.sharers == 0) return 1;
  return sharing.sharers < kMostShares ? sharing.sharers : kMostShares;
}

/// Calls work(i) for each i < count; where the work is shared, in any order and at the same time.
template <class Work>
static GRIDIRON_INLINE void share([[maybe_unused]] const WorkSharing& sharing, std::uint32_t count, Work&& work) {
  if constexpr (kSharesWork) {
    if (sharing.run != nullptr && count > 1) {
      using Called = std::remove_reference_t<Work>;
      const auto call = [](void* called, std::uint32_t i) { (*static_cast<Called*>(called))(i); };
      sharing.run(sharing.team, count, call, &work);
      return;
    }
  }
  for (std::uint32_t i = 0; i < count; ++i) work(i);
}

/// Elements [begin, end).
struct Share {
  std::size_t begin, end;

  [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// @returns share `i` of `shares` of so many elements: all but the last are multiples of `unit` long.
[[nodiscard]] constexpr Share share_of(std::size_t count, std::uint32_t shares, std::uint32_t i, std::size_t unit = 1) {
  const std::size_t units = (count + unit - 1) / unit;
  const std::size_t begin = units * i / shares * unit, end = units * (i + 1) / shares * unit;
  return {begin, end < count ? end : count};
}

}  // namespace gridiron
