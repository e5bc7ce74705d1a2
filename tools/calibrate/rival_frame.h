// A frame rendered by the counted rival: the same picture, and what every operation of it came to.
// Memory: owned. Threads: the caller's only. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <counted_frame.h>
#include <gridiron/base/math.h>
#include <pipe_model.h>

#include <cstdint>
#include <span>

namespace gridiron::calibrate {

/// What is rendered, and how.
struct RivalCountedFrame {
  std::span<const Vec3> vertices;
  std::span<const UVec3> triangles;
  Vec3 eye, at;
  float tan_half_fov;
  std::uint32_t width;      ///< and height, pixels
  std::uint32_t ring_size;  ///< 1: packets one after another
};

/// Renders on one core, in the settings that the rival is tuned to but for the ring, shaded.
/// Errors: std::runtime_error where the scene cannot be built or the rival refuses the frame.
[[nodiscard]] CountedPicture render_rival_counted(const RivalCountedFrame& frame,
                                                  std::uint32_t superblock_branches = kSuperblockBranches);

/// The same by the rival itself: pixels, and work as it counts it in `totals[].units`.
[[nodiscard]] CountedPicture render_rival_plain(const RivalCountedFrame& frame);

}  // namespace gridiron::calibrate
