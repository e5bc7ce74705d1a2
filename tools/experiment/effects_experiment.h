// The effects experiment: what each effect costs on the simulated chip, and that one that is off costs nothing.
// Memory: its own. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "experiment/effect_scenes.h"
#include "experiment/experiment.h"

namespace gridiron::experiment {

struct EffectsExperiment {
  std::uint32_t threads = 1;  ///< host threads; change nothing
  std::uint32_t width = 96, height = 96;
  std::vector<std::string> scenes{std::begin(kEffectSceneKeys), std::end(kEffectSceneKeys)};  ///< by key
};

/// @returns the names of all files that it may write.
[[nodiscard]] std::vector<std::string> effects_file_names();

/// Runs the experiment. Every file is a function of scenes and size. Errors: tool::Failure; kCheckFailed if an effect
/// that is off cost anything, or buffering hides too little.
[[nodiscard]] ExperimentResult run_effects_experiment(const EffectsExperiment& experiment,
                                                      const ProgressCall& progress);

}  // namespace gridiron::experiment
