// Layout choice: which build of the kernel renders a frame, and how many buffers it rotates.
// Memory: plain values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/sim_chip.h>

#include <optional>

#include "arguments.h"

namespace gridiron::tool {

/// Settles store, tile and packet width and buffer depths of a render by what was asked for, its shading, machine and
/// configuration. The store is the one asked for, or the largest one of the machine that is built for the rest.
///
/// Errors: Failure (kUsage) where no kernel is built for it, or its buffers do not hold what was asked for.
void settle_layout(RenderArguments& render);

/// Errors: Failure (kUsage) where the machine has no room for the store that was asked for.
void require_room(const sim::MachineProfile& machine, std::optional<sim::StoreSize> asked);

}  // namespace gridiron::tool
