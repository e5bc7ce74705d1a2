// Kinds of work that only the passes of a build have. Memory: none. Threads: any.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/work_counters.h>

#include <cstdint>

namespace gridiron {

/// Counted like Work, and numbered behind it.
enum class BuildWork : std::uint8_t {
  kFirst = kSharedWorkCount,
  kVertex = kFirst,  ///< vertices bounded
  kCorner,           ///< corners of triangles looked for in the lines of vertices that are there
  kMissedCorner,     ///< of these, corners that were not there whole
  kCodedGroup,       ///< SIMD groups of triangles coded, and written as records
  kSortedRecord,     ///< records copied to their place in the order of codes
  kSortCount,        ///< values of a digit whose keys were counted and summed up
  kMovedKey,         ///< keys moved to where a digit of their codes belongs
  kExchangedKey,     ///< keys looked at, and moved where needed, behind the ones before them
  kGatheredKey,      ///< keys taken from runs to their bucket, of each piece of a run 16 more; or from here to there
  kAgainGroup,       ///< SIMD groups of triangles gone through to code them again: first for the range of their middles
  kAskedRecord,      ///< records asked for
  kRecordSpan,       ///< transfers of records that lie close to one another
  kTakenRecord,      ///< records of leaves taken: box, area, and the record written
  kLeaf,             ///< leaves whose boxes went to their nodes
  kPart,             ///< parts of ranges made by splitting another one
  kWeighedPart,      ///< parts whose weights were compared, to split the one that weighs the most
  kSearchStep,       ///< steps to the place where a part is split
  kCutStep,          ///< steps to the place where a bucket begins in a run
  kNode,             ///< nodes made: boxes and order of their children
  kNumberedNode,     ///< nodes that got their numbers
  kEnd
};
static_assert(static_cast<std::uint32_t>(BuildWork::kEnd) <= kWorkKindCount);
/// Kinds of BuildWork.
inline constexpr std::uint32_t kBuildWorkCount = static_cast<std::uint32_t>(BuildWork::kEnd) - kSharedWorkCount;

/// The same of the pass that checks an image, which has none of the others.
enum class CheckWork : std::uint8_t {
  kFirst = kSharedWorkCount,
  kCheckedLine = kFirst,  ///< lines of the image that entered its check value
  kEnd
};

}  // namespace gridiron
