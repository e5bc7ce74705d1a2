// Sharing of work on the host: builders and checks of large images take several threads, if the caller has them. Core
// starts none itself. Results do not depend on how many there are, nor on who takes which part.
// Memory: values. Threads: those of the caller. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace gridiron {

inline constexpr std::uint32_t kMostSharers = 16;

/// The threads that share a piece of work. As it is made: the caller alone.
struct WorkSharing {
  using Part = void (*)(void* work, std::uint32_t part);

  std::uint32_t sharers = 1;  ///< threads; more than kMostSharers count as so many
  /// Calls part(work, i) for each i < count, by any threads at any time, and returns when all calls have.
  void (*run)(void* team, std::uint32_t count, Part part, void* work) = nullptr;
  void* team = nullptr;  ///< passed to `run`

  /// Threads for a work that is large enough to be shared.
  [[nodiscard]] std::uint32_t count() const {
    if (run == nullptr || sharers == 0) return 1;
    return sharers < kMostSharers ? sharers : kMostSharers;
  }
};

/// Calls work(i) for each i < count; where the work is shared, in any order and at the same time.
template <class Work>
void share(const WorkSharing& sharing, std::uint32_t count, Work&& work) {
  if (sharing.run == nullptr || count == 1) {
    for (std::uint32_t i = 0; i < count; ++i) work(i);
    return;
  }
  using Called = std::remove_reference_t<Work>;
  sharing.run(
      sharing.team, count, [](void* called, std::uint32_t i) { (*static_cast<Called*>(called))(i); }, &work);
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
