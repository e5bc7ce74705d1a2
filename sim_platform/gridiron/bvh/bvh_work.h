// Kinds of work of the cached BVH that core does not have. Memory: none. Threads: any.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/work_counters.h>

#include <cstdint>

namespace gridiron::bvh {

/// Work of the cached BVH's own code. Everything else is core's Work. kTileStart is core's too, at a price of its own:
/// what the BVH does between packets is charged to it.
enum class BvhWork : std::uint8_t {
  kFirst = kSharedWorkCount,
  kPacketStart = kFirst,  ///< packets begun: bounds of their quarters
  kMixedStart,            ///< packets whose rays run both ways along an axis: the rest of their bounds
  kNodeStep,              ///< nodes whose children were tested against the quarters of a packet
  kMixedNodeStep,         ///< the same of those packets
  kChildren,              ///< nodes of which a child was met: the nearest was taken, the others put on the stack
  kStackPop,              ///< entries taken from the stack
  kCacheLookup,           ///< look-ups in either cache
  kMiss,                  ///< those without a hit: the line to be replaced, address and get, or the line is on its way
  kSwitch,                ///< packets suspended and taken up again
  kLeafVisit,             ///< leaves whose triangles were tested
  kLeafTriangle,          ///< triangles of leaves
  kReach,                 ///< quarters of packets of which the farthest hit was sought
  kEnd
};
inline constexpr std::uint32_t kBvhWorkCount = static_cast<std::uint32_t>(BvhWork::kEnd) - kSharedWorkCount;

}  // namespace gridiron::bvh
