// Prices against direct counts: whether the table of work costs holds where it was not made.
// Memory: owned. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pipe_model.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace gridiron::calibrate {

/// A view in a configuration, summed over its windows of 96x96 pixels of a picture of 1024x1024; or a frame.
struct DirectCount {
  std::string view, configuration;         ///< "bvh": the cached BVH
  Totals totals{};                         ///< of all windows
  double counted = 0, priced = 0;          ///< cycles
  double worst = 0;                        ///< of priced / counted - 1 of a window, the one farthest from 0
  std::uint32_t worst_x = 0, worst_y = 0;  ///< its first pixel

  [[nodiscard]] double error() const { return priced / counted - 1; }
};

/// Counts nine windows of each view of the experiment in every configuration and the cached BVH.
///
/// @param scenes   folder of the scans. @param done  called after each window with how many are done, of how many;
///                 by one thread at a time.
/// Errors: Failure where a scene cannot be read, std::runtime_error where a counted picture is another one.
[[nodiscard]] std::vector<DirectCount> count_windows(const std::filesystem::path& scenes, std::uint32_t threads,
                                                     const std::function<void(std::size_t, std::size_t)>& done);

/// @returns the two frames with effects that the table of work costs is made from, priced: they share the packets'
/// kinds of work, to which they do not contribute.
[[nodiscard]] std::vector<DirectCount> count_effects();

/// @returns the table of tools/calibrate/README.md.
[[nodiscard]] std::string direct_count_table(const std::vector<DirectCount>& counts);

/// @returns by configuration, what a unit of each kind costs in each view beside its price, and what the difference
/// makes of all cycles.
[[nodiscard]] std::string direct_count_kinds(const std::vector<DirectCount>& counts);

}  // namespace gridiron::calibrate
