// Layout choice: the build of the kernel that fits a machine and a request.
// Memory: plain values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/sim_chip.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "configurations.h"

namespace gridiron::tool {

/// Parts of the kernel and its buffers that a command line sets; the rest follows from scene, machine and
/// configuration.
struct LayoutRequest {
  std::optional<sim::StoreSize> store;
  std::optional<std::uint32_t> tile_width, packet_width;
  std::optional<BufferDepths> depths;
};

/// @returns the layout with a store; parts that were not requested are the store's and the configuration's.
[[nodiscard]] sim::LayoutChoice layout_with(const LayoutRequest& asked, const Configuration& configuration,
                                            sim::StoreSize store, bool has_effects);

/// @returns the requested store, or the largest one of the machine that `is_built`; the machine's largest if none is.
/// Errors: Failure (kUsage) if the requested store does not fit the machine.
[[nodiscard]] sim::StoreSize choose_store(const sim::MachineProfile& machine, std::optional<sim::StoreSize> asked,
                                          const std::function<bool(sim::StoreSize)>& is_built);

/// @returns whether `best` has a kernel for the requested store, or else for a store of the machine.
/// Errors: Failure (kUsage) as choose_store().
[[nodiscard]] bool has_best_kernel(const sim::MachineProfile& machine, std::optional<sim::StoreSize> asked,
                                   bool has_effects, const std::function<bool(const sim::LayoutChoice&)>& is_built);

/// Errors: Failure (kUsage) if packets are wider than tiles, or no kernel is built; lists the existing ones.
void require_built(const sim::LayoutChoice& layout, const Configuration& configuration, bool is_built);

/// An option of the command line that only eye rays through a grid have.
struct GridOption {
  const char* name;  ///< with its dashes
  bool is_given = false;
};

/// Errors: Failure (kUsage) if a configuration without a grid is given an option of the grid, or triangles of
/// Accuracy::kPaper. @param projection  the option that requires such triangles; null: none does.
void require_grid_for(const Configuration& configuration, std::span<const GridOption> options, const char* projection);

/// Errors: Failure (kUsage) if distances are requested of a layout without them.
void require_distances(const sim::LayoutChoice& layout, bool has_depth);

/// Errors: Failure (kUsage) if tiles of such frames have no bound for a view (sim::has_view_bound).
/// @param option  that requires it, with its dashes.
void require_view_bound(const char* option, EngineId engine, const sim::LayoutChoice& layout, Accuracy accuracy,
                        bool has_depth);

/// Errors: Failure (kUsage) if effects cannot be rendered with an accuracy.
void require_effects_of(std::optional<Accuracy> accuracy);

}  // namespace gridiron::tool
