// The name of a Status, for logs and serial lines. Not in status.h, so that only programs that print contain the texts.
// Memory: constants, where a name is used. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/status.h>

#include <cstdint>

namespace gridiron {

// A value of Status that is missing here does not compile.
#pragma GCC diagnostic push
#pragma GCC diagnostic error "-Wswitch"
#define GRIDIRON_STATUS_NAME(name) \
  case Status::name:               \
    return #name;

/// @returns the enumerator's name, such as "kBadImage", which status.h explains; nullptr for an unknown value.
[[nodiscard]] constexpr const char* status_name(Status status) {
  switch (status) {
    GRIDIRON_STATUS_NAME(kOk)
    GRIDIRON_STATUS_NAME(kTransferSize)
    GRIDIRON_STATUS_NAME(kTransferAlignment)
    GRIDIRON_STATUS_NAME(kTransferBoundary)
    GRIDIRON_STATUS_NAME(kTransferTag)
    GRIDIRON_STATUS_NAME(kTransferQueueFull)
    GRIDIRON_STATUS_NAME(kTransferLocalRange)
    GRIDIRON_STATUS_NAME(kTransferMainRange)
    GRIDIRON_STATUS_NAME(kTransferOverlap)
    GRIDIRON_STATUS_NAME(kTransferFailed)
    GRIDIRON_STATUS_NAME(kTransferTimedOut)
    GRIDIRON_STATUS_NAME(kTransferPending)
    GRIDIRON_STATUS_NAME(kBadAccess)
    GRIDIRON_STATUS_NAME(kBadFrame)
    GRIDIRON_STATUS_NAME(kBadImage)
    GRIDIRON_STATUS_NAME(kUnsupportedImage)
    GRIDIRON_STATUS_NAME(kUnsupportedFrame)
    GRIDIRON_STATUS_NAME(kAborted)
    GRIDIRON_STATUS_NAME(kDeadline)
    GRIDIRON_STATUS_NAME(kIncompleteFrame)
    GRIDIRON_STATUS_NAME(kMissingEffect)
    GRIDIRON_STATUS_NAME(kSpillTooSmall)
    GRIDIRON_STATUS_NAME(kMemoryTooSmall)
    GRIDIRON_STATUS_NAME(kTooManyTriangles)
    GRIDIRON_STATUS_NAME(kNoTriangles)
    GRIDIRON_STATUS_NAME(kBadVertex)
    GRIDIRON_STATUS_NAME(kBadIndex)
    GRIDIRON_STATUS_NAME(kBadParameter)
    GRIDIRON_STATUS_NAME(kBadEffects)
  }
  return nullptr;
}

#undef GRIDIRON_STATUS_NAME
#pragma GCC diagnostic pop

/// The same for a number that was printed, stored or received; a cast could cut off bits.
[[nodiscard]] constexpr const char* status_name(std::uint32_t number) {
  return number <= 0xFFu ? status_name(static_cast<Status>(number)) : nullptr;
}

}  // namespace gridiron
