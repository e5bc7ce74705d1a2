// Places along a Z curve. Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>

#include <cstdint>

namespace gridiron {

/// Column of place i on a Z curve through squares: the even bits of i, up to the fifth. z_curve_row: the odd ones.
[[nodiscard]] GRIDIRON_INLINE constexpr std::uint32_t z_curve_column(std::uint32_t i) {
  return (i & 1u) | ((i >> 1) & 2u) | ((i >> 2) & 4u);
}
[[nodiscard]] GRIDIRON_INLINE constexpr std::uint32_t z_curve_row(std::uint32_t i) {
  return z_curve_column(i >> 1);
}

}  // namespace gridiron
