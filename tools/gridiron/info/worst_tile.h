// Worst tile: the bound of a tile of a scene as `info` tells it, with what it was made of.
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
  bool are_instructions = false;   ///< what the machine's profile calls cycles: its prices are those of `fu540`
};

/// The bound of a scene's frames as the configuration, the store and the machine asked for would render them, by the
/// accuracy asked for, or the one that the image's format is for (`standard` of vertices).
[[nodiscard]] WorstTile find_worst_tile(const InfoPlan& plan, std::span<const std::byte> image,
                                        const SceneImageView& view);

}  // namespace gridiron::tool
