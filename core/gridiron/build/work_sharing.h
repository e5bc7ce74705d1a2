// Threads of the host that share the work of core's builders and checks. Core starts none itself. Results do not depend
// on how many there are, nor on who takes which part. Libraries for targets without an operating system work alone.
// Memory: values. Threads: those of the caller. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron {

inline constexpr std::uint32_t kMostSharers = 16;  ///< more count as so many

/// The threads that share a piece of work. As it is made: the caller alone. sim::HostTeam has one with threads.
struct WorkSharing {
  using Part = void (*)(void* work, std::uint32_t part);

  std::uint32_t sharers = 1;  ///< threads, the caller's included
  /// Calls part(work, i) for each i < count, by any threads at any time, and returns when all calls have. Calls do not
  /// throw.
  void (*run)(void* team, std::uint32_t count, Part part, void* work) = nullptr;
  void* team = nullptr;  ///< passed to `run`
};

}  // namespace gridiron
