// Pass timing: what a list of passes costs on a machine, and what each of them waits for.
// Memory: std::vector. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/passes.h>
#include <gridiron/sim/replay.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace gridiron::sim {

/// What may keep a pass from being faster.
enum class PassLimit : std::uint8_t {
  kChannel,  ///< the memory channel: cycles in which it carried a line
  kCompute,  ///< the cores: work, commands and claims, spread evenly over all of them
  kWaiting,  ///< transfers that are not hidden behind work: waits of a core, on the average
  kOneItem,  ///< the longest item, which one core has alone
  kBarrier,  ///< begin and end: start and barrier, and a core's idle time until the last one ends, on the average
  kCount
};
/// Limits, kChannel among them.
inline constexpr std::size_t kPassLimitCount = static_cast<std::size_t>(PassLimit::kCount);

/// @returns the stable snake_case name of a limit.
[[nodiscard]] std::string_view name_of(PassLimit limit);

/// The time of one pass. On each core, start + init + compute + waits + idle + barrier = cycles, without any rounding.
struct PassTiming {
  std::string_view name;      ///< of the pass
  std::uint32_t items = 0;    ///< 1: what one core does while the others are idle
  double begin_cycles = 0;    ///< from the begin of the list
  double start_cycles = 0;    ///< the master reads the count and starts the cores
  FrameTiming run;            ///< from there until the last core has ended; its tiles are items, its idle_cycles claims
                              ///< and, end_idle_cycles of them, the time until the last core ends
  double barrier_cycles = 0;  ///< until the master knows; none after a pass without items
  double cycles = 0;          ///< of all three
  std::uint64_t bytes_in = 0, bytes_out = 0;     ///< of all cores, as requested
  std::array<double, kPassLimitCount> limits{};  ///< cycles by PassLimit, none above `cycles`
  PassLimit binding = PassLimit::kChannel;       ///< the greatest of these, of equal ones the first
};

/// The time of a list of passes.
struct PassesTiming {
  std::vector<PassTiming> passes;  ///< in their order
  double cycles = 0;               ///< the sum of theirs
  double one_item_cycles = 0;      ///< of passes of one item: what more cores cannot make faster
  double seconds = 0;              ///< by the clock of the machine
};

/// Gives passes that ran in checked mode their time on `core_count` cores of `machine` (0: as many as it has).
///
/// A pass takes pass_start_cycles, then what replay() says of its trace on cores that have nothing under way, then
/// pass_barrier_cycles; the next one begins. Its latencies are drawn with latency_seed + its number in the list. A pass
/// without items takes pass_start_cycles, in which its count was looked at. Exact, and independent of the threads that
/// the passes ran on, as replay().
///
/// Rendering as the last pass: append {"render", tiles, render_frame(...)} to the runs.
///
/// @param timeline  whether to fill the runs' timelines.
[[nodiscard]] PassesTiming replay_passes(std::span<const PassRun> passes, const MachineProfile& machine,
                                         std::uint32_t core_count = 0, bool timeline = false);

/// @returns the time of one pass that was replayed by itself, as the first of a list. @param name  outlives it.
[[nodiscard]] PassTiming timing_of_pass(std::string_view name, const FrameTiming& run, const MachineProfile& machine);

}  // namespace gridiron::sim
