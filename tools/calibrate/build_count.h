// What the passes that build the tree cost: counted on meshes of the calibration, and prices against counts of scans.
// Memory: owned while it runs. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/passes/build_plan.h>
#include <pipe_model.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace gridiron::calibrate {

/// What the passes of a build came to.
using BuildTotals = std::array<Totals, kBuildPassCount>;

/// Counts the builds of the calibration's meshes: a fine teapot, a torus knot, the same with its triangles and vertices
/// in another order, and knots so small in a large room that many triangles have one code. Each on one core, 256 KB.
///
/// Errors: std::runtime_error where a counted tree is another one than build_tree()'s, or a counted pass does other
/// work.
[[nodiscard]] BuildTotals count_builds();

/// @returns the generated source file, sim_platform/gridiron/sim/build_pass_costs.h.
[[nodiscard]] std::string build_table_text(const BuildTotals& totals);

/// @returns the same for people: every kind with its bounds and classes.
[[nodiscard]] std::string build_report_text(const BuildTotals& totals);

/// The build of a scan's tree.
struct BuildCount {
  std::string scan;
  BuildTotals totals{};
  std::array<double, kBuildPassCount> counted{}, priced{};  ///< cycles of a core; without commands, waits and claims

  [[nodiscard]] double all_counted() const;
  [[nodiscard]] double all_priced() const;
  [[nodiscard]] double error() const { return all_priced() / all_counted() - 1; }
};

/// Counts the builds of the scans of the experiment. @param scenes  folder of the scans. Errors: Failure where one
/// cannot be read; as count_builds().
[[nodiscard]] std::vector<BuildCount> count_scans(const std::filesystem::path& scenes);

/// @returns a table, Markdown: scans and passes, priced against counted.
[[nodiscard]] std::string build_count_table(const std::vector<BuildCount>& counts);
/// @returns for each kind its price, what a unit took, and what the price adds to the difference.
[[nodiscard]] std::string build_count_kinds(const std::vector<BuildCount>& counts);

}  // namespace gridiron::calibrate
