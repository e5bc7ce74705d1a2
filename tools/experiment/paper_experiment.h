// The paper experiment: the evaluation of Cho, Kim, Han 2012 run again on the simulated chip, with additional sweeps.
// Memory: its own. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "experiment/experiment.h"

namespace gridiron::experiment {

struct PaperExperiment {
  std::filesystem::path scenes;  ///< folder of scans; empty: none
  std::uint32_t threads = 1;     ///< host threads; change host_*.csv at most
  std::uint32_t width = 1024, height = 1024;
  std::uint32_t largest_knot = 1'000'000;  ///< triangles of the largest mesh of Table 1
};

/// @returns the names of all files that it may write; which views it has depends on the scenes.
[[nodiscard]] std::vector<std::string> paper_file_names();

/// Runs the experiment. Every file but host_*.csv is a function of scenes, size and largest_knot. Errors: Failure.
///
/// @param progress  called serialised with the steps done and all steps.
[[nodiscard]] ExperimentResult run_paper_experiment(const PaperExperiment& experiment, const ProgressCall& progress);

}  // namespace gridiron::experiment
