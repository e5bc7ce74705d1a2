// Aims: packets of rays from inside a solid, at what is hard about its surface.
// Memory: borrows the solid. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "numeric/watertight/placed_solid.h"
#include "numeric/watertight/shot.h"
#include "support/test_mesh.h"

namespace gridiron::test {

/// Where rays start and where they go. All start inside, see PlacedSolid::look_around.
enum class RayKind : std::uint32_t {
  kRandom,      ///< anywhere, into any direction
  kEdge,        ///< at points of edges
  kVertex,      ///< at vertices
  kTwoEdges,    ///< from between points of two edges at both; with those as near to them as floats get
  kAxis,        ///< along the axes, from points with one, two or three coordinates of vertices
  kJustInside,  ///< from next to vertices, edges and faces at their neighbours, and into any direction
  kCount
};
inline constexpr RayKind kRayKinds[] = {RayKind::kRandom,   RayKind::kEdge, RayKind::kVertex,
                                        RayKind::kTwoEdges, RayKind::kAxis, RayKind::kJustInside};
[[nodiscard]] const char* name_of(RayKind kind);

/// Rays of a kind that a packet holds at most.
[[nodiscard]] std::uint32_t rays_of(RayKind kind);

/// Aims the rays of one packet; unused rays are not active. The same packet for the same seed.
///
/// Rays at edges and vertices go, packet by packet, to features around one triangle that is seen from the origin, to
/// those around any triangle, or each to another part of the mesh.
/// @returns false where no origin was found that is surely inside: there is no packet.
[[nodiscard]] bool aim(const PlacedSolid& solid, RayKind kind, std::uint64_t seed, watertight::Shot& shot);

}  // namespace gridiron::test
