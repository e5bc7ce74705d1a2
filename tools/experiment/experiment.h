// Shared by the experiments: their results, and how they report progress.
// Memory: owns the files' text. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "experiment/book.h"

namespace gridiron::experiment {

/// The files of an experiment, and the work done for them.
struct ExperimentResult {
  std::vector<BookFile> files;
  std::size_t frame_count = 0;  ///< rendered on the simulated chip
  std::size_t run_count = 0;
  std::vector<std::string> missing;  ///< a sentence for each view that was left out
};

/// Called serialised with the steps done and all steps.
using ProgressCall = std::function<void(std::uint32_t, std::uint32_t)>;

}  // namespace gridiron::experiment
