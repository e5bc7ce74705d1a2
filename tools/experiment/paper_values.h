// The figures of Cho, Kim, Han, "Enhancing Visual Rendering on Multicore Accelerators with Explicitly Managed
// Memories", Journal of Information Science and Engineering 28 (2012), 895-909, for comparison.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace gridiron::experiment {

// [P]: printed, stands in the paper. [D]: derived, follows from printed figures.

/// One of the paper's five views.
struct PaperView {
  std::string_view key;               ///< as in View::key
  std::uint64_t vertices, triangles;  ///< [P] Table 2
  // Index 0: 1 core, index 1: 6 cores. Percent.
  std::array<double, 2> hidden;    ///< [P] Table 4, "DMA hide": share of the wait that double buffering removes
  std::array<double, 2> fps_gain;  ///< [P] Table 4, "speedup (fps)"
};

[[nodiscard]] std::span<const PaperView> paper_views();

/// @returns nullptr for a view that the paper does not have.
[[nodiscard]] const PaperView* find_paper_view(std::string_view key);

/// [D] Percent of a frame spent waiting. With w the single-buffered wait, h the hidden share and g the fps gain, and if
/// only the wait changes: 1 / (1 - h w) = 1 + g, so w = g / ((1 + g) h).
[[nodiscard]] double derived_single_wait_percent(const PaperView& view, std::size_t cores_index);
/// [D] The same with double buffering: w (1 - h) (1 + g).
[[nodiscard]] double derived_double_wait_percent(const PaperView& view, std::size_t cores_index);

/// Statements of the paper in words, each [P].
inline constexpr std::string_view kPaperShadingCost = "10-20 %";      ///< section 6.1
inline constexpr std::string_view kPaperHidden = "60-76 %";           ///< section 6.2
inline constexpr std::string_view kPaperAgainstBvh = "slow by half";  ///< section 6.3
inline constexpr std::string_view kPaperFpsGain = "10-22 %";          ///< section 6.2

/// Growth of a structure by Table 1: n is the number of triangles.
struct PaperGrowth {
  std::string_view build, traversal;
};
inline constexpr PaperGrowth kPaperGridGrowth = {"O(n)", "O(n^(1/3))"};     ///< [P]
inline constexpr PaperGrowth kPaperBvhGrowth = {"O(n log n)", "O(log n)"};  ///< [P]

}  // namespace gridiron::experiment
