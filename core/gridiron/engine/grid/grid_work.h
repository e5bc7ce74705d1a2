// Kinds of work that only the grid has. Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/work_counters.h>

#include <cstdint>

namespace gridiron {

/// Counted like Work, and numbered behind it.
enum class GridWork : std::uint8_t {
  kFirst = kSharedWorkCount,
  kPacketStart = kFirst,  ///< packet passes begun: frustum, mailbox reset (initialisation)
  kPassSlope,             ///< squares of ray groups of which slopes became part of a pass's (initialisation)
  kMailboxGroup,          ///< groups of four mailbox slots cleared (initialisation)
  kPassGroup,             ///< ray groups tested against a pass's march axis, and their slopes (initialisation)
  kPassSquare,            ///< squares of ray groups tested against it by their corners (initialisation)
  kMacroSliceStep,        ///< macro slices entered
  kMacroRow,              ///< rows of macrocells begun or gone on with
  kMacroCellStep,         ///< macrocells looked up in the macrocell table
  kMacroCellVisit,        ///< non-empty macrocells whose cell block was walked
  kSliceStep,             ///< slices entered inside a visited macrocell
  kCellRow,               ///< rows of cells begun or gone on with
  kCellStep,              ///< cells looked up inside a visited macrocell
  kCellVisit,             ///< non-empty cells visited
  kTriangleBatch,         ///< triangle buffers consumed
  kMailboxProbe,          ///< mailbox look-ups
  kReachGroup,            ///< SIMD groups of which the farthest hit was sought
  kReachTest,             ///< groups of squares or subpackets asked whether they look beyond a cell's entry
  kFootprintGroup,        ///< SIMD groups of squares of subpackets tested against a cell
  kCellBoundStep,         ///< cells looked up inside a visited macrocell by their bounds, beside lattice triangles
  kEnd
};

}  // namespace gridiron
