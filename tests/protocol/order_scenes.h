// Frames in which the kernel has five transfers pending at once, of each level and mix.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "protocol/order_frame.h"

namespace gridiron::test {

/// A frame and the mixes of five transfers that it must have pending at once.
struct OrderCase {
  std::string name;
  OrderScene scene;
  OrderSettings settings;
  std::vector<std::string> mixes;  ///< letters of Purpose, sorted
};

[[nodiscard]] std::vector<OrderCase> order_cases();

/// One of them.
[[nodiscard]] OrderCase order_case(std::string_view name);

}  // namespace gridiron::test
