// Machine profile: what a chip's cores, transfers and memory cost. Applied by the replay, never seen by core.
// Memory: plain values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/work_counters.h>

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace gridiron::sim {

/// All times in cycles of the core clock.
struct MachineProfile {
  std::string_view name;
  std::string_view description;
  std::uint32_t core_count;
  double clock_hz;
  std::uint64_t main_memory_bytes;
  std::uint32_t local_store_bytes;
  std::uint32_t line_bytes;             ///< a transfer costs whole lines of this size
  std::uint32_t queue_depth;            ///< commands pending per core; issuing to a full queue stalls
  std::uint32_t lines_in_flight;        ///< per core
  double issue_cycles;                  ///< per command, on the core
  double wait_cycles;                   ///< per wait, on the core, even when nothing is pending
  double latency_cycles;                ///< from a line's turn on the channel to its arrival
  double channel_bytes_per_cycle;       ///< shared by all cores
  double core_line_interval_cycles;     ///< least distance between two lines of one core
  double claim_cycles;                  ///< from asking for a tile to having it
  std::array<double, kWorkKindCount> work_cycles;  ///< cycles per unit of each kind of work, 4 lanes
};

/// The built-in profiles, `cell-ps3` first.
[[nodiscard]] std::span<const MachineProfile> machine_profiles();

/// @returns nullptr where no profile has that name.
[[nodiscard]] const MachineProfile* find_machine_profile(std::string_view name);

}  // namespace gridiron::sim
