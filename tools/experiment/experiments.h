// The experiments: their settings, their results, and how they report progress.
// Memory: their own. Threads: they start their own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiment/book.h"

namespace gridiron::experiment {

/// Every file that an experiment writes but host_*.csv is a function of scenes, size and largest_knot.
struct ExperimentSettings {
  std::filesystem::path scenes;  ///< folder of scans; empty: none. Effects makes its own.
  std::uint32_t threads = 1;     ///< host threads; change host_*.csv at most
  std::uint32_t width = 1024, height = 1024;
  std::uint32_t largest_knot = 1'000'000;  ///< triangles of the largest mesh of Table 1, of dynamic's largest knot
};

/// The files of an experiment, and the work done for them.
struct ExperimentResult {
  std::vector<BookFile> files;
  std::size_t frame_count = 0;  ///< rendered on the simulated chip
  std::size_t run_count = 0;
  std::vector<std::string> missing;  ///< a sentence for each view that was left out
};

/// Called serialised with the steps done and all steps.
using ProgressCall = std::function<void(std::uint32_t, std::uint32_t)>;

// Each runs an experiment, divided among the ranks, of which rank 0 alone returns a result; or returns the names of all
// files that it may write; which ones depends on the scenes. Errors: Failure.

/// The evaluation of Cho, Kim, Han 2012 run again on the simulated chip, with additional sweeps.
[[nodiscard]] ExperimentResult run_paper_experiment(const ExperimentSettings& settings, const ProgressCall& progress);
[[nodiscard]] std::vector<std::string> paper_file_names();

/// The cost of every accuracy profile on the simulated chip, and the errors of its answers.
[[nodiscard]] ExperimentResult run_accuracy_experiment(const ExperimentSettings& settings,
                                                       const ProgressCall& progress);
[[nodiscard]] std::vector<std::string> accuracy_file_names();

/// The cost of each effect on the simulated chip, and that an effect that is off costs nothing. Errors: also
/// kCheckFailed if such an effect cost anything, or buffering hides too little.
[[nodiscard]] ExperimentResult run_effects_experiment(const ExperimentSettings& settings,
                                                      const ProgressCall& progress);
[[nodiscard]] std::vector<std::string> effects_file_names();

/// What building anew for each frame costs: grid, hierarchy and tree by the general core, the tree by the cores.
[[nodiscard]] ExperimentResult run_dynamic_experiment(const ExperimentSettings& settings,
                                                      const ProgressCall& progress);
[[nodiscard]] std::vector<std::string> dynamic_file_names();

}  // namespace gridiron::experiment
