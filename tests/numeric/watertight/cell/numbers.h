// Replaces the host's numbers by the Cell's in the following code: included before a source of core is compiled.
// Headers whose numbers are the host's come first. The language reserves its keywords, compilers let them be replaced.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/platform/contract.h>

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <span>
#include <type_traits>
#include <vector>

#include "numeric/watertight/cell/cell_float.h"
#include "numeric/watertight/cell/cell_vector.h"
#include "numeric/watertight/shot.h"

#define float ::watertight::CellFloat
#define double ::watertight::CellDouble
