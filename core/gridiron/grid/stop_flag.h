// A flag that ends long work early: read now and then by who works, raised by a signal handler, a thread or a core.
// Memory: one byte. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron {

/// Raised once, never lowered. A call that is given one returns Status::kAborted soon after it is raised.
class StopFlag {
 public:
  void raise() { __atomic_store_n(&raised_, std::uint8_t{1}, __ATOMIC_RELAXED); }  ///< by anybody, at any time
  [[nodiscard]] bool is_raised() const { return __atomic_load_n(&raised_, __ATOMIC_RELAXED) != 0; }  ///< by now

 private:
  std::uint8_t raised_ = 0;
};

/// Looks at a flag each time that much work is done, so that a loop may ask after every element.
class StopPoll {
 public:
  static constexpr std::uint64_t kWorkBetweenLooks = 65536;  ///< triangles, rows or references: milliseconds

  /// @param flag  null: never stops.
  explicit StopPoll(const StopFlag* flag) : flag_(flag) {}

  /// Counts work. @returns whether to stop.
  [[nodiscard]] bool stops_after(std::uint64_t work) {
    work_ += work;
    if (work_ < kWorkBetweenLooks) return false;
    work_ = 0;
    return flag_ != nullptr && flag_->is_raised();
  }

 private:
  const StopFlag* flag_;
  std::uint64_t work_ = 0;
};

/// Calls body(i) for i in [0, count), until the flag is raised. @returns whether all of them were called.
template <class Body>
[[nodiscard]] inline bool for_each_until(const StopFlag* flag, std::uint64_t count, Body&& body) {
  for (std::uint64_t begin = 0; begin < count; begin += StopPoll::kWorkBetweenLooks) {
    if (flag != nullptr && flag->is_raised()) return false;
    const std::uint64_t left = count - begin;
    const std::uint64_t end = begin + (left < StopPoll::kWorkBetweenLooks ? left : StopPoll::kWorkBetweenLooks);
    for (std::uint64_t i = begin; i < end; ++i) body(i);
  }
  return true;
}

}  // namespace gridiron
