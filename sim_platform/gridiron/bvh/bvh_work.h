// Kinds of work of the cached BVH that core does not have, and what they cost.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/work_counters.h>
#include <gridiron/sim/machine_profile.h>

#include <array>
#include <cstdint>
#include <string_view>

namespace gridiron::bvh {

/// Work of the cached BVH's own code. Everything else is core's Work, done by core's code.
enum class BvhWork : std::uint8_t {
  kTileStart,      ///< tiles begun
  kPacketStart,    ///< packets begun: bounds of their quarters
  kMixedStart,     ///< packets whose rays run both ways along an axis: the rest of their bounds
  kNodeStep,       ///< nodes whose children were held against the quarters of a packet
  kMixedNodeStep,  ///< the same of those packets
  kChildren,       ///< nodes of which a child was met: the nearest was taken, the others put on the stack
  kStackPop,       ///< entries taken from the stack
  kCacheLookup,    ///< look-ups in either cache
  kMiss,           ///< those that did not hit: the line to be replaced, address and get, or the line is on its way
  kSwitch,         ///< packets suspended and taken up again
  kLeafVisit,      ///< leaves whose triangles were tested
  kLeafTriangle,   ///< triangles of leaves
  kReach,          ///< quarters of packets of which the farthest hit was sought
  kCount
};
inline constexpr std::uint32_t kBvhWorkCount = static_cast<std::uint32_t>(BvhWork::kCount);

/// A counter of core's whose code the cached BVH does not run carries a kind of its own through trace and replay.
[[nodiscard]] constexpr Work carrier_of(BvhWork kind) {
  constexpr std::array<Work, kBvhWorkCount> kCarriers = {
      Work::kTileStart,      Work::kPacketStart,    Work::kPassGroup, Work::kMacroSliceStep, Work::kMacroCellStep,
      Work::kMacroCellVisit, Work::kSliceStep,      Work::kCellStep,  Work::kCellVisit,      Work::kTriangleBatch,
      Work::kMailboxProbe,   Work::kFootprintGroup, Work::kReachGroup};
  return kCarriers[static_cast<std::size_t>(kind)];
}

/// Name of a kind in reports, snake_case.
[[nodiscard]] std::string_view name_of(BvhWork kind);

/// Cycles per unit, 4 lanes: bvh_costs.h, counted by tools/calibrate.
[[nodiscard]] double cycles_of(BvhWork kind);

/// @returns `machine` with the cached BVH's costs in the places of the carriers; all other kinds keep theirs.
[[nodiscard]] sim::MachineProfile with_bvh_costs(sim::MachineProfile machine);

}  // namespace gridiron::bvh
