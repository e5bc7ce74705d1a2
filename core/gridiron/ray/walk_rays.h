// Up to 16 rays that are traced together, each with an origin of its own.
// Memory: inside the local store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>

#include <cstdint>

namespace gridiron {

inline constexpr std::uint32_t kWalkRays = 16;

/// Rays, SoA. World space, directions not normalised; a ray looks for hits with 0 < t <= its t.
struct WalkRays {
  alignas(64) float origin[3][kWalkRays];
  alignas(64) float dir[3][kWalkRays];
  alignas(64) float t[kWalkRays];           ///< how far to look; of closest hits: the nearest so far
  alignas(64) float dir_max[kWalkRays];     ///< largest |component|; set by the engine
  alignas(64) std::uint32_t id[kWalkRays];  ///< triangle of the nearest hit so far, kNoTriangle before
  std::uint32_t owner[kWalkRays];           ///< index for the caller; the walk does not use it
};

/// What is asked about the hits of rays.
struct RayQuestion {
  bool any_hit;          ///< whether there is one, or which is the nearest
  bool trusts_floats;    ///< Accuracy::kFast
  MainAddress surfaces;  ///< the scene's SurfaceRecord[], by triangle_id: Accuracy::kExact settles ties with them
};

}  // namespace gridiron
