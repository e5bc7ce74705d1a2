// The experiments: what they are asked for, what they make, and how they tell how far they are.
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

/// What an experiment is asked for. Every file that it makes but host_*.csv is a function of scenes, size and
/// largest_knot.
struct ExperimentSettings {
  std::filesystem::path scenes;  ///< folder of scans; empty: none. Effects makes its own.
  std::uint32_t threads = 1;     ///< host threads; change host_*.csv at most
  std::uint32_t width = 1024, height = 1024;
  std::uint32_t largest_knot = 1'000'000;  ///< triangles of the largest mesh of Table 1; of the paper alone
};

/// What an experiment made, and what it did for it.
struct ExperimentResult {
  std::vector<BookFile> files;
  std::size_t frame_count = 0;  ///< rendered on the simulated chip
  std::size_t run_count = 0;
  std::vector<std::string> missing;  ///< a sentence for each view that was left out
};

/// Called serialised with steps done and steps in all.
using ProgressCall = std::function<void(std::uint32_t, std::uint32_t)>;

// Each runs an experiment, or returns the names of all files that it may make: which ones depends on the scenes.
// Errors: Failure.

/// The evaluation of Cho, Kim, Han 2012 run again on the simulated chip, and sweeps beside it.
[[nodiscard]] ExperimentResult run_paper_experiment(const ExperimentSettings& settings, const ProgressCall& progress);
[[nodiscard]] std::vector<std::string> paper_file_names();

/// What every accuracy profile costs on the simulated chip, and what is wrong with its answers.
[[nodiscard]] ExperimentResult run_accuracy_experiment(const ExperimentSettings& settings,
                                                       const ProgressCall& progress);
[[nodiscard]] std::vector<std::string> accuracy_file_names();

/// What each effect costs on the simulated chip, and that one that is off costs nothing. Errors: kCheckFailed too,
/// where such an effect cost anything, or buffering hides too little.
[[nodiscard]] ExperimentResult run_effects_experiment(const ExperimentSettings& settings,
                                                      const ProgressCall& progress);
[[nodiscard]] std::vector<std::string> effects_file_names();

}  // namespace gridiron::experiment
