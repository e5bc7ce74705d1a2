// Shots through the grid: whole frames from inside a solid, by builder, transfers, traversal and packets, each picture
// aimed at a feature. Its pixels are what the rays of aims.h are to the intersectors alone.
// Memory: a scene image per format and thread. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/sim_chip.h>

#include "numeric/watertight/placed_solid.h"
#include "numeric/watertight/tally.h"

namespace gridiron::test {

inline constexpr const char* kGridKind = "grid";

/// The machines that frames can be rendered under: those that differ from the first by rules of floating point alone.
[[nodiscard]] std::vector<Machine> grid_machines();

/// Renders frames of 32x32 pixels until so many rays are shot. The same tally for any number of threads.
///
/// A frame's rays go: across one triangle, so that pixels lie on its corners, its edges and on 1/32 of the way between;
/// or to a vertex or a point of an edge and to the floats around that direction, column by column and row by row; or
/// over a wide field. By turns frames have packets of 8 with corner culling or of 32 with subpackets, a depth plane or
/// none, 4, 8 or 16 lanes; some are rendered by all these turns, and compared with each other.
///
/// @param machines  of grid_machines(). @param mode  checked or plain.
/// Errors: std::runtime_error where a frame cannot be rendered or breaks a rule of the platform.
[[nodiscard]] Tally shoot_through_grid(const PlacedSolid& solid, std::span<const Machine> machines,
                                       std::span<const Peer> peers, sim::Mode mode, const TallyOptions& options);

}  // namespace gridiron::test
