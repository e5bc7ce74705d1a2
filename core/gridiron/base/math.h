// Vector types and the few scalar helpers core uses. GLM; no libm, every result is the same bits on every target.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#ifndef GLM_FORCE_INLINE
#define GLM_FORCE_INLINE
#endif
#include <cstdint>
#include <glm/vec3.hpp>

namespace gridiron {

using Vec3 = glm::vec3;  ///< 12 bytes, x y z
using DVec3 = glm::dvec3;  ///< the same in doubles
using UVec3 = glm::uvec3;  ///< three indices

/// Largest finite float; used where "no limit" is meant, since a chip may have no infinity.
inline constexpr float kFloatMax = 3.402823466e+38f;
inline constexpr float kInfinity = __builtin_inff();  ///< for comparisons only

/// Rounds `value` up to a multiple of `step` (a power of two).
template <class Integer>
[[nodiscard]] constexpr Integer round_up(Integer value, Integer step) {
  return static_cast<Integer>((value + step - 1) & ~(step - 1));
}

}  // namespace gridiron
