// A batch of rays that are traced together, each with an origin of its own, and what is asked about their hits.
// Memory: inside the local store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>

#include <cstdint>

namespace gridiron {

/// Triangles that rays are tested against have lower numbers. From here on, an id says that nothing was hit.
inline constexpr std::uint32_t kNoHit = 1u << 31;
/// @param own  a triangle that the ray surely does not hit, as the one that it begins on or ends at: an engine that
///             would have to decide that exactly may skip it. kNoTriangle: there is none.
/// @returns the id of a ray that has hit nothing so far.
[[nodiscard]] constexpr std::uint32_t no_hit(std::uint32_t own) {
  return own | kNoHit;
}

/// A ray of a batch: three quads of words. World space, direction not normalised; it looks for hits with 0 < t <= its
/// t.
struct alignas(16) BatchRay {
  float origin[3];
  float t;           ///< how far to look; of closest hits: the nearest so far
  float inverse[3];  ///< reciprocals of dir; set by the engine
  float dir_max;     ///< largest |component| of dir; set by the engine
  float dir[3];
  std::uint32_t id;  ///< triangle of the hit so far; before, what no_hit() gives

  [[nodiscard]] bool has_hit() const { return id < kNoHit; }
};
static_assert(sizeof(BatchRay) == 48);

/// Rays that one call of an engine's trace() adds to a batch at most.
inline constexpr std::uint32_t kJobRays = 16;

/// Rays in the local store, and for each a number that its caller knows it by.
struct RayBatch {
  BatchRay* rays;
  std::uint32_t* owners;
  std::uint32_t count;  ///< rays so far; there is room for kJobRays more whenever jobs are asked for some
};

/// What is asked about the hits of rays.
struct RayQuestion {
  bool any_hit;          ///< whether there is one, or which is the nearest
  bool are_neighbors;    ///< rays that follow each other run alike: bounds of several may save work
  bool trusts_floats;    ///< Accuracy::kFast
  bool breaks_ties;      ///< Accuracy::kExact: of hits at one rounded distance the truly nearer one counts
  MainAddress surfaces;  ///< the scene's SurfaceRecord[], by triangle_id: ties are settled with them
};

}  // namespace gridiron
