// Build work: counted steps of building a scene's data structure, and their cost on a machine's general core.
// Memory: plain values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/mesh_lines.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace gridiron::sim {

/// Counts of each step of a build. The same on every host.
struct BuildWork {
  std::array<std::uint64_t, kBuildStepCount> counts{};  ///< by BuildStep

  /// Counts `amount` more of a step.
  constexpr void add(BuildStep step, std::uint64_t amount) { counts[static_cast<std::size_t>(step)] += amount; }
  /// @returns the count of a step.
  [[nodiscard]] constexpr std::uint64_t operator[](BuildStep step) const {
    return counts[static_cast<std::size_t>(step)];
  }
};

/// Counting and building the grid: count_scene_image with this result, then build_scene_image.
///
/// @param vertex_count, triangle_count  of the mesh, dropped triangles included.
/// @param need                          from count_scene_image, of an image with a grid and without a tree, whose
///                                      steps tree_build_work.h counts.
/// @param lines                         of the mesh.
[[nodiscard]] BuildWork grid_build_work(std::uint64_t vertex_count, std::uint64_t triangle_count, const GridNeed& need,
                                        const MeshLines& lines);

/// What the general core does for an image that the cores have built: it reads the check values of the pieces and
/// writes the image's.
[[nodiscard]] BuildWork image_check_work(std::uint64_t piece_count);

/// @returns the stable snake_case name of a step.
[[nodiscard]] std::string_view name_of(BuildStep step);

/// @returns cycles of `master`'s clock that one core needs for `work`. Whole counts times profile values, summed in the
/// order of BuildStep, so equal to the last digit on every host.
[[nodiscard]] double build_cycles(const MasterProfile& master, const BuildWork& work);

/// @returns simulated seconds; 0 unless the clock is positive.
[[nodiscard]] double build_seconds(const MasterProfile& master, const BuildWork& work);

}  // namespace gridiron::sim
