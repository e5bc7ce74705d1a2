// sRGB: the encoding of colours in pictures and vertices.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace gridiron::tool {

/// @returns the linear value of an sRGB one, both 0..1. Source: IEC 61966-2-1.
[[nodiscard]] inline float linear_of_srgb(float value) {
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

}  // namespace gridiron::tool
