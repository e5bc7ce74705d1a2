// Worst tile: the bound of a scene's tiles that `info` prints, with its inputs.
// Memory: plain values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/frame/tile_bound.h>
#include <gridiron/sim/tile_cycles.h>

#include <cstddef>
#include <span>

#include "info_plan.h"

namespace gridiron::tool {

struct WorstTile {
  TileLayout layout{};  ///< 4 lanes
  TileScene scene{};
  TileFrame frame{};  ///< of the configuration, without a plane of ids
  TileBound bound{};
  sim::TileCycles cycles;          ///< on the machine
  bool are_instructions = false;   ///< the unit of cycles is instructions: prices are those of fu540
};

/// The bound for frames with the requested configuration, store, machine and accuracy; the default accuracy is the one
/// for the image's format (`standard` for vertices).
[[nodiscard]] WorstTile find_worst_tile(const InfoPlan& plan, std::span<const std::byte> image,
                                        const SceneImageView& view);

}  // namespace gridiron::tool
