// The accuracy experiment: what every accuracy profile costs on the simulated chip, and what is wrong with its answers.
// Memory: its own. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "experiment/experiment.h"

namespace gridiron::experiment {

struct AccuracyExperiment {
  std::filesystem::path scenes;  ///< folder of scans; empty: none
  std::uint32_t threads = 1;     ///< host threads; change host_*.csv at most
  std::uint32_t width = 1024, height = 1024;
};

/// @returns the names of all files that it may write; which views it has depends on the scenes.
[[nodiscard]] std::vector<std::string> accuracy_file_names();

/// Runs the experiment. Every file but host_*.csv is a function of scenes and size. Errors: Failure.
[[nodiscard]] ExperimentResult run_accuracy_experiment(const AccuracyExperiment& experiment,
                                                       const ProgressCall& progress);

}  // namespace gridiron::experiment
