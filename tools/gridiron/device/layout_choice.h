// Layout choice: which build of the kernel fits a machine and what was asked for.
// Memory: plain values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/sim_chip.h>

#include <cstdint>
#include <functional>
#include <optional>

#include "configurations.h"

namespace gridiron::tool {

/// What a command line fixes of the kernel and its buffers; the rest is the scene's, machine's and configuration's.
struct LayoutRequest {
  std::optional<sim::StoreSize> store;
  std::optional<std::uint32_t> tile_width, packet_width;
  std::optional<BufferDepths> depths;
};

/// @returns the layout with a store: what was not asked for is the store's and the configuration's.
[[nodiscard]] sim::LayoutChoice layout_with(const LayoutRequest& asked, const Configuration& configuration,
                                            sim::StoreSize store, bool has_effects);

/// @returns the store asked for, or the largest one of the machine that `is_built`; the machine's largest where none
/// is. Errors: Failure (kUsage) where the machine has no room for the store that was asked for.
[[nodiscard]] sim::StoreSize choose_store(const sim::MachineProfile& machine, std::optional<sim::StoreSize> asked,
                                          const std::function<bool(sim::StoreSize)>& is_built);

/// Errors: Failure (kUsage) where packets are wider than tiles, or no kernel is built, with those that there are.
void require_built(const sim::LayoutChoice& layout, bool is_built);

/// Errors: Failure (kUsage) where distances are wanted of a layout that has none.
void require_distances(const sim::LayoutChoice& layout, bool has_depth);

/// Errors: Failure (kUsage) where effects cannot be rendered with an accuracy.
void require_effects_of(std::optional<Accuracy> accuracy);

}  // namespace gridiron::tool
