// The lane widths that a typed suite runs over: all of them in a program for the baseline, and in one for another
// instruction set (wide_lanes.cmake) the width that it is there for.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/one_lane.h>

#include "support/test_headers.h"

namespace gridiron::test {

// Of lists of rays, one lane too.
#if defined(GRIDIRON_TEST_LANES)
using LaneTypes = testing::Types<Lanes<GRIDIRON_TEST_LANES>>;
using ListLaneTypes = LaneTypes;
#else
using LaneTypes = testing::Types<Lanes<4>, Lanes<8>, Lanes<16>>;
using ListLaneTypes = testing::Types<Lanes<1>, Lanes<4>, Lanes<8>, Lanes<16>>;
#endif

struct LaneNames {
  template <class L>
  static std::string GetName(int) {
    return "W" + std::to_string(L::kCount);
  }
};

}  // namespace gridiron::test
