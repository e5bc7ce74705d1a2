// Stopwatch: seconds since its construction, of the host's clock and of its processors.
// Memory: one time point. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <ctime>

namespace gridiron::tool {

/// Time of a part of the work.
struct HostSeconds {
  double wall = 0;
  double processor = 0;  ///< of all threads of the program

  /// @returns the least of both, each by itself.
  [[nodiscard]] HostSeconds least(const HostSeconds& other) const {
    return {other.wall < wall ? other.wall : wall, other.processor < processor ? other.processor : processor};
  }
};

class Stopwatch {
 public:
  [[nodiscard]] HostSeconds both() const { return {seconds(), processor_seconds()}; }
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  [[nodiscard]] double processor_seconds() const {
    return static_cast<double>(std::clock() - processor_start_) / static_cast<double>(CLOCKS_PER_SEC);
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::clock_t processor_start_ = std::clock();
};

}  // namespace gridiron::tool
