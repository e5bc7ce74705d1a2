// Borrowed region: main memory whose pages several processes of one host share.
// Memory: borrows. Threads: before the frame. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/sim_memory.h>

#include <cstddef>
#include <span>

namespace gridiron::sim {

/// Gives a region the bytes of `shared`, of the same size. Where the host can, the region's whole pages become those of
/// `shared`, read-only, and what it held is freed; the bytes beside them are copied. The pages stay as long as the
/// region's SimMemory, even if the owner of `shared` unmaps them.
///
/// Precondition: nothing that was allocated before the region's end is released any more, and nobody writes there.
/// @param shared  of a mapping that processes share (MAP_SHARED).
/// @returns whether pages are shared; false: all bytes were copied. Errors: throws std::bad_alloc if the host has no
/// place for another mapping; the region cannot be used then.
bool borrow_bytes(const MemoryRegion& region, std::span<std::byte> shared);

}  // namespace gridiron::sim
