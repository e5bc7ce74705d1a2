// A frame rendered by the counted kernel: the same picture, and what every operation of it came to.
// Memory: owned. Threads: the caller's only. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>
#include <gridiron/base/records.h>
#include <gridiron/scene/effects.h>
#include <pipe_model.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gridiron::calibrate {

/// What is rendered, and how.
struct CountedFrame {
  std::span<const Vec3> vertices;
  std::span<const UVec3> triangles;
  Vec3 eye, at;
  float tan_half_fov;
  std::uint32_t width;             ///< and height, pixels
  std::uint32_t packet_width = 8;  ///< or 32
  Accuracy accuracy = Accuracy::kStandard;
  Shading shading = Shading::kSimple;
  std::uint32_t techniques = 0;          ///< TechniqueBits
  bool has_planes = false;               ///< depth and ids too, for which distances are exact
  const EffectsView* effects = nullptr;  ///< of Shading::kScene: of the mesh, in a store built for all effects
  /// Not 0: the cached BVH renders, with so many packets in its ring and otherwise as it is tuned. It has no choice of
  /// what begins with packet_width, but for the shading.
  std::uint32_t ring_size = 0;
};

struct CountedPicture {
  Totals totals;
  std::vector<std::uint32_t> pixels;  ///< and planes, tile-major, as the kernel puts them
};

/// Renders on one core. The grid: out of a 256 KB store, double-buffered, with 8 walks of secondary rays, lambda 4,
/// macrocells of width 6.
/// Errors: std::runtime_error where the scene cannot be built or the kernel refuses the frame.
[[nodiscard]] CountedPicture render_counted(const CountedFrame& frame,
                                            std::uint32_t superblock_branches = kSuperblockBranches);

/// The same by the kernel itself: pixels, and work as it counts it in `totals[].units`.
[[nodiscard]] CountedPicture render_plain(const CountedFrame& frame);

/// @returns the main memory that both render from: frame record, picture, scene image.
[[nodiscard]] std::vector<std::byte> main_memory_of(const CountedFrame& frame);

}  // namespace gridiron::calibrate
