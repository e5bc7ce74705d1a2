// Layout choice: which build of the kernel renders a frame, and how many buffers it rotates.
// Memory: plain values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/sim_chip.h>

#include <optional>

#include "gridiron/command_line/arguments.h"

namespace gridiron::tool {

/// Settles store, tile and packet width and buffer depths of a render by what was asked for, its shading, machine and
/// configuration. The store is the one asked for, or the largest one of the machine that is built for the rest.
///
/// Errors: Failure (kUsage) where no kernel is built for it, or its buffers do not hold what was asked for.
void settle_layout(RenderArguments& render);

/// Settles the store that `info` tells of: the one asked for, or the largest one of the machine that is built for the
/// packets asked for. Errors: Failure (kUsage) as of a render.
/// @param has_effects  whether the scene is known to be a text scene.
void settle_layout(InfoArguments& info, bool has_effects);

/// @returns the layout that `info` tells of: the store's usual tiles, packets as asked for or the configuration's. With
/// effects, where the store has none for these, that of 256 KB.
/// Errors: Failure (kUsage) where no kernel is built for it, or it has no distances and these are wanted.
[[nodiscard]] sim::LayoutChoice info_layout(const InfoArguments& info, bool has_effects);

/// Errors: Failure (kUsage) where distances are wanted of a layout that has none.
void require_distances(const sim::LayoutChoice& layout, bool has_depth);

/// Errors: Failure (kUsage) where the machine has no room for the store that was asked for.
void require_room(const sim::MachineProfile& machine, std::optional<sim::StoreSize> asked);

}  // namespace gridiron::tool
