// Core's walks over the Cell's numbers, as tests/numeric/watertight transcribes them. Numbers alone, none of core's
// types: core is compiled for it in a namespace of its own. Memory: std::vector. Threads: any.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace hard_cell {

/// The cells that one ray's walk visits, x fastest, then y, then z; none for what joins no pass.
/// @param grid  the bytes of core's GridRecord. @param steps  out: steps of the two walks.
std::vector<std::uint64_t> visited_cells(const unsigned char* grid, const float origin[3], const float dir[3],
                                         std::uint64_t& steps);

}  // namespace hard_cell
