// Compares a rendered frame's pixels with the ground truth, bit for bit.
// Memory: std::vector. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/scene/mesh.h>

#include "support/brute_force.h"
#include "support/render_mesh.h"

namespace gridiron::test {

/// Outcome of a comparison.
struct TruthReport {
  std::size_t pixels = 0;
  std::size_t hits = 0;        ///< pixels whose true ray hits a triangle
  std::size_t mismatches = 0;  ///< pixels whose triangle or depth differs
  std::string first_mismatch;  ///< in words, with the pixel; empty if there is none
  BruteForceCounts work;
};

/// Checks triangle and depth of `pixels` (row-major indices) of a frame of accuracy `standard` or `exact`, and that the
/// colour is the background's where nothing is hit.
TruthReport check_against_truth(const RenderedFrame& rendered, const MeshView& mesh,
                                std::span<const std::size_t> pixels);

/// All pixels of a frame.
std::vector<std::size_t> all_pixels(const FrameRecord& frame);

/// `count` different pixels, or all where there are fewer, drawn by `seed`.
std::vector<std::size_t> random_pixels(const FrameRecord& frame, std::size_t count, std::uint64_t seed);

/// Up to `count` pixels with a neighbour (left, right, above, below) of another id, drawn by `seed`.
std::vector<std::size_t> border_pixels(const RenderedFrame& rendered, std::size_t count, std::uint64_t seed);

}  // namespace gridiron::test
