// Stages of a frame with effects: what a core is busy with, reported to the clock. Each is a kind of rays or of data.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron {

/// What a core is busy with.
enum class Stage : std::uint8_t {
  kPrimary,      ///< eye rays, set-up of tiles and frames: all that there is without effects
  kSurface,      ///< points, normals, materials of hits
  kShadow,       ///< light of point and area lights, shadow rays included
  kOcclusion,    ///< ambient occlusion
  kBounce,       ///< reflected and refracted rays, their queue
  kEnvironment,  ///< lookups of the environment map
  kOutput,       ///< sums turned into pixels
  kCount
};
/// Stages, kPrimary among them.
inline constexpr std::uint32_t kStageCount = static_cast<std::uint32_t>(Stage::kCount);

}  // namespace gridiron
