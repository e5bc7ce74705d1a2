// What core's ray room takes from math.h, where numbers are the Cell's. Memory: none. Threads: any.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "numeric/watertight/cell/cell_float.h"

namespace gridiron {

using watertight::CellDouble;
using watertight::CellFloat;

inline constexpr CellFloat kFloatMax(3.402823466e+38f);
/// The bits of IEEE's infinity, which are a number here.
inline constexpr CellFloat kInfinity(__builtin_inff());

}  // namespace gridiron
