// Memory of the effects in the local store: the scene's record, materials and lights, sums of pixels, a queue of rays;
// and the wave of rays and hits being worked on, which shares the packet's memory.
// Memory: is the memory. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/dma/tags.h>
#include <gridiron/platform/contract.h>
#include <gridiron/ray/ray_batch.h>

#include <cstddef>
#include <cstdint>

namespace gridiron {

/// How a hit reflects light: shares of the ray's weight.
struct LitHit {
  float diffuse[3];
  float specular[3];
  float shine;
};

/// A hit whose shading normal is still to be computed from its triangle's.
struct PendingHit {
  float behind[3];         ///< origin of refracted rays
  float weight[3];         ///< of the ray
  std::uint32_t normals;   ///< record of the triangle's normals
  std::uint32_t material;  ///< index | enters << 31: the ray ran against the winding's normal
};

/// A hit with the data that light and secondary rays need. Directions are unit to rounding.
struct WavePoint {
  float point[3];       ///< on the side that the ray came from, lifted
  float face[3];        ///< the triangle's normal on the ray's side
  float shading[3];     ///< the normal of light; while the hit is pending the corners' weights
  float view[3];        ///< against the ray
  std::uint32_t pixel;  ///< as in QueuedRay
  std::uint32_t path;  ///< as in QueuedRay; of a finished point: the seed of its jitter
  union {
    PendingHit pending;
    LitHit lit;
  };
  std::uint32_t is_pending;  ///< 0, 1
  std::uint32_t triangle;    ///< that it lies on
};

/// A ray of a wave, which becomes its hit if there is one.
union WaveItem {
  QueuedRay ray;
  WavePoint point;
};

/// @tparam RayStore  the memory of the engine of rays while it traces some.
template <class RayStore, std::uint32_t WaveRayCount>
struct alignas(128) Wave {
  RayStore rays;
  std::uint32_t ids[WaveRayCount];  ///< triangles hit, kNoTriangle without a hit
  WaveItem items[WaveRayCount];
};

/// Memory of a layout with effects for the whole frame.
template <class Layout>
struct alignas(128) EffectStore {
  static constexpr std::uint32_t kTilePixels = Layout::kTileWidth * Layout::kTileWidth;
  static constexpr std::uint32_t kWaveRays = Layout::kWaveRays;
  static constexpr std::uint32_t kMaterialSlots = Layout::kMaterialSlots;
  static constexpr std::uint32_t kLightSlots = Layout::kLightSlots;
  static constexpr std::uint32_t kSpillBlockRays = kWaveRays / 2;  ///< moved to or from main memory at once
  static constexpr bool kHasQueue = (Layout::kEffects & (kReflection | kRefraction)) != 0;
  static constexpr std::uint32_t kQueueRays =
      kHasQueue ? 3 * kSpillBlockRays : std::uint32_t{1};  ///< of a queue that is not used: 1
  static constexpr std::uint32_t kNoMaterial = 0xFFFFFFFFu, kNoLight = 0xFFFFFFFFu;
  static_assert(kTilePixels <= kMostEffectTilePixels, "spill_bytes() counts on it");
  static_assert(kWaveRays <= kMostWaveRays && kWaveRays % (2 * kJobRays) == 0 && kMaterialSlots % 2 == 0);

  alignas(128) EffectsRecord scene;
  alignas(128) MaterialRecord materials[kMaterialSlots];  ///< direct-mapped by index
  alignas(128) LightRecord lights[kLightSlots];           ///< first_light and those that follow it, or none
  alignas(128) QueuedRay queue[kQueueRays];
  alignas(128) std::uint32_t sums[3][kTilePixels];  ///< RGB in steps of 2^-20, summed over all samples of a pixel
  alignas(128) std::uint32_t hit_ids[kTilePixels];  ///< of the eye rays of samples after the first
  std::uint32_t material_of_slot[kMaterialSlots];
  std::uint32_t first_light;
};

/// Main memory of one core for secondary rays that wait; empty for frames without effects.
struct SpillRegion {
  MainAddress address{};    ///< a multiple of kSpillAlignment
  std::uint64_t bytes = 0;  ///< at least spill_bytes(recursion_depth) of the frame's scene
};

/// Takes the effects' place in a layout without them.
struct NoEffectStore {};
struct NoWave {};
struct NoRayStore {};

}  // namespace gridiron
