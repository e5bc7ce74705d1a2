// Buffer ring: which of a few equal buffers is in use, in flight or free, oldest first. Depth 1 is single buffering.
// Memory: values. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>

#include <cstdint>

namespace gridiron {

/// Indices of `depth` buffers, handed out and taken back in order.
class BufferRing {
 public:
  explicit BufferRing(std::uint32_t depth) : depth_(depth) {}

  [[nodiscard]] GRIDIRON_INLINE bool empty() const { return used_ == 0; }
  [[nodiscard]] GRIDIRON_INLINE bool full() const { return used_ == depth_; }

  /// Hands out the next buffer. Precondition: !full().
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t push() {
    std::uint32_t slot = front_ + used_;
    if (slot >= depth_) slot -= depth_;
    ++used_;
    return slot;
  }
  /// The buffer handed out longest ago. Precondition: !empty().
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t front() const { return front_; }
  /// Takes the front buffer back. Precondition: !empty().
  GRIDIRON_INLINE void pop() {
    ++front_;
    if (front_ == depth_) front_ = 0;
    --used_;
  }

 private:
  std::uint32_t depth_;
  std::uint32_t front_ = 0;
  std::uint32_t used_ = 0;
};

}  // namespace gridiron
