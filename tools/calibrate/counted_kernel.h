// The counted kernel: core's own sources, compiled with counted numbers, branches and lanes (counted/numbers.h).
// Plain types alone, since a source that includes the counted kernel cannot include core's own.
// Memory: borrowed. Threads: the model's. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pipe_model.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace gridiron::calibrate {

/// Which program runs, in which layout of the local store.
enum class CountedProgram { kPackets8, kPackets32, kTree, kEffects, kBvh };

/// What a counted core renders: memory that begins with the frame's record.
struct CountedRun {
  std::span<std::byte> memory;
  std::span<const std::uint32_t> tiles;
  std::uint64_t spill_address = 0, spill_bytes = 0;
  CountedProgram program = CountedProgram::kPackets8;
};

/// @returns what the branches do. Errors: std::runtime_error where the kernel refuses the frame.
[[nodiscard]] Branches branches_of(const CountedRun& run);
/// @param usual  what the program's branches usually do: the program is laid out for that. @returns what everything
/// costs. Errors: as above.
[[nodiscard]] Counts run_counted(const CountedRun& run, const Branches& usual, const PipeRules& rules);

/// A pass of a build on one core.
struct CountedPass {
  std::span<std::byte> memory;           ///< from address 0 on
  std::span<const std::byte> plan;       ///< BuildPlan of BuildLayout256K
  std::uint32_t number = 0;              ///< of BuildPass
  std::span<const std::uint32_t> items;  ///< that the core claims
};
/// As of a frame. Errors: std::runtime_error where the pass fails.
[[nodiscard]] Branches branches_of(const CountedPass& pass);
[[nodiscard]] Counts run_counted(const CountedPass& pass, const Branches& usual, const PipeRules& rules);

/// A ray and a triangle that are decided in integers: sign, distance, and its order with the distance of the same
/// triangle from another corner.
struct ExactDecision {
  float eye[3], direction[3], a[3], b[3], c[3];
};
[[nodiscard]] Totals count_decisions(std::span<const ExactDecision> decisions, const PipeRules& rules);

}  // namespace gridiron::calibrate
