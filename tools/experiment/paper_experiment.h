// The paper experiment: the evaluation of Cho, Kim, Han 2012 run again on the simulated chip, and sweeps beside it.
// Memory: its own. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiment/book.h"

namespace gridiron::experiment {

struct PaperExperiment {
  std::filesystem::path scenes;  ///< folder of scans; empty: none
  std::uint32_t threads = 1;     ///< host threads; change host_*.csv at most
  std::uint32_t width = 1024, height = 1024;
  std::uint32_t largest_knot = 1'000'000;  ///< triangles of the largest mesh of Table 1
};

/// What an experiment made, and what it did for it.
struct PaperResult {
  std::vector<BookFile> files;
  std::size_t frame_count = 0;  ///< rendered on the simulated chip, those of the hierarchy included
  std::size_t run_count = 0;
  std::vector<std::string> missing;  ///< a sentence for each view that was left out
};

/// @returns the names of all files that it may make: which views it has depends on the scenes.
[[nodiscard]] std::vector<std::string> paper_file_names();

/// Runs the experiment. Every file but host_*.csv is a function of scenes, size and largest_knot.
///
/// @param progress  called serialised with steps done and steps in all.
/// Errors: Failure.
[[nodiscard]] PaperResult run_paper_experiment(const PaperExperiment& experiment,
                                               const std::function<void(std::uint32_t, std::uint32_t)>& progress);

}  // namespace gridiron::experiment
