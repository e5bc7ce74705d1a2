// The busy time of a core with a tile, without a clock: work, commands and waits at a machine's costs, no stall.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/trace_packing.h>

namespace gridiron::sim {

/// @returns the cycles of a tile, its claim included, on a core that never stalls; instructions with a profile that
/// counts these.
[[nodiscard]] inline double busy_cycles(const TileTrace& tile, const MachineProfile& machine) {
  double cycles = machine.claim_cycles;
  for_each_event(tile, [&](const TraceEvent& event) {
    for (const WorkAmount& work : event.work) {
      cycles += machine.work_cycles[static_cast<std::size_t>(work.kind)] * work.amount;
    }
  });
  for_each_event(tile, [&](const TraceEvent& event) {
    if (event.kind == EventKind::kGet || event.kind == EventKind::kPut) cycles += machine.issue_cycles;
    if (event.kind == EventKind::kWait) cycles += machine.wait_cycles;
  });
  return cycles;
}

}  // namespace gridiron::sim
