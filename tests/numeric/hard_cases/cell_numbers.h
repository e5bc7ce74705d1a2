// Core's walks over the Cell's numbers, as tests/numeric/watertight compiles them. Numbers alone, none of core's
// types: core is compiled for it in a namespace of its own. Memory: std::vector. Threads: any.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace hard_cell {

using HostVector = float[3];

/// The cells that one ray's walk visits, x fastest, then y, then z; none for what joins no pass.
/// @param grid  the bytes of core's GridRecord. @param steps  out: steps of the two walks.
std::vector<std::uint64_t> visited_cells(const unsigned char* grid, const HostVector& origin, const HostVector& dir,
                                         std::uint64_t& steps);

}  // namespace hard_cell
