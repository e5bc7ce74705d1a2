// Machine sweep: the trace of one frame replayed on many machines, which differ in a few numbers of their profile.
// Memory: owns texts and figures; borrows the trace. Threads: replay_sweep() starts its own.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/replay.h>
#include <gridiron/sim/trace.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gridiron/device/machine_keys.h"

namespace gridiron::tool {

/// A key of machine files, and the values that it takes in turn.
struct VariedKey {
  std::string name;
  std::vector<std::string> values;  ///< valid, each as the shortest text of its number
};

/// @returns "KEY=VALUE,VALUE,...", read. Errors: Failure (kUsage) if there is no such key, if a replay does not use it,
/// or if a value is wrong.
[[nodiscard]] VariedKey parse_varied_key(const std::string& text);

/// @returns the keys that a replay uses, in the order of machine files.
[[nodiscard]] std::vector<std::string> keys_of_replays();

/// Errors: Failure (kUsage) if there are too many keys or machines, or a key is there twice.
void check_varied_keys(std::span<const VariedKey> varied);

/// @returns the number of machines: of all combinations.
[[nodiscard]] std::size_t machine_count(std::span<const VariedKey> varied);

/// @returns for each key which of its values machine `i` has: the first key changes slowest.
[[nodiscard]] std::vector<std::size_t> places_of(std::span<const VariedKey> varied, std::size_t i);

/// @returns the core counts of the machines, if they differ in them.
[[nodiscard]] std::vector<std::uint32_t> varied_core_counts(std::span<const VariedKey> varied);

/// The machines of a sweep, one at a time.
class SweptMachine {
 public:
  /// @param varied  borrowed.
  SweptMachine(const sim::MachineProfile& base, std::span<const VariedKey> varied);
  SweptMachine(const SweptMachine&) = delete;
  SweptMachine& operator=(const SweptMachine&) = delete;

  /// @returns machine `i`, until the next call.
  const sim::MachineProfile& at(std::size_t i);

 private:
  sim::MachineProfile machine_;
  std::span<const VariedKey> varied_;
  std::vector<MachineKey> keys_;  // those of varied_, in machine_
};

/// Errors: Failure (kUsage) if one of the machines has no time but a number of instructions.
void require_time(const sim::MachineProfile& base, std::span<const VariedKey> varied);

/// A frame on one machine. Sums are over its cores.
struct SweepFigures {
  double frame_cycles = 0, seconds = 0;
  double compute_cycles = 0, init_cycles = 0, wait_cycles = 0, idle_cycles = 0;
  double wait_percent = 0;          ///< of the cores' cycles
  double channel_busy_percent = 0;  ///< of the frame's cycles

  [[nodiscard]] double frames_per_second() const { return seconds > 0 ? 1 / seconds : 0.0; }
};
[[nodiscard]] SweepFigures figures_of(const sim::FrameTiming& timing);

/// Replays the trace on all machines, which ranks and threads divide among them. All ranks call it.
///
/// @param trace  of rank 0, which loses it where there are several ranks. @param base  what is not varied.
/// @returns      the figures, by machine, on every rank. Errors: those of Ranks and stop_if_interrupted().
[[nodiscard]] std::vector<SweepFigures> replay_sweep(sim::FrameTrace& trace, const sim::MachineProfile& base,
                                                     std::span<const VariedKey> varied, std::uint32_t threads,
                                                     bool quiet);

}  // namespace gridiron::tool
