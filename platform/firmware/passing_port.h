// A port that passes every call on to another. Ports that are wrong on purpose derive from it and replace one call.
// Memory: none. Threads: one worker. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>

#include <cstdint>

namespace gridiron::port {

template <Platform P>
class PassingPort {
 public:
  explicit PassingPort(P& port) : port_(port) {}

  [[nodiscard]] PlatformLimits limits() const { return port_.limits(); }
  Status get(void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    return port_.get(local, address, bytes, tag);
  }
  Status put(const void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    return port_.put(local, address, bytes, tag);
  }
  Status wait(TagMask tags) { return port_.wait(tags); }
  ItemClaim claim_item() { return port_.claim_item(); }

 private:
  P& port_;
};

}  // namespace gridiron::port
