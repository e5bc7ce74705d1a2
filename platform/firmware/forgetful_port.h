// A port that forgets waits: wrong on purpose, for images that must fail.
// Memory: none. Threads: one worker. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/dma/tags.h>
#include <gridiron/platform/contract.h>

#include <cstdint>

#include "passing_port.h"

namespace gridiron::port {

/// Leaves out every 16th wait for triangles.
template <Platform P>
class ForgetfulPort : public PassingPort<P> {
 public:
  using PassingPort<P>::PassingPort;

  Status wait(TagMask tags) {
    constexpr std::uint32_t kTriangleTags = ((1u << kTriangleTagCount) - 1u) << kFirstTriangleTag;
    if ((tags.bits & kTriangleTags) != 0 && ++waits_ % 16 == 0) return Status::kOk;
    return PassingPort<P>::wait(tags);
  }

 private:
  std::uint32_t waits_ = 0;
};

template <Platform P>
ForgetfulPort(P&) -> ForgetfulPort<P>;

}  // namespace gridiron::port
