// What the experiments have in common: what they make, and how they tell how far they are.
// Memory: owns the files' text. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "experiment/book.h"

namespace gridiron::experiment {

/// What an experiment made, and what it did for it.
struct ExperimentResult {
  std::vector<BookFile> files;
  std::size_t frame_count = 0;  ///< rendered on the simulated chip
  std::size_t run_count = 0;
  std::vector<std::string> missing;  ///< a sentence for each view that was left out
};

/// Called serialised with steps done and steps in all.
using ProgressCall = std::function<void(std::uint32_t, std::uint32_t)>;

}  // namespace gridiron::experiment
