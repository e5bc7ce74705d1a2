// The facts of a firmware that follow from the layout of its workers.
// Memory: none. Threads: none. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/work_counters.h>
#include <gridiron/platform/contract.h>

#include <cstdint>

#include "job_check.h"

namespace gridiron::port {

/// @tparam Layout      of the workers' LocalStore.
/// @tparam L           the lanes that render_tiles is given.
/// @param name         of board and image, for the console.
/// @param core_count   workers.
/// @param memory_end   first address behind the memory that a job may take.
/// @param most_tiles   the most tiles whose results fit the board's memory.
/// @param board_stack_bytes  of a worker's stack for the board's own functions, on top of the layout's budget.
/// @param queue_depth  of the port's limits.
template <class Layout, class L>
[[nodiscard]] constexpr FirmwareFacts firmware_facts(const char* name, std::uint32_t core_count,
                                                     std::uint64_t memory_end, std::uint32_t most_tiles,
                                                     std::uint32_t board_stack_bytes = 0,
                                                     std::uint32_t queue_depth = PlatformLimits{}.queue_depth) {
  return {.name = name,
          .memory_end = memory_end,
          .core_count = core_count,
          .tile_width = Layout::kTileWidth,
          .effects = Layout::kEffects,
          .packet_width = Layout::kPacketWidth,
          .engine = Layout::Engine::kId,
          .store_bytes = Layout::kArenaBytes,
          .stack_bytes = Layout::kStackBudgetBytes + board_stack_bytes,
          .lane_count = std::uint32_t{L::kCount},
          .queue_depth = queue_depth,
          .work_kinds = kWorkKindCount,
          .most_tiles = most_tiles};
}

}  // namespace gridiron::port
