// Status: the one error type of Gridiron. Messages are written in tools/.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#ifndef __cpp_concepts
#error "Gridiron is C++20: compile with -std=c++20"
#endif

namespace gridiron {

/// Outcome of a call that can fail. Every value names one cause; kOk is zero.
enum class [[nodiscard]] Status : std::uint8_t{
    kOk = 0,

    // Transfers and claims (platform).
    kTransferSize,        ///< size is 0, above the platform's limit, or not a multiple of its granule
    kTransferAlignment,   ///< an end is misaligned, or the two ends are not congruent
    kTransferBoundary,    ///< the main-memory side crosses a boundary the platform forbids
    kTransferTag,         ///< tag index out of range
    kTransferQueueFull,   ///< more commands pending than the platform's queue depth
    kTransferLocalRange,  ///< the local side is not inside the core's arena
    kTransferMainRange,   ///< the main-memory side is not inside memory that may be read or written
    kTransferOverlap,     ///< overlaps a pending transfer, at least one of the two writing
    kTransferFailed,      ///< the transfer was started and reported an error
    kTransferTimedOut,    ///< the transfer did not end within the platform's bound
    kTransferPending,     ///< a transfer was never waited for before the frame ended (platforms that check)
    kBadAccess,           ///< a load or store touched bytes that it must not (platforms that check)

    // Frames (kernel).
    kBadFrame,          ///< frame record: wrong magic, version, size or range; camera too far for its grid
    kBadImage,          ///< scene image: wrong magic, version, check value, offset or count
    kUnsupportedImage,  ///< scene image is valid but this store layout or profile cannot use it
    kUnsupportedFrame,  ///< this renderer was not built for such a frame
    kAborted,           ///< the frame was stopped between two tiles
    kDeadline,          ///< the frame's deadline passed between two tiles
    kIncompleteFrame,   ///< the cores ended well, but part of the picture was not written (platforms that check)

    // Effects (kernel).
    kMissingEffect,  ///< the scene requires effects that this renderer was built without
    kSpillTooSmall,  ///< main memory for rays that wait is smaller than the scene's depth requires

    // Readers and builders (prepare).
    kMemoryTooSmall,    ///< the caller's span is smaller than the counted need; nothing was written
    kTooManyTriangles,  ///< more triangles or references than 32-bit counts can address
    kNoTriangles,       ///< nothing to trace: the mesh has no triangle of non-zero area
    kBadVertex,         ///< a vertex coordinate is NaN, infinite or beyond +-2^120
    kBadIndex,          ///< a triangle names a vertex that does not exist
    kBadParameter,      ///< a parameter is outside its documented range
    kBadEffects,        ///< a light, material, normal, texel or count of a scene is outside its documented range
};

}  // namespace gridiron

/// Returns from the enclosing function when `expression` is not Status::kOk.
#define GRIDIRON_TRY(expression)                                            \
  do {                                                                      \
    const ::gridiron::Status gridiron_status_ = (expression);               \
    if (gridiron_status_ != ::gridiron::Status::kOk) return gridiron_status_; \
  } while (false)
