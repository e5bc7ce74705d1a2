// A frame rendered by the counted BVH: the same picture, and what every operation of it came to.
// Memory: owned. Threads: the caller's only. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <counted_frame.h>
#include <gridiron/base/math.h>
#include <pipe_model.h>

#include <cstdint>
#include <span>

namespace gridiron::calibrate {

/// What is rendered, and how.
struct BvhCountedFrame {
  std::span<const Vec3> vertices;
  std::span<const UVec3> triangles;
  Vec3 eye, at;
  float tan_half_fov;
  std::uint32_t width;      ///< and height, pixels
  std::uint32_t ring_size;  ///< 1: packets one after another
};

/// Renders on one core, in the settings that the cached BVH is tuned to but for the ring, shaded.
/// Errors: std::runtime_error where the scene cannot be built or the cached BVH refuses the frame.
[[nodiscard]] CountedPicture render_bvh_counted(const BvhCountedFrame& frame,
                                                std::uint32_t superblock_branches = kSuperblockBranches);

/// The same by the cached BVH itself: pixels, and work as it counts it in `totals[].units`.
[[nodiscard]] CountedPicture render_bvh_plain(const BvhCountedFrame& frame);

}  // namespace gridiron::calibrate
