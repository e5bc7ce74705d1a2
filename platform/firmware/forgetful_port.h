// Wrong on purpose, for images that show what is noticed: a port that forgets waits.
// Memory: none. Threads: one worker. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>
#include <gridiron/store/dma_tags.h>

#include <cstdint>

namespace gridiron::port {

/// Leaves out every 16th wait for triangles.
template <Platform P>
class ForgetfulPort {
 public:
  explicit ForgetfulPort(P& port) : port_(port) {}

  [[nodiscard]] PlatformLimits limits() const { return port_.limits(); }
  Status get(void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    return port_.get(local, address, bytes, tag);
  }
  Status put(const void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    return port_.put(local, address, bytes, tag);
  }
  Status wait(TagMask tags) {
    constexpr std::uint32_t kTriangleTags = ((1u << kTriangleTagCount) - 1u) << kFirstTriangleTag;
    if ((tags.bits & kTriangleTags) != 0 && ++waits_ % 16 == 0) return Status::kOk;
    return port_.wait(tags);
  }
  TileClaim claim_tile() { return port_.claim_tile(); }

 private:
  P& port_;
  std::uint32_t waits_ = 0;
};

}  // namespace gridiron::port
