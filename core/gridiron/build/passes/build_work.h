// Kinds of work that only the passes of a build have, and transfers that count them. Memory: none. Threads: any.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/dma/transfers.h>
#include <gridiron/platform/contract.h>

#include <cstdint>

namespace gridiron {

/// Counted like Work, and numbered behind it.
enum class BuildWork : std::uint8_t {
  kFirst = kSharedWorkCount,
  kVertex = kFirst,  ///< vertices bounded
  kCorner,           ///< corners of triangles looked for in the lines of vertices that are there
  kMissedCorner,     ///< of these, corners that were not there whole
  kCodedGroup,       ///< SIMD groups of triangles coded, and written as records
  kDroppedTriangle,  ///< triangles without an area
  kSortCount,        ///< values of a digit whose keys were counted and summed up
  kMovedKey,         ///< keys moved to where a digit of their codes belongs
  kExchangedKey,     ///< keys looked at, and moved where needed, behind the ones before them
  kCut,              ///< places of a bucket's begin in a run that were looked for
  kGatheredKey,      ///< keys taken from runs to their bucket; or from here to there
  kMiddleGroup,      ///< SIMD groups of triangles whose middles were found, to code them again
  kAgainGroup,       ///< SIMD groups of triangles coded again
  kAskedRecord,      ///< records asked for
  kTakenRecord,      ///< records of leaves taken: box, area, and the record written
  kLeaf,             ///< leaves whose boxes went to their nodes
  kPart,             ///< parts of ranges made by splitting another one
  kWeighedPart,      ///< parts whose weights were compared, to split the one that weighs the most
  kSearchStep,       ///< steps to the place where a part is split
  kNode,             ///< nodes made: boxes and order of their children
  kNumberedNode,     ///< nodes that got their numbers
  kEnd
};
static_assert(static_cast<std::uint32_t>(BuildWork::kEnd) <= kWorkKindCount);

/// The same of the pass that checks an image, which has none of the others.
enum class CheckWork : std::uint8_t {
  kFirst = kSharedWorkCount,
  kCheckedLine = kFirst,  ///< lines of the image that entered its check value
  kEnd
};

/// A core's transfers, and the work between them.
template <Platform P>
class BuildTransfers : public Transfers<P> {
 public:
  BuildTransfers(P& platform, WorkCounters& work) : Transfers<P>(platform, work), counters_(work) {}

  /// Counts so many more of a kind of work.
  GRIDIRON_INLINE void add_work(WorkId kind, std::uint32_t amount = 1) { counters_.add(kind, amount); }

 private:
  WorkCounters& counters_;
};

}  // namespace gridiron
