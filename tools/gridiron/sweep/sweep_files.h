// Sweep files: the table and the plot of a machine sweep.
// Memory: std::string. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "machine_sweep.h"

namespace gridiron::tool {

/// @returns a row for each machine as CSV: its values of the varied keys, then its figures.
[[nodiscard]] std::string sweep_csv(std::span<const VariedKey> varied, std::span<const SweepFigures> figures);

/// Errors: Failure (kUsage) if sweep_svg() could not show the sweep clearly.
void check_sweep_plot(std::span<const VariedKey> varied);

/// @returns frames a second against the first key as SVG, a curve for each combination of the others. The axis is
/// logarithmic where the values of the first key span more than a factor of 20.
/// Precondition: check_sweep_plot() accepts the keys.
[[nodiscard]] std::string sweep_svg(std::span<const VariedKey> varied, std::span<const SweepFigures> figures,
                                    const std::string& title);

/// @returns "30 machines, 4.02 to 61.30 frames/s".
[[nodiscard]] std::string words_of_sweep(std::span<const SweepFigures> figures);

}  // namespace gridiron::tool
