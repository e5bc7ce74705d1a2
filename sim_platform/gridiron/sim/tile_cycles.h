// Tile cycles: the greatest cost of the worst tile of a scene on a machine.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/frame/tile_bound.h>
#include <gridiron/sim/machine_profile.h>

#include <algorithm>
#include <cstdint>

namespace gridiron::sim {

/// Most cycles of a tile, from the grant of its claim to the next claim, of the core's clock; instructions if the
/// machine's profile counts these (`fu540`).
struct TileCycles {
  double work = 0;       ///< counts times their prices
  double commands = 0;   ///< commands and waits
  double transfers = 0;  ///< all lines, as if none overlapped another or work
  /// The sum, as if nothing were hidden.
  [[nodiscard]] double total() const { return work + commands + transfers; }
};

/// Prices the counts of a bound on `machine`, whose prices are for 4 lanes (MachineProfile::work_cycles).
///
/// A line waits for those that every core may have under way, and arrives a latency later (replay.h). A tile also waits
/// for earlier tiles that are leaving the core: as many as output buffers, each of them the largest.
///
/// @param bound         of worst_tile(), for TileLayout::lanes of 4.
/// @param machine       provides prices, lines and channel.
/// @param output_depth  TileFrame::output_depth of the same frame.
/// Errors: none; a count of 2^64 - 1 is priced as that number.
[[nodiscard]] inline TileCycles worst_tile_cycles(const TileBound& bound, const MachineProfile& machine,
                                                  std::uint32_t output_depth) {
  const auto number = [](std::uint64_t count) { return static_cast<double>(count); };
  TileCycles cycles;
  for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) {
    cycles.work += number(bound.work[kind]) * machine.work_cycles[kind];
  }
  const double gets = number(bound[Work::kGetIssue]), puts = number(bound[Work::kPutIssue]);
  cycles.commands = (gets + puts) * machine.issue_cycles + number(bound[Work::kWait]) * machine.wait_cycles;
  // The first and the last line of a transfer may be used only in part.
  const double line_bytes = machine.line_bytes;
  const auto lines = [&](std::uint64_t bytes, double transfers) { return number(bytes) / line_bytes + 2 * transfers; };
  const double all_lines = lines(bound.get_bytes, gets) + lines(bound.put_bytes, puts) * (1 + output_depth);
  const double turn_cycles =
      machine.channel_bytes_per_cycle > 0 ? line_bytes / machine.channel_bytes_per_cycle : 0.0;
  const double in_flight = static_cast<double>(machine.core_count) * machine.lines_in_flight;
  cycles.transfers =
      all_lines * (machine.core_line_interval_cycles + machine.latency_cycles.longest() + in_flight * turn_cycles);
  return cycles;
}

}  // namespace gridiron::sim
