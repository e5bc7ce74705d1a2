// One ray walk: up to 16 rays, their state, and the transfer that they wait for.
// Memory: inside the local store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/engine/grid/shaft.h>
#include <gridiron/engine/grid/slice_walk.h>
#include <gridiron/ray/walk_rays.h>

#include <cstdint>

namespace gridiron {

/// Whether a layout has no packets and traces all rays by walks.
template <class Layout>
inline constexpr bool kHasPackets = Layout::kPacketWidth != 0;

/// Number of walks that a layout has buffers for.
template <class Layout>
inline constexpr std::uint32_t kWalkCount =
    Layout::kMaxMacroDepth < Layout::kMaxTriangleDepth ? Layout::kMaxMacroDepth : Layout::kMaxTriangleDepth;

/// State of a walk: what it does when its turn comes.
enum class WalkState : std::uint32_t {
  kIdle,       ///< has no rays
  kNextPass,   ///< takes the next of its rays that run the same way
  kNextMacro,  ///< looks for its next macrocell
  kHasBlock,   ///< waits for a cell block
  kNextCell,   ///< looks for the next cell of it
  kHasRun,     ///< waits for triangles
  kDone,       ///< every ray has its answer
};

/// One walk: its rays and its state.
struct alignas(128) Walk {
  static constexpr std::uint32_t kMailboxSlots = 32;

  WalkRays rays;
  Shaft shaft;
  MacroWalk macro_walk;
  CellWalk cell_walk;
  MacroVisit visit;
  CellVisit cell;  ///< the rest of the cell whose triangles are being fetched
  std::uint32_t run_count;
  std::uint32_t run_first_byte;
  float reach;
  WalkState state;
  std::uint32_t ray_count;
  std::uint32_t waiting;                             ///< rays not taken into a pass yet, bit i = ray i
  std::uint32_t active;                              ///< rays of this pass without an answer
  std::uint32_t purpose;                             ///< purpose of the rays; the walk does not use it
  std::uint32_t touching;                            ///< rays that may touch the cell
  alignas(16) std::uint32_t mailbox[kMailboxSlots];  ///< triangles that this pass was tested against, and
  std::uint32_t tested[kMailboxSlots];               ///< the rays that were
};

}  // namespace gridiron
