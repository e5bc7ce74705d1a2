// Replay: gives a frame's trace a time on a machine. Single-threaded, deterministic to the last digit.
// Memory: std::vector. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/stages.h>
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/trace.h>
#include <gridiron/sim/wait_levels.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace gridiron::sim {

/// One core's time in one stage: cycles and commands belong to the stage in which the core was.
struct StageTiming {
  double compute_cycles = 0;  ///< initialisation included
  double wait_cycles = 0;     ///< of all levels
  std::uint64_t gets = 0, puts = 0;           ///< commands
  std::uint64_t bytes_in = 0, bytes_out = 0;  ///< as requested
};

/// One core's cycles: init + compute + sum of waits + idle = frame cycles, without any rounding.
///
/// Cycles that the core itself spends on transfers (issuing a command, asking whether tags are done) are computation:
/// no buffering can hide them. Time in which it stalls is a wait: at a wait, of the level of the transfer that ended
/// last; at a full queue, of the level of the transfer that could not be issued.
struct CoreTiming {
  std::uint32_t tiles = 0;                       ///< claimed
  double init_cycles = 0;                        ///< work that is initialisation
  double compute_cycles = 0;                     ///< all other work, and issuing transfers
  double dma_wait_cycles[kWaitLevelCount] = {};  ///< by WaitLevel
  double idle_cycles = 0;  ///< claim latency (of the refused claim too) and the time after the core's last step
  double end_idle_cycles = 0;      ///< of these, the time after the core's last step
  double longest_tile_cycles = 0;  ///< of its tiles: from having the tile to the tile's last step
  std::uint64_t gets = 0, puts = 0;                     ///< commands
  std::uint64_t bytes_in = 0, bytes_out = 0;            ///< as requested
  std::uint64_t line_bytes_in = 0, line_bytes_out = 0;  ///< in whole lines
  /// By Stage: the sums over them are init + compute, all waits, bytes and commands of the core, without any rounding.
  std::array<StageTiming, kStageCount> stages{};
};

/// One bar of the timeline. A kTile span encloses the spans of its tile; the others do not overlap on one core. Time
/// without a span is idle.
struct TimelineSpan {
  /// What the core does meanwhile.
  enum class Kind : std::uint8_t {
    kInit,     ///< work that is initialisation
    kCompute,  ///< other work
    kWait,     ///< stands still
    kTile,     ///< has this tile
  };
  std::uint32_t core;                ///< whose
  Kind kind;                         ///< of span
  WaitLevel level;                   ///< kWait only
  std::uint32_t tile_id;             ///< kNoTile before the first and after the last
  double begin_cycles, end_cycles;   ///< from the frame's begin
};

/// The time of a frame.
struct FrameTiming {
  const EngineWork* engine = &kGridEngine;  ///< of the trace: names its wait levels and kinds of work
  double frame_cycles = 0;  ///< until the last core has ended its epilogue
  double seconds = 0;       ///< the same, by the clock of the machine
  double channel_busy_cycles = 0;  ///< time in which the shared channel carried a line
  std::vector<CoreTiming> cores;       ///< one a core
  std::vector<TimelineSpan> timeline;  ///< filled only if requested; core by core, each in order of time
};

/// Options of a replay.
struct ReplayOptions {
  std::uint32_t core_count = 0;  ///< 0: the profile's
  bool timeline = false;         ///< whether to fill FrameTiming::timeline
  /// Core that renders trace.tiles[n], for programs whose tiles depend on their core's earlier tiles; empty: cores
  /// claim. A tile of a core that does not exist is not rendered.
  std::span<const std::uint32_t> core_of_tile = {};
};

/// Gives every step of `trace` a time on `core_count` cores of `machine`.
///
/// Each core runs the prologue, claims tiles, then runs the epilogue. Claims are granted in order of simulated time,
/// ties by core. The n-th grant hands out trace.tiles[n], or, if trace.is_middle_out, that of middle_out(n); with
/// options.core_of_tile a core gets the next of its own tiles instead, in the order of the trace. A core's commands are
/// served one after another in the order of issue. Each line leaves the core when the command has been issued,
/// core_line_interval_cycles have passed since the line before it, and fewer than lines_in_flight lines are under way:
/// a line is until it arrives. The channel serves lines of all cores, gets and puts alike, by the time they left, ties
/// by core. A line arrives latency_cycles after its turn on the channel has ended; where these are several numbers,
/// line_draw() / 2^64 falls into the share of one of them, in their order. A command is done when all its lines have
/// arrived; commands need not be done in the order of issue. A wait ends when all commands of its tags are done. The
/// queue is full until the command queue_depth before the new one is done.
///
/// First come, first served is fair: cores that stream equally get equal shares, and a line waits for at most
/// lines_in_flight lines of each other core.
///
/// Time is counted in integers of 1/1024 cycle. Profile values are rounded to them first, so the result is exact and
/// repeatable. Invalid values of the profile are replaced by the nearest valid one: cycles below 0 by 0 and above 2^20
/// by 2^20, counts of 0 by 1, queue_depth and lines_in_flight above 65,536 by that; channel_bytes_per_cycle <= 0 is a
/// channel that costs no time. Preconditions: a frame shorter than 2^43 cycles; tags below 32; stages below kCount;
/// steps packed by TraceWriter, which are read as cores come to them. Cost: linear in events and lines, times
/// core_count; memory: the steps of one tile a core, unpacked, about 2 bytes a step.
[[nodiscard]] FrameTiming replay(const FrameTrace& trace, const MachineProfile& machine, const ReplayOptions& options);

/// A replay of one frame whose traces come one after another, in any order. A trace that comes before its turn waits;
/// each core has one more until it has taken its steps.
class FrameClock {
 public:
  /// @param frame       prologue, epilogue and what else tiles have in common; its own tiles are not looked at.
  /// @param tile_count  that cores claim.
  /// @param options     core_of_tile is borrowed until finish().
  FrameClock(FrameTrace frame, std::uint32_t tile_count, const MachineProfile& machine, const ReplayOptions& options);
  ~FrameClock();
  FrameClock(const FrameClock&) = delete;
  FrameClock& operator=(const FrameClock&) = delete;

  /// Takes the trace of tile trace.tile_id, below tile_count and not taken before, and goes on as far as possible.
  void take(TileTrace trace);
  /// @returns traces that wait for those of earlier claims.
  [[nodiscard]] std::size_t waiting_count() const;
  /// @returns what replay() does of all traces. Precondition: all have been taken.
  [[nodiscard]] FrameTiming finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// @returns a time of a profile as the replay takes it: in whole 1/1024 of a cycle, within its limits.
[[nodiscard]] double rounded_cycles(double cycles);

/// A replay of one core that is alone with its memory, step by step while the core runs.
class CoreClock {
 public:
  using Ticks = std::uint64_t;                     ///< simulated time
  static constexpr double kTicksPerCycle = 1024;  ///< of `machine`'s cores

  /// At time 0.
  CoreClock(const MachineProfile& machine, const EngineWork& engine, std::uint32_t output_depth);
  ~CoreClock();
  CoreClock(CoreClock&&) noexcept;             ///< leaves a clock that can only be destroyed
  CoreClock& operator=(CoreClock&&) noexcept;  ///< the same

  /// Adds the steps of `trace`. @param ordinal  tiles this core had before this one.
  void take(const TileTrace& trace, std::uint32_t ordinal);
  /// Adds the time of a claim, granted or refused.
  void take_claim();

  [[nodiscard]] Ticks now() const;  ///< of the core, which may have transfers under way

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gridiron::sim
