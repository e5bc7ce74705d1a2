// The order in which a port may hand out tiles.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron {

/// @returns the tile of a claim, so that claims 0, 1, 2, ... go from the middle of the frame outward, each tile once.
/// The tiles that take long are mostly not the last then, and the cores end together. Precondition: claim < tile_count.
[[nodiscard]] constexpr std::uint32_t middle_out(std::uint32_t claim, std::uint32_t tile_count) {
  const std::uint32_t away = (claim + 1) / 2;
  return tile_count / 2 + (claim % 2 == 0 ? away : 0 - away);
}

}  // namespace gridiron
