// Machine profile: the costs of a chip's cores, transfers and memory. Applied by the replay, never seen by core.
// Memory: plain values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/work_counters.h>
#include <gridiron/build/build_step.h>
#include <gridiron/engine/tree/tile_work.h>
#include <gridiron/sim/latency.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace gridiron::sim {

/// Steps of building a scene's data structure that cost time on the general core: those of the grid, the tree and the
/// hierarchy. GridStep and TreeStep say what the first two are. Steps are priced with what they need in the cache; far
/// lines cost besides.
enum class BuildStep : std::uint8_t {
  kBuildOnce = static_cast<std::uint8_t>(GridStep::kBuildOnce),
  kVertexCheck = static_cast<std::uint8_t>(GridStep::kVertexCheck),
  kTriangleSurvey = static_cast<std::uint8_t>(GridStep::kTriangleSurvey),
  kCellBox = static_cast<std::uint8_t>(GridStep::kCellBox),
  kCellRow = static_cast<std::uint8_t>(GridStep::kCellRow),
  kSquareTest = static_cast<std::uint8_t>(GridStep::kSquareTest),
  kOutline = static_cast<std::uint8_t>(GridStep::kOutline),
  kSlabCut = static_cast<std::uint8_t>(GridStep::kSlabCut),
  kPolygonCut = static_cast<std::uint8_t>(GridStep::kPolygonCut),
  kPolygonRow = static_cast<std::uint8_t>(GridStep::kPolygonRow),
  kReferenceInsert = static_cast<std::uint8_t>(GridStep::kReferenceInsert),
  kReferenceSort = static_cast<std::uint8_t>(GridStep::kReferenceSort),
  kTriangleWrite = static_cast<std::uint8_t>(GridStep::kTriangleWrite),
  kProjectionSetup = static_cast<std::uint8_t>(GridStep::kProjectionSetup),
  kCellSum = static_cast<std::uint8_t>(GridStep::kCellSum),
  kMacroWord = static_cast<std::uint8_t>(GridStep::kMacroWord),
  kClearedLine = static_cast<std::uint8_t>(GridStep::kClearedLine),
  kCheckedLine = static_cast<std::uint8_t>(GridStep::kCheckedLine),
  kLatticeSurvey = static_cast<std::uint8_t>(GridStep::kLatticeSurvey),
  kLatticeBox = static_cast<std::uint8_t>(GridStep::kLatticeBox),
  kLatticeSort = static_cast<std::uint8_t>(GridStep::kLatticeSort),
  kLatticeWrite = static_cast<std::uint8_t>(GridStep::kLatticeWrite),
  kLatticeCellSum = static_cast<std::uint8_t>(GridStep::kLatticeCellSum),
  kTreeOnce = static_cast<std::uint8_t>(TreeStep::kOnce),
  kTreeVertexBound = static_cast<std::uint8_t>(TreeStep::kVertexBound),
  kTreeTriangleSurvey = static_cast<std::uint8_t>(TreeStep::kTriangleSurvey),
  kTreeTriangleCode = static_cast<std::uint8_t>(TreeStep::kTriangleCode),
  kTreeDigitValue = static_cast<std::uint8_t>(TreeStep::kDigitValue),
  kTreeKeySorted = static_cast<std::uint8_t>(TreeStep::kKeySorted),
  kTreeKeyScattered = static_cast<std::uint8_t>(TreeStep::kKeyScattered),
  kTreeLeafSplit = static_cast<std::uint8_t>(TreeStep::kLeafSplit),
  kTreeNodeSplit = static_cast<std::uint8_t>(TreeStep::kNodeSplit),
  kTreeCrowd = static_cast<std::uint8_t>(TreeStep::kCrowd),
  kTreeCrowdKey = static_cast<std::uint8_t>(TreeStep::kCrowdKey),
  kTreeTriangleWrite = static_cast<std::uint8_t>(TreeStep::kTriangleWrite),
  kTreeTriangleArea = static_cast<std::uint8_t>(TreeStep::kTriangleArea),
  kTreeNodeWrite = static_cast<std::uint8_t>(TreeStep::kNodeWrite),
  kTreeNodeOrder = static_cast<std::uint8_t>(TreeStep::kNodeOrder),
  kTreeCheckedLine = static_cast<std::uint8_t>(TreeStep::kCheckedLine),
  kFarLine = static_cast<std::uint8_t>(TreeStep::kCount),  ///< grid: lines that no cache holds, met out of sequence
  kTreeSurveyFarLine,  ///< the same of the survey of a tree's image, which asks for none ahead
  kTreeFarLine,        ///< the same of the tree
  kBvhOnce,            ///< what is done once a build
  kBvhVertexCheck,     ///< vertices checked for NaN and infinity
  kBvhTriangleSurvey,  ///< triangles read: indices, zero area, bounds
  kBinUpdate,          ///< (triangle, axis) entered into a bin of the surface area heuristic
  kBinSwept,           ///< bins merged when the splits of a node are priced, there and back
  kTriangleMoved,      ///< triangles moved to their side of a split, whose bounds of centres they enter
  kTriangleHalved,     ///< triangles of nodes split in halves, times the bits of their number: selected and sorted
  kBoxBound,           ///< triangles entered into the bounds of the root or a half: of boxes, of their centres
  kNodeMade,           ///< nodes of the binary tree, inner and leaf, without what is counted above
  kNodeMerged,         ///< nodes of four children: merged from pairs
  kNodePlaced,         ///< the same, laid out in cache lines
  kNodeWritten,        ///< the same, written
  kBvhTriangleWrite,   ///< triangle records written
  kBvhFarLine,         ///< lines that no cache holds, met out of sequence
  kCount
};
/// Number of steps, of grid, tree and hierarchy.
inline constexpr std::size_t kBuildStepCount = static_cast<std::size_t>(BuildStep::kCount);

/// The general core, which builds the scene image before the cores render it. One core of it works.
struct MasterProfile {
  double clock_hz;                                  ///< of the general core
  std::array<double, kBuildStepCount> step_cycles;  ///< cycles of its own clock per step, memory included

  /// Equal in every figure.
  bool operator==(const MasterProfile&) const = default;
};

/// All times in cycles of the core clock, but those of `master`.
struct MachineProfile {
  std::string_view name;             ///< argument of find_machine_profile
  std::string_view description;      ///< one line for people
  std::uint32_t core_count;          ///< accelerator cores
  double clock_hz;                   ///< of the accelerator cores
  std::uint64_t main_memory_bytes;   ///< shared by all cores
  std::uint32_t local_store_bytes;   ///< of each core
  std::uint32_t line_bytes;          ///< a transfer costs whole lines of this size
  std::uint32_t queue_depth;         ///< commands pending per core; the kernel keeps to it, a replay of more stalls
  std::uint32_t lines_in_flight;     ///< per core
  double issue_cycles;               ///< per command, on the core
  double wait_cycles;                ///< per wait, on the core, even when nothing is pending
  Latency latency_cycles;            ///< from the end of a line's turn on the channel to its arrival
  std::uint32_t latency_seed;        ///< decides which line has which, where there are several
  double channel_bytes_per_cycle;    ///< shared by all cores
  double core_line_interval_cycles;  ///< least distance between two lines of one core
  double claim_cycles;               ///< from asking for an item to having it
  double pass_start_cycles;          ///< from the master's decision to begin a pass until all cores run its kernel
  double pass_barrier_cycles;        ///< from the last core's end of a pass until the master knows of it
  std::array<double, kWorkKindCount> work_cycles;       ///< per unit of each kind of work of core and the grid, 4 lanes
  std::array<double, kTileWorkCount> tile_work_cycles;  ///< the same of TileWork
  MasterProfile master;                                 ///< builds scenes

  /// Equal in every figure and name.
  bool operator==(const MachineProfile&) const = default;
};

/// The built-in profiles, `cell-ps3` first.
[[nodiscard]] std::span<const MachineProfile> machine_profiles();

/// @returns nullptr if no profile has that name.
[[nodiscard]] const MachineProfile* find_machine_profile(std::string_view name);

/// @returns whether the prices of work are instructions, as those of fu540 are, so that times are in instructions too.
[[nodiscard]] bool counts_instructions(const MachineProfile& machine);

}  // namespace gridiron::sim
