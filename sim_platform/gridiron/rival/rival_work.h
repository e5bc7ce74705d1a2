// Kinds of work of the rival that core does not have, and what they cost.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/work_counters.h>
#include <gridiron/sim/machine_profile.h>

#include <array>
#include <cstdint>
#include <string_view>

namespace gridiron::rival {

/// Work of the packet traversal and of its caches. Everything else is core's Work.
enum class RivalWork : std::uint8_t {
  kCacheLookup,      ///< look-ups in either cache
  kRefill,           ///< lines replaced: victim, directory, address of the get
  kSwitch,           ///< changes to another packet of the ring
  kNodeStep,         ///< nodes whose children were held against the packet
  kChildPush,        ///< children met, put in their place in the order
  kStackPop,         ///< entries taken from the stack
  kReciprocalGroup,  ///< groups of rays of which reciprocals were computed
  kBoxSetup,         ///< boxes prepared for tests by single groups
  kBoxGroup,         ///< groups of rays held against a box
  kLeafVisit,        ///< leaves whose triangles were tested
  kTileStart,        ///< tiles begun
  kPacketStart,      ///< packets begun: bounds
  kReach,            ///< groups of rays whose farthest hit was sought, or ...
  kCount
};
inline constexpr std::uint32_t kRivalWorkCount = static_cast<std::uint32_t>(RivalWork::kCount);

/// A counter of core's that the grid's traversal alone uses carries the rival's kind through trace and replay.
[[nodiscard]] constexpr Work carrier_of(RivalWork kind) {
  constexpr std::array<Work, kRivalWorkCount> kCarriers = {
      Work::kMacroSliceStep, Work::kMacroCellStep, Work::kMacroCellVisit, Work::kSliceStep,     Work::kCellStep,
      Work::kCellVisit,      Work::kTriangleBatch, Work::kMailboxProbe,   Work::kGroupTestPaper, Work::kHitGroupPaper, Work::kTileStart, Work::kPacketStart, Work::kReachGroup};
  return kCarriers[static_cast<std::size_t>(kind)];
}

/// Name of a kind in reports, snake_case.
[[nodiscard]] std::string_view name_of(RivalWork kind);

/// Cycles per unit, 4 lanes; each with its derivation in rival_work.cpp.
[[nodiscard]] double cycles_of(RivalWork kind);

/// @returns `machine` with the rival's costs in the places of the carriers; all other kinds keep theirs.
[[nodiscard]] sim::MachineProfile with_rival_costs(sim::MachineProfile machine);

}  // namespace gridiron::rival
